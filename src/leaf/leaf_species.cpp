#include "leaf/leaf_species.h"

#include "verdure/error.h"

namespace verdure {
namespace {

// Sizes after the floras: blades and stalks at the middle of the species' range.
// Pigments are chlorophyll, carotenoids, anthocyanins and tannins.

LeafSpecies quakingAspen() {
  PinnateForm form;
  form.stalk_mm = 32;
  form.stalk_radius_mm = 0.55f;  // flat, edge-on to the viewer
  form.bend = 0.03f;
  BladeShape& blade = form.blade;
  blade.length_mm = 50;
  blade.margin = {{{0, 0}},          {{0.16f, -0.012f}}, {{0.36f, 0.10f}},
                  {{0.465f, 0.32f}}, {{0.435f, 0.55f}},  {{0.315f, 0.74f}},
                  {{0.15f, 0.88f}},  {{0.055f, 0.95f}},  {{0, 1}}};
  blade.pairs = 6;
  blade.first = 0.005f;
  blade.last = 0.74f;
  blade.angle_base_deg = 52;
  blade.angle_tip_deg = 44;
  blade.bend = 0.07f;
  blade.loop = 0.85f;
  blade.stagger = 0.3f;
  blade.minor_mm = 0.65f;
  blade.pitch_mm = 2.3f;
  blade.teeth_from = 0.07f;
  blade.teeth_to = 0.95f;
  blade.saw = {{}, {}, 0.30f, 0.6f, 0.62f};
  LeafSpecies s;
  s.info = {"quaking-aspen", "Quaking aspen (Populus tremuloides)"};
  s.form = [form](std::uint64_t seed) { return makePinnate(form, seed); };
  s.veins = {0.16f, 0.5f, 6, 0.2f, 2.6f};
  s.thickness_mm = 0.20f;
  s.quilt_mm = 0.28f;
  s.quilt_reach_mm = 2.4f;
  s.spring = {0.62f, 0.40f, 0.05f, 0};
  s.summer = {0.96f, 0.42f, 0, 0};
  s.autumn = {0.02f, 0.95f, 0.06f, 0};
  s.stalk = {0.30f, 0.35f, 0.08f, 0.05f};
  s.back_path = 0.76f;
  s.back_bloom = 0.035f;
  s.roughness = 0.28f;
  return s;
}

LeafSpecies blackTupelo() {
  PinnateForm form;
  form.stalk_mm = 13;
  form.stalk_radius_mm = 0.75f;
  form.bend = 0.035f;
  BladeShape& blade = form.blade;
  blade.length_mm = 95;
  blade.margin = {{{0, 0}},          {{0.055f, 0.045f}}, {{0.145f, 0.20f}},
                  {{0.218f, 0.40f}}, {{0.240f, 0.58f}},  {{0.205f, 0.76f}},
                  {{0.11f, 0.895f}}, {{0.035f, 0.955f}}, {{0, 1}}};
  blade.pairs = 9;
  blade.first = 0.07f;
  blade.last = 0.80f;
  blade.angle_base_deg = 47;
  blade.angle_tip_deg = 50;
  blade.bend = 0.10f;
  blade.loop = 1.1f;
  LeafSpecies s;
  s.info = {"black-tupelo", "Black tupelo (Nyssa sylvatica)"};
  s.form = [form](std::uint64_t seed) { return makePinnate(form, seed); };
  s.veins = {0.22f, 0.65f, 7, 0.25f, 2.6f};
  s.thickness_mm = 0.28f;
  s.quilt_mm = 0.35f;
  s.quilt_reach_mm = 3.0f;
  s.areole_mm = 0.55f;
  s.spring = {0.62f, 0.42f, 0.10f, 0};
  s.summer = {1.08f, 0.42f, 0, 0};
  s.autumn = {0.03f, 0.75f, 1.05f, 0};
  s.stalk = {0.30f, 0.35f, 0.35f, 0.05f};
  s.back_path = 0.82f;
  s.back_bloom = 0.02f;
  s.roughness = 0.18f;
  return s;
}

LeafSpecies weepingWillow() {
  PinnateForm form;
  form.stalk_mm = 7;
  form.stalk_radius_mm = 0.5f;
  form.bend = 0.07f;
  BladeShape& blade = form.blade;
  blade.length_mm = 112;
  blade.margin = {{{0, 0}},          {{0.020f, 0.03f}},  {{0.046f, 0.13f}},
                  {{0.060f, 0.29f}}, {{0.056f, 0.45f}},  {{0.042f, 0.62f}},
                  {{0.024f, 0.79f}}, {{0.0085f, 0.92f}}, {{0, 1}}};
  blade.pairs = 22;
  blade.first = 0.04f;
  blade.last = 0.92f;
  blade.angle_base_deg = 52;
  blade.angle_tip_deg = 40;
  blade.bend = 0.14f;
  blade.loop = 1.2f;
  blade.minor_mm = 0.34f;
  blade.pitch_mm = 1.55f;
  blade.teeth_from = 0.08f;
  blade.teeth_to = 0.99f;
  blade.saw = {{}, {}, 0.25f, 0.9f, 1.1f};
  LeafSpecies s;
  s.info = {"weeping-willow", "Weeping willow (Salix babylonica)"};
  s.form = [form](std::uint64_t seed) { return makePinnate(form, seed); };
  s.veins = {0.14f, 0.45f, 2.5f, 0.15f, 2.7f};
  s.thickness_mm = 0.20f;
  s.quilt_mm = 0.12f;
  s.quilt_reach_mm = 1.2f;
  s.spring = {0.58f, 0.42f, 0, 0};
  s.summer = {0.90f, 0.42f, 0, 0};
  s.autumn = {0.08f, 0.90f, 0, 0.04f};
  s.stalk = {0.25f, 0.45f, 0.05f, 0.02f};
  s.back_path = 0.68f;
  s.back_bloom = 0.075f;
  s.roughness = 0.26f;
  return s;
}

LeafSpecies blackOak() {
  LeafSpecies s;
  s.info = {"black-oak", "California black oak (Quercus kelloggii)"};
  s.form = makeOak;
  s.veins = {0.24f, 0.7f, 8, 0.25f, 2.6f};
  s.thickness_mm = 0.26f;
  s.quilt_mm = 0.35f;
  s.quilt_reach_mm = 3.2f;
  s.areole_mm = 0.5f;
  s.spring = {0.45f, 0.38f, 0.55f, 0};  // unfolds pink
  s.summer = {1.02f, 0.45f, 0, 0};
  s.autumn = {0.02f, 0.95f, 0.22f, 0.28f};
  s.stalk = {0.28f, 0.50f, 0.12f, 0.10f};
  s.back_path = 0.80f;
  s.back_bloom = 0.025f;
  s.roughness = 0.20f;
  s.edge_browning = 1.3f;
  return s;
}

LeafSpecies japaneseMaple() {
  LeafSpecies s;
  s.info = {"japanese-maple", "Japanese maple (Acer palmatum)"};
  s.form = makeMaple;
  s.veins = {0.17f, 0.5f, 5, 0.2f, 2.6f};
  s.thickness_mm = 0.18f;
  s.quilt_mm = 0.18f;
  s.quilt_reach_mm = 1.8f;
  // A red-leaved form, as the tree.
  s.spring = {0.16f, 0.35f, 0.95f, 0};
  s.summer = {0.42f, 0.12f, 1.10f, 0};
  s.autumn = {0.0f, 0.75f, 0.90f, 0};
  s.stalk = {0.22f, 0.25f, 0.95f, 0.12f};
  s.back_path = 0.84f;
  s.back_bloom = 0.02f;
  s.vein_contrast = 0.55f;
  s.roughness = 0.34f;
  return s;
}

LeafSpecies scotsPine() {
  LeafSpecies s;
  s.info = {"scots-pine", "Scots pine (Pinus sylvestris)"};
  s.thickness_mm = 0.8f;
  s.spring = {0.70f, 0.36f, 0, 0};
  s.summer = {1.02f, 0.24f, 0, 0};
  s.autumn = {0.45f, 0.60f, 0, 0.25f};
  s.stalk = {0.10f, 0.40f, 0.10f, 0.85f};
  s.back_path = 0.92f;
  s.back_bloom = 0.012f;
  s.roughness = 0.28f;
  return s;
}

LeafSpecies silverBirch() {
  PinnateForm form;
  form.stalk_mm = 16;
  form.stalk_radius_mm = 0.5f;
  form.bend = 0.03f;
  BladeShape& blade = form.blade;
  blade.length_mm = 52;
  blade.margin = {{{0, 0}},          {{0.13f, 0.008f}},  {{0.305f, 0.105f}},
                  {{0.37f, 0.225f}}, {{0.335f, 0.37f}},  {{0.225f, 0.55f}},
                  {{0.115f, 0.73f}}, {{0.045f, 0.875f}}, {{0, 1}}};
  blade.pairs = 7;
  blade.first = 0.035f;
  blade.last = 0.74f;
  blade.angle_base_deg = 56;
  blade.angle_tip_deg = 42;
  blade.bend = 0.045f;
  blade.into_teeth = true;
  blade.tooth_mm = 1.45f;
  blade.minor_mm = 0.75f;
  blade.pitch_mm = 1.75f;
  blade.teeth_from = 0.12f;
  blade.teeth_to = 0.985f;
  blade.saw = {{}, {}, 0.15f, 0.5f, 1.1f};
  LeafSpecies s;
  s.info = {"silver-birch", "Silver birch (Betula pendula)"};
  s.form = [form](std::uint64_t seed) { return makePinnate(form, seed); };
  s.veins = {0.16f, 0.48f, 5, 0.18f, 2.6f};
  s.thickness_mm = 0.18f;
  s.quilt_mm = 0.32f;
  s.quilt_reach_mm = 2.0f;
  s.spring = {0.60f, 0.42f, 0, 0};
  s.summer = {0.97f, 0.44f, 0, 0};
  s.autumn = {0.02f, 1.0f, 0.02f, 0.03f};
  s.stalk = {0.32f, 0.40f, 0.12f, 0.08f};
  s.back_path = 0.80f;
  s.back_bloom = 0.022f;
  s.roughness = 0.30f;
  return s;
}

LeafSpecies hedge() {
  PinnateForm form;
  form.stalk_mm = 4;
  form.stalk_radius_mm = 0.65f;
  form.bend = 0.03f;
  BladeShape& blade = form.blade;
  blade.length_mm = 44;
  blade.margin = {{{0, 0}},          {{0.075f, 0.035f}}, {{0.18f, 0.17f}},  {{0.245f, 0.37f}},
                  {{0.240f, 0.55f}}, {{0.185f, 0.75f}},  {{0.085f, 0.92f}}, {{0, 1}}};
  blade.pairs = 6;
  blade.first = 0.07f;
  blade.last = 0.74f;
  blade.angle_base_deg = 50;
  blade.angle_tip_deg = 47;
  blade.bend = 0.10f;
  blade.loop = 1.0f;
  blade.stagger = 0.15f;
  LeafSpecies s;
  s.info = {"hedge", "Hedge privet (Ligustrum)"};
  s.form = [form](std::uint64_t seed) { return makePinnate(form, seed); };
  s.veins = {0.16f, 0.6f, 5, 0.2f, 2.5f};
  s.thickness_mm = 0.36f;
  s.protrusion = 0.5f;
  s.groove = 0.5f;
  s.quilt_mm = 0.12f;
  s.quilt_reach_mm = 2.2f;
  s.pillow_mm = 0.015f;
  s.spring = {0.66f, 0.42f, 0, 0};
  s.summer = {1.10f, 0.42f, 0, 0};
  s.autumn = {0.40f, 0.80f, 0.25f, 0};
  s.stalk = {0.45f, 0.40f, 0.05f, 0.02f};
  s.back_path = 0.74f;
  s.back_bloom = 0.02f;
  s.vein_contrast = 0.38f;
  s.edge_browning = 0.5f;
  s.roughness = 0.14f;
  return s;
}

}  // namespace

const std::vector<LeafSpecies>& allLeafSpecies() {
  static const std::vector<LeafSpecies> list{quakingAspen(), blackTupelo(),   weepingWillow(),
                                             blackOak(),     japaneseMaple(), scotsPine(),
                                             silverBirch(),  hedge()};
  return list;
}

const LeafSpecies& findLeafSpecies(const std::string& name) {
  for (const LeafSpecies& species : allLeafSpecies())
    if (species.info.name == name) return species;
  std::string names;
  for (const LeafSpecies& species : allLeafSpecies())
    names += (names.empty() ? "" : ", ") + species.info.name;
  throw Error("leaf species " + name, "there is no such species", "take one of " + names);
}

const std::vector<LeafSpeciesInfo>& leafSpeciesList() {
  static const std::vector<LeafSpeciesInfo> list = [] {
    std::vector<LeafSpeciesInfo> infos;
    for (const LeafSpecies& species : allLeafSpecies()) infos.push_back(species.info);
    return infos;
  }();
  return list;
}

}  // namespace verdure
