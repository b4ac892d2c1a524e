#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

// Reads a body in chunks (RFC 9112, 7.1), strictly: sizes are hexadecimal digits alone, lines end with CR LF.
// Extensions and trailers are skipped, a few bytes of them.
class ChunkDecoder {
 public:
  explicit ChunkDecoder(const BodyLimit& limit) : limit_(limit) {}

  // Moves what is understood from the front of `bytes` to the body. Returns whether that is its end. Throws
  // HttpError 400 for what are no chunks, 413 for more than the limit.
  bool take(std::string& bytes);

  std::string& body() { return body_; }

 private:
  enum class Expects { size, data, end_of_data, trailer, nothing };

  // One step from the front of `bytes`; returns how many it took, 0: it needs more.
  std::size_t step(std::string_view bytes);
  std::size_t take_size(std::string_view bytes);
  std::size_t take_data(std::string_view bytes);
  std::size_t take_end_of_data(std::string_view bytes);
  std::size_t take_trailer(std::string_view bytes);

  const BodyLimit limit_;
  std::string body_;
  Expects expects_ = Expects::size;
  std::size_t left_ = 0;      // of the chunk
  std::size_t overhead_ = 0;  // bytes of extensions and trailers
};

// What is thrown for a body of so many bytes, or of more than the limit if that is all that is known.
HttpError body_too_long(const BodyLimit& limit, const std::string& bytes);

}  // namespace orrery
