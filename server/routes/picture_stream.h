#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "server/http/message.h"

// Streams of PNG pictures, either multipart/x-mixed-replace, which browsers can show, or
// application/x-orrery-frames: [length of the header, 4 bytes, big-endian][header, JSON][PNG] for each
// picture.
namespace orrery {

enum class StreamFormat { multipart, frames };

// Returns the preferred format of the Accept header. Throws HttpError 406.
StreamFormat negotiate_stream(const Request& request);
// Sets Content-Type and the headers that keep proxies from caching and buffering.
void set_stream_headers(Response& response, StreamFormat format);

struct StreamedPicture {
  SharedBytes png;
  const nlohmann::ordered_json& header;  // for `frames`; the PNG length, "bytes", is added
  Fields fields = {};                    // for `multipart`
  bool last = false;
};

class PictureWriter {
 public:
  PictureWriter(Sink& sink, StreamFormat format) : sink_(sink), format_(format) {}

  // Writes a picture and waits until it is sent. Returns false if the client has disconnected. Throws
  // LimitExceeded without sending it if too many response bytes are being sent.
  bool write(const StreamedPicture& picture);
  // Ends the stream after the last picture.
  void end();

 private:
  bool write_frame(const StreamedPicture& picture);
  // Writes a part together with its closing boundary, since browsers show a part only at the next boundary.
  bool write_part(const StreamedPicture& picture);

  Sink& sink_;
  const StreamFormat format_;
  bool begun_ = false, ended_ = false;  // multipart body
};

}  // namespace orrery
