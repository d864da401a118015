#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace verdure {
namespace fs = std::filesystem;

std::vector<std::uint8_t> readFile(const fs::path& path) {
  std::error_code status;
  if (!fs::exists(path, status)) throw Error(path.string(), "no such file", "check the path");
  if (fs::is_directory(path, status)) throw Error(path.string(), "is a folder", "name a file");
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

/// A file under a temporary name, removed unless renamed into place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) {
    std::string file_name = ".";
    file_name.append(target.filename().string()).append(".XXXXXX");
    name_ = (folderOf(target) / file_name).string();
    descriptor_ = mkstemp(name_.data());
    if (descriptor_ < 0)
      throw Error(target.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
                  "check that the folder exists and is writable");
    ::fchmod(descriptor_, 0644);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }

  void write(std::span<const std::uint8_t> bytes, const fs::path& target) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0)
        throw Error(target.string(),
                    std::string("cannot be written (") + std::strerror(errno) + ")",
                    "check the free space");
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
  }

  void renameTo(const fs::path& target) {
    if (::close(std::exchange(descriptor_, -1)) != 0 ||
        ::rename(name_.c_str(), target.c_str()) != 0)
      throw Error(target.string(), std::string("cannot be written (") + std::strerror(errno) + ")");
    renamed_ = true;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void writeFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
  if (fs::is_directory(path)) throw Error(path.string(), "is a folder", "name a file");
  TemporaryFile file(path);
  file.write(bytes, path);
  file.renameTo(path);
}

void writeFile(const fs::path& path, const std::string& text) {
  writeFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void checkWritable(const fs::path& path) {
  if (fs::is_directory(path)) throw Error(path.string(), "is a folder", "name a file");
  TemporaryFile probe(path);
}

}  // namespace verdure
