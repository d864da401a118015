#include "app/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "app/commands.h"
#include "verdure/error.h"

extern char** environ;

namespace verdure::app {
namespace {

namespace fs = std::filesystem;

bool isFilm(const std::string& path) {
  return fs::path(path).extension() != ".png";
}

bool onPath(const char* program) {
  const char* path = std::getenv("PATH");
  if (path == nullptr) return false;
  const std::string all = path;
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find(':', begin), all.size());
    const fs::path file = fs::path(all.substr(begin, end - begin)) / program;
    if (access(file.c_str(), X_OK) == 0) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

Video::Video(std::string path, int fps) : path_(std::move(path)), fps_(fps) {
  checkOutput(path_, {".mp4", ".webm", ".gif", ".png"});
  if (fs::path(path_).extension() == ".gif" && fps_ > 50)
    throw Error("--fps", fmt::format("{} is more than a .gif can show", fps_), "choose 1 to 50");
  if (isFilm(path_) && !onPath("ffmpeg"))
    throw Error(path_, "films are written by ffmpeg, which is not installed",
                "install it (apt-get install ffmpeg), or name a .png for numbered pictures");
}

Video::~Video() {
  if (pipe_ >= 0) close(pipe_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
  std::error_code ignored;
  if (!unfinished_.empty()) fs::remove(unfinished_, ignored);
}

void Video::start(int width, int height) {
  const fs::path path(path_);
  unfinished_ = (path.parent_path() /
                 fmt::format(".{}.{}{}", path.stem().string(), getpid(), path.extension().string()))
                    .string();
  const std::string size = fmt::format("{}x{}", width, height), rate = std::to_string(fps_);
  std::vector<std::string> words{"ffmpeg", "-loglevel", "error",    "-nostdin", "-y",
                                 "-f",     "rawvideo",  "-pix_fmt", "rgba",     "-s",
                                 size,     "-r",        rate,       "-i",       "pipe:0"};
  const auto say = [&words](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  // Players want even sizes and half the colour.
  constexpr const char* kEven = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709";
  if (path.extension() != ".gif")
    say({"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"});
  if (path.extension() == ".mp4")
    say({"-vf", kEven, "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-movflags",
         "+faststart"});
  else if (path.extension() == ".webm")
    say({"-vf", kEven, "-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p", "-crf", "28", "-b:v", "0"});
  else
    say({"-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1"});
  words.push_back("file:" + unfinished_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw Error(path_, "there is no pipe to ffmpeg");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
  const int failed =
      posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (failed != 0) {
    process_ = -1;
    throw Error(path_, "ffmpeg cannot be started", "name a .png for numbered pictures");
  }
  std::signal(SIGPIPE, SIG_IGN);  // a film that ffmpeg gave up is an Error, not our end
}

void Video::add(const Image& image, int number) {
  if (!isFilm(path_)) {
    const fs::path path(path_);
    writePng(image, path.parent_path() / fmt::format("{}-{:04}.png", path.stem().string(), number));
    return;
  }
  if (pipe_ < 0) start(image.width, image.height);
  for (std::size_t at = 0; at < image.rgba.size();) {
    const ssize_t count = write(pipe_, image.rgba.data() + at, image.rgba.size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Error(path_, "ffmpeg took no more pictures", "see what it said");
    at += static_cast<std::size_t>(count);
  }
}

void Video::finish() {
  if (pipe_ < 0) return;
  close(pipe_);
  pipe_ = -1;
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(process_, &status, 0);
  while (ended < 0 && errno == EINTR);
  process_ = -1;
  if (ended < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(path_, "ffmpeg could not make a film of this", "see what it said");
  std::error_code failed;
  fs::rename(unfinished_, path_, failed);
  if (failed) throw Error(path_, "the film could not be put in its place: " + failed.message());
  unfinished_.clear();
}

}  // namespace verdure::app
