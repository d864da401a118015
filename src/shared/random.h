#ifndef VERDURE_SHARED_RANDOM_H_
#define VERDURE_SHARED_RANDOM_H_

#include "portable.h"

SHARED_BEGIN

/// A well-mixed number from any other: PCG's output hash (Jarzynski and Olano, "Hash Functions for
/// GPU Rendering", JCGT 2020).
SHARED_FUNCTION uint scrambled(uint value) {
  uint random = value * 747796405u + 2891336453u;
  random = ((random >> ((random >> 28u) + 4u)) ^ random) * 277803737u;
  return (random >> 22u) ^ random;
}

SHARED_END

#endif  // VERDURE_SHARED_RANDOM_H_
