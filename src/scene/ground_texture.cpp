#include "scene/ground_texture.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/random.h"
#include "shared/color.h"
#include "shared/sky.h"

namespace verdure {

Image makeGroundTexture(int size) {
  const auto n = static_cast<std::size_t>(size);
  // Soil between the blades, slightly uneven.
  Random random(20070);
  std::vector<glm::vec3> color(n * n);
  for (glm::vec3& c : color) c = glm::vec3(0.040f, 0.040f, 0.018f) * random.uniform(0.6f, 1.2f);

  // Blades: strokes that get lighter towards the tip; later ones lie above earlier ones.
  const int blades = size * size / 14;
  for (int i = 0; i < blades; ++i) {
    const glm::vec2 root(random.uniform(0.0f, static_cast<float>(size)),
                         random.uniform(0.0f, static_cast<float>(size)));
    const float angle = random.uniform(0.0f, glm::two_pi<float>());
    const float bend = random.vary(0.8f);
    const float length = random.uniform(0.012f, 0.04f) * static_cast<float>(size);
    const float width = random.uniform(0.8f, 1.9f);
    const float dry = random.uniform();
    const glm::vec3 green = glm::mix(glm::vec3(0.075f, 0.165f, 0.028f),
                                     glm::vec3(0.20f, 0.21f, 0.075f), dry * dry * dry) *
                            random.uniform(0.35f, 1.45f);
    glm::vec2 p = root;
    const int steps = static_cast<int>(length * 1.5f) + 1;
    for (int s = 0; s < steps; ++s) {
      const float t = static_cast<float>(s) / static_cast<float>(steps);
      const float a = angle + bend * t;
      p += glm::vec2(std::cos(a), std::sin(a)) * (length / static_cast<float>(steps));
      const float radius = 0.5f * width * (1.0f - t);
      const int reach = static_cast<int>(std::ceil(radius));
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const float cover =
              std::clamp(radius + 0.5f - std::hypot(static_cast<float>(dx), static_cast<float>(dy)),
                         0.0f, 1.0f);
          const auto wrapped = [size, n](float v, int d) {
            const int i_v = (static_cast<int>(std::floor(v)) + d) % size;
            return static_cast<std::size_t>(i_v < 0 ? i_v + size : i_v) % n;
          };
          glm::vec3& c = color[wrapped(p.y, dy) * n + wrapped(p.x, dx)];
          c = glm::mix(c, green * glm::mix(0.45f, 1.35f, t), cover * 0.8f);
        }
    }
  }

  glm::dvec3 sum(0.0);
  for (const glm::vec3& c : color) sum += glm::dvec3(c);
  const glm::vec3 scale =
      shared::groundMeanColor() / glm::vec3(sum / static_cast<double>(color.size()));
  Image image(size, size);
  for (std::size_t i = 0; i < color.size(); ++i)
    for (int k = 0; k < 3; ++k)
      image.rgba[4 * i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(
          255.0f * shared::srgbFromLinear(std::clamp(color[i][k] * scale[k], 0.0f, 1.0f))));
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

Image makeGroundNoise(int size) {
  Random random(2007);
  std::vector<float> sum(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0f);
  float total = 0.0f, weight = 1.0f;
  for (int cells = 4; cells <= size / 4; cells *= 2) {  // value noise, smoothly interpolated
    const auto c = static_cast<std::size_t>(cells);
    std::vector<float> lattice(c * c);
    for (float& v : lattice) v = random.uniform();
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const glm::vec2 p =
            glm::vec2(x, y) * (static_cast<float>(cells) / static_cast<float>(size));
        const glm::vec2 cell = glm::floor(p);
        const glm::vec2 f = glm::smoothstep(glm::vec2(0.0f), glm::vec2(1.0f), p - cell);
        const auto x0 = static_cast<std::size_t>(cell.x), y0 = static_cast<std::size_t>(cell.y);
        const std::size_t x1 = (x0 + 1) % c, y1 = (y0 + 1) % c;
        sum[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
            static_cast<std::size_t>(x)] +=
            weight * glm::mix(glm::mix(lattice[y0 * c + x0], lattice[y0 * c + x1], f.x),
                              glm::mix(lattice[y1 * c + x0], lattice[y1 * c + x1], f.x), f.y);
      }
    total += weight;
    weight *= 0.6f;
  }
  Image image(size, size);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const float v = std::clamp(0.5f + 1.6f * (sum[i] / total - 0.5f), 0.0f, 1.0f);
    for (std::size_t k = 0; k < 4; ++k)
      image.rgba[4 * i + k] = k == 3 ? 255 : static_cast<std::uint8_t>(std::lround(255.0f * v));
  }
  return image;
}

}  // namespace verdure
