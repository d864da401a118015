#ifndef VERDURE_SCENE_PLACE_LIMIT_H_
#define VERDURE_SCENE_PLACE_LIMIT_H_

#include <string>

namespace verdure {

/// Throws Error, naming `where`, if so many places of plants are more than scenes may have or than
/// half of this machine's memory holds; nothing needs to be allocated before.
void checkPlaceCount(double count, const std::string& where);

}  // namespace verdure

#endif  // VERDURE_SCENE_PLACE_LIMIT_H_
