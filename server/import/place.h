#pragma once

#include <cmath>
#include <string>

#include "core/base/error.h"

namespace orrery {

// Line of a scene description.
struct ImportPlace {
  std::string file;
  std::size_t line = 1;
};

// Throws InputError with the pointer "file:line".
[[noreturn]] inline void refuse_at(const ImportPlace& place, const std::string& detail) {
  throw InputError(place.file + ":" + std::to_string(place.line), detail);
}

}  // namespace orrery
