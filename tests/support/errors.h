#pragma once

#include <string>

#include "core/base/error.h"

namespace orrery::test {

// Returns the text of the InputError that call() throws, or "accepted".
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// Returns the detail of the first problem of the InputError that call() throws, or "accepted".
template <class Call>
std::string detail_of(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.problems().front().detail;
  }
  return "accepted";
}

}  // namespace orrery::test
