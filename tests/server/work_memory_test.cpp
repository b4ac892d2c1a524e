#include "server/scheduler/work_memory.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/image.h"
#include "server/base/errors.h"
#include "server/scheduler/worker_pool.h"

// Tests memory accounts and their limits.
namespace orrery {
namespace {

constexpr std::size_t kMega = 1 << 20;

std::vector<char> block(std::size_t bytes) { return std::vector<char>(bytes); }

TEST(WorkAccount, ChargesScopedAllocationsUntilFreed) {
  WorkMemory memory(100 * kMega);
  const auto account = memory.open("a");
  EXPECT_EQ(account->bytes(), 0u);
  std::vector<char> kept = account->run({}, [] { return block(10 * kMega); });
  EXPECT_GE(account->bytes(), 10 * kMega);
  EXPECT_LE(account->bytes(), 10 * kMega + 100);
  EXPECT_GE(memory.bytes(), 10 * kMega);
  const std::vector<char> others = block(5 * kMega);  // allocated outside of the account's scope
  EXPECT_LE(account->bytes(), 10 * kMega + 100);
  std::thread([&] { std::vector<char>().swap(kept); }).join();
  EXPECT_EQ(account->bytes(), 0u);
}

TEST(WorkAccount, CountsEveryFormOfNew) {
  struct alignas(256) Wide {
    char bytes[256];
  };
  WorkMemory memory(100 * kMega);
  const auto account = memory.open("a");
  account->run({}, [&] {
    const auto held = [&] { return account->bytes(); };
    const auto expect_held = [&](std::size_t bytes) { EXPECT_GE(held(), bytes); };
    char* const one = new char;
    char* const some = new char[1000];
    char* const quiet = new (std::nothrow) char;
    char* const some_quiet = new (std::nothrow) char[1000];
    Wide* const wide = new Wide;
    Wide* const some_wide = new Wide[3];
    Wide* const quiet_wide = new (std::nothrow) Wide;
    Wide* const some_quiet_wide = new (std::nothrow) Wide[3];
    for (const Wide* aligned : {wide, some_wide, quiet_wide, some_quiet_wide})
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % 256, 0u);
    expect_held(2002 + 8 * sizeof(Wide));
    delete one;
    delete[] some;
    delete quiet;
    delete[] some_quiet;
    delete wide;
    delete[] some_wide;
    delete quiet_wide;
    delete[] some_quiet_wide;
    EXPECT_EQ(held(), 0u);
  });
}

TEST(WorkAccount, ChargesAllocationsOfWorkersAndImages) {
  WorkMemory memory(100 * kMega);
  const auto account = memory.open("a");
  WorkerPool pool(2);
  std::vector<std::vector<char>> blocks(16);
  account->run({}, [&] {
    parallel_for_each(8, 1, [&](std::size_t i) { blocks[i] = block(kMega); });
    pool.for_each(8, false,
                  [&](int step, int) { blocks[8 + static_cast<std::size_t>(step)] = block(kMega); });
  });
  EXPECT_GE(account->bytes(), 16 * kMega);
  blocks.clear();
  EXPECT_LT(account->bytes(), 4096u);  // the pool may keep a few bytes
  const Image image = account->run({}, [] { return Image(1024, 1024, PixelFormat::linear32); });
  EXPECT_GE(account->bytes(), 12 * kMega);
}

TEST(WorkAccount, ReleasesMemoryDespiteLiveAllocations) {
  WorkMemory memory(100 * kMega);
  std::vector<char> kept = memory.open("a")->run({}, [] { return block(10 * kMega); });
  EXPECT_EQ(memory.bytes(), 0u);
  std::vector<char>().swap(kept);
}

TEST(WorkAccount, ReleasesSettledBytes) {
  WorkMemory memory(100 * kMega);
  const auto account = memory.open("a");
  const std::vector<char> kept = account->run({}, [] { return block(10 * kMega); });
  account->settle(account->bytes());
  EXPECT_EQ(memory.bytes(), 0u);
  const std::vector<char> more = account->run({}, [] { return block(20 * kMega); });
  EXPECT_LT(memory.bytes(), 21 * kMega);
  EXPECT_GE(memory.bytes(), 20 * kMega);
  account->settle(0);
  EXPECT_GE(memory.bytes(), 30 * kMega);
}

// Small allocations never fail. Work above the limit ends at its next checkpoint.
TEST(WorkAccount, InterruptsWorkOfManySmallBlocks) {
  WorkMemory memory(2 * kMega);
  const auto account = memory.open("a");
  std::vector<std::unique_ptr<int>> blocks;
  EXPECT_THROW(account->run({},
                            [&] {
                              for (;;) {
                                for (int i = 0; i < 100; ++i) blocks.push_back(std::make_unique<int>(i));
                                checkpoint();
                              }
                            }),
               InputError);
  EXPECT_LT(account->bytes(), kMega + 100'000);
  blocks.clear();
  blocks.shrink_to_fit();
  account->run({}, [] { checkpoint(); });  // the account is below its limit again
}

TEST(Checkpoint, ThrowsOnceStopIsRequested) {
  WorkMemory memory(100 * kMega);
  std::stop_source source;
  const std::stop_token stop = source.get_token();
  int steps = 0;
  EXPECT_THROW(memory.open("a")->run(stop,
                                     [&] {
                                       for (;; ++steps) {
                                         checkpoint();
                                         if (steps == 3) source.request_stop();
                                       }
                                     }),
               Cancelled);
  EXPECT_EQ(steps, 4);
  checkpoint();  // outside of any account
}

// Returns the kind and limit of the error when `account` charges `bytes`, or "" if the charge succeeds.
std::string refusal_of(const std::shared_ptr<WorkAccount>& account, std::size_t bytes) {
  try {
    account->run({}, [&] { MemoryCharge charge(bytes); });
    return "";
  } catch (const InputError& error) {
    return std::string("never: ") + error.what();
  } catch (const ClientLimitExceeded& error) {
    return std::string("client: ") + error.limit();
  } catch (const LimitExceeded& error) {
    return std::string("all: ") + error.limit();
  }
}

TEST(WorkMemory, LimitsClientToHalfOfFreeMemory) {
  WorkMemory memory(1000 * kMega);
  const auto first = memory.open("a"), more = memory.open("a"), second = memory.open("b"),
             third = memory.open("c");
  EXPECT_EQ(refusal_of(first, 510 * kMega).substr(0, 7), "never: ");
  const MemoryCharge half = first->run({}, [] { return MemoryCharge(490 * kMega); });
  EXPECT_EQ(refusal_of(more, 40 * kMega), "client: work_bytes");
  EXPECT_EQ(refusal_of(second, 260 * kMega), "all: work_bytes");
  const MemoryCharge quarter = second->run({}, [] { return MemoryCharge(240 * kMega); });
  EXPECT_EQ(refusal_of(third, 140 * kMega), "all: work_bytes");
  EXPECT_EQ(refusal_of(third, 120 * kMega), "");
}

TEST(WorkMemory, ReportsExceededByteLimit) {
  WorkMemory memory(1000 * kMega);
  const std::string error = refusal_of(memory.open("a"), 600 * kMega);
  EXPECT_NE(error.find("524,288,000"), std::string::npos) << error;
  EXPECT_NE(error.find("of work_bytes)"), std::string::npos) << error;
}

}  // namespace
}  // namespace orrery
