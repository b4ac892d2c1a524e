#include "core/meshes/zip_file.h"

#include <zip.h>

#include <algorithm>
#include <new>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::size_t kZipChunk = 1 << 16;       // bytes between two checkpoints
constexpr std::uint64_t kSmallEntry = 64 << 10;  // entries up to this size may have any ratio

[[noreturn]] void fail_zip(const std::string& place, zip_error_t* error) {
  if (zip_error_code_zip(error) == ZIP_ER_MEMORY) throw std::bad_alloc();
  fail_at(place, std::string("cannot read: ") + zip_error_strerror(error));
}

// Throws InputError if the bytes contain the signatures of more directory records than `limit`. Called before
// libzip allocates memory for the records.
void check_records(std::string_view bytes, std::size_t limit) {
  constexpr std::string_view kRecord = "PK\x01\x02";
  std::size_t count = 0;
  for (std::size_t at = bytes.find(kRecord); at != bytes.npos;
       at = bytes.find(kRecord, at + kRecord.size())) {
    checkpoint(count);
    if (++count > limit)
      throw InputError("",
                       "archive has more than " + grouped(limit) + " entries (limit " + grouped(limit) + ")");
  }
}

// Throws InputError if an entry has an unsupported encoding.
void check_encoding(const std::string& place, const zip_stat_t& entry) {
  constexpr std::uint64_t kNeeded =
      ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
  if ((entry.valid & kNeeded) != kNeeded) fail_at(place, "must have sizes and a method");
  if (entry.encryption_method != ZIP_EM_NONE) fail_at(place, "must not be encrypted");
  if (entry.comp_method != ZIP_CM_STORE && entry.comp_method != ZIP_CM_DEFLATE)
    fail_at(place, "must be stored or deflated (got method " + std::to_string(entry.comp_method) + ")");
}

// Throws InputError if an entry unpacks to more than `bytes_left` bytes.
void check_size(const std::string& place, const zip_stat_t& entry, const ZipLimits& limits,
                std::uint64_t bytes_left) {
  if (entry.size > bytes_left)
    fail_at(place, "entries must unpack to at most " + grouped(limits.unpacked_bytes) + " bytes (got " +
                       grouped(limits.unpacked_bytes - bytes_left) + " bytes before this entry of " +
                       grouped(entry.size) + " bytes)");
  if (entry.size > kSmallEntry && entry.size / limits.ratio > entry.comp_size)
    fail_at(place, "must unpack to at most " + grouped(limits.ratio) + " times its size (got " +
                       grouped(entry.size) + " bytes from " + grouped(entry.comp_size) + ")");
}

// Returns the packed size of an entry. Throws InputError if it has more than `bytes_left` bytes: the entry is
// not in the file, or overlaps others, which would let a small file unpack to much.
std::uint64_t packed_size(zip* archive, std::uint64_t index, std::uint64_t bytes_left) {
  zip_stat_t entry;
  if (zip_stat_index(archive, index, 0, &entry) < 0 || !(entry.valid & ZIP_STAT_COMP_SIZE)) return 0;
  if (entry.comp_size > bytes_left)
    fail_at("entry " + std::to_string(index + 1),
            "packed entries must not overlap, or have more bytes than the file (got " +
                grouped(entry.comp_size) + " bytes, of which " + grouped(bytes_left) + " are left)");
  return entry.comp_size;
}

class ZipError {
 public:
  ZipError() { zip_error_init(&error_); }
  ~ZipError() { zip_error_fini(&error_); }
  ZipError(const ZipError&) = delete;
  zip_error_t* get() { return &error_; }

 private:
  zip_error_t error_;
};

struct CloseEntry {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

void ZipFile::Discard::operator()(zip* archive) const { zip_discard(archive); }

ZipFile::ZipFile(std::string_view bytes, const ZipLimits& limits) : limits_(limits) {
  check_records(bytes, limits.entries);
  ZipError error;
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, error.get());
  if (!source) fail_zip("archive", error.get());
  archive_.reset(zip_open_from_source(source, ZIP_RDONLY, error.get()));
  if (!archive_) {
    zip_source_free(source);
    fail_zip("archive", error.get());
  }
  const auto count = zip_get_num_entries(archive_.get(), 0);
  std::uint64_t packed_bytes = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    checkpoint();
    const auto index = static_cast<std::uint64_t>(i);
    packed_bytes += packed_size(archive_.get(), index, bytes.size() - packed_bytes);
    const char* name = zip_get_name(archive_.get(), index, ZIP_FL_ENC_GUESS);
    if (name && indices_.emplace(name, index).second) names_.emplace_back(name);
  }
}

std::string ZipFile::read(const std::string& name) {
  const std::string place = "entry " + excerpt(name, 80);
  const auto found = indices_.find(name);
  if (found == indices_.end()) fail_at(place, "missing in the archive");
  zip_stat_t entry;
  if (zip_stat_index(archive_.get(), found->second, 0, &entry) < 0)
    fail_zip(place, zip_get_error(archive_.get()));
  check_encoding(place, entry);
  check_size(place, entry, limits_, limits_.unpacked_bytes - unpacked_bytes_);
  const std::unique_ptr<zip_file_t, CloseEntry> file(zip_fopen_index(archive_.get(), found->second, 0));
  if (!file) fail_zip(place, zip_get_error(archive_.get()));

  std::string content(entry.size, '\0');
  std::size_t size = 0;
  for (char beyond = 0;;) {  // reads past the last byte, where libzip verifies the checksum
    checkpoint();
    const bool is_full = size == content.size();
    const std::int64_t got =
        is_full ? zip_fread(file.get(), &beyond, 1)
                : zip_fread(file.get(), &content[size], std::min(kZipChunk, content.size() - size));
    if (got < 0) fail_zip(place, zip_file_get_error(file.get()));
    if (got == 0) break;
    if (is_full) fail_at(place, "must have " + grouped(entry.size) + " bytes (got more)");
    size += static_cast<std::size_t>(got);
  }
  if (size < content.size())
    fail_at(place, "must have " + grouped(entry.size) + " bytes (got " + grouped(size) + ")");
  unpacked_bytes_ += size;
  return content;
}

}  // namespace orrery
