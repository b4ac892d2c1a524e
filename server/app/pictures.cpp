#include "server/app/pictures.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>

#include "core/base/error.h"
#include "server/app/watch.h"

namespace orrery {

Pictures::Found Pictures::get(const std::string& key, const Gone& gone,
                              const std::function<Picture(const Gone&)>& make) {
  constexpr std::chrono::milliseconds kAsk{20};
  for (;;) {
    std::unique_lock lock(mutex_);
    if (const auto kept = kept_.find(key)) return {*kept, false};
    const auto [entry, first] = under_way_.try_emplace(key);
    if (first) entry->second = std::make_shared<Work>();
    const WorkPtr work = entry->second;
    const auto self = work->waiting.insert(work->waiting.end(), &gone);
    if (first) {
      lock.unlock();
      return make_for_all(key, work, make);
    }
    bool left = false;
    while (!work->done && !left) {
      work->changed.wait_for(lock, kAsk);
      lock.unlock();
      left = gone();
      lock.lock();
    }
    work->waiting.erase(self);
    if (work->picture) return {work->picture, false};
    if (work->error) std::rethrow_exception(work->error);
    if (left) throw Cancelled("the client has gone");
  }
}

Pictures::Found Pictures::make_for_all(const std::string& key, const WorkPtr& work,
                                       const std::function<Picture(const Gone&)>& make) {
  std::exception_ptr error;
  bool theirs = false;  // whether the error concerns the others
  PicturePtr picture;
  try {
    picture = std::make_shared<const Picture>(make([this, &work] { return nobody_waits(*work); }));
    keep(key, picture);
  } catch (const Busy&) {
    error = std::current_exception();
  } catch (const Cancelled&) {  // another may have come at the last moment
    error = std::current_exception();
  } catch (const TimedOut&) {  // it came first, and others have more time
    error = std::current_exception();
  } catch (...) {
    error = std::current_exception();
    theirs = true;
  }
  {
    const std::lock_guard lock(mutex_);
    under_way_.erase(key);
    work->done = true;
    work->picture = picture;
    if (theirs) work->error = error;
    work->changed.notify_all();
  }
  if (error) std::rethrow_exception(error);
  return {picture, true};
}

bool Pictures::nobody_waits(const Work& work) {
  const std::lock_guard lock(mutex_);
  return std::all_of(work.waiting.begin(), work.waiting.end(), [](const Gone* gone) { return (*gone)(); });
}

void Pictures::keep(const std::string& key, const PicturePtr& picture) {
  constexpr std::size_t kBeside = 4096;  // what the allocator adds to a large block, and the entries here
  const std::string& held = picture->bytes;
  const bool has_block = held.capacity() > std::string().capacity();
  const std::size_t block = has_block ? malloc_usable_size(const_cast<char*>(held.data())) : 0;
  const std::size_t bytes = kBeside + key.size() + block;
  if (bytes <= kept_.most_bytes()) kept_.add(key, bytes, [&] { return picture; });
}

}  // namespace orrery
