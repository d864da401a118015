#ifndef VERDURE_APP_FIDELITY_H_
#define VERDURE_APP_FIDELITY_H_

#include <array>
#include <cmath>
#include <string>

#include "verdure/density.h"
#include "verdure/optical_depth.h"
#include "verdure/render.h"
#include "verdure/transfer.h"

/// What the parts of `report fidelity` share.
namespace verdure::app {

enum class CrownBake { kMetaball, kOpticalDepth, kLeafVisibility };

/// A way to light a plant: the terms and, where they use one, the bake of the crown.
struct Candidate {
  const char* name;
  Terms terms;
  CrownBake bake;
  bool on_ground;  ///< lights the ground in a way of its own: measured there
};

inline Terms presetWith(const char* preset, ShadowSource source) {
  Terms terms = presetTerms(preset);
  terms.shadow_source = source;
  return terms;
}

/// What `best` is without transfer vectors.
inline Terms bestBaked() {
  Terms terms = presetTerms("best");
  terms.ambient_source = AmbientSource::kBaked;
  return terms;
}

/// What `best` is of leaves by their colour, as if they had no maps.
inline Terms bestByColor() {
  Terms terms = presetTerms("best");
  terms.leaf = LeafModel::kColor;
  return terms;
}

inline const std::array<Candidate, 11> kCandidates{{
    {"standard", presetTerms("standard"), CrownBake::kMetaball, true},
    {"expressive", presetTerms("expressive"), CrownBake::kMetaball, false},
    {"expressive, optical depth", presetTerms("expressive"), CrownBake::kOpticalDepth, false},
    {"depth-maps, paper", presetWith("depth-maps", ShadowSource::kDepthPaper),
     CrownBake::kLeafVisibility, false},
    {"depth-maps, layers", presetTerms("depth-maps"), CrownBake::kLeafVisibility, true},
    {"depth-maps, ordered", presetWith("depth-maps", ShadowSource::kDepthOrdered),
     CrownBake::kLeafVisibility, true},
    {"transfer", presetTerms("transfer"), CrownBake::kOpticalDepth, true},
    {"habel", presetTerms("habel"), CrownBake::kOpticalDepth, false},
    {"best, baked", bestBaked(), CrownBake::kOpticalDepth, false},
    {"best, leaves by colour", bestByColor(), CrownBake::kOpticalDepth, false},
    {"best", presetTerms("best"), CrownBake::kOpticalDepth, true},
}};

struct SunPosition {
  const char* name;
  float azimuth_deg, elevation_deg;  // the camera looks from 35 degrees
  Daylight daylight() const {
    constexpr float kTurbidity = 3.0f;
    return preethamDaylight(kTurbidity,
                            directionOf(glm::radians(azimuth_deg), glm::radians(elevation_deg)));
  }
};
inline constexpr std::array<SunPosition, 3> kSuns{{
    {"low sun from the side", 105.0f, 8.0f},
    {"sun behind the viewer", 10.0f, 35.0f},
    {"high sun against the viewer", -160.0f, 60.0f},
}};

/// A grown plant with all its light.
struct Subject {
  std::string name;
  Plant plant;
  DensityBake metaball;
  DepthBake depth;
  CrownLight visible;  ///< depth.light with the leaves' visibility
  PlantTransfer transfer;
  Scene scene(const Candidate& candidate) const {
    Scene scene;
    scene.items.push_back({&plant, candidate.bake == CrownBake::kMetaball       ? &metaball.light
                                   : candidate.bake == CrownBake::kOpticalDepth ? &depth.light
                                                                                : &visible});
    scene.items[0].transfer = &transfer;
    return scene;
  }
};

}  // namespace verdure::app

#endif  // VERDURE_APP_FIDELITY_H_
