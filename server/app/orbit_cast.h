#pragma once

#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <stop_token>
#include <thread>

#include "server/app/orbit.h"
#include "server/app/render_services.h"

namespace orrery {

// Renders an orbit once for all who watch it. The frames run in a circle, numbered on and on; each viewer
// gets as many as the orbit has, beginning with the one that is shown when it comes in. A viewer has a
// mailbox for one frame: a newer frame takes the place of one that was not fetched in time. Nothing is
// rendered that nobody would see: the cast waits while all mailboxes are full. With fps 0 it then goes on
// where it was; else with the frame whose time has come.
class OrbitCast {
 public:
  // frame_time: that one frame may take.
  OrbitCast(OrbitSpec spec, const RenderServices& services, std::chrono::seconds frame_time);
  ~OrbitCast();

  const OrbitSpec& spec() const { return spec_; }
  bool is_watched_by(const std::string& client) const;

  class Viewer;
  // None once the cast is ending. Each frame is rendered in the earliest turn of any viewer's client.
  static std::unique_ptr<Viewer> join(const std::shared_ptr<OrbitCast>& cast, const std::string& client);

 private:
  struct Mailbox {
    std::string client;
    std::int64_t begin, end;  // numbers of the frames this viewer gets
    std::shared_ptr<const OrbitFrame> frame;
    std::int64_t number = 0;   // of `frame`
    std::int64_t fetched = 0;  // how many
    bool wants(std::int64_t n) const { return n >= begin && n < end; }
  };

  void run();
  std::optional<std::int64_t> next();
  RenderResult render(std::int64_t number);
  RenderResult try_render(const Plan& plan, const std::stop_token& stop);
  void deliver(std::int64_t number, Frame&& frame);
  // Below: with mutex_ held.
  void post();  // puts finished frames into the mailboxes, as far as they may
  bool anyone_free(std::int64_t number) const;
  bool anyone_wants(std::int64_t number) const;
  bool at_end(const Mailbox& mailbox) const;  // nothing more will be put into it

  const OrbitSpec spec_;
  const RenderServices services_;
  const std::shared_ptr<MemoryAccount> memory_;  // of films; frames have another like it
  const std::shared_ptr<Sharers> sharers_ = std::make_shared<Sharers>();
  const std::chrono::seconds frame_time_;
  std::stop_source nobody_watches_;  // then nobody can join either
  mutable std::mutex mutex_;         // guards all below
  std::condition_variable_any changed_;
  std::list<Mailbox> mailboxes_;
  std::int64_t next_ = 0;  // number of the frame to render next
  std::deque<std::pair<std::int64_t, std::shared_ptr<const OrbitFrame>>> finished_;  // not delivered yet
  std::int64_t delivered_ = 0;                // all before it are in the mailboxes or lost
  std::shared_ptr<const OrbitFrame> latest_;  // the one before it; none at first
  Clock::time_point start_;     // when frame 0 was due; moves on when rendering is slower than fps
  bool closed_ = false;         // no frames will be rendered any more
  bool over_ = false;           // none will be delivered any more
  std::exception_ptr failure_;  // why no frame could follow
  std::thread thread_;          // last: it uses the others
};

// One who watches. For one thread.
class OrbitCast::Viewer {
 public:
  ~Viewer();
  Viewer(const Viewer&) = delete;

  // The newest frame not seen yet; waits for it. None at the end of the orbit, when the service ends, or once
  // `gone` is requested. Throws what kept a frame from being rendered, such as TimedOut.
  std::shared_ptr<const OrbitFrame> next(const std::stop_token& gone);
  // Frames of the orbit up to the last one got that this viewer missed.
  std::int64_t skipped() const { return skipped_; }
  // Whether the frame got last was the last.
  bool at_end() const { return at_end_; }

 private:
  friend class OrbitCast;
  Viewer(std::shared_ptr<OrbitCast> cast, std::list<Mailbox>::iterator mailbox, const std::string& client)
      : cast_(std::move(cast)),
        mailbox_(mailbox),
        sharing_(cast_->services_.admission, cast_->sharers_, client) {}

  const std::shared_ptr<OrbitCast> cast_;
  const std::list<Mailbox>::iterator mailbox_;
  const Admission::Sharing sharing_;
  std::int64_t skipped_ = 0;
  bool at_end_ = false;
};

}  // namespace orrery
