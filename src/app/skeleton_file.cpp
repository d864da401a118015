#include "app/skeleton_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/files.h"

namespace verdure::app {
namespace {

constexpr int kPictureHeight = 1600, kPictureMargin = 40, kLeastWidth = 400, kMostWidth = 2400;

int levelsOf(const Plant& plant) {
  int levels = 0;
  for (const Branch& branch : plant.branches) levels = std::max(levels, branch.level + 1);
  return levels;
}

std::string objOf(const Plant& plant) {
  std::string text = fmt::format("# {}: branches, {}\n", "verdure", plant.branches.size());
  std::size_t vertex = 1;
  for (int level = 0; level < levelsOf(plant); ++level) {
    text += fmt::format("o level_{}\n", level);
    for (const Branch& branch : plant.branches) {
      if (branch.level != level) continue;
      std::string line = "l";
      for (const BranchPoint& p : branch.points) {
        text += fmt::format("v {} {} {}\n", p.position.x, p.position.y, p.position.z);
        line += fmt::format(" {}", vertex++);
      }
      text += line + "\n";
    }
  }
  return text;
}

glm::vec3 levelColor(int level) {
  static const std::array<glm::vec3, 6> kColors = {
      glm::vec3(0.25f, 0.16f, 0.10f), glm::vec3(0.80f, 0.25f, 0.10f),
      glm::vec3(0.10f, 0.35f, 0.80f), glm::vec3(0.10f, 0.55f, 0.25f),
      glm::vec3(0.60f, 0.20f, 0.65f), glm::vec3(0.85f, 0.60f, 0.05f)};
  return level == 0 ? kColors[0]
                    : kColors[1 + static_cast<std::size_t>(level - 1) % (kColors.size() - 1)];
}

/// One side of the drawing: a parallel projection.
class SideView {
 public:
  SideView(Image& image, float left, float scale, const glm::vec3& foot, int axis, float sign)
      : image_(image), left_(left), scale_(scale), foot_(foot), axis_(axis), sign_(sign) {}

  glm::vec2 pixel(const glm::vec3& p) const {
    const glm::vec3 off = p - foot_;
    return {left_ + sign_ * off[axis_] * scale_,
            static_cast<float>(image_.height - kPictureMargin) - off.y * scale_};
  }

  /// A line with round ends whose half width goes from r to s metres, at least one pixel wide.
  void line(const glm::vec3& p, const glm::vec3& q, float r, float s, const glm::vec3& color) {
    const glm::vec2 a = pixel(p), b = pixel(q), ab = b - a;
    const float ra = std::max(r * scale_, 0.5f), rb = std::max(s * scale_, 0.5f);
    const glm::vec2 edge(std::max(ra, rb) + 1.0f);
    const glm::ivec2 low(glm::floor(glm::min(a, b) - edge)), high(glm::ceil(glm::max(a, b) + edge));
    const float square = glm::dot(ab, ab);
    for (int y = std::max(low.y, 0); y <= std::min(high.y, image_.height - 1); ++y)
      for (int x = std::max(low.x, 0); x <= std::min(high.x, image_.width - 1); ++x) {
        const glm::vec2 c(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const float t = square > 0.0f ? glm::clamp(glm::dot(c - a, ab) / square, 0.0f, 1.0f) : 0.0f;
        blend(x, y, color,
              glm::clamp(glm::mix(ra, rb, t) + 0.5f - glm::length(c - a - t * ab), 0.0f, 1.0f));
      }
  }

  void dot(const glm::vec3& p, const glm::vec3& color, float cover) {
    const glm::ivec2 at(glm::floor(pixel(p) - 0.5f));
    for (int y = std::max(at.y, 0); y < std::min(at.y + 2, image_.height); ++y)
      for (int x = std::max(at.x, 0); x < std::min(at.x + 2, image_.width); ++x)
        blend(x, y, color, cover);
  }

 private:
  void blend(int x, int y, const glm::vec3& color, float cover) {
    std::uint8_t* p = image_.at(x, y);
    for (int c = 0; c < 3; ++c)
      p[c] = toByte(glm::mix(static_cast<float>(p[c]) / 255.0f, color[c], cover));
  }

  Image& image_;
  float left_, scale_;
  glm::vec3 foot_;
  int axis_;
  float sign_;
};

/// Deep levels first, so that the trunk is not hidden by its twigs.
Image drawingOf(const Plant& plant) {
  const Bounds box = bounds(plant);
  const glm::vec3 size = glm::max(box.size(), glm::vec3(1e-6f));
  const float wide = size.x + size.z;
  const float scale = std::min(static_cast<float>(kPictureHeight - 2 * kPictureMargin) / size.y,
                               static_cast<float>(kMostWidth - 3 * kPictureMargin) / wide);
  const auto width = static_cast<int>(wide * scale) + 3 * kPictureMargin;
  const auto height = static_cast<int>(size.y * scale) + 2 * kPictureMargin;
  Image image(std::max(width, kLeastWidth), height);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t{255});
  const auto margin = static_cast<float>(kPictureMargin);
  const glm::vec3 foot(box.center().x, box.min.y, box.center().z);
  std::array<SideView, 2> views = {
      SideView(image, margin + 0.5f * size.x * scale, scale, foot, 0, 1.0f),
      SideView(image, 2 * margin + (size.x + 0.5f * size.z) * scale, scale, foot, 2, -1.0f)};
  for (SideView& view : views) {
    for (const Leaf& leaf : plant.leaves) view.dot(leaf.centroid, {0.45f, 0.70f, 0.35f}, 0.35f);
    for (int level = levelsOf(plant) - 1; level >= 0; --level)
      for (const Branch& branch : plant.branches)
        if (branch.level == level)
          for (std::size_t i = 1; i < branch.points.size(); ++i)
            view.line(branch.points[i - 1].position, branch.points[i].position,
                      branch.points[i - 1].radius, branch.points[i].radius, levelColor(level));
  }
  return image;
}

}  // namespace

void writeSkeleton(const Plant& plant, const std::string& path) {
  std::string type = std::filesystem::path(path).extension().string();
  for (char& c : type) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (type == ".png")
    writePng(drawingOf(plant), path);
  else
    writeFile(path, objOf(plant));
}

}  // namespace verdure::app
