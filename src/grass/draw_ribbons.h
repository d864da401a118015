#ifndef VERDURE_GRASS_DRAW_RIBBONS_H_
#define VERDURE_GRASS_DRAW_RIBBONS_H_

#include <vector>

#include "grass/plant_ribbons.h"

namespace verdure {

/// A parallel projection into a picture that repeats to the right, and maybe down.
struct RibbonView {
  glm::vec3 right{1, 0, 0}, up{0, 1, 0},
      toward{0, 0, 1};        ///< of the picture and to the looker, unit
  int width = 0, height = 0;  ///< texels
  float width_m = 0.0f, height_m = 0.0f;
  float top_m = 0.0f;  ///< of row 0's upper edge, along `up`
  bool repeats_down = false;
  /// What is drawn, along `toward`: [from_m, to_m).
  float from_m = -1e9f, to_m = 1e9f;
};

/// Draws ribbons with 4 x 4 samples a texel, the nearest in front, and averages.
GrassMap drawRibbons(const std::vector<DrawnRibbon>& ribbons, const RibbonView& view);

}  // namespace verdure

#endif  // VERDURE_GRASS_DRAW_RIBBONS_H_
