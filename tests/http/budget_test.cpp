#include "server/http/budget.h"

#include <gtest/gtest.h>

#include <optional>

#include "server/http/answer_budget.h"

// Bytes that requests and answers take together.
namespace orrery {
namespace {

TEST(Budget, SharesTakeNoMoreThanThereIs) {
  Budget budget(100, "some_bytes", "Some");
  std::optional<Budget::Share> a(std::in_place, budget, "a");
  Budget::Share b(budget, "b");
  a->grow(60);
  a->grow(50);  // has them
  b.grow(40);
  try {
    b.grow(41);
    FAIL() << "41 bytes of 40";
  } catch (const OverLimit& error) {
    EXPECT_STREQ(error.what(),
                 "Some take 100 bytes already, of at most 100 (some_bytes), and 1 more are needed");
    EXPECT_STREQ(error.limit(), "some_bytes");
  }
  a.reset();
  b.grow(100);
}

TEST(Budget, AClientHasHalfOrOneShare) {
  Budget budget(1'000'000, "some_bytes", "Some");
  {
    Budget::Share large(budget, "a"), more(budget, "a"), other(budget, "b");
    large.grow(700'000);
    EXPECT_THROW(more.grow(65'537), ClientBusy);
    more.grow(65'536);
    EXPECT_THROW(more.grow(65'537), ClientBusy);
    other.grow(234'464);
    EXPECT_THROW(other.grow(234'465), OverLimit);
  }
  Budget::Share first(budget, "a"), second(budget, "a"), third(budget, "a");
  first.grow(200'000);
  second.grow(300'000);
  EXPECT_THROW(third.grow(65'537), ClientBusy);
  EXPECT_THROW(second.grow(300'001), ClientBusy);
}

TEST(AnswerBudget, BytesThatManyShareCountOnce) {
  AnswerBudget budget(200'000);
  const SharedBytes picture(std::string(100'000, 'p')), other(std::string(100'001, 'o'));
  std::vector<AnswerBudget::Share> shares;
  for (const char* client : {"a", "b", "a"}) shares.push_back(budget.take(picture, client));
  EXPECT_THROW(budget.take(other, "c"), OverLimit);
  shares.pop_back();
  shares.pop_back();
  EXPECT_THROW(budget.take(other, "c"), OverLimit);
  shares.pop_back();
  shares.push_back(budget.take(other, "c"));
}

TEST(AnswerBudget, SmallAnswersAreFreeAndOneMayHaveAnySize) {
  AnswerBudget budget(1);
  const SharedBytes small(std::string(64 * 1024, 's')), large(std::string(64 * 1024 + 1, 'l')),
      other(std::string(64 * 1024 + 1, 'o'));
  EXPECT_EQ(budget.take(small, "a"), nullptr);
  const auto share = budget.take(large, "a");
  EXPECT_EQ(budget.take(small, "b"), nullptr);
  EXPECT_THROW(budget.take(other, "b"), OverLimit);
}

TEST(AnswerBudget, AClientIsSentHalfAndPaysForWhatItIsSentAlone) {
  AnswerBudget budget(400'000);
  const SharedBytes shared(std::string(150'000, 's')), other(std::string(100'000, 'o'));
  auto first = budget.take(shared, "a"), second = budget.take(shared, "b");
  EXPECT_THROW(budget.take(other, "a"), ClientBusy);
  first.reset();  // a is sent nothing any more, though b is
  first = budget.take(other, "a");
  EXPECT_THROW(budget.take(other, "b"), ClientBusy);
}

}  // namespace
}  // namespace orrery
