#include "sky/formula_sky.h"

#include <cmath>

#include "verdure/error.h"

namespace verdure {
namespace {

class FormulaSky final : public Sky {
 public:
  explicit FormulaSky(const shared::SkyFormula& formula) : formula_(formula) {}
  glm::vec3 luminance(const glm::vec3& direction) const override {
    return shared::skyLuminance(direction, formula_);
  }
  const shared::SkyFormula* formula() const override { return &formula_; }

 private:
  shared::SkyFormula formula_;
};

}  // namespace

std::shared_ptr<const Sky> formulaSky(const shared::SkyFormula& formula) {
  return std::make_shared<FormulaSky>(formula);
}

glm::vec3 unitDirection(const glm::vec3& to_sun) {
  const float length = glm::length(to_sun);
  if (!std::isfinite(length) || length == 0.0f)
    throw Error("sun", "its direction is zero or not finite", "give one of any other length");
  return to_sun / length;
}

glm::vec3 raisedToHorizon(const glm::vec3& unit) {
  if (unit.y >= 0.0f) return unit;
  const float across = std::hypot(unit.x, unit.z);
  return across > 0.0f ? glm::vec3(unit.x, 0.0f, unit.z) / across : glm::vec3(0.0f, 0.0f, 1.0f);
}

}  // namespace verdure
