#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace orrery {

// Immutable bytes, shared without copies.
class SharedBytes {
 public:
  SharedBytes() = default;
  SharedBytes(std::string bytes) {
    const auto own = std::make_shared<const std::string>(std::move(bytes));
    *this = SharedBytes(own, *own);
  }
  SharedBytes(const char* text) : SharedBytes(std::string(text)) {}
  // Refers to bytes that live as long as `owner`, or as long as the program if it is null.
  SharedBytes(std::shared_ptr<const void> owner, std::string_view bytes)
      : owner_(std::move(owner)), bytes_(bytes) {}

  operator std::string_view() const { return bytes_; }
  const char* data() const { return bytes_.data(); }
  std::size_t size() const { return bytes_.size(); }
  bool empty() const { return bytes_.empty(); }

 private:
  std::shared_ptr<const void> owner_;
  std::string_view bytes_;
};

}  // namespace orrery
