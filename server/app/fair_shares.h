#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/clock.h"

namespace orrery {

// The clients that hold the entries of a store, and which entries a full store evicts. An entry counts in
// full for each client that holds it, and stays until the last of them gives it up. The client that holds
// most gives up its least recently used entry first. So a client that loses an entry holds at least an equal
// share of the store, whatever others add. Entries that nobody has used for a long time go before all others,
// so that clients that never return leave their shares to those that came after them. Not thread-safe.
class FairShares {
 public:
  // A client gives up all its entries of a lower rank before those of a higher one.
  using Rank = std::size_t;
  static constexpr Rank kRanks = 3;

  // protected_for: after its latest use, an entry belongs to the share of its holders.
  explicit FairShares(Clock::duration protected_for, std::function<Clock::time_point()> now = Clock::now)
      : protected_for_(protected_for), now_(std::move(now)) {}
  FairShares(const FairShares&) = delete;

  // From now on the client holds the entry, by that rank; that is a use. A new entry weighs nothing.
  void hold(const std::string& id, const std::string& client, Rank rank = 0);
  void set_weight(const std::string& id, std::size_t weight);  // REQUIRES: somebody holds it
  void touch(const std::string& id);                           // it is used
  // The client does not hold the entry any more. Whether it was the last one.
  bool release(const std::string& id, const std::string& client);
  void erase(const std::string& id);

  bool holds(const std::string& id, const std::string& client) const { return rank(id, client).has_value(); }
  // The rank by which the client holds it, and the highest by which anybody does; none: not at all.
  std::optional<Rank> rank(const std::string& id, const std::string& client) const;
  std::optional<Rank> rank(const std::string& id) const;
  std::vector<std::string> holders(const std::string& id) const;
  std::size_t weight(const std::string& id) const;  // 0: nobody holds it
  std::size_t weight() const { return weight_; }    // of all entries, each counted once

  // Which entries may be given up: those of ranks below these.
  struct Ranks {
    Rank own = kRanks, others = kRanks;
  };
  // Has clients give up entries until all weigh at most `most` beside `more` that the client is about to add.
  // Returns the entries that nobody holds any more; or none if the client would hold most and has nothing
  // else to give up, and then nothing has changed.
  std::optional<std::vector<std::string>> make_room(const std::string& client, std::size_t more,
                                                    std::size_t most, Ranks ranks);

 private:
  struct Hold {
    Rank rank;
    std::uint64_t seen;  // use of the entry by which the client's list has it: the latest, or one before
  };
  struct Entry {
    std::size_t weight = 0;
    std::uint64_t use = 0;  // the number of its latest use
    Clock::time_point used{};
    std::map<std::string, Hold> holders;
    std::array<std::size_t, kRanks> holders_by_rank{};
    Rank rank() const;  // the highest of its holders
  };
  using Entries = std::map<std::string, Entry>;
  using ByUse = std::array<std::map<std::uint64_t, Entries::iterator>, kRanks>;  // of each rank
  struct Client {
    std::size_t weight = 0;
    ByUse entries;
  };
  using Clients = std::map<std::string, Client>;
  struct Loss {
    std::string id, client;
    Rank rank;
    std::size_t weight;
    std::uint64_t use;
    Clock::time_point used;
  };

  void add_hold(Entries::iterator entry, const std::string& client, Rank rank);
  static void remove_from(Client& client, Entry& entry, const Hold& hold);
  void give_up(Entries::iterator entry, const std::string& client);
  void set_weight_of(Clients::iterator client, std::size_t weight);
  void set_use(Entries::iterator entry, std::uint64_t use, Clock::time_point used);
  void restore(const Loss& loss);
  // What is given up next; none: the client would hold most.
  std::optional<Loss> next_loss(const std::string& client, std::size_t more, Ranks ranks);
  std::optional<Loss> longest_unused(Rank below) const;
  std::optional<Loss> least_used(Clients::iterator client, Rank below);

  const Clock::duration protected_for_;
  const std::function<Clock::time_point()> now_;
  Entries entries_;
  ByUse by_use_;
  Clients clients_;                                          // those that hold entries
  std::set<std::pair<std::size_t, std::string>> by_weight_;  // the same
  std::size_t weight_ = 0;
  std::uint64_t uses_ = 0;
};

}  // namespace orrery
