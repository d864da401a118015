#include "bake/field_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/field_kernels.cpp"
#include <hwy/foreach_target.h>
// Highway's own header must come after foreach_target.h.
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace verdure {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Never more lanes than a block's row or the padding of point arrays.
using Tag = hn::CappedTag<float, 8>;
using V = hn::Vec<Tag>;

// Distances relative to the radius for one norm: s2 = (|d| / r)^2 of offsets scaled by 1 / r, and
// the vector s grad s (with respect to the scaled offset), which (2)'s derivative needs.
struct NormL1 {
  V s2(Tag, V x, V y, V z) const {
    const V s = hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z)));
    return hn::Mul(s, s);
  }
  void sGradS(Tag d, V x, V y, V z, V& gx, V& gy, V& gz) const {
    const V s = hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z)));
    gx = hn::CopySign(s, x);
    gy = hn::CopySign(s, y);
    gz = hn::CopySign(s, z);
    (void)d;
  }
};
struct NormL2 {
  V s2(Tag, V x, V y, V z) const { return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))); }
  void sGradS(Tag, V x, V y, V z, V& gx, V& gy, V& gz) const {
    gx = x;
    gy = y;
    gz = z;
  }
};
struct NormLinf {
  V s2(Tag, V x, V y, V z) const {
    const V s = hn::Max(hn::Abs(x), hn::Max(hn::Abs(y), hn::Abs(z)));
    return hn::Mul(s, s);
  }
  void sGradS(Tag d, V x, V y, V z, V& gx, V& gy, V& gz) const {
    const V ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z), zero = hn::Zero(d);
    const auto first = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az));
    const auto second = hn::AndNot(first, hn::Ge(ay, az));
    gx = hn::IfThenElse(first, x, zero);
    gy = hn::IfThenElse(second, y, zero);
    gz = hn::IfThenElse(hn::Or(first, second), zero, z);
  }
};
struct NormLp {
  float p;
  V power(Tag d, V v, float exponent) const {
    // 0^p = 0: the smallest normal number instead of 0 keeps the logarithm finite.
    const V x = hn::Max(v, hn::Set(d, 1e-30f));
    return hn::Exp(d, hn::Mul(hn::Log(d, x), hn::Set(d, exponent)));
  }
  V s2(Tag d, V x, V y, V z) const {
    const V sum =
        hn::Add(power(d, hn::Abs(x), p), hn::Add(power(d, hn::Abs(y), p), power(d, hn::Abs(z), p)));
    return power(d, sum, 2.0f / p);
  }
  void sGradS(Tag d, V x, V y, V z, V& gx, V& gy, V& gz) const {
    // grad |d|_p = sign(d_i) (|d_i| / |d|_p)^(p - 1).
    const V s = hn::Sqrt(s2(d, x, y, z));
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(s, hn::Set(d, 1e-20f)));
    const auto component = [&](V v) {
      return hn::CopySign(hn::Mul(s, power(d, hn::Mul(hn::Abs(v), inverse), p - 1.0f)), v);
    };
    gx = component(x);
    gy = component(y);
    gz = component(z);
  }
};

template <class Function>
void withNorm(const Norm& norm, const Function& function) {
  switch (norm.kind) {
    case Norm::Kind::kL1:
      return function(NormL1{});
    case Norm::Kind::kL2:
      return function(NormL2{});
    case Norm::Kind::kLinf:
      return function(NormLinf{});
    case Norm::Kind::kLp:
      return function(NormLp{norm.p});
  }
}

// Points times generators, any norm.
template <class N>
void sumLanes(const N& norm, const PackedGenerator* generators, std::size_t count, V x, V y, V z,
              float* out) {
  const Tag d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  V sum = zero;
  for (std::size_t i = 0; i < count; ++i) {
    const PackedGenerator& g = generators[i];
    const V inverse = hn::Set(d, g.inverse_radius);
    const V w = hn::Max(hn::Sub(one, norm.s2(d, hn::Mul(hn::Sub(x, hn::Set(d, g.x)), inverse),
                                             hn::Mul(hn::Sub(y, hn::Set(d, g.y)), inverse),
                                             hn::Mul(hn::Sub(z, hn::Set(d, g.z)), inverse))),
                        zero);
    sum = hn::MulAdd(w, w, sum);
  }
  hn::StoreU(sum, d, out);
}

void SumAtPoints(const Norm& norm, const PackedGenerator* generators, std::size_t count,
                 const PointArrays& points, float* sums) {
  const Tag d;
  withNorm(norm, [&](const auto& n) {
    for (std::size_t i = 0; i < points.count; i += hn::Lanes(d))
      sumLanes(n, generators, count, hn::LoadU(d, points.x + i), hn::LoadU(d, points.y + i),
               hn::LoadU(d, points.z + i), sums + i);
  });
}

void GradientAtPoints(const Norm& norm, const PackedGenerator* generators, std::size_t count,
                      const PointArrays& points, float* sums, float* gx, float* gy, float* gz) {
  const Tag d;
  withNorm(norm, [&](const auto& n) {
    const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    for (std::size_t i = 0; i < points.count; i += hn::Lanes(d)) {
      const V x = hn::LoadU(d, points.x + i), y = hn::LoadU(d, points.y + i),
              z = hn::LoadU(d, points.z + i);
      V sum = zero, sx = zero, sy = zero, sz = zero;
      for (std::size_t k = 0; k < count; ++k) {
        const PackedGenerator& g = generators[k];
        const V inverse = hn::Set(d, g.inverse_radius);
        const V ox = hn::Mul(hn::Sub(x, hn::Set(d, g.x)), inverse),
                oy = hn::Mul(hn::Sub(y, hn::Set(d, g.y)), inverse),
                oz = hn::Mul(hn::Sub(z, hn::Set(d, g.z)), inverse);
        const V w = hn::Max(hn::Sub(one, n.s2(d, ox, oy, oz)), zero);
        sum = hn::MulAdd(w, w, sum);
        // d/dq (1 - s^2)^2 = -4 (1 - s^2) s grad s / r.
        const V scale = hn::Mul(w, inverse);
        V vx, vy, vz;
        n.sGradS(d, ox, oy, oz, vx, vy, vz);
        sx = hn::MulAdd(scale, vx, sx);
        sy = hn::MulAdd(scale, vy, sy);
        sz = hn::MulAdd(scale, vz, sz);
      }
      const V factor = hn::Set(d, -4.0f);
      hn::StoreU(sum, d, sums + i);
      hn::StoreU(hn::Mul(sx, factor), d, gx + i);
      hn::StoreU(hn::Mul(sy, factor), d, gy + i);
      hn::StoreU(hn::Mul(sz, factor), d, gz + i);
    }
  });
}

// The Euclidean norm splits along the axes: a row of points shares 1 - (dy^2 + dz^2) / r^2, and
// rows that the sphere misses cost one comparison.
void SumOnBlockEuclidean(const PackedGenerator* generators, std::size_t count, const glm::vec3& low,
                         float spacing, float* sums) {
  const Tag d;
  constexpr std::size_t kRow = kBlockX;
  HWY_ALIGN float acc[kBlockPoints] = {};
  HWY_ALIGN float px[kRow], dx2[kRow];
  for (int i = 0; i < kBlockX; ++i) px[i] = low.x + spacing * static_cast<float>(i);
  const V zero = hn::Zero(d);
  for (std::size_t k = 0; k < count; ++k) {
    const PackedGenerator& g = generators[k];
    const float inverse2 = g.inverse_radius * g.inverse_radius;
    const V gx = hn::Set(d, g.x), scale = hn::Set(d, inverse2);
    for (std::size_t i = 0; i < kRow; i += hn::Lanes(d)) {
      const V o = hn::Sub(hn::Load(d, px + i), gx);
      hn::Store(hn::Mul(hn::Mul(o, o), scale), d, dx2 + i);
    }
    float dy2[kBlockY];
    for (int y = 0; y < kBlockY; ++y) {
      const float o = low.y + spacing * static_cast<float>(y) - g.y;
      dy2[y] = o * o * inverse2;
    }
    float* row = acc;
    for (int z = 0; z < kBlockZ; ++z) {
      const float o = low.z + spacing * static_cast<float>(z) - g.z;
      const float rest_z = 1.0f - o * o * inverse2;
      if (rest_z <= 0.0f) {
        row += kBlockX * kBlockY;
        continue;
      }
      for (int y = 0; y < kBlockY; ++y, row += kBlockX) {
        const V rest = hn::Set(d, rest_z - dy2[y]);
        for (std::size_t i = 0; i < kRow; i += hn::Lanes(d)) {
          const V w = hn::Max(hn::Sub(rest, hn::Load(d, dx2 + i)), zero);
          hn::Store(hn::MulAdd(w, w, hn::Load(d, row + i)), d, row + i);
        }
      }
    }
  }
  for (std::size_t i = 0; i < kBlockPoints; ++i) sums[i] = acc[i];
}

void SumOnBlock(const Norm& norm, const PackedGenerator* generators, std::size_t count,
                const glm::vec3& low, float spacing, float* sums) {
  if (norm.kind == Norm::Kind::kL2)
    return SumOnBlockEuclidean(generators, count, low, spacing, sums);
  HWY_ALIGN float x[kBlockPoints], y[kBlockPoints], z[kBlockPoints];
  for (int i = 0; i < kBlockPoints; ++i) {
    x[i] = low.x + spacing * static_cast<float>(i % kBlockX);
    y[i] = low.y + spacing * static_cast<float>(i / kBlockX % kBlockY);
    z[i] = low.z + spacing * static_cast<float>(i / (kBlockX * kBlockY));
  }
  SumAtPoints(norm, generators, count, {x, y, z, kBlockPoints}, sums);
}

// |Hessian|_2 of (2) at relative distance s is max(4 (1 - s^2), 12 s^2 - 4) / r^2 inside the
// radius, 0 outside (eigenvalues 12 s^2 - 4 along the offset, -4 (1 - s^2) across it). Over a cell
// with half diagonal delta (relative to r) around a centre at s, s' lies in [s - delta, s + delta],
// and 2 s delta <= delta (1 + s^2) gives bounds of s'^2 that are linear in s^2: no root needed.
void CurvatureOnBlock(const PackedGenerator* generators, std::size_t count, const glm::vec3& low,
                      float spacing, float* bounds) {
  const Tag d;
  constexpr std::size_t kRow = kBlockX;
  HWY_ALIGN float acc[kBlockPoints] = {};
  HWY_ALIGN float px[kRow], dx2[kRow];
  const float half = 0.5f * spacing;
  for (int i = 0; i < kBlockX; ++i) px[i] = low.x + half + spacing * static_cast<float>(i);
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  for (std::size_t k = 0; k < count; ++k) {
    const PackedGenerator& g = generators[k];
    const float inverse2 = g.inverse_radius * g.inverse_radius;
    const float delta = 0.8660255f * spacing * g.inverse_radius;
    const float limit = (1.0f + delta) * (1.0f + delta);
    const V gx = hn::Set(d, g.x), scale = hn::Set(d, inverse2);
    for (std::size_t i = 0; i < kRow; i += hn::Lanes(d)) {
      const V o = hn::Sub(hn::Load(d, px + i), gx);
      hn::Store(hn::Mul(hn::Mul(o, o), scale), d, dx2 + i);
    }
    const V near_slope = hn::Set(d, -4.0f * (1.0f - delta)),
            near_offset = hn::Set(d, 4.0f + 4.0f * (delta - delta * delta)),
            far_slope = hn::Set(d, 1.0f + delta), far_offset = hn::Set(d, delta + delta * delta);
    float* row = acc;
    for (int z = 0; z < kBlockZ; ++z) {
      const float oz = low.z + half + spacing * static_cast<float>(z) - g.z;
      for (int y = 0; y < kBlockY; ++y, row += kBlockX) {
        const float oy = low.y + half + spacing * static_cast<float>(y) - g.y;
        const float dyz2 = (oy * oy + oz * oz) * inverse2;
        if (dyz2 >= limit) continue;
        for (std::size_t i = 0; i < kRow; i += hn::Lanes(d)) {
          const V s2 = hn::Add(hn::Set(d, dyz2), hn::Load(d, dx2 + i));
          const V inner = hn::MulAdd(near_slope, s2, near_offset);
          const V outer =
              hn::MulSub(hn::Set(d, 12.0f), hn::Min(one, hn::MulAdd(far_slope, s2, far_offset)),
                         hn::Set(d, 4.0f));
          const V bound =
              hn::IfThenElse(hn::Lt(s2, hn::Set(d, limit)), hn::Max(inner, outer), zero);
          hn::Store(hn::MulAdd(bound, scale, hn::Load(d, row + i)), d, row + i);
        }
      }
    }
  }
  for (std::size_t i = 0; i < kBlockPoints; ++i) bounds[i] = acc[i];
}

}  // namespace HWY_NAMESPACE
}  // namespace verdure
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace verdure {

HWY_EXPORT(SumOnBlock);
HWY_EXPORT(CurvatureOnBlock);
HWY_EXPORT(SumAtPoints);
HWY_EXPORT(GradientAtPoints);

void sumOnBlock(const Norm& norm, std::span<const PackedGenerator> generators, const glm::vec3& low,
                float spacing, float* sums) {
  HWY_DYNAMIC_DISPATCH(SumOnBlock)(norm, generators.data(), generators.size(), low, spacing, sums);
}

void curvatureOnBlock(std::span<const PackedGenerator> generators, const glm::vec3& low,
                      float spacing, float* bounds) {
  HWY_DYNAMIC_DISPATCH(CurvatureOnBlock)
  (generators.data(), generators.size(), low, spacing, bounds);
}

void sumAtPoints(const Norm& norm, std::span<const PackedGenerator> generators,
                 const PointArrays& points, float* sums) {
  HWY_DYNAMIC_DISPATCH(SumAtPoints)(norm, generators.data(), generators.size(), points, sums);
}

void gradientAtPoints(const Norm& norm, std::span<const PackedGenerator> generators,
                      const PointArrays& points, float* sums, float* gx, float* gy, float* gz) {
  HWY_DYNAMIC_DISPATCH(GradientAtPoints)
  (norm, generators.data(), generators.size(), points, sums, gx, gy, gz);
}

}  // namespace verdure
#endif  // HWY_ONCE
