#include "server/app/pictures.h"

#include <malloc.h>

#include "core/base/error.h"
#include "server/app/watch.h"

namespace orrery {

Pictures::Found Pictures::get(const std::string& key, const std::stop_token& gone, const Make& make) {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (const auto kept = kept_.find(key)) return {*kept, false};
    const auto [entry, first] = under_way_.try_emplace(key);
    if (first) entry->second = std::make_shared<Work>();
    const WorkPtr work = entry->second;
    ++work->waiting;
    lock.unlock();
    const std::stop_callback leaves(gone, [this, &work] { leave(*work); });
    if (first) return make_for_all(key, work, make);
    lock.lock();
    work->changed.wait(lock, gone, [&] { return work->done; });
    const PicturePtr picture = work->picture;
    const std::exception_ptr error = work->error;
    lock.unlock();  // before `leaves` goes: it may be waiting for the mutex
    if (picture) return {picture, false};
    if (error) std::rethrow_exception(error);
    if (gone.stop_requested()) throw Cancelled("the client has gone");
  }
}

int Pictures::waiting(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto work = under_way_.find(key);
  return work == under_way_.end() ? 0 : work->second->waiting;
}

void Pictures::leave(Work& work) {
  {
    const std::lock_guard lock(mutex_);
    if (--work.waiting > 0) return;
  }
  work.nobody_waits.request_stop();
}

Pictures::Found Pictures::make_for_all(const std::string& key, const WorkPtr& work, const Make& make) {
  std::exception_ptr error;
  bool theirs = false;  // whether the error concerns the others
  PicturePtr picture;
  try {
    picture = std::make_shared<const Picture>(make(work->nobody_waits.get_token()));
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

void Pictures::keep(const std::string& key, const PicturePtr& picture) {
  constexpr std::size_t kBeside = 4096;  // what the allocator adds to a large block, and the entries here
  const std::string& held = picture->bytes;
  const bool has_block = held.capacity() > std::string().capacity();
  const std::size_t block = has_block ? malloc_usable_size(const_cast<char*>(held.data())) : 0;
  const std::size_t bytes = kBeside + key.size() + block;
  if (bytes <= kept_.most_bytes()) kept_.add(key, bytes, [&] { return picture; });
}

}  // namespace orrery
