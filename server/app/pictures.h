#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include "core/render/renderer.h"
#include "server/app/lru.h"

namespace orrery {

// An encoded picture and what it took.
struct Picture {
  std::string bytes;
  RenderStats stats;
};

// Pictures made lately, by what they show, and those being made: what several ask for at one time is made
// once. Safe from any thread.
class Pictures {
 public:
  using PicturePtr = std::shared_ptr<const Picture>;
  // Makes a picture; a stop request says that nobody wants it any more.
  using Make = std::function<Picture(const std::stop_token&)>;

  explicit Pictures(std::size_t most_bytes) : kept_(most_bytes) {}

  struct Found {
    PicturePtr picture;
    bool made_here;  // for this caller; or else it was kept, or made for another
  };
  // The picture called `key`. Where there is none, calls `make` on this thread, with a token that is stopped
  // once neither this caller nor others who came meanwhile wait any more. Throws what `make` throws, also for
  // those others, except that Busy, Cancelled and TimedOut concern the maker alone: one of the others then
  // makes it. Throws Cancelled once `gone` is requested.
  Found get(const std::string& key, const std::stop_token& gone, const Make& make);

  std::size_t bytes() const { return kept_.bytes(); }
  // How many wait for the picture called `key`, which is being made, with the one who makes it.
  int waiting(const std::string& key) const;

 private:
  struct Work {
    int waiting = 0;                // how many want it
    std::stop_source nobody_waits;  // requested once none of them is left
    bool done = false;
    PicturePtr picture;        // once done, unless it failed
    std::exception_ptr error;  // likewise; none: somebody else has to make it
    std::condition_variable_any changed;
  };
  using WorkPtr = std::shared_ptr<Work>;

  void leave(Work& work);
  Found make_for_all(const std::string& key, const WorkPtr& work, const Make& make);
  void keep(const std::string& key, const PicturePtr& picture);

  Lru<PicturePtr> kept_;
  mutable std::mutex mutex_;
  std::map<std::string, WorkPtr> under_way_;  // guarded by mutex_, and what it points at
};

}  // namespace orrery
