#include "core/base/error.h"

#include <cassert>
#include <utility>

#include "core/base/shorten.h"

namespace orrery {
namespace {

std::vector<Problem> bounded(std::vector<Problem> problems) {
  if (problems.size() > InputError::kMaxProblems) problems.resize(InputError::kMaxProblems);
  for (Problem& p : problems)
    for (std::string* text : {&p.pointer, &p.detail}) *text = shortened(*text, InputError::kMaxCharacters);
  return problems;
}

std::string summary(const std::vector<Problem>& problems) {
  assert(!problems.empty());
  std::string text = bounded({problems.front()}).front().text();
  if (problems.size() > 1) {
    const std::size_t more = problems.size() - 1;
    text += " (and " + std::to_string(more) + (more == 1 ? " more problem)" : " more problems)");
  }
  return text;
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : Error(summary(problems)), problems_(bounded(std::move(problems))) {}

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
