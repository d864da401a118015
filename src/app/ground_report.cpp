#include "app/ground_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "shared/color.h"
#include "shared/illumination.h"
#include "verdure/compare.h"
#include "verdure/reference.h"

namespace verdure::app {
namespace {

constexpr float kShadowBelow = 0.9f, kOpenAbove = 0.99f;  ///< of open ground's irradiance
/// Irradiances below this share of open ground's count as this much where one is divided by.
constexpr float kLeastIrradiance = 1e-3f;
/// The renderer shades a pixel's middle, the path tracer its area: the renderer draws this many
/// pixels for one, along each side, and their mean is measured, as what reaches that patch of
/// ground.
constexpr int kFiner = 4;
const glm::vec3 kLuma(0.2126f, 0.7152f, 0.0722f);

/// From nearly straight above, the picture's x away from the sun, all of the plant's shadow.
View viewOfShadow(const Plant& plant, const SunPosition& sun, int pixels) {
  View view;
  view.hdr = true;
  view.bloom = 0.0f;
  view.daylight = sun.daylight();
  const glm::vec3 to_sun = view.daylight.sun.direction;
  const glm::vec3 away = -glm::normalize(glm::vec3(to_sun.x, 0.0f, to_sun.z));
  const glm::vec3 aside = glm::cross(glm::vec3(0, 1, 0), away);
  glm::vec2 low(std::numeric_limits<float>::max()), high(-low);
  for (const Mesh& mesh : plant.meshes)
    for (const glm::vec3& p : mesh.positions) {
      const glm::vec3 shadow = p - to_sun * (std::max(p.y, 0.0f) / to_sun.y);
      const glm::vec2 at(glm::dot(shadow, away), glm::dot(shadow, aside));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  // A quarter of its breadth around it: the ground there loses some of the sky.
  const glm::vec2 size = (high - low) + 0.5f * (high.y - low.y);
  const float aspect = size.x / size.y;
  view.height =
      std::max(static_cast<int>(std::lround(std::sqrt(static_cast<float>(pixels) / aspect))), 16);
  view.width = static_cast<int>(std::lround(static_cast<float>(view.height) * aspect));
  const glm::vec2 middle = 0.5f * (low + high);
  view.camera.target = away * middle.x + aside * middle.y;
  view.camera.vertical_fov = 0.1f;
  const float distance = 0.5f * size.y / std::tan(0.5f * view.camera.vertical_fov);
  // Right of a camera that looks down from the side of `b` is up x b: `away` for away x up.
  const glm::vec3 from = glm::cross(away, glm::vec3(0, 1, 0));
  view.camera.eye =
      view.camera.target + distance * glm::normalize(glm::vec3(0, 1, 0) + 0.03f * from);
  return view;
}

/// Irradiance over open ground's, for each pixel.
using Irradiance = std::vector<glm::vec3>;

Irradiance divided(const HdrImage& light, const HdrImage& open) {
  Irradiance out(light.rgb.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = light.rgb[i] / open.rgb[i];
  return out;
}

/// Each pixel the mean of kFiner x kFiner.
HdrImage coarser(const HdrImage& fine) {
  HdrImage out(fine.width / kFiner, fine.height / kFiner);
  for (int y = 0; y < out.height * kFiner; ++y)
    for (int x = 0; x < out.width * kFiner; ++x)
      out.at(x / kFiner, y / kFiner) += fine.at(x, y) * (1.0f / (kFiner * kFiner));
  return out;
}

/// The path tracer's, twice, with other random numbers.
struct Truth {
  std::array<Irradiance, 2> halves;
  Irradiance mean;
  glm::vec3 open{0.0f};     ///< irradiance of open ground, klx
  HdrImage open_luminance;  ///< of open ground, kcd/m^2
};

Scene unseen(Scene scene) {
  for (SceneItem& item : scene.items) item.seen = false;
  return scene;
}

/// The ground's texture divides out: the picture of open ground under the sun alone has the same
/// paths from the eye, and neither noise nor anything else than texture and sun.
Truth traceTruth(const Scene& scene, const View& view, int samples) {
  Truth truth;
  const Sun& sun = view.daylight.sun;
  const glm::vec3 open_sun = sun.illuminance() * sun.direction.y;
  ReferenceOptions options;
  options.width = view.width;
  options.height = view.height;
  options.camera = view.camera;
  options.samples = std::max(samples / 2, 1);
  truth.open = open_sun;
  for (std::size_t half = 0; half < 2; ++half) {
    options.seed = static_cast<std::uint32_t>(half + 1);
    const HdrImage light = renderReference(scene, view.daylight, options).image;
    HdrImage open = renderReference(Scene{}, {nullptr, sun}, options).image;
    if (half == 0 && view.daylight.sky != nullptr) {
      ReferenceOptions few = options;
      few.samples = std::min(options.samples, 8);
      const HdrImage whole = renderReference(Scene{}, view.daylight, few).image;
      const HdrImage part = renderReference(Scene{}, {nullptr, sun}, few).image;
      glm::dvec3 whole_sum(0.0), part_sum(0.0);
      for (std::size_t i = 0; i < whole.rgb.size(); ++i) {
        whole_sum += glm::dvec3(whole.rgb[i]);
        part_sum += glm::dvec3(part.rgb[i]);
      }
      truth.open = open_sun * glm::vec3(whole_sum / part_sum);
    }
    for (glm::vec3& c : open.rgb) c *= truth.open / open_sun;
    truth.halves[half] = divided(light, open);
    if (half == 0) truth.open_luminance = std::move(open);
  }
  truth.mean.resize(truth.halves[0].size());
  for (std::size_t i = 0; i < truth.mean.size(); ++i)
    truth.mean[i] = 0.5f * (truth.halves[0][i] + truth.halves[1][i]);
  return truth;
}

double sumOfLuminance(const HdrImage& image) {
  double sum = 0.0;
  for (const glm::vec3& c : image.rgb) sum += double{glm::dot(c, kLuma)};
  return sum;
}

/// Irradiance as linear grey and colour, open ground white.
Image shown(const Irradiance& light, int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < light.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      image.rgba[4 * i + static_cast<std::size_t>(c)] =
          toByte(shared::srgbFromLinear(glm::clamp(light[i][c], 0.0f, 1.0f)));
    image.rgba[4 * i + 3] = 255;
  }
  return image;
}

/// What of the picture is measured, in open ground's illuminance.
class Measure {
 public:
  Measure(const Truth& truth, const View& view) : truth_(truth), width_(view.width) {
    weights_ = truth.open * kLuma / glm::dot(truth.open, kLuma);
    double sum = 0.0;
    for (const glm::vec3& e : truth.mean) {
      const float share = glm::dot(e, weights_);
      shadow_.push_back(share > 0.0f && share < kShadowBelow);
      if (shadow_.back()) {
        sum += double{share};
        ++count_;
      }
    }
    mean_ = count_ > 0 ? sum / count_ : 1.0;
  }

  int count() const { return count_; }
  double mean() const { return mean_; }

  GroundError errorOf(const Irradiance& light) const {
    GroundError error;
    double squares = 0.0;
    int open = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double e = share(light[i]), truth = share(truth_.mean[i]);
      if (shadow_[i]) {
        error.of_mean += std::abs(e - truth);
        error.of_pixel += std::abs(e - truth) / std::max(truth, double{kLeastIrradiance});
        error.bias += e - truth;
        // Each half has noise of its own: their product has none in its mean.
        squares += (e - share(truth_.halves[0][i])) * (e - share(truth_.halves[1][i]));
      } else if (truth > double{kOpenAbove}) {
        error.open += std::abs(e - truth);
        ++open;
      }
    }
    error.of_mean /= count_ * mean_;
    error.of_pixel /= count_;
    error.bias /= count_ * mean_;
    error.rms = std::sqrt(std::max(squares / count_, 0.0)) / mean_;
    error.open /= std::max(open, 1);
    return error;
  }

  /// |A - B| / 2 of the halves is as large as what their mean is off.
  GroundError noise() const {
    Irradiance off(truth_.mean.size());
    for (std::size_t i = 0; i < off.size(); ++i)
      off[i] = truth_.mean[i] + 0.5f * (truth_.halves[0][i] - truth_.halves[1][i]);
    return errorOf(off);
  }

  /// |E - E_ref| over the shadow's mean of E_ref, up to 1.
  ErrorMap mapOf(const Irradiance& light) const {
    ErrorMap map{width_, static_cast<int>(light.size()) / width_, {}};
    for (std::size_t i = 0; i < light.size(); ++i)
      map.values.push_back(static_cast<float>(
          std::min(std::abs(share(light[i]) - share(truth_.mean[i])) / mean_, 1.0)));
    return map;
  }

 private:
  double share(const glm::vec3& e) const { return double{glm::dot(e, weights_)}; }

  const Truth& truth_;
  int width_;
  glm::vec3 weights_;
  std::vector<bool> shadow_;
  int count_ = 0;
  double mean_ = 1.0;
};

}  // namespace

std::vector<const Candidate*> groundCandidates() {
  std::vector<const Candidate*> out;
  for (const Candidate& candidate : kCandidates)
    if (candidate.on_ground) out.push_back(&candidate);
  return out;
}

std::vector<GroundPicture> measureGround(const Subject& subject, int pixels, int samples,
                                         Renderer& renderer, Page& page, Progress& progress) {
  const std::vector<const Candidate*> candidates = groundCandidates();
  // By sun and light; drawn by candidate, so that each scene is uploaded once.
  std::vector<View> views;
  for (const SunPosition& sun : kSuns)
    for (const bool sun_alone : {false, true}) {
      views.push_back(viewOfShadow(subject.plant, sun, pixels));
      if (sun_alone) views.back().daylight.sky = nullptr;
    }
  std::vector<std::vector<Irradiance>> drawn(candidates.size());
  std::vector<std::vector<double>> open_light(candidates.size());
  const auto draw = [&](const Candidate& candidate, std::vector<HdrImage>& out) {
    for (View view : views) {
      view.terms = candidate.terms;
      view.width *= kFiner;
      view.height *= kFiner;
      out.push_back(coarser(renderer.render(view).hdr));
    }
  };
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    progress.show(fmt::format("{}: ground, {}", subject.name, candidates[c]->name));
    std::vector<HdrImage> under, open;
    renderer.setScene(unseen(subject.scene(*candidates[c])));
    draw(*candidates[c], under);
    renderer.setScene(Scene{});
    draw(*candidates[c], open);
    for (std::size_t v = 0; v < views.size(); ++v) {
      drawn[c].push_back(divided(under[v], open[v]));
      open_light[c].push_back(sumOfLuminance(open[v]));
    }
  }

  std::vector<GroundPicture> pictures;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const View& view = views[v];
    const SunPosition& sun = kSuns[v / 2];
    GroundPicture picture;
    picture.label = fmt::format("{}, {}", subject.name, sun.name);
    picture.sun_alone = view.daylight.sky == nullptr;
    const std::string light = picture.sun_alone ? "sun alone" : "daylight";
    progress.show(fmt::format("{}: ground, reference, {}, {}", subject.name, sun.name, light));
    // The sun through a crown is noisier than the sky.
    const Truth truth = traceTruth(unseen(subject.scene(kCandidates[0])), view,
                                   picture.sun_alone ? 2 * samples : samples);
    const Measure measure(truth, view);
    picture.patch_m = double{2.0f * glm::length(view.camera.eye - view.camera.target) *
                             std::tan(0.5f * view.camera.vertical_fov)} /
                      view.height;
    picture.shadow_m2 = measure.count() * picture.patch_m * picture.patch_m;
    picture.shadow_light = measure.mean();
    const GroundError noise = measure.noise();
    picture.noise = noise.of_mean;
    picture.open_noise = noise.open;
    picture.open_light = open_light[0][v] / sumOfLuminance(truth.open_luminance) - 1.0;

    const std::string prefix =
        fmt::format("{}-{}-ground-{}", subject.name, v / 2 + 1, picture.sun_alone ? "sun" : "day");
    page.beginRow();
    page.picture(prefix + "-reference", shown(truth.mean, view.width, view.height),
                 fmt::format("irradiance on the ground, path-traced, {}, {}", sun.name, light));
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      picture.errors.push_back(measure.errorOf(drawn[c][v]));
      page.picture(fmt::format("{}-{}", prefix, c + 1), shown(drawn[c][v], view.width, view.height),
                   fmt::format("{}: error {:.0f} %", candidates[c]->name,
                               100.0 * picture.errors.back().of_mean));
    }
    page.endRow();
    page.beginRow();
    page.paragraph("");
    for (std::size_t c = 0; c < candidates.size(); ++c)
      page.picture(
          fmt::format("{}-{}-error", prefix, c + 1), heatmap(measure.mapOf(drawn[c][v])),
          fmt::format("error of {}, pale yellow: the shadow's mean light", candidates[c]->name));
    page.endRow();
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

void addGroundTables(Page& page, const std::vector<GroundPicture>& pictures) {
  const std::vector<const Candidate*> candidates = groundCandidates();
  const auto table = [&](const std::string& what, bool sun_alone, double GroundError::*value) {
    page.paragraph(what + (sun_alone ? ", sun alone (black sky)" : ", whole daylight"));
    std::vector<std::vector<std::string>> rows{{"plant, sun"}};
    for (const Candidate* candidate : candidates) rows[0].emplace_back(candidate->name);
    for (const char* head : {"noise of the reference", "light there, of open ground's",
                             "shadow, m<sup>2</sup>", "open ground's noise", "open ground's light"})
      rows[0].emplace_back(head);
    std::vector<double> sums(candidates.size());
    int count = 0;
    for (const GroundPicture& picture : pictures) {
      if (picture.sun_alone != sun_alone) continue;
      ++count;
      rows.push_back({picture.label});
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        sums[c] += picture.errors[c].*value;
        rows.back().push_back(fmt::format("{:.4f}", picture.errors[c].*value));
      }
      rows.back().push_back(fmt::format("{:.4f}", picture.noise));
      rows.back().push_back(fmt::format("{:.3f}", picture.shadow_light));
      rows.back().push_back(fmt::format("{:.0f}", picture.shadow_m2));
      rows.back().push_back(fmt::format("{:.4f}", picture.open_noise));
      rows.back().push_back(fmt::format("{:+.4f}", picture.open_light));
    }
    rows.push_back({"<b>mean</b>"});
    for (const double sum : sums) rows.back().push_back(fmt::format("{:.4f}", sum / count));
    rows.push_back({"<b>relative to standard</b>"});
    for (const double sum : sums) rows.back().push_back(fmt::format("{:.2f}", sum / sums[0]));
    page.table(rows);
  };
  for (const bool sun_alone : {false, true}) {
    table("Ground: mean error of irradiance in the shadow over its mean there", sun_alone,
          &GroundError::of_mean);
    table("Ground: mean relative error of irradiance in the shadow", sun_alone,
          &GroundError::of_pixel);
    table("Ground: root-mean-square error in the shadow over its mean light, free of noise",
          sun_alone, &GroundError::rms);
    table("Ground: error outside of the shadow over open ground's light", sun_alone,
          &GroundError::open);
  }
}

nlohmann::ordered_json groundJson(const std::vector<GroundPicture>& pictures) {
  const std::vector<const Candidate*> candidates = groundCandidates();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const GroundPicture& picture : pictures)
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const GroundError& error = picture.errors[c];
      rows.push_back({{"picture", picture.label},
                      {"sun_alone", picture.sun_alone},
                      {"light", candidates[c]->name},
                      {"error", error.of_mean},
                      {"pixel_error", error.of_pixel},
                      {"rms", error.rms},
                      {"bias", error.bias},
                      {"open_error", error.open},
                      {"noise", picture.noise},
                      {"open_noise", picture.open_noise},
                      {"shadow_light", picture.shadow_light},
                      {"shadow_m2", picture.shadow_m2},
                      {"patch_m", picture.patch_m},
                      {"open_light", picture.open_light}});
    }
  return rows;
}

}  // namespace verdure::app
