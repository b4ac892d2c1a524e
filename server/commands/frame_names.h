#pragma once

#include <cstdint>
#include <string>

namespace orrery {

// File names of numbered frames, from a pattern such as "frame-%04d.png". %d or %0<width>d becomes the frame
// number, %% becomes a percent sign.
class FrameNames {
 public:
  // Throws InputError unless the pattern has exactly one %d or %0<width>d.
  explicit FrameNames(const std::string& pattern);

  std::string of(std::int64_t number) const;

 private:
  std::string before_, after_;
  std::size_t digits_ = 0;  // minimum number of digits
};

}  // namespace orrery
