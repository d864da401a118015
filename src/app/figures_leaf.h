#ifndef VERDURE_APP_FIGURES_LEAF_H_
#define VERDURE_APP_FIGURES_LEAF_H_

#include "app/figure_set.h"
#include "verdure/leaf_plant.h"

/// What the parts of `figures leaf` share.
namespace verdure::app {

inline constexpr float kLeafFold_deg = 8.0f;  ///< of the leaf in the figures

/// A leaf with the light through it, upright before the camera.
struct LeafSubject {
  LeafSet set;
  LeafTranslucency light;
  Plant plant;
};

/// A clear day's sun and no sky. `behind`: the sun stands behind the leaf, `elevation` above its
/// plane, radians; to the right and above.
void lightLeaf(FigureSet& figures, float elevation, bool behind);

Terms leafTerms(LeafModel model);

/// Figure 3.20, and the renderer's pictures against the path tracer's of one leaf, `samples` paths
/// a pixel.
void drawLeafTruth(FigureSet& figures, const LeafSubject& subject, int samples);

}  // namespace verdure::app

#endif  // VERDURE_APP_FIGURES_LEAF_H_
