#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <utility>

namespace verdure {
namespace fs = std::filesystem;

std::vector<std::uint8_t> readFile(const fs::path& path) {
  std::error_code status;
  if (!fs::exists(path, status)) throw Error(path.string(), "no such file", "check the path");
  if (fs::is_directory(path, status)) throw Error(path.string(), "is a folder", "name a file");
  if (!fs::is_regular_file(path, status))
    throw Error(path.string(), "is no regular file", "copy it into one");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw Error(path.string(), "cannot be read", "check its permissions");
  const std::streamoff size = in.tellg();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!in) throw Error(path.string(), "cannot be read to its end");
  return bytes;
}

namespace {

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Error cannotWrite(const fs::path& target, const char* advice) {
  return Error(target.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
               advice);
}

/// Renaming over a device or a pipe would put a file in its place.
void checkTarget(const fs::path& path) {
  if (path.empty()) throw Error("output", "the file has no name", "name a file");
  std::error_code status;  // what cannot be looked at cannot be written either, and that is told
  if (fs::is_directory(path, status)) throw Error(path.string(), "is a folder", "name a file");
  if (fs::is_other(path, status))
    throw Error(path.string(), "is no regular file", "name another file");
}

/// A file that is not there yet: without any name where the system can do that (Linux, on most of
/// its file systems), so that nothing of it outlives the process, else under a temporary one.
class PendingFile {
 public:
  explicit PendingFile(const fs::path& target)
      : hidden_(folderOf(target) /
                std::string(".").append(target.filename().string()).append(".XXXXXX")) {
#ifdef O_TMPFILE
    if (::access("/proc/self/fd", X_OK) == 0)  // the way to its name
      descriptor_ = ::open(folderOf(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
#endif
    descriptor_ = ::mkstemp(hidden_.data());
    if (descriptor_ < 0) throw cannotWrite(target, "check that the folder exists and is writable");
    named_ = true;
    ::fchmod(descriptor_, 0644);
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (named_) ::unlink(hidden_.c_str());
  }

  void write(std::span<const std::uint8_t> bytes, const fs::path& target) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw cannotWrite(target, "check the free space");
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
  }

  void moveTo(const fs::path& target) {
    if (!named_) {
      // A link cannot replace a file, a rename can; between the two it has its hidden name.
      const std::string own = "/proc/self/fd/" + std::to_string(descriptor_);
      hidden_.replace(hidden_.size() - 6, 6, std::to_string(::getpid()));
      ::unlink(hidden_.c_str());  // of a process of the same number that was killed right there
      if (::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, hidden_.c_str(), AT_SYMLINK_FOLLOW) != 0)
        throw cannotWrite(target, "choose another folder");
      named_ = true;
    }
    if (::close(std::exchange(descriptor_, -1)) != 0 ||
        ::rename(hidden_.c_str(), target.c_str()) != 0)
      throw cannotWrite(target, "choose another file");
    named_ = false;
  }

 private:
  std::string hidden_;
  int descriptor_ = -1;
  bool named_ = false;  ///< it stands in the folder under its hidden name
};

}  // namespace

void writeFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
  checkTarget(path);
  PendingFile file(path);
  file.write(bytes, path);
  file.moveTo(path);
}

void writeFiles(const std::vector<std::pair<fs::path, std::vector<std::uint8_t>>>& files) {
  std::deque<PendingFile> pending;  // they cannot move
  for (const auto& [path, bytes] : files) {
    checkTarget(path);
    pending.emplace_back(path).write(bytes, path);
  }
  for (std::size_t i = 0; i < files.size(); ++i) pending[i].moveTo(files[i].first);
}

void writeFile(const fs::path& path, const std::string& text) {
  writeFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void checkWritable(const fs::path& path) {
  checkTarget(path);
  PendingFile probe(path);
}

}  // namespace verdure
