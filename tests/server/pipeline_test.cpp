#include "server/rendering/pipeline.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/base/error.h"
#include "server/base/errors.h"
#include "server/scheduler/work_memory.h"

// Tests memory accounting of frames, which are charged to the client from encoding until destruction.
namespace orrery {
namespace {

constexpr std::size_t kMega = 1 << 20;

class PipelineMemory : public testing::Test {
 protected:
  // Keeps `count` frames of `bytes` bytes, and calls `then` after the last one.
  void run(std::size_t count, std::size_t bytes, const std::function<void()>& then) {
    std::size_t next = 0;
    const auto deliver = [&](std::int64_t, Frame&& frame) {
      frames_.push_back(std::move(frame));
      if (frames_.size() == count) then();
    };
    Pipeline{.pool = pool_,
             .background = false,
             .next = [&] { return next < count ? std::optional<std::int64_t>(next++) : std::nullopt; },
             .render =
                 [](std::int64_t) {
                   return RenderResult{Film(1, 1, FilmStorage::srgb8, {}), {}};
                 },
             .encode = [&](const Film&) { return std::string(bytes, 'x'); },
             .memory = account_.get(),
             .deliver = deliver}
        .run();
  }

  WorkerPool pool_{2};
  WorkMemory memory_{100 * kMega};
  const std::shared_ptr<WorkAccount> account_ = memory_.open("a");  // for films
  std::vector<Frame> frames_;
};

TEST_F(PipelineMemory, ChargesFramesUntilDestruction) {
  run(3, kMega, [&] {
    EXPECT_GE(memory_.bytes(), 3 * kMega);
    EXPECT_LE(memory_.bytes(), 3 * kMega + kMega / 2);
  });
  EXPECT_EQ(frames_.size(), 3U);
  frames_.clear();
  EXPECT_EQ(memory_.bytes(), 0U);
}

TEST_F(PipelineMemory, RejectsNextFilmWhileOverLimit) {
  const auto next_film = [] {
    const MemoryCharge film(kMega);
    checkpoint();
  };
  run(3, 20 * kMega, [&] { EXPECT_THROW(account_->run({}, next_film), ClientLimitExceeded); });
  EXPECT_EQ(frames_.size(), 3U);
  frames_.clear();
  EXPECT_NO_THROW(account_->run({}, next_film));
}

TEST_F(PipelineMemory, RejectsFrameLargerThanLimit) {
  EXPECT_THROW(run(1, 60 * kMega, [] {}), InputError);
  EXPECT_TRUE(frames_.empty());
}

}  // namespace
}  // namespace orrery
