#include "server/http/raw_response.h"

#include <algorithm>

namespace orrery {

bool may_have_body(int status) { return status >= 200 && status != 204 && status != 304; }

std::string header_value(std::string_view value) {
  std::string text(value);
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7F; },
      ' ');
  return text;
}

std::string raw_response(const Response& response) {
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " ";
  text.append(reason_phrase(response.status)).append("\r\n");
  for (const auto& [name, value] : response.headers)
    text.append(name).append(": ").append(header_value(value)).append("\r\n");
  text += "Content-Length: " + std::to_string(response.body.size()) + "\r\nConnection: close\r\n\r\n";
  return text.append(response.body);
}

}  // namespace orrery
