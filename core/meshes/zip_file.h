#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;

namespace orrery {

// Limits on the content of an archive.
struct ZipLimits {
  std::size_t entries = 10'000;
  std::uint64_t unpacked_bytes = std::uint64_t{1} << 30;  // sum over the entries that are read
  // Maximum ratio of the sizes of an entry, unpacked to packed. Deflate reaches 1,032. Meshes as text reach
  // 5 to 30.
  std::uint64_t ratio = 200;
};

// Reader of a ZIP archive (APPNOTE 6.3, PKWARE) in memory: entries that are stored or deflated and not
// encrypted. Checks sizes against the limits before it unpacks an entry. Functions throw InputError (pointer
// ""), Cancelled and std::bad_alloc. Not thread-safe.
class ZipFile {
 public:
  // Returns true if the bytes begin like an archive with at least one entry.
  static bool is_zip(std::string_view bytes) { return bytes.starts_with("PK\x03\x04"); }

  // Reads the directory. Throws InputError if the entries together have more packed bytes than the file, as
  // entries that overlap. REQUIRES: `bytes` outlive the reader.
  explicit ZipFile(std::string_view bytes, const ZipLimits& limits = {});

  // Returns the names of the entries in UTF-8, in the order of the archive and without repetitions. Names are
  // not checked: they may be absolute, contain "..", or end with a slash (folders).
  const std::vector<std::string>& names() const { return names_; }
  bool contains(const std::string& name) const { return indices_.contains(name); }

  // Unpacks an entry and verifies its size and CRC-32. Reads the first one if several entries have the name.
  // Throws InputError if there is no such entry, or it is invalid or beyond the limits.
  std::string read(const std::string& name);

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  std::unique_ptr<zip, Discard> archive_;
  ZipLimits limits_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint64_t> indices_;  // by name
  std::uint64_t unpacked_bytes_ = 0;              // sum over the entries that were read
};

}  // namespace orrery
