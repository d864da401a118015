#include "app/bake_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/parse.h"
#include "verdure/error.h"

namespace verdure::app {

BakeField BakeParameters::fieldOr(BakeField fallback) const {
  std::string given = metaball_option;
  if (normals == "surface-vertex" || normals == "surface-point" || normals == "ellipsoid")
    given = "--normals " + normals;
  if (field == "metaball") {
    if (normals == "optical-depth")
      throw Error("--normals optical-depth", "does not go with --field metaball",
                  "leave one of them out");
    return BakeField::kMetaball;
  }
  if (!field.empty() && field != "optical-depth")
    throw Error("--field", fmt::format("'{}' is unknown", field), "use metaball or optical-depth");
  const bool depth = field == "optical-depth" || normals == "optical-depth";
  if (depth && !given.empty())
    throw Error(given, "belongs to the metaball field, not to optical-depth",
                "leave it out, or use --field metaball");
  return depth ? BakeField::kOpticalDepth : given.empty() ? fallback : BakeField::kMetaball;
}

DepthOptions BakeParameters::checkedDepth() const {
  const DensityOptions common = [&] {
    BakeParameters named = *this;  // the rest is checked alike
    if (normals == "optical-depth") named.normals.clear();
    return named.checked();
  }();
  DepthOptions o;
  o.normals =
      common.normals == CrownNormals::kKeep ? CrownNormals::kKeep : CrownNormals::kOpticalDepth;
  o.blend = common.blend;
  o.seed = common.seed;
  o.max_memory_bytes = common.max_memory_bytes;
  o.fit = fit.value_or(true);
  return o;
}

DensityOptions BakeParameters::checked() const {
  DensityOptions o = options;
  if (norm == "inf") {
    o.norm = {Norm::Kind::kLinf, 0.0f};
  } else {
    const float p = parseNumbers("--norm", norm, 1)[0];
    if (!(p >= 1.0f)) throw Error("--norm", "the exponent must be at least 1", "use 1, 2 or inf");
    o.norm = p == 1.0f   ? Norm{Norm::Kind::kL1, 1.0f}
             : p == 2.0f ? Norm{Norm::Kind::kL2, 2.0f}
                         : Norm{Norm::Kind::kLp, p};
  }
  if (normals.empty())
    o.normals = CrownNormals::kSurfacePoint;
  else if (normals == "surface-vertex")
    o.normals = CrownNormals::kSurfaceVertex;
  else if (normals == "surface-point")
    o.normals = CrownNormals::kSurfacePoint;
  else if (normals == "ellipsoid")
    o.normals = CrownNormals::kEllipsoid;
  else if (normals == "keep")
    o.normals = CrownNormals::kKeep;
  else
    throw Error("--normals", fmt::format("'{}' is unknown", normals),
                "use optical-depth, surface-point, surface-vertex, ellipsoid or keep");
  if (!(max_memory_mib > 0.0)) throw Error("--max-memory", "must be above 0", "4096 is usual");
  o.max_memory_bytes = static_cast<std::size_t>(std::min(max_memory_mib, 1e12) * 1048576.0);
  return o;
}

}  // namespace verdure::app
