#ifndef VERDURE_PLANT_CLASSIFY_H_
#define VERDURE_PLANT_CLASSIFY_H_

#include <optional>
#include <string>
#include <vector>

#include "verdure/plant_io.h"

namespace verdure {

/// What a file says about a part beside its geometry and material.
struct PartNames {
  std::string mesh, node;
  std::optional<PartKind> recorded;  ///< written by verdure itself
};

/// Decides for each mesh of the plant whether it is wood or foliage, by a score of evidence: names
/// in the languages of asset packs, cut-out textures, double-sidedness, flat or tubular pieces,
/// their number, green. Adds one note per part with its reasons. `options` overrule. Throws Error
/// (naming `where`) if an option matches no name of the file.
void classifyParts(Plant& plant, const std::vector<PartNames>& names, const LoadOptions& options,
                   const std::string& where);

/// Case-insensitive match of a whole name against a pattern with `*` wildcards.
bool matchesPattern(const std::string& name, const std::string& pattern);

/// Evidence of a name alone: above 0 foliage, below 0 wood. The words that count are whole words
/// ("last" holds no "Ast"), or ends and beginnings of compounds ("Eichenblatt").
double nameScore(const std::string& name);

}  // namespace verdure

#endif  // VERDURE_PLANT_CLASSIFY_H_
