#include "core/meshes/zip_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/writers.h"
#include "tests/support/errors.h"

namespace orrery::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Returns the error of opening an archive and reading an entry, or "accepted".
std::string zip_problem(const std::string& bytes, const std::string& name, const ZipLimits& limits = {}) {
  return error_of([&] { ZipFile(bytes, limits).read(name); });
}

// "aaaa...", 1,000 times, deflated by zlib at level 9 without a header.
const std::string kDeflated = std::string("\x4b\x4c\x1c\x05\xa3\x60\x14\x0c\x77\x00\x00", 11);

TEST(ZipFile, ReadsStoredAndDeflatedEntries) {
  const std::string bytes =
      Zip().add("a/b.txt", "hello").add("empty", "").add("c", std::string(1000, 'a'), kDeflated, 8).bytes();
  ZipFile zip(bytes);
  EXPECT_THAT(zip.names(), ElementsAre("a/b.txt", "empty", "c"));
  EXPECT_EQ(zip.read("a/b.txt"), "hello");
  EXPECT_EQ(zip.read("empty"), "");
  EXPECT_EQ(zip.read("c"), std::string(1000, 'a'));
  EXPECT_TRUE(zip.contains("c"));
  EXPECT_FALSE(zip.contains("C"));
}

TEST(ZipFile, ReadsTheFirstOfEntriesWithOneName) {
  const std::string bytes = Zip().add("a", "first").add("a", "second").bytes();
  ZipFile zip(bytes);
  EXPECT_THAT(zip.names(), ElementsAre("a"));
  EXPECT_EQ(zip.read("a"), "first");
}

TEST(ZipFile, RejectsInvalidArchives) {
  const std::string good = Zip().add("a", "hello").bytes();
  EXPECT_EQ(zip_problem(good, "a"), "accepted");
  EXPECT_THAT(zip_problem(good, "b"), HasSubstr("entry \"b\": missing in the archive"));
  for (std::size_t size = 1; size < good.size(); ++size)
    EXPECT_THAT(zip_problem(good.substr(0, size), "a"), HasSubstr("archive: cannot read")) << size;
  std::string damaged = good;
  damaged[damaged.find("hello")] = 'j';
  EXPECT_THAT(zip_problem(damaged, "a"), HasSubstr("entry \"a\": cannot read: CRC error"));
  EXPECT_THAT(zip_problem(Zip().add("a", "content", "packed", 12).bytes(), "a"),
              HasSubstr("must be stored or deflated (got method 12)"));
}

TEST(ZipFile, RejectsEntriesOfAnotherSizeThanTheirRecord) {
  const std::string content(1000, 'a');
  EXPECT_THAT(zip_problem(Zip().add("a", content + "a", kDeflated, 8).bytes(), "a"),
              HasSubstr("entry \"a\""));
  EXPECT_THAT(zip_problem(Zip().add("a", content.substr(1), kDeflated, 8).bytes(), "a"),
              HasSubstr("entry \"a\""));
}

// Two records of the directory refer to the same bytes.
TEST(ZipFile, RejectsEntriesThatOverlap) {
  std::string bytes = Zip().add("a", std::string(1000, 'x')).bytes();
  EXPECT_EQ(zip_problem(bytes, "a"), "accepted");
  const std::size_t first = bytes.find("PK\1\2"), size = bytes.find("PK\5\6") - first;
  bytes.insert(first, bytes.substr(first, size));
  const std::size_t end = bytes.size() - 22;  // number of records, twice, and their size
  bytes[end + 8] = bytes[end + 10] = 2;
  bytes[end + 12] = static_cast<char>(2 * size);
  EXPECT_THAT(zip_problem(bytes, "a"), HasSubstr("entry 2: packed entries must not overlap"));
}

TEST(ZipFile, ChecksLimitsBeforeUnpacking) {
  const std::string two = Zip().add("a", "hello").add("b", "world").bytes();
  EXPECT_THAT(zip_problem(two, "a", {.entries = 1}), HasSubstr("archive has more than 1 entries (limit 1)"));
  EXPECT_EQ(zip_problem(two, "a", {.entries = 2, .unpacked_bytes = 5}), "accepted");
  EXPECT_THAT(zip_problem(two, "a", {.unpacked_bytes = 4}), HasSubstr("at most 4 bytes (got 0 bytes before"));
  ZipFile zip(two, {.unpacked_bytes = 9});
  zip.read("a");
  EXPECT_THROW(zip.read("b"), InputError);
  // The packed bytes are invalid, which only an attempt to unpack them reports.
  EXPECT_THAT(
      zip_problem(Zip().add("a", std::string(1'000'000, 'a'), std::string(1000, '\xff'), 8).bytes(), "a"),
      HasSubstr("must unpack to at most 200 times its size (got 1,000,000 bytes from 1,000)"));
}

}  // namespace
}  // namespace orrery::test
