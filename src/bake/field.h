#ifndef VERDURE_BAKE_FIELD_H_
#define VERDURE_BAKE_FIELD_H_

#include "bake/generator_grid.h"

namespace verdure {

struct DensityField::State {
  GeneratorGrid grid;
  Norm norm;
  float weight = 1.0f;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_FIELD_H_
