#include "app/page.h"

#include <fmt/format.h>

#include "base/files.h"
#include "verdure/error.h"

namespace verdure::app {

Page::Page(std::filesystem::path folder, std::string title, std::string introduction)
    : folder_(std::move(folder)), title_(std::move(title)), introduction_(std::move(introduction)) {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem)
    throw Error(folder_.string(), "the folder cannot be made (" + problem.message() + ")",
                "choose another with -o");
  checkWritable(folder_ / "index.html");
}

void Page::heading(const std::string& text) {
  body_ += fmt::format("<h2>{}</h2>\n", text);
}

void Page::paragraph(const std::string& html) {
  body_ += fmt::format("<p>{}</p>\n", html);
}

void Page::beginRow() {
  body_ += "<div class=row>\n";
}

void Page::endRow() {
  body_ += "</div>\n";
}

void Page::picture(const std::string& name, const Image& image, const std::string& caption) {
  writePng(image, folder_ / (name + ".png"));
  add(name + ".png", caption);
}

void Page::svg(const std::string& name, const std::string& svg, const std::string& caption) {
  writeFile(folder_ / (name + ".svg"), svg);
  add(name + ".svg", caption);
}

void Page::table(const std::vector<std::vector<std::string>>& rows) {
  body_ += "<table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    body_ += "<tr>";
    for (const std::string& cell : rows[r])
      body_ += fmt::format("<{0}>{1}</{0}>", r == 0 ? "th" : "td", cell);
    body_ += "</tr>\n";
  }
  body_ += "</table>\n";
}

void Page::write() const {
  writeFile(folder_ / "index.html",
            fmt::format("<!doctype html><html lang=en><meta charset=utf-8><title>{0}</title>\n"
                        "<style>body{{font:15px/1.45 sans-serif;margin:2em auto;max-width:1320px;"
                        "padding:0 1em;color:#222}}.row{{display:flex;flex-wrap:wrap;gap:12px}}"
                        "figure{{margin:0;flex:1 1 220px;max-width:640px}}"
                        "img{{width:100%;height:auto}}figcaption{{color:#555;font-size:13px}}"
                        "td,th{{padding:2px 12px;text-align:right}}"
                        "td:first-child,th:first-child{{text-align:left}}</style>\n"
                        "<h1>{0}</h1>\n<p>{1}</p>\n{2}</html>\n",
                        title_, introduction_, body_));
}

void Page::add(const std::string& file, const std::string& caption) {
  body_ += fmt::format("<figure><img src='{0}' alt='{1}'><figcaption>{1}</figcaption></figure>\n",
                       file, caption);
}

std::string svgOpen(int width, int height) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' "
      "height='{1}' font-family='sans-serif' font-size='15'>\n"
      "<rect width='{0}' height='{1}' fill='white'/>\n",
      width, height);
}

}  // namespace verdure::app
