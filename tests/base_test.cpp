#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <numeric>

#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scratch.h"
#include "shared/density.h"
#include "verdure/image.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;

TEST(Files, WritesAndReadsBack) {
  const fs::path dir = scratchFolder("verdure_files");
  writeFile(dir / "a.txt", "first");
  writeFile(dir / "a.txt", "second");
  const auto bytes = readFile(dir / "a.txt");
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "second");
  // No temporary file stays behind.
  EXPECT_EQ(std::distance(fs::directory_iterator(dir), fs::directory_iterator()), 1);
}

TEST(Files, SayWhatIsWrong) {
  const fs::path dir = scratchFolder("verdure_files_bad");
  try {
    readFile(dir / "none.glb");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("none.glb: no such file"), std::string::npos) << e.what();
  }
  EXPECT_THROW(readFile(dir), Error);
  EXPECT_THROW(writeFile(dir / "no" / "such" / "folder.txt", "x"), Error);
  EXPECT_THROW(writeFile(dir, "x"), Error);
  EXPECT_THROW(checkWritable("/proc/verdure.glb"), Error);
  // A rename would put a file in the place of a pipe or a device.
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(readFile(dir / "pipe"), Error);
  EXPECT_THROW(writeFile(dir / "pipe", "x"), Error);
  EXPECT_TRUE(fs::is_fifo(dir / "pipe"));
  EXPECT_THROW(checkWritable("/dev/null"), Error);
}

TEST(Parallel, CoversEveryIndexOnceInRangesThatIgnoreTheThreadCount) {
  for (const int threads : {1, 2, 0}) {
    setThreadCount(threads);
    std::vector<std::atomic<int>> hits(1003);
    std::atomic<int> ragged = 0;
    parallelChunks(hits.size(), 10, [&](std::size_t begin, std::size_t end) {
      if (begin % 10 != 0 || (end != hits.size() && end - begin != 10)) ++ragged;
      for (std::size_t i = begin; i < end; ++i) ++hits[i];
    });
    EXPECT_EQ(ragged, 0);
    for (const auto& h : hits) EXPECT_EQ(h, 1);
  }
  setThreadCount(0);
  EXPECT_GE(threadCount(), 1);
}

TEST(Random, MatchesThePublishedGenerator) {
  // First outputs of the PCG authors' demo, pcg32-demo: seed 42, stream 54.
  Random random(42, 54);
  const std::uint32_t expected[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330,
                                    0x83d2f293, 0xbfa4784b, 0xcbed606e};
  for (const std::uint32_t e : expected) EXPECT_EQ(random.next(), e);
}

TEST(Random, IsUniform) {
  Random random(7);
  double sum = 0, squares = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 0.005);
  EXPECT_NEAR(squares / 1e5, 1.0 / 3.0, 0.005);
}

TEST(ImageFile, SurvivesPng) {
  Image image(5, 3);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(i * 37);
  const Image back = decodeImage(encodePng(image), "memory");
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.height, 3);
  EXPECT_EQ(back.rgba, image.rgba);
  const std::uint8_t junk[] = {1, 2, 3, 4};
  EXPECT_THROW(decodeImage(junk, "junk.png"), Error);
  EXPECT_THROW(writePng(Image{}, "never.png"), Error);
}

TEST(SharedDensity, EncodingKeepsDirectionAndCoefficient) {
  const glm::vec3 n = glm::normalize(glm::vec3(1, 2, -3));
  for (const float k : {1.0f, 0.5f, 1.0f / 255.0f}) {
    const glm::vec4 d = shared::decodeNormal(shared::encodeNormal(n, k));
    EXPECT_NEAR(d.w, k, 1e-6f);
    EXPECT_NEAR(glm::dot(glm::vec3(d), n), 1.0f, 1e-6f);
  }
  const glm::vec4 zero = shared::decodeNormal(shared::encodeNormal(n, 0.0f));
  EXPECT_NEAR(glm::dot(glm::vec3(zero), n), 1.0f, 1e-5f);
}

}  // namespace
}  // namespace verdure
