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

// Never more lanes than the padding of point arrays, or than half a layer of a block.
using Tag = hn::CappedTag<float, kPointLanes>;
using V = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());

// One norm: s2 = (|o| / r)^2 of an offset o, and s grad s = s2's gradient / 2, which (2)'s
// derivative needs, times r^2.
struct NormL1 {
  V s2(Tag, V x, V y, V z, V inverse) const {
    const V s = hn::Mul(hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))), inverse);
    return hn::Mul(s, s);
  }
  void slope(Tag, V x, V y, V z, V& gx, V& gy, V& gz) const {
    const V length = hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z)));
    gx = hn::CopySign(length, x);
    gy = hn::CopySign(length, y);
    gz = hn::CopySign(length, z);
  }
};
struct NormL2 {
  V s2(Tag, V x, V y, V z, V inverse) const {
    const V d2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    return hn::Mul(d2, hn::Mul(inverse, inverse));
  }
  void slope(Tag, V x, V y, V z, V& gx, V& gy, V& gz) const {
    gx = x;
    gy = y;
    gz = z;
  }
};
struct NormLinf {
  V s2(Tag, V x, V y, V z, V inverse) const {
    const V s = hn::Mul(hn::Max(hn::Abs(x), hn::Max(hn::Abs(y), hn::Abs(z))), inverse);
    return hn::Mul(s, s);
  }
  void slope(Tag d, V x, V y, V z, V& gx, V& gy, V& gz) const {
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
    // 0^p = 0: a tiny number instead of 0 keeps the logarithm finite.
    const V x = hn::Max(v, hn::Set(d, 1e-30f));
    // Below exp(-80) nothing is left of a term beside 1; far below, Exp itself breaks down.
    const V log = hn::Mul(hn::Log(d, x), hn::Set(d, exponent));
    return hn::Exp(d, hn::Max(log, hn::Set(d, -80.0f)));
  }
  // By the largest component, so that high powers neither vanish nor overflow.
  V length(Tag d, V x, V y, V z) const {
    const V ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
    const V most = hn::Max(ax, hn::Max(ay, az));
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(most, hn::Set(d, 1e-30f)));
    const V sum =
        hn::Add(power(d, hn::Mul(ax, inverse), p),
                hn::Add(power(d, hn::Mul(ay, inverse), p), power(d, hn::Mul(az, inverse), p)));
    return hn::Mul(most, power(d, sum, 1.0f / p));
  }
  V s2(Tag d, V x, V y, V z, V inverse) const {
    const V s = length(d, hn::Mul(x, inverse), hn::Mul(y, inverse), hn::Mul(z, inverse));
    return hn::Mul(s, s);
  }
  void slope(Tag d, V x, V y, V z, V& gx, V& gy, V& gz) const {
    // grad |o|_p = sign(o_i) (|o_i| / |o|_p)^(p - 1).
    const V l = length(d, x, y, z);
    const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(l, hn::Set(d, 1e-30f)));
    const auto component = [&](V v) {
      return hn::CopySign(hn::Mul(l, power(d, hn::Mul(hn::Abs(v), inverse), p - 1.0f)), v);
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

void AppendInReach(const GeneratorList& list, std::size_t begin, std::size_t end,
                   const glm::vec3& low, const glm::vec3& high, bool euclidean,
                   GeneratorList& found) {
  const hn::ScalableTag<float> d;
  using W = hn::Vec<decltype(d)>;
  found.reserve(found.count + (end - begin));
  const W zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  std::size_t n = found.count;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const W x = hn::LoadU(d, list.x.data() + i), y = hn::LoadU(d, list.y.data() + i),
            z = hn::LoadU(d, list.z.data() + i),
            inverse = hn::LoadU(d, list.inverse_radius.data() + i);
    const auto outside = [&](W v, float from, float to) {
      return hn::Max(hn::Max(hn::Sub(hn::Set(d, from), v), hn::Sub(v, hn::Set(d, to))), zero);
    };
    const W dx = outside(x, low.x, high.x), dy = outside(y, low.y, high.y),
            dz = outside(z, low.z, high.z);
    // Every Lp ball lies in the cube of the same radius.
    const W distance2 = euclidean
                            ? hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)))
                            : hn::Max(hn::Mul(dx, dx), hn::Max(hn::Mul(dy, dy), hn::Mul(dz, dz)));
    const auto reach =
        hn::And(hn::Lt(hn::Mul(distance2, hn::Mul(inverse, inverse)), one), hn::FirstN(d, end - i));
    hn::CompressStore(x, reach, d, found.x.data() + n);
    hn::CompressStore(y, reach, d, found.y.data() + n);
    hn::CompressStore(z, reach, d, found.z.data() + n);
    n += hn::CompressStore(inverse, reach, d, found.inverse_radius.data() + n);
  }
  found.count = n;
}

void SumAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                 float* sums) {
  const Tag d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  withNorm(norm, [&](const auto& n) {
    for (std::size_t i = 0; i < points.count; i += kLanes) {
      const V x = hn::LoadU(d, points.x + i), y = hn::LoadU(d, points.y + i),
              z = hn::LoadU(d, points.z + i);
      V sum = zero;
      for (std::size_t k = 0; k < generators.count; ++k) {
        const V s2 = n.s2(
            d, hn::Sub(x, hn::Set(d, generators.x[k])), hn::Sub(y, hn::Set(d, generators.y[k])),
            hn::Sub(z, hn::Set(d, generators.z[k])), hn::Set(d, generators.inverse_radius[k]));
        const V w = hn::Max(hn::Sub(one, s2), zero);
        sum = hn::MulAdd(w, w, sum);
      }
      hn::StoreU(sum, d, sums + i);
    }
  });
}

void GradientAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                      float* sums, float* gx, float* gy, float* gz) {
  const Tag d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  withNorm(norm, [&](const auto& n) {
    for (std::size_t i = 0; i < points.count; i += kLanes) {
      const V x = hn::LoadU(d, points.x + i), y = hn::LoadU(d, points.y + i),
              z = hn::LoadU(d, points.z + i);
      V sum = zero, sx = zero, sy = zero, sz = zero;
      for (std::size_t k = 0; k < generators.count; ++k) {
        const V inverse = hn::Set(d, generators.inverse_radius[k]);
        const V ox = hn::Sub(x, hn::Set(d, generators.x[k])),
                oy = hn::Sub(y, hn::Set(d, generators.y[k])),
                oz = hn::Sub(z, hn::Set(d, generators.z[k]));
        const V w = hn::Max(hn::Sub(one, n.s2(d, ox, oy, oz, inverse)), zero);
        sum = hn::MulAdd(w, w, sum);
        // d/dq (1 - s^2)^2 = -4 (1 - s^2) s grad s.
        const V scale = hn::Mul(w, hn::Mul(inverse, inverse));
        V vx, vy, vz;
        n.slope(d, ox, oy, oz, vx, vy, vz);
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

// The x and y of one layer of a block, which all its layers share.
constexpr std::size_t kLayer = kBlockX * kBlockY;
static_assert(kLayer % kLanes == 0);
struct Layer {
  HWY_ALIGN float x[kLayer];
  HWY_ALIGN float y[kLayer];
  Layer(const glm::vec3& low, float spacing) {
    for (std::size_t i = 0; i < kLayer; ++i) {
      x[i] = low.x + spacing * static_cast<float>(i % kBlockX);
      y[i] = low.y + spacing * static_cast<float>(i / kBlockX);
    }
  }
};

// Calls acc = add(acc, prepared, 1 - xy, z) for each of a block's vectors of points, where xy + z
// is the squared relative distance to a generator, split by axes. The accumulators fill eight
// registers of 16 lanes.
template <class Prepare, class Add>
void overBlock(const GeneratorList& generators, const glm::vec3& low, float spacing,
               const Prepare& prepare, const Add& add, float* out) {
  const Tag d;
  const hn::CappedTag<float, kBlockZ> layers;
  const Layer layer(low, spacing);
  HWY_ALIGN float zs[kBlockZ], z2[kBlockZ];
  for (int z = 0; z < kBlockZ; ++z) zs[z] = low.z + spacing * static_cast<float>(z);
  constexpr std::size_t kPerLayer = kLayer / kLanes;
  const V one = hn::Set(d, 1.0f);
  V acc[kPerLayer * kBlockZ];
  for (V& a : acc) a = hn::Zero(d);
  for (std::size_t k = 0; k < generators.count; ++k) {
    const float inverse = generators.inverse_radius[k];
    const V scale = hn::Set(d, inverse * inverse), gx = hn::Set(d, generators.x[k]),
            gy = hn::Set(d, generators.y[k]);
    V rest[kPerLayer];
    for (std::size_t i = 0; i < kPerLayer; ++i) {
      const V ox = hn::Sub(hn::Load(d, layer.x + i * kLanes), gx),
              oy = hn::Sub(hn::Load(d, layer.y + i * kLanes), gy);
      rest[i] = hn::NegMulAdd(hn::MulAdd(ox, ox, hn::Mul(oy, oy)), scale, one);
    }
    for (std::size_t z = 0; z < kBlockZ; z += hn::Lanes(layers)) {
      const auto oz = hn::Mul(hn::Sub(hn::Load(layers, zs + z), hn::Set(layers, generators.z[k])),
                              hn::Set(layers, inverse));
      hn::Store(hn::Mul(oz, oz), layers, z2 + z);
    }
    const auto prepared = prepare(inverse, scale);
    for (std::size_t z = 0; z < kBlockZ; ++z) {
      const V z_term = hn::Set(d, z2[z]);
      for (std::size_t i = 0; i < kPerLayer; ++i)
        acc[z * kPerLayer + i] = add(acc[z * kPerLayer + i], prepared, rest[i], z_term);
    }
  }
  for (std::size_t i = 0; i < kPerLayer * kBlockZ; ++i) hn::StoreU(acc[i], d, out + i * kLanes);
}

glm::vec2 SumOnBlock(const Norm& norm, float weight, const GeneratorList& generators,
                     const glm::vec3& low, float spacing, float* sums) {
  const Tag d;
  if (norm.kind == Norm::Kind::kL2) {
    const V zero = hn::Zero(d);
    overBlock(
        generators, low, spacing, [](float, V) { return 0; },
        [&](V acc, int, V rest, V z2) {
          const V w = hn::Max(hn::Sub(rest, z2), zero);
          return hn::MulAdd(w, w, acc);
        },
        sums);
  } else {
    const Layer layer(low, spacing);
    for (int z = 0; z < kBlockZ; ++z) {
      float zs[kLayer];
      for (float& v : zs) v = low.z + spacing * static_cast<float>(z);
      SumAtPoints(norm, generators, {layer.x, layer.y, zs, kLayer},
                  sums + static_cast<std::size_t>(z) * kLayer);
    }
  }
  const V scale = hn::Set(d, weight);
  V least = hn::Mul(hn::LoadU(d, sums), scale), most = least;
  for (std::size_t i = 0; i < kBlockPoints; i += kLanes) {
    const V v = hn::Mul(hn::LoadU(d, sums + i), scale);
    hn::StoreU(v, d, sums + i);
    least = hn::Min(least, v);
    most = hn::Max(most, v);
  }
  return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

// |Hessian|_2 of (2) at relative distance s is max(4 (1 - s^2), 12 s^2 - 4) / r^2 inside the
// radius, 0 outside (eigenvalues 12 s^2 - 4 along the offset, -4 (1 - s^2) across it). Over a cell
// with half diagonal delta (relative to r) around a centre at s, s' lies in [s - delta, s + delta],
// and 2 s delta <= delta (1 + s^2) gives bounds of s'^2 that are linear in s^2: no root needed.
void CurvatureOnBlock(const GeneratorList& generators, const glm::vec3& low, float spacing,
                      float* bounds) {
  const Tag d;
  const V one = hn::Set(d, 1.0f), four = hn::Set(d, 4.0f), twelve = hn::Set(d, 12.0f);
  struct Prepared {
    V near_slope, near_offset, far_slope, far_offset, limit, scale;
  };
  overBlock(
      generators, low + 0.5f * spacing, spacing,
      [&](float inverse, V scale) {
        const float delta = 0.8660255f * spacing * inverse;
        return Prepared{hn::Set(d, -4.0f * (1.0f - delta)),
                        hn::Set(d, 4.0f + 4.0f * (delta - delta * delta)),
                        hn::Set(d, 1.0f + delta),
                        hn::Set(d, delta + delta * delta),
                        hn::Set(d, (1.0f + delta) * (1.0f + delta)),
                        scale};
      },
      [&](V acc, const Prepared& p, V rest, V z2) {
        const V s2 = hn::Sub(hn::Add(one, z2), rest);
        const V inner = hn::MulAdd(p.near_slope, s2, p.near_offset);
        const V outer =
            hn::MulSub(twelve, hn::Min(one, hn::MulAdd(p.far_slope, s2, p.far_offset)), four);
        const V bound = hn::IfThenElseZero(hn::Lt(s2, p.limit), hn::Max(inner, outer));
        return hn::MulAdd(bound, p.scale, acc);
      },
      bounds);
}

}  // namespace HWY_NAMESPACE
}  // namespace verdure
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace verdure {

HWY_EXPORT(AppendInReach);
HWY_EXPORT(SumOnBlock);
HWY_EXPORT(CurvatureOnBlock);
HWY_EXPORT(SumAtPoints);
HWY_EXPORT(GradientAtPoints);

void appendInReach(const GeneratorList& list, std::size_t begin, std::size_t end,
                   const glm::vec3& low, const glm::vec3& high, bool euclidean,
                   GeneratorList& found) {
  HWY_DYNAMIC_DISPATCH(AppendInReach)(list, begin, end, low, high, euclidean, found);
}

glm::vec2 sumOnBlock(const Norm& norm, float weight, const GeneratorList& generators,
                     const glm::vec3& low, float spacing, float* sums) {
  return HWY_DYNAMIC_DISPATCH(SumOnBlock)(norm, weight, generators, low, spacing, sums);
}

void curvatureOnBlock(const GeneratorList& generators, const glm::vec3& low, float spacing,
                      float* bounds) {
  HWY_DYNAMIC_DISPATCH(CurvatureOnBlock)(generators, low, spacing, bounds);
}

void sumAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                 float* sums) {
  HWY_DYNAMIC_DISPATCH(SumAtPoints)(norm, generators, points, sums);
}

void gradientAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                      float* sums, float* gx, float* gy, float* gz) {
  HWY_DYNAMIC_DISPATCH(GradientAtPoints)(norm, generators, points, sums, gx, gy, gz);
}

}  // namespace verdure
#endif  // HWY_ONCE
