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

/// A way to light a plant: the terms and, where they use one, the bake of the crown.
struct Candidate {
  const char* name;
  Terms terms;
  bool optical_depth;  ///< the crown's light comes from it, else from the metaball field
  bool on_ground;      ///< lights the ground in a way of its own: measured there
};
inline const std::array<Candidate, 4> kCandidates{{
    {"standard", presetTerms("standard"), false, true},
    {"expressive", presetTerms("expressive"), false, true},
    {"expressive, optical depth", presetTerms("expressive"), true, false},
    {"transfer", presetTerms("transfer"), true, true},
}};

struct SunPosition {
  const char* name;
  float azimuth_deg, elevation_deg;  // the camera looks from 35 degrees
  Daylight daylight() const {
    constexpr float kTurbidity = 3.0f, kDegree = static_cast<float>(M_PI / 180.0);
    return preethamDaylight(kTurbidity,
                            directionOf(azimuth_deg * kDegree, elevation_deg * kDegree));
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
  PlantTransfer transfer;
  Scene scene(const Candidate& candidate) const {
    Scene scene;
    scene.items.push_back({&plant, candidate.optical_depth ? &depth.light : &metaball.light});
    scene.items[0].transfer = &transfer;
    return scene;
  }
};

}  // namespace verdure::app

#endif  // VERDURE_APP_FIDELITY_H_
