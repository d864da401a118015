#include "app/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/view/widgets.h"
#include "verdure/grass.h"

namespace verdure::app {
namespace {

/// The eight terms that LookSettings::terms names.
struct TermName {
  const char* name;
  bool Terms::*term;
};
constexpr std::array kTerms{
    TermName{"ambient", &Terms::ambient},       TermName{"diffuse", &Terms::diffuse},
    TermName{"specular", &Terms::specular},     TermName{"shadow", &Terms::shadow},
    TermName{"textures", &Terms::textures},     TermName{"transmission", &Terms::transmission},
    TermName{"scattering", &Terms::scattering}, TermName{"gloss", &Terms::gloss}};

/// Those that are on.
std::vector<std::string> namesOf(const Terms& terms) {
  std::vector<std::string> names;
  for (const TermName& each : kTerms)
    if (terms.*each.term) names.emplace_back(each.name);
  return names;
}

BakeParameters& bakeOf(PlantSettings& plant) {
  if (!plant.bake) plant.bake.emplace();
  return *plant.bake;
}

}  // namespace

Change plantPanel(ViewSession& session, PanelState& state) {
  Change change = Change::kNothing;
  SceneSettings& settings = session.settings;
  if (settings.plants.empty()) {
    ImGui::TextWrapped("No plant. Drop a file here, or use File.");
    return change;
  }
  state.plant = std::min(state.plant, settings.plants.size() - 1);
  if (settings.plants.size() > 1)
    for (std::size_t i = 0; i < settings.plants.size(); ++i)
      if (ImGui::Selectable(settings.plants[i].name.c_str(), i == state.plant)) state.plant = i;
  PlantSettings& plant = settings.plants[state.plant];
  if (plant.file.empty()) {
    std::vector<std::string> species;
    for (const SpeciesInfo& info : speciesList()) species.push_back(info.name);
    if (choice("species", plant.grow.species, species)) change |= Change::kScene;
    int seed = static_cast<int>(plant.grow.seed);
    if (ImGui::InputInt("seed", &seed)) {
      plant.grow.seed = static_cast<std::uint32_t>(std::max(seed, 0));
      change |= Change::kScene;
    }
    slider("leaf age", plant.grow.leaf_age, 0.0f, 1.0f);
    change |= sceneWhenLetGo();
  } else {
    ImGui::TextWrapped("%s", plant.file.c_str());
  }
  const ShownScene* shown = session.shown();
  if (shown == nullptr || state.plant >= shown->loaded().plants().size()) return change;
  const Plant& loaded = shown->loaded().plants()[state.plant].plant;
  ImGui::TextDisabled("%zu vertices, %zu leaves, %zu branches", vertexCount(loaded),
                      loaded.leaves.size(), loaded.branches.size());
  for (const std::string& note : shown->loaded().notes()) {
    ImGui::PushTextWrapPos();
    ImGui::TextDisabled("%s", note.c_str());
    ImGui::PopTextWrapPos();
  }
  return change;
}

Change bakePanel(ViewSession& session, const PanelState& state) {
  SceneSettings& settings = session.settings;
  if (state.plant >= settings.plants.size()) return Change::kNothing;
  PlantSettings& plant = settings.plants[state.plant];
  bool changed = false;
  BakeParameters shown = plant.bake.value_or(BakeParameters());
  int field = shown.fieldOr(BakeField::kOpticalDepth) == BakeField::kMetaball ? 1 : 0;
  constexpr std::array<const char*, 2> kFields{"optical depth", "metaballs (Luft 2007)"};
  if (choice("field", field, kFields)) {
    bakeOf(plant).field = field == 1 ? "metaball" : "optical-depth";
    bakeOf(plant).metaball_option.clear();
    bakeOf(plant).normals.clear();
    changed = true;
    shown = *plant.bake;
  }
  const bool metaball = field == 1;
  const auto wanted = [&plant, metaball]() -> BakeParameters& {
    BakeParameters& bake = bakeOf(plant);
    bake.field = metaball ? "metaball" : "optical-depth";
    return bake;
  };
  DensityOptions& options = shown.options;
  bool edited = false;
  if (metaball) {
    // What the last bake found is where sliders start.
    const PlantBake* last =
        session.shown() != nullptr && state.plant < session.shown()->loaded().plants().size()
            ? session.shown()->bake(state.plant)
            : nullptr;
    const float rho = last != nullptr && last->rho > 0.0f ? last->rho : 0.3f;
    const float tau = last != nullptr && last->rho > 0.0f ? last->tau : 1.0f;
    const float most = last != nullptr && last->rho > 0.0f ? last->most_tau : 10.0f;
    const float d_min = last != nullptr && last->d_min > 0.0f ? last->d_min : 1.0f;
    edited |= optionalSlider("rho, m", options.rho, rho, 0.01f, 5.0f, "%.3f", true);
    edited |= optionalSlider("tau", options.tau, tau, 0.001f, std::max(most, 0.01f), "%.3f", true);
    edited |= slider("share of leaves", options.fraction, 0.01f, 1.0f, "%.2f", true);
    edited |= slider("cells", options.grid, 16, 384);
    edited |=
        optionalSlider("d_min", options.d_min, d_min, 0.01f, std::max(most, d_min), "%.3g", true);
    edited |= slider("k_min", options.k_min, 0.0f, 1.0f, "%.2f");
    edited |= slider("exponent n", options.exponent, 0.1f, 8.0f, "%.2f", true);
    edited |= choice("norm", shown.norm, {"1", "2", "4", "inf"});
    if (shown.normals.empty()) shown.normals = "surface-point";
    edited |=
        choice("normals", shown.normals, {"surface-point", "surface-vertex", "ellipsoid", "keep"});
    ImGui::Checkbox("show the surface", &session.show_surface);
    explain("Where the kernel sum equals tau: Figure 3 of Luft et al. 2007");
  } else {
    bool fit = shown.fit.value_or(true);
    if (ImGui::Checkbox("fitted by rays", &fit)) {
      shown.fit = fit;
      edited = true;
    }
    if (shown.normals.empty()) shown.normals = "optical-depth";
    edited |= choice("normals", shown.normals, {"optical-depth", "keep"});
  }
  edited |= slider("blend of normals", options.blend, 0.0f, 1.0f, "%.2f");
  if (edited) {
    plant.bake = shown;
    wanted();
    changed = true;
  }
  if (ImGui::Button("Bake")) {
    wanted();
    changed = true;
  }
  if (session.shown() != nullptr && state.plant < session.shown()->loaded().plants().size())
    if (const PlantBake* bake = session.shown()->bake(state.plant)) {
      ImGui::SameLine();
      ImGui::TextDisabled("first seen after %.0f ms, all in %.0f", session.bakeLatency() * 1e3,
                          bake->seconds * 1e3);
      ImGui::PushTextWrapPos();
      ImGui::TextDisabled("%s", bake->report.c_str());
      ImGui::PopTextWrapPos();
    }
  return changed ? Change::kBake : Change::kNothing;
}

Change lightPanel(ViewSession& session) {
  SceneSettings& settings = session.settings;
  LookSettings& look = settings.look;
  const LookSettings before = look;
  bool changed = choice("preset", look.light, presetNames());
  if (changed) {
    look.terms.reset();
    look.shadows.reset();
    session.lightChanged(before);
  }
  Terms terms = session.view().terms;
  const auto source = static_cast<std::size_t>(terms.ambient_source);
  constexpr std::array kSources{"constant", "sky", "baked", "transfer", "leaf visibility"};
  ImGui::TextDisabled("%s normals, ambient: %s",
                      terms.normal == NormalSource::kCrown ? "crown" : "leaf", kSources[source]);
  for (std::size_t i = 0; i < kTerms.size(); ++i) {
    if (i % 2 == 1) ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (!ImGui::Checkbox(kTerms[i].name, &(terms.*kTerms[i].term))) continue;
    look.terms = namesOf(terms);
    changed = true;
  }
  if (look.terms && ImGui::Button("all of the preset")) {
    look.terms.reset();
    changed = true;
  }
  constexpr std::array kShadows{"the preset's", "shadow map", "depth maps: paper",
                                "depth maps: layers", "depth maps: ordered"};
  int shadows = look.shadows ? 1 + static_cast<int>(*look.shadows) : 0;
  if (choice("shadows", shadows, kShadows)) {
    look.shadows =
        shadows == 0 ? std::nullopt : std::optional(static_cast<ShadowSource>(shadows - 1));
    changed = true;
  }
  constexpr std::array kMapSizes{512, 1024, 2048, 4096};
  constexpr std::array kMapNames{"512", "1024", "2048", "4096"};
  int size = static_cast<int>(std::find(kMapSizes.begin(), kMapSizes.end(), look.shadow_map) -
                              kMapSizes.begin());
  if (choice("shadow map", size, kMapNames)) {
    look.shadow_map = kMapSizes[static_cast<std::size_t>(size)];
    changed = true;
  }
  constexpr std::array kCascades{"automatic", "1", "2", "3", "4"};
  changed |= choice("cascades", look.cascades, kCascades);
  changed |= slider("bands of the sky", look.sky_bands, 2, 7);
  if (terms.ambient_source == AmbientSource::kLeafVisibility)
    changed |= slider("visibility exponent", look.visibility_exponent, 0.1f, 8.0f, "%.2f", true);
  bool plain = look.background.has_value();
  if (ImGui::Checkbox("plain background", &plain)) {
    look.background = plain ? std::optional(glm::vec3(0.5f)) : std::nullopt;
    changed = true;
  }
  if (look.background) {
    ImGui::SameLine();
    changed |= ImGui::ColorEdit3("##background", &look.background->x, ImGuiColorEditFlags_NoInputs);
  }
  constexpr std::array kStyles{"photo", "edges", "toon", "watercolor"};
  int style = static_cast<int>(look.style);
  if (choice("style", style, kStyles)) {
    look.style = static_cast<Style>(style);
    changed = true;
  }
  if (look.style != Style::kPhoto) {
    constexpr std::array kNormals{"raw", "realigned", "scaled"};
    int normals = static_cast<int>(look.style_normals);
    if (choice("its normals", normals, kNormals)) {
      look.style_normals = static_cast<StyleNormals>(normals);
      changed = true;
    }
  }
  ImGui::Separator();
  constexpr std::array kInspected{"the light",        "normals",      "ambient coefficient",
                                  "layers of leaves", "branch level", "texels a pixel",
                                  "base colour"};
  if (choice("show", session.inspected, kInspected)) session.refresh();
  constexpr std::array kBeside{"nothing", "another preset", "the path tracer"};
  int beside = static_cast<int>(session.beside);
  if (choice("beside it", beside, kBeside)) {
    session.beside = static_cast<Beside>(beside);
    session.refresh();
  }
  if (session.beside == Beside::kPreset &&
      choice("its preset", session.beside_light, presetNames()))
    session.refresh();
  return picture(changed);
}

Change skyPanel(SceneSettings& settings, PanelState& state) {
  DaylightSettings& daylight = settings.daylight;
  bool changed = false;
  int how = daylight.date.empty() ? 0 : 1;
  constexpr std::array kHow{"directions", "a date and a place"};
  if (choice("sun by", how, kHow)) {
    if (how == 1) {
      daylight.sun_deg.reset();
      daylight.date = "2026-06-21T12:00Z";
      daylight.place = Place{48.2, 16.4};
    } else {
      daylight.date.clear();
      daylight.place.reset();
      daylight.sun_deg = glm::vec2(85.0f, 42.0f);
    }
    changed = true;
  }
  if (daylight.date.empty()) {
    glm::vec2 sun = daylight.sun_deg.value_or(glm::vec2(85.0f, 42.0f));
    bool moved = slider("azimuth", sun.x, -180.0f, 180.0f, "%.1f");
    moved |= slider("elevation", sun.y, -12.0f, 90.0f, "%.1f");
    if (moved) daylight.sun_deg = sun;
    changed |= moved;
  } else {
    changed |= ImGui::InputText("date", &daylight.date, ImGuiInputTextFlags_EnterReturnsTrue);
    try {
      const double time = parseTime(daylight.date), day = std::floor(time / 86400.0) * 86400.0;
      state.hour = (time - day) / 3600.0;
      if (slider("hour (UTC)", state.hour, 0.0f, 23.983f, "%.2f")) {
        daylight.date = formatTime(day + state.hour * 3600.0);
        changed = true;
      }
    } catch (const std::exception& e) {
      ImGui::TextWrapped("%s", e.what());
    }
    changed |= slider("latitude", daylight.place->latitude_deg, -90.0f, 90.0f, "%.1f");
    changed |= slider("longitude", daylight.place->longitude_deg, -180.0f, 180.0f, "%.1f");
  }
  changed |= slider("turbidity", daylight.turbidity, 2.0f, 10.0f, "%.1f");
  if (ImGui::BeginCombo("sky", daylight.sky.c_str())) {
    for (int type = 0; type <= 15; ++type) {
      const std::string name = type == 0 ? "preetham" : fmt::format("cie:{}", type);
      if (!ImGui::Selectable(name.c_str(), name == daylight.sky)) continue;
      daylight.sky = name;
      changed = true;
    }
    ImGui::EndCombo();
  }
  explain("preetham, the CIE's standard skies, or a panorama (.hdr, .exr): drop it on the window");
  return picture(changed);
}

Change exposurePanel(SceneSettings& settings, const ViewSession& session) {
  ExposureSettings& exposure = settings.exposure;
  const Frame& frame = session.frame(0);
  const float ev =
      frame.average_luminance > 0.0f ? std::log2(frame.average_luminance / 0.125e-3f) : 14.0f;
  bool changed = optionalSlider("EV", exposure.ev, ev, -6.0f, 20.0f, "%.1f");
  changed |= slider("key", exposure.key, 0.02f, 1.5f, "%.2f", true);
  changed |= optionalSlider("white", exposure.white, std::max(frame.white, 0.1f), 0.5f, 20.0f,
                            "%.2f", true);
  changed |= slider("bloom", exposure.bloom, 0.0f, 0.2f, "%.3f");
  return picture(changed);
}

Change windPanel(ViewSession& session) {
  WindSettings& wind = session.settings.wind;
  float speed = windOf(wind).speed;
  bool changed = slider("speed, m/s", speed, 0.0f, 30.0f, "%.1f");
  if (changed) wind.speed = speed;
  changed |= slider("from", wind.from_deg, 0.0f, 360.0f, "%.0f deg");
  changed |= slider("gusts", wind.gusts, 0.0f, 1.0f, "%.2f");
  double seconds = wind.seconds.value_or(0.0);
  if (slider("time, s", seconds, 0.0f, 60.0f, "%.2f")) {
    if (!wind.speed) wind.speed = speed;  // a time alone would make it blow
    wind.seconds = seconds;
    changed = true;
  }
  if (ImGui::Button(session.playing ? "Pause" : "Play")) session.togglePlay();
  return picture(changed);
}

Change groundPanel(SceneSettings& settings) {
  GroundSettings& ground = settings.ground;
  Change change = Change::kNothing;
  if (ImGui::Checkbox("ground", &ground.shown)) change |= Change::kScene;
  const std::vector<std::string>& known = grassSpeciesNames();
  for (std::size_t i = 0; i < ground.grass.size(); ++i) {
    GrassLayerSettings& layer = ground.grass[i];
    ImGui::PushID(static_cast<int>(i));
    if (choice("grass", layer.grass, known)) change |= Change::kScene;
    slider("density", layer.density, 0.0f, 1.0f, "%.2f");
    change |= sceneWhenLetGo();
    const bool removed = ImGui::Button("Remove");
    ImGui::PopID();
    if (!removed) continue;
    ground.grass.erase(ground.grass.begin() + static_cast<std::ptrdiff_t>(i));
    return Change::kScene;
  }
  if (ImGui::Button("Add grass")) {
    ground.grass.emplace_back().grass = known.front();
    change |= Change::kScene;
  }
  if (!ground.grass.empty()) {
    slider("slices on a ray", ground.grass_slices, 4, 128);
    change |= sceneWhenLetGo();
  }
  bool hills = !ground.terrain.empty();
  if (ImGui::Checkbox("terrain", &hills)) {
    ground.terrain = hills ? "hills" : "";
    change |= Change::kScene;
  }
  if (!hills) return change;
  if (ImGui::InputText("heights", &ground.terrain, ImGuiInputTextFlags_EnterReturnsTrue))
    change |= Change::kScene;
  explain("hills, or a grey picture");
  ImGui::DragFloat2("size, m", &ground.terrain_size_m.x, 1.0f, 1.0f, 10000.0f, "%.0f");
  change |= sceneWhenLetGo();
  ImGui::DragFloat2("from, to, m", &ground.terrain_height_m.x, 0.1f, -500.0f, 500.0f, "%.1f");
  change |= sceneWhenLetGo();
  return change;
}

void cameraPanel(ViewSession& session) {
  auto fov = static_cast<float>(session.settings.camera.fov_deg);
  if (slider("field of view", fov, 5.0f, 120.0f, "%.0f deg")) {
    session.settings.camera.fov_deg = double{fov};
    session.changed(Change::kPicture);
  }
  Camera camera = session.camera();
  bool moved = ImGui::DragFloat3("eye", &camera.eye.x, 0.02f, 0.0f, 0.0f, "%.2f");
  moved |= ImGui::DragFloat3("target", &camera.target.x, 0.02f, 0.0f, 0.0f, "%.2f");
  if (moved && glm::length(camera.eye - camera.target) > 1e-4f) session.moveCamera(camera);
  if (ImGui::Button("Show all")) session.showAll();
  explain(
      "Left: orbit. Middle, or Shift and left: move. Wheel: nearer. Right: look around; with W A S "
      "D Q E: fly.");
  if (ImGui::InputInt2("picture size", &session.settings.width)) {
    session.settings.width = std::clamp(session.settings.width, 16, 16384);
    session.settings.height = std::clamp(session.settings.height, 16, 16384);
    session.changed(Change::kPicture);
  }
}

void timesPanel(const ViewSession& session) {
  const FrameTimes& times = session.frame(0).times;
  const auto row = [](const char* name, double ms) {
    ImGui::Text("%-14s", name);
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    ImGui::Text("%8.2f ms", ms);
  };
  row("wind", times.motion_ms);
  row("shadow maps", times.shadow_ms);
  row("colour", times.color_ms);
  row("tone", times.tone_ms);
  row("upload (CPU)", times.pack_ms);
  row("picture (wall)", session.drawSeconds() * 1e3);
  ImGui::TextDisabled("maps of the sun: %d", session.frame(0).shadow_cascades);
}

void drawPanels(ViewSession& session, PanelState& state) {
  Change change = Change::kNothing;
  const auto section = [](const char* title, bool open) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  };
  ImGui::PushItemWidth(0.52f * ImGui::GetContentRegionAvail().x);
  const auto run = [&](const char* title, bool open, const auto& body) {
    ImGui::PushID(title);
    if (section(title, open)) change |= body();
    ImGui::PopID();
  };
  run("Plant", true, [&] { return plantPanel(session, state); });
  run("Light", true, [&] { return lightPanel(session); });
  run("Bake", false, [&] { return bakePanel(session, state); });
  run("Sun and sky", false, [&] { return skyPanel(session.settings, state); });
  run("Exposure", false, [&] { return exposurePanel(session.settings, session); });
  run("Wind", false, [&] { return windPanel(session); });
  run("Branches", false, [&] { return motionPanel(session, state); });
  run("Ground", false, [&] { return groundPanel(session.settings); });
  run("Camera", false, [&] {
    cameraPanel(session);
    return Change::kNothing;
  });
  run("Times", false, [&] {
    timesPanel(session);
    return Change::kNothing;
  });
  ImGui::PopItemWidth();
  session.changed(change, state.plant);
}

}  // namespace verdure::app
