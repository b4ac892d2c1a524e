#include "server/jobs/jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <nlohmann/json.hpp>

#include "server/config/settings.h"
#include "tests/server/manual_timer.h"
#include "tests/support/eventually.h"
#include "tests/support/pictures.h"

// Tests time limits, retention and status of jobs, with a manual clock.
namespace orrery {
namespace {

using nlohmann::ordered_json;
using std::chrono::milliseconds, std::chrono::seconds;

constexpr seconds kRunTime{100}, kRetention{50};

// Renders tiny images of a ball. Calls `then` on the thread of the job after each image. Is complete after
// `enough` images.
class FakeWork final : public JobWork {
 public:
  FakeWork(int steps, std::size_t bytes, std::function<void(int)> then, int enough = 1 << 20)
      : steps_(steps), enough_(enough), bytes_(bytes), then_(std::move(then)) {}
  void keep_first_to(double error) { request_.error = error; }

  int steps() const override { return added_ < enough_ ? steps_ : std::max(enough_, added_); }
  RenderRequest request(int) const override { return request_; }
  FileFormat format() const override { return FileFormat::png; }
  void add(const RenderResult& rendered) override {
    if (rendered.budget) static_cast<RenderSettings&>(request_) = rendered.budget->settings;
    then_(added_++);
  }
  std::string encode(const Film&) const override { return std::string(bytes_, 'x'); }
  void keep(int step, std::string&&) override { EXPECT_EQ(step, kept_++); }
  ordered_json links(const std::string&) const override { return {}; }
  ordered_json links_of_step(const std::string&, int) const override { return {}; }
  ordered_json status_fields(int) const override { return {}; }
  ordered_json step_fields(int) const override { return {}; }
  JobResult result(const std::string&, std::string_view) const override { throw NotFound("none"); }

 private:
  const int steps_, enough_;
  const std::size_t bytes_;
  const std::function<void(int)> then_;
  RenderRequest request_ = test::size(8, 8);
  int added_ = 0, kept_ = 0;
};

class JobsTest : public testing::Test {
 protected:
  using JobPtr = Jobs::JobPtr;

  Jobs& jobs() {
    if (!jobs_) jobs_.emplace(services_, limits_);
    return *jobs_;
  }
  JobPtr start(
      int steps, std::function<void(int)> then = [](int) {}, const std::string& client = "a") {
    auto work = std::make_unique<FakeWork>(steps, bytes_a_step_, std::move(then));
    return jobs().start({scene_, std::move(work), client}, "", "").job;
  }
  // Waits for the end of the job and returns its final status.
  static JobStatus end_of(const JobPtr& job) {
    EXPECT_TRUE(test::eventually([&] { return job->ended().has_value(); }));
    return job->status();
  }
  RenderServices services_with(Admission& admission) {
    return {
        pool_,      admission,    timer_,  drains_.get_token(),         ends_.get_token(),         meters_,
        estimator_, work_memory_, scenes_, Settings().interactive_rays, Settings().request_seconds};
  }
  static std::string error_of(const JobStatus& status) {
    try {
      if (status.error) std::rethrow_exception(status.error);
    } catch (const TimedOut& error) {
      return std::string("timed out: ") + error.what();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  bool is_kept(const JobPtr& job) {
    try {
      return jobs().find(job->id()) == job;
    } catch (const NotFound&) {
      return false;
    }
  }

  ManualTimer timer_;
  WorkerPool pool_{1};
  Admission admission_{{.running = 2, .max_queued_rays = 1e6}, timer_};
  std::stop_source drains_, ends_;
  ServiceCounters meters_;
  RayEstimator estimator_;
  WorkMemory work_memory_{std::size_t{1} << 30};
  SceneStore scenes_{std::size_t{1} << 30, work_memory_};
  const RenderServices services_ = services_with(admission_);
  Jobs::Limits limits_{
      .under_way = 4, .ended = 100, .bytes = 1 << 20, .run_time = kRunTime, .kept = kRetention};
  std::size_t bytes_a_step_ = 10;
  const std::shared_ptr<const StoredScene> scene_ = std::make_shared<const StoredScene>(
      test::load(test::scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'mirror'}",
                                R"({'materials': {'mirror': {
                                  'type': 'reflective', 'n': [0.1, 0.1, 0.1], 'k': [4, 3, 2]}}})")));
  std::optional<Jobs> jobs_;  // last member, since it uses the others
};

TEST_F(JobsTest, FinishesWithinRunTime) {
  const auto job =
      start(3, [&](int step) { timer_.advance(step < 2 ? kRunTime / 2 - milliseconds(1) : seconds(0)); });
  const JobStatus status = end_of(job);
  EXPECT_EQ(status.state, JobState::done) << error_of(status);
  EXPECT_EQ(status.steps_done, 3);
  EXPECT_EQ(status.tiles_done, status.tiles);
  EXPECT_DOUBLE_EQ(status.elapsed_s, 99.998);
}

TEST_F(JobsTest, FinishesEarlyWhenWorkIsComplete) {
  auto work = std::make_unique<FakeWork>(
      9, bytes_a_step_, [](int) {}, 4);
  const auto job = jobs().start({scene_, std::move(work), "a"}, "", "").job;
  EXPECT_EQ(job->status().steps % 5, 4) << "9 before the work is complete, 4 after";
  const JobStatus status = end_of(job);
  EXPECT_EQ(status.state, JobState::done) << error_of(status);
  EXPECT_EQ(status.steps, 4);
  EXPECT_EQ(status.steps_done, 4);
  EXPECT_EQ(status.tiles_done, status.tiles);
}

TEST_F(JobsTest, FailsWhenRunTimeExpires) {
  const auto job = start(3, [&](int step) {
    if (step == 1) timer_.advance(kRunTime);
  });
  const JobStatus status = end_of(job);
  EXPECT_EQ(status.state, JobState::failed);
  EXPECT_EQ(status.steps_done, 2);
  const std::string error = error_of(status);
  EXPECT_TRUE(error.starts_with("timed out: ")) << error;
  EXPECT_NE(error.find(", job_seconds)"), std::string::npos) << error;
}

TEST_F(JobsTest, KeepsEndedJobsForRetentionTime) {
  const auto job = start(1, [&](int) { timer_.advance(kRunTime / 2); });
  end_of(job);
  timer_.advance(kRetention);
  EXPECT_TRUE(is_kept(job));
  timer_.advance(milliseconds(1));
  EXPECT_FALSE(is_kept(job));
}

TEST_F(JobsTest, ReportsRemainingTime) {
  std::promise<JobPtr> started;
  std::promise<JobStatus> reported;
  const auto job = start(4, [&](int step) {
    if (step > 0) return;
    timer_.advance(seconds(10));
    reported.set_value(started.get_future().get()->status());
  });
  started.set_value(job);
  const JobStatus status = reported.get_future().get();
  EXPECT_EQ(status.state, JobState::running);
  EXPECT_DOUBLE_EQ(status.elapsed_s, 10);
  EXPECT_DOUBLE_EQ(status.remaining_s.value_or(-1), 30);
  EXPECT_FALSE(end_of(job).remaining_s);
}

// The remaining time does not include rays that the budget spent only on the first image.
TEST_F(JobsTest, ReportsRemainingTimeUnderBudget) {
  std::promise<JobPtr> started;
  std::promise<JobStatus> reported;
  auto work = std::make_unique<FakeWork>(4, bytes_a_step_, [&](int step) {
    timer_.advance(seconds(10));
    if (step == 1) reported.set_value(started.get_future().get()->status());
  });
  work->keep_first_to(0.5);
  const auto job = jobs().start({scene_, std::move(work), "a"}, "", "").job;
  started.set_value(job);
  const JobStatus status = reported.get_future().get();
  EXPECT_DOUBLE_EQ(status.elapsed_s, 20);
  EXPECT_DOUBLE_EQ(status.remaining_s.value_or(-1), 20);
  EXPECT_EQ(status.tiles_done, 2);
  EXPECT_EQ(end_of(job).tiles_done, 4);
}

TEST_F(JobsTest, LimitsRunningJobsPerClientAndInTotal) {
  std::promise<void> go;
  const auto goes = go.get_future().share();
  const auto wait = [&](int) { goes.wait(); };
  const auto one = start(1, wait), two = start(1, wait);
  EXPECT_THROW(start(1, wait), ClientLimitExceeded);
  const auto three = start(1, wait, "b"), four = start(1, wait, "c");
  EXPECT_THROW(start(1, wait, "d"), LimitExceeded);
  go.set_value();
  for (const auto& job : {one, two, three, four}) EXPECT_EQ(end_of(job).state, JobState::done);
  EXPECT_EQ(end_of(start(1)).state, JobState::done);
  EXPECT_EQ(meters_.jobs_done, 5U);
}

TEST_F(JobsTest, EvictsEndedJobsOverByteLimit) {
  limits_.bytes = 35;
  const auto first = start(2);
  end_of(first);
  const auto second = start(1);
  end_of(second);
  EXPECT_EQ(jobs().bytes(), 30U);
  const auto third = start(1);
  EXPECT_EQ(end_of(third).state, JobState::done);
  EXPECT_FALSE(is_kept(first));
  EXPECT_TRUE(is_kept(second));
  EXPECT_EQ(jobs().bytes(), 20U);
  const JobStatus large = end_of(start(4));
  EXPECT_EQ(large.state, JobState::failed);
  EXPECT_EQ(large.steps_done, 3);
  EXPECT_NE(error_of(large).find(", job_bytes)"), std::string::npos) << error_of(large);
}

TEST_F(JobsTest, KeepsJobsOfOtherClientsDuringFlood) {
  limits_.ended = 10;
  const auto other = start(
      1, [](int) {}, "b");
  end_of(other);
  std::vector<JobPtr> flood;
  for (int i = 0; i < 30; ++i) end_of(flood.emplace_back(start(1)));
  EXPECT_TRUE(is_kept(other));
  EXPECT_TRUE(is_kept(flood.back()));
  EXPECT_EQ(std::count_if(flood.begin(), flood.end(), [&](const auto& job) { return is_kept(job); }), 9);
}

TEST_F(JobsTest, KeepsJobsOfOtherClientsUnderByteLimit) {
  limits_.bytes = 95;
  const auto other = start(
      2, [](int) {}, "b");
  end_of(other);
  for (int i = 0; i < 10; ++i) end_of(start(3));
  const JobStatus large = end_of(start(12));
  EXPECT_EQ(large.state, JobState::failed);
  EXPECT_EQ(large.steps_done, 7);
  EXPECT_TRUE(is_kept(other));
}

// A running job is evicted if its client uses the most bytes and has no ended jobs.
TEST_F(JobsTest, EvictsLargestRunningJob) {
  limits_.bytes = 60;
  std::promise<void> go;
  const auto goes = go.get_future().share();
  const auto large = start(6, [&](int step) {
    if (step == 5) goes.wait();
  });
  EXPECT_TRUE(test::eventually([&] { return large->status().steps_done == 5; }));
  const auto other = start(
      3, [](int) {}, "b");
  EXPECT_EQ(end_of(other).state, JobState::done);
  EXPECT_FALSE(is_kept(large));
  go.set_value();
  EXPECT_EQ(end_of(large).state, JobState::cancelled);
  EXPECT_TRUE(is_kept(other));
  EXPECT_EQ(jobs().bytes(), 30U);
}

TEST_F(JobsTest, UpdatesRayEstimateOfScene) {
  const Plan plan = make_plan(scene_->scene(), test::size(8, 8));
  const double expected = estimator_.estimate(scene_->scene(), plan);
  EXPECT_EQ(end_of(start(1)).state, JobState::done);
  const double share = 64.0 / 4096, traced = static_cast<double>(meters_.rays);
  EXPECT_NE(expected, traced);
  EXPECT_DOUBLE_EQ(estimator_.estimate(scene_->scene(), plan), expected + share * (traced - expected));
}

// A frame that lacks memory gives its slot back, and starts again once other clients free the memory.
TEST_F(JobsTest, StartsFrameAgainAfterShortageOfMemory) {
  constexpr std::size_t kMega = 1 << 20;
  WorkMemory memory(16 * kMega);
  const auto own = memory.open("a");
  auto others = memory.open("b");
  std::optional<MemoryCharge> held;
  others->run({}, [&] { held.emplace(8 * kMega); });
  ASSERT_EQ(memory.bytes(), 8 * kMega);
  const auto scene = std::make_shared<const StoredScene>(scene_->shared_scene());  // charged to `memory`
  const RenderOrder order =
      make_order(scene, test::size(2048, 1024), FileFormat::png, {"a", {}});  // film of 6 MiB
  std::atomic<int> begun = 0;
  auto width = std::async(std::launch::async, [&] {
    return services_.render_next(order, *own, false, {}, [&] { ++begun; }).film.width();
  });
  EXPECT_TRUE(test::eventually([&] { return begun == 1 && admission_.running() == 0; }));
  held.reset();
  others.reset();
  EXPECT_TRUE(test::eventually([&] {
    timer_.advance(seconds(1));
    return width.wait_for(seconds(0)) == std::future_status::ready;
  }));
  EXPECT_EQ(width.get(), 2048);
  EXPECT_EQ(begun, 2);
}

// The measured rate counts traced rays, not estimated ones.
TEST_F(JobsTest, ReportsTracedRaysToAdmission) {
  Admission admission({.running = 1, .max_queued_rays = 1}, timer_);
  const RenderServices services = services_with(admission);
  const RenderOrder order = make_order(scene_, test::size(8, 8), FileFormat::png, {"a", {}});
  {
    auto ticket = admission.enter({Priority::interactive, "a", 1e12}, {});
    services.render(ticket, false, order, FilmStorage::srgb8, {});
    timer_.advance(seconds(1));
  }
  const double rate = kFixedCost + static_cast<double>(meters_.rays);
  const auto ticket = admission.enter({Priority::interactive, "a", 1}, {});
  std::stop_source stop;
  std::thread waits([&] {
    EXPECT_THROW(admission.enter({Priority::interactive, "a", 7 * rate}, stop.get_token()), Cancelled);
  });
  EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 1; }));
  try {
    admission.enter({Priority::interactive, "a", 7 * rate}, {});
    ADD_FAILURE() << "admitted although the queue is full";
  } catch (const Busy& busy) {
    EXPECT_DOUBLE_EQ(busy.retry_after_s(), 7);
  }
  stop.request_stop();
  waits.join();
}

}  // namespace
}  // namespace orrery
