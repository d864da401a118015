#include "app/scene_archive.h"

#include <algorithm>

#include "app/json_text.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "verdure-scene";

float radiansOf(double degrees) {
  return static_cast<float>(glm::radians(degrees));
}

}  // namespace

SceneReader::SceneReader(std::string_view text, const fs::path& path)
    : text_(text),
      where_(path.string()),
      folder_(path.parent_path()),
      json_(parseJson(text, path.string())) {
  if (!json_.is_object()) throw Error(where_, "is no scene: no JSON object", "see docs/scene.md");
  frame_.json = &json_;
}

void SceneReader::checkVersion(int newest) {
  const Json* const format = find("format");
  if (format == nullptr || *format != kFormat)
    throw Error(where_, fmt::format("is no scene: its \"format\" is not \"{}\"", kFormat),
                "see docs/scene.md");
  const Json* const version = find("version");
  if (version == nullptr || !version->is_number_integer() || version->get<double>() < 1.0)
    refuse("version", "is no version", fmt::format("write {}", newest));
  if (version->get<double>() > newest)
    refuse("version",
           fmt::format("is {}, and this program knows scenes up to {}", version->dump(), newest),
           "use a newer verdure");
}

void SceneReader::refuse(const char* key, const std::string& what,
                         const std::string& advice) const {
  const std::string path = pathOf(key);
  throw Error(fmt::format("{}:{}", where_, lineOfKey(text_, path)),
              path.empty() ? what : fmt::format("key '{}' {}", path, what), advice);
}

const SceneReader::Json* SceneReader::find(const char* key) {
  if (std::find(frame_.known.begin(), frame_.known.end(), std::string_view(key)) ==
      frame_.known.end())
    frame_.known.push_back(key);
  const auto found = frame_.json->find(key);
  return found == frame_.json->end() ? nullptr : &*found;
}

std::string SceneReader::pathOf(const char* key) const {
  if (frame_.path.empty() || *key == '\0') return frame_.path + key;
  return frame_.path + "." + key;
}

void SceneReader::checkKeys() const {
  for (const auto& [key, value] : frame_.json->items())
    if (std::find(frame_.known.begin(), frame_.known.end(), std::string_view(key)) ==
        frame_.known.end())
      refuse(key.c_str(), "is unknown", fmt::format("use {}", fmt::join(frame_.known, ", ")));
}

std::string SceneReader::rangeText(double low, double high) {
  constexpr double kHuge = 1e9, kTiny = 1e-5;
  const std::string least = low > 0.0 && low < kTiny ? "above 0" : fmt::format("{:g}", low);
  if (low < -kHuge && high > kHuge) return "";
  if (low < -kHuge) return fmt::format("choose {:g} or less", high);
  if (high > kHuge)
    return low > 0.0 && low < kTiny ? "choose a number above 0"
                                    : fmt::format("choose {} or more", least);
  return fmt::format("choose {} to {:g}", least, high);
}

void SceneReader::numberOrWord(const char* key, std::string& value, const char* word) {
  const Json* const json = find(key);
  if (json == nullptr) return;
  if (*json == word)
    value = word;
  else if (json->is_number())
    value = json->dump();
  else
    refuse(key, "is no number", fmt::format("write one, or \"{}\"", word));
}

void SceneReader::text(const char* key, std::string& value) {
  const Json* const json = find(key);
  if (json == nullptr) return;
  if (!json->is_string()) refuse(key, "is no text", "put it in quotes");
  value = json->get<std::string>();
}

void SceneReader::flag(const char* key, bool& value) {
  const Json* const json = find(key);
  if (json == nullptr) return;
  if (!json->is_boolean()) refuse(key, "is neither true nor false", "");
  value = json->get<bool>();
}

void SceneReader::texts(const char* key, std::vector<std::string>& value) {
  const Json* const json = find(key);
  if (json == nullptr) return;
  if (!json->is_array() ||
      !std::all_of(json->begin(), json->end(), [](const Json& t) { return t.is_string(); }))
    refuse(key, "is no list of texts", "");
  value = json->get<std::vector<std::string>>();
}

void SceneReader::path(const char* key, std::string& value,
                       const std::function<bool(const std::string&)>& is_name) {
  if (!has(key)) return;
  text(key, value);
  if (value.empty() || (is_name && is_name(value)) || fs::path(value).is_absolute()) return;
  value = (folder_ / value).lexically_normal().string();
}

void SceneReader::assignments(const char* key,
                              std::vector<std::pair<std::string, std::string>>& value) {
  const Json* const json = find(key);
  if (json == nullptr) return;
  if (!json->is_object()) refuse(key, "is no object", "write {\"Levels\": 2}");
  value.clear();
  for (const auto& [name, setting] : json->items()) {
    if (!setting.is_string() && !setting.is_number())
      refuse(key, fmt::format("sets {} to what is no number", name), "");
    value.emplace_back(name, setting.is_string() ? setting.get<std::string>() : setting.dump());
  }
}

std::size_t SceneReader::choiceAmong(const char* key, std::initializer_list<const char*> names) {
  std::string name;
  text(key, name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    refuse(key, fmt::format("is '{}'", name), fmt::format("choose {}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

void SceneReader::angle(const char* key, float& radians) {
  double degrees = 0.0;
  number(key, degrees, -1e9, 1e9);
  if (has(key)) radians = radiansOf(degrees);
}

void SceneReader::color(const char* key, std::uint32_t& rgb) {
  if (!has(key)) return;
  std::string name;
  text(key, name);
  const char *const begin = name.data() + 1, *const end = name.data() + name.size();
  const bool shaped = name.size() == 7 && name[0] == '#';
  if (!shaped || std::from_chars(begin, end, rgb, 16).ptr != end)
    refuse(key, fmt::format("is '{}'", name), "write a colour as \"#rrggbb\"");
}

void SceneReader::setPlants(const std::vector<PlantSettings>& plants) {
  for (const PlantSettings& plant : plants) {
    plant_of_name_[plant.name] = static_cast<std::uint32_t>(plant_names_.size());
    plant_names_.push_back(plant.name);
  }
}

void SceneReader::plant(const char* key, std::uint32_t& index) {
  if (plant_names_.empty()) refuse(key, "names a plant, and the scene has none", "add \"plants\"");
  if (!has(key)) return;
  std::string name;
  text(key, name);
  const auto found = plant_of_name_.find(name);
  if (found == plant_of_name_.end())
    refuse(key, fmt::format("names '{}'", name),
           fmt::format("the plants are {}", fmt::join(plant_names_, ", ")));
  index = found->second;
}

void SceneReader::plants(const char* key, std::vector<std::uint32_t>& indices) {
  std::vector<std::string> names;
  texts(key, names);
  for (const std::string& name : names) {
    const auto found = plant_of_name_.find(name);
    if (found == plant_of_name_.end())
      refuse(key, fmt::format("names '{}'", name),
             fmt::format("the plants are {}", fmt::join(plant_names_, ", ")));
    indices.push_back(found->second);
  }
}

SceneWriter::SceneWriter(const fs::path& path, int version)
    : where_(path.string()),
      folder_(fs::absolute(path).lexically_normal().parent_path()),
      json_{{"format", kFormat}, {"version", version}} {}

std::string SceneWriter::text() const {
  try {
    return prettyJson(json_);
  } catch (const Json::exception&) {
    throw Error(where_, "cannot hold names that are no UTF-8", "rename the files");
  }
}

void SceneWriter::numberOrWord(const char* key, const std::string& value, const char* word) {
  if (value == word)
    json_[key] = word;
  else
    json_[key] = Json::parse(value, nullptr, false);  // what the command line took as a number
  if (json_[key].is_discarded()) json_[key] = value;
}

void SceneWriter::path(const char* key, const std::string& value,
                       const std::function<bool(const std::string&)>& is_name) {
  if (value.empty()) return;
  if (is_name && is_name(value)) {
    json_[key] = value;
    return;
  }
  const fs::path whole = fs::absolute(value).lexically_normal();
  const fs::path relative = whole.lexically_relative(folder_);
  json_[key] = (relative.empty() ? whole : relative).generic_string();
}

void SceneWriter::assignments(const char* key,
                              const std::vector<std::pair<std::string, std::string>>& value) {
  if (value.empty()) return;
  Json set = Json::object();
  for (const auto& [name, setting] : value) set[name] = setting;
  json_[key] = std::move(set);
}

void SceneWriter::angle(const char* key, float radians) {
  // The fewest digits that come back as the same angle.
  double degrees = glm::degrees(double{radians});
  for (int digits = 6; digits < 17; ++digits) {
    const double rounded = std::stod(fmt::format("{:.{}g}", degrees, digits));
    if (radiansOf(rounded) == radians) {
      degrees = rounded;
      break;
    }
  }
  json_[key] = degrees;
}

void SceneWriter::color(const char* key, std::uint32_t rgb) {
  json_[key] = fmt::format("#{:06x}", rgb & 0xffffffu);
}

void SceneWriter::setPlants(const std::vector<PlantSettings>& plants) {
  for (const PlantSettings& plant : plants) plant_names_.push_back(plant.name);
}

void SceneWriter::plants(const char* key, const std::vector<std::uint32_t>& indices) {
  Json names = Json::array();
  for (const std::uint32_t index : indices) names.push_back(plant_names_.at(index));
  json_[key] = std::move(names);
}

}  // namespace verdure::app
