#include "server/http/compression.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string>

#include "server/http/field_list.h"

namespace orrery {
namespace {

constexpr std::size_t kLeast = 1024, kMost = 1 << 20;  // bytes

bool is_text(std::string_view content_type) {
  constexpr std::array<std::string_view, 2> kTypes{"application/json", "image/svg+xml"};
  const std::string_view type = trimmed(content_type.substr(0, content_type.find(';')));
  return starts_with_ignoring_case(type, "text/") || type.ends_with("+json") ||
         std::any_of(kTypes.begin(), kTypes.end(), [&](auto t) { return equal_ignoring_case(t, type); });
}

bool may_compress(std::string_view content_type, std::size_t size) {
  return size >= kLeast && size <= kMost && is_text(content_type);
}

bool takes_gzip(const Request& request) {
  double gzip = -1, any = -1;
  for_each_entry(joined(request.headers, "Accept-Encoding"), ',', [&](std::string_view entry) {
    const std::string_view coding = trimmed(entry.substr(0, entry.find(';')));
    if (equal_ignoring_case(coding, "gzip") || equal_ignoring_case(coding, "x-gzip"))
      gzip = weight_of(entry);
    else if (coding == "*")
      any = weight_of(entry);
  });
  return (gzip < 0 ? any : gzip) > 0;
}

std::string gzip(std::string_view bytes) {
  constexpr int kWindowBits = 15, kGzip = 16, kMemoryLevel = 8;
  z_stream stream{};
  // Fastest level: at 100 MB/s or more, the handler holds its slot for at most 10 ms.
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kWindowBits + kGzip, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::bad_alloc();
  packed.resize(stream.total_out);
  return packed;
}

}  // namespace

SharedBytes gzip_of(std::string_view content_type, std::string_view bytes) {
  if (!may_compress(content_type, bytes.size())) return {};
  std::string packed = gzip(bytes);
  return packed.size() < bytes.size() ? SharedBytes(std::move(packed)) : SharedBytes();
}

void compress(const Request& request, Response& response) {
  const auto header = [&](std::string_view name) { return find_field(response.headers, name).value_or(""); };
  const auto vary = [&] {
    const std::string others = header("Vary");
    response.set("Vary", (others.empty() ? "" : others + ", ") + "Accept-Encoding");
  };
  if (response.status == 304) {  // the client may have cached the compressed body
    const std::string weak = "W/" + header("ETag");
    if (joined(request.headers, "If-None-Match").find(weak) == std::string::npos) return;
    response.set("ETag", weak);
    return vary();
  }
  if (response.stream || !may_compress(header("Content-Type"), response.body.size()) ||
      header("Cache-Control").find("no-store") != std::string::npos)
    return;
  vary();
  if (!takes_gzip(request)) return;
  if (response.gzip.empty()) response.gzip = gzip_of(header("Content-Type"), response.body);
  if (response.gzip.empty()) return;
  response.body = response.gzip;
  response.set("Content-Encoding", "gzip");
  if (const std::string etag = header("ETag"); etag.starts_with('"')) response.set("ETag", "W/" + etag);
}

}  // namespace orrery
