#include "verdure/leaf_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/random.h"
#include "leaf/leaf_maps.h"
#include "scratch.h"
#include "shared/color.h"
#include "verdure/error.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Two bumps on a disk, wider than high; every map says something of its own.
LeafSet bumpyLeaf(int width = 48, int height = 32) {
  LeafSet set;
  set.name = "bumps";
  set.width = width;
  set.height = height;
  set.mm_per_texel = 0.125f;
  Random random(5);
  std::vector<bool> inside(set.texelCount());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 0.5f;
      const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 0.5f;
      const bool in = u * u + v * v < 0.23f;
      inside[set.opacity.size()] = in;
      set.opacity.push_back(in ? 1.0f : 0.0f);
      const float bump = std::exp(-40 * ((u - 0.1f) * (u - 0.1f) + v * v)) -
                         0.5f * std::exp(-60 * ((u + 0.2f) * (u + 0.2f) + (v - 0.1f) * (v - 0.1f)));
      set.thickness_mm.push_back(0.25f + 0.05f * u);
      set.front.relief_mm.push_back(0.1f + 0.2f * bump);
      set.back.relief_mm.push_back(0.12f - 0.1f * bump);
      for (LeafSide* side : {&set.front, &set.back}) {
        side->albedo.emplace_back(0.1f + 0.1f * random.uniform(), 0.2f, 0.05f);
        side->translucency.emplace_back(0.3f, 0.4f + 0.1f * random.uniform(), 0.02f);
      }
    }
  for (LeafSide* side : {&set.front, &set.back})
    for (const glm::vec2& s :
         slopesFromHeights(side->relief_mm, inside, width, height, set.mm_per_texel))
      side->normal.push_back(glm::normalize(glm::vec3(-s.x, s.y, 1)));
  return set;
}

float largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  float most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

float largestDifference(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  float most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, glm::length(a[i] - b[i]));
  return most;
}

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  return "no error";
}

void edit(const fs::path& folder, const std::function<void(Json&)>& change) {
  const auto bytes = readFile(folder / "leaf.json");
  Json json = Json::parse(bytes.begin(), bytes.end());
  change(json);
  writeFile(folder / "leaf.json", json.dump());
}

bool hasNote(const LeafSet& set, const std::string& part) {
  for (const std::string& note : set.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

TEST(LeafFiles, ComeBackWithinTheirRounding) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf();
  writeLeafSet(set, folder / "a");
  const LeafSet read = readLeafSet(folder / "a");
  EXPECT_EQ(read.name, set.name);
  EXPECT_EQ(read.width, 48);
  EXPECT_EQ(read.height, 32);
  EXPECT_EQ(read.mm_per_texel, set.mm_per_texel);
  EXPECT_EQ(read.opacity, set.opacity);
  EXPECT_TRUE(read.notes.empty());
  EXPECT_LT(largestDifference(read.thickness_mm, set.thickness_mm), 1e-6f);
  for (const bool front : {true, false}) {
    const LeafSide &a = front ? set.front : set.back, &b = front ? read.front : read.back;
    EXPECT_LT(largestDifference(a.relief_mm, b.relief_mm), 1e-5f);
    EXPECT_LT(largestDifference(a.normal, b.normal), 6e-5f);
    EXPECT_LT(largestDifference(a.albedo, b.albedo), 0.006f);
    EXPECT_LT(largestDifference(a.translucency, b.translucency), 0.006f);
  }
  // What has been rounded once stays: the second copy is the first, byte by byte.
  writeLeafSet(read, folder / "b");
  for (const auto& entry : fs::directory_iterator(folder / "a"))
    if (entry.path().extension() == ".png" &&
        entry.path().filename().string().find("normal") == std::string::npos) {
      EXPECT_EQ(readFile(entry.path()), readFile(folder / "b" / entry.path().filename()))
          << entry.path();
    }
}

TEST(LeafFiles, MakeTheBackOfTheFront) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf();
  writeLeafSet(set, folder);
  edit(folder, [](Json& json) { json.erase("back"); });
  const LeafSet read = readLeafSet(folder);
  EXPECT_TRUE(hasNote(read, "mirrored"));
  for (std::size_t i = 0; i < read.texelCount(); ++i) {
    ASSERT_NEAR(read.front.relief_mm[i] + read.back.relief_mm[i], read.thickness_mm[i], 1e-5f);
    ASSERT_GE(read.back.albedo[i].y, read.front.albedo[i].y);
  }
  // The normals are those of that relief.
  std::vector<bool> inside;
  for (const float o : read.opacity) inside.push_back(o >= 0.5f);
  const auto slopes =
      slopesFromHeights(read.back.relief_mm, inside, read.width, read.height, read.mm_per_texel);
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (inside[i]) {
      ASSERT_LT(glm::length(read.back.normal[i] -
                            glm::normalize(glm::vec3(-slopes[i].x, slopes[i].y, 1))),
                2e-3f);
    }
}

TEST(LeafFiles, FindReliefInNormalsAndNormalsInRelief) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf(96, 64);
  writeLeafSet(set, folder);
  edit(folder, [](Json& json) {
    json["front"].erase("relief");
    json["front"].erase("relief_range_mm");
    json["back"].erase("normal");
  });
  const LeafSet read = readLeafSet(folder);
  // The slopes of the disk's border are one-sided and those outside unknown: the inner half.
  double difference = 0, sum = 0, size = 0, mean_a = 0, mean_b = 0;
  std::vector<std::size_t> inner;
  for (int y = 0; y < set.height; ++y)
    for (int x = 0; x < set.width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(set.width) - 0.5f;
      const float v = static_cast<float>(y) / static_cast<float>(set.height) - 0.5f;
      if (u * u + v * v < 0.12f) inner.push_back(static_cast<std::size_t>(y * set.width + x));
    }
  for (const std::size_t i : inner) {
    mean_a += set.front.relief_mm[i] / static_cast<double>(inner.size());
    mean_b += read.front.relief_mm[i] / static_cast<double>(inner.size());
  }
  for (const std::size_t i : inner) {
    const double a = set.front.relief_mm[i] - mean_a, b = read.front.relief_mm[i] - mean_b;
    difference += (a - b) * (a - b);
    sum += a * a;
    size += 1;
  }
  EXPECT_GT(size, 1000);
  EXPECT_LT(std::sqrt(difference / sum), 0.03);
  EXPECT_LT(largestDifference(read.back.normal, set.back.normal), 1e-3f);
  EXPECT_TRUE(hasNote(read, "front's relief comes from its normals"));
  EXPECT_TRUE(hasNote(read, "back's normals come from its relief"));
}

TEST(LeafFiles, HeightsOfSlopesAreExactOnAnySize) {
  // The rises between neighbours of this height are integrable, so least squares has no residual.
  const int width = 37, height = 20;
  std::vector<float> heights;
  std::vector<glm::vec2> slopes;
  double mean = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto u = static_cast<float>(x), v = static_cast<float>(y);
      // A plane and a saddle: the mean of two slopes is exactly the rise between the texels.
      heights.push_back(0.3f * u - 0.2f * v + 0.01f * u * v);
      slopes.emplace_back((0.3f + 0.01f * v) / 0.5f, (-0.2f + 0.01f * u) / 0.5f);
      mean += heights.back();
    }
  const std::vector<float> found = heightsFromSlopes(slopes, width, height, 0.5f);
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i], heights[i] - mean / (width * height), 2e-4) << i;
}

TEST(LeafFiles, ScaleDownWhatWouldSendOutTooMuch) {
  LeafSet set = bumpyLeaf();
  set.front.albedo[800] = {0.6f, 0.9f, 0.2f};
  set.back.translucency[800] = {0.3f, 0.6f, 0.1f};
  const fs::path folder = scratchFolder("leaf");
  writeLeafSet(set, folder);
  const LeafSet read = readLeafSet(folder);
  ASSERT_GE(set.opacity[800], 0.5f);
  EXPECT_TRUE(hasNote(read, "sum to more than 1"));
  const glm::vec3 sum = read.front.albedo[800] + read.back.translucency[800];
  EXPECT_NEAR(sum.y, 1.0f, 1e-5f);
  EXPECT_NEAR(read.front.albedo[800].y / read.back.translucency[800].y, 1.5f, 0.02f);
  EXPECT_NEAR(sum.x, 0.9f / 1.5f, 0.01f) << "the hue stays";
}

TEST(LeafFiles, ReadEveryKindOfPng) {
  const fs::path folder = scratchFolder("leaf");
  const auto texels = static_cast<std::size_t>(6 * 4);
  for (int channels = 1; channels <= 4; ++channels) {
    Image16 image{6, 4, channels, {}};
    for (std::size_t i = 0; i < texels * static_cast<std::size_t>(channels); ++i)
      image.values.push_back(static_cast<std::uint16_t>(1000 + 2600 * i % 64000));
    writeFile(folder / "map.png", encodePng(image));
    const LeafMap map = readLeafMap(folder / "map.png");
    EXPECT_EQ(map.width, 6);
    EXPECT_EQ(map.height, 4);
    ASSERT_EQ(map.channels, channels);
    for (std::size_t i = 0; i < map.values.size(); ++i)
      ASSERT_EQ(map.values[i], static_cast<float>(image.values[i]) / 65535.0f);
  }
  Image bytes(6, 4);
  for (std::size_t i = 0; i < bytes.rgba.size(); ++i)
    bytes.rgba[i] = static_cast<std::uint8_t>(7 * i);
  writePng(bytes, folder / "map.png");
  const LeafMap map = readLeafMap(folder / "map.png");
  ASSERT_EQ(map.channels, 4);
  for (std::size_t i = 0; i < map.values.size(); ++i)
    ASSERT_EQ(map.values[i], static_cast<float>(bytes.rgba[i]) / 255.0f);
}

TEST(LeafFiles, TakeNumbersFromExr) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf();
  writeLeafSet(set, folder);
  HdrImage thickness(set.width, set.height), normal = thickness, relief = thickness;
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    thickness.rgb[i] = glm::vec3(2 * set.thickness_mm[i]);
    normal.rgb[i] = set.back.normal[i];
    relief.rgb[i] = glm::vec3(-set.front.relief_mm[i]);
  }
  writeExr(thickness, folder / "t.exr");
  writeExr(normal, folder / "n.exr", ExrDepth::kHalf);
  writeExr(relief, folder / "r.exr");
  edit(folder, [](Json& json) {
    json["thickness"] = "t.exr";
    json.erase("thickness_range_mm");
    json["front"]["normal"] = "n.exr";
    json["front"]["relief"] = "r.exr";
    json["front"].erase("relief_range_mm");
  });
  const LeafSet read = readLeafSet(folder);
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    ASSERT_EQ(read.thickness_mm[i], 2 * set.thickness_mm[i]);
    ASSERT_EQ(read.front.relief_mm[i], -set.front.relief_mm[i]);
    ASSERT_LT(glm::length(read.front.normal[i] - set.back.normal[i]), 1e-3f);
  }
}

TEST(LeafFiles, FindMapsByTheirNames) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf();
  writeLeafSet(set, folder / "set");
  fs::create_directories(folder / "maps");
  const auto copy = [&](const char* from, const char* to) {
    fs::copy_file(folder / "set" / from, folder / "maps" / to);
  };
  copy("front_albedo.png", "Set_1K_Color.png");
  copy("front_normal.png", "Set_1K_NormalGL.png");
  copy("front_translucency.png", "Set_1K_Scattering.png");
  copy("front_relief.png", "Set_1K_Displacement.png");
  copy("opacity.png", "Set_1K_Opacity.png");
  copy("thickness.png", "readme_NormalDX.png");
  LeafImportOptions options;
  EXPECT_NE(errorOf([&] { importLeafSet(folder / "maps", options); }).find("millimetres per texel"),
            std::string::npos);
  options.width_mm = 48 * 0.125f;
  EXPECT_NE(errorOf([&] { importLeafSet(folder / "maps", options); }).find("how thick"),
            std::string::npos);
  options.thickness_mm = 0.25f;
  const LeafSet read = importLeafSet(folder / "maps", options);
  EXPECT_EQ(read.name, "Set_1K");
  EXPECT_FLOAT_EQ(read.mm_per_texel, 0.125f);
  EXPECT_EQ(read.thickness_mm, std::vector<float>(set.texelCount(), 0.25f));
  EXPECT_LT(largestDifference(read.front.translucency, set.front.translucency), 0.006f);
  EXPECT_TRUE(hasNote(read, "front's relief comes from its normals"));
  options.relief_mm = 0.5f;
  const LeafSet high = importLeafSet(folder / "maps", options);
  const auto [least, most] =
      std::minmax_element(high.front.relief_mm.begin(), high.front.relief_mm.end());
  EXPECT_NEAR(*most - *least, 0.5f, 1e-4f);
}

TEST(LeafFiles, AreRefusedWithOneLine) {
  const fs::path folder = scratchFolder("leaf");
  const LeafSet set = bumpyLeaf();
  const auto refused = [&](const std::function<void(Json&)>& change) {
    writeLeafSet(set, folder);
    edit(folder, change);
    return errorOf([&] { readLeafSet(folder); });
  };
  const auto expect = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << " lacks: " << part;
  };
  expect(refused([](Json& j) { j.erase("mm_per_texel"); }), "millimetres per texel");
  expect(refused([](Json& j) { j["mm_per_texel"] = 0; }), "mm_per_texel is 0");
  expect(refused([](Json& j) { j["mm_per_texel"] = "wide"; }), "mm_per_texel is no number");
  expect(refused([](Json& j) { j.erase("thickness_range_mm"); }), "thickness_range_mm");
  expect(refused([](Json& j) { j["thickness_range_mm"] = {0, 0}; }), "0 mm thick");
  expect(refused([](Json& j) { j["thickness_range_mm"] = 3; }), "pair of numbers");
  expect(refused([](Json& j) { j["front"].erase("albedo"); }), "no albedo");
  expect(refused([](Json& j) { j["front"]["albedo"] = "gone.png"; }), "gone.png: no such file");
  expect(refused([](Json& j) { j["front"].erase("relief_range_mm"); }), "relief_range_mm");
  expect(refused([](Json& j) { j["thicknes"] = 1; }), "'thicknes'");
  expect(refused([](Json& j) { j["front"]["color"] = "a.png"; }), "front: has an unknown");
  expect(refused([](Json& j) { j["front"] = 5; }), "front: is no object");
  expect(refused([](Json& j) { j["version"] = 9; }), "version");
  expect(refused([](Json& j) { j["format"] = "leaf"; }), "is no leaf");
  expect(refused([](Json& j) { j["optics"]["absorption_per_mm"] = 0; }), "absorption");
  expect(refused([](Json& j) { j["optics"]["anisotropy"] = 1; }), "anisotropy");
  expect(refused([](Json& j) { j["opacity"] = "leaf.json"; }), "image cannot be decoded");
  writeLeafSet(set, folder);
  writePng(Image(8, 8), folder / "small.png");
  edit(folder, [](Json& j) { j["opacity"] = "small.png"; });
  const std::string sizes = errorOf([&] { readLeafSet(folder); });
  expect(sizes, "48 x 32");
  expect(sizes, "small.png 8 x 8");
  writePng(Image(48, 32), folder / "small.png");
  expect(errorOf([&] { readLeafSet(folder); }), "shows no leaf");
  writeFile(folder / "leaf.json", std::string("{\"format\": "));
  expect(errorOf([&] { readLeafSet(folder); }), "no JSON at byte");
  expect(errorOf([&] { readLeafSet(folder / "nowhere"); }), "no such file");
  expect(errorOf([&] { importLeafSet(folder / "nowhere", {}); }), "is no folder");
}

TEST(LeafFiles, ReadTheScannedSet) {
  const char* plants = std::getenv("VERDURE_PLANT_DIR");
  if (plants == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  LeafImportOptions options;
  options.mm_per_texel = 0.1f;
  options.thickness_mm = 0.2f;
  const LeafSet set = importLeafSet(fs::path(plants) / ".." / "leaves", options);
  EXPECT_EQ(set.width, 1024);
  EXPECT_TRUE(hasNote(set, ": 9.7 % of the leaf for light on the front"))
      << "counted by another program: 10.9 % over 1, 9.7 % over 1.01";
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    const glm::vec3 sum = set.front.albedo[i] + set.back.translucency[i];
    ASSERT_LE(std::max({sum.x, sum.y, sum.z}), 1.00001f);
  }
}

}  // namespace
}  // namespace verdure
