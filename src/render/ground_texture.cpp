#include "render/ground_texture.h"

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
  for (glm::vec3& c : color) c = glm::vec3(0.075f, 0.070f, 0.030f) * random.uniform(0.7f, 1.2f);

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
                            random.uniform(0.55f, 1.2f);
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
          c = glm::mix(c, green * glm::mix(0.6f, 1.25f, t), cover * 0.8f);
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

}  // namespace verdure
