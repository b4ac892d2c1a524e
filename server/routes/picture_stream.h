#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "server/api/results.h"
#include "server/http/message.h"
#include "server/routes/operation.h"

// Streams of PNG images in one of two formats. Browsers can show multipart/x-mixed-replace.
// application/x-orrery-frames is a sequence of [header length: 4 bytes, big-endian][header: JSON][PNG].
namespace orrery {

enum class StreamFormat { multipart, frames };

// Returns the format that the Accept header prefers. Throws HttpError 406 if it allows neither.
StreamFormat negotiate_stream(const Request& request);
// Sets Content-Type and the headers that keep proxies from caching and buffering.
void set_stream_headers(Response& response, StreamFormat format);
// Returns the description of a response with a stream. `schema`: component with the results in the header of
// a frame. `parts`: output with the results in the headers of a part.
Operation::Answer stream_answer(const std::string& description, const std::string& schema,
                                ResultOutput parts);

struct StreamedPicture {
  SharedBytes png;
  const nlohmann::ordered_json& header;  // for `frames`; the PNG length, "bytes", is added
  Fields fields = {};                    // for `multipart`
  bool last = false;
};

class PictureWriter {
 public:
  PictureWriter(Sink& sink, StreamFormat format) : sink_(sink), format_(format) {}

  // Writes an image and waits until it is sent. Returns false if the client has disconnected. Throws
  // LimitExceeded, without sending the image, if too many response bytes are being sent.
  bool write(const StreamedPicture& picture);
  // Ends the stream after the last image.
  void end();

 private:
  bool write_frame(const StreamedPicture& picture);
  // Writes a part together with its closing boundary, since browsers show a part only at the next boundary.
  bool write_part(const StreamedPicture& picture);

  Sink& sink_;
  const StreamFormat format_;
  bool begun_ = false, ended_ = false;  // state of the multipart body
};

}  // namespace orrery
