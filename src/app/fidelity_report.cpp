// report fidelity: every light preset against the path tracer, and the crown fields against rays.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/fidelity.h"
#include "app/ground_report.h"
#include "app/page.h"
#include "base/files.h"
#include "base/progress.h"
#include "scene/display.h"
#include "verdure/compare.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/leaf_visibility.h"
#include "verdure/occlusion.h"
#include "verdure/optical_depth.h"
#include "verdure/reference.h"

namespace verdure::app {
namespace {

/// One candidate's picture of one plant under one sun.
struct Outcome {
  double flip = 0.0;      ///< mean, of what both look like at the reference's exposure
  double hdr_flip = 0.0;  ///< mean
  double frame_ms = 0.0;  ///< shadow, colour and tone passes, median of several frames
};
using Outcomes = std::array<Outcome, kCandidates.size()>;

/// What a plant's fields say about openness, against what rays find.
struct FieldCheck {
  std::vector<float> traced, metaball, depth;  ///< of the same vertices
  Agreement of_metaball, of_depth;
};

Subject makeSubject(const std::string& species, const FidelityCommand& command) {
  GrowOptions options;
  options.species = species;
  options.leaf_form = LeafForm::kCard;
  options.texture_size = 256;
  Subject subject{species, grow(options), {}, {}, {}, {}};
  subject.metaball = bakeDensity(subject.plant);
  subject.depth = bakeOpticalDepth(subject.plant);
  subject.visible = subject.depth.light;
  setLeafVisibility(subject.plant, leafVisibility(subject.plant), subject.visible);
  TransferOptions transfer;
  transfer.rays.rays = command.transfer_rays;
  transfer.rays.ground_height = 0.0f;
  subject.transfer = bakeTransfer(subject.plant, transfer);
  return subject;
}

/// An even choice of at most `count` of the plant's leaf vertices.
std::vector<VertexId> someLeafVertices(const Plant& plant, std::size_t count) {
  std::vector<VertexId> all;
  for (const VertexId& id : allVertices(plant))
    if (plant.meshes[id.mesh].kind == PartKind::kFoliage) all.push_back(id);
  if (all.size() <= count) return all;
  std::vector<VertexId> some(count);
  for (std::size_t i = 0; i < count; ++i) some[i] = all[i * all.size() / count];
  return some;
}

/// The metaball coefficient and the openness that the optical depth predicts, at leaf vertices.
FieldCheck checkFields(const Subject& subject) {
  const Plant& plant = subject.plant;
  const std::vector<VertexId> vertices = someLeafVertices(plant, 1500);
  RayOptions rays;
  rays.rays = 512;
  const std::vector<Openness> traced = traceOpenness(plant, vertices, rays);

  const std::vector<Surfel> surfels = plantSurfels(plant);
  const OpticalDepthField field(surfels, plantDepthOptions(plant, surfels));
  const std::vector<DepthSums> sums = vertexDepths(plant, surfels, field);
  std::vector<std::size_t> first_vertex;
  std::size_t total = 0;
  for (const Mesh& mesh : plant.meshes) {
    first_vertex.push_back(total);
    total += mesh.positions.size();
  }
  FieldCheck check;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const VertexId id = vertices[i];
    check.traced.push_back(traced[i].share);
    check.metaball.push_back(subject.metaball.light.meshes[id.mesh].ambient[id.vertex]);
    check.depth.push_back(
        opennessOf(sums[first_vertex[id.mesh] + id.vertex], subject.depth.report.models.leaf));
  }
  check.of_metaball = agreementOf(check.metaball, check.traced);
  check.of_depth = agreementOf(check.depth, check.traced);
  return check;
}

std::string scatterSvg(const std::vector<float>& predicted, const std::vector<float>& traced,
                       const Agreement& agreement, const std::string& label) {
  constexpr int kSize = 420;
  const auto x = [](float v) { return 55.0f + 340.0f * v; };
  const auto y = [](float v) { return 370.0f - 340.0f * v; };
  std::string out = svgOpen(kSize, kSize);
  out += fmt::format(
      "<path d='M{0:.0f} {1:.0f}H{2:.0f}V{3:.0f}H{0:.0f}Z' fill='none' stroke='#999'/>"
      "<path d='M{0:.0f} {1:.0f}L{2:.0f} {3:.0f}' stroke='#c33'/>\n<g fill='#2e6b1f' "
      "fill-opacity='0.35'>\n",
      x(0), y(0), x(1), y(1));
  for (std::size_t i = 0; i < predicted.size(); ++i)
    out +=
        fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='1.8'/>\n", x(traced[i]), y(predicted[i]));
  out += "</g>\n";
  for (const float tick : {0.0f, 0.5f, 1.0f})
    out += fmt::format(
        "<text x='{:.0f}' y='{:.0f}' text-anchor='middle' font-size='12'>{}</text>"
        "<text x='{:.0f}' y='{:.0f}' text-anchor='end' font-size='12'>{}</text>\n",
        x(tick), y(0) + 16, tick, x(0) - 6, y(tick) + 4, tick);
  return out + fmt::format(
                   "<text x='{:.0f}' y='410' text-anchor='middle'>traced openness</text>"
                   "<text transform='translate(18 {:.0f}) rotate(-90)' text-anchor='middle'>{}"
                   "</text><text x='{:.0f}' y='48'>RMS {:.3f}, rank {:.2f}</text></svg>\n",
                   x(0.5f), y(0.5f), label, x(0.03f), agreement.rms, agreement.rank);
}

/// The pictures of one plant: rows of the page and numbers for the tables.
class SubjectPictures {
 public:
  SubjectPictures(const FidelityCommand& command, Renderer& renderer, Page& page,
                  Progress& progress)
      : command_(&command), renderer_(&renderer), page_(&page), progress_(&progress) {
    std::tie(view_.width, view_.height) = parseSize(command.size);
    view_.hdr = true;
    view_.bloom = 0.0f;
  }

  std::array<Outcomes, kSuns.size()> draw(const Subject& subject) {
    const std::string& species = subject.name;
    const float aspect = static_cast<float>(view_.width) / static_cast<float>(view_.height);
    view_.camera = automaticCamera(subject.scene(kCandidates[0]), glm::radians(35.0f),
                                   glm::radians(4.0f), aspect);
    std::array<HdrImage, kSuns.size()> truth;
    for (std::size_t s = 0; s < kSuns.size(); ++s) {
      progress_->show(fmt::format("{}: reference, {}", species, kSuns[s].name));
      truth[s] = reference(subject, s);
    }
    std::array<std::array<HdrImage, kSuns.size()>, kCandidates.size()> pictures;
    std::array<Outcomes, kSuns.size()> outcomes{};
    for (std::size_t c = 0; c < kCandidates.size(); ++c) {
      progress_->show(fmt::format("{}: {}", species, kCandidates[c].name));
      renderer_->setScene(subject.scene(kCandidates[c]));
      view_.terms = kCandidates[c].terms;
      for (std::size_t s = 0; s < kSuns.size(); ++s)
        std::tie(pictures[c][s], outcomes[s][c].frame_ms) = frame(s);
    }
    for (std::size_t s = 0; s < kSuns.size(); ++s) {
      progress_->show(fmt::format("{}: comparing", species));
      compare(species, s, truth[s], pictures, outcomes[s]);
    }
    return outcomes;
  }

 private:
  HdrImage reference(const Subject& subject, std::size_t sun) const {
    ReferenceOptions options;
    options.width = view_.width;
    options.height = view_.height;
    options.camera = view_.camera;
    options.samples = command_->samples;
    return renderReference(subject.scene(kCandidates[0]), kSuns[sun].daylight(), options).image;
  }

  /// The picture and its time.
  std::pair<HdrImage, double> frame(std::size_t sun) {
    view_.daylight = kSuns[sun].daylight();
    std::array<double, 3> times{};
    HdrImage image;
    for (double& time : times) {
      Frame drawn = renderer_->render(view_);
      time = drawn.times.shadow_ms + drawn.times.color_ms + drawn.times.tone_ms;
      image = std::move(drawn.hdr);
    }
    std::sort(times.begin(), times.end());
    return {std::move(image), times[1]};
  }

  void compare(const std::string& species, std::size_t sun, const HdrImage& truth,
               const std::array<std::array<HdrImage, kSuns.size()>, kCandidates.size()>& pictures,
               Outcomes& outcomes) {
    const Exposure exposure;
    const float average = averageLuminance(truth);
    const float white = automaticWhite(truth, average, exposure.key);
    const auto show = [&](const HdrImage& image) {
      return displayed(image, average, exposure.key, white);
    };
    const Image shown_truth = show(truth);
    const std::string prefix = fmt::format("{}-{}", species, sun + 1);
    page_->beginRow();
    page_->picture(prefix + "-reference", shown_truth,
                   fmt::format("path-traced, {}", kSuns[sun].name));
    std::array<ErrorMap, kCandidates.size()> maps;
    for (std::size_t c = 0; c < kCandidates.size(); ++c) {
      const Image shown = show(pictures[c][sun]);
      maps[c] = flip(shown_truth, shown);
      outcomes[c].flip = maps[c].mean();
      outcomes[c].hdr_flip = hdrFlip(truth, pictures[c][sun]).map.mean();
      page_->picture(fmt::format("{}-{}", prefix, c + 1), shown,
                     fmt::format("{}: FLIP {:.3f}, HDR-FLIP {:.3f}", kCandidates[c].name,
                                 outcomes[c].flip, outcomes[c].hdr_flip));
    }
    page_->endRow();
    page_->beginRow();
    page_->paragraph("");
    for (std::size_t c = 0; c < kCandidates.size(); ++c)
      page_->picture(fmt::format("{}-{}-flip", prefix, c + 1), heatmap(maps[c]),
                     fmt::format("FLIP of {}", kCandidates[c].name));
    page_->endRow();
  }

  const FidelityCommand* command_;
  Renderer* renderer_;
  Page* page_;
  Progress* progress_;
  View view_;
};

/// Rows of "species, sun | candidates' values", with the mean in the last, and that over the mean
/// of the first candidate.
std::vector<std::vector<std::string>> tableOf(const std::vector<std::string>& labels,
                                              const std::vector<Outcomes>& all,
                                              double Outcome::*value, const char* format) {
  std::vector<std::vector<std::string>> rows{{"plant, sun"}};
  for (const Candidate& candidate : kCandidates) rows[0].emplace_back(candidate.name);
  std::array<double, kCandidates.size()> sums{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    rows.push_back({labels[i]});
    for (std::size_t c = 0; c < kCandidates.size(); ++c) {
      rows.back().push_back(fmt::format(fmt::runtime(format), all[i][c].*value));
      sums[c] += all[i][c].*value;
    }
  }
  rows.push_back({"<b>mean</b>"});
  for (const double sum : sums)
    rows.back().push_back(fmt::format(fmt::runtime(format), sum / static_cast<double>(all.size())));
  rows.push_back({"<b>relative to standard</b>"});
  for (const double sum : sums) rows.back().push_back(fmt::format("{:.2f}", sum / sums[0]));
  return rows;
}

std::array<double, kCandidates.size()> meanFlips(const std::vector<Outcomes>& all) {
  std::array<double, kCandidates.size()> means{};
  for (const Outcomes& outcomes : all)
    for (std::size_t c = 0; c < kCandidates.size(); ++c)
      means[c] += outcomes[c].flip / static_cast<double>(all.size());
  return means;
}

nlohmann::ordered_json jsonOf(const std::vector<std::string>& labels,
                              const std::vector<Outcomes>& all) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t c = 0; c < kCandidates.size(); ++c)
      rows.push_back({{"picture", labels[i]},
                      {"light", kCandidates[c].name},
                      {"flip", all[i][c].flip},
                      {"hdr_flip", all[i][c].hdr_flip},
                      {"frame_ms", all[i][c].frame_ms}});
  return rows;
}

}  // namespace

void runFidelityReport(const FidelityCommand& command) {
  std::vector<std::string> species = command.species;
  if (species.empty())
    species = {"black-oak",  "quaking-aspen",  "silver-birch",
               "scots-pine", "japanese-maple", "weeping-willow"};
  for (const std::string& name : species) speciesParameters(name);  // throws if there is none
  if (command.samples < 1) throw Error("--samples", "must be at least 1", "96 is usual");

  Progress progress("report fidelity");
  progress.show("device");
  Renderer renderer(command.device);
  Page page(
      command.output, "Fidelity of the light presets",
      fmt::format("Each preset against the path tracer ({} samples a pixel, up to 32 bounces) "
                  "under the same sky, sun and exposure, on {}. FLIP: 0 = equal, 1 = as "
                  "different as can be.",
                  command.samples, renderer.deviceName()));
  const auto [width, height] = parseSize(command.size);
  const int pixels = width * height / 2;  // of each picture of the ground
  std::vector<std::string> labels;
  std::vector<Outcomes> all;
  std::vector<GroundPicture> ground;
  nlohmann::ordered_json fields = nlohmann::ordered_json::array();
  std::vector<std::vector<std::string>> field_rows{
      {"plant", "metaball: RMS", "rank", "optical depth: RMS", "rank"}};
  for (const std::string& name : species) {
    progress.show(name + ": baking");
    const Subject subject = makeSubject(name, command);
    page.heading(name);
    const auto outcomes = SubjectPictures(command, renderer, page, progress).draw(subject);
    for (std::size_t s = 0; s < kSuns.size(); ++s) {
      labels.push_back(fmt::format("{}, {}", name, kSuns[s].name));
      all.push_back(outcomes[s]);
    }
    for (GroundPicture& picture :
         measureGround(subject, pixels, command.samples, renderer, page, progress))
      ground.push_back(std::move(picture));
    progress.show(name + ": openness");
    const FieldCheck check = checkFields(subject);
    page.beginRow();
    page.svg(name + "-metaball",
             scatterSvg(check.metaball, check.traced, check.of_metaball, "metaball coefficient"),
             "the metaball field's ambient coefficient against traced openness");
    page.svg(name + "-optical-depth",
             scatterSvg(check.depth, check.traced, check.of_depth, "openness from optical depth"),
             "openness predicted by the optical-depth field against traced openness");
    page.endRow();
    field_rows.push_back({name, fmt::format("{:.3f}", check.of_metaball.rms),
                          fmt::format("{:.2f}", check.of_metaball.rank),
                          fmt::format("{:.3f}", check.of_depth.rms),
                          fmt::format("{:.2f}", check.of_depth.rank)});
    fields.push_back({{"plant", name},
                      {"metaball_rms", check.of_metaball.rms},
                      {"metaball_rank", check.of_metaball.rank},
                      {"optical_depth_rms", check.of_depth.rms},
                      {"optical_depth_rank", check.of_depth.rank}});
  }

  const auto means = meanFlips(all);
  const auto best =
      static_cast<std::size_t>(std::min_element(means.begin(), means.end()) - means.begin());
  const std::string verdict =
      fmt::format("closest to the reference: {} (mean FLIP {:.3f}, {:.2f} of standard's {:.3f})",
                  kCandidates[best].name, means[best], means[best] / means[0], means[0]);
  page.heading("Tables");
  page.paragraph("<b>" + verdict + "</b>");
  page.paragraph("Mean FLIP at the reference's exposure");
  page.table(tableOf(labels, all, &Outcome::flip, "{:.4f}"));
  page.paragraph("Mean HDR-FLIP");
  page.table(tableOf(labels, all, &Outcome::hdr_flip, "{:.4f}"));
  page.paragraph(
      "Frame time, ms (median of three; on a software driver this says nothing about "
      "GPUs)");
  page.table(tableOf(labels, all, &Outcome::frame_ms, "{:.1f}"));
  addGroundTables(page, ground);
  page.paragraph("Openness of leaf vertices against 512 rays each");
  page.table(field_rows);
  page.write();
  const nlohmann::ordered_json json{
      {"device", renderer.deviceName()},   {"samples", command.samples},
      {"closest", kCandidates[best].name}, {"pictures", jsonOf(labels, all)},
      {"ground", groundJson(ground)},      {"openness", fields}};
  writeFile(page.folder() / "fidelity.json", json.dump(2) + "\n");
  progress.show("done");
  if (command.json)
    fmt::print("{}\n", json.dump(2));
  else
    fmt::print("{}: {}\n", (page.folder() / "index.html").string(), verdict);
}

}  // namespace verdure::app
