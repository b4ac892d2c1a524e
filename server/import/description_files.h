#pragma once

#include <string>

#include "server/import/import.h"
#include "server/import/place.h"

namespace orrery {

// Files of one description, within the limits of an import. The functions throw InputError. Not thread-safe.
class DescriptionFiles {
 public:
  // The arguments must outlive the object.
  DescriptionFiles(const ReadNearby& nearby, const ImportLimits& limits) : nearby_(nearby), limits_(limits) {}

  // Counts the bytes of a file.
  void count(const std::string& text, const std::string& name);
  // Reads a file that the description includes at `place`. end_include() ends the include.
  std::string begin_include(const std::string& name, const ImportPlace& place);
  void end_include() { --depth_; }

 private:
  const ReadNearby& nearby_;
  const ImportLimits& limits_;
  std::size_t bytes_ = 0, files_ = 0, depth_ = 0;
};

}  // namespace orrery
