#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/meshes/formats.h"
#include "core/meshes/ply_header.h"

namespace orrery {

// Loads one value of type T. The conversion to double is exact.
template <class T, std::endian order>
double load_ply_value(const char* bytes) {
  std::array<char, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if constexpr (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return static_cast<double>(std::bit_cast<T>(copy));
}
using PlyLoad = double (*)(const char*);

template <std::endian order>
PlyLoad ply_load_as(PlyType type) {
  constexpr PlyLoad kLoads[] = {load_ply_value<std::int8_t, order>,  load_ply_value<std::uint8_t, order>,
                                load_ply_value<std::int16_t, order>, load_ply_value<std::uint16_t, order>,
                                load_ply_value<std::int32_t, order>, load_ply_value<std::uint32_t, order>,
                                load_ply_value<float, order>,        load_ply_value<double, order>};
  return kLoads[static_cast<std::size_t>(type)];
}
inline PlyLoad ply_load(PlyType type, PlyEncoding encoding) {
  return encoding == PlyEncoding::big_endian ? ply_load_as<std::endian::big>(type)
                                             : ply_load_as<std::endian::little>(type);
}

// Bodies of PLY files: AsciiPly reads words of text, BinaryPly reads bytes. describe() returns the argument
// for read() and skip().
class AsciiPly {
 public:
  struct Value {};
  static constexpr bool kBinary = false;

  explicit AsciiPly(const PlyHeader& header) : text_(header.body) {}
  Value describe(PlyType) const { return {}; }
  // Returns the minimum size of a value in bytes: one digit and one blank. bytes_left() adds 1, because the
  // last value may lack the blank.
  static std::size_t min_bytes(PlyType) { return 2; }
  std::size_t bytes_left() const { return text_.rest().size() + 1; }

  double read(Value) { return text_.number("value"); }
  void skip(Value) {
    if (text_.word().empty()) fail("must be a value (got the end of the file)");
  }
  [[noreturn]] void fail(const std::string& detail) const { text_.fail(detail); }

 private:
  TextReader text_;
};

class BinaryPly {
 public:
  struct Value {
    PlyLoad load;
    std::size_t size;
  };
  static constexpr bool kBinary = true;

  explicit BinaryPly(const PlyHeader& header)
      : encoding_(header.encoding), rest_(header.body.rest()), total_(rest_.size()) {}
  Value describe(PlyType type) const { return {ply_load(type, encoding_), size_of(type)}; }
  static std::size_t min_bytes(PlyType type) { return size_of(type); }
  std::size_t bytes_left() const { return rest_.size(); }

  double read(const Value& value) {
    const char* at = rest_.data();
    skip(value);
    return value.load(at);
  }
  void skip(const Value& value) {
    if (value.size > rest_.size())
      fail("must be a value of " + std::to_string(value.size) + " bytes (got the end of the file)");
    rest_.remove_prefix(value.size);
  }
  const char* take(std::size_t bytes) {  // REQUIRES: bytes <= bytes_left()
    const char* at = rest_.data();
    rest_.remove_prefix(bytes);
    return at;
  }
  [[noreturn]] void fail(const std::string& detail) const {
    fail_at("byte " + std::to_string(total_ - rest_.size()) + " after the header", detail);
  }

 private:
  PlyEncoding encoding_;
  std::string_view rest_;
  std::size_t total_;
};

}  // namespace orrery
