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

// Eviction policy of a store that clients share. The full weight of an entry counts for each client that
// holds the entry. The entry stays until its last holder releases it. The client with the largest total
// weight loses its least recently used entry first. A client with less than an equal share therefore loses
// nothing, whatever other clients add. Entries that were unused for a long time are evicted before all
// others, so that clients that never return lose their entries. Not thread-safe.
class FairShares {
 public:
  // Eviction order. A client loses all entries of a lower rank before any entry of a higher rank.
  using Rank = std::size_t;
  static constexpr Rank kRanks = 3;

  // Entries unused for more than `protected_for` are evicted first, whatever the weights of their holders.
  explicit FairShares(Clock::duration protected_for, std::function<Clock::time_point()> now = Clock::now)
      : protected_for_(protected_for), now_(std::move(now)) {}
  FairShares(const FairShares&) = delete;

  // Makes the client a holder of the entry with this rank, and records a use. A new entry has weight 0.
  void hold(const std::string& id, const std::string& client, Rank rank = 0);
  void set_weight(const std::string& id, std::size_t weight);  // REQUIRES: a client holds it
  void touch(const std::string& id);                           // records a use
  // Releases the entry for the client. Returns true if the client was its last holder.
  bool release(const std::string& id, const std::string& client);
  void erase(const std::string& id);  // releases the entry for all clients

  bool holds(const std::string& id, const std::string& client) const { return rank(id, client).has_value(); }
  // Returns the rank with which the client holds the entry, or the highest rank of all holders. Returns
  // nullopt if the entry is not held.
  std::optional<Rank> rank(const std::string& id, const std::string& client) const;
  std::optional<Rank> rank(const std::string& id) const;
  std::vector<std::string> holders(const std::string& id) const;
  std::size_t weight(const std::string& id) const;  // 0 if not held
  std::size_t weight() const { return weight_; }    // all entries, each counted once

  // Limits on eviction. The client itself loses only entries of ranks below `own`, other clients only entries
  // of ranks below `others`.
  struct Ranks {
    Rank own = kRanks, others = kRanks;
  };
  // Releases entries until the total weight is at most `most` - `more`, because the client is about to add
  // `more`. Returns the entries that no client holds any longer. Returns nullopt and changes nothing if
  // neither the client nor clients with more weight have enough entries to lose.
  std::optional<std::vector<std::string>> make_room(const std::string& client, std::size_t more,
                                                    std::size_t most, Ranks ranks);

 private:
  struct Hold {
    Rank rank;
    std::uint64_t seen;  // position in the client's list: a use number, may be outdated
  };
  struct Entry {
    std::size_t weight = 0;
    std::uint64_t use = 0;  // number of the latest use
    Clock::time_point used{};
    std::map<std::string, Hold> holders;
    std::array<std::size_t, kRanks> holders_by_rank{};
    Rank rank() const;  // highest of all holders
  };
  using Entries = std::map<std::string, Entry>;
  using ByUse = std::array<std::map<std::uint64_t, Entries::iterator>, kRanks>;  // by rank and use number
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
  // Returns the next hold to release, or nullopt if no hold may be released.
  std::optional<Loss> next_loss(const std::string& client, std::size_t more, Ranks ranks);
  std::optional<Loss> longest_unused(Rank below) const;
  std::optional<Loss> least_recently_used(Clients::iterator client, Rank below);

  const Clock::duration protected_for_;
  const std::function<Clock::time_point()> now_;
  Entries entries_;
  ByUse by_use_;
  Clients clients_;                                          // clients with entries
  std::set<std::pair<std::size_t, std::string>> by_weight_;  // (weight, client)
  std::size_t weight_ = 0;
  std::uint64_t uses_ = 0;
};

}  // namespace orrery
