#include "server/commands/progress.h"

#include <unistd.h>

#include <cstdio>

namespace orrery {

ProgressBar::ProgressBar(std::string unit)
    : unit_(std::move(unit)), shown_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (written_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::say(const std::string& what) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  written_ = true;
  std::fprintf(stderr, "\r%s ...\x1b[K", what.c_str());
  std::fflush(stderr);
}

void ProgressBar::update(int done, int total) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (done <= done_ || (done < total && now - drawn_ < std::chrono::milliseconds(100))) return;
  written_ = true;
  done_ = done;
  drawn_ = now;
  constexpr int kWidth = 30;
  const double part = double(done) / total;
  const int filled = static_cast<int>(part * kWidth);
  const double spent = std::chrono::duration<double>(now - start_).count();
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r[%s] %3.0f%%  %d of %d %s  %.0f s left\x1b[K", bar.c_str(), 100 * part, done, total,
               unit_.c_str(), spent / part - spent);
  std::fflush(stderr);
}

}  // namespace orrery
