#pragma once

#include <string_view>

#include "server/http/message.h"

// Content coding gzip (RFC 9110, 8.4.1.3) of text responses.
namespace orrery {

// Compresses the body if the client accepts gzip and the response is text of 1 KiB to 1 MiB without
// Cache-Control: no-store. A no-store response may hold secrets that the compressed length would reveal. Uses
// Response::gzip if it is set. Makes the ETag weak, as well as the ETag of a 304 for a client that cached the
// compressed body. Throws std::bad_alloc.
void compress(const Request& request, Response& response);

// Returns the value for Response::gzip: the compressed body, or empty bytes if it would stay uncompressed.
SharedBytes gzip_of(std::string_view content_type, std::string_view bytes);

}  // namespace orrery
