#include "app/view/file_dialog.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <system_error>

#include "app/view/widgets.h"

namespace verdure::app {

std::vector<std::pair<std::string, bool>> folderEntries(
    const std::filesystem::path& folder, const std::vector<std::string>& extensions) {
  std::vector<std::pair<std::string, bool>> entries;
  std::error_code problem;
  for (std::filesystem::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    const std::string name = at->path().filename().string();
    if (name.empty() || name[0] == '.') continue;
    std::error_code unknown;
    const bool is_folder = at->is_directory(unknown);
    if (is_folder || std::find(extensions.begin(), extensions.end(),
                               at->path().extension().string()) != extensions.end())
      entries.emplace_back(name, is_folder);
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second : a.first < b.first;
  });
  return entries;
}

void FileDialog::open(std::string title, const std::filesystem::path& start,
                      std::vector<std::string> extensions, bool save,
                      std::function<void(const std::filesystem::path&)> chosen) {
  title_ = std::move(title);
  path_ = start.string();
  extensions_ = std::move(extensions);
  save_ = save;
  chosen_ = std::move(chosen);
  problem_.clear();
  opening_ = true;
  listed_.clear();
}

void FileDialog::list(const std::filesystem::path& folder) {
  listed_ = folder;
  entries_.clear();
  for (auto& [name, is_folder] : folderEntries(folder, extensions_))
    entries_.push_back({name, is_folder});
}

void FileDialog::draw() {
  if (opening_) ImGui::OpenPopup(title_.c_str());
  if (title_.empty() || !ImGui::IsPopupOpen(title_.c_str())) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowSize({std::min(560.0f, size.x), std::min(440.0f, size.y)}, ImGuiCond_Always);
  if (!ImGui::BeginPopupModal(title_.c_str(), nullptr, ImGuiWindowFlags_NoResize)) return;
  const std::filesystem::path path(path_);
  std::error_code unknown;
  const bool is_folder = path_.empty() || std::filesystem::is_directory(path, unknown);
  std::filesystem::path folder = is_folder ? path : path.parent_path();
  if (folder.empty()) folder = ".";
  if (listed_ != folder) list(folder);
  ImGui::SetNextItemWidth(-1.0f);
  if (opening_) ImGui::SetKeyboardFocusHere();
  opening_ = false;
  ImGui::InputText("##path", &path_);
  bool done = false;
  ImGui::BeginChild("##files", {0.0f, -2.2f * ImGui::GetFrameHeightWithSpacing()}, true);
  if (ImGui::Selectable("../")) path_ = (listed_ / "..").lexically_normal().string();
  for (const Entry& entry : entries_) {
    const std::string label = entry.name + (entry.folder ? "/" : "");
    if (!ImGui::Selectable(label.c_str(), false, ImGuiSelectableFlags_AllowDoubleClick)) continue;
    path_ = (listed_ / entry.name).lexically_normal().string();
    done = done || (!entry.folder && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
  }
  ImGui::EndChild();
  if (!problem_.empty())
    ImGui::TextColored({1.0f, 0.5f, 0.4f, 1.0f}, "%s", problem_.c_str());
  else
    ImGui::TextDisabled("%s", save_ ? "A file in the place is replaced." : " ");
  done = acceptButton(save_ ? "Save" : "Open") || done;
  ImGui::SameLine();
  if (cancelButton()) ImGui::CloseCurrentPopup();
  if (done) {
    const std::filesystem::path wanted(path_);
    if (std::filesystem::is_directory(wanted, unknown)) {
      list(wanted);
    } else if (!save_ && !std::filesystem::exists(wanted, unknown)) {
      problem_ = "There is no such file.";
    } else {
      ImGui::CloseCurrentPopup();
      chosen_(wanted);
    }
  }
  ImGui::EndPopup();
}

}  // namespace verdure::app
