#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

// Decodes a chunked body (RFC 9112, 7.1) strictly: sizes are hexadecimal digits only, lines end with CR LF.
// Skips extensions and trailers of up to 16 KiB in total.
class ChunkDecoder {
 public:
  explicit ChunkDecoder(const BodyLimit& limit) : limit_(limit) {}

  // Removes all complete elements from the front of `bytes` and appends chunk data to body(). Returns true at
  // the end of the body. Throws HttpError 400 if the chunks are malformed, 413 if the body exceeds the limit.
  bool take(std::string& bytes);

  std::string& body() { return body_; }

 private:
  enum class Expects { size, data, end_of_data, trailer, nothing };

  // Decodes a line or some chunk data at the front of `bytes`. Returns the number of bytes consumed, or 0 if
  // more bytes are needed.
  std::size_t step(std::string_view bytes);
  std::size_t take_size(std::string_view bytes);
  std::size_t take_data(std::string_view bytes);
  std::size_t take_end_of_data(std::string_view bytes);
  std::size_t take_trailer(std::string_view bytes);

  const BodyLimit limit_;
  std::string body_;
  Expects expects_ = Expects::size;
  std::size_t left_ = 0;      // bytes left in the current chunk
  std::size_t overhead_ = 0;  // bytes of extensions and trailers
};

// Returns the 413 error for a body of `bytes` bytes. `bytes` is a text such as "more than 1000".
HttpError body_too_long(const BodyLimit& limit, const std::string& bytes);

}  // namespace orrery
