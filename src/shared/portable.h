#ifndef VERDURE_SHARED_PORTABLE_H_
#define VERDURE_SHARED_PORTABLE_H_

// The only place that knows whether a shared formula is compiled as C++ (GLM) or as GLSL. What may
// stand in a shared header: plain structs and pure functions in GLSL's vocabulary; literals 0.5f;
// no swizzles; no textures or bindings (fetched values are arguments); include guards. Structs that
// travel to the GPU use scalar block layout and a SHARED_SIZE check.

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_FUNCTION inline
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == bytes)
namespace verdure::shared {
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
using glm::abs;
using glm::acos;
using glm::asin;
using glm::atan;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::floor;
using glm::length;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::reflect;
using glm::sin;
using glm::smoothstep;
using glm::sqrt;
}  // namespace verdure::shared
#define SHARED_BEGIN namespace verdure::shared {
#define SHARED_END }
#else
#define SHARED_FUNCTION
#define SHARED_SIZE(type, bytes)
#define SHARED_BEGIN
#define SHARED_END
#endif

#endif  // VERDURE_SHARED_PORTABLE_H_
