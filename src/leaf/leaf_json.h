#ifndef VERDURE_LEAF_LEAF_JSON_H_
#define VERDURE_LEAF_LEAF_JSON_H_

#include <filesystem>
#include <nlohmann/json.hpp>

namespace verdure {

/// The file of a leaf's folder that describes its maps (docs/leaves.md).
inline constexpr const char* kLeafFile = "leaf.json";

/// Parses FOLDER/leaf.json and checks that it is an object of this format and version. Throws
/// Error.
nlohmann::ordered_json readLeafJson(const std::filesystem::path& folder);
/// The number that stands in JSON with as few digits as the float needs: 0.2, not 0.200000003.
double shortest(float value);
void writeLeafJson(const nlohmann::ordered_json& json, const std::filesystem::path& folder);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_JSON_H_
