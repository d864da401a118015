// figures sky (Figures 5.3 to 5.7 of Habel 2009), and sky --report (those up to 5.5).
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/page.h"
#include "app/sky_pictures.h"
#include "app/sky_scenes.h"
#include "base/files.h"
#include "base/progress.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/sky_fit.h"

namespace verdure::app {
namespace {

constexpr int kPanoramaHeight = 320;

Light lightOf(const Harmonics& harmonics) {
  return [&harmonics](const glm::vec3& d) { return valueAt(harmonics, d); };
}

std::string svgText(float x, float y, const std::string& text, const char* more = "") {
  return fmt::format("<text x='{:.0f}' y='{:.0f}' {}>{}</text>\n", x, y, more, text);
}

/// Fig. 5.4: the errors over the number of bands, in powers of ten.
std::string errorPlot(const SkyFitErrors& errors, int bands) {
  constexpr float kLeft = 90.0f, kTop = 30.0f, kWidth = 440.0f, kHeight = 300.0f;
  constexpr int kLow = -6, kHigh = -1;
  const auto x = [&](int n) {
    return kLeft + kWidth * (static_cast<float>(n) - 0.5f) / static_cast<float>(bands);
  };
  const auto y = [](double error) {
    const double power =
        std::clamp(std::log10(std::max(error, 1e-30)), double{kLow}, double{kHigh});
    return kTop + kHeight * static_cast<float>((kHigh - power) / (kHigh - kLow));
  };
  std::string out = svgOpen(600, 400);
  for (int power = kLow; power <= kHigh; ++power) {
    const float at = y(std::pow(10.0, power));
    out += fmt::format("<path d='M{:.0f} {:.1f}h{:.0f}' stroke='#ddd'/>\n", kLeft, at, kWidth);
    out += svgText(kLeft - 8, at + 5, fmt::format("{:g} %", std::pow(10.0, power + 2)),
                   "text-anchor='end'");
  }
  for (int n = 1; n <= bands; ++n)
    out += svgText(x(n), kTop + kHeight + 22, std::to_string(n), "text-anchor='middle'");
  out += svgText(kLeft + kWidth / 2, kTop + kHeight + 46, "bands", "text-anchor='middle'");
  const auto line = [&](const std::array<double, kMaxBands>& values, const char* color,
                        const char* name, float name_y) {
    out += fmt::format("<polyline fill='none' stroke='{}' stroke-width='2' points='", color);
    for (int n = 1; n <= bands; ++n)
      out += fmt::format("{:.1f},{:.1f} ", x(n), y(values[static_cast<std::size_t>(n - 1)]));
    out += "'/>\n";
    for (int n = 1; n <= bands; ++n)
      out += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='{}'/>\n", x(n),
                         y(values[static_cast<std::size_t>(n - 1)]), color);
    out += svgText(kLeft + 12, name_y, name, fmt::format("fill='{}'", color).c_str());
  };
  line(errors.maximal, "#b03020", "maximal, (5.3)", kTop + 20);
  line(errors.mean, "#2050a0", "mean, (5.4)", kTop + 40);
  return out + "</svg>\n";
}

/// The green of several functions in the vertical plane through the sun, over elevation.
std::string ringingPlot(const Harmonics& plain, const Harmonics& filtered, const Sky& sky,
                        float sun_azimuth) {
  const auto direction = [&](int degree) {  // 0: nadir on the sun's side ... 180: zenith
    const float e = glm::radians(static_cast<float>(degree - 90));
    return glm::vec3(std::cos(e) * std::sin(sun_azimuth), std::sin(e),
                     std::cos(e) * std::cos(sun_azimuth));
  };
  float top = 0.0f, bottom = 0.0f;
  for (int i = 0; i <= 180; ++i) {
    top = std::max({top, valueAt(plain, direction(i)).g, valueAt(filtered, direction(i)).g});
    bottom = std::min({bottom, valueAt(plain, direction(i)).g, valueAt(filtered, direction(i)).g});
  }
  top *= 1.25f;
  const auto x = [](int i) { return 70.0f + 2.7f * static_cast<float>(i); };
  const auto y = [&](float v) {
    return 30.0f + 300.0f * (top - std::clamp(v, bottom, top)) / (top - bottom);
  };
  std::string out = svgOpen(600, 400);
  out += fmt::format("<path d='M70 {:.1f}H556M{:.1f} 30V330' stroke='#bbb'/>\n", y(0.0f), x(90));
  for (const int degree : {-90, -45, 0, 45, 90})
    out += svgText(x(degree + 90), 352, fmt::format("{}°", degree), "text-anchor='middle'");
  out += svgText(313, 376, "elevation below and above the sun's azimuth", "text-anchor='middle'");
  out += svgText(62, y(0.0f) + 5, "0", "text-anchor='end'");
  const auto line = [&](const Light& light, const char* style, const char* name, float name_y) {
    out += fmt::format("<polyline fill='none' {} points='", style);
    for (int i = 0; i <= 180; ++i)
      out += fmt::format("{:.1f},{:.1f} ", x(i), y(light(direction(i)).g));
    out += fmt::format("'/><path d='M84 {0:.0f}h30' {1}/>\n", name_y - 5, style);
    out += svgText(122, name_y, name);
  };
  line([&](const glm::vec3& d) { return sky.luminance(d); }, "stroke='#999' stroke-width='1.5'",
       "sky", 50);
  line(lightOf(plain), "stroke='#b03020' stroke-width='2'", "harmonics", 72);
  line(lightOf(filtered), "stroke='#2050a0' stroke-width='2'", "filtered, (5.5)", 94);
  return out + "</svg>\n";
}

/// 128 where both agree, in units of `step` for each level of gray.
Image differencePicture(const HdrImage& a, const HdrImage& b, float step) {
  Image out(a.width, a.height);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const glm::vec3 d = (b.rgb[i] - a.rgb[i]) / step;
    for (int c = 0; c < 3; ++c)
      out.rgba[4 * i + static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::clamp(128.0f + d[c], 0.0f, 255.0f));
    out.rgba[4 * i + 3] = 255;
  }
  return out;
}

}  // namespace

void runSkyFigures(const FiguresCommand& command) {
  speciesParameters(command.species);  // both throw before anything is written
  parseSize(command.size);
  SkyReport report;
  report.folder = command.output;
  report.scenes = command;
  writeSkyReport(report);
}

void writeSkyReport(const SkyReport& report) {
  std::optional<Renderer> renderer;
  if (report.scenes) renderer.emplace(report.scenes->device);
  Page page(report.folder, "Skylight models for lighting with spherical harmonics",
            fmt::format("Figures 5.3 to {} of Habel, Real-Time Rendering and Animation of "
                        "Vegetation (2009). The panoramas show all directions, north in the "
                        "middle.",
                        renderer ? "5.7" : "5.5"));
  Progress progress("sky");
  progress.show("fitting");
  SkyFitOptions options;
  options.bands = report.bands;
  const SkyModel model = preethamModel();
  const SkyFit fit(model, options);
  progress.show("measuring");
  const SkyFitErrors errors = measureSkyFit(fit, model);
  progress.show("drawing");

  // Fig. 5.3, at the thesis' worst case and at ours.
  const auto compare = [&](const std::string& name, float zenith, float turbidity,
                           const std::string& title) {
    const Harmonics truth = projectSky(*model(zenith, turbidity), report.bands);
    const Harmonics fitted = fit.atZenithAngle(zenith, turbidity);
    const HdrImage a = drawPanorama(lightOf(truth), kPanoramaHeight);
    const HdrImage b = drawPanorama(lightOf(fitted), kPanoramaHeight);
    const float mean = meanLuminance(a), step = mean * 1e-6f;
    page.heading(title);
    page.beginRow();
    page.picture(name + "a", toneMapped(a, mean), "correct: projected");
    page.picture(name + "b", toneMapped(b, mean), "reconstructed: the fit");
    page.picture(name + "c", differencePicture(a, b, step),
                 "difference: a level of gray is a millionth of the mean");
    page.endRow();
  };
  compare("figure53", glm::half_pi<float>(), 6.0f,
          fmt::format("Figure 5.3: the thesis' worst case, N = {}, θs = 90°, τ = 6", report.bands));
  compare("figure53-worst", errors.worst_sun_zenith, errors.worst_turbidity,
          fmt::format("... and the worst case of this fit, θs = {:.0f}°, τ = {:.2f}",
                      glm::degrees(errors.worst_sun_zenith), errors.worst_turbidity));

  page.heading("Figure 5.4: highest upper bound of the errors");
  page.beginRow();
  page.svg("figure54", errorPlot(errors, report.bands),
           fmt::format("over θs 0 to 90° and τ {:g} to {:g}, of L_min = {:.3f} kcd/m²",
                       options.turbidity_min, options.turbidity_max, errors.least_weight));
  page.endRow();

  page.heading("Figure 5.5: ringing below the horizon");
  const auto ring = [&](const std::string& name, const glm::vec3& to_sun) {
    const Daylight light = preethamDaylight(report.turbidity, to_sun);
    const Harmonics plain = projectSky(*light.sky, report.bands);
    const Harmonics filtered = withoutRinging(plain);
    const HdrImage picture = drawPanorama(lightOf(plain), kPanoramaHeight);
    const float mean = meanLuminance(picture);
    page.paragraph(fmt::format("Sun {:.0f}° high, τ = {:g}.",
                               glm::degrees(std::asin(light.sun.direction.y)), report.turbidity));
    page.beginRow();
    page.picture(name + "a", toneMapped(picture, mean), "original");
    page.picture(name + "b", toneMapped(drawPanorama(lightOf(filtered), kPanoramaHeight), mean),
                 "filtered, (5.5)");
    page.svg(name + "c", ringingPlot(plain, filtered, *light.sky, std::atan2(to_sun.x, to_sun.z)),
             "green in the vertical plane through the sun");
    page.endRow();
  };
  ring("figure55", report.to_sun);
  // A low sun's ringing is not zonal: the filter does little about it.
  ring("figure55-low", {0.0f, std::sin(glm::radians(10.0f)), std::cos(glm::radians(10.0f))});

  nlohmann::ordered_json json = {{"bands", report.bands},
                                 {"sun_degree", options.sun_degree},
                                 {"turbidity_degree", options.turbidity_degree},
                                 {"turbidity", {options.turbidity_min, options.turbidity_max}},
                                 {"bytes", fit.coefficients().size_bytes()},
                                 {"least_weight", errors.least_weight},
                                 {"worst_sun_zenith_deg", glm::degrees(errors.worst_sun_zenith)},
                                 {"worst_turbidity", errors.worst_turbidity}};
  for (int n = 1; n <= report.bands; ++n)
    json["errors"].push_back({{"bands", n},
                              {"maximal", errors.maximal[static_cast<std::size_t>(n - 1)]},
                              {"mean", errors.mean[static_cast<std::size_t>(n - 1)]}});
  writeFile(page.folder() / "report.json", json.dump(2) + "\n");
  if (renderer) addSkyScenes(*report.scenes, page, progress, *renderer);
  page.write();
  progress.show("done");
  fmt::print("{}\n", (page.folder() / "index.html").string());
}

}  // namespace verdure::app
