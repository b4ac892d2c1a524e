#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

// Checks a chunked body (RFC 9112, 7.1) before cpp-httplib decodes it. cpp-httplib 0.11.4 accepts a chunk
// size with a sign, a "0x" or other text around it, takes sizes of 2^64 - 1 and more as the end, and rejects
// trailers. Here, sizes are hexadecimal digits only, lines end with CR LF, and extensions and trailers of up
// to 16 KiB in total are skipped.
class ChunkCheck {
 public:
  explicit ChunkCheck(const BodyLimit& limit) : limit_(limit) {}

  // Removes all complete elements from the front of `bytes` and appends them to `checked`, without extensions
  // and trailers. Throws HttpError 400 if the chunks are malformed, 413 if the body exceeds the limit.
  void pass_on(std::string& bytes, std::string& checked);
  // Whether the end of the body has been passed on.
  bool has_ended() const { return expects_ == Expects::nothing; }

 private:
  enum class Expects { size, data, end_of_data, trailer, nothing };

  // Checks a line or some chunk data at the front of `bytes`. Returns the number of bytes consumed, or 0 if
  // more bytes are needed.
  std::size_t step(std::string_view bytes, std::string& checked);
  std::size_t check_size(std::string_view bytes, std::string& checked);
  std::size_t check_data(std::string_view bytes, std::string& checked);
  std::size_t check_end_of_data(std::string_view bytes, std::string& checked);
  std::size_t check_trailer(std::string_view bytes, std::string& checked);

  const BodyLimit limit_;
  Expects expects_ = Expects::size;
  std::size_t left_ = 0;      // bytes left in the current chunk
  std::size_t body_ = 0;      // bytes of all complete and partial chunks
  std::size_t overhead_ = 0;  // bytes of extensions and trailers
};

// Returns the 413 error for a body of `bytes` bytes. `bytes` is a text such as "more than 1000".
HttpError body_too_long(const BodyLimit& limit, const std::string& bytes);

}  // namespace orrery
