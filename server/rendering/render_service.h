#pragma once

#include <memory>

#include "core/budget/budget.h"
#include "server/base/subscribers.h"
#include "server/cache/pictures.h"
#include "server/rendering/render_services.h"

namespace orrery {

struct Rendered {
  std::shared_ptr<const Picture> picture;
  bool made_now;  // rendered for this request, neither cached nor shared
};

// Renders images for requests, with a cache of encoded images and a cache of films. Thread-safe.
class RenderService {
 public:
  // The limits are bytes of the caches and estimated rays of one image. `services` must outlive this object.
  RenderService(const RenderServices& services, std::size_t image_cache_bytes, std::size_t film_cache_bytes,
                double request_rays);

  // Returns the image of the order: cached, or rendered and encoded once for all requests that wait for it.
  // An image with a time budget is rendered for each request, and the steps in `trace` count towards the
  // budget. Throws BudgetMissed, ClientLimitExceeded, Busy, Cancelled and TimedOut. Throws TooManyRays if the
  // image is not cached and its estimated cost exceeds the limit of one request.
  Rendered render(const RenderOrder& order, RequestTrace& trace);

  // Throws TooManyRays if the estimated cost of the image exceeds the limit of one request.
  void require_request_rays(const Scene& scene, const Plan& plan) const;
  // Returns the maximum rays and seconds that one request may use to meet its budget.
  RenderControl limits_of(const Scene& scene, const Plan& plan) const;

  Pictures& pictures() { return pictures_; }
  const Pictures& pictures() const { return pictures_; }
  const Films& films() const { return films_; }

 private:
  struct Run;

  // The steps of render(), in this order.
  Rendered look_up(Run& run);
  Picture make(Run& run, const std::stop_token& stop);
  Films::LookupResult obtain_film(Run& run, const std::stop_token& stop);
  Admission::Ticket queue(Run& run, const SlotRequest& demand, const std::stop_token& stop);
  // Throws LimitExceeded if the time budget ends in the queue.
  Admission::Ticket queue_with_time_limit(const Run& run, const SlotRequest& demand,
                                          const std::stop_token& stop);
  RenderResult render_film(Run& run, FilmStorage storage, const std::stop_token& stop);
  Picture encode(Run& run, const Films::LookupResult& film);

  const RenderServices& services_;
  const double request_rays_;
  SubscribersByKey subscribers_;  // by image, regardless of its format
  Pictures pictures_;
  Films films_;
};

}  // namespace orrery
