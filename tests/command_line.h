#ifndef VERDURE_TESTS_COMMAND_LINE_H_
#define VERDURE_TESTS_COMMAND_LINE_H_

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/files.h"
#include "gltf_builder.h"

/// Runs the built program as a shell would.
namespace verdure::test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

inline std::string textOf(const fs::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

inline Json jsonOf(const fs::path& path) {
  return Json::parse(textOf(path));
}

/// Starts `verdure ARGUMENTS` with its output going to two files. `environment` is put before the
/// inherited one.
inline pid_t start(const Words& arguments, const fs::path& out, const fs::path& err,
                   const Words& environment = {}) {
  Words words = {VERDURE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Words variables = environment;
  std::vector<char*> argv, envp;
  for (std::string& w : words) argv.push_back(w.data());
  for (std::string& v : variables) envp.push_back(v.data());
  for (char** v = environ; *v != nullptr; ++v) envp.push_back(*v);
  argv.push_back(nullptr);
  envp.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), kFlags, 0600);
  pid_t child = -1;
  const int problem =
      posix_spawn(&child, VERDURE_PROGRAM, &files, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&files);
  EXPECT_EQ(problem, 0) << "cannot start " << VERDURE_PROGRAM;
  return problem == 0 ? child : -1;
}

struct Outcome {
  int code = -1;  ///< 128 + signal if one ended it
  std::string out, err;
};

/// A folder of its own for each test; logs lie beside it so that it holds only what the program
/// writes.
class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    dir_ = scratchFolder(name);
    logs_ = scratchFolder(name + "_logs");
  }

  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  Outcome run(const Words& arguments, const Words& environment = {}) const {
    Outcome outcome;
    const pid_t child = start(arguments, logs_ / "out", logs_ / "err", environment);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = textOf(logs_ / "out");
    outcome.err = textOf(logs_ / "err");
    return outcome;
  }

  /// Must succeed and say nothing on standard error: progress is for terminals only.
  std::string runWell(const Words& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments[0] << ": " << outcome.err;
    EXPECT_EQ(outcome.err, "") << arguments[0];
    return outcome.out;
  }

  /// Names and sizes of all files, hidden ones too.
  std::set<std::string> listing() const {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(dir_))
      files.insert(fmt::format("{} {}", entry.path().string(),
                               entry.is_regular_file() ? entry.file_size() : 0));
    return files;
  }

  /// Must end with code 2 and one line that holds all `said`; writes nothing.
  void expectRefused(const Words& arguments, const Words& said,
                     const Words& environment = {}) const {
    std::string shown = "verdure";
    for (const std::string& a : arguments) shown.append(" ").append(a);
    SCOPED_TRACE(shown);
    const auto before = listing();
    const Outcome outcome = run(arguments, environment);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.rfind("verdure: ", 0), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(!outcome.err.empty() && outcome.err.back() == '\n');
    EXPECT_EQ(outcome.err.rfind("verdure: unexpected", 0), std::string::npos) << outcome.err;
    for (const std::string& text : said)
      EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err << "lacks: " << text;
    EXPECT_EQ(listing(), before);
  }

  /// A tree of a few hundred leaves; of some thousand with three levels of stems.
  std::string smallTree(const std::string& name = "tree.glb", int levels = 2) const {
    runWell({"grow", "-o", path(name), "--leaves", "card", "--texture-size", "64", "--set",
             fmt::format("Levels={}", levels), "--set", "Leaves=6", "--seed", "3"});
    return path(name);
  }

  fs::path dir_, logs_;
};

/// Squares of 10 cm in a file, one leaf each, with the given lower left corners.
struct LeafFile : GltfBuilder {
  explicit LeafFile(const std::vector<glm::vec3>& corners, float side = 0.1f) {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> triangles;
    for (const glm::vec3& c : corners) {
      const auto first = static_cast<std::uint32_t>(positions.size());
      for (const glm::vec3 corner :
           {glm::vec3(0), glm::vec3(side, 0, 0), glm::vec3(side, side, 0), glm::vec3(0, side, 0)})
        positions.push_back(c + corner);
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) triangles.push_back(first + i);
    }
    json["materials"] = Json::array({{{"name", "leaf"}}});
    mesh({{"attributes", {{"POSITION", floats(positions)}}},
          {"indices", indices(triangles)},
          {"material", 0}},
         "leaf");
    node({{"mesh", 0}});
  }
};

}  // namespace verdure::test

#endif  // VERDURE_TESTS_COMMAND_LINE_H_
