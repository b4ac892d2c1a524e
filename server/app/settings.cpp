#include "server/app/settings.h"

#include <array>

namespace orrery {
namespace {

using S = Settings;
constexpr std::int64_t kMost = 1'000'000'000'000;

constexpr std::array kLimits{
    Limit{"body_bytes", &S::body_bytes, 1, 1'000'000'000, "Bytes of a request's body"},
    Limit{"bodies_bytes", &S::bodies_bytes, 1, kMost, "Bytes of the bodies of all requests at one time"},
    Limit{"store_bytes", &S::store_bytes, 1, kMost, "Bytes of scenes kept, by estimate"},
    Limit{"asset_bytes", &S::asset_bytes, 1, 4'000'000'000, "Bytes of a mesh file"},
    Limit{"asset_store_bytes", &S::asset_store_bytes, 1, kMost, "Bytes of mesh files kept"},
    Limit{"picture_bytes", &S::picture_bytes, 0, kMost, "Bytes of pictures kept for who asks again"},
    Limit{"connections", &S::connections, 1, 10'000,
          "Connections at once; streams may have three quarters of them, one client half of these"},
    Limit{"renders", &S::renders, 0, 1024, "Pieces of work at once; 0: two a thread"},
    Limit{"queue_rays", &S::queue_rays, 1, kMost,
          "Estimated rays (pixels x samples x levels of depth) of what waits for its turn, in each lane"},
    Limit{"interactive_rays", &S::interactive_rays, 1, kMost,
          "Estimated rays of one picture, beyond which it takes its turn among the long work"},
    Limit{"orbits", &S::orbits, 1, 10'000, "Different orbits streamed at once; half of them for one client"},
    Limit{"orbit_frames", &S::orbit_frames, 1, 1'000'000, "Frames of an orbit"},
    Limit{"request_seconds", &S::request_seconds, 1, 1'000'000, "Seconds that one picture may take"},
    Limit{"jobs", &S::jobs, 1, 1000, "Jobs under way at once; half of them for one client"},
    Limit{"jobs_kept", &S::jobs_kept, 1, 1'000'000, "Jobs that are kept after their end"},
    Limit{"job_bytes", &S::job_bytes, 1, kMost, "Bytes of the pictures of all jobs"},
    Limit{"job_seconds", &S::job_seconds, 1, 1'000'000, "Seconds that one job may take"},
    Limit{"job_kept_seconds", &S::job_kept_seconds, 1, 10'000'000,
          "Seconds that a job is kept after its end"},
    Limit{"grace_seconds", &S::grace_seconds, 1, 1'000'000,
          "Seconds that running requests get when the service ends"},
};

}  // namespace

std::span<const Limit> limits() { return kLimits; }

double Limit::value(const Settings& settings) const {
  return std::visit(
      [&](auto member) {
        const auto& field = settings.*member;
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, std::chrono::seconds>)
          return static_cast<double>(field.count());
        else
          return static_cast<double>(field);
      },
      setting);
}

void Limit::set(Settings& settings, std::int64_t value) const {
  std::visit(
      [&](auto member) {
        auto& field = settings.*member;
        field = std::decay_t<decltype(field)>(value);
      },
      setting);
}

}  // namespace orrery
