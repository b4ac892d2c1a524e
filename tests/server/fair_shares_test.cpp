#include "server/base/fair_shares.h"

#include <gtest/gtest.h>

#include <random>

// Tests which entries a full store evicts.
namespace orrery {
namespace {

using std::chrono::seconds;
using Ids = std::vector<std::string>;

class FairSharesTest : public testing::Test {
 protected:
  static constexpr std::size_t kMost = 100;

  // Adds an entry and records the evicted entries. Returns false if the entry does not fit.
  bool add(const std::string& client, const std::string& id, std::size_t weight, FairShares::Rank rank = 0,
           FairShares::Ranks ranks = {}) {
    const auto evicted = shares_.make_room(client, weight, kMost, ranks);
    if (!evicted) return false;
    evicted_.insert(evicted_.end(), evicted->begin(), evicted->end());
    shares_.hold(id, client, rank);
    shares_.set_weight(id, weight);
    return true;
  }
  Ids evicted() { return std::exchange(evicted_, {}); }

  Clock::time_point now_{};
  FairShares shares_{seconds(60), [this] { return now_; }};

 private:
  Ids evicted_;
};

TEST_F(FairSharesTest, EvictsLeastRecentlyUsedEntries) {
  for (const char* id : {"a", "b", "c"}) add("x", id, 30);
  shares_.touch("a");
  EXPECT_TRUE(add("x", "d", 30));
  EXPECT_EQ(evicted(), Ids{"b"});
  EXPECT_TRUE(add("x", "e", 60));
  EXPECT_EQ(evicted(), (Ids{"c", "a"}));
  EXPECT_EQ(shares_.weight(), 90U);
}

TEST_F(FairSharesTest, EvictsOnlyFromFloodingClient) {
  add("victim", "v", 10);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(add("flood", std::to_string(i), 1 + i % 7));
    EXPECT_LE(shares_.weight(), kMost);
  }
  EXPECT_TRUE(shares_.holds("v", "victim"));
  const Ids lost = evicted();
  EXPECT_GT(lost.size(), 900U);
  EXPECT_EQ(lost[0], "0");
  EXPECT_EQ(lost[1], "1");
}

TEST_F(FairSharesTest, EvictsFromClientWithMost) {
  for (int i = 0; i < 8; ++i) add("most", "m" + std::to_string(i), 10);
  add("less", "l", 20);
  EXPECT_TRUE(add("new", "n", 30));
  EXPECT_EQ(evicted(), (Ids{"m0", "m1", "m2"}));
  EXPECT_TRUE(add("new", "o", 10));
  EXPECT_EQ(evicted(), Ids{"m3"});
  EXPECT_TRUE(add("new", "p", 10)) << "it would have 50 and \"most\" 40";
  EXPECT_EQ(evicted(), Ids{"n"});
}

TEST_F(FairSharesTest, RejectsEntryLargerThanOtherShares) {
  add("a", "a1", 20);
  add("a", "a2", 20);
  add("b", "b", 40);
  add("new", "n", 20);
  EXPECT_FALSE(add("new", "large", 45));
  EXPECT_EQ(evicted(), Ids{});
  for (const char* id : {"a1", "a2"}) EXPECT_TRUE(shares_.holds(id, "a")) << id;
  EXPECT_TRUE(shares_.holds("n", "new")) << "a rejected entry evicts nothing";
  EXPECT_EQ(shares_.weight(), 100U);
  EXPECT_TRUE(add("a", "a3", 10));
  EXPECT_EQ(evicted(), Ids{"a1"}) << "a rejected entry does not change the order";
}

TEST_F(FairSharesTest, RemovesEntryWithItsLastHolder) {
  add("a", "shared", 30);
  shares_.hold("shared", "b");
  EXPECT_EQ(shares_.weight(), 30U);
  add("b", "more", 70);
  EXPECT_TRUE(add("c", "c", 30));  // b has 100 and loses both, a has 30 and keeps the shared entry
  EXPECT_EQ(evicted(), Ids{"more"});
  EXPECT_TRUE(shares_.holds("shared", "a"));
  EXPECT_FALSE(shares_.holds("shared", "b"));
  shares_.hold("shared", "b");
  EXPECT_FALSE(shares_.release("shared", "a"));
  EXPECT_FALSE(shares_.release("shared", "a"));
  EXPECT_TRUE(shares_.release("shared", "b"));
  EXPECT_EQ(shares_.weight(), 30U) << "only the entry of c is left";
}

TEST_F(FairSharesTest, EvictsLowRanksFirst) {
  add("x", "kept", 30, 2);
  add("x", "cached", 30, 0);
  add("x", "kept too", 30, 2);
  add("x", "more", 40, 0, {.own = 1, .others = 1});
  EXPECT_EQ(evicted(), Ids{"cached"});
  EXPECT_FALSE(add("x", "cached", 50, 0, {.own = 1, .others = 1}));
  EXPECT_FALSE(add("y", "cached", 30, 0, {.own = 1, .others = 0}));
  EXPECT_TRUE(add("y", "cached", 30, 0, {.own = 1, .others = 1}));
  EXPECT_EQ(evicted(), Ids{"more"});
  EXPECT_TRUE(add("y", "y", 20, 2));
  EXPECT_EQ(evicted(), Ids{"kept"}) << "x has the most";
  shares_.hold("kept too", "y", 1);
  EXPECT_EQ(shares_.rank("kept too"), 2U);
  EXPECT_EQ(shares_.rank("kept too", "y"), 1U);
  EXPECT_EQ(shares_.rank("kept too", "z"), std::nullopt);
}

TEST_F(FairSharesTest, EvictsStaleEntriesFirst) {
  add("left", "l1", 10);
  add("left", "l2", 10);
  add("left", "l3", 10);
  add("x", "x1", 60);
  now_ += seconds(60);
  shares_.touch("l1");
  EXPECT_TRUE(add("x", "x2", 20));
  EXPECT_EQ(evicted(), Ids{"x1"}) << "x has the most, and no entry is stale yet";
  add("x", "x3", 40);
  now_ += seconds(1);
  EXPECT_TRUE(add("x", "x4", 25));
  EXPECT_EQ(evicted(), (Ids{"l2", "l3"}));
}

// A client that loses an entry has at least an equal share of the store, before and after the eviction.
TEST_F(FairSharesTest, NeverEvictsBelowEqualShare) {
  std::mt19937 random(1);
  std::map<std::string, std::map<std::string, std::size_t>> model;  // client, id
  const auto held = [&](const std::string& client) {
    std::size_t sum = 0;
    for (const auto& [id, weight] : model[client]) sum += weight;
    return sum;
  };
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string client(1, static_cast<char>('a' + random() % 5)), id = std::to_string(i);
    const std::size_t weight = 1 + random() % (client == "a" ? 40 : 8);
    if (random() % 3 == 0 && i > 10) shares_.touch(std::to_string(i - 1 - static_cast<int>(random() % 10)));
    if (!add(client, id, weight)) {
      ++refused;
      continue;
    }
    model[client][id] = weight;
    for (const std::string& lost : evicted())
      for (auto& [loser, entries] : model)
        if (entries.count(lost) > 0) {
          EXPECT_GE(held(loser), held(client)) << "the adding client must lose entries first";
          EXPECT_GE(held(loser) * 5, kMost) << loser;
          entries.erase(lost);
          break;
        }
    std::size_t all = 0;
    for (const auto& [some, entries] : model) all += held(some);
    ASSERT_EQ(shares_.weight(), all);
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace orrery
