#include "app/view/gui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/view/fly_camera.h"
#include "app/view/orbit_camera.h"
#include "app/view/surface_overlay.h"
#include "app/view/widgets.h"
#include "scene/scene.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

constexpr float kPanelWidth = 330.0f;
constexpr float kTurnPerHeight = 3.0f;  // radians that a drag across the window's height turns
constexpr float kZoomPerNotch = 0.88f;
const std::vector<std::string> kOpened{".json", ".glb", ".gltf", ".obj", ".fbx",
                                       ".dae",  ".ply", ".hdr",  ".exr"};

bool isPanorama(const std::filesystem::path& path) {
  return path.extension() == ".hdr" || path.extension() == ".exr";
}

bool held(const Window& window, int key) {
  return glfwGetKey(window.handle(), key) == GLFW_PRESS;
}

}  // namespace

GuiContext::GuiContext(const Window& window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is left behind in the folder it was started from
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0.0f;
  style.FrameRounding = 2.0f;
  style.WindowBorderSize = 0.0f;
  style.Colors[ImGuiCol_WindowBg].w = 1.0f;
  style.Colors[ImGuiCol_PopupBg].w = 1.0f;
  style.Colors[ImGuiCol_ModalWindowDimBg] = {0.0f, 0.0f, 0.0f, 0.35f};
  style.Colors[ImGuiCol_PlotHistogram] = style.Colors[ImGuiCol_Header];
  const float scale = window.scale();
  style.ScaleAllSizes(scale);
  ImFontConfig font;
  font.SizePixels = std::floor(13.0f * scale);
  io.Fonts->AddFontDefault(&font);
  ImGui_ImplGlfw_InitForOther(window.handle(), true);
}

GuiContext::~GuiContext() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

Gui::Gui(Window& window, Screen& screen, ViewSession& session)
    : window_(&window), screen_(&screen), session_(&session) {}

void Gui::leaveScene(std::function<void()> then) {
  asks_to_close_ = false;
  leave_ = nullptr;
  if (session_->modified())
    leave_ = std::move(then);
  else
    then();
}

void Gui::askToClose() {
  if (asks_to_close_) {  // asked twice is answered
    closes_ = true;
    return;
  }
  leaveScene([this] { closes_ = true; });
  asks_to_close_ = leave_ != nullptr;
}

void Gui::openFile(const std::filesystem::path& path) {
  if (isPanorama(path)) {
    session_->settings.daylight.sky = path.string();
    session_->changed(Change::kPicture);
  } else {
    leaveScene([this, path] { session_->open(path); });
  }
}

void Gui::openDialog() {
  files_.open("Open a plant, a scene or a panorama", std::filesystem::current_path(), kOpened,
              false, [this](const std::filesystem::path& path) { openFile(path); });
}

void Gui::saveThen(const std::filesystem::path& path, const std::function<void()>& then) {
  session_->saveScene(path);
  if (then && !session_->modified()) then();
}

void Gui::save(const std::function<void()>& then) {
  if (session_->scenePath().empty())
    saveDialog(then);
  else
    saveThen(session_->scenePath(), then);
}

void Gui::saveDialog(const std::function<void()>& then) {
  const std::filesystem::path known = session_->scenePath();
  files_.open("Save the scene", known.empty() ? std::filesystem::path("scene.json") : known,
              {".json"}, true,
              [this, then](const std::filesystem::path& path) { saveThen(path, then); });
}

void Gui::menu() {
  if (!ImGui::BeginMainMenuBar()) return;
  const bool has_plant = session_->shown() != nullptr && !session_->settings.plants.empty();
  if (ImGui::BeginMenu("File")) {
    if (ImGui::MenuItem("Open...", "Ctrl+O")) openDialog();
    if (ImGui::MenuItem("Grow...", "Ctrl+G")) asks_to_grow_ = true;
    if (ImGui::MenuItem("Save the scene", "Ctrl+S")) save();
    if (ImGui::MenuItem("Save the scene as...")) saveDialog();
    if (ImGui::MenuItem("Save the plant with its light...", nullptr, false, has_plant)) {
      const std::size_t plant = panel_state_.plant;
      files_.open(
          "Save the plant with its light", session_->settings.plants[plant].name + "-lit.glb",
          {".glb", ".gltf"}, true,
          [this, plant](const std::filesystem::path& path) { session_->savePlant(plant, path); });
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Screenshot", "F12")) session_->saveScreenshot();
    if (ImGui::MenuItem("Screenshot of the window", "Shift+F12")) capture_ = "verdure-window.png";
    if (ImGui::MenuItem("Clip...", nullptr, false, has_plant)) asks_for_clip_ = true;
    ImGui::Separator();
    if (ImGui::MenuItem("Close", "Ctrl+Q")) askToClose();
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Edit")) {
    if (ImGui::MenuItem("Undo", "Ctrl+Z", false, session_->canUndo())) session_->undo();
    if (ImGui::MenuItem("Redo", "Ctrl+Shift+Z", false, session_->canRedo())) session_->redo();
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Bake")) {
    if (ImGui::MenuItem("Bake the light", "B", false, has_plant))
      session_->changed(Change::kBake, panel_state_.plant);
    ImGui::MenuItem("Show the field's surface", nullptr, &session_->show_surface);
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("View")) {
    ImGui::MenuItem("Panels", "Tab", &panels_);
    if (ImGui::MenuItem("Show all", "Home")) session_->showAll();
    if (ImGui::MenuItem(session_->playing ? "Pause the wind" : "Let the wind blow", "Space"))
      session_->togglePlay();
    ImGui::EndMenu();
  }
  ImGui::TextDisabled("   %s", screen_->deviceName().c_str());
  ImGui::EndMainMenuBar();
}

void Gui::keys(const WindowInput& input) {
  const bool dialog =
      ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  for (const auto& [key, modifiers] : input.keys) {
    const bool control = (modifiers & GLFW_MOD_CONTROL) != 0;
    const bool shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    if (control) commands_.insert(key);
    if (key == GLFW_KEY_F12 && shift)
      capture_ = "verdure-window.png";
    else if (key == GLFW_KEY_F12)
      session_->saveScreenshot();
    else if (control && key == GLFW_KEY_Q)
      askToClose();
    else if (ImGui::GetIO().WantTextInput || dialog)
      continue;
    else if (control && key == GLFW_KEY_Z && ImGui::IsAnyItemActive())
      continue;  // a value is being dragged
    else if (control && key == GLFW_KEY_Z)
      shift ? session_->redo() : session_->undo();
    else if (control && key == GLFW_KEY_O)
      openDialog();
    else if (control && key == GLFW_KEY_G)
      asks_to_grow_ = true;
    else if (control && key == GLFW_KEY_S)
      save();
    else if (key == GLFW_KEY_TAB)
      panels_ = !panels_;
    else if (key == GLFW_KEY_HOME)
      session_->showAll();
    else if (key == GLFW_KEY_B && session_->shown() != nullptr)
      session_->changed(Change::kBake, panel_state_.plant);
    else if (key == GLFW_KEY_SPACE)
      session_->togglePlay();
  }
}

void Gui::feedKeys(const WindowInput& input) {
  bool* const down = ImGui::GetIO().KeysDown;
  for (const int key : brief_keys_) down[key] = held(*window_, key);
  brief_keys_.clear();
  for (const auto& [key, modifiers] : input.keys) {
    if (key < 0 || down[key]) continue;
    down[key] = true;
    brief_keys_.push_back(key);
  }
}

void Gui::moveCamera(double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = !io.WantCaptureMouse;
  const bool pressed = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
  if (!pressed) drags_ = false;
  for (int button = 0; button < 3; ++button)
    if (over && ImGui::IsMouseClicked(button)) drags_ = true;
  Camera camera = session_->camera();
  const float height = std::max(io.DisplaySize.y, 1.0f);
  const glm::vec2 delta = glm::vec2(io.MouseDelta.x, io.MouseDelta.y) / height;
  bool moved = false;
  if (drags_ && delta != glm::vec2(0.0f)) {
    moved = true;
    if (io.MouseDown[1])
      camera =
          lookedAround(camera, kTurnPerHeight * delta.x * 0.5f, -kTurnPerHeight * delta.y * 0.5f);
    else if (io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift))
      camera = panned(camera, delta.x, delta.y);
    else if (io.MouseDown[0])
      camera = orbited(camera, -kTurnPerHeight * delta.x, kTurnPerHeight * delta.y);
  }
  const float reach = session_->reach();
  if (over && io.MouseWheel != 0.0f) {
    moved = true;
    camera = zoomed(camera, std::pow(kZoomPerNotch, io.MouseWheel), 1e-3f * reach, 100.0f * reach);
  }
  moves_ = false;
  std::erase_if(commands_, [this](int key) { return !held(*window_, key); });
  if (!io.WantCaptureKeyboard && !io.KeyCtrl) {
    const auto flies = [this](int key) {
      return held(*window_, key) && !commands_.contains(key) ? 1.0f : 0.0f;
    };
    const auto axis = [&flies](int forth, int back) { return flies(forth) - flies(back); };
    const glm::vec3 fly(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                        axis(GLFW_KEY_W, GLFW_KEY_S));
    if (fly != glm::vec3(0.0f)) {
      // A pause is no long step.
      const float step = 0.4f * reach * static_cast<float>(std::min(seconds, 0.25));
      camera = flown(camera, step * fly.x, step * fly.y, step * fly.z);
      moved = moves_ = true;
    }
  }
  if (moved) session_->moveCamera(camera);
}

void Gui::drawPictures(const glm::vec2& at, const glm::vec2& size) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const int columns = session_->beside == Beside::kNothing ? 1 : 2;
  const float width = size.x / static_cast<float>(columns);
  for (int picture = 0; picture < columns; ++picture) {
    const float left = at.x + width * static_cast<float>(picture);
    if (void* texture = screen_->texture(picture))
      list.AddImage(texture, {left, at.y}, {left + width, at.y + size.y});
  }
  if (columns == 1) return;
  const float middle = at.x + width;
  list.AddLine({middle, at.y}, {middle, at.y + size.y}, IM_COL32(255, 255, 255, 160));
  const auto label = [&](float x, const std::string& text) {
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    list.AddRectFilled({x, at.y + 6.0f}, {x + extent.x + 12.0f, at.y + extent.y + 14.0f},
                       IM_COL32(0, 0, 0, 140));
    list.AddText({x + 6.0f, at.y + 10.0f}, IM_COL32(255, 255, 255, 255), text.c_str());
  };
  label(at.x + 6.0f, session_->settings.look.light);
  label(middle + 6.0f,
        session_->beside == Beside::kPreset
            ? session_->beside_light
            : fmt::format("path tracer, {} paths a pixel", session_->tracedSamples()));
}

void Gui::drawSurface(const glm::vec2& at, const glm::vec2& size) {
  const ShownScene* shown = session_->shown();
  if (!session_->show_surface || shown == nullptr) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float width = session_->beside == Beside::kNothing ? size.x : 0.5f * size.x;
  list.PushClipRect({at.x, at.y}, {at.x + width, at.y + size.y}, true);
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const Scene& scene = shown->scene();
  for (std::size_t p = 0; p < shown->loaded().plants().size(); ++p) {
    const PlantBake* bake = shown->bake(p);
    if (bake == nullptr) continue;
    for (const SceneItem& item : scene.items) {
      if (item.plant != &shown->loaded().plants()[p].plant || item.world_from_plant.empty())
        continue;
      const glm::mat4 world = worldFromPlant(scene, item, item.world_from_plant.front());
      for (const OverlayTriangle& t :
           overlayTriangles(bake->surface, world, session_->camera(), width / size.y)) {
        list.PrimReserve(3, 3);
        for (std::size_t c = 0; c < 3; ++c) {
          const float rim = 1.0f - t.facing[c];
          const auto alpha = static_cast<int>(40.0f + 170.0f * rim * rim);
          list.PrimVtx({at.x + t.corners[c].x * width, at.y + t.corners[c].y * size.y}, white,
                       IM_COL32(120, 190, 255, alpha));
        }
      }
    }
  }
  list.PopClipRect();
}

void Gui::statusBar(float height) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.0f, size.y - height});
  ImGui::SetNextWindowSize({size.x, height});
  ImGui::Begin("##status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  const auto status = session_->status();
  if (status) {
    const std::string text =
        status->step.empty() ? status->title : status->title + ": " + status->step;
    const float share = status->share >= 0.0
                            ? static_cast<float>(status->share)
                            : std::fmod(static_cast<float>(ImGui::GetTime()), 1.0f);
    ImGui::ProgressBar(share, {0.35f * size.x, 0.0f}, text.c_str());
    ImGui::SameLine();
    if (session_->clipRuns() && ImGui::SmallButton("Stop")) session_->stopClip();
    ImGui::SameLine();
  }
  if (!session_->message.empty()) {
    if (ImGui::SmallButton("x")) session_->message.clear();
    ImGui::SameLine();
    ImGui::TextUnformatted(session_->message.c_str());
  } else if (!status) {
    ImGui::TextDisabled("Drag: orbit. Wheel: nearer. Right drag, W A S D: fly. Tab: panels.");
  }
  ImGui::End();
}

void Gui::growDialog() {
  if (std::exchange(asks_to_grow_, false)) ImGui::OpenPopup("Grow a plant");
  if (!ImGui::BeginPopupModal("Grow a plant", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  std::vector<std::string> species;
  for (const SpeciesInfo& info : speciesList()) species.push_back(info.name);
  choice("species", grow_.species, species);
  int seed = static_cast<int>(grow_.seed);
  if (ImGui::InputInt("seed", &seed)) grow_.seed = static_cast<std::uint32_t>(std::max(seed, 0));
  slider("leaf age", grow_.leaf_age, 0.0f, 1.0f, "%.2f");
  int form = grow_.leaf_form == LeafForm::kMesh ? 0 : 1;
  constexpr std::array kForms{"folded blades", "one quad a leaf"};
  if (choice("leaves", form, kForms))
    grow_.leaf_form = form == 0 ? LeafForm::kMesh : LeafForm::kCard;
  if (acceptButton("Grow")) {
    leaveScene([this, options = grow_] { session_->grow(options); });
    ImGui::CloseCurrentPopup();
  }
  ImGui::SameLine();
  if (cancelButton()) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void Gui::clipDialog() {
  if (std::exchange(asks_for_clip_, false)) ImGui::OpenPopup("Save a clip");
  if (!ImGui::BeginPopupModal("Save a clip", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::InputText("file", &clip_path_);
  ImGui::InputInt("frames", &clip_frames_);
  ImGui::InputInt("frames a second", &clip_fps_);
  clip_frames_ = std::clamp(clip_frames_, 1, 100000);
  clip_fps_ = std::clamp(clip_fps_, 1, 240);
  ImGui::TextDisabled(".mp4, .webm or .gif by ffmpeg; .png: numbered pictures");
  if (acceptButton("Save")) {
    session_->startClip(clip_path_, clip_frames_, clip_fps_);
    ImGui::CloseCurrentPopup();
  }
  ImGui::SameLine();
  if (cancelButton()) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void Gui::saveQuestion() {
  constexpr const char* kTitle = "Save the changes?";
  if (leave_) ImGui::OpenPopup(kTitle);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(kTitle, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::TextUnformatted("The scene has changes that are in no file.");
  ImGui::Spacing();
  const bool saves = acceptButton("Save");
  ImGui::SameLine();
  const bool discards = dialogButton("Discard");
  ImGui::SameLine();
  const bool cancels = cancelButton();
  if (saves || discards || cancels) {
    ImGui::CloseCurrentPopup();
    asks_to_close_ = false;
    const std::function<void()> then = std::exchange(leave_, nullptr);
    if (saves)
      save(then);
    else if (discards)
      then();
  }
  ImGui::EndPopup();
}

void Gui::updateTitle() {
  const auto status = session_->status();
  const std::string title =
      fmt::format("{}{} - verdure{}", session_->name(), session_->modified() ? " *" : "",
                  status ? " (" + status->title + ")" : "");
  if (title == title_) return;
  title_ = title;
  window_->setTitle(title);
}

void Gui::frame(const WindowInput& input, double seconds) {
  session_->poll();
  session_->advance(seconds);
  updateTitle();
  const glm::ivec2 pixels = window_->size();
  feedKeys(input);
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  keys(input);
  for (const std::filesystem::path& path : input.dropped) openFile(path);
  menu();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float top = ImGui::GetFrameHeight();
  const float bottom = ImGui::GetFrameHeightWithSpacing() + 8.0f;
  const float left = panels_ ? std::min(kPanelWidth * window_->scale(), 0.6f * display.x) : 0.0f;
  if (panels_) {
    ImGui::SetNextWindowPos({0.0f, top});
    ImGui::SetNextWindowSize({left, std::max(display.y - top - bottom, 1.0f)});
    ImGui::Begin("##panels", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    drawPanels(*session_, panel_state_);
    ImGui::End();
  }
  statusBar(bottom);
  files_.draw();
  growDialog();
  clipDialog();
  saveQuestion();
  if (!ImGui::IsAnyItemActive()) session_->settle();
  moveCamera(seconds);
  const glm::vec2 at(left, top), size(display.x - left, display.y - top - bottom);
  if (pixels.x > 0 && pixels.y > 0 && size.x >= 1.0f && size.y >= 1.0f) {
    session_->draw(glm::ivec2(size), ImGui::IsAnyItemActive());
    drawPictures(at, size);
    drawSurface(at, size);
  }
  ImGui::Render();
  if (pixels.x <= 0 || pixels.y <= 0) return;
  Image shown;
  if (!screen_->present(*ImGui::GetDrawData(), capture_.empty() ? nullptr : &shown)) return;
  if (capture_.empty()) return;
  try {
    if (shown.empty()) throw Error(capture_.string(), "the driver cannot read the window");
    writePng(shown, capture_);
    session_->message = "saved " + capture_.string();
  } catch (const std::exception& e) {
    session_->message = e.what();
  }
  capture_.clear();
}

}  // namespace verdure::app
