#include "app/style_names.h"

#include <fmt/format.h>

#include "verdure/error.h"

namespace verdure::app {
namespace {

constexpr std::pair<const char*, Style> kStyles[] = {{"photo", Style::kPhoto},
                                                     {"normals", Style::kNormals},
                                                     {"edges", Style::kEdges},
                                                     {"toon", Style::kToon},
                                                     {"watercolour", Style::kWatercolor}};
constexpr std::pair<const char*, StyleNormals> kNormals[] = {
    {"raw", StyleNormals::kRaw},
    {"realigned", StyleNormals::kRealigned},
    {"scaled", StyleNormals::kScaled}};

}  // namespace

Style parseStyle(const std::string& name) {
  for (const auto& [known, style] : kStyles)
    if (name == known) return style;
  if (name == "watercolor") return Style::kWatercolor;
  throw Error("--style", fmt::format("'{}' is unknown", name),
              "use photo, edges, toon, watercolour or normals");
}

const char* nameOf(Style style) {
  for (const auto& [name, known] : kStyles)
    if (style == known) return name;
  return "";
}

StyleNormals parseStyleNormals(const std::string& name) {
  for (const auto& [known, normals] : kNormals)
    if (name == known) return normals;
  throw Error("--style-normals", fmt::format("'{}' is unknown", name),
              "use raw, realigned or scaled");
}

const char* nameOf(StyleNormals normals) {
  for (const auto& [name, known] : kNormals)
    if (normals == known) return name;
  return "";
}

bool needsBake(const View& view) {
  if (view.style != Style::kPhoto) return view.style_normals != StyleNormals::kRaw;
  return view.terms.normal == NormalSource::kCrown ||
         view.terms.ambient_source == AmbientSource::kBaked ||
         view.terms.ambient_source == AmbientSource::kLeafVisibility;
}

bool needsLeafNormals(const View& view) {
  return view.style == Style::kPhoto ? view.terms.normal == NormalSource::kLeaf
                                     : view.style_normals == StyleNormals::kRaw;
}

}  // namespace verdure::app
