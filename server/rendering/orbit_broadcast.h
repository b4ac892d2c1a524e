#pragma once

#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <stop_token>
#include <thread>

#include "server/rendering/orbit.h"
#include "server/rendering/render_services.h"

namespace orrery {

// Renders an orbit once for all its viewers. The frames repeat cyclically, and their numbers keep increasing.
// Each viewer gets one full orbit, which starts with the latest frame when it joins. A viewer has a mailbox
// for one frame. A newer frame replaces a frame that was not fetched in time. Rendering pauses while all
// mailboxes are full. It resumes at the next frame if fps is 0, otherwise at the frame that is due.
class OrbitBroadcast {
 public:
  // Each frame may take request_seconds.
  OrbitBroadcast(OrbitSpec spec, const RenderServices& services);
  ~OrbitBroadcast();

  const OrbitSpec& spec() const { return spec_; }
  bool is_watched_by(const std::string& client) const;

  class Viewer;
  // Adds a viewer. Returns null once the orbit is ending. Each frame has the earliest virtual finish time of
  // all viewers' clients; see Admission.
  static std::unique_ptr<Viewer> join(const std::shared_ptr<OrbitBroadcast>& cast, const std::string& client);

 private:
  struct Mailbox {
    std::string client;
    std::int64_t begin, end;  // numbers of the viewer's frames: [begin, end)
    std::shared_ptr<const OrbitFrame> frame;
    std::int64_t number = 0;   // number of `frame`
    std::int64_t fetched = 0;  // number of fetched frames
    bool wants(std::int64_t n) const { return n >= begin && n < end; }
  };

  void run();
  std::optional<std::int64_t> next();
  RenderResult render(std::int64_t number);
  void deliver(std::int64_t number, Frame&& frame);
  // REQUIRES for the functions below: mutex_ is held.
  void post();  // moves finished frames into the mailboxes
  bool anyone_free(std::int64_t number) const;
  bool anyone_wants(std::int64_t number) const;
  bool at_end(const Mailbox& mailbox) const;  // no more frames will arrive

  const OrbitSpec spec_;
  const RenderServices services_;
  const std::shared_ptr<WorkAccount> memory_;  // account of films; encoded frames have another one
  const std::shared_ptr<Subscribers> subscribers_ = std::make_shared<Subscribers>();
  std::stop_source nobody_watches_;  // requested when the last viewer disconnects
  mutable std::mutex mutex_;         // guards the members below
  std::condition_variable_any changed_;
  std::list<Mailbox> mailboxes_;
  std::int64_t next_ = 0;  // number of the frame to render next
  std::deque<std::pair<std::int64_t, std::shared_ptr<const OrbitFrame>>> finished_;  // not yet delivered
  std::int64_t delivered_ = 0;                // number of the last posted frame, plus 1
  std::shared_ptr<const OrbitFrame> latest_;  // last delivered frame, or null
  Clock::time_point start_;     // due time of frame 0; postponed if rendering is slower than fps
  bool closed_ = false;         // no more frames will be rendered
  bool over_ = false;           // no more frames will be delivered
  std::exception_ptr failure_;  // error that ended rendering
  std::thread thread_;          // last: uses the members above
};

// Viewer of an orbit. Not thread-safe.
class OrbitBroadcast::Viewer {
 public:
  ~Viewer();
  Viewer(const Viewer&) = delete;

  // Waits for the newest unseen frame and returns it. Returns null at the end of the orbit, when the service
  // ends, or once `gone` is requested. Throws the error that ended rendering, such as TimedOut.
  std::shared_ptr<const OrbitFrame> next(const std::stop_token& gone);
  // Returns the number of frames before the last fetched frame that this viewer missed.
  std::int64_t skipped() const { return skipped_; }
  // Returns whether the last fetched frame was the final one.
  bool at_end() const { return at_end_; }

 private:
  friend class OrbitBroadcast;
  Viewer(std::shared_ptr<OrbitBroadcast> cast, std::list<Mailbox>::iterator mailbox,
         const std::string& client)
      : cast_(std::move(cast)),
        mailbox_(mailbox),
        sharing_(cast_->services_.admission, cast_->subscribers_, client) {}

  const std::shared_ptr<OrbitBroadcast> cast_;
  const std::list<Mailbox>::iterator mailbox_;
  const Admission::Subscription sharing_;
  std::int64_t skipped_ = 0;
  bool at_end_ = false;
};

}  // namespace orrery
