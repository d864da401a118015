#ifndef VERDURE_APP_PAGE_H_
#define VERDURE_APP_PAGE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "verdure/image.h"

namespace verdure::app {

/// A folder of pictures and the page that shows them.
class Page {
 public:
  /// Makes the folder unless it is there. Throws Error if it cannot or index.html could not be
  /// written.
  Page(std::filesystem::path folder, std::string title, std::string introduction);

  void heading(const std::string& text);
  void paragraph(const std::string& html);
  /// Pictures that stand side by side.
  void beginRow();
  void endRow();
  /// `name` without extension.
  void picture(const std::string& name, const Image& image, const std::string& caption);
  void svg(const std::string& name, const std::string& svg, const std::string& caption);
  /// The first row is the head.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// Writes index.html.
  void write() const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  void add(const std::string& file, const std::string& caption);

  std::filesystem::path folder_;
  std::string title_, introduction_, body_;
};

/// The start of an SVG picture on white; "</svg>" ends it.
std::string svgOpen(int width, int height);

}  // namespace verdure::app

#endif  // VERDURE_APP_PAGE_H_
