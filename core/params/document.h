#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// What a JSON text may cost before it is refused. Every refusal names the limit it hit.
struct JsonLimits {
  std::size_t depth = 32;         // arrays and objects inside one another; keeps every recursion shallow
  std::size_t nodes = 1'000'000;  // values of any kind; about 16 to 100 bytes of memory each
};

// A parsed JSON value. Immutable and cheap to copy: copies and members share one tree, and keep it alive.
// Safe to read from any number of threads. core/params/json.h gives the tree itself to those who must have
// it.
class Document {
 public:
  bool has(std::string_view key) const;  // false if this is not an object

  // The member of an object, with errors in it still reported from the root: "/scene/objects/3".
  std::optional<Document> member(std::string_view key) const;

  // JSON Pointer of this value in the text it was parsed from; "" for the root.
  const std::string& pointer() const noexcept { return pointer_; }

  // The one way to write this value: keys sorted by their bytes, no spaces, each number as the shortest
  // decimal that reads back to the same double (so 1, 1.0 and 10e-1 are one number, and -0 is 0), strings
  // as UTF-8 with only the escapes that JSON demands.
  std::string canonical() const;

  // SHA-256 of canonical(), 64 hexadecimal digits: equal for texts that differ only in layout.
  std::string id() const;

 private:
  friend struct DocumentAccess;
  Document(std::shared_ptr<const nlohmann::json> value, std::string pointer);

  std::shared_ptr<const nlohmann::json> value_;  // never null; may alias into a larger tree
  std::string pointer_;
};

// Parses one JSON text (RFC 8259, UTF-8), strictly. Throws MalformedJson for text that is not JSON, which
// includes NaN, Infinity, comments and invalid UTF-8; throws InputError for duplicate keys, for numbers that
// no double can hold (1e999) and for a limit that was hit.
Document parse_document(std::string_view text, const JsonLimits& limits = {});

}  // namespace orrery
