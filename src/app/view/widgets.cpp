#include "app/view/widgets.h"

#include <algorithm>

namespace verdure::app {
namespace {

ImGuiSliderFlags flagsOf(bool logarithmic) {
  return ImGuiSliderFlags_AlwaysClamp |
         (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
}

/// In this dialog: a key that opens it is no answer.
bool pressedNow(ImGuiKey key) {
  return !ImGui::IsWindowAppearing() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
}

}  // namespace

bool slider(const char* label, float& value, float least, float most, const char* format,
            bool logarithmic) {
  return ImGui::SliderFloat(label, &value, least, most, format, flagsOf(logarithmic));
}

bool slider(const char* label, double& value, float least, float most, const char* format,
            bool logarithmic) {
  auto shown = static_cast<float>(value);
  if (!slider(label, shown, least, most, format, logarithmic)) return false;
  value = double{shown};
  return true;
}

bool slider(const char* label, int& value, int least, int most) {
  return ImGui::SliderInt(label, &value, least, most, "%d", ImGuiSliderFlags_AlwaysClamp);
}

bool optionalSlider(const char* label, std::optional<float>& value, float automatic, float least,
                    float most, const char* format, bool logarithmic) {
  ImGui::PushID(label);
  bool set = value.has_value();
  bool changed = ImGui::Checkbox("##set", &set);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Unset: found by itself");
  if (changed) value = set ? std::optional(std::clamp(automatic, least, most)) : std::nullopt;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetFrameHeightWithSpacing());
  float shown = value.value_or(automatic);
  const float alpha = value ? 1.0f : 0.5f;
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, alpha * ImGui::GetStyle().Alpha);
  if (slider("##value", shown, least, most, format, logarithmic)) {
    value = shown;
    changed = true;
  }
  ImGui::PopStyleVar();
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::TextUnformatted(label);
  ImGui::PopID();
  return changed;
}

bool choice(const char* label, int& index, std::span<const char* const> names) {
  return ImGui::Combo(label, &index, names.data(), static_cast<int>(names.size()));
}

bool choice(const char* label, std::string& value, const std::vector<std::string>& values) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, value.c_str())) return false;
  for (const std::string& each : values)
    if (ImGui::Selectable(each.c_str(), each == value)) {
      changed = each != value;
      value = each;
    }
  ImGui::EndCombo();
  return changed;
}

bool dialogButton(const char* label) {
  return ImGui::Button(label, {90.0f, 0.0f});
}

bool acceptButton(const char* label) {
  return dialogButton(label) || pressedNow(ImGuiKey_Enter) || pressedNow(ImGuiKey_KeyPadEnter);
}

bool cancelButton() {
  return dialogButton("Cancel") || pressedNow(ImGuiKey_Escape);
}

void explain(const char* text) {
  ImGui::SameLine();
  ImGui::TextDisabled("(?)");
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24.0f);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace verdure::app
