#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#pragma GCC diagnostic pop
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <map>
#include <set>

#include "glb_reader.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/plant_io.h"
#include "verdure/wind_files.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;

Plant grown(const std::string& species = "black-oak", int levels = 3) {
  GrowOptions options;
  options.species = species;
  options.seed = 3;
  options.texture_size = 32;
  options.leaf_form = LeafForm::kCard;
  options.set = {{"Levels", std::to_string(levels)}};
  return grow(options);
}

MotionOptions smallTextures() {
  MotionOptions options;
  options.texture_width = 512;
  options.texture_height = 64;
  return options;
}

/// A plant, its motion, and the deflections that the documents of all targets speak of.
class WindFilesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    plant_ = new Plant(grown());
    motion_ = new PlantMotion(plantMotion(*plant_, smallTextures()));
  }
  static void TearDownTestSuite() {
    delete motion_;
    delete plant_;
  }

  static const VertexMotion& hung(std::size_t m, std::size_t v) {
    return motion_->tree.meshes[m][v];
  }
  /// m, for wind of 1 m/s, by branches of levels from `low` to `high`.
  static double bend(std::size_t m, std::size_t v, int low, int high) {
    double sum = 0.0;
    const VertexMotion& motion = hung(m, v);
    for (std::uint32_t b = motion.branch; b != kNone; b = motion_->tree.branches[b].parent) {
      const MotionBranch& branch = motion_->tree.branches[b];
      if (branch.level < low || branch.level > high) continue;
      const double x = double{motion.places[branch.level]}, c2 = double{branch.fit.x},
                   c4 = double{branch.fit.y};
      sum += double{motion_->branches[b].mean + motion_->branches[b].swing} *
             double{branch.length} * (c2 * x * x + c4 * x * x * x * x) / (c2 + c4);
    }
    return sum;
  }
  static double largestBend(int low, int high) {
    double most = 0.0;
    for (std::size_t m = 0; m < plant_->meshes.size(); ++m)
      for (std::size_t v = 0; v < plant_->meshes[m].positions.size(); ++v)
        most = std::max(most, bend(m, v, low, high));
    return most;
  }
  static std::uint32_t boughOf(std::uint32_t branch) {
    while (motion_->tree.branches[branch].level > 1) branch = motion_->tree.branches[branch].parent;
    return branch;
  }

  static fs::path exported(const std::string& target, const fs::path& dir,
                           const std::string& name = "oak.glb") {
    exportWind(*plant_, *motion_, target, dir / name);
    return dir / name;
  }

  using Channel = std::function<float(const glm::vec4&)>;
  /// Leaf edges move, from their stalks on; wood does not.
  static void expectLeafEdges(const GlbReader& file, const Channel& of, double step) {
    for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
      const auto colors = file.attribute(m, "COLOR_1");
      for (std::size_t v = 0; v < colors.size(); ++v) {
        const std::uint32_t leaf = hung(m, v).leaf;
        double expected = 0.0;
        if (leaf != kNone)
          expected =
              double{glm::length(plant_->meshes[m].positions[v] - plant_->leaves[leaf].stalk) /
                     motion_->leaves[leaf].reach};
        ASSERT_NEAR(double{of(colors[v])}, expected, step);
      }
    }
  }
  static void expectBend(const GlbReader& file, const std::string& name, const Channel& of, int low,
                         int high, double step) {
    const double most = largestBend(low, high);
    ASSERT_GT(most, 0.0);
    double seen = 0.0;
    for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
      const auto colors = file.attribute(m, name);
      for (std::size_t v = 0; v < colors.size(); ++v) {
        ASSERT_NEAR(double{of(colors[v])}, bend(m, v, low, high) / most, step);
        seen = std::max(seen, double{of(colors[v])});
      }
    }
    EXPECT_NEAR(seen, 1.0, 1e-6);
  }
  /// The same all over each group, and spread over [0, 1) between groups.
  static void expectPhases(const GlbReader& file, const Channel& of,
                           const std::function<std::uint64_t(const VertexMotion&)>& group) {
    std::map<std::uint64_t, float> phases;
    for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
      const auto colors = file.attribute(m, "COLOR_1");
      for (std::size_t v = 0; v < colors.size(); ++v)
        ASSERT_EQ(phases.emplace(group(hung(m, v)), of(colors[v])).first->second, of(colors[v]));
    }
    double mean = 0.0;
    std::array<int, 4> quarters{};
    for (const auto& [id, phase] : phases) {
      mean += double{phase} / static_cast<double>(phases.size());
      ++quarters[static_cast<std::size_t>(std::min(phase * 4.0f, 3.0f))];
    }
    ASSERT_GT(phases.size(), 12u);
    EXPECT_NEAR(mean, 0.5, 1.2 / std::sqrt(static_cast<double>(phases.size())));
    for (const int count : quarters) EXPECT_GT(count, 0);
  }
  static std::uint64_t leafOrBough(const VertexMotion& v) {
    return v.leaf != kNone ? v.leaf : (std::uint64_t{1} << 40) + boughOf(v.branch);
  }
  static std::uint64_t bough(const VertexMotion& v) { return boughOf(v.branch); }

  static Plant* plant_;
  static PlantMotion* motion_;
};
Plant* WindFilesTest::plant_ = nullptr;
PlantMotion* WindFilesTest::motion_ = nullptr;

constexpr double kByte = 0.5 / 255.0 + 1e-6;

const auto red = [](const glm::vec4& c) { return c.r; };
const auto green = [](const glm::vec4& c) { return c.g; };
const auto blue = [](const glm::vec4& c) { return c.b; };

// Readers: each takes the channels as the engine's documentation names them.

TEST_F(WindFilesTest, CrysisReadsItsColours) {
  // GPU Gems 3, 16: red leaf edges, green phase of each leaf, blue overall; alpha ambient
  // occlusion.
  const GlbReader file(exported("vertex-colour:crysis", scratchFolder("wind_crysis")));
  expectLeafEdges(file, red, kByte);
  expectPhases(file, green, leafOrBough);
  expectBend(file, "COLOR_1", blue, 1, 3, kByte);
  for (const glm::vec4& c : file.attribute(0, "COLOR_1")) ASSERT_EQ(c.a, 1.0f);
}

TEST_F(WindFilesTest, O3deReadsItsColours) {
  // Red: small and fast; green: delay; blue: large and slow.
  const GlbReader file(exported("vertex-colour:o3de", scratchFolder("wind_o3de")));
  expectLeafEdges(file, red, kByte);
  expectPhases(file, green, bough);
  expectBend(file, "COLOR_1", blue, 1, 3, kByte);
}

TEST_F(WindFilesTest, RedEclipseReadsItsColours) {
  // Red: leaf wiggliness; green: phase shift; blue: sway of branches.
  const GlbReader file(exported("vertex-colour:red-eclipse", scratchFolder("wind_redeclipse")));
  expectLeafEdges(file, red, kByte);
  expectPhases(file, green, leafOrBough);
  expectBend(file, "COLOR_1", blue, 1, 3, kByte);
}

TEST_F(WindFilesTest, SboxReadsItsColours) {
  // Red: leaves; green: branches that bend; blue: phase, the same across a leaf.
  const GlbReader file(exported("vertex-colour:sbox", scratchFolder("wind_sbox")));
  expectLeafEdges(file, red, kByte);
  expectBend(file, "COLOR_1", green, 1, 3, kByte);
  expectPhases(file, blue, leafOrBough);
}

TEST_F(WindFilesTest, DagorReadsItsColours) {
  // Red: fine jitter; green: its phase; the third is not used.
  const GlbReader file(exported("vertex-colour:dagor", scratchFolder("wind_dagor")));
  expectLeafEdges(file, red, kByte);
  expectPhases(file, green, leafOrBough);
  for (const glm::vec4& c : file.attribute(0, "COLOR_1")) ASSERT_EQ(c.b, 0.0f);
}

TEST_F(WindFilesTest, GdTree3dReadsItsColours) {
  // Green: most influence, red: none.
  const GlbReader file(exported("vertex-colour:gdtree3d", scratchFolder("wind_gdtree")));
  expectBend(file, "COLOR_1", green, 0, 3, kByte);
  for (const glm::vec4& c : file.attribute(0, "COLOR_1")) ASSERT_NEAR(c.r + c.g, 1.0f, 0.005f);
}

TEST_F(WindFilesTest, UnityReadsItsColoursAndSecondUvs) {
  // TreeVertex: red phase, green edge, alpha occlusion; uv1: primary, secondary.
  const GlbReader file(exported("vertex-colour:unity", scratchFolder("wind_unity")));
  expectPhases(file, red, bough);
  expectLeafEdges(file, green, kByte);
  expectBend(file, "TEXCOORD_1", red, 0, 0, 1e-5);
  expectBend(file, "TEXCOORD_1", green, 1, 3, 1e-5);
}

TEST_F(WindFilesTest, SpeedTree8ReadsItsVectors) {
  const GlbReader file(exported("speedtree8", scratchFolder("wind_speedtree")));
  // UnpackNormalFromFloat() of its shaders.
  const auto unpacked = [](float value) {
    const glm::vec3 key(16.0f, 1.0f, 0.0625f), scaled = value / key;
    return (scaled - glm::floor(scaled)) * 2.0f - 1.0f;
  };
  expectBend(file, "_SPEEDTREE8_TEXCOORD0", blue, 1, 3, 1e-5);
  for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
    const auto t1 = file.attribute(m, "_SPEEDTREE8_TEXCOORD1"),
               t2 = file.attribute(m, "_SPEEDTREE8_TEXCOORD2"),
               t3 = file.attribute(m, "_SPEEDTREE8_TEXCOORD3");
    for (std::size_t v = 0; v < t1.size(); ++v) {
      const std::uint32_t leaf = hung(m, v).leaf;
      const glm::vec3 anchor(t1[v].z, t1[v].w, t2[v].w);
      ASSERT_EQ(t3[v].w, leaf == kNone ? 0.0f : 2.0f);
      ASSERT_EQ(glm::vec3(t2[v]), plant_->meshes[m].positions[v]);
      if (leaf == kNone) continue;
      ASSERT_EQ(anchor, plant_->leaves[leaf].stalk);
      ASSERT_LT(glm::length(unpacked(t3[v].y) - motion_->leaves[leaf].axis), 0.11f);
      ASSERT_LT(glm::length(unpacked(t3[v].z) - motion_->leaves[leaf].normal), 0.11f);
    }
  }
}

TEST_F(WindFilesTest, AttributesNameTheTreeOfBeams) {
  const GlbReader file(exported("attributes", scratchFolder("wind_attributes")));
  for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
    const auto branch = file.attribute(m, "_BRANCH"), places = file.attribute(m, "_PLACES"),
               depth = file.attribute(m, "_HIERARCHY_DEPTH"),
               pivot = file.attribute(m, "_PIVOT_POSITION"),
               extent = file.attribute(m, "_BRANCH_EXTENT");
    const bool foliage = plant_->meshes[m].kind == PartKind::kFoliage;
    ASSERT_EQ(file.has(m, "_LEAF_ANCHOR"), foliage);
    ASSERT_EQ(file.has(m, "_LEAF_PHASE"), foliage);
    for (std::size_t v = 0; v < branch.size(); ++v) {
      const VertexMotion& motion = hung(m, v);
      const MotionBranch& beam = motion_->tree.branches[motion.branch];
      ASSERT_EQ(branch[v].x, static_cast<float>(motion.branch));
      ASSERT_EQ(places[v], motion.places);
      ASSERT_EQ(depth[v].x, static_cast<float>(beam.level));
      ASSERT_EQ(glm::vec3(pivot[v]), beam.root);
      ASSERT_EQ(extent[v].x, beam.length);
    }
  }
  EXPECT_FALSE(file.has(0, "COLOR_0"));
}

TEST_F(WindFilesTest, RecordsSayTheBranchesAndWhereTheirNumbersAreFrom) {
  const fs::path dir = scratchFolder("wind_records");
  exported("attributes", dir);
  const auto bytes = readFile(dir / "oak.wind.json");
  const Json json = Json::parse(bytes.begin(), bytes.end());
  ASSERT_EQ(json["branches"].size(), motion_->tree.branches.size());
  for (std::size_t b = 0; b < json["branches"].size(); ++b) {
    const Json& record = json["branches"][b];
    const MotionBranch& beam = motion_->tree.branches[b];
    EXPECT_EQ(record["parent"], beam.parent == kNone ? Json(nullptr) : Json(beam.parent));
    EXPECT_FLOAT_EQ(record["length_m"], beam.length);
    EXPECT_NEAR(record["frequency_hz"].get<double>(),
                std::min(2.55 * std::pow(double{beam.length}, -0.59), 15.0), 1e-4);
    for (const auto& [key, value] : record.items()) {
      const std::string base = key == "bend_c2" || key == "bend_c4" ? "bend_c2, bend_c4" : key;
      EXPECT_TRUE(key == "branch" || key == "level" || json["provenance"].contains(base)) << key;
    }
  }
}

/// Pivot Painter 2's textures, read by the library and by hand.
struct PivotPainterFiles {
  int width = 0, height = 0;
  std::vector<glm::vec3> pivots;
  std::vector<int> parents;
  std::vector<glm::vec3> axes;
  std::vector<float> extents;

  PivotPainterFiles(const fs::path& exr, const fs::path& tga) {
    Imf::InputFile file(exr.c_str());
    const auto box = file.header().dataWindow();
    width = box.max.x - box.min.x + 1;
    height = box.max.y - box.min.y + 1;
    const auto count = static_cast<std::size_t>(width * height);
    std::array<std::vector<std::uint16_t>, 4> channels;  // bits
    Imf::FrameBuffer buffer;
    const char* names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
      channels[c].resize(count);
      EXPECT_EQ(file.header().channels().findChannel(names[c])->type, Imf::HALF);
      buffer.insert(names[c], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(channels[c].data()), 2,
                                         2 * static_cast<std::size_t>(width)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(box.min.y, box.max.y);
    for (std::size_t i = 0; i < count; ++i) {
      pivots.emplace_back(glm::unpackHalf1x16(channels[0][i]), glm::unpackHalf1x16(channels[1][i]),
                          glm::unpackHalf1x16(channels[2][i]));
      parents.push_back(static_cast<int>(channels[3][i]) - 1024);
    }
    const auto bytes = readFile(tga);
    EXPECT_EQ(bytes[2], 2);  // true colour, not compressed
    EXPECT_EQ(bytes[12] | bytes[13] << 8, width);
    EXPECT_EQ(bytes[14] | bytes[15] << 8, height);
    EXPECT_EQ(bytes[16], 32);
    EXPECT_EQ(bytes[17], 8);  // from the bottom, 8 bits of alpha
    EXPECT_EQ(bytes.size(), 18 + 4 * count);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::uint8_t* p =
            &bytes[18 + 4 * static_cast<std::size_t>((height - 1 - y) * width + x)];
        axes.push_back(glm::vec3(p[2], p[1], p[0]) / 255.0f * 2.0f - 1.0f);
        extents.push_back(static_cast<float>(p[3]) / 255.0f * 2048.0f);
      }
  }
};

TEST_F(WindFilesTest, PivotPainterFindsPivotsAndParents) {
  const fs::path dir = scratchFolder("wind_pivots");
  const GlbReader file(exported("pivot-painter2", dir));
  const PivotPainterFiles textures(dir / "T_oak_PivPos16bit_ParentIndexInt_UV2.EXR",
                                   dir / "T_oak_XVector8bit_XExtentDividedby2048_UV2.TGA");
  const auto& branches = motion_->tree.branches;
  ASSERT_GT(branches.size(), 100u);
  ASSERT_GE(textures.parents.size(), branches.size());
  // Unreal's coordinates of a glTF point: (x, z, y), centimetres.
  const auto unreal = [](const glm::vec3& p) { return glm::vec3(p.x, p.z, p.y); };
  for (std::size_t b = 0; b < branches.size(); ++b) {
    const MotionBranch& beam = branches[b];
    const glm::vec3 cm = 100.0f * unreal(beam.root);
    for (int c = 0; c < 3; ++c)  // a half has 11 bits
      ASSERT_NEAR(textures.pivots[b][c], cm[c], std::max(std::abs(cm[c]) / 2048.0f, 1e-4f));
    ASSERT_EQ(textures.parents[b], static_cast<int>(beam.parent == kNone ? b : beam.parent));
    ASSERT_LT(glm::length(textures.axes[b] - unreal(beam.t)), 0.008f);
    // Steps of 8 cm, rounded up, in bytes of 1/255.
    ASSERT_NEAR(textures.extents[b], std::ceil(beam.length * 12.5f) * 8.0f, 4.1f);
  }
  // What the engine does: from UV2 to a texel, and on to the trunk.
  for (std::size_t m = 0; m < plant_->meshes.size(); ++m) {
    const auto uvs = file.attribute(m, "TEXCOORD_1");
    for (std::size_t v = 0; v < uvs.size(); v += 7) {
      const auto texel = [&](float x, int size) {
        const float at = x * static_cast<float>(size);
        EXPECT_NEAR(at - std::floor(at), 0.5f, 1e-3f);
        return static_cast<int>(at);
      };
      auto element = static_cast<std::uint32_t>(texel(uvs[v].y, textures.height) * textures.width +
                                                texel(uvs[v].x, textures.width));
      std::uint32_t b = hung(m, v).branch;
      for (int level = 0; level < kMotionLevels; ++level) {
        ASSERT_EQ(element, b);
        const auto parent = static_cast<std::uint32_t>(textures.parents[element]);
        if (parent == element) break;
        element = parent;
        b = branches[b].parent;
      }
      ASSERT_EQ(textures.parents[element], static_cast<int>(element));
    }
  }
}

TEST_F(WindFilesTest, AllTargetsPassTheKhronosValidator) {
  const fs::path dir = scratchFolder("wind_valid");
  std::vector<std::string> files;
  for (const WindTarget& target : windTargets()) {
    std::string name = target.name + ".glb";
    std::replace(name.begin(), name.end(), ':', '-');
    files.push_back(exported(target.name, dir, name).string());
    const GlbReader file(files.back());
    if (!file.has(0, "COLOR_0")) continue;
    for (const glm::vec4& c : file.attribute(0, "COLOR_0")) ASSERT_EQ(c, glm::vec4(1.0f));
  }
  const int code = runValidator(files);
  if (code > 1) GTEST_SKIP() << "the validator is not installed";
  EXPECT_EQ(code, 0);
}

TEST_F(WindFilesTest, AGrownPlantKeepsItsBranchesInItsFile) {
  const fs::path dir = scratchFolder("wind_stems");
  Plant far = *plant_;
  far.origin = {500.0, 20.0, -3000.0};
  savePlant(far, nullptr, dir / "oak.glb");
  const Plant back = loadPlant(dir / "oak.glb");
  ASSERT_EQ(back.branches.size(), plant_->branches.size());
  const glm::vec3 moved(far.origin - back.origin);
  for (std::size_t b = 0; b < back.branches.size(); ++b) {
    const Branch &was = plant_->branches[b], &is = back.branches[b];
    ASSERT_EQ(is.parent, was.parent);
    ASSERT_EQ(is.level, was.level);
    ASSERT_EQ(is.parent_offset, was.parent_offset);
    ASSERT_EQ(is.points.size(), was.points.size());
    for (std::size_t p = 0; p < is.points.size(); ++p) {
      ASSERT_LT(glm::length(is.points[p].position - was.points[p].position - moved), 1e-4f);
      ASSERT_EQ(is.points[p].radius, was.points[p].radius);
    }
  }
  for (std::size_t m = 0; m < back.meshes.size(); ++m)
    EXPECT_EQ(back.meshes[m].branch_of_vertex, plant_->meshes[m].branch_of_vertex);
  ASSERT_EQ(back.leaves.size(), plant_->leaves.size());
  std::size_t same = 0;
  for (std::size_t l = 0; l < back.leaves.size(); ++l)
    if (back.leaves[l].branch == plant_->leaves[l].branch) ++same;
  EXPECT_EQ(same, back.leaves.size());
  double off = 0.0;
  for (std::size_t l = 0; l < back.leaves.size(); ++l)
    off =
        std::max(off, double{glm::length(back.leaves[l].stalk - plant_->leaves[l].stalk - moved)});
  EXPECT_LT(off, 1e-3);  // far from the origin
  const MotionTree was = motionTree(*plant_), is = motionTree(back);
  ASSERT_EQ(is.branches.size(), was.branches.size());
  for (std::size_t b = 0; b < is.branches.size(); ++b) {
    EXPECT_EQ(is.branches[b].parent, was.branches[b].parent);
    EXPECT_NEAR(is.branches[b].length, was.branches[b].length, 1e-4f);
  }
  // And once more, from the exported file.
  exportWind(back, plantMotion(back, smallTextures()), "attributes", dir / "again.glb");
  EXPECT_EQ(loadPlant(dir / "again.glb").branches.size(), plant_->branches.size());
  EXPECT_EQ(glbJson(dir / "again.glb")["asset"], glbJson(dir / "oak.glb")["asset"]);
}

TEST_F(WindFilesTest, BranchesThatDoNotFitAreLeftOut) {
  const fs::path dir = scratchFolder("wind_broken");
  savePlant(*plant_, nullptr, dir / "oak.gltf");
  const auto bytes = readFile(dir / "oak.gltf");
  const Json whole = Json::parse(bytes.begin(), bytes.end());
  const auto load = [&](const std::function<void(Json&)>& harm) {
    Json json = whole;
    harm(json["asset"]["extras"]["verdure"]["stems"]);
    writeFile(dir / "oak.gltf", json.dump());
    return loadPlant(dir / "oak.gltf");
  };
  EXPECT_EQ(load([](Json&) {}).branches.size(), plant_->branches.size());
  // Other accessors: of other kinds, of other numbers.
  const std::vector<std::function<void(Json&)>> harms = {
      [](Json& stems) { stems["stems"] = 0; },
      [](Json& stems) { stems["stems"] = stems["points"]; },
      [](Json& stems) { stems["points"] = stems["stems"]; },
      [](Json& stems) { stems["points"] = 100000; },
      [](Json& stems) { stems["stalks"] = stems["points"]; },
      [](Json& stems) { stems.erase("points"); },
      [](Json& stems) {
        stems["origin"] = {5000, 0, 0};
      },
      [](Json& stems) { stems = "nothing"; }};
  for (const auto& harm : harms) {
    const Plant plant = load(harm);
    EXPECT_TRUE(plant.branches.empty());
    for (const Mesh& mesh : plant.meshes) EXPECT_TRUE(mesh.branch_of_vertex.empty());
    for (const Leaf& leaf : plant.leaves) ASSERT_EQ(leaf.branch, kNone);
  }
}

/// A foreign file: a box below nodes that turn, stretch and move it, with UVs in two sets.
struct ForeignFile : BoxFile {
  ForeignFile()
      : BoxFile(Json{{"name", "tree"}, {"scale", {2, 2, 2}}, {"translation", {1, 0, 3}}}) {
    json["asset"]["extras"] = {{"id", 12345678901}, {"verdure", {{"other", 1}}}};
    json["unknown"] = {{"deep", {1, 2.5, "x"}}};
    primitive()["attributes"]["TEXCOORD_1"] = floats(box.uvs);
    const glm::quat q = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, -1)));
    node({{"name", "above"}, {"rotation", {q.x, q.y, q.z, q.w}}, {"children", {0}}}, false);
    json["scenes"][0]["nodes"] = {1};
  }
  Plant load(const fs::path& dir) const {
    writeFile(dir / "in.glb", glb());
    Plant plant = loadPlant(dir / "in.glb");
    findBranches(plant);
    EXPECT_FALSE(plant.branches.empty());
    return plant;
  }
};

TEST(WindForeign, NothingElseChanges) {
  const fs::path dir = scratchFolder("wind_foreign");
  const Plant plant = ForeignFile().load(dir);
  const PlantMotion motion = plantMotion(plant, smallTextures());
  for (const WindTarget& target : windTargets()) {
    const WindFiles files = exportWind(plant, motion, target.name, dir / "out.glb");
    Json out = glbJson(dir / "out.glb"), expected = glbJson(dir / "in.glb");
    for (const std::string& name : files.attributes)
      if (name.rfind("_LEAF", 0) != 0) {  // the box has no leaves
        EXPECT_EQ(out["meshes"][0]["primitives"][0]["attributes"].erase(name), 1u) << name;
      }
    out["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0");
    if (target.name == "attributes") {
      EXPECT_EQ(out["asset"]["extras"]["verdure"].erase("stems"), 1u);
    }
    for (const char* key : {"buffers", "bufferViews", "accessors"}) {
      out.erase(key);
      expected.erase(key);
    }
    EXPECT_EQ(out, expected) << target.name;
    // The second set of UVs is taken.
    if (target.name == "pivot-painter2") {
      EXPECT_EQ(files.attributes[0], "TEXCOORD_2");
    }
  }
}

TEST(WindForeign, PointsAreInTheMeshesOwnCoordinates) {
  const fs::path dir = scratchFolder("wind_local");
  const Plant plant = ForeignFile().load(dir);
  const PlantMotion motion = plantMotion(plant, smallTextures());
  exportWind(plant, motion, "attributes", dir / "out.glb");
  const GlbReader file(dir / "out.glb");
  const glm::dmat4 world = file.pose(-1.0)[0];
  for (const glm::vec4& pivot : file.attribute(0, "_PIVOT_POSITION")) {
    const glm::dvec3 at(world * glm::dvec4(glm::dvec3(pivot), 1.0));
    EXPECT_LT(glm::length(at - glm::dvec3(motion.tree.branches[0].root) - plant.origin), 1e-5);
  }
}

class WindClip : public WindFilesTest {
 protected:
  static ClipOptions breeze() {
    ClipOptions options;
    options.wind.speed = 8.0f;
    options.wind.from = 1.0f;
    options.seconds = 2.0;
    options.fps = 24.0;
    return options;
  }
  /// Nodes with a skin, in the order of the plant's meshes.
  static std::vector<std::size_t> shown(const GlbReader& file) {
    std::vector<std::size_t> nodes;
    for (std::size_t n = 0; n < file.json["nodes"].size(); ++n)
      if (file.json["nodes"][n].contains("skin")) nodes.push_back(n);
    return nodes;
  }
  struct Errors {
    double wood = 0.0, leaf = 0.0, most = 0.0, way = 0.0;
  };
  static Errors against(const GlbReader& file, const Plant& plant, const PlantMotion& motion,
                        const Wind& wind, double time) {
    Plant moved = plant;
    movePlant(motion, wind, time, {}, moved);
    const auto world = file.pose(time);
    const auto nodes = shown(file);
    EXPECT_EQ(nodes.size(), plant.meshes.size());
    Errors errors;
    double counts[2] = {0, 0};
    for (std::size_t m = 0; m < nodes.size(); ++m) {
      const auto positions = file.skinned(nodes[m], world);
      for (std::size_t v = 0; v < positions.size(); ++v) {
        const glm::dvec3 p(moved.meshes[m].positions[v]);
        const double error = glm::length(positions[v] - p - plant.origin);
        const bool leaf = motion.tree.meshes[m][v].leaf != kNone;
        (leaf ? errors.leaf : errors.wood) += error * error;
        errors.way += glm::dot(p - glm::dvec3(plant.meshes[m].positions[v]),
                               p - glm::dvec3(plant.meshes[m].positions[v]));
        errors.most = std::max(errors.most, error);
        ++counts[leaf];
      }
    }
    errors.way = std::sqrt(errors.way / (counts[0] + counts[1]));
    errors.wood = std::sqrt(errors.wood / std::max(counts[0], 1.0));
    errors.leaf = std::sqrt(errors.leaf / std::max(counts[1], 1.0));
    return errors;
  }
};

TEST_F(WindClip, FollowsTheTrueMotion) {
  const fs::path dir = scratchFolder("clip_follows");
  double before = 1e9;
  for (const int joints : {16, 256, 4096}) {
    ClipOptions options = breeze();
    options.joints = joints;
    const ClipFiles report = exportClip(*plant_, *motion_, options, dir / "oak.glb");
    EXPECT_LE(report.joints, static_cast<std::size_t>(joints));
    const GlbReader file(dir / "oak.glb");
    EXPECT_EQ(file.json["skins"][0]["joints"].size(), report.joints);
    Errors worst;
    for (const double time : {0.0, 0.37, 0.75, 1.2}) {
      const Errors e = against(file, *plant_, *motion_, options.wind, time);
      worst.wood = std::max(worst.wood, e.wood);
      worst.leaf = std::max(worst.leaf, e.leaf);
      worst.way = std::max(worst.way, e.way);
      worst.most = std::max(worst.most, e.most);
    }
    std::printf(
        "%4zu joints, %zu of %zu branches: wood %.4f m, leaves %.4f m, most %.3f m, moved "
        "%.3f m; report %.4f %.4f %.3f %.3f\n",
        report.joints, report.bent_branches, report.branches, worst.wood, worst.leaf, worst.most,
        worst.way, report.wood_rms, report.leaf_rms, report.largest, report.motion_rms);
    EXPECT_GT(worst.way, 0.02);  // it does move
    EXPECT_LT(worst.wood, before);
    EXPECT_LT(worst.wood, (joints == 16 ? 0.7 : joints == 256 ? 0.3 : 0.18) * worst.way);
    EXPECT_NEAR(report.wood_rms, worst.wood, 0.6 * worst.wood + 1e-4);
    before = worst.wood;
  }
}

TEST_F(WindClip, ClosesItsLoop) {
  const fs::path dir = scratchFolder("clip_loop");
  const ClipOptions options = breeze();
  exportClip(*plant_, *motion_, options, dir / "oak.glb");
  const GlbReader file(dir / "oak.glb");
  const Json& animation = file.json["animations"][0];
  ASSERT_FALSE(animation["channels"].empty());
  for (const Json& sampler : animation["samplers"]) {
    std::size_t n = 0;
    const auto keys = file.values(sampler["output"], &n);
    double same = 0.0, other = 0.0;  // turns may have the other sign
    for (std::size_t i = 0; i < n; ++i) {
      const auto first_key = static_cast<double>(keys[i]),
                 last_key = static_cast<double>(keys[keys.size() - n + i]);
      same = std::max(same, std::abs(first_key - last_key));
      other = std::max(other, std::abs(first_key + last_key));
    }
    EXPECT_LT(n == 4 ? std::min(same, other) : same, 1e-5);
  }
  const double end = options.seconds, step = 1.0 / options.fps;
  const auto nodes = shown(file);
  double place = 0.0, velocity = 0.0, speed = 0.0, jump = 0.0;
  const auto at = [&](double t) { return file.skinned(nodes[0], file.pose(t)); };
  const auto first = at(0.0), second = at(step), third = at(2 * step), last = at(end),
             ahead = at(end - step);
  for (std::size_t v = 0; v < first.size(); ++v) {
    place = std::max(place, glm::length(first[v] - last[v]));
    const glm::dvec3 in = (last[v] - ahead[v]) / step, out = (second[v] - first[v]) / step,
                     later = (third[v] - second[v]) / step;
    velocity += glm::dot(out - in, out - in);
    jump += glm::dot(later - out, later - out);
    speed += glm::dot(out, out);
  }
  EXPECT_LT(place, 1e-4);
  // Over the end, velocity changes about as much as from one frame to the next.
  std::printf("change of velocity over the end %.3f, between frames %.3f, velocity %.3f m/s\n",
              std::sqrt(velocity / double(first.size())), std::sqrt(jump / double(first.size())),
              std::sqrt(speed / double(first.size())));
  EXPECT_LT(velocity, 4.0 * jump);
}

TEST_F(WindClip, PassesTheKhronosValidator) {
  const fs::path dir = scratchFolder("clip_valid");
  exportClip(*plant_, *motion_, breeze(), dir / "oak.glb");
  const Plant foreign = ForeignFile().load(dir);
  exportClip(foreign, plantMotion(foreign, smallTextures()), breeze(), dir / "foreign.gltf");
  const int code = runValidator({(dir / "oak.glb").string(), (dir / "foreign.gltf").string()});
  if (code > 1) GTEST_SKIP() << "the validator is not installed";
  EXPECT_EQ(code, 0);
}

TEST_F(WindClip, MovesForeignFilesBelowTheirNodes) {
  const fs::path dir = scratchFolder("clip_foreign");
  const Plant plant = ForeignFile().load(dir);
  const PlantMotion motion = plantMotion(plant, smallTextures());
  ClipOptions options = breeze();
  options.wind.speed = 20.0f;
  exportClip(plant, motion, options, dir / "out.glb");
  const GlbReader file(dir / "out.glb");
  for (const double time : {0.0, 0.8}) {
    const Errors e = against(file, plant, motion, options.wind, time);
    EXPECT_LT(e.most, 0.03 * bounds(plant).size().y);
    EXPECT_GT(e.way, 0.0);
  }
}

TEST_F(WindClip, StandsStillWithoutWind) {
  const fs::path dir = scratchFolder("clip_still");
  ClipOptions options = breeze();
  options.wind.speed = 0.0f;
  options.seconds = 0.5;
  exportClip(*plant_, *motion_, options, dir / "oak.glb");
  const GlbReader file(dir / "oak.glb");
  EXPECT_LT(against(file, *plant_, *motion_, options.wind, 0.3).most, 1e-4);
}

TEST_F(WindFilesTest, RefusesWhatItCannotWrite) {
  const fs::path dir = scratchFolder("wind_refused");
  EXPECT_THROW(exportWind(*plant_, *motion_, "vertex-colour:nothing", dir / "a.glb"), Error);
  EXPECT_THROW(exportWind(*plant_, *motion_, "attributes", dir / "a.fbx"), Error);
  for (const auto& [seconds, fps, joints] : {std::tuple{0.1, 24.0, 64},
                                             {61.0, 24.0, 64},
                                             {2.0, 4.0, 64},
                                             {2.0, 121.0, 64},
                                             {2.0, 24.0, 7},
                                             {2.0, 24.0, 5000},
                                             {std::nan(""), 24.0, 64}}) {
    ClipOptions options;
    options.seconds = seconds;
    options.fps = fps;
    options.joints = joints;
    EXPECT_THROW(exportClip(*plant_, *motion_, options, dir / "a.glb"), Error);
  }
  // All or none: the last of the files cannot be written.
  fs::create_directories(dir / "b.glb");
  EXPECT_THROW(exportWind(*plant_, *motion_, "pivot-painter2", dir / "b.glb"), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir), {}), 1);
}

}  // namespace
}  // namespace verdure
