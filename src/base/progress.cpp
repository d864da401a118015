#include "base/progress.h"

#include <unistd.h>

#include <cstdio>

namespace verdure {

Progress::Progress(std::string title)
    : title_(std::move(title)), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::show(const std::string& step, double fraction) {
  if (!terminal_) return;
  if (fraction < 0.0)
    std::fprintf(stderr, "\r\033[K%s: %s", title_.c_str(), step.c_str());
  else
    std::fprintf(stderr, "\r\033[K%s: %s %3.0f %%", title_.c_str(), step.c_str(), 100.0 * fraction);
  std::fflush(stderr);
}

}  // namespace verdure
