#pragma once

#include <mutex>

#include "server/http/message.h"

namespace orrery {

// The content coding gzip (RFC 9110, 8.4.1.3) of answers that are text. Safe from any thread.
class Compressor {
 public:
  // Compresses the body, if the client takes that and it is text of 1 KiB to 1 MiB that may be kept: what may
  // not can hold secrets, which the length would give away. Its ETag is then a weak one, as is that of a 304
  // for who has the compressed one. One answer at a
  // time: while another is compressed, this one is left as it is, so that nobody can have all processors do
  // that. Throws std::bad_alloc.
  void compress(const Request& request, Response& response);

 private:
  std::mutex busy_;
};

}  // namespace orrery
