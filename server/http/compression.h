#pragma once

#include <string_view>

#include "server/http/message.h"

// Content coding gzip (RFC 9110, 8.4.1.3) of text responses.
namespace orrery {

// Compresses the body if the client accepts gzip and the response is text of 1 KiB to 1 MiB without
// Cache-Control: no-store. A no-store response may contain secrets, which its compressed length would reveal.
// Uses Response::gzip if it is set. Weakens the ETag of a compressed response, and of a 304 to a client that
// sends the weak ETag. Throws std::bad_alloc.
void compress(const Request& request, Response& response);

// Returns the compressed body for Response::gzip. Returns empty bytes if `bytes` is no text of 1 KiB to 1
// MiB, or if compression would not shrink it.
SharedBytes gzip_of(std::string_view content_type, std::string_view bytes);

}  // namespace orrery
