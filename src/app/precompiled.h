// What most commands include and what is costly to compile.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "gpu/vulkan.h"
