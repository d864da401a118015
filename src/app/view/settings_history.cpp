#include "app/view/settings_history.h"

#include <exception>
#include <utility>

namespace verdure::app {
namespace {

/// As files would have them. What no file can hold counts as another value.
bool sameInFiles(const SceneSettings& a, const SceneSettings& b) {
  try {
    return sceneText(a, "scene.json") == sceneText(b, "scene.json");
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

void SettingsHistory::start(const SceneSettings& settings, bool saved) {
  values_.clear();
  values_.push_back({settings, {}});
  present_ = 0;
  saved_ = saved ? std::optional<std::size_t>(0) : std::nullopt;
  noted_.clear();
}

void SettingsHistory::settle(const SceneSettings& now) {
  if (noted_.empty()) return;
  const std::set<Edit> edits = std::exchange(noted_, {});
  if (sameInFiles(now, values_[present_].settings)) return;
  values_.resize(present_ + 1);
  if (saved_ && *saved_ > present_) saved_.reset();
  values_.push_back({now, edits});
  ++present_;
  if (values_.size() <= kMostSteps + 1) return;
  values_.pop_front();
  --present_;
  if (saved_) saved_ = *saved_ > 0 ? std::optional(*saved_ - 1) : std::nullopt;
}

SettingsHistory::Step SettingsHistory::undo() {
  const std::set<Edit>& edits = values_[present_].edits;
  --present_;
  return {&values_[present_].settings, edits};
}

SettingsHistory::Step SettingsHistory::redo() {
  ++present_;
  return {&values_[present_].settings, values_[present_].edits};
}

}  // namespace verdure::app
