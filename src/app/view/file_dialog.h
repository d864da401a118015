#ifndef VERDURE_APP_VIEW_FILE_DIALOG_H_
#define VERDURE_APP_VIEW_FILE_DIALOG_H_

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace verdure::app {

/// Asks for the path of a file: a field to write it in, and what is in its folder.
class FileDialog {
 public:
  /// `extensions`: of files that are listed, with their dots. `chosen` gets the path.
  void open(std::string title, const std::filesystem::path& start,
            std::vector<std::string> extensions, bool save,
            std::function<void(const std::filesystem::path&)> chosen);
  /// To be called for each frame.
  void draw();

 private:
  struct Entry {
    std::string name;
    bool folder = false;
  };
  void list(const std::filesystem::path& folder);

  std::string title_, path_, problem_;
  std::vector<std::string> extensions_;
  bool save_ = false, opening_ = false;
  std::function<void(const std::filesystem::path&)> chosen_;
  std::filesystem::path listed_;  ///< folder of the entries
  std::vector<Entry> entries_;
};

/// Folders first, then files whose names end in one of `extensions`, each sorted; without hidden
/// ones. An unreadable folder is empty.
std::vector<std::pair<std::string, bool>> folderEntries(const std::filesystem::path& folder,
                                                        const std::vector<std::string>& extensions);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_FILE_DIALOG_H_
