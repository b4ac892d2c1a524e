#include "server/http/chunk_check.h"

#include <charconv>
#include <optional>

#include "core/base/shorten.h"
#include "server/http/framing_check.h"

namespace orrery {
namespace {

constexpr std::size_t kLongestLine = 256, kMaxOverhead = 16 * 1024;

[[noreturn]] void refuse(const std::string& why) {
  throw HttpError(400, "malformed chunked request body: " + why);
}

[[noreturn]] void refuse_overhead() {
  refuse("extensions and trailers must have at most " + grouped(kMaxOverhead) + " bytes in total");
}

// Returns the first line without its CR LF, or nullopt if it is incomplete.
std::optional<std::string_view> line_of(std::string_view bytes) {
  const std::size_t end = bytes.find("\r\n");
  const std::string_view line = bytes.substr(0, end);
  if (line.size() > kLongestLine) refuse("line must have at most " + grouped(kLongestLine) + " bytes");
  const bool whole = end != std::string_view::npos;
  if (!is_field_text(line.substr(0, line.size() - (!whole && line.ends_with('\r')))))
    refuse("line must not contain control characters");
  return whole ? std::optional(line) : std::nullopt;
}

}  // namespace

HttpError body_too_long(const BodyLimit& limit, const std::string& bytes) {
  return {413,
          "request body has " + bytes + " bytes (limit " + grouped(limit.bytes) + ", " + limit.name + ")",
          {},
          limit.name};
}

void ChunkCheck::pass_on(std::string& bytes, std::string& checked) {
  std::size_t passed = 0;
  while (expects_ != Expects::nothing) {
    const std::size_t count = step(std::string_view(bytes).substr(passed), checked);
    if (count == 0) break;
    passed += count;
  }
  bytes.erase(0, passed);
}

std::size_t ChunkCheck::step(std::string_view bytes, std::string& checked) {
  switch (expects_) {
    case Expects::size: return check_size(bytes, checked);
    case Expects::data: return check_data(bytes, checked);
    case Expects::end_of_data: return check_end_of_data(bytes, checked);
    case Expects::trailer: return check_trailer(bytes, checked);
    case Expects::nothing: break;
  }
  return 0;
}

std::size_t ChunkCheck::check_size(std::string_view bytes, std::string& checked) {
  const auto line = line_of(bytes);
  if (!line) return 0;
  const auto [end, problem] = std::from_chars(line->data(), line->data() + line->size(), left_, 16);
  const std::string_view extension(end, static_cast<std::size_t>(line->data() + line->size() - end));
  if (problem != std::errc() || !(extension.empty() || extension.front() == ';'))
    refuse("chunk size must be hexadecimal digits");
  if ((overhead_ += extension.size()) > kMaxOverhead) refuse_overhead();
  if (left_ > limit_.bytes - body_) throw body_too_long(limit_, "more than " + grouped(limit_.bytes));
  body_ += left_;
  expects_ = left_ > 0 ? Expects::data : Expects::trailer;
  if (left_ > 0) checked.append(line->data(), end).append("\r\n");
  return line->size() + 2;
}

std::size_t ChunkCheck::check_data(std::string_view bytes, std::string& checked) {
  const std::string_view data = bytes.substr(0, left_);
  checked += data;
  left_ -= data.size();
  if (left_ == 0) expects_ = Expects::end_of_data;
  return data.size();
}

std::size_t ChunkCheck::check_end_of_data(std::string_view bytes, std::string& checked) {
  if (!std::string_view("\r\n").starts_with(bytes.substr(0, 2))) refuse("CR LF must follow the chunk data");
  if (bytes.size() < 2) return 0;
  expects_ = Expects::size;
  checked += "\r\n";
  return 2;
}

std::size_t ChunkCheck::check_trailer(std::string_view bytes, std::string& checked) {
  const auto line = line_of(bytes);
  if (!line) return 0;
  if (line->empty()) {
    expects_ = Expects::nothing;
    checked += "0\r\n\r\n";
    return 2;
  }
  if (!is_token(line->substr(0, line->find(':'))) || line->find(':') == std::string_view::npos)
    refuse("trailer must be NAME: VALUE");
  if ((overhead_ += line->size()) > kMaxOverhead) refuse_overhead();
  return line->size() + 2;
}

}  // namespace orrery
