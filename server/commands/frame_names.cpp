#include "server/commands/frame_names.h"

#include "core/base/error.h"

namespace orrery {

FrameNames::FrameNames(const std::string& pattern) {
  const InputError bad("--output", "must contain one %d or %04d for the frame number (got " + pattern + ")");
  bool found = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& part = found ? after_ : before_;
    if (pattern[i] != '%') {
      part += pattern[i];
    } else if (pattern.compare(i, 2, "%%") == 0) {
      part += pattern[++i];
    } else {
      const std::size_t letter = pattern.find_first_not_of("0123456789", i + 1);
      const std::string width = pattern.substr(i + 1, letter - i - 1);
      if (found || letter == std::string::npos || pattern[letter] != 'd' || width.size() > 3) throw bad;
      if (!width.empty() && width[0] != '0') throw bad;  // padding with blanks is not supported
      if (!width.empty()) digits_ = std::stoul(width);
      found = true;
      i = letter;
    }
  }
  if (!found) throw bad;
}

std::string FrameNames::of(std::int64_t number) const {
  std::string digits = std::to_string(number);
  if (digits.size() < digits_) digits.insert(0, digits_ - digits.size(), '0');
  return before_ + digits + after_;
}

}  // namespace orrery
