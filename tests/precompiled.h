// What most tests include and what is costly to compile.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
