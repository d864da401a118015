#ifndef VERDURE_APP_VIEW_WIDGETS_H_
#define VERDURE_APP_VIEW_WIDGETS_H_

#include <imgui.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/view/changes.h"

/// Small helpers over Dear ImGui for the panels; those of a value return whether it is another.
namespace verdure::app {

inline Change picture(bool changed) {
  return changed ? Change::kPicture : Change::kNothing;
}

/// Loading takes long: once the value is let go.
inline Change sceneWhenLetGo() {
  return ImGui::IsItemDeactivatedAfterEdit() ? Change::kScene : Change::kNothing;
}

bool slider(const char* label, float& value, float least, float most, const char* format = "%.3g",
            bool logarithmic = false);
bool slider(const char* label, double& value, float least, float most, const char* format = "%.3g",
            bool logarithmic = false);
bool slider(const char* label, int& value, int least, int most);

/// A value that may be left to the program: a box to set it, and a slider. `automatic`: where it
/// starts.
bool optionalSlider(const char* label, std::optional<float>& value, float automatic, float least,
                    float most, const char* format = "%.3g", bool logarithmic = false);

/// One of some names.
bool choice(const char* label, int& index, std::span<const char* const> names);
bool choice(const char* label, std::string& value, const std::vector<std::string>& values);

/// At the foot of a dialog.
bool dialogButton(const char* label);
/// The one that Enter presses, too.
bool acceptButton(const char* label);
/// The one that Escape presses, too.
bool cancelButton();

/// A small "(?)" that explains.
void explain(const char* text);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_WIDGETS_H_
