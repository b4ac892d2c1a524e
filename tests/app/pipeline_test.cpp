#include "server/app/pipeline.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/error.h"
#include "server/app/work_memory.h"
#include "tests/support/pictures.h"

// Frames count as memory of whom they are made for, from their encoding until they are thrown away.
namespace orrery {
namespace {

constexpr std::size_t kMega = 1 << 20;

class PipelineMemory : public testing::Test {
 protected:
  // Keeps `count` frames of so many bytes.
  void run(int count, std::size_t bytes) {
    int next = 0;
    Pipeline{.pool = test::shared_pool(),
             .background = false,
             .next = [&] { return next < count ? std::optional<std::int64_t>(next++) : std::nullopt; },
             .render =
                 [](std::int64_t) {
                   return RenderResult{Film(1, 1, FilmStorage::srgb8, {}), {}};
                 },
             .encode = [&](const Film&) { return std::string(bytes, 'x'); },
             .memory = account_.get(),
             .deliver = [&](std::int64_t, Frame&& frame) { frames_.push_back(std::move(frame)); }}
        .run();
  }

  WorkMemory memory_{100 * kMega};
  const std::shared_ptr<MemoryAccount> account_ = memory_.open("a");
  std::vector<Frame> frames_;
};

TEST_F(PipelineMemory, IsTakenWhileFramesAreKept) {
  run(3, kMega);
  EXPECT_GE(memory_.bytes(), 3 * kMega);
  EXPECT_LE(memory_.bytes(), 3 * kMega + kMega / 2);
  frames_.pop_back();
  EXPECT_LE(account_->bytes(), 2 * kMega + kMega / 2);
  frames_.clear();
  EXPECT_EQ(account_->bytes(), 0U);
}

TEST_F(PipelineMemory, IsTakenBeyondTheLimitForFramesThatAreMade) {
  run(3, 20 * kMega);
  EXPECT_EQ(frames_.size(), 3U);
  EXPECT_THROW(account_->run({}, [] { interruption_point(); }), InputError);
}

TEST_F(PipelineMemory, EndsWithTheLimitWhereAFrameIsLarge) {
  EXPECT_THROW(run(1, 60 * kMega), InputError);
  EXPECT_TRUE(frames_.empty());
}

}  // namespace
}  // namespace orrery
