#ifndef VERDURE_LEAF_REFERENCE_H_
#define VERDURE_LEAF_REFERENCE_H_

#include "verdure/leaf_plant.h"
#include "verdure/reference.h"

namespace verdure {

/// The truth of one leaf close up: paths that enter the leaf leave it by the multipole's BSSRDF
/// itself, (3.8), (3.13) and (3.16) of Habel 2009, with `bake` as the coefficients' bake has it,
/// but without one: entry points are sampled by their distance, the light on them is found by rays
/// past the relief of the leaf's real surface (leafReliefPlant()), by the normal map of the side
/// that is lit and its albedo. The side that is looked at reflects diffusely by its own maps. No
/// gloss, no other things around. The leaf stands where leafPlant() puts it; distances in the leaf
/// are those of the flat sheet. Throws Error for what renderReference() and leafReliefPlant()
/// refuse.
ReferencePicture renderLeafReference(const LeafSet& set, const LeafPlantOptions& shape,
                                     const LeafBakeOptions& bake, const Daylight& lights,
                                     const ReferenceOptions& options);

}  // namespace verdure

#endif  // VERDURE_LEAF_REFERENCE_H_
