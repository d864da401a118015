#ifndef VERDURE_ERROR_H_
#define VERDURE_ERROR_H_

#include <stdexcept>
#include <string>

namespace verdure {

/// Bad input or a bad environment: thrown by every public function that reads, writes or checks.
/// `what()` is one line that says what is wrong, where, and what to do:
/// "oak.glb: accessor 3 points past the end of its buffer; export the file again".
/// A broken invariant of the library itself is not an Error: it aborts (see base/check.h).
class Error : public std::runtime_error {
 public:
  /// `where`: file, option or object; `what`: what is wrong; `advice`: what to do (may be empty).
  Error(const std::string& where, const std::string& what, const std::string& advice = "")
      : std::runtime_error(where + ": " + what + (advice.empty() ? "" : "; " + advice)) {}
};

}  // namespace verdure

#endif  // VERDURE_ERROR_H_
