#pragma once

#include <string_view>

#include "server/http/message.h"

// The content coding gzip (RFC 9110, 8.4.1.3) of answers that are text.
namespace orrery {

// Compresses the body, if the client takes that and it is text of 1 KiB to 1 MiB that may be kept: what may
// not can hold secrets, which the length would give away. Response::gzip is used where it was made before.
// The ETag is then a weak one, as is that of a 304 for a client that has the compressed one. Throws
// std::bad_alloc.
void compress(const Request& request, Response& response);

// What compress() would make of a body of that type, for Response::gzip; empty where it leaves it as it is.
SharedBytes gzip_of(std::string_view content_type, std::string_view bytes);

}  // namespace orrery
