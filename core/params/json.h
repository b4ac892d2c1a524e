#pragma once

#include <nlohmann/json.hpp>

#include "core/params/document.h"

// JSON tree of a Document, for code that handles JSON directly (responses of the service, tests). Only
// core/params, server/ and tests/ include this header. All other code reads documents through Params.

namespace orrery {

struct DocumentAccess {
  static const nlohmann::json& tree(const Document& document) { return *document.value_; }
  // Returns `part` as a document. REQUIRES: `part` is inside the tree of `document`.
  static Document part(const Document& document, const nlohmann::json& part, std::string pointer) {
    return Document(std::shared_ptr<const nlohmann::json>(document.value_, &part), std::move(pointer));
  }
  static Document make(std::shared_ptr<const nlohmann::json> value, std::string pointer) {
    return Document(std::move(value), std::move(pointer));
  }
};

inline const nlohmann::json& json_of(const Document& document) { return DocumentAccess::tree(document); }

// Makes a document from a JSON value, e.g. a scene with changed members. REQUIRES: all numbers are finite.
inline Document document_of(nlohmann::json value) {
  return DocumentAccess::make(std::make_shared<const nlohmann::json>(std::move(value)), "");
}

}  // namespace orrery
