#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace orrery {

// Names defined in a document, numbered in insertion order.
class Names {
 public:
  // `kind` is the noun in errors: unknown material "slver" (did you mean "silver"?).
  explicit Names(std::string kind) : kind_(std::move(kind)) {}

  // Returns the index of the new name. REQUIRES: `name` was not added before.
  std::size_t add(std::string name) {
    return index_of_.emplace(std::move(name), index_of_.size()).first->second;
  }

  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = index_of_.find(name);
    return found == index_of_.end() ? std::nullopt : std::optional(found->second);
  }

  const std::string& kind() const { return kind_; }
  const std::map<std::string, std::size_t, std::less<>>& index_of() const { return index_of_; }

 private:
  std::string kind_;
  std::map<std::string, std::size_t, std::less<>> index_of_;
};

}  // namespace orrery
