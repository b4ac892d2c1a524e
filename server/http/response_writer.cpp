#include "server/http/response_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "server/scheduler/handler_slots.h"

namespace orrery {
namespace {

// Whether a response with this status may have a body (RFC 9110, 6.4.1).
bool may_have_body(int status) { return status >= 200 && status != 204 && status != 304; }

bool is_streamed(const Response& response, const Framing& framing) {
  return response.stream && has_body(response, framing);
}

void append_header(std::string& text, std::string_view name, std::string_view value) {
  text.append(name).append(": ");
  std::transform(value.begin(), value.end(), std::back_inserter(text), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F ? ' ' : c;
  });
  text += "\r\n";
}

// Writes a body in chunks, or without framing up to the end of the connection (RFC 9112, 7.1 and 6.3).
class BodySink final : public Sink {
 public:
  BodySink(Connection& connection, bool chunked, const Sender& sender)
      : connection_(connection), chunked_(chunked), sender_(sender) {}

  bool write(std::string_view bytes, const SharedBytes& more, std::string_view end) override {
    if (sender_.gone.stop_requested()) return whole_ = false;
    const std::size_t count = bytes.size() + more.size() + end.size();
    if (count == 0) return whole_;  // an empty chunk would end the body
    HandlerSlots::yield();
    const auto share = sender_.answers.take(more, sender_.client);
    if (!chunked_) return whole_ = whole_ && connection_.write({bytes, more, end});
    std::array<char, 20> text;
    const std::string_view size(text.data(),
                                std::to_chars(text.data(), text.data() + text.size(), count, 16).ptr);
    return whole_ = whole_ && connection_.write({size, "\r\n", bytes, more, end, "\r\n"});
  }
  // Ends the body. Returns whether all of it was written.
  bool finish() {
    return whole_ && !sender_.gone.stop_requested() && (!chunked_ || connection_.write({"0\r\n\r\n"}));
  }

 private:
  Connection& connection_;
  const bool chunked_;
  const Sender& sender_;
  bool whole_ = true;  // all writes succeeded
};

}  // namespace

bool has_body(const Response& response, const Framing& framing) {
  return !framing.head_only && may_have_body(response.status);
}

std::string response_head(const Response& response, const Framing& framing) {
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " ";
  text.append(reason_phrase(response.status)).append("\r\n");
  for (const auto& [name, value] : response.headers) append_header(text, name, value);
  if (is_streamed(response, framing)) {
    if (framing.minor_version == 1) append_header(text, "Transfer-Encoding", "chunked");
  } else if (!response.stream && may_have_body(response.status)) {
    // A route may answer HEAD without creating the body. Its length is then unknown, not 0.
    const bool unknown = framing.head_only && response.body.empty();
    if (!unknown) append_header(text, "Content-Length", std::to_string(response.body.size()));
  }
  if (!framing.keep_alive)
    append_header(text, "Connection", "close");
  else if (framing.minor_version == 0)
    append_header(text, "Connection", "keep-alive");
  return text + "\r\n";
}

bool write_response(Connection& connection, Response& response, const Framing& framing,
                    const Sender& sender) {
  const std::string head = response_head(response, framing);
  if (!is_streamed(response, framing)) {
    if (!has_body(response, framing)) return connection.write({head});
    return connection.write({head, response.body});
  }
  if (!connection.write({head})) return false;
  BodySink sink(connection, framing.minor_version == 1, sender);
  try {
    response.stream(sink);
  } catch (const std::exception& error) {
    response.note = error.what();
    if (framing.minor_version == 0) connection.reset_on_close();  // a normal close would end the body
    return false;
  }
  return sink.finish();
}

}  // namespace orrery
