#include <algorithm>
#include <cmath>

#include "app/view/panels.h"
#include "app/view/widgets.h"

namespace verdure::app {
namespace {

constexpr float kMost = 8.0f;  // of flexibilities, as far as sliders go

/// A branch by its number: what it is, and how far it bends beside the others of its level.
bool branchControls(const PlantMotion& motion, MotionSettings& settings, int& shown) {
  const int last = static_cast<int>(motion.tree.branches.size()) - 1;
  ImGui::InputInt("branch", &shown);
  shown = std::clamp(shown, 0, last);
  const auto number = static_cast<std::uint32_t>(shown);
  const MotionBranch& branch = motion.tree.branches[number];
  const BranchMotion& answer = motion.branches[number];
  ImGui::TextDisabled("level %d, %.2f m long, %.1f to %.1f mm thick", branch.level,
                      double{branch.length}, 2e3 * double{branch.root_radius},
                      2e3 * double{branch.tip_radius});
  ImGui::TextDisabled("%.2f Hz, %.3g kg, carries %.3g m2 of leaves", double{answer.frequency_hz},
                      double{answer.mass_kg}, double{branch.leaf_m2});
  const auto found = std::find_if(
      settings.branches.begin(), settings.branches.end(),
      [number](const MotionSettings::BranchFlexibility& one) { return one.branch == number; });
  float flexibility = found != settings.branches.end() ? found->flexibility : 1.0f;
  if (!slider("its flexibility", flexibility, 0.0f, kMost, "%.2f")) return false;
  if (found != settings.branches.end())
    found->flexibility = flexibility;
  else
    settings.branches.push_back({number, flexibility});
  return true;
}

}  // namespace

Change motionPanel(ViewSession& session, PanelState& state) {
  const ShownScene* shown = session.shown();
  if (shown == nullptr || state.plant >= session.settings.plants.size() ||
      state.plant >= shown->loaded().plants().size())
    return Change::kNothing;
  const PlantMotion* motion = shown->motion(state.plant);
  if (motion == nullptr || motion->tree.branches.empty()) {
    ImGui::TextDisabled("It stands still.");
    return Change::kNothing;
  }
  std::optional<MotionSettings>& kept = session.settings.plants[state.plant].motion;
  MotionSettings settings = kept.value_or(MotionSettings());
  bool changed = slider("flexibility", settings.flexibility, 0.05f, kMost, "%.2f", true);
  int levels = 0;
  for (const MotionBranch& branch : motion->tree.branches)
    levels = std::max(levels, branch.level + 1);
  constexpr const char* kLevels[] = {"trunk", "level 1", "level 2", "level 3"};
  ImGui::TextUnformatted("of levels");
  ImGui::PushID("flexibility");
  for (int level = 0; level < levels; ++level)
    changed |= slider(kLevels[level], settings.level_flexibility[level], 0.0f, kMost, "%.2f");
  ImGui::PopID();
  ImGui::TextUnformatted("damping ratio");
  ImGui::PushID("damping");
  for (int level = 0; level < levels; ++level)
    changed |= slider(kLevels[level], settings.damping_ratio[level], 0.02f, 4.0f, "%.2f", true);
  ImGui::PopID();
  changed |= branchControls(*motion, settings, state.branch);
  if (changed) kept = settings;
  if (kept && ImGui::Button("as it was")) {
    kept.reset();
    changed = true;
  }
  return changed ? Change::kMotion : Change::kNothing;
}

}  // namespace verdure::app
