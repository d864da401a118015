// report motion.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/page.h"
#include "app/plot.h"
#include "base/files.h"
#include "base/progress.h"
#include "motion/beam.h"
#include "motion/large_deflection.h"
#include "motion/motion_tables.h"
#include "motion/motion_texture.h"
#include "motion/spectrum.h"
#include "shared/beam.h"
#include "verdure/grow.h"
#include "verdure/plant_io.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

/// A branch of length 1 along x, bent by `amplitude`: its axis at `count` + 1 places.
std::vector<glm::dvec2> bentByShader(const glm::vec2& fit, float amplitude, int count) {
  const shared::BeamFrame frame{{0, 0, 0}, 1.0f, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= count; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(count);
    const glm::vec3 p =
        shared::posedPoint(shared::poseOfBeam(frame, fit, x, {amplitude, 0.0f}), {x, 0.0f, 0.0f});
    points.emplace_back(p.x, p.y);
  }
  return points;
}

/// Figure 4.8.
void addTapers(Page& page) {
  Plot plot({0.0, 1.0, "x, lengths"}, {0.0, 0.3, "u for E'F / r_1^4 = 1"});
  for (const double taper : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    std::vector<glm::dvec2> exact;
    for (int i = 0; i <= 50; ++i) {
      const double x = 0.02 * i;
      exact.emplace_back(x, beamDeflectionExact(taper, x));
    }
    plot.curve(fmt::format("taper {}", taper), exact);
  }
  page.svg("figure4-8", plot.svg(), "Fig. 4.8: deflection by taper, (4.7)");
}

/// Figure 4.10, and what large deflections are. Returns the table's numbers.
Json addDeflections(Page& page) {
  constexpr int kCount = 200;
  Plot plot({0.0, 1.05, "along the axis at rest, lengths"}, {0.0, 0.8, "aside, lengths"});
  const double taper = 0.3;
  const glm::vec2 fit(fitBeam(taper));
  const float full = shared::beamDeflection(fit, 1.0f);
  std::vector<glm::dvec2> plain;
  for (int i = 0; i <= kCount; ++i) {
    const float x = static_cast<float>(i) / kCount;
    plain.emplace_back(x, 0.6f * shared::beamDeflection(fit, x) / full);
  }
  plot.curve("without length correction", plain, true);
  const auto corrected = bentByShader(fit, 0.6f / full, kCount);
  plot.curve("verdure", corrected);
  plot.curve("large deflections", bentBeam(taper, corrected.back().y, kCount));
  page.svg("figure4-10", plot.svg(),
           "Fig. 4.10: a strongly deflected beam (taper 0.3, amplitude 0.6 of its length), and the "
           "beam that the theory of large deflections bends as far");

  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{{"taper", "tip aside, lengths", "length",
                                               "farthest from the theory, lengths",
                                               "tip's angle off, degrees"}};
  for (const double alpha : {0.2, 0.5, 1.0})
    for (const double tip : {0.1, 0.3, 0.5}) {
      const glm::vec2 c(fitBeam(alpha));
      // The amplitude that brings the tip there.
      float low = 0.0f, high = 2.0f / shared::beamDeflection(c, 1.0f);
      for (int i = 0; i < 40; ++i) {
        const float middle = 0.5f * (low + high);
        (bentByShader(c, middle, 1).back().y < tip ? low : high) = middle;
      }
      const auto ours = bentByShader(c, high, kCount);
      const auto truth = bentBeam(alpha, tip, kCount);
      double length = 0.0, farthest = 0.0;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        farthest = std::max(farthest, glm::length(ours[i] - truth[i]));
        if (i > 0) length += glm::length(ours[i] - ours[i - 1]);
      }
      const auto angle = [](const std::vector<glm::dvec2>& points) {
        const glm::dvec2 d = points.back() - points[points.size() - 2];
        return glm::degrees(std::atan2(d.y, d.x));
      };
      const double off = angle(ours) - angle(truth);
      rows.push_back({{"taper", alpha},
                      {"tip", tip},
                      {"length", length},
                      {"farthest", farthest},
                      {"angle_deg", off}});
      table.push_back({fmt::format("{}", alpha), fmt::format("{}", tip),
                       fmt::format("{:.4f}", length), fmt::format("{:.4f}", farthest),
                       fmt::format("{:+.1f}", off)});
    }
  page.paragraph("The axis against large-deflection theory, with the tips equally far aside:");
  page.table(table);
  return rows;
}

/// How a branch moves with a texture, and how an oscillator in wind would.
struct MeasuredBranch {
  std::vector<double> power;
  double error = 0.0, peak = 0.0, true_peak = 0.0;
};
constexpr int kRecord = 512, kBins = 205;
constexpr double kBinsPerResonance = kRecord / 10.0;

double truePower(const BranchOscillator& branch, std::size_t bin) {
  const double a =
      branchResponse(branch, branch.frequency_hz * static_cast<double>(bin) / kBinsPerResonance);
  return a * a;
}

MeasuredBranch measure(const BranchOscillator& branch, MotionLayout layout) {
  Spectrum spectrum(kRecord, kBins);
  MotionTextureOptions options;
  options.layout = layout;
  const MotionTexture texture = makeMotionTexture(branch, options);
  const double step = 1.0 / (10.0 * branch.frequency_hz);
  for (std::uint64_t i = 0; i < 150; ++i) {
    const auto trajectory = makeTrajectory(texture, branch.frequency_hz, i);
    for (int channel = 0; channel < 2; ++channel)
      spectrum.add([&](int k) {
        const MotionTime time = motionTime(37.0 * static_cast<double>(i) + k * step);
        return double{
            texture.sample(shared::motionUv(trajectory, time.whole, time.fraction), channel)};
      });
  }
  MeasuredBranch out{spectrum.power};
  out.error = spectrum.errorTo([&](std::size_t bin) { return truePower(branch, bin); });
  const auto peak = [](const auto& power) {
    std::size_t best = 8;
    for (std::size_t bin = 8; bin < kBins; ++bin)
      if (power(bin) > power(best)) best = bin;
    return static_cast<double>(best) / kBinsPerResonance;
  };
  out.peak = peak([&](std::size_t bin) { return spectrum.power[bin]; });
  out.true_peak = peak([&](std::size_t bin) { return truePower(branch, bin); });
  return out;
}

/// Part of a texture as grey.
Image partOf(const MotionTexture& texture, int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * texture.width + x) *
                      static_cast<std::size_t>(texture.channels);
      const float grey = glm::clamp(0.5f + 0.18f * texture.values[at], 0.0f, 1.0f);
      const std::size_t pixel = 4 * static_cast<std::size_t>(y * width + x);
      for (std::size_t c = 0; c < 3; ++c)
        image.rgba[pixel + c] = static_cast<std::uint8_t>(std::lround(255.0f * grey));
      image.rgba[pixel + 3] = 255;
    }
  return image;
}

/// Figure 4.14, for both constructions. Returns the errors.
Json addSpectra(Page& page, Progress& progress) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{
      {"damping ratio", "texture", "L1 error", "peak, f_h", "the formula's peak, f_h"}};
  for (const double damping : {0.1, 0.2, 1.5}) {
    const BranchOscillator branch{1.0, damping, 5.0};
    Plot plot({0.1, 4.0, "frequency, f_h", true}, {1e-4, 10.0, "power", true});
    std::vector<glm::dvec2> truth;
    double sum = 0.0;
    for (std::size_t bin = 1; bin < kBins; ++bin) sum += truePower(branch, bin);
    for (std::size_t bin = 1; bin < kBins; ++bin)
      truth.emplace_back(static_cast<double>(bin) / kBinsPerResonance,
                         100.0 * truePower(branch, bin) / sum);
    plot.curve("oscillator in wind", truth, true);
    for (const auto& [layout, name] : {std::pair(MotionLayout::kSeparable, "separable"),
                                       std::pair(MotionLayout::kRadial, "radial (thesis)")}) {
      progress.show(fmt::format("spectra: damping ratio {}, {}", damping, name));
      const MeasuredBranch measured = measure(branch, layout);
      double total = 0.0;
      for (std::size_t bin = 1; bin < kBins; ++bin) total += measured.power[bin];
      std::vector<glm::dvec2> curve;
      for (std::size_t bin = 1; bin < kBins; ++bin)
        curve.emplace_back(static_cast<double>(bin) / kBinsPerResonance,
                           100.0 * measured.power[bin] / total);
      plot.curve(name, curve);
      rows.push_back({{"damping_ratio", damping},
                      {"texture", name},
                      {"l1_error", measured.error},
                      {"peak", measured.peak},
                      {"true_peak", measured.true_peak}});
      table.push_back({fmt::format("{}", damping), name, fmt::format("{:.3f}", measured.error),
                       fmt::format("{:.2f}", measured.peak),
                       fmt::format("{:.2f}", measured.true_peak)});
    }
    const std::string number = fmt::format("figure4-14-{:.0f}", damping * 10.0);
    page.beginRow();
    page.svg(number, plot.svg(),
             fmt::format("Fig. 4.14: spectra along trajectories, damping ratio {}", damping));
    MotionTextureOptions separable, radial;
    radial.layout = MotionLayout::kRadial;
    page.picture(number + "-separable", partOf(makeMotionTexture(branch, separable), 380, 380),
                 "part of the separable texture: time runs to the right");
    page.picture(number + "-radial", partOf(makeMotionTexture(branch, radial), 380, 380),
                 "part of the thesis's");
    page.endRow();
  }
  page.table(table);
  return rows;
}

/// What moves, level by level. Returns its numbers.
Json addLevels(Page& page, const Plant& plant, const PlantMotion& motion) {
  constexpr std::array<float, 4> kSpeeds{2.0f, 5.0f, 10.0f, 20.0f};
  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{{"level", "branches", "median length, m",
                                               "median f_h, Hz",
                                               "RMS tip at 2, 5, 10, 20 m/s, lengths"}};
  for (int level = 0; level < kMotionLevels; ++level) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t b = 0; b < motion.tree.branches.size(); ++b)
      if (motion.tree.branches[b].level == level) members.push_back(b);
    if (members.empty()) continue;
    const auto median = [&](const auto& value) {
      std::vector<float> values;
      for (const std::uint32_t b : members) values.push_back(value(b));
      std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                       values.end());
      return values[values.size() / 2];
    };
    const float length = median([&](auto b) { return motion.tree.branches[b].length; });
    const float frequency = median([&](auto b) { return motion.branches[b].frequency_hz; });
    std::string tips;
    Json rms = Json::array();
    for (const float speed : kSpeeds) {
      double sum = 0.0, count = 0.0;
      for (int k = 0; k < 24; ++k) {
        const auto amplitudes = branchAmplitudes(motion, {.speed = speed}, 7.3 * k);
        for (const std::uint32_t b : members) {
          const MotionBranch& branch = motion.tree.branches[b];
          const double tip =
              double{glm::length(amplitudes[b]) * (branch.fit.x + branch.fit.y) / branch.length};
          sum += tip * tip;
          count += 1.0;
        }
      }
      rms.push_back(std::sqrt(sum / count));
      tips += fmt::format("{}{:.3f}", tips.empty() ? "" : ", ", std::sqrt(sum / count));
    }
    rows.push_back({{"level", level},
                    {"branches", members.size()},
                    {"median_length_m", length},
                    {"median_frequency_hz", frequency},
                    {"rms_tip", rms}});
    table.push_back({std::to_string(level), std::to_string(members.size()),
                     fmt::format("{:.2f}", length), fmt::format("{:.2f}", frequency), tips});
  }
  page.paragraph(fmt::format("The branches of {}:", plant.name));
  page.table(table);
  return rows;
}

void addFrames(Page& page, const Plant& plant, const PlantMotion& motion, const View& base,
               Renderer& renderer, Progress& progress) {
  Scene scene;
  scene.items.push_back({.plant = &plant, .motion = &motion});
  View view = base;
  const Bounds box = bounds(plant);
  scene.ground_height = box.min.y;
  view.camera = automaticCamera(scene, glm::radians(35.0f), glm::radians(4.0f),
                                static_cast<float>(view.width) / static_cast<float>(view.height));
  renderer.setScene(scene);
  for (const float speed : {6.0f, 16.0f}) {
    page.paragraph(fmt::format("Wind of {} m/s from the left, every quarter of a second:", speed));
    page.beginRow();
    for (int k = 0; k < 5; ++k) {
      progress.show(fmt::format("frames at {} m/s", speed), 0.2 * k);
      view.wind = {.speed = speed, .from = glm::radians(305.0f)};
      view.seconds = 20.0 + 0.25 * k;
      page.picture(fmt::format("tree-{:.0f}-{}", speed, k), renderer.render(view).image,
                   fmt::format("{:.2f} s", view.seconds));
    }
    page.endRow();
  }
}

}  // namespace

void runMotionReport(const MotionReportCommand& command) {
  Progress progress("report motion");
  View view;
  std::tie(view.width, view.height) = parseSize(command.size);
  view.daylight = daylightOf({});
  view.terms = presetTerms("habel");
  view.terms.ambient_source = AmbientSource::kSky;
  Renderer renderer(command.device);
  progress.show("growing");
  Plant plant;
  if (command.input.empty()) {
    GrowOptions birch;
    birch.species = "silver-birch";
    birch.seed = 3;
    plant = grow(birch);
  } else {
    plant = loadPlant(command.input, {});
  }
  const PlantMotion motion = motionFor(plant);
  Page page(command.output, "Motion",
            "Trees in wind (Habel 2009, chapter 4), measured; pictures drawn on " +
                renderer.deviceName() + ".");
  page.heading("Beams");
  addTapers(page);
  Json json;
  json["beams"] = addDeflections(page);
  page.heading("Spectra");
  json["spectra"] = addSpectra(page, progress);
  page.heading("A tree");
  json["levels"] = addLevels(page, plant, motion);
  addFrames(page, plant, motion, view, renderer, progress);
  page.write();
  writeFile(page.folder() / "motion.json", json.dump(2) + "\n");
  progress.show("done");
  if (command.json)
    fmt::print("{}\n", json.dump(2));
  else
    fmt::print("{}\n", (page.folder() / "index.html").string());
}

}  // namespace verdure::app
