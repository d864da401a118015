#ifndef VERDURE_APP_VIEW_SETTINGS_HISTORY_H_
#define VERDURE_APP_VIEW_SETTINGS_HISTORY_H_

#include <compare>
#include <cstddef>
#include <deque>
#include <optional>
#include <set>

#include "app/scene_settings.h"
#include "app/view/changes.h"

namespace verdure::app {

/// The values that a scene's settings settled at, so that changes can be taken back, and which of
/// them is in a file.
class SettingsHistory {
 public:
  /// Something that a change asks for. `plant`: whose bake or motion.
  struct Edit {
    Change change = Change::kNothing;
    std::size_t plant = 0;
    auto operator<=>(const Edit&) const = default;
  };
  /// Where undo() and redo() lead.
  struct Step {
    const SceneSettings* settings = nullptr;  ///< until the next call
    std::set<Edit> edits;                     ///< what must be done for them, the most last
  };
  /// Of more, the oldest are forgotten.
  static constexpr std::size_t kMostSteps = 100;

  /// Another scene: nothing to take back. `saved`: it is in a file.
  void start(const SceneSettings& settings, bool saved);
  /// A setting is being changed.
  void note(const Edit& edit) { noted_.insert(edit); }
  /// What was noted since the last call is one step to `now`, if that is another value. What had
  /// been taken back is forgotten.
  void settle(const SceneSettings& now);

  // Of settled values:
  bool canUndo() const { return present_ > 0; }
  bool canRedo() const { return present_ + 1 < values_.size(); }
  Step undo();  ///< canUndo()
  Step redo();  ///< canRedo()

  /// The present value was written.
  void markSaved() { saved_ = present_; }
  /// The present value is in no file.
  bool modified() const { return !noted_.empty() || saved_ != present_; }

 private:
  struct Value {
    SceneSettings settings;
    std::set<Edit> edits;  ///< from the value before
  };
  std::deque<Value> values_ = std::deque<Value>(1);  ///< oldest first, at least the one of start()
  std::size_t present_ = 0;
  std::optional<std::size_t> saved_ = 0;
  std::set<Edit> noted_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_SETTINGS_HISTORY_H_
