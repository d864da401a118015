#ifndef VERDURE_BASE_RANDOM_H_
#define VERDURE_BASE_RANDOM_H_

#include <cstdint>

namespace verdure {

/// PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation"). The same on every machine, unlike <random>'s
/// distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 1) : increment_(2 * stream + 1) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }

  /// Uniform in [0, 1).
  float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
  /// Uniform in [low, high).
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  /// Uniform in [-amplitude, amplitude): the "value plus or minus variation" of plant parameters.
  float vary(float amplitude) { return uniform(-amplitude, amplitude); }
  /// Uniform in [0, count), count > 0 (bias below count / 2^32).
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((std::uint64_t{next()} * count) >> 32);
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

/// A well-mixed 64-bit hash (SplitMix64's finaliser, Steele et al. 2014), to give each branch or
/// leaf a random stream of its own.
inline std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace verdure

#endif  // VERDURE_BASE_RANDOM_H_
