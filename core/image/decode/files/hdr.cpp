#include <charconv>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/image/decode/picture_file.h"

namespace orrery {
namespace {

// Returns the next number in the text, such as 512 in "-Y 512 +X 1024", and removes the text up to the end of
// the number. Returns the maximum value if the number is too large. `offset` is the position of the line in
// the file, in bytes.
std::uint64_t side(std::string_view& text, std::size_t offset) {
  const std::size_t digits = text.find_first_of("0123456789");
  if (digits == std::string_view::npos) fail_damaged(offset, "size must have the form -Y 512 +X 1024");
  std::uint64_t value = 0;
  const auto read = std::from_chars(text.data() + digits, text.data() + text.size(), value);
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  return read.ec == std::errc() ? value : ~std::uint64_t{0};
}

}  // namespace

// Reads text lines up to an empty line, then the line with the size: "-Y height +X width".
void inspect_hdr(std::string_view bytes, PictureFile& file) {
  constexpr std::size_t kMaxHeader = 1 << 16;  // bytes
  const std::size_t end = bytes.substr(0, kMaxHeader).find("\n\n");
  if (end == std::string_view::npos) {
    if (bytes.size() < kMaxHeader) fail_damaged(bytes.size(), "data ends early (size is missing)");
    throw InputError(
        "", "header has more than " + grouped(kMaxHeader) + " bytes (limit " + grouped(kMaxHeader) + ")");
  }
  ByteReader reader(bytes, end + 2);
  const std::size_t offset = reader.offset();
  std::string_view size = reader.take_until('\n');
  const bool rows_first = size.find('Y') < size.find('X');
  const std::uint64_t first = side(size, offset), second = side(size, offset);
  file.height = rows_first ? first : second;
  file.width = rows_first ? second : first;
  file.channels = 3;
  file.keep(bytes);
}

}  // namespace orrery
