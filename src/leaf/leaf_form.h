#ifndef VERDURE_LEAF_LEAF_FORM_H_
#define VERDURE_LEAF_LEAF_FORM_H_

#include <vector>

#include "base/random.h"
#include "leaf/outline_curve.h"

// The shape of a leaf before its fine veins grow: outline and large veins, which belong together
// (veins end in teeth and lobes). Millimetres; the foot of the stalk is the origin, +y to the tip.

namespace verdure {

/// A vein whose course the species decides.
struct VeinGuide {
  Polyline points;  ///< from its root on
  int order = 1;    ///< 1 primary, 2 secondary, 3 tertiary
  int parent = -1;  ///< guide that it leaves, before this one; -1: the stalk's foot
};

struct LeafPlan {
  Polyline outline;          ///< closed, anticlockwise, from y = 0 on
  float blade_base = 0;      ///< y where the stalk ends and the blade begins
  float stalk_radius = 0.5;  ///< half the stalk's width
  std::vector<VeinGuide> guides;
};

/// A blade about a midrib: a whole pinnate leaf, or one finger of a palmate one.
struct BladeShape {
  float length_mm = 50;
  /// Right half from the base (0, 0) to the tip (0, 1), in lengths.
  std::vector<ControlPoint> margin;

  int pairs = 7;                                  ///< secondary veins on each side
  float first = 0.05f, last = 0.8f;               ///< where they leave the midrib, in lengths
  float angle_base_deg = 50, angle_tip_deg = 40;  ///< to the midrib
  float bend = 0.06f;  ///< bow of secondary veins, hollow to the tip, by their length
  bool into_teeth =
      false;             ///< secondaries end in teeth (craspedodromous), or loop before the margin
  float loop = 1.0f;     ///< how far loops climb, in distances between secondaries
  float stagger = 0.5f;  ///< shift between left and right veins: 0 opposite, 0.5 alternate

  float tooth_mm = 0;                         ///< height of the teeth at the secondaries' ends
  float minor_mm = 0;                         ///< height of the others
  float pitch_mm = 2;                         ///< distance between the others
  float teeth_from = 0.1f, teeth_to = 0.95f;  ///< y, in lengths
  Saw saw;                                    ///< its form alone
  float vary = 0.03f;                         ///< irregularity of the margin
};

struct HalfBlade {
  Polyline margin;                    ///< from base to tip
  std::vector<Polyline> secondaries;  ///< from the midrib on, from base to tip
};

/// The right half of a blade, base at the origin. `side` shifts the secondaries by stagger.
HalfBlade makeHalfBlade(const BladeShape& shape, float side, Random& random);

struct PinnateForm {
  BladeShape blade;
  float stalk_mm = 10;
  float stalk_radius_mm = 0.5f;
  float bend = 0.03f;  ///< how far leaves bend to one side, by their length
};

LeafPlan makePinnate(const PinnateForm& form, std::uint64_t seed);
/// California black oak: lobes with bristles.
LeafPlan makeOak(std::uint64_t seed);
/// Japanese maple: seven fingers.
LeafPlan makeMaple(std::uint64_t seed);

// Shared by the above.

/// Shifts all points sideways by a smooth curve of y that is 0 at the foot: areas do not change.
void bendForm(LeafPlan& form, float bend, Random& random);
/// A vein that is not quite smooth.
Polyline wiggled(const Polyline& points, float amplitude, Random& random);
/// Half the width of the stalk at height y: it is swollen at the foot.
float stalkRadius(const LeafPlan& form, float y);
/// Right half of the stalk: from the foot to the blade.
Polyline stalkSide(const LeafPlan& form);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_FORM_H_
