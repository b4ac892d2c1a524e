#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

// What the core throws. The edge of the program (server/) turns each class into its own answer: a status
// code over HTTP, an exit code and a line of text on the command line. Nothing else leaves the core on
// purpose; a std::logic_error or std::bad_alloc that does is our own bug or the machine's limit.

namespace orrery {

// One thing that is wrong with the input.
struct Problem {
  std::string pointer;  // JSON Pointer (RFC 6901) of the value; "" is the whole document
  std::string detail;   // one sentence without the place: what was expected and what came

  // The place, if there is one, before the sentence.
  std::string text() const { return pointer.empty() ? detail : pointer + ": " + detail; }
};

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The input says something that cannot be done: wrong type, out of range, unknown name, no meaning.
// what() is a readable summary: the first problem with its place, and how many more there are.
class InputError : public Error {
 public:
  // At most this many problems are kept: more help nobody and let a bad document ask for unbounded memory.
  static constexpr std::size_t kMaxProblems = 20;
  // Characters of a pointer and of a detail; longer ones are shortened. Those who write them cut names,
  // values and lists long before.
  static constexpr std::size_t kMaxCharacters = 2048;

  // REQUIRES: problems is not empty. Problems past kMaxProblems are dropped.
  explicit InputError(std::vector<Problem> problems);
  InputError(std::string pointer, std::string detail);

  const std::vector<Problem>& problems() const noexcept { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// The text is not JSON at all. Its one problem points at the innermost value that was being read.
class MalformedJson : public InputError {
 public:
  // offset: bytes before the offending one, from 0. line and column count from 1, columns in characters.
  MalformedJson(std::string pointer, std::string detail, std::size_t offset, std::size_t line,
                std::size_t column);

  std::size_t offset() const noexcept { return offset_; }
  std::size_t line() const noexcept { return line_; }
  std::size_t column() const noexcept { return column_; }

 private:
  std::size_t offset_, line_, column_;
};

// A scene, a sample or another named thing does not exist (any more).
class NotFound : public Error {
 public:
  using Error::Error;
};

// There is no room for the work now; the same request may succeed after retry_after_s seconds.
class Busy : public Error {
 public:
  Busy(const std::string& message, double retry_after_s) : Error(message), retry_after_s_(retry_after_s) {}
  double retry_after_s() const noexcept { return retry_after_s_; }

 private:
  double retry_after_s_;
};

// The one who asked has gone or called the work off: nobody waits for an answer.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
  using Error::Error;
};

}  // namespace orrery
