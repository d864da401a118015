#include "verdure/sky.h"

namespace verdure {
namespace {

class UniformSky final : public Sky {
 public:
  UniformSky(const glm::vec3& above, const glm::vec3& below) : above_(above), below_(below) {}
  glm::vec3 luminance(const glm::vec3& direction) const override {
    return direction.y < 0.0f ? below_ : above_;
  }

 private:
  glm::vec3 above_, below_;
};

}  // namespace

std::shared_ptr<const Sky> uniformSky(const glm::vec3& luminance, const glm::vec3& below) {
  return std::make_shared<UniformSky>(luminance, below);
}

}  // namespace verdure
