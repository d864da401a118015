// bench grass.
#include "app/bench_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "app/commands.h"
#include "app/json_numbers.h"
#include "base/progress.h"
#include "render/frame.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

/// Frames of each kind where their number is not given.
constexpr int kMostFrames = 15;
constexpr double kSeconds = 12.0;  ///< of a table
/// A football pitch about the eye.
constexpr float kPitch_m = 50.0f;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Medians; times are the GPU's for the picture before its tone curve.
struct MeasuredWay {
  double ms = 0.0;
  double of_first = 1.0;  ///< times as long as the first of those measured in turns
  int frames = 0;
  std::uint32_t polygons = 0;  ///< this and what follows: where it was drawn with polygons
  float radius_m = 0.0f;
  double sort_ms = 0.0;  ///< of the CPU, not in `ms`
};

/// One way to draw a meadow.
struct Way {
  GpuScene* scene = nullptr;
  std::optional<BillboardTrial> billboards = {};
};

/// Meadows that nothing else stands on.
class GrassBench {
 public:
  explicit GrassBench(const BenchGrassCommand& command)
      : device_(command.device.device, command.device.validation),
        drawer_(device_),
        set_(growGrass(grassSpecies(command.species))),
        frames_(command.frames) {
    view_.terms = presetTerms("habel");
    view_.terms.ambient_source = AmbientSource::kSky;
    view_.terms.shadow = false;  // nothing casts one
    view_.shadow_map_size = 16;
    // The horizon is near the upper edge; slices stand askew to the picture.
    view_.camera = {{0.0f, 1.7f, 0.0f}, {0.0f, -1.0f, -10.0f}, 0.6f};
  }

  const std::string& deviceName() const { return device_.name(); }

  std::unique_ptr<GpuScene> meadow(int most_slices, float spacing) {
    GrassSet set = set_;
    set.spacing_m *= spacing;
    GrassLayer layer;
    layer.set = &set;
    layer.most_slices = most_slices;
    layer.middle = layer.blades = false;
    Scene scene;
    scene.grass = {layer};
    return std::make_unique<GpuScene>(device_, packScene(scene), drawer_.sceneLayouts());
  }

  /// In turns: a machine that is slow for a while is so for all.
  std::vector<MeasuredWay> measure(const std::pair<int, int>& size, const std::vector<Way>& ways) {
    // To warm up. Drivers compile for powers of two and other sizes apart: an eighth is as the
    // whole.
    std::tie(view_.width, view_.height) =
        std::pair(std::max(size.first / 8, 1), std::max(size.second / 8, 1));
    for (const Way& way : ways) draw(way);
    std::tie(view_.width, view_.height) = size;
    std::vector<std::vector<double>> times(ways.size()), ratios(ways.size()), sorts(ways.size());
    std::vector<MeasuredWay> measured(ways.size());
    const Timer timer;
    for (int round = 0; round < frames_.value_or(kMostFrames); ++round) {
      if (!frames_ && round > 0 && timer.seconds() * (round + 1) / round > kSeconds) break;
      for (std::size_t i = 0; i < ways.size(); ++i) {
        times[i].push_back(draw(ways[i]));
        ratios[i].push_back(times[i].back() / times[0].back());
        const GrassBillboards& drawn = drawer_.billboards();
        sorts[i].push_back(drawn.sortMilliseconds());
        measured[i].polygons = drawn.count();
        measured[i].radius_m = drawn.radius();
        measured[i].frames = round + 1;
      }
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
      measured[i].ms = median(times[i]);
      measured[i].of_first = median(ratios[i]);
      measured[i].sort_ms = median(sorts[i]);
    }
    if (measured[0].ms <= 0.0)
      throw Error(deviceName(), "has no timers", "choose another with --device");
    return measured;
  }

 private:
  double draw(const Way& way) {
    drawer_.tryBillboards(way.billboards);
    return drawer_.draw(*way.scene, view_).times.color_ms;
  }

  gpu::Device device_;
  FrameDrawer drawer_;
  GrassSet set_;
  View view_;
  std::optional<int> frames_;
};

/// All that is measured.
struct GrassTable {
  struct Picture {
    std::pair<int, int> size;
    MeasuredWay traced;
    MeasuredWay near;      ///< as far as rays meet slices one by one
    MeasuredWay near_cut;  ///< the same in exact order
    MeasuredWay far;
  };
  struct Spacing {
    float factor = 1.0f;
    MeasuredWay traced, near;
  };
  std::vector<Picture> pictures;
  std::pair<int, int> size;  ///< of the rest
  std::vector<std::pair<int, MeasuredWay>> most_slices;
  std::vector<Spacing> spacings;
};

GrassTable measureGrass(GrassBench& bench, const std::vector<std::pair<int, int>>& sizes) {
  Progress progress("measuring");
  GrassTable table;
  std::vector<std::unique_ptr<GpuScene>> meadows;
  meadows.push_back(bench.meadow(GrassLayer{}.most_slices, 1.0f));
  std::vector<Way> ways{{meadows[0].get()},
                        {meadows[0].get(), BillboardTrial{}},
                        {meadows[0].get(), BillboardTrial{.cut = true}},
                        {meadows[0].get(), BillboardTrial{.radius_m = kPitch_m}}};
  for (const auto& size : sizes) {
    progress.show(fmt::format("{} x {} pixels", size.first, size.second));
    const std::vector<MeasuredWay> m = bench.measure(size, ways);
    table.pictures.push_back({size, m[0], m[1], m[2], m[3]});
  }
  const auto smallest = std::min_element(
      table.pictures.begin(), table.pictures.end(), [](const auto& a, const auto& b) {
        return a.size.first * a.size.second < b.size.first * b.size.second;
      });
  table.size = smallest->size;

  progress.show("slices on a ray");
  ways.clear();
  for (const int slices : {4, 8, 16, 32}) {
    meadows.push_back(bench.meadow(slices, 1.0f));
    ways.push_back({meadows.back().get()});
    table.most_slices.emplace_back(slices, MeasuredWay{});
  }
  std::vector<MeasuredWay> m = bench.measure(table.size, ways);
  for (std::size_t i = 0; i < m.size(); ++i) table.most_slices[i].second = m[i];

  progress.show("distances of slices");
  ways.clear();
  const BillboardTrial near{.radius_m = smallest->near.radius_m};
  for (const float factor : {0.5f, 1.0f, 2.0f}) {
    meadows.push_back(bench.meadow(GrassLayer{}.most_slices, factor));
    ways.push_back({meadows.back().get()});
    ways.push_back({meadows.back().get(), near});
    table.spacings.push_back({factor, {}, {}});
  }
  m = bench.measure(table.size, ways);
  for (std::size_t i = 0; i < table.spacings.size(); ++i) {
    table.spacings[i].traced = m[2 * i];
    table.spacings[i].near = m[2 * i + 1];
  }
  return table;
}

std::string nameOf(const std::pair<int, int>& size) {
  return fmt::format("{}x{}", size.first, size.second);
}

void print(const GrassTable& table) {
  constexpr const char* kRow = "{:>10} {:>7} {:>11}   {:40} {:>9} {:>8} {:>9}\n";
  const auto number = [](double value) { return fmt::format("{:.1f}", value); };
  fmt::print(fmt::runtime(kRow), "pixels", "frames", "traced, ms", "polygons", "ms", "speedup",
             "sort, ms");
  for (const GrassTable::Picture& p : table.pictures) {
    std::string size = nameOf(p.size), frames = std::to_string(p.traced.frames),
                traced = number(p.traced.ms);
    for (const MeasuredWay* m : {&p.near, &p.near_cut, &p.far}) {
      const char* cut = m == &p.near_cut ? ", cut at crossings" : "";
      fmt::print(fmt::runtime(kRow), size, frames, traced,
                 fmt::format("{} to {:.1f} m{}", m->polygons, double{m->radius_m}, cut),
                 number(m->ms), fmt::format("{:.2f}", m->of_first), number(m->sort_ms));
      size = frames = traced = "";
    }
  }
  fmt::print("Polygons are found and sorted by the CPU; that is in no other column.\n");
  fmt::print("\n{:>10} {:>11}   at {}\n", "slices", "traced, ms", nameOf(table.size));
  for (const auto& [slices, measured] : table.most_slices)
    fmt::print("{:>10} {:11.1f}\n", slices, measured.ms);
  fmt::print("\n{:>10} {:>11} {:>13} {:>8} {:>9}\n", "distances", "traced, ms", "polygons, ms",
             "speedup", "polygons");
  for (const auto& [factor, traced, near] : table.spacings)
    fmt::print("{:>9}x {:11.1f} {:13.1f} {:8.2f} {:9}\n", double{factor}, traced.ms, near.ms,
               near.of_first / traced.of_first, near.polygons);
}

Json jsonOf(const MeasuredWay& m) {
  return {{"ms", sixDigits(m.ms)},
          {"speedup", sixDigits(m.of_first)},
          {"polygons", m.polygons},
          {"radius_m", sixDigits(double{m.radius_m})},
          {"sort_ms", sixDigits(m.sort_ms)}};
}

Json jsonOf(const GrassTable& table) {
  Json pictures = Json::array(), most = Json::array(), spacings = Json::array();
  for (const GrassTable::Picture& p : table.pictures)
    pictures.push_back({{"width", p.size.first},
                        {"height", p.size.second},
                        {"frames", p.traced.frames},
                        {"traced_ms", sixDigits(p.traced.ms)},
                        {"near", jsonOf(p.near)},
                        {"near_cut", jsonOf(p.near_cut)},
                        {"far", jsonOf(p.far)}});
  for (const auto& [slices, measured] : table.most_slices)
    most.push_back({{"slices", slices}, {"traced_ms", sixDigits(measured.ms)}});
  for (const auto& [factor, traced, near] : table.spacings)
    spacings.push_back({{"factor", sixDigits(double{factor})},
                        {"traced_ms", sixDigits(traced.ms)},
                        {"polygons_ms", sixDigits(near.ms)},
                        {"polygons", near.polygons}});
  return {{"pictures", pictures},
          {"width", table.size.first},
          {"height", table.size.second},
          {"most_slices", most},
          {"distances", spacings}};
}

}  // namespace

void runBenchGrass(const BenchGrassCommand& command) {
  const int frames = command.frames.value_or(1);
  if (frames < 1 || frames > 1000)
    throw Error("--frames", fmt::format("{} is out of range", frames), "choose 1 to 1000");
  std::vector<std::pair<int, int>> sizes;
  for (const std::string& size : command.sizes) sizes.push_back(parseSize(size));
  const std::vector<std::string>& known = grassSpeciesNames();
  if (std::find(known.begin(), known.end(), command.species) == known.end())
    throw Error("--species", fmt::format("there is no grass '{}'", command.species),
                fmt::format("use {}", fmt::join(known, ", ")));
  try {
    GrassBench bench(command);
    const GrassTable table = measureGrass(bench, sizes);
    if (command.json) {
      Json json{{"device", bench.deviceName()}, {"species", command.species}};
      json.update(jsonOf(table));
      fmt::print("{}\n", json.dump(2));
    } else {
      fmt::print("{}: {} from eye height, medians\n", bench.deviceName(), command.species);
      print(table);
    }
  } catch (const vk::Error& e) {
    throw Error("bench grass", std::string("the driver failed (") + e.what() + ")",
                "try smaller pictures with --size, or another --device");
  }
}

}  // namespace verdure::app
