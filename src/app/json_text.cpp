#include "app/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "verdure/error.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

/// Counts the lines that the parser has read: the library tells no places of what it finds.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  int* line_;
};

/// Goes through a text: where keys are, and whether one is there twice. A number is known only when
/// the character behind it has been read, so elements of lists that are no objects have their
/// list's line.
class KeyFinder : public nlohmann::json_sax<Json> {
 public:
  KeyFinder(std::string_view text, std::string wanted) : wanted_(std::move(wanted)) {
    const CountingIterator begin(text.data(), &line_), end(text.data() + text.size(), &line_);
    Json::sax_parse(begin, end, this);
  }
  int foundLine() const { return found_; }
  int lastLine() const { return line_; }  ///< that was read
  struct Repeated {
    std::string path;
    int line = 0;
  };
  const std::optional<Repeated>& repeated() const { return repeated_; }

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(std::int64_t) override { return value(); }
  bool number_unsigned(std::uint64_t) override { return value(); }
  bool number_float(double, const std::string&) override { return value(); }
  bool string(std::string&) override { return value(); }
  bool binary(Json::binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return start(false); }
  bool start_array(std::size_t) override { return start(true); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }
  bool key(std::string& name) override {
    Level& level = levels_.back();
    path_.resize(level.path_size);
    if (!path_.empty()) path_ += '.';
    path_ += name;
    if (std::find(level.keys.begin(), level.keys.end(), name) != level.keys.end() && !repeated_)
      repeated_ = {path_, line_};
    level.keys.push_back(name);
    note();
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  struct Level {
    bool is_list = false;
    std::size_t path_size = 0;  ///< of its own path
    std::size_t elements = 0;
    std::vector<std::string> keys;
  };

  /// Elements of lists get their path where they begin.
  bool value() {
    if (!levels_.empty() && levels_.back().is_list) ++levels_.back().elements;
    return true;
  }
  bool start(bool is_list) {
    if (!levels_.empty() && levels_.back().is_list) {
      path_.resize(levels_.back().path_size);
      path_ += fmt::format("[{}]", levels_.back().elements++);
      note();
    }
    levels_.push_back({is_list, path_.size(), 0, {}});
    return true;
  }
  bool end() {
    levels_.pop_back();
    return true;
  }
  void note() {
    const bool around = wanted_.starts_with(path_) &&
                        (wanted_.size() == path_.size() || wanted_[path_.size()] == '.' ||
                         wanted_[path_.size()] == '[');
    if (around) found_ = line_;
  }

  std::string wanted_, path_;
  int line_ = 1, found_ = 1;
  std::vector<Level> levels_;
  std::optional<Repeated> repeated_;
};

constexpr std::size_t kWidth = 96;

void append(const Json& json, std::size_t indent, std::string& out) {
  if (!json.is_structured() || json.empty()) {
    out += json.dump();
    return;
  }
  const bool flat = std::none_of(json.begin(), json.end(), [](const Json& part) {
    return part.is_object() || (part.is_array() && !part.empty() && part[0].is_structured());
  });
  const char open = json.is_array() ? '[' : '{', close = json.is_array() ? ']' : '}';
  if (flat) {
    std::string line(1, open);
    for (auto part = json.begin(); part != json.end(); ++part) {
      if (part != json.begin()) line += ", ";
      if (json.is_object()) line += Json(part.key()).dump() + ": ";
      std::string value;
      append(*part, 0, value);
      line += value;
    }
    line += close;
    if (line.size() + indent <= kWidth || (json.is_array() && !json[0].is_string())) {
      out += line;
      return;
    }
  }
  out += open;
  for (auto part = json.begin(); part != json.end(); ++part) {
    out += part == json.begin() ? "\n" : ",\n";
    out.append(indent + 2, ' ');
    if (json.is_object()) out += Json(part.key()).dump() + ": ";
    append(*part, indent + 2, out);
  }
  out += '\n';
  out.append(indent, ' ');
  out += close;
}

}  // namespace

Json parseJson(std::string_view text, const std::string& where) {
  Json json;
  try {
    json = Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& e) {
    // "[json...101] parse error at line 3, column 5: syntax error while parsing ..."
    const std::string said = e.what();
    int line = 1 + static_cast<int>(std::count(
                       text.begin(),
                       text.begin() + static_cast<std::ptrdiff_t>(
                                          std::clamp(e.byte, std::size_t{1}, text.size() + 1) - 1),
                       '\n'));
    const std::size_t colon = said.find(": ");
    throw Error(fmt::format("{}:{}", where, line),
                colon == std::string::npos ? "is no JSON" : said.substr(colon + 2),
                "mend it, or save the scene again");
  } catch (const Json::exception&) {  // a number that no double holds
    throw Error(fmt::format("{}:{}", where, KeyFinder(text, "").lastLine()),
                "holds a number that is too large", "mend it");
  }
  const KeyFinder finder(text, "");
  if (const auto& repeated = finder.repeated())
    throw Error(fmt::format("{}:{}", where, repeated->line),
                fmt::format("key '{}' is there twice", repeated->path), "leave one of them out");
  return json;
}

int lineOfKey(std::string_view text, const std::string& path) {
  return KeyFinder(text, path).foundLine();
}

std::string prettyJson(const Json& json) {
  std::string out;
  append(json, 0, out);
  return out + "\n";
}

}  // namespace verdure::app
