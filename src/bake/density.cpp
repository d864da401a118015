#include "verdure/density.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "bake/crown_parameters.h"
#include "bake/nearest_surface.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "shared/density.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr const char* kWhere = "density bake";

void checkOptions(const DensityOptions& o) {
  const auto require = [](bool ok, const char* what, const char* advice) {
    if (!ok) throw Error(kWhere, what, advice);
  };
  const auto finite = [](float v) { return std::isfinite(v); };
  require(!o.rho || (finite(*o.rho) && *o.rho > 0.0f), "rho must be above 0",
          "leave --rho out to have it found from the plant");
  require(!o.tau || (finite(*o.tau) && *o.tau >= 0.0f), "tau must not be negative",
          "leave --tau out to have it found from the plant");
  require(o.fraction > 0.0f && o.fraction <= 1.0f, "the fraction must lie in (0, 1]",
          "use 1 for all leaves");
  require(o.grid >= 1, "the grid needs at least one cell", "128 is usual");
  require(!o.d_min || (finite(*o.d_min) && *o.d_min > 0.0f), "d_min must be above 0",
          "leave --d-min out to have it found from the plant");
  require(o.k_min >= 0.0f && o.k_min <= 1.0f, "k_min must lie in [0, 1]", "0.2 is usual");
  require(finite(o.exponent) && o.exponent > 0.0f, "the exponent must be above 0", "1 is usual");
  require(o.blend >= 0.0f && o.blend <= 1.0f, "the blend must lie in [0, 1]",
          "1 takes the crown's normals");
  require(o.normals != CrownNormals::kOpticalDepth, "it has no optical-depth normals",
          "use --field optical-depth, or --normals surface-point");
}

/// The leaves of one plant, checked.
std::vector<glm::vec3> checkedCenters(const Plant& plant, std::size_t& skipped) {
  const bool foliage = std::any_of(plant.meshes.begin(), plant.meshes.end(), [](const Mesh& m) {
    return m.kind == PartKind::kFoliage && !m.indices.empty();
  });
  if (!foliage)
    throw Error(plant.name, "the plant has no foliage",
                "name its material or mesh with --foliage, or choose another plant");
  std::vector<glm::vec3> centers = foliageCenters(plant, skipped);
  if (centers.empty())
    throw Error(plant.name, fmt::format("all {} leaves have zero area", plant.leaves.size()),
                "check the scale of the foliage");
  if (centers.size() < 2)
    throw Error(plant.name, "there is a single leaf, and a crown needs several",
                "check --foliage, or keep the leaf's own light");
  return centers;
}

/// World from plant: rotation about +Y, uniform scale, translation.
struct Frame {
  glm::mat3 rotation{1.0f};
  float scale = 1.0f;
  glm::vec3 translation{0.0f};
  bool identity = true;

  Frame() = default;
  explicit Frame(const Placement& p) : scale(p.scale), translation(p.position), identity(false) {
    const float c = std::cos(p.angle), s = std::sin(p.angle);
    rotation = glm::mat3(glm::vec3(c, 0, -s), glm::vec3(0, 1, 0), glm::vec3(s, 0, c));
  }
  glm::vec3 worldFromPlant(const glm::vec3& p) const {
    return identity ? p : rotation * (scale * p) + translation;
  }
  glm::vec3 plantDirection(const glm::vec3& d) const {
    return identity ? d : glm::transpose(rotation) * d;
  }
};

/// Everything that the vertices ask: the field, its thresholds, the surface and how to search it.
struct CrownField {
  DensityField field;
  float rho = 0.0f;
  CrownThresholds thresholds;
  bool own_surface =
      true;  ///< extracted from the field, so that the field's gradient is its normal
  std::unique_ptr<Surface> surface;  // where `nearest` refers to it, however this moves
  std::unique_ptr<NearestSurface> nearest;

  CrownField(DensityField f, float r, const CrownThresholds& t)
      : field(std::move(f)), rho(r), thresholds(t) {}

  void setSurface(Surface s) {
    surface = std::make_unique<Surface>(std::move(s));
    nearest = std::make_unique<NearestSurface>(*surface);
  }
  Surface takeSurface() {
    nearest.reset();
    return surface ? std::move(*surface) : Surface{};
  }
};

std::vector<Generator> generatorsAt(const std::vector<glm::vec3>& centers, float rho) {
  std::vector<Generator> generators(centers.size());
  for (std::size_t i = 0; i < centers.size(); ++i) generators[i] = {centers[i], rho};
  return generators;
}

std::vector<glm::vec3> positionsOf(const std::vector<Generator>& generators) {
  std::vector<glm::vec3> points(generators.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = generators[i].position;
  return points;
}

std::vector<float> sumsAt(const DensityField& field, const std::vector<glm::vec3>& points) {
  std::vector<float> sums(points.size());
  field.sumAt(points, sums);
  return sums;
}

/// Thresholds of a crown from the field of all its leaves, at some thousand of them: a random
/// fraction would be noisy and counts each chosen leaf at its own place several times.
CrownThresholds thresholdsOf(const std::vector<glm::vec3>& centers, float rho,
                             const DensityOptions& options) {
  if (options.tau && options.d_min) return {*options.tau, *options.d_min};
  constexpr std::size_t kMost = 8192;
  const std::size_t step = (centers.size() + kMost - 1) / kMost;
  std::vector<glm::vec3> some;
  for (std::size_t i = 0; i < centers.size(); i += step) some.push_back(centers[i]);
  const DensityField all(generatorsAt(centers, rho), options.norm);
  return defaultThresholds(sumsAt(all, some), options);
}

Surface preparedSurface(const Surface& given) {
  if (given.indices.empty())
    throw Error("surface", "the surface has no triangles", "choose another --surface");
  // Vertices without a triangle would be found as nearest and lead nowhere.
  Surface surface;
  std::vector<std::uint32_t> renamed(given.positions.size(), kNone);
  const bool has_normals = given.normals.size() == given.positions.size();
  for (const std::uint32_t v : given.indices) {
    if (v < given.positions.size() && !std::isfinite(glm::dot(given.positions[v], glm::vec3(1.0f))))
      throw Error("surface", fmt::format("position {} is not finite", v), "export it again");
    if (v >= given.positions.size())
      throw Error("surface",
                  fmt::format("index {} points past its {} vertices", v, given.positions.size()),
                  "export the surface again");
    if (renamed[v] == kNone) {
      renamed[v] = static_cast<std::uint32_t>(surface.positions.size());
      surface.positions.push_back(given.positions[v]);
      surface.normals.push_back(has_normals ? given.normals[v] : glm::vec3(0.0f));
    }
    surface.indices.push_back(renamed[v]);
  }
  if (!has_normals)
    for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
      const glm::vec3& a = surface.positions[surface.indices[i]];
      const glm::vec3 normal = glm::cross(surface.positions[surface.indices[i + 1]] - a,
                                          surface.positions[surface.indices[i + 2]] - a);
      for (std::size_t k = 0; k < 3; ++k) surface.normals[surface.indices[i + k]] += normal;
    }
  for (glm::vec3& n : surface.normals) {
    const float length = glm::length(n);
    n = length > 0.0f ? n / length : glm::vec3(0, 1, 0);
  }
  return surface;
}

void reportSurface(const CrownField& crown, const SurfaceStatistics& statistics,
                   const Lattice& lattice, DensityReport& report) {
  report.grid_points = statistics.grid_points;
  report.grid_points_evaluated = statistics.grid_points_evaluated;
  report.grid_bytes = statistics.bytes;
  report.voxel_m = lattice.spacing;
  report.degenerate_gradients = statistics.degenerate_gradients;
  report.surface_vertices = crown.surface->positions.size();
  report.surface_triangles = crown.surface->indices.size() / 3;
  report.surface_components = crown.nearest->components();
  report.watertight = crown.nearest->watertight();
}

void showStep(const DensityOptions& options, const char* step, double share) {
  if (options.progress) options.progress(step, share);
}

bool needsSurface(const DensityOptions& options) {
  return options.normals == CrownNormals::kSurfaceVertex ||
         options.normals == CrownNormals::kSurfacePoint;
}

/// The kernel sum at the top of the hill on which `start` stands, by ever finer searches around the
/// best point so far.
float hilltop(const DensityField& field, glm::vec3 start) {
  float best = 0.0f;
  for (float reach = 0.5f * field.maxRadius(); reach > 1e-3f * field.maxRadius(); reach *= 0.6f) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 343; ++i)
      points.push_back(start +
                       reach / 3.0f * (glm::vec3(i % 7, i / 7 % 7, i / 49) - glm::vec3(3.0f)));
    const std::vector<float> sums = sumsAt(field, points);
    const auto top = std::max_element(sums.begin(), sums.end());
    best = std::max(best, *top);
    start = points[static_cast<std::size_t>(top - sums.begin())];
  }
  return best;
}

/// There is no surface: says why, with the field's maximum. `densest` is the generator with the
/// largest sum.
[[noreturn]] void failWithoutSurface(const DensityField& field, const glm::vec3& densest,
                                     float tau) {
  const float largest = hilltop(field, densest);
  if (tau < largest)
    throw Error(kWhere, fmt::format("the grid is too coarse for the surface of tau {:g}", tau),
                "choose a finer --grid");
  throw Error(kWhere,
              fmt::format("tau {:g} is above the largest kernel sum, {:g}: there is no surface",
                          tau, largest),
              "choose a smaller --tau");
}

/// Takes the field and its thresholds and finds the surface where it is asked for. `generators` are
/// those of the field.
CrownField makeCrownField(DensityField field, const std::vector<Generator>& generators,
                          const CrownThresholds& thresholds, const DensityOptions& options,
                          float cell_extent, const Surface* surface, DensityReport& report) {
  Timer timer;
  const float rho = generators[0].radius;
  CrownField crown(std::move(field), rho, thresholds);
  const std::vector<float> sums = sumsAt(crown.field, positionsOf(generators));
  const auto largest = std::max_element(sums.begin(), sums.end());
  const glm::vec3 densest = generators[static_cast<std::size_t>(largest - sums.begin())].position;
  report.rho = rho;
  report.tau = thresholds.tau;
  report.d_min = thresholds.d_min;
  report.k_min = options.k_min;
  report.exponent = options.exponent;
  report.generators = generators.size();
  report.field_max_at_generators = *largest;
  if (surface != nullptr) {
    crown.setSurface(preparedSurface(*surface));
    crown.own_surface = false;
    Lattice none;
    none.spacing = 0.0f;
    reportSurface(crown, {}, none, report);
  } else if (needsSurface(options)) {
    showStep(options, "surface", 0.1);
    const Lattice lattice = crown.field.lattice(options.grid, cell_extent);
    SurfaceStatistics statistics;
    Surface extracted =
        crown.field.surface(lattice, thresholds.tau, options.max_memory_bytes, &statistics);
    if (extracted.indices.empty()) failWithoutSurface(crown.field, densest, thresholds.tau);
    crown.setSurface(std::move(extracted));
    reportSurface(crown, statistics, lattice, report);
  } else if (thresholds.tau >= *largest && thresholds.tau >= hilltop(crown.field, densest)) {
    failWithoutSurface(crown.field, densest, thresholds.tau);
  }
  report.seconds_surface = timer.lap();
  return crown;
}

/// Sums of one run of vertices for the report, added up in order.
struct AmbientCounts {
  float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
  std::size_t open = 0, core = 0;
  double ambient = 0;
};

/// (4) at every vertex, bark included.
void bakeAmbient(const CrownField& crown, std::span<const glm::vec3> points,
                 const DensityOptions& options, std::vector<float>& ambient,
                 DensityReport& report) {
  ambient.resize(points.size());
  crown.field.sumAt(points, ambient);
  const float tau = crown.thresholds.tau, d_min = crown.thresholds.d_min;
  constexpr std::size_t kRun = 8192;
  std::vector<AmbientCounts> runs((points.size() + kRun - 1) / kRun);
  parallelChunks(points.size(), kRun, [&](std::size_t begin, std::size_t end) {
    AmbientCounts& run = runs[begin / kRun];
    for (std::size_t i = begin; i < end; ++i) {  // the sum goes, the coefficient comes
      const float d = ambient[i] - tau;
      run.least = std::min(run.least, d);
      run.most = std::max(run.most, d);
      run.open += d <= 0.0f ? 1 : 0;
      run.core += d >= d_min ? 1 : 0;
      ambient[i] = std::max(shared::ambientCoefficient(d, d_min, options.k_min, options.exponent),
                            1.0f / 255.0f);
      run.ambient += double{ambient[i]};
    }
  });
  for (const AmbientCounts& run : runs) {
    const bool first = &run == runs.data() && report.vertices == 0;
    report.field_min_at_vertices =
        first ? run.least : std::min(report.field_min_at_vertices, run.least);
    report.field_max_at_vertices =
        first ? run.most : std::max(report.field_max_at_vertices, run.most);
    report.vertices_open += run.open;
    report.vertices_core += run.core;
    report.mean_ambient += run.ambient;
  }
  report.vertices += points.size();
}

/// Crown normals at foliage vertices, in the world's frame.
std::vector<glm::vec3> crownNormals(const CrownField& crown, std::span<const glm::vec3> points,
                                    const Bounds& foliage, const DensityOptions& options) {
  std::vector<glm::vec3> normals(points.size());
  switch (options.normals) {
    case CrownNormals::kKeep:
    case CrownNormals::kOpticalDepth:  // refused by checkOptions
      break;
    case CrownNormals::kEllipsoid: {
      const glm::vec3 half = glm::max(0.5f * foliage.size(), glm::vec3(1e-6f));
      parallelFor(points.size(), 8192, [&](std::size_t i) {
        // Gradient of (x / a)^2 + (y / b)^2 + (z / c)^2.
        const glm::vec3 g = (points[i] - foliage.center()) / (half * half);
        const float length = glm::length(g);
        normals[i] = length > 0.0f ? g / length : glm::vec3(0, 1, 0);
      });
      break;
    }
    case CrownNormals::kSurfaceVertex:
      parallelChunks(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::uint32_t hint = 0;
        for (std::size_t i = begin; i < end; ++i) {
          hint = crown.nearest->vertex(points[i], hint);
          normals[i] = crown.surface->normals[hint];
        }
      });
      break;
    case CrownNormals::kSurfacePoint: {
      std::vector<glm::vec3> feet(crown.own_surface ? points.size() : 0);
      parallelChunks(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::uint32_t hint = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const NearestSurface::Point p = crown.nearest->point(points[i], hint);
          hint = p.vertex;
          normals[i] = p.normal;
          if (crown.own_surface) feet[i] = p.position;
        }
      });
      if (!crown.own_surface) break;
      std::vector<float> sums(points.size());
      std::vector<glm::vec3> gradients(points.size());
      crown.field.gradientAt(feet, sums, gradients);
      parallelFor(points.size(), 8192, [&](std::size_t i) {
        const float length = glm::length(gradients[i]);
        if (length * crown.rho > 1e-6f) normals[i] = -gradients[i] / length;
      });
      break;
    }
  }
  return normals;
}

CrownLight bakeLight(const Plant& plant, const Frame& frame, const CrownField& crown,
                     const DensityOptions& options, DensityReport& report) {
  CrownLight light;
  light.meshes.resize(plant.meshes.size());
  Bounds foliage = bounds(plant, PartKind::kFoliage);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    const Mesh& mesh = plant.meshes[m];
    MeshLight& out = light.meshes[m];
    std::vector<glm::vec3> moved;
    if (!frame.identity) {
      moved.resize(mesh.positions.size());
      parallelFor(moved.size(), 8192,
                  [&](std::size_t i) { moved[i] = frame.worldFromPlant(mesh.positions[i]); });
    }
    const std::span<const glm::vec3> points = frame.identity ? mesh.positions : moved;

    Timer timer;
    bakeAmbient(crown, points, options, out.ambient, report);
    report.seconds_ambient += timer.lap();

    if (mesh.kind != PartKind::kFoliage || options.normals == CrownNormals::kKeep) {
      out.normals = mesh.normals;
    } else if (options.normals == CrownNormals::kEllipsoid) {
      out.normals = crownNormals(crown, mesh.positions, foliage, options);
    } else {
      out.normals = crownNormals(crown, points, foliage, options);
      for (glm::vec3& n : out.normals) n = frame.plantDirection(n);
    }
    if (mesh.kind == PartKind::kFoliage) {
      report.foliage_vertices += mesh.positions.size();
      if (options.blend < 1.0f)
        for (std::size_t i = 0; i < out.normals.size(); ++i) {
          const glm::vec3 n = glm::mix(mesh.normals[i], out.normals[i], options.blend);
          const float length = glm::length(n);
          if (length > 1e-4f) out.normals[i] = n / length;
        }
    }
    report.seconds_normals += timer.lap();
  }
  if (report.vertices > 0) report.mean_ambient /= static_cast<double>(report.vertices);
  return light;
}

float weightOf(std::size_t all, std::size_t chosen) {
  return static_cast<float>(all) / static_cast<float>(chosen);
}

}  // namespace

DensityBake bakeDensity(const Plant& plant, const DensityOptions& options, const Surface* surface) {
  checkOptions(options);
  Timer total, timer;
  DensityBake bake;
  DensityReport& report = bake.report;
  showStep(options, "leaves", 0.0);
  report.leaves = plant.leaves.size();
  const std::vector<glm::vec3> centers = checkedCenters(plant, report.skipped_leaves);
  const float rho = options.rho.value_or(defaultRho(centers));
  const CrownThresholds thresholds = thresholdsOf(centers, rho, options);
  const std::vector<Generator> chosen =
      generatorsAt(randomFraction(centers, options.fraction, options.seed), rho);
  DensityField field(chosen, options.norm, weightOf(centers.size(), chosen.size()));
  report.seconds_generators = timer.lap();

  CrownField crown =
      makeCrownField(std::move(field), chosen, thresholds, options, 0.0f, surface, report);
  showStep(options, "vertices", 0.3);
  bake.light = bakeLight(plant, Frame(), crown, options, report);
  bake.surface = crown.takeSurface();
  report.seconds_total = total.seconds();
  return bake;
}

std::vector<DensityBake> bakeDensityPopulation(std::span<const Plant* const> plants,
                                               std::span<const Placement> placements,
                                               const DensityOptions& options) {
  checkOptions(options);
  if (placements.empty()) throw Error(kWhere, "the population has no plants", "place at least one");
  Timer total, timer;
  std::vector<std::vector<glm::vec3>> centers(plants.size());
  std::vector<std::size_t> skipped(plants.size());
  for (std::size_t p = 0; p < plants.size(); ++p)
    centers[p] = checkedCenters(*plants[p], skipped[p]);

  // Parameters come from the placement with the most leaves, as if it stood alone.
  std::size_t largest = 0;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (placements[i].plant >= plants.size())
      throw Error(kWhere, fmt::format("placement {} names plant {}, there are {}", i,
                                      placements[i].plant, plants.size()));
    if (!(placements[i].scale > 0.0f))
      throw Error(kWhere, fmt::format("placement {} has no positive scale", i));
    if (centers[placements[i].plant].size() > centers[placements[largest].plant].size())
      largest = i;
  }
  const auto placed = [&](const Placement& placement, const std::vector<glm::vec3>& points) {
    const Frame frame(placement);
    std::vector<glm::vec3> out(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) out[k] = frame.worldFromPlant(points[k]);
    return out;
  };
  const std::vector<glm::vec3> reference =
      placed(placements[largest], centers[placements[largest].plant]);
  const float rho = options.rho.value_or(defaultRho(centers[placements[largest].plant]) *
                                         placements[largest].scale);
  const CrownThresholds thresholds = thresholdsOf(reference, rho, options);
  const Lattice own =
      DensityField(generatorsAt(reference, rho), options.norm).lattice(options.grid);

  std::vector<Generator> chosen;
  std::size_t all = 0;
  for (const Placement& placement : placements) {
    const auto part = randomFraction(centers[placement.plant], options.fraction, options.seed);
    for (const Generator& g : generatorsAt(placed(placement, part), rho)) chosen.push_back(g);
    all += centers[placement.plant].size();
  }
  DensityField field(chosen, options.norm, weightOf(all, chosen.size()));
  DensityReport common;
  common.seconds_generators = timer.lap();
  CrownField crown =
      makeCrownField(std::move(field), chosen, thresholds, options,
                     own.spacing * static_cast<float>(options.grid), nullptr, common);

  std::vector<DensityBake> bakes(placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i) {
    showStep(options, "vertices", static_cast<double>(i) / static_cast<double>(placements.size()));
    bakes[i].report = common;
    bakes[i].report.leaves = plants[placements[i].plant]->leaves.size();
    bakes[i].report.skipped_leaves = skipped[placements[i].plant];
    bakes[i].light = bakeLight(*plants[placements[i].plant], Frame(placements[i]), crown, options,
                               bakes[i].report);
    bakes[i].report.seconds_total = total.seconds();
  }
  bakes[0].surface = crown.takeSurface();
  return bakes;
}

}  // namespace verdure
