// How well fields predict what rays find, plant by plant, as a table in Markdown
// (docs/openness.md):
//   openness_table [--samples N] [--dump FILE] [PLANT | SPECIES]...
// Without plants: all species, grown with seed 4. Openness is the share of the whole sphere that is
// free (512 rays); vertices that see nothing at all are left out, and their share is told.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/progress.h"
#include "base/random.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/occlusion.h"
#include "verdure/optical_depth.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

double median(std::vector<double> v) {
  if (v.empty()) return 0.0;
  std::sort(v.begin(), v.end());
  return v.size() % 2 == 1 ? v[v.size() / 2] : 0.5 * (v[v.size() / 2 - 1] + v[v.size() / 2]);
}

double meanAngleDeg(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::acos(
        double{std::clamp(glm::dot(glm::normalize(a[i]), glm::normalize(b[i])), -1.0f, 1.0f)});
  return a.empty() ? 0.0 : sum / static_cast<double>(a.size()) * 180.0 / M_PI;
}

/// Least squares for k -> openness: the metaball coefficient has no scale of its own.
std::vector<float> scaledTo(const std::vector<float>& x, const std::vector<float>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    n += 1, sx += x[i], sy += y[i], sxx += double{x[i]} * x[i], sxy += double{x[i]} * y[i];
  }
  const double spread = sxx - sx * sx / n, b = spread > 1e-12 ? (sxy - sx * sy / n) / spread : 0.0;
  std::vector<float> out;
  for (const float v : x) out.push_back(static_cast<float>((sy - b * sx) / n + b * v));
  return out;
}

struct Columns {
  std::vector<double> rms, rank, fit_rms, fit_rank, leaf_rms, leaf_rank, ball_rms, ball_rank, angle,
      crown, crown_fit, crown_by_openness, own, own_by_openness, wood, wood_fit, times;
};

void addPlant(const Plant& plant, std::size_t samples, std::FILE* dump, Columns& columns) {
  std::vector<VertexId> all = allVertices(plant), chosen;
  Random random(7);
  std::size_t wanted = std::min(samples, all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (random.below(static_cast<std::uint32_t>(all.size() - i)) < wanted) {
      chosen.push_back(all[i]);
      --wanted;
    }
  RayOptions rays;
  rays.rays = 512;
  rays.bounces = 0;
  const std::vector<Openness> openness = traceOpenness(plant, chosen, rays);

  const std::vector<Surfel> surfels = plantSurfels(plant);
  const OpticalDepthField field(surfels, plantDepthOptions(plant, surfels));
  double terms = 0.0;
  const std::vector<DepthSums> sums = vertexDepths(plant, surfels, field, &terms);
  rays.rays = 256;
  Timer ray_timer;
  traceOpenness(plant, std::span(chosen).first(1), rays);
  const double build = ray_timer.lap();
  traceOpenness(plant, chosen, rays);
  const double per_vertex =
      std::max(0.0, ray_timer.lap() - build) / static_cast<double>(chosen.size());
  const double ray_seconds = build + per_vertex * static_cast<double>(all.size());

  const DepthBake bake = bakeOpticalDepth(plant);
  const DepthModels& models = bake.report.models;
  const double seconds = bake.report.seconds_total;
  rays.rays = 256;
  const std::vector<glm::vec3> crown_light = traceAmbient(plant, chosen, rays, &bake.light);
  const std::vector<glm::vec3> own_light = traceAmbient(plant, chosen, rays);
  std::vector<float> ball_ambient(all.size(), 1.0f);
  try {
    const DensityBake ball = bakeDensity(plant);
    std::size_t at = 0;
    for (const MeshLight& m : ball.light.meshes)
      for (const float k : m.ambient) ball_ambient[at++] = k;
  } catch (const Error&) {  // no foliage
  }

  std::vector<std::size_t> first;
  std::size_t vertex = 0;
  for (const Mesh& mesh : plant.meshes) {
    first.push_back(vertex);
    vertex += mesh.positions.size();
  }
  std::vector<float> truth, predicted, fitted, leaf_truth, leaf_predicted, ball;
  std::vector<float> crown_truth, crown_outward, crown_fitted, own_truth, own_hemisphere;
  std::vector<float> wood_truth, wood_light, wood_fitted;
  std::vector<glm::vec3> open, away;
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!(openness[i].share > 0.0f)) {
      ++hidden;
      continue;
    }
    const std::size_t at = first[chosen[i].mesh] + chosen[i].vertex;
    const Mesh& mesh = plant.meshes[chosen[i].mesh];
    const bool leaf = mesh.kind == PartKind::kFoliage;
    const DepthSums& s = sums[at];
    truth.push_back(openness[i].share);
    predicted.push_back(opennessOf(s, DepthModels{}.of(mesh.kind)));
    fitted.push_back(opennessOf(s, models.of(mesh.kind)));
    ball.push_back(ball_ambient[at]);
    if (dump != nullptr)
      fmt::print(dump, "{} {} {} {} {} {} {} {}\n", plant.name, leaf ? 1 : 0, openness[i].share,
                 s.depth, glm::length(s.toward), s.hemisphere, crown_light[i].x, own_light[i].x);
    if (!leaf) {
      wood_truth.push_back(own_light[i].x);
      wood_light.push_back(hemisphereLightOf(s, kWoodLight));
      wood_fitted.push_back(hemisphereLightOf(s, models.wood_light));
      continue;
    }
    leaf_truth.push_back(truth.back());
    leaf_predicted.push_back(predicted.back());
    crown_truth.push_back(crown_light[i].x);
    crown_outward.push_back(outwardLightOf(s, kCrownLight));
    crown_fitted.push_back(outwardLightOf(s, models.crown_light));
    own_truth.push_back(own_light[i].x);
    own_hemisphere.push_back(-s.hemisphere);
    if (glm::length(openness[i].direction) > 0.02f && glm::length(s.toward) > 0.0f) {
      open.push_back(openness[i].direction);
      away.push_back(-s.toward);
    }
  }
  const Agreement plain = agreementOf(predicted, truth), fit = agreementOf(fitted, truth),
                  leaves = agreementOf(leaf_predicted, leaf_truth),
                  metaball = agreementOf(scaledTo(ball, truth), truth),
                  crown = agreementOf(crown_outward, crown_truth),
                  crown_by_openness =
                      agreementOf(scaledTo(leaf_predicted, crown_truth), crown_truth),
                  own = agreementOf(own_hemisphere, own_truth),
                  own_by_openness = agreementOf(leaf_predicted, own_truth),
                  wood = agreementOf(wood_light, wood_truth),
                  crown_fit = agreementOf(crown_fitted, crown_truth),
                  wood_fit = agreementOf(wood_fitted, wood_truth);
  const double angle = meanAngleDeg(open, away);
  columns.rms.push_back(plain.rms);
  columns.rank.push_back(plain.rank);
  columns.fit_rms.push_back(fit.rms);
  columns.fit_rank.push_back(fit.rank);
  columns.leaf_rms.push_back(leaves.rms);
  columns.leaf_rank.push_back(leaves.rank);
  columns.ball_rms.push_back(metaball.rms);
  columns.ball_rank.push_back(metaball.rank);
  columns.angle.push_back(angle);
  columns.crown.push_back(crown.rms);
  columns.crown_fit.push_back(crown_fit.rms);
  columns.crown_by_openness.push_back(crown_by_openness.rms);
  columns.own.push_back(own.rank);
  columns.own_by_openness.push_back(own_by_openness.rank);
  columns.wood.push_back(wood.rms);
  columns.wood_fit.push_back(wood_fit.rms);
  columns.times.push_back(ray_seconds / seconds);
  fmt::print(
      "| {} | {} | {:.0f} % | {:.3f}, {:.2f} | {:.3f}, {:.2f} | {:.3f}, {:.2f} | {:.3f}, {:.2f} "
      "| {:.0f} | {:.3f}, {:.3f} | {:.2f} | {:.3f}, {:.3f} | {:.2f} s | {:.0f} |\n",
      plant.name, all.size(),
      100.0 * static_cast<double>(hidden) / static_cast<double>(chosen.size()), plain.rms,
      plain.rank, leaves.rms, leaves.rank, fit.rms, fit.rank, metaball.rms, metaball.rank, angle,
      crown.rms, crown_fit.rms, own.rank, wood.rms, wood_fit.rms, seconds, ray_seconds / seconds);
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  std::size_t samples = 1000;
  std::FILE* dump = nullptr;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--samples" && i + 1 < argc)
      samples = std::stoul(argv[++i]);
    else if (name == "--dump" && i + 1 < argc)
      dump = std::fopen(argv[++i], "w");
    else
      names.push_back(name);
  }
  if (names.empty())
    for (const SpeciesInfo& s : speciesList()) names.push_back(s.name);
  fmt::print(
      "| plant | vertices | hidden | constants: RMS, rank | leaves | fitted | metaball | open "
      "side, "
      "degrees | crown light RMS: constants, fitted | leaf light rank | wood light RMS: "
      "constants, fitted | time | rays / field |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  Columns c;
  for (const std::string& name : names) {
    Plant plant;
    if (std::filesystem::exists(name)) {
      plant = loadPlant(name);
      plant.name = std::filesystem::path(name).stem().string();
    } else {
      GrowOptions grow_options;
      grow_options.species = name;
      grow_options.seed = 4;
      plant = grow(grow_options);
    }
    addPlant(plant, samples, dump, c);
  }
  fmt::print(
      "| median | | | {:.3f}, {:.2f} | {:.3f}, {:.2f} | {:.3f}, {:.2f} | {:.3f}, {:.2f} | "
      "{:.0f} | {:.3f}, {:.3f} | {:.2f} | {:.3f}, {:.3f} | | {:.0f} |\n",
      median(c.rms), median(c.rank), median(c.leaf_rms), median(c.leaf_rank), median(c.fit_rms),
      median(c.fit_rank), median(c.ball_rms), median(c.ball_rank), median(c.angle), median(c.crown),
      median(c.crown_fit), median(c.own), median(c.wood), median(c.wood_fit), median(c.times));
  fmt::print(
      "\nCrown light by openness alone (scaled to fit): RMS {:.3f}; leaf light by openness "
      "alone: rank {:.2f}\n",
      median(c.crown_by_openness), median(c.own_by_openness));
  if (dump != nullptr) std::fclose(dump);
  return 0;
}

}  // namespace
}  // namespace verdure

int main(int argc, char** argv) {
  try {
    return verdure::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "openness_table: %s\n", e.what());
    return 2;
  }
}
