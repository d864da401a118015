#ifndef VERDURE_BASE_PROGRESS_H_
#define VERDURE_BASE_PROGRESS_H_

#include <chrono>
#include <string>

namespace verdure {

/// Seconds since it was made or last restarted.
class Timer {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Returns the seconds so far and starts again.
  double lap() {
    const double elapsed = seconds();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// One line on standard error that says what is being done, rewritten in place; prints nothing
/// when standard error is not a terminal.
class Progress {
 public:
  explicit Progress(std::string title);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  ///< clears the line
  /// `fraction` in [0, 1]; a negative one shows the step alone.
  void show(const std::string& step, double fraction = -1.0);

 private:
  std::string title_;
  bool terminal_ = false;
};

}  // namespace verdure

#endif  // VERDURE_BASE_PROGRESS_H_
