#include "core/params/document.h"

#include <utility>

#include "core/base/hash.h"
#include "core/params/json.h"
#include "core/params/words.h"

namespace orrery {

Document::Document(std::shared_ptr<const nlohmann::json> value, std::string pointer)
    : value_(std::move(value)), pointer_(std::move(pointer)) {}

bool Document::has(std::string_view key) const { return value_->is_object() && value_->contains(key); }

std::optional<Document> Document::member(std::string_view key) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return Document(std::shared_ptr<const nlohmann::json>(value_, &*found), pointer_ + pointer_step(key));
}

std::string Document::canonical() const {
  std::string text;
  append_canonical(*value_, text);
  return text;
}

std::string Document::id() const { return sha256_hex(canonical()); }

}  // namespace orrery
