#include "server/routes/picture_stream.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"

namespace orrery {
namespace {

constexpr std::string_view kMultipart = "multipart/x-mixed-replace", kFrames = "application/x-orrery-frames";
constexpr std::string_view kBoundary = "orrery-frame";
constexpr std::string_view kDelimiter = "\r\n--orrery-frame";

}  // namespace

StreamFormat negotiate_stream(const Request& request) {
  return negotiate(request, std::array{kMultipart, kFrames}) == kMultipart ? StreamFormat::multipart
                                                                           : StreamFormat::frames;
}

Operation::Answer stream_answer(const std::string& description, const std::string& schema,
                                ResultOutput parts) {
  std::string names;
  for (const ImageResult& row : image_results())
    if (row.in.*parts && !row.header.empty()) names += (names.empty() ? "" : ", ") + std::string(row.header);
  return {
      .status = 200,
      .description =
          description +
          "The header of a frame has the results of its image as members, described in components.schemas." +
          schema + ". Headers of a part with results: " + names,
      .headers = {"Orrery-Warning"},
      .content = {{kMultipart}, {kFrames}}};
}

void set_stream_headers(Response& response, StreamFormat format) {
  response.set("Content-Type", format == StreamFormat::multipart
                                   ? std::string(kMultipart) + "; boundary=" + std::string(kBoundary)
                                   : std::string(kFrames));
  response.set("Cache-Control", "no-store").set("Vary", "Accept").set("X-Accel-Buffering", "no");
}

bool PictureWriter::write(const StreamedPicture& picture) {
  return format_ == StreamFormat::multipart ? write_part(picture) : write_frame(picture);
}

bool PictureWriter::write_frame(const StreamedPicture& picture) {
  nlohmann::ordered_json header = picture.header;
  header["bytes"] = picture.png.size();
  const std::string text = header.dump();
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(text.size() >> shift & 0xFF);
  return sink_.write(bytes + text, picture.png);
}

bool PictureWriter::write_part(const StreamedPicture& picture) {
  const std::string delimiter(kDelimiter);
  if (!begun_ && !sink_.write(delimiter.substr(2) + "\r\n")) return false;
  begun_ = true;
  std::string head =
      "Content-Type: image/png\r\nContent-Length: " + std::to_string(picture.png.size()) + "\r\n";
  for (const auto& [name, value] : picture.fields) head += name + ": " + value + "\r\n";
  const bool sent = sink_.write(head + "\r\n", picture.png, delimiter + (picture.last ? "--\r\n" : "\r\n"));
  ended_ = sent && picture.last;
  return sent;
}

void PictureWriter::end() {
  if (format_ == StreamFormat::multipart && !ended_) sink_.write(std::string(kDelimiter) + "--\r\n");
}

}  // namespace orrery
