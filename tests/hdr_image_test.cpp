#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/files.h"
#include "base/random.h"
#include "scratch.h"
#include "verdure/image.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

HdrImage randomImage(int width, int height) {
  HdrImage image(width, height);
  Random random(3);
  for (glm::vec3& p : image.rgb)
    p = glm::exp(glm::vec3(random.vary(20.0f), random.vary(20.0f), random.vary(20.0f)));
  return image;
}

std::string problem(const Bytes& bytes, const std::string& name) {
  try {
    decodeHdrImage(bytes, name);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Exr, KeepsEveryBit) {
  const fs::path file = scratchFolder("verdure_exr") / "a.exr";
  HdrImage image = randomImage(37, 21);
  image.at(3, 4) = glm::vec3(0.0f, std::numeric_limits<float>::max(), 1e-42f);
  writeExr(image, file);
  const HdrImage back = readHdrImage(file);
  ASSERT_EQ(back.width, 37);
  ASSERT_EQ(back.height, 21);
  EXPECT_EQ(back.rgb, image.rgb);
}

TEST(Exr, RefusesWhatIsNoLight) {
  const fs::path file = scratchFolder("verdure_exr_bad") / "a.exr";
  HdrImage image(4, 3);
  EXPECT_THROW(writeExr(HdrImage{}, file), Error);
  image.at(2, 1).y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(writeExr(image, file), Error);
  EXPECT_FALSE(fs::exists(file));
}

/// Writes a file as other programs do, with the library itself.
struct OtherWriter {
  Imf::PixelType type = Imf::FLOAT;
  std::vector<std::string> names = {"R", "G", "B"};
  Imath::Box2i display{{0, 0}, {3, 2}}, data{{0, 0}, {3, 2}};
  int sampling = 1;
  bool tiled = false;
  bool aces = false;

  Bytes bytes(const std::vector<float>& pixels) const {  // names.size() a pixel
    const fs::path file = scratchFolder("verdure_exr_other") / "a.exr";
    Imf::Header header(display, data);
    if (aces)
      Imf::addChromaticities(
          header, {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}});
    Imf::FrameBuffer buffer;
    std::vector<half> halves(pixels.begin(), pixels.end());
    const bool is_half = type == Imf::HALF;
    const std::size_t size = is_half ? sizeof(half) : sizeof(float);
    const char* first = is_half ? reinterpret_cast<const char*>(halves.data())
                                : reinterpret_cast<const char*>(pixels.data());
    const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
    for (std::size_t c = 0; c < names.size(); ++c) {
      header.channels().insert(names[c], Imf::Channel(type, sampling, sampling));
      buffer.insert(names[c], Imf::Slice::Make(
                                  type, first + c * size, data, size * names.size(),
                                  size * names.size() * width / static_cast<std::size_t>(sampling),
                                  sampling, sampling));
    }
    if (tiled) {
      header.setTileDescription({2, 2, Imf::ONE_LEVEL});
      Imf::TiledOutputFile out(file.c_str(), header);
      out.setFrameBuffer(buffer);
      out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
    } else {
      Imf::OutputFile out(file.c_str(), header);
      out.setFrameBuffer(buffer);
      out.writePixels(data.max.y - data.min.y + 1);
    }
    return readFile(file);
  }
};

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = 0.25f * static_cast<float>(i);
  return values;
}

TEST(Exr, ReadsWhatOthersWrite) {
  for (const bool tiled : {false, true})
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
      OtherWriter writer;
      writer.type = type;
      writer.tiled = tiled;
      writer.names = {"R", "G", "B", "A"};
      const HdrImage image = decodeHdrImage(writer.bytes(ramp(48)), "a.exr");
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
          EXPECT_EQ(image.at(x, y), static_cast<float>(4 * y + x) + glm::vec3(0.0f, 0.25f, 0.5f));
    }
  OtherWriter grey;
  grey.names = {"Y"};
  EXPECT_EQ(decodeHdrImage(grey.bytes(ramp(12)), "a.exr").at(1, 2), glm::vec3(2.25f));
}

TEST(Exr, ShowsTheDisplayWindow) {
  OtherWriter writer;
  writer.display = {{10, 20}, {12, 22}};
  writer.data = {{11, 19}, {14, 21}};
  writer.names = {"Y"};
  const HdrImage image = decodeHdrImage(writer.bytes(ramp(12)), "a.exr");
  ASSERT_EQ(image.width, 3);
  ASSERT_EQ(image.height, 3);
  EXPECT_EQ(image.at(0, 0).x, 0.0f);   // left of the data
  EXPECT_EQ(image.at(1, 0).x, 1.0f);   // its row 1, column 0
  EXPECT_EQ(image.at(2, 1).x, 2.25f);  // its row 2, column 1
  EXPECT_EQ(image.at(2, 2).x, 0.0f);   // below it
}

TEST(Exr, SaysWhatItCannotRead) {
  OtherWriter subsampled;
  subsampled.names = {"Y"};
  subsampled.sampling = 2;
  subsampled.display = subsampled.data = {{0, 0}, {3, 3}};
  EXPECT_NE(problem(subsampled.bytes(ramp(16)), "a.exr").find("Y is subsampled"),
            std::string::npos);
  OtherWriter layers;
  layers.names = {"left.R", "left.G", "left.B"};
  EXPECT_NE(problem(layers.bytes(ramp(36)), "a.exr").find("no channel R"), std::string::npos);
  OtherWriter aces;
  aces.aces = true;
  EXPECT_NE(problem(aces.bytes(ramp(36)), "a.exr").find("primaries"), std::string::npos);
}

TEST(Exr, NamesThePixelThatIsNoLight) {
  const OtherWriter writer;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.5f}) {
    std::vector<float> values = ramp(36);
    values[3 * (2 * 4 + 1) + 2] = bad;  // pixel 1, 2
    const std::string what = problem(writer.bytes(values), "sky.exr");
    EXPECT_NE(what.find("sky.exr: pixel 1, 2 is"), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos);
  }
  // Noise around black is none.
  std::vector<float> values = ramp(36);
  values[5] = -0.01f;
  EXPECT_EQ(decodeHdrImage(writer.bytes(values), "a.exr").at(1, 0).z, 0.0f);
}

void expectSurvivesDamage(const Bytes& good, const std::string& name) {
  ASSERT_EQ(problem(good, name), "");
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_NE(problem(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)), name),
              "")
        << size << " of " << good.size() << " bytes";
  Random random(9);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bad = good;
    for (int k = 0; k < 3; ++k)
      bad[random.below(static_cast<std::uint32_t>(bad.size()))] =
          static_cast<std::uint8_t>(random.next());
    problem(bad, name);  // an Error or an image, never a crash
  }
}

TEST(Exr, SurvivesDamage) {
  const fs::path file = scratchFolder("verdure_exr_damage") / "a.exr";
  writeExr(randomImage(20, 18), file);
  expectSurvivesDamage(readFile(file), "a.exr");
}

Bytes radianceHeader(int width, int height, const std::string& more = "") {
  const std::string text = "#?RADIANCE\n# comment\n" + more + "FORMAT=32-bit_rle_rgbe\n\n-Y " +
                           std::to_string(height) + " +X " + std::to_string(width) + "\n";
  return {text.begin(), text.end()};
}

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

/// A row of `width` pixels: all red channels r, a run of green, blue counted up, exponent 129.
Bytes codedRow(int width, std::uint8_t r, std::uint8_t g) {
  const auto n = static_cast<std::uint8_t>(width);
  Bytes row = {2, 2, 0, n};
  append(row, {static_cast<std::uint8_t>(128 + n), r});
  append(row, {static_cast<std::uint8_t>(128 + n - 1), g, 1, g});
  row.push_back(n);
  for (int x = 0; x < width; ++x) row.push_back(static_cast<std::uint8_t>(x));
  append(row, {static_cast<std::uint8_t>(128 + n), 129});
  return row;
}

TEST(Radiance, ReadsRunsAndFlatPixels) {
  // Exponent 129: a mantissa m is m * 2^(129 - 136) = m / 128.
  Bytes bytes = radianceHeader(10, 2);
  append(bytes, codedRow(10, 128, 64));
  append(bytes, codedRow(10, 0, 255));
  const HdrImage image = decodeHdrImage(bytes, "a.hdr");
  ASSERT_EQ(image.width, 10);
  for (int x = 0; x < 10; ++x) {
    EXPECT_EQ(image.at(x, 0), glm::vec3(1.0f, 0.5f, static_cast<float>(x) / 128.0f));
    EXPECT_EQ(image.at(x, 1), glm::vec3(0.0f, 255.0f / 128.0f, static_cast<float>(x) / 128.0f));
  }
  // Flat, with the old repetition; a zero exponent is black.
  Bytes flat = radianceHeader(6, 1);
  append(flat, {10, 20, 30, 136, 1, 1, 1, 3, 9, 9, 9, 0, 200, 0, 0, 137});
  const HdrImage old = decodeHdrImage(flat, "a.pic");
  EXPECT_EQ(old.at(0, 0), glm::vec3(10, 20, 30));
  EXPECT_EQ(old.at(3, 0), glm::vec3(10, 20, 30));
  EXPECT_EQ(old.at(4, 0), glm::vec3(0));
  EXPECT_EQ(old.at(5, 0), glm::vec3(400, 0, 0));
}

TEST(Radiance, UndoesExposures) {
  Bytes bytes = radianceHeader(1, 1, "EXPOSURE=2\nEXPOSURE= 4.0\n");
  append(bytes, {16, 8, 0, 136});
  EXPECT_EQ(decodeHdrImage(bytes, "a.hdr").at(0, 0), glm::vec3(2, 1, 0));
}

TEST(Radiance, RefusesBadHeadersAndSurvivesDamage) {
  EXPECT_NE(problem({'x', '\n'}, "a.hdr"), "");
  Bytes lies = radianceHeader(30000, 30000);
  append(lies, {1, 2, 3, 4});
  EXPECT_NE(problem(lies, "a.hdr").find("cut off"), std::string::npos);
  EXPECT_NE(problem(radianceHeader(0, 5), "a.hdr"), "");
  EXPECT_NE(problem(radianceHeader(-4, 5), "a.hdr"), "");
  EXPECT_NE(problem(radianceHeader(4, 5, "EXPOSURE=0\n"), "a.hdr").find("EXPOSURE"),
            std::string::npos);
  Bytes bytes = radianceHeader(12, 3);
  for (int y = 0; y < 3; ++y) append(bytes, codedRow(12, 128, 64));
  expectSurvivesDamage(bytes, "a.hdr");
}

TEST(HdrImageFile, RefusesOtherKinds) {
  EXPECT_NE(problem({1, 2, 3}, "a.tiff").find("use .exr"), std::string::npos);
  EXPECT_THROW(readHdrImage("none.exr"), Error);
}

}  // namespace
}  // namespace verdure
