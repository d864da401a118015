#ifndef VERDURE_REFERENCE_PATH_TRACER_H_
#define VERDURE_REFERENCE_PATH_TRACER_H_

#include "verdure/reference.h"

namespace verdure {

class LeafCrossing;

/// renderReference(). With `leaf`, the scene is that leaf's leafReliefPlant() alone, and light goes
/// through it as LeafCrossing says.
ReferencePicture tracePicture(const Scene& scene, const Daylight& lights,
                              const ReferenceOptions& options, const LeafCrossing* leaf);

}  // namespace verdure

#endif  // VERDURE_REFERENCE_PATH_TRACER_H_
