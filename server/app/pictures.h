#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
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
  using Gone = std::function<bool()>;

  explicit Pictures(std::size_t most_bytes) : kept_(most_bytes) {}

  struct Found {
    PicturePtr picture;
    bool made_here;  // for this caller; or else it was kept, or made for another
  };
  // The picture called `key`. Where there is none, calls make(gone) on this thread; its `gone` says that
  // neither this caller nor others who came meanwhile wait any more. Throws what `make` throws, also for
  // those others, except that Busy, Cancelled and TimedOut concern the maker alone: one of the others then
  // makes it. Throws Cancelled once `gone` says so.
  Found get(const std::string& key, const Gone& gone, const std::function<Picture(const Gone&)>& make);

  std::size_t bytes() const { return kept_.bytes(); }

 private:
  struct Work {
    std::list<const Gone*> waiting;  // who wants it
    bool done = false;
    PicturePtr picture;        // once done, unless it failed
    std::exception_ptr error;  // likewise; none: somebody else has to make it
    std::condition_variable changed;
  };
  using WorkPtr = std::shared_ptr<Work>;

  Found make_for_all(const std::string& key, const WorkPtr& work,
                     const std::function<Picture(const Gone&)>& make);
  bool nobody_waits(const Work& work);
  void keep(const std::string& key, const PicturePtr& picture);

  Lru<PicturePtr> kept_;
  std::mutex mutex_;
  std::map<std::string, WorkPtr> under_way_;  // guarded by mutex_, and what it points at
};

}  // namespace orrery
