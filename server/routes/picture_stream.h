#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "server/http/message.h"

// Answers of many PNG pictures, one after the other: multipart/x-mixed-replace, which browsers show, or
// application/x-orrery-frames, [length of the header, 4 bytes, big-endian][header, JSON][PNG] each.
namespace orrery {

enum class StreamFormat { multipart, frames };

// What the Accept header likes best. Throws HttpError 406.
StreamFormat negotiate_stream(const Request& request);
// Content-Type, and that nobody between is to keep or gather the pictures.
void set_stream_headers(Response& response, StreamFormat format);

struct StreamedPicture {
  SharedBytes png;
  const nlohmann::ordered_json& header;  // of a frame; its length, "bytes", is added
  Fields fields = {};                    // of a part
  bool last = false;
};

class PictureWriter {
 public:
  PictureWriter(Sink& sink, StreamFormat format) : sink_(sink), format_(format) {}

  // Waits until it is sent. False once the client has gone. Throws OverLimit if too much is being sent
  // already; the picture is then left out.
  bool write(const StreamedPicture& picture);
  // After the last picture that there is.
  void end();

 private:
  bool write_frame(const StreamedPicture& picture);
  // The boundary that ends a part goes with it: a browser shows a picture when it sees the next one.
  bool write_part(const StreamedPicture& picture);

  Sink& sink_;
  const StreamFormat format_;
  bool begun_ = false, ended_ = false;  // the parts
};

}  // namespace orrery
