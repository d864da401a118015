#ifndef VERDURE_APP_JSON_TEXT_H_
#define VERDURE_APP_JSON_TEXT_H_

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

/// JSON as people write and read it: lines of keys, and few of them.
namespace verdure::app {

/// Throws Error that names `where` and the line for what is no JSON and for a key that an object
/// has twice.
nlohmann::ordered_json parseJson(std::string_view text, const std::string& where);

/// The line of a key in a text that parseJson() took, from 1. `path` as "plants[2].file"; of one
/// that is not there, the line of the innermost object or list around it.
int lineOfKey(std::string_view text, const std::string& path);

/// Indented by two, with what is short in one line.
std::string prettyJson(const nlohmann::ordered_json& json);

}  // namespace verdure::app

#endif  // VERDURE_APP_JSON_TEXT_H_
