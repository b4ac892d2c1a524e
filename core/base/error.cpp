#include "core/base/error.h"

#include <cassert>
#include <utility>

namespace orrery {
namespace {

std::string summary(const std::vector<Problem>& problems) {
  assert(!problems.empty());
  const Problem& first = problems.front();
  std::string text = first.text();
  if (problems.size() > 1) {
    const std::size_t more = problems.size() - 1;
    text += " (and " + std::to_string(more) + (more == 1 ? " more problem)" : " more problems)");
  }
  return text;
}

std::vector<Problem> at_most(std::vector<Problem> problems, std::size_t count) {
  if (problems.size() > count) problems.resize(count);
  return problems;
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : Error(summary(problems)), problems_(at_most(std::move(problems), kMaxProblems)) {}

InputError::InputError(std::string pointer, std::string detail)
    : InputError(std::vector<Problem>{{std::move(pointer), std::move(detail)}}) {}

MalformedJson::MalformedJson(std::string pointer, std::string detail, std::size_t offset, std::size_t line,
                             std::size_t column)
    : InputError(std::move(pointer), "line " + std::to_string(line) + ", column " + std::to_string(column) +
                                         ": " + std::move(detail)),
      offset_(offset),
      line_(line),
      column_(column) {}

}  // namespace orrery
