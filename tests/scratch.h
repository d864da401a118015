#ifndef VERDURE_TESTS_SCRATCH_H_
#define VERDURE_TESTS_SCRATCH_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace verdure {

/// An empty folder of this process: tests run side by side. It goes when the process ends.
inline std::filesystem::path scratchFolder(const std::string& name) {
  struct Root {
    std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("verdure_tests." + std::to_string(::getpid()));
    ~Root() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Root root;
  const std::filesystem::path folder = root.path / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace verdure

#endif  // VERDURE_TESTS_SCRATCH_H_
