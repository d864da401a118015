#ifndef VERDURE_APP_SCENE_ARCHIVE_H_
#define VERDURE_APP_SCENE_ARCHIVE_H_

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "app/scene_settings.h"

/// The two sides of a scene file's fields. Both have the same functions, each for one key of the
/// object at hand: one fills the value, and leaves it where the key is missing, the other writes
/// it. What is optional and unset is left out.
namespace verdure::app {

class SceneReader {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr bool kReads = true;

  /// Throws Error for what is no JSON object. `text` must outlive this.
  SceneReader(std::string_view text, const std::filesystem::path& path);
  /// Throws Error unless the file says that it is a scene, of `newest` version or an older one.
  void checkVersion(int newest);
  /// Throws Error for keys of the whole object that nothing asked for.
  void finish() { checkKeys(); }

  /// Throws Error in one line: file, line, key, what, what to do. "": the object at hand.
  [[noreturn]] void refuse(const char* key, const std::string& what,
                           const std::string& advice) const;

  bool has(const char* key) { return find(key) != nullptr; }

  template <class T>
  void number(const char* key, T& value, double low, double high) {
    if (const Json* json = find(key)) value = numberIn<T>(key, *json, low, high);
  }
  template <class T>
  void number(const char* key, std::optional<T>& value, double low, double high) {
    if (has(key)) number(key, value.emplace(), low, high);
  }
  /// A number or a word, as a text.
  void numberOrWord(const char* key, std::string& value, const char* word);
  void text(const char* key, std::string& value);
  void flag(const char* key, bool& value);
  void flag(const char* key, std::optional<bool>& value) {
    if (has(key)) flag(key, value.emplace());
  }
  void texts(const char* key, std::vector<std::string>& value);
  void texts(const char* key, std::optional<std::vector<std::string>>& value) {
    if (has(key)) texts(key, value.emplace());
  }
  /// A text that is a path unless `is_name`.
  void path(const char* key, std::string& value,
            const std::function<bool(const std::string&)>& is_name = {});
  void assignments(const char* key, std::vector<std::pair<std::string, std::string>>& value);

  template <glm::length_t N, class T>
  void vector(const char* key, glm::vec<N, T>& value, double low, double high) {
    const Json* json = find(key);
    if (json == nullptr) return;
    if (!json->is_array() || json->size() != N)
      refuse(key, fmt::format("is no list of {} numbers", N), "");
    for (glm::length_t i = 0; i < N; ++i)
      value[i] = numberIn<T>(key, (*json)[static_cast<std::size_t>(i)], low, high);
  }
  template <glm::length_t N, class T>
  void vector(const char* key, std::optional<glm::vec<N, T>>& value, double low, double high) {
    if (has(key)) vector(key, value.emplace(), low, high);
  }
  /// An enumeration, or false and true, whose values are named in their order.
  template <class T>
  void choice(const char* key, T& value, std::initializer_list<const char*> names) {
    if (has(key)) value = static_cast<T>(choiceAmong(key, names));
  }
  template <class T>
  void choice(const char* key, std::optional<T>& value, std::initializer_list<const char*> names) {
    if (has(key)) choice(key, value.emplace(), names);
  }
  void angle(const char* key, float& radians);      ///< degrees in the file
  void color(const char* key, std::uint32_t& rgb);  ///< "#rrggbb"
  void setPlants(const std::vector<PlantSettings>& plants);
  void plant(const char* key, std::uint32_t& index);  ///< the name of one of them
  void plants(const char* key, std::vector<std::uint32_t>& indices);

  template <class Fields>
  void object(const char* key, const Fields& fields) {
    if (const Json* json = find(key)) within(*json, pathOf(key), fields);
  }
  template <class T, class Fields>
  void optionalObject(const char* key, std::optional<T>& value, const Fields& fields) {
    if (const Json* json = find(key)) within(*json, pathOf(key), [&] { fields(value.emplace()); });
  }
  template <class T, class Fields>
  void list(const char* key, std::vector<T>& values, const Fields& fields) {
    const Json* json = find(key);
    if (json == nullptr) return;
    if (!json->is_array()) refuse(key, "is no list", "");
    const std::string base = pathOf(key);
    values.resize(json->size());
    for (std::size_t i = 0; i < values.size(); ++i)
      within((*json)[i], fmt::format("{}[{}]", base, i), [&] { fields(values[i]); });
  }

 private:
  const Json* find(const char* key);
  std::string pathOf(const char* key) const;
  void checkKeys() const;
  std::size_t choiceAmong(const char* key, std::initializer_list<const char*> names);

  /// `json` becomes the object at hand for `fields`.
  template <class Fields>
  void within(const Json& json, const std::string& path, const Fields& fields) {
    Frame outer{&json, path, {}};
    std::swap(frame_, outer);
    if (!json.is_object()) refuse("", "is no object", "");
    fields();
    checkKeys();
    std::swap(frame_, outer);
  }

  static std::string rangeText(double low, double high);
  template <class T>
  T numberIn(const char* key, const Json& json, double low, double high) const {
    if constexpr (std::is_integral_v<T>) {
      if (!json.is_number_integer()) refuse(key, "is no whole number", rangeText(low, high));
      low = std::max(low, static_cast<double>(std::numeric_limits<T>::min()));
      high = std::min(high, static_cast<double>(std::numeric_limits<T>::max()));
      if (std::is_unsigned_v<T> && !json.is_number_unsigned())
        refuse(key, fmt::format("is {}", json.dump()), rangeText(low, high));
    } else {
      if (!json.is_number()) refuse(key, "is no number", rangeText(low, high));
      low = std::max(low, static_cast<double>(std::numeric_limits<T>::lowest()));
      high = std::min(high, static_cast<double>(std::numeric_limits<T>::max()));
    }
    const double number = json.get<double>();
    if (!(number >= low && number <= high))
      refuse(key, fmt::format("is {}", json.dump()), rangeText(low, high));
    return json.get<T>();
  }

  /// The object at hand.
  struct Frame {
    const Json* json = nullptr;
    std::string path;  ///< "plants[2]"
    std::vector<const char*> known;
  };

  std::string_view text_;
  std::string where_;
  std::filesystem::path folder_;
  Json json_;
  Frame frame_;
  std::vector<std::string> plant_names_;
  std::unordered_map<std::string, std::uint32_t> plant_of_name_;
};

class SceneWriter {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr bool kReads = false;

  SceneWriter(const std::filesystem::path& path, int version);
  /// Throws Error for names that are no UTF-8.
  std::string text() const;
  bool has(const char* key) const { return json_.contains(key); }

  template <class T>
  void number(const char* key, const T& value, double, double) {
    json_[key] = shortest(value);
  }
  template <class T>
  void number(const char* key, const std::optional<T>& value, double low, double high) {
    if (value) number(key, *value, low, high);
  }
  void numberOrWord(const char* key, const std::string& value, const char* word);
  void text(const char* key, const std::string& value) {
    if (!value.empty()) json_[key] = value;
  }
  void flag(const char* key, bool value) { json_[key] = value; }
  void flag(const char* key, const std::optional<bool>& value) {
    if (value) json_[key] = *value;
  }
  void texts(const char* key, const std::vector<std::string>& value) {
    if (!value.empty()) json_[key] = value;
  }
  void texts(const char* key, const std::optional<std::vector<std::string>>& value) {
    if (value) json_[key] = *value;
  }
  void path(const char* key, const std::string& value,
            const std::function<bool(const std::string&)>& is_name = {});
  void assignments(const char* key, const std::vector<std::pair<std::string, std::string>>& value);

  template <glm::length_t N, class T>
  void vector(const char* key, const glm::vec<N, T>& value, double, double) {
    Json list = Json::array();
    for (glm::length_t i = 0; i < N; ++i) list.push_back(shortest(value[i]));
    json_[key] = std::move(list);
  }
  template <glm::length_t N, class T>
  void vector(const char* key, const std::optional<glm::vec<N, T>>& value, double low,
              double high) {
    if (value) vector(key, *value, low, high);
  }
  template <class T>
  void choice(const char* key, const T& value, std::initializer_list<const char*> names) {
    json_[key] = names.begin()[static_cast<std::size_t>(value)];
  }
  template <class T>
  void choice(const char* key, const std::optional<T>& value,
              std::initializer_list<const char*> names) {
    if (value) choice(key, *value, names);
  }
  void angle(const char* key, float radians);
  void color(const char* key, std::uint32_t rgb);
  void setPlants(const std::vector<PlantSettings>& plants);
  void plant(const char* key, std::uint32_t index) { json_[key] = plant_names_.at(index); }
  void plants(const char* key, const std::vector<std::uint32_t>& indices);

  template <class Fields>
  void object(const char* key, const Fields& fields) {
    Json outer = std::move(json_);
    json_ = Json::object();
    fields();
    outer[key] = std::move(json_);
    json_ = std::move(outer);
  }
  template <class T, class Fields>
  void optionalObject(const char* key, std::optional<T>& value, const Fields& fields) {
    if (value) object(key, [&] { fields(*value); });
  }
  template <class T, class Fields>
  void list(const char* key, std::vector<T>& values, const Fields& fields) {
    if (values.empty()) return;
    Json outer = std::move(json_), all = Json::array();
    for (T& value : values) {
      json_ = Json::object();
      fields(value);
      all.push_back(std::move(json_));
    }
    outer[key] = std::move(all);
    json_ = std::move(outer);
  }

 private:
  /// A float's few digits instead of those of its double.
  static double shortest(float value) {
    const std::string digits = fmt::format("{}", value);
    double number = 0.0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return number;
  }
  template <class T>
  static T shortest(T value) {
    return value;
  }

  std::string where_;
  std::filesystem::path folder_;
  Json json_;
  std::vector<std::string> plant_names_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_SCENE_ARCHIVE_H_
