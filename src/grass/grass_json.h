#ifndef VERDURE_GRASS_GRASS_JSON_H_
#define VERDURE_GRASS_GRASS_JSON_H_

#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "verdure/grass.h"

namespace verdure {

/// An object of grass.json. Throws Error that names the member for one of a wrong type, and for
/// members that are not `known`, which are mistyped more often than not.
class GrassMembers {
 public:
  using Json = nlohmann::ordered_json;
  GrassMembers(const Json& json, std::string where, std::initializer_list<std::string_view> known);

  const std::string& where() const { return where_; }
  bool has(const char* key) const { return json_.contains(key); }
  /// The member, which must be there.
  const Json& at(const char* key) const;
  /// Each of these leaves `value` as it is where the member is missing.
  void number(const char* key, float& value) const;
  void number(const char* key, int& value) const;
  void flag(const char* key, bool& value) const;
  void text(const char* key, std::string& value) const;
  void color(const char* key, glm::vec3& value) const;
  /// An array, empty where the member is missing.
  const Json& array(const char* key) const;

 private:
  const Json& json_;
  std::string where_;
};

nlohmann::ordered_json speciesToJson(const GrassSpecies& species);
/// Throws Error for members that are wrong, and as checkGrassSpecies() does.
GrassSpecies speciesFromJson(const nlohmann::ordered_json& json, const std::string& where);

/// A float's shortest digits as a double.
double shortestNumber(float value);

}  // namespace verdure

#endif  // VERDURE_GRASS_GRASS_JSON_H_
