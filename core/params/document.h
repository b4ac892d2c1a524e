#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// Limits of parse_document(). The error names the exceeded limit.
struct JsonLimits {
  std::size_t depth = 32;         // levels of nested arrays and objects; bounds every recursion
  std::size_t nodes = 1'000'000;  // values of any kind; each takes 16 to 100 bytes of memory
};

// Immutable parsed JSON value. Cheap to copy: copies and members share ownership of one tree. Thread-safe.
// Code that needs the tree itself includes core/params/json.h.
class Document {
 public:
  bool has(std::string_view key) const;  // false if this is not an object

  // Returns the member `key`, or nullopt if there is none or this is not an object. The pointer of the member
  // starts at the root of the parsed text: "/scene/objects/3".
  std::optional<Document> member(std::string_view key) const;

  // JSON Pointer (RFC 6901) of this value in the parsed text; "" for the root.
  const std::string& pointer() const noexcept { return pointer_; }

  // Returns the canonical text of this value. Keys are sorted by bytes and there is no white space. 1, 1.0
  // and 10e-1 have the same text, and -0 becomes 0: whole numbers up to 2^53 have neither fraction nor
  // exponent. Larger integers keep all digits. Any other number is the shortest decimal that reads back to
  // the same double. Strings are UTF-8 with only the escapes that JSON requires.
  std::string canonical() const;

  // Returns the SHA-256 of canonical() as 64 hexadecimal digits. Texts that differ only in white space, key
  // order, number format or escapes have the same id.
  std::string id() const;

 private:
  friend struct DocumentAccess;
  Document(std::shared_ptr<const nlohmann::json> value, std::string pointer);

  std::shared_ptr<const nlohmann::json> value_;  // never null; may point into a larger tree
  std::string pointer_;
};

// Parses one JSON text (RFC 8259, UTF-8). Throws MalformedJson if the text is not JSON: NaN, Infinity,
// comments and invalid UTF-8 are rejected. Throws InputError for duplicate keys, for numbers beyond the range
// of double (1e999) and for an exceeded limit. Calls checkpoint(), which throws Cancelled.
// Thread-safe.
Document parse_document(std::string_view text, const JsonLimits& limits = {});

}  // namespace orrery
