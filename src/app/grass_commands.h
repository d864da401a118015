#ifndef VERDURE_APP_GRASS_COMMANDS_H_
#define VERDURE_APP_GRASS_COMMANDS_H_

#include <string>

#include "app/commands.h"
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

/// Figures 2.9 to 2.16 of Habel 2009, with a page that shows them. Throws Error.
void runGrassFigures(const FiguresCommand& command);

}  // namespace verdure::app

#endif  // VERDURE_APP_GRASS_COMMANDS_H_
