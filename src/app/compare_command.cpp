// compare.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <variant>

#include "app/commands.h"
#include "base/progress.h"
#include "verdure/compare.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

using AnyImage = std::variant<Image, HdrImage>;

AnyImage readAny(const std::string& path) {
  const std::string kind = std::filesystem::path(path).extension().string();
  if (kind == ".exr" || kind == ".hdr" || kind == ".pic") return readHdrImage(path);
  if (kind == ".png" || kind == ".jpg" || kind == ".jpeg") return readImage(path);
  throw Error(path, "is no kind of image that can be compared", "use .png, .jpg, .exr or .hdr");
}

struct Metric {
  const char* name;
  bool more_is_worse;
};
constexpr std::array<Metric, 3> kMetrics = {{{"flip", true}, {"psnr", false}, {"ssim", false}}};

std::vector<Metric> parseMetrics(const std::string& text) {
  std::vector<Metric> metrics;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    const auto known = std::find_if(kMetrics.begin(), kMetrics.end(),
                                    [&name](const Metric& m) { return name == m.name; });
    if (known == kMetrics.end())
      throw Error("--metric", fmt::format("'{}' is unknown", name), "use flip, psnr, ssim");
    metrics.push_back(*known);
    begin = end + 1;
  }
  return metrics;
}

/// JSON knows no infinity.
nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json("inf");
}

}  // namespace

int runCompare(const CompareCommand& command) {
  std::vector<Metric> metrics = parseMetrics(command.metric);
  if (!(command.pixels_per_degree > 0.0f && command.pixels_per_degree <= 1000.0f))
    throw Error("--pixels-per-degree", "must be above 0 and at most 1000", "67 is usual");
  if (!command.heatmap.empty()) checkOutput(command.heatmap, {".png"});
  const AnyImage reference = readAny(command.reference), test = readAny(command.test);
  if (reference.index() != test.index())
    throw Error(command.test, "one image is HDR, the other is not",
                "compare two of .png, .jpg or two of .exr, .hdr");
  const Image* const ldr = std::get_if<Image>(&reference);
  const HdrImage* const hdr = std::get_if<HdrImage>(&reference);

  nlohmann::ordered_json json;
  std::vector<double> values;
  ErrorMap map;
  const auto flipMap = [&] {
    if (ldr != nullptr) {
      map = flip(*ldr, std::get<Image>(test), command.pixels_per_degree);
      return;
    }
    HdrFlip result = hdrFlip(*hdr, std::get<HdrImage>(test), command.pixels_per_degree);
    map = std::move(result.map);
    json["exposures"] = {{"start", result.start_exposure},
                         {"stop", result.stop_exposure},
                         {"count", result.exposures}};
  };
  const Timer timer;
  for (const Metric& metric : metrics) {
    const std::string name = metric.name;
    double value = 0.0;
    if (name == "flip") {
      if (map.values.empty()) flipMap();
      value = map.mean();
    } else if (name == "psnr") {
      value = ldr != nullptr ? psnr(*ldr, std::get<Image>(test))
                             : psnr(*hdr, std::get<HdrImage>(test), command.peak);
    } else {
      value =
          ldr != nullptr ? ssim(*ldr, std::get<Image>(test)) : ssim(*hdr, std::get<HdrImage>(test));
    }
    values.push_back(value);
    json[name] = number(value);
  }
  if (!command.heatmap.empty()) {
    if (map.values.empty()) flipMap();
    writePng(heatmap(map), command.heatmap);
  }
  const double seconds = timer.seconds();

  bool worse = false;
  if (command.threshold) {
    worse =
        metrics[0].more_is_worse ? values[0] > *command.threshold : values[0] < *command.threshold;
    json["threshold"] = *command.threshold;
    json["worse"] = worse;
  }
  json["width"] = ldr != nullptr ? ldr->width : hdr->width;
  json["height"] = ldr != nullptr ? ldr->height : hdr->height;
  json["seconds"] = seconds;
  if (command.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    for (std::size_t i = 0; i < metrics.size(); ++i)
      fmt::print("{}{} {:.6g}{}", i == 0 ? "" : ", ", metrics[i].name, values[i],
                 std::string_view(metrics[i].name) == "psnr" ? " dB" : "");
    fmt::print("{}\n", !command.threshold ? ""
                       : worse            ? fmt::format("; worse than {:g}", *command.threshold)
                                          : fmt::format("; within {:g}", *command.threshold));
  }
  return worse ? 1 : 0;
}

}  // namespace verdure::app
