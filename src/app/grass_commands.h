#ifndef VERDURE_APP_GRASS_COMMANDS_H_
#define VERDURE_APP_GRASS_COMMANDS_H_

#include <string>

#include "verdure/grass.h"

namespace verdure::app {

struct GrassGrowCommand {
  std::string species = "meadow";
  std::string output;
  GrassGrowOptions grow;
  bool list = false;
  bool json = false;
};
/// Grows a data set into a folder, or lists the species. Throws Error.
void runGrassGrow(const GrassGrowCommand& command);

}  // namespace verdure::app

#endif  // VERDURE_APP_GRASS_COMMANDS_H_
