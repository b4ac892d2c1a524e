#include "server/http/byte_quota.h"

#include <gtest/gtest.h>

#include <optional>

#include "server/http/response_quota.h"

// Tests byte quotas shared by requests and responses.
namespace orrery {
namespace {

TEST(ByteQuota, RejectsGrowthBeyondTotal) {
  ByteQuota budget(100, "some_bytes", "some");
  std::optional<ByteQuota::Share> a(std::in_place, budget, "a");
  ByteQuota::Share b(budget, "b");
  a->grow(60);
  a->grow(50);  // no growth, because `a` has 60
  b.grow(40);
  try {
    b.grow(41);
    FAIL() << "accepted 41 bytes with 40 left";
  } catch (const LimitExceeded& error) {
    EXPECT_STREQ(error.what(), "some use 100 bytes and need 1 more (limit 100, some_bytes)");
    EXPECT_STREQ(error.limit(), "some_bytes");
  }
  a.reset();
  b.grow(100);
}

TEST(ByteQuota, LimitsClientToHalfUnlessItHasOneShare) {
  ByteQuota budget(1'000'000, "some_bytes", "some");
  {
    ByteQuota::Share large(budget, "a"), more(budget, "a"), other(budget, "b");
    large.grow(700'000);
    EXPECT_THROW(more.grow(65'537), ClientLimitExceeded);
    more.grow(65'536);
    EXPECT_THROW(more.grow(65'537), ClientLimitExceeded);
    other.grow(234'464);
    EXPECT_THROW(other.grow(234'465), LimitExceeded);
  }
  ByteQuota::Share first(budget, "a"), second(budget, "a"), third(budget, "a");
  first.grow(200'000);
  second.grow(300'000);
  EXPECT_THROW(third.grow(65'537), ClientLimitExceeded);
  EXPECT_THROW(second.grow(300'001), ClientLimitExceeded);
}

TEST(ResponseQuota, CountsSharedBytesOnce) {
  ResponseQuota budget(200'000);
  const SharedBytes picture(std::string(100'000, 'p')), other(std::string(100'001, 'o'));
  std::vector<ResponseQuota::Share> shares;
  for (const char* client : {"a", "b", "a"}) shares.push_back(budget.take(picture, client));
  EXPECT_THROW(budget.take(other, "c"), LimitExceeded);
  shares.pop_back();
  shares.pop_back();
  EXPECT_THROW(budget.take(other, "c"), LimitExceeded);
  shares.pop_back();
  shares.push_back(budget.take(other, "c"));
}

TEST(ResponseQuota, ExemptsSmallAndSingleResponses) {
  ResponseQuota budget(1);
  const SharedBytes small(std::string(64 * 1024, 's')), large(std::string(64 * 1024 + 1, 'l')),
      other(std::string(64 * 1024 + 1, 'o'));
  EXPECT_EQ(budget.take(small, "a"), nullptr);
  const auto share = budget.take(large, "a");
  EXPECT_EQ(budget.take(small, "b"), nullptr);
  EXPECT_THROW(budget.take(other, "b"), LimitExceeded);
}

TEST(ResponseQuota, LimitsClientToHalf) {
  ResponseQuota budget(400'000);
  const SharedBytes shared(std::string(150'000, 's')), other(std::string(100'000, 'o'));
  auto first = budget.take(shared, "a"), second = budget.take(shared, "b");
  EXPECT_THROW(budget.take(other, "a"), ClientLimitExceeded);
  first.reset();  // a has received its response, b has not
  first = budget.take(other, "a");
  EXPECT_THROW(budget.take(other, "b"), ClientLimitExceeded);
}

}  // namespace
}  // namespace orrery
