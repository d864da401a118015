#ifndef VERDURE_APP_BENCH_COMMAND_H_
#define VERDURE_APP_BENCH_COMMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "verdure/render.h"

namespace verdure::app {

struct BenchGrassCommand {
  std::vector<std::string> sizes{"800x600", "1600x1200"};
  std::optional<int> frames;  ///< of each kind; unset: as many as fit into a quarter of a minute
  std::string species = "lawn";
  DeviceOptions device;
  bool json = false;
};
/// Table 2.1 of Habel 2009 for this machine: traced grass against its slices as polygons. Throws
/// Error.
void runBenchGrass(const BenchGrassCommand& command);

}  // namespace verdure::app

#endif  // VERDURE_APP_BENCH_COMMAND_H_
