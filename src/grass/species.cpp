#include <fmt/format.h>

#include <initializer_list>

#include "verdure/error.h"
#include "verdure/grass.h"

namespace verdure {
namespace {

// Sizes and numbers after floras and counts of stands; colours are the reflectances of leaves,
// linear: a blade of grass returns about 5 % of red, 11 % of green and 2.5 % of blue light.

/// A part by what differs from the defaults. Lengths in metres, angles in radians; second numbers
/// are spreads.
struct Part : GrassPart {
  Part(RibbonProfile kind, int number) {
    profile = kind;
    count = number;
  }
  Part& onStalk() {
    on_stalk = true;
    return *this;
  }
  Part& size(float length, float spread, float width) {
    length_m = length;
    length_spread = spread;
    width_m = width;
    return *this;
  }
  Part& leans(float angle, float spread) {
    lean = angle;
    lean_spread = spread;
    return *this;
  }
  Part& bends(float angle, float spread) {
    bend = angle;
    bend_spread = spread;
    return *this;
  }
  Part& looks(const glm::vec3& root, const glm::vec3& tip, float spread, float through) {
    root_color = root;
    tip_color = tip;
    color_spread = spread;
    transmitted = through;
    return *this;
  }
};

GrassPlant plant(const char* name, float per_m2, float radius_m,
                 std::initializer_list<GrassPart> parts) {
  return {name, per_m2, radius_m, parts};
}

constexpr auto kBlade = RibbonProfile::kBlade;
constexpr auto kStalk = RibbonProfile::kStalk;
constexpr auto kOval = RibbonProfile::kOval;
constexpr auto kCut = RibbonProfile::kCut;

const glm::vec3 kGreen{0.048f, 0.105f, 0.024f};
const glm::vec3 kDeepGreen{0.034f, 0.080f, 0.020f};
const glm::vec3 kFreshGreen{0.070f, 0.140f, 0.030f};
const glm::vec3 kPaleFoot{0.065f, 0.085f, 0.036f};
const glm::vec3 kStraw{0.270f, 0.215f, 0.115f};
const glm::vec3 kOldStraw{0.180f, 0.135f, 0.075f};
const glm::vec3 kLitter{0.105f, 0.085f, 0.050f};
const glm::vec3 kPetalWhite{0.620f, 0.620f, 0.600f};

GrassSpecies lawn() {
  GrassSpecies s;
  s.name = "lawn";
  s.description = "mown lawn, 4.5 cm: 32 000 blades a square metre, most with cut tips";
  s.height_m = 0.055f;
  s.spacing_m = 0.02f;
  s.tile_m = 0.5f;
  s.litter = 0.25f;
  s.litter_color = kLitter;
  s.plants = {
      plant("ryegrass", 5200, 0.008f,
            {Part(kCut, 3)
                 .size(0.047f, 0.11f, 0.0026f)
                 .leans(0.25f, 0.25f)
                 .bends(0.45f, 0.40f)
                 .looks(kPaleFoot, kGreen, 0.25f, 0.8f),
             Part(kBlade, 2)
                 .size(0.034f, 0.30f, 0.0028f)
                 .leans(0.75f, 0.45f)
                 .bends(0.70f, 0.40f)
                 .looks(kGreen, kFreshGreen, 0.25f, 0.8f)}),
      plant("fescue", 2200, 0.006f,
            {Part(kCut, 3)
                 .size(0.045f, 0.14f, 0.0014f)
                 .leans(0.22f, 0.22f)
                 .bends(0.40f, 0.35f)
                 .looks(kPaleFoot, kDeepGreen, 0.25f, 0.7f)}),
      plant("dead blades", 900, 0.005f,
            {Part(kBlade, 1)
                 .size(0.028f, 0.40f, 0.0020f)
                 .leans(0.70f, 0.50f)
                 .bends(0.50f, 0.40f)
                 .looks(kOldStraw, kStraw, 0.30f, 0.5f)}),
  };
  return s;
}

GrassSpecies meadow() {
  GrassSpecies s;
  s.name = "meadow";
  s.description = "hay meadow in June, 30 to 45 cm, with daisies, buttercups, clover, cornflowers";
  s.height_m = 0.50f;
  s.spacing_m = 0.08f;
  s.tile_m = 0.8f;
  s.litter = 0.4f;
  s.litter_color = kLitter;
  const glm::vec3 stalk{0.085f, 0.125f, 0.045f};
  const glm::vec3 panicle{0.200f, 0.150f, 0.105f};
  const glm::vec3 yellow{0.600f, 0.420f, 0.020f};
  s.plants = {
      plant("red fescue", 420, 0.015f,
            {Part(kBlade, 10)
                 .size(0.30f, 0.38f, 0.0022f)
                 .leans(0.18f, 0.17f)
                 .bends(0.65f, 0.50f)
                 .looks(kPaleFoot, kGreen, 0.25f, 0.8f)}),
      plant("cocksfoot", 250, 0.020f,
            {Part(kBlade, 6)
                 .size(0.34f, 0.30f, 0.0050f)
                 .leans(0.18f, 0.15f)
                 .bends(0.80f, 0.50f)
                 .looks(kDeepGreen, kFreshGreen, 0.20f, 0.8f)}),
      plant("dead leaves", 150, 0.015f,
            {Part(kBlade, 3)
                 .size(0.16f, 0.40f, 0.0024f)
                 .leans(0.55f, 0.40f)
                 .bends(0.70f, 0.50f)
                 .looks(kOldStraw, kStraw, 0.30f, 0.5f)}),
      plant("herbs", 90, 0.012f,
            {Part(kOval, 5)
                 .size(0.085f, 0.35f, 0.0180f)
                 .leans(0.65f, 0.35f)
                 .bends(0.50f, 0.40f)
                 .looks(kDeepGreen, kGreen, 0.25f, 0.7f)}),
      plant("meadow grass in flower", 110, 0.004f,
            {Part(kStalk, 1)
                 .size(0.370f, 0.12f, 0.0014f)
                 .leans(0.06f, 0.06f)
                 .bends(0.22f, 0.16f)
                 .looks(kGreen, stalk, 0.20f, 0.5f),
             Part(kOval, 16)
                 .onStalk()
                 .size(0.052f, 0.45f, 0.0028f)
                 .leans(0.24f, 0.24f)
                 .bends(0.25f, 0.45f)
                 .looks(stalk, panicle, 0.25f, 0.5f),
             Part(kBlade, 2)
                 .size(0.24f, 0.30f, 0.0030f)
                 .leans(0.12f, 0.10f)
                 .bends(0.80f, 0.40f)
                 .looks(kGreen, kFreshGreen, 0.20f, 0.8f)}),
      plant("timothy", 22, 0.004f,
            {Part(kStalk, 1)
                 .size(0.380f, 0.10f, 0.0016f)
                 .leans(0.05f, 0.05f)
                 .bends(0.15f, 0.12f)
                 .looks(kGreen, stalk, 0.20f, 0.5f),
             Part(kOval, 3)
                 .onStalk()
                 .size(0.055f, 0.20f, 0.0070f)
                 .leans(0.03f, 0.03f)
                 .bends(0.0f, 0.05f)
                 .looks(kGreen, glm::vec3(0.150f, 0.160f, 0.100f), 0.20f, 0.4f)}),
      plant("ox-eye daisy", 11, 0.004f,
            {Part(kStalk, 1)
                 .size(0.360f, 0.16f, 0.0020f)
                 .leans(0.07f, 0.07f)
                 .bends(0.20f, 0.20f)
                 .looks(kDeepGreen, kGreen, 0.20f, 0.4f),
             Part(kOval, 20)
                 .onStalk()
                 .size(0.020f, 0.10f, 0.0055f)
                 .leans(1.35f, 0.12f)
                 .bends(0.20f, 0.15f)
                 .looks(kPetalWhite, kPetalWhite, 0.05f, 0.6f),
             Part(kOval, 9)
                 .onStalk()
                 .size(0.0075f, 0.10f, 0.0055f)
                 .leans(0.95f, 0.45f)
                 .bends(0.30f, 0.10f)
                 .looks(yellow, yellow, 0.10f, 0.3f),
             Part(kOval, 3)
                 .size(0.070f, 0.30f, 0.0100f)
                 .leans(0.70f, 0.30f)
                 .bends(0.40f, 0.30f)
                 .looks(kDeepGreen, kGreen, 0.20f, 0.7f)}),
      plant("buttercup", 14, 0.004f,
            {Part(kStalk, 1)
                 .size(0.330f, 0.24f, 0.0015f)
                 .leans(0.10f, 0.10f)
                 .bends(0.25f, 0.20f)
                 .looks(kGreen, kGreen, 0.20f, 0.4f),
             Part(kOval, 5)
                 .onStalk()
                 .size(0.013f, 0.10f, 0.0120f)
                 .leans(0.95f, 0.12f)
                 .bends(0.30f, 0.10f)
                 .looks(glm::vec3(0.620f, 0.430f, 0.015f), glm::vec3(0.640f, 0.450f, 0.015f), 0.05f,
                        0.5f),
             Part(kOval, 4)
                 .size(0.080f, 0.30f, 0.0100f)
                 .leans(0.60f, 0.30f)
                 .bends(0.50f, 0.30f)
                 .looks(kDeepGreen, kGreen, 0.20f, 0.7f)}),
      plant("red clover", 14, 0.004f,
            {Part(kStalk, 1)
                 .size(0.240f, 0.25f, 0.0018f)
                 .leans(0.12f, 0.12f)
                 .bends(0.25f, 0.20f)
                 .looks(kDeepGreen, kGreen, 0.20f, 0.4f),
             Part(kOval, 60)
                 .onStalk()
                 .size(0.014f, 0.15f, 0.0034f)
                 .leans(0.85f, 0.85f)
                 .bends(-0.20f, 0.20f)
                 .looks(glm::vec3(0.300f, 0.110f, 0.210f), glm::vec3(0.330f, 0.070f, 0.220f), 0.15f,
                        0.5f),
             Part(kOval, 3)
                 .onStalk()
                 .size(0.030f, 0.20f, 0.0150f)
                 .leans(1.50f, 0.15f)
                 .bends(0.30f, 0.20f)
                 .looks(kDeepGreen, kGreen, 0.20f, 0.7f)}),
      plant("cornflower", 5, 0.004f,
            {Part(kStalk, 1)
                 .size(0.360f, 0.16f, 0.0016f)
                 .leans(0.08f, 0.08f)
                 .bends(0.20f, 0.16f)
                 .looks(kGreen, kGreen, 0.20f, 0.4f),
             Part(kOval, 14)
                 .onStalk()
                 .size(0.018f, 0.20f, 0.0070f)
                 .leans(0.95f, 0.30f)
                 .bends(0.25f, 0.20f)
                 .looks(glm::vec3(0.070f, 0.090f, 0.450f), glm::vec3(0.080f, 0.120f, 0.520f), 0.10f,
                        0.5f),
             Part(kOval, 7)
                 .onStalk()
                 .size(0.008f, 0.20f, 0.0035f)
                 .leans(0.35f, 0.30f)
                 .bends(0.10f, 0.10f)
                 .looks(glm::vec3(0.100f, 0.040f, 0.250f), glm::vec3(0.120f, 0.050f, 0.300f), 0.10f,
                        0.4f)}),
  };
  return s;
}

GrassSpecies dryGrass() {
  GrassSpecies s;
  s.name = "dry-grass";
  s.description = "dry grass in late summer, 25 to 40 cm";
  s.height_m = 0.45f;
  s.spacing_m = 0.08f;
  s.tile_m = 0.8f;
  s.soil_color = {0.110f, 0.080f, 0.052f};
  s.litter = 0.8f;
  s.litter_color = {0.240f, 0.190f, 0.105f};
  s.plants = {
      plant("tuft", 520, 0.022f,
            {Part(kBlade, 12)
                 .size(0.29f, 0.40f, 0.0019f)
                 .leans(0.20f, 0.20f)
                 .bends(0.65f, 0.55f)
                 .looks(kOldStraw, kStraw, 0.25f, 0.6f)}),
      plant("broad leaves", 220, 0.020f,
            {Part(kBlade, 4)
                 .size(0.26f, 0.35f, 0.0036f)
                 .leans(0.30f, 0.25f)
                 .bends(1.20f, 0.60f)
                 .looks(kOldStraw, glm::vec3(0.300f, 0.235f, 0.130f), 0.25f, 0.6f)}),
      plant("fallen leaves", 220, 0.020f,
            {Part(kBlade, 4)
                 .size(0.15f, 0.40f, 0.0022f)
                 .leans(0.85f, 0.45f)
                 .bends(0.60f, 0.40f)
                 .looks(kOldStraw, kStraw, 0.30f, 0.6f)}),
      plant("green shoots", 70, 0.010f,
            {Part(kBlade, 4)
                 .size(0.13f, 0.35f, 0.0022f)
                 .leans(0.25f, 0.20f)
                 .bends(0.50f, 0.30f)
                 .looks(kPaleFoot, glm::vec3(0.085f, 0.115f, 0.035f), 0.25f, 0.8f)}),
      plant("seed stalks", 160, 0.005f,
            {Part(kStalk, 1)
                 .size(0.330f, 0.14f, 0.0013f)
                 .leans(0.08f, 0.08f)
                 .bends(0.25f, 0.20f)
                 .looks(kOldStraw, glm::vec3(0.260f, 0.200f, 0.110f), 0.20f, 0.4f),
             Part(kBlade, 14)
                 .onStalk()
                 .size(0.045f, 0.40f, 0.0022f)
                 .leans(0.30f, 0.30f)
                 .bends(0.30f, 0.40f)
                 .looks(glm::vec3(0.220f, 0.165f, 0.090f), glm::vec3(0.330f, 0.260f, 0.160f), 0.20f,
                        0.6f)}),
  };
  return s;
}

GrassSpecies clover() {
  GrassSpecies s;
  s.name = "clover";
  s.description = "white clover, 10 to 15 cm, in flower, with low grass between";
  s.height_m = 0.17f;
  s.spacing_m = 0.04f;
  s.tile_m = 0.5f;
  s.litter = 0.25f;
  s.litter_color = kLitter;
  const glm::vec3 leaf{0.036f, 0.090f, 0.022f};
  const glm::vec3 mark{0.062f, 0.120f, 0.048f};
  s.plants = {
      plant("clover leaf", 3600, 0.003f,
            {Part(kStalk, 1)
                 .size(0.085f, 0.35f, 0.0012f)
                 .leans(0.18f, 0.18f)
                 .bends(0.35f, 0.30f)
                 .looks(glm::vec3(0.075f, 0.100f, 0.040f), glm::vec3(0.060f, 0.110f, 0.030f), 0.20f,
                        0.5f),
             Part(kOval, 3)
                 .onStalk()
                 .size(0.019f, 0.15f, 0.0165f)
                 .leans(1.20f, 0.15f)
                 .bends(0.25f, 0.20f)
                 .looks(mark, leaf, 0.25f, 0.7f)}),
      plant("flower head", 110, 0.003f,
            {Part(kStalk, 1)
                 .size(0.120f, 0.18f, 0.0014f)
                 .leans(0.12f, 0.12f)
                 .bends(0.20f, 0.20f)
                 .looks(glm::vec3(0.060f, 0.100f, 0.030f), glm::vec3(0.080f, 0.120f, 0.040f), 0.20f,
                        0.4f),
             Part(kOval, 40)
                 .onStalk()
                 .size(0.0095f, 0.15f, 0.0024f)
                 .leans(0.95f, 0.95f)
                 .bends(-0.20f, 0.20f)
                 .looks(glm::vec3(0.330f, 0.310f, 0.240f), glm::vec3(0.620f, 0.600f, 0.560f), 0.10f,
                        0.6f)}),
      plant("grass", 1500, 0.006f,
            {Part(kBlade, 4)
                 .size(0.085f, 0.35f, 0.0022f)
                 .leans(0.25f, 0.20f)
                 .bends(0.55f, 0.40f)
                 .looks(kPaleFoot, kGreen, 0.25f, 0.8f)}),
  };
  return s;
}

}  // namespace

const std::vector<std::string>& grassSpeciesNames() {
  static const std::vector<std::string> names{"lawn", "meadow", "dry-grass", "clover"};
  return names;
}

GrassSpecies grassSpecies(const std::string& name) {
  if (name == "lawn") return lawn();
  if (name == "meadow") return meadow();
  if (name == "dry-grass") return dryGrass();
  if (name == "clover") return clover();
  throw Error("grass species", "'" + name + "' is unknown",
              fmt::format("choose one of {}", fmt::join(grassSpeciesNames(), ", ")));
}

}  // namespace verdure
