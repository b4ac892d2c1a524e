#include "core/budget/budget.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <thread>
#include <utility>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/budget/forecast_pilots.h"
#include "core/budget/pilot.h"
#include "core/model/tile.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "core/render/progressive.h"

namespace orrery {
namespace {

constexpr double kNearLeast = 1.25;  // accepted bound / smallest provable error
// Maximum fractions of the requested error that untraced rays may cause, in a pass and in a pilot. The
// fraction is smaller for a pilot, which samples few such rays.
constexpr double kShareOfCuts = 0.125, kShareOfPilot = kShareOfCuts / 2;
// Divisors of min_contribution after a pilot and after a pass, and maximum numbers of pilots and of restarts.
constexpr double kStep = 4, kStepOfPass = 16;
constexpr int kMaxPilots = 10, kMaxRefinements = 3;
// Untraced rays were mostly cut by depth if their mean weight is at least this multiple of min_contribution.
constexpr double kHeavy = 10;
constexpr double kShareOfPilots = 0.25;  // fraction of the time limit after which no pilot starts
constexpr double kSlower = 1.1;          // safety factor on the time per sample of the previous pass
// If the time allows fewer samples than this multiple of the current samples, the next pass traces all of
// them.
constexpr double kLastPassReach = 4.4;
constexpr int kSeenTiles = 16;  // finished tiles of the first pass from which its end is predicted
// The first pass is abandoned if its predicted end exceeds this multiple of the time limit.
constexpr double kSurelyLate = 1.5;
// Time reserved for encoding: this fraction of the time limit, plus the time of all pixels at this rate.
constexpr double kShareOfEncoding = 0.02, kEncodedPixelsPerSecond = 8e6;

constexpr const char* kNoMemory = "not enough memory for another pass";

class BudgetedRender {
 public:
  BudgetedRender(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                 const RenderControl& control)
      : scene_(scene),
        executor_(executor),
        control_(control),
        error_(*plan->asked.error),
        seconds_(*plan->asked.seconds),
        limit_s_(seconds_ > 0 ? std::min(seconds_, control.max_s) : control.max_s),
        begin_(Clock::now()),
        made_{.plan = plan} {}

  RenderResult render() {
    made_.certificate = certify(*made_.plan, made_.stats, alpha_of_look(1));  // no samples yet
    if (fails_on_miss() && error_ > 0 && !is_reachable()) throw BudgetMissed(outcome(), made_.certificate);
    choose_contribution();
    while (!render_passes()) {  // a pass found omitted light that the pilots missed
      made_.plan = made_.plan.with_min_contribution(made_.plan->min_contribution / kStepOfPass);
      ++refinements_;
    }
    made_.stats.counts.add(discarded_.counts);  // the cost includes discarded rays
    made_.stats.build_ms += discarded_.build_ms;
    made_.stats.trace_ms += discarded_.trace_ms;
    made_.stats.cpu_ms += discarded_.cpu_ms;
    BudgetOutcome told = outcome();
    require_met(told, made_.certificate);
    return {std::move(*made_.film), made_.stats, made_.certificate, std::move(told)};
  }

  Forecast predict() {
    choose_contribution();
    const double begin_s = used_s();
    const ForecastPilots pilots(scene_, made_.plan, executor_, control_);
    ahead_s_ = begin_s - used_s();  // excludes the time of these pilots, which a render does not trace
    rays_per_sample_ = pilots.rays_per_sample();
    pass_s_per_sample_ = pilots.cpu_s_per_sample() / threads_at_work();
    int next = has_budget(made_.plan->asked) ? progressive_samples(*made_.plan).front() : made_.plan->samples;
    for (; next > 0; next = next_samples()) {
      ahead_s_ += (next - made_.samples) * pass_s_per_sample_;
      made_.samples = next;
      look(pilots.extrapolated(made_.samples));
      for (Certificate::Term& term : made_.certificate.terms)  // a subset of pixels proves nothing
        if (term.bound.kind == Bound::Kind::proved) term.bound = Bound::estimated(*term.bound.rms);
      if (made_.samples % 2 == 0 && is_enough()) break;
    }
    const double ready_s =
        (pilots.build_ms() + discarded_.build_ms + discarded_.trace_ms + made_.plan.settle_ms()) / 1000;
    return {outcome(), made_.certificate,
            static_cast<double>(discarded_.counts.rays.total()) + rays_per_sample_ * made_.samples,
            ready_s + pass_s_per_sample_ * made_.samples};
  }

 private:
  int threads_at_work() const {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return std::min({executor_.threads(), cores, TileGrid(made_.plan->width, made_.plan->height).size()});
  }

  bool fails_on_miss() const { return *made_.plan->asked.on_miss == OnMiss::fail; }

  // Returns the error probability of the `look`-th certificate, counted from 1. Each certificate may end the
  // render, so the probabilities add up to at most kAlpha. If the request sets the samples, only the last
  // certificate counts, with kAlpha.
  double alpha_of_look(int look) const {
    return Certificate::kAlpha * (made_.plan->free_samples ? std::exp2(-look) : 1);
  }

  // Returns whether a time limit may end the render.
  bool is_timed() const { return std::isfinite(limit_s_); }
  double used_s() const {
    return ahead_s_ + (control_.used_s ? control_.used_s() : milliseconds_since(begin_) / 1000);
  }
  // Returns the time, in seconds as in used_s(), at which tracing must end to leave time for encoding.
  double deadline_s() const {
    const double pixels = double(made_.plan->width) * made_.plan->height;
    return limit_s_ * (1 - kShareOfEncoding) - pixels / kEncodedPixelsPerSecond;
  }

  // Chooses min_contribution with pilots, if it is free. Divides it by kStep until untraced rays cause at
  // most kShareOfPilot of the error or are mostly cut by depth. Also stops after kMaxPilots pilots, or after
  // kShareOfPilots of the time limit.
  void choose_contribution() {
    if (!made_.plan->free_contribution) return;
    for (int pilots = 1;; ++pilots) {
      const RenderStats pilot = trace_pilot(scene_, made_.plan, 1, executor_, control_).stats;
      discard(pilot);
      discarded_.build_ms += pilot.build_ms;  // the passes reuse this work
      const bool late = seconds_ > 0 && used_s() > kShareOfPilots * seconds_;
      if (pilots == kMaxPilots || late || are_too_deep(pilot) ||
          share_of_cuts(certify(*made_.plan, pilot)) <= kShareOfPilot * error_)
        return;
      made_.plan = made_.plan.with_min_contribution(made_.plan->min_contribution / kStep);
    }
  }

  // Returns whether nearly all omitted light is due to the depth limit, so that a smaller min_contribution
  // would not help. A ray that is cut by its weight has a weight below min_contribution.
  bool are_too_deep(const RenderStats& stats) const {
    const auto& [x, y, z] = made_.plan->cut_range;
    const double least = made_.plan->min_contribution * (x + y + z);
    return stats.omitted.sum >= kHeavy * least * static_cast<double>(stats.counts.cut_rays);
  }

  // Adds the cost of rays that do not contribute to the image to `discarded_`.
  void discard(const RenderStats& traced) {
    discarded_.counts.add(traced.counts);
    discarded_.trace_ms += traced.trace_ms;
    discarded_.cpu_ms += traced.cpu_ms;
  }

  static double share_of_cuts(const Certificate& certificate) {
    return certificate.terms.front().bound.rms.value_or(0);
  }

  // Renders the passes. Returns false if they must restart with a smaller min_contribution.
  bool render_passes() {
    made_.samples = 0;
    const auto passes = begin_passes();
    for (int next = passes ? progressive_samples(*made_.plan).front() : 0; next > 0; next = next_samples()) {
      const double begin_s = used_s();
      if (!trace(*passes, next)) break;
      pass_s_per_sample_ = (used_s() - begin_s) / (next - made_.samples);
      made_.samples = next;
      look(passes->stats());
      rays_per_sample_ = static_cast<double>(made_.stats.counts.rays.total()) / made_.samples;
      if (before_ && !is_better(before_->certificate, made_.certificate)) forget_before();
      if (is_too_coarse()) {
        forget_before();
        made_.film = passes->take_film();
        before_.emplace(std::move(made_));
        made_ = {.plan = before_->plan};
        return false;
      }
      if (is_enough()) break;
    }
    if (before_) {  // no time or memory for a better image
      if (made_.samples > 0) discard(made_.stats);
      made_ = std::move(*before_);
    } else if (!made_.film) {
      made_.film = passes->take_film();
    }
    return true;
  }

  // Returns null if there is an earlier image but no memory for another.
  std::unique_ptr<ProgressiveRender> begin_passes() try {
    return std::make_unique<ProgressiveRender>(scene_, made_.plan, executor_, control_.stop);
  } catch (const std::bad_alloc&) {
    if (!before_) throw;
    reason_ = kNoMemory;
    return nullptr;
  }

  void forget_before() {
    if (before_) discard(before_->stats);
    before_.reset();
  }

  static bool is_better(const Certificate& a, const Certificate& b) {
    const auto of_a = a.total().rms, of_b = b.total().rms;
    return of_a && (!of_b || *of_a < *of_b);
  }

  // Traces one pass. Returns false if the time limit is reached, or if there is no memory to copy the film.
  // The image of the previous pass is then the result. Throws BudgetMissed if the first pass is abandoned.
  bool trace(ProgressiveRender& passes, int samples) {
    if (is_timed() && made_.samples > 0 && !keep(passes.film())) return false;
    std::stop_source late;
    const std::stop_callback forward(control_.stop, [&] { late.request_stop(); });
    RenderControl control = control_;
    control.stop = late.get_token();
    const bool is_first = made_.samples == 0 && !before_;
    control.spread = is_first && seconds_ > 0 && fails_on_miss();
    control.progress = [&, begin_s = used_s()](int done, int total) {
      if (is_first ? control.spread && is_surely_late(begin_s, done, total) : used_s() > deadline_s())
        late.request_stop();
      if (control_.progress) control_.progress(done, total);
    };
    try {
      passes.refine(samples, control);
    } catch (const Cancelled&) {
      if (control_.stop.stop_requested()) throw;
      if (is_first) throw BudgetMissed(outcome(), made_.certificate);
      gave_up_ = true;
      reason_ = "time limit reached";
      return false;
    }
    made_.film.reset();
    return true;
  }

  // Copies the film to made_.film. Returns false if there is no memory.
  bool keep(const Film& film) try {
    made_.film = film.copy();
    return true;
  } catch (const std::bad_alloc&) {
    reason_ = kNoMemory;
    return false;
  }

  // Returns whether the first pass has exceeded the time limit, or will end after kSurelyLate times the
  // limit. The end is extrapolated from at least kSeenTiles finished tiles. Returns false once all tiles are
  // finished. REQUIRES: the finished tiles are spread over the whole image.
  bool is_surely_late(double begin_s, int done, int total) {
    const double now_s = used_s();
    if (done == total) return false;
    const double end_s = begin_s + (now_s - begin_s) * total / done;
    const bool extrapolated = done >= kSeenTiles && end_s > kSurelyLate * seconds_;
    if (now_s <= seconds_ && !extrapolated) return false;
    is_late_ = true;
    if (done >= kSeenTiles) min_s_ = end_s;
    return true;
  }

  void look(const RenderStats& stats) {
    made_.stats = stats;
    made_.certificate = certify(*made_.plan, made_.stats, alpha_of_look(++looks_));
  }

  static bool is_not_sampling(const Certificate::Term& term) { return term.subject != Certificate::kSamples; }
  // Returns the RMS bound of all terms except the sampling error, or nullopt if it is unknown.
  std::optional<double> rest() const { return made_.certificate.total_of(is_not_sampling).rms; }
  // Returns the RMS bound of all terms with a known bound except the sampling error.
  double rest_known() const {
    return *made_.certificate
                .total_of([](const Certificate::Term& term) {
                  return is_not_sampling(term) && term.bound.kind != Bound::Kind::unknown;
                })
                .rms;
  }

  // Returns whether the bound of the image meets the error limit.
  bool is_bound_met() const {
    const auto bound = made_.certificate.total().rms;
    return bound && *bound <= error_;
  }

  // Returns false if the image has fewer samples than the request sets. With a time limit, fewer are allowed.
  bool has_samples_asked() const {
    return made_.plan->free_samples || seconds_ > 0 || made_.samples == made_.plan->samples;
  }

  // Returns whether some number of samples may meet the error limit. If the radiance of a sample is
  // unbounded, no error is provable, and the bound that the samples estimate has no lower limit.
  bool is_reachable() const {
    if (!made_.certificate.min_provable) return rest() && *rest() <= error_;
    return least() && *least() <= error_;
  }

  // Returns whether more samples are not worth their cost. This requires an estimated error of at most the
  // error limit less the other known errors, or half of the limit if that is larger. In addition, one of
  // these conditions must be met: the bound meets the error limit, or is at most kNearLeast times the
  // smallest provable error, or there is no bound. If no error is provable, but there is a bound, that bound
  // must meet the limit. A smaller error limit never leads to fewer samples.
  bool is_near_enough() const {
    const SampledError& error = made_.stats.error;
    if (!error.known()) return false;
    const auto& bound = made_.certificate.total().rms;
    if (bound && !made_.certificate.min_provable) return is_bound_met();
    const double estimate = made_.certificate.min_provable ? *made_.certificate.estimate
                            : error.tiles < 2              ? error.pixel.rmse()
                                                           : error.interval().high;
    if (estimate > std::max(error_ - rest_known(), error_ / 2)) return false;
    return !bound || *bound <= std::max(error_, kNearLeast * *least());
  }

  // Returns whether an error limit makes more passes useless. With samples set by the request, passes stop
  // early only if the render must fail.
  bool is_enough() const {
    return error_ > 0 && (is_hopeless() || (made_.plan->free_samples && is_near_enough()));
  }

  // Returns whether a miss is an error and no number of samples can avoid it.
  bool is_hopeless() const { return fails_on_miss() && !is_reachable(); }

  bool is_too_coarse() const {
    if (error_ == 0 || !made_.plan->free_contribution || refinements_ == kMaxRefinements) return false;
    const double first_pass_s = pass_s_per_sample_ * progressive_samples(*made_.plan).front();
    if (seconds_ > 0 && used_s() + kSlower * first_pass_s > deadline_s()) return false;
    return !is_bound_met() && share_of_cuts(made_.certificate) > kShareOfCuts * error_ &&
           !are_too_deep(made_.stats);
  }

  // Returns the next number of samples that is at least twice the current one, or 0 if there is none. It is
  // even, so that both halves estimate the error, unless it is the plan's maximum.
  int doubled_samples() const {
    for (const int samples : progressive_samples(*made_.plan)) {
      const int told = samples == made_.plan->samples ? samples : samples / 2 * 2;
      if (told >= 2 * made_.samples) return told;
    }
    return 0;
  }

  // Returns the number of samples after the next pass, or 0 if there is none.
  int next_samples() {
    const int most = made_.plan->samples;
    int next = doubled_samples();
    if (next == 0) return 0;
    if (is_timed()) {
      const double fit = made_.samples + (deadline_s() - used_s()) / (kSlower * pass_s_per_sample_);
      if (fit < next) {
        reason_ = "more samples would exceed the time limit";
        return 0;
      }
      if (seconds_ > 0 && fit < most && fit < kLastPassReach * made_.samples)
        next = static_cast<int>(fit / 2) * 2;
    }
    const double rays = rays_per_sample_ * next;
    if (rays <= control_.max_rays) return next;
    reason_ = "another pass would bring the image to " + rounded(rays) + " rays (limit " +
              rounded(control_.max_rays) + ", request_rays)";
    return 0;
  }

  BudgetOutcome outcome() {
    BudgetOutcome outcome;
    outcome.error = error_;
    outcome.seconds = seconds_;
    outcome.on_miss = *made_.plan->asked.on_miss;
    outcome.kind = made_.certificate.total().kind;
    outcome.min_error = least();
    Plan used = *made_.plan;
    used.asked.samples = made_.samples;
    used.asked.error = used.asked.seconds = 0;
    used.asked.on_miss = OnMiss::best;
    used.asked.space = Space::automatic;
    outcome.settings = settings_of(used);
    outcome.used_s = used_s();
    if (min_s_ > 0) outcome.min_s = min_s_;
    outcome.seconds_met = seconds_ == 0 || (outcome.used_s <= seconds_ && !is_late_);
    outcome.error_met = error_ == 0 || (is_bound_met() && has_samples_asked());
    if (!outcome.met()) outcome.reason = reason();
    return outcome;
  }

  std::string reason() const {
    if (is_bound_met() && !has_samples_asked()) return reason_;
    if (is_late_ || error_ == 0 || is_bound_met()) return late_reason();
    for (const Certificate::Term& term : made_.certificate.terms)
      if (term.bound.kind == Bound::Kind::unknown && (made_.samples > 0 || is_not_sampling(term)))
        return term.subject + ": " + term.reason;
    if (*rest() > error_) return "errors other than sampling noise may reach " + rounded(*rest());
    if (!is_reachable()) return "smallest provable error at this size: " + rounded(*least());
    if (!reason_.empty()) return reason_;
    const bool near = least() && *made_.certificate.total().rms <= kNearLeast * *least();
    return near ? "more samples hardly reduce the provable error (smallest: " + rounded(*least()) + ")"
                : "sample limit reached";
  }

  std::string late_reason() const {
    if (min_s_ > 0) return "first pass would take about " + rounded(min_s_) + " s";
    if (is_late_) return "time limit reached in the first pass";
    if (gave_up_) return "a pass took longer than predicted and was stopped after the time limit";
    const bool first = made_.samples == progressive_samples(*made_.plan).front();
    return std::string(first ? "first" : "last") + " pass exceeded the time limit";
  }

  // Returns the smallest provable error, or nullopt if no error can be proved.
  std::optional<double> least() const {
    if (!rest() || !made_.certificate.min_provable) return {};
    return *rest() + *made_.certificate.min_provable;
  }

  const PreparedScene& scene_;
  Executor& executor_;
  const RenderControl& control_;
  const double error_, seconds_;  // limits of the request; 0: no limit
  const double limit_s_;          // smaller of seconds_ and control.max_s; may be infinite
  const Clock::time_point begin_;
  double ahead_s_ = 0;  // predicted seconds of passes, which a forecast adds to the clock
  int refinements_ = 0, looks_ = 0;
  bool gave_up_ = false;                                // a pass other than the first was abandoned
  std::atomic<bool> is_late_ = false;                   // the first pass was late and was abandoned
  std::atomic<double> min_s_ = 0.0;                     // predicted end of an abandoned first pass
  double pass_s_per_sample_ = 0, rays_per_sample_ = 0;  // costs measured in the last complete pass
  RenderStats discarded_;                               // cost of pilots and of discarded images
  // Image after `samples` samples per pixel.
  struct Made {
    SettledPlan plan;
    RenderStats stats = {};
    Certificate certificate = {};
    int samples = 0;
    std::optional<Film> film = {};  // set while a pass may be abandoned, and at the end
  };
  Made made_;
  std::optional<Made> before_;  // image with a larger min_contribution, until a better one exists
  std::string reason_;          // why no further pass was made; may be empty
};

}  // namespace

void BudgetOutcome::end_at(double seconds_used) {
  used_s = seconds_used;
  if (seconds == 0 || seconds_used <= seconds || !seconds_met) return;
  seconds_met = false;
  reason = (reason.empty() ? "" : reason + "; ") + "encoding exceeded the time limit";
}

void require_met(const BudgetOutcome& outcome, const Certificate& certificate) {
  if (!outcome.met() && outcome.on_miss == OnMiss::fail) throw BudgetMissed(outcome, certificate);
}

BudgetMissed::BudgetMissed(BudgetOutcome outcome, const Certificate& certificate)
    : Error("budget missed: " + outcome.reason), outcome_(std::move(outcome)), certificate_(certificate) {}

RenderResult render_within_budget(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                                  const RenderControl& control) {
  return BudgetedRender(scene, plan, executor, control).render();
}

Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                  const RenderControl& control) {
  return BudgetedRender(scene, plan, executor, control).predict();
}

}  // namespace orrery
