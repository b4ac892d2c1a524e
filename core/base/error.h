#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

// core/base: exceptions, cancellation, memory accounts, parallel loops, hashes and text helpers. Functions
// are thread-safe unless a comment states otherwise.
//
// Exceptions of the core. The server maps each class to an HTTP status, the command line to an exit code and
// one line of text. A std::logic_error that escapes the core is a bug. A std::bad_alloc means that the
// machine or the memory account of the task is out of memory.

namespace orrery {

// One problem in the input.
struct Problem {
  std::string pointer;  // JSON Pointer (RFC 6901) to the value; "" for the whole document
  std::string detail;   // one sentence without the place: allowed range and actual value

  // Returns the detail, preceded by the pointer unless that is empty.
  std::string text() const { return pointer.empty() ? detail : pointer + ": " + detail; }
};

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Invalid input: wrong type, out of range, unknown name or contradictory values. what() returns the first
// problem with its place, and the number of further problems.
class InputError : public Error {
 public:
  // Maximum number of stored problems. It bounds the memory that an invalid document can use.
  static constexpr std::size_t kMaxProblems = 20;
  // Maximum number of characters of a pointer and of a detail. Longer texts are shortened. Callers already
  // shorten names, values and lists to far less.
  static constexpr std::size_t kMaxCharacters = 2048;

  // REQUIRES: problems is not empty. Drops problems past kMaxProblems.
  explicit InputError(std::vector<Problem> problems);
  InputError(std::string pointer, std::string detail);

  const std::vector<Problem>& problems() const noexcept { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Text that is not JSON. The only problem has the pointer of the innermost value that was being parsed.
class MalformedJson : public InputError {
 public:
  // `offset` counts bytes from 0. `line` and `column` count from 1, columns in characters.
  MalformedJson(std::string pointer, std::string detail, std::size_t offset, std::size_t line,
                std::size_t column);

  std::size_t offset() const noexcept { return offset_; }
  std::size_t line() const noexcept { return line_; }
  std::size_t column() const noexcept { return column_; }

 private:
  std::size_t offset_, line_, column_;
};

// Unknown or deleted scene, sample or other named resource.
class NotFound : public Error {
 public:
  using Error::Error;
};

// The server is at capacity. The same request may succeed after retry_after_s seconds.
class Busy : public Error {
 public:
  Busy(const std::string& message, double retry_after_s) : Error(message), retry_after_s_(retry_after_s) {}
  double retry_after_s() const noexcept { return retry_after_s_; }

 private:
  double retry_after_s_;
};

// The operation was cancelled, for example because its client disconnected. No response is expected.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
  using Error::Error;
};

}  // namespace orrery
