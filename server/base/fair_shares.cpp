#include "server/base/fair_shares.h"

#include <algorithm>

namespace orrery {

FairShares::Rank FairShares::Entry::rank() const {
  Rank highest = kRanks - 1;
  while (highest > 0 && holders_by_rank[highest] == 0) --highest;
  return highest;
}

void FairShares::hold(const std::string& id, const std::string& client, Rank rank) {
  const auto entry = entries_.try_emplace(id).first;
  set_use(entry, ++uses_, now_());
  add_hold(entry, client, rank);
}

void FairShares::set_weight(const std::string& id, std::size_t weight) {
  Entry& entry = entries_.at(id);
  if (weight == entry.weight) return;
  for (const auto& [client, hold] : entry.holders) {
    const auto holder = clients_.find(client);
    set_weight_of(holder, holder->second.weight - entry.weight + weight);
  }
  weight_ += weight - entry.weight;
  entry.weight = weight;
}

void FairShares::touch(const std::string& id) {
  if (const auto entry = entries_.find(id); entry != entries_.end()) set_use(entry, ++uses_, now_());
}

bool FairShares::release(const std::string& id, const std::string& client) {
  if (!holds(id, client)) return false;
  const auto entry = entries_.find(id);
  const bool is_last = entry->second.holders.size() == 1;
  give_up(entry, client);
  return is_last;
}

void FairShares::erase(const std::string& id) {
  for (const std::string& client : holders(id)) release(id, client);
}

std::optional<FairShares::Rank> FairShares::rank(const std::string& id, const std::string& client) const {
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return std::nullopt;
  const auto hold = entry->second.holders.find(client);
  return hold == entry->second.holders.end() ? std::nullopt : std::optional(hold->second.rank);
}

std::optional<FairShares::Rank> FairShares::rank(const std::string& id) const {
  const auto entry = entries_.find(id);
  return entry == entries_.end() ? std::nullopt : std::optional(entry->second.rank());
}

std::size_t FairShares::weight(const std::string& id) const {
  const auto entry = entries_.find(id);
  return entry == entries_.end() ? 0 : entry->second.weight;
}

std::vector<std::string> FairShares::holders(const std::string& id) const {
  std::vector<std::string> clients;
  if (const auto entry = entries_.find(id); entry != entries_.end())
    for (const auto& [client, hold] : entry->second.holders) clients.push_back(client);
  return clients;
}

void FairShares::add_hold(Entries::iterator entry, const std::string& client, Rank rank) {
  by_use_[entry->second.rank()].erase(entry->second.use);
  const auto [holder, is_new] = clients_.try_emplace(client);
  if (is_new) by_weight_.emplace(0, client);
  const auto [hold, is_first] = entry->second.holders.try_emplace(client);
  if (is_first)
    set_weight_of(holder, holder->second.weight + entry->second.weight);
  else
    remove_from(holder->second, entry->second, hold->second);
  hold->second = {rank, entry->second.use};
  ++entry->second.holders_by_rank[rank];
  holder->second.entries[rank].emplace(entry->second.use, entry);
  by_use_[entry->second.rank()].emplace(entry->second.use, entry);
}

void FairShares::remove_from(Client& client, Entry& entry, const Hold& hold) {
  client.entries[hold.rank].erase(hold.seen);
  --entry.holders_by_rank[hold.rank];
}

void FairShares::give_up(Entries::iterator entry, const std::string& client) {
  const auto hold = entry->second.holders.find(client);
  const auto holder = clients_.find(client);
  const auto& own = holder->second.entries;
  by_use_[entry->second.rank()].erase(entry->second.use);
  remove_from(holder->second, entry->second, hold->second);
  set_weight_of(holder, holder->second.weight - entry->second.weight);
  if (std::all_of(own.begin(), own.end(), [](const auto& entries) { return entries.empty(); })) {
    by_weight_.erase({holder->second.weight, client});
    clients_.erase(holder);
  }
  entry->second.holders.erase(hold);
  if (!entry->second.holders.empty()) {
    by_use_[entry->second.rank()].emplace(entry->second.use, entry);
    return;
  }
  weight_ -= entry->second.weight;
  entries_.erase(entry);
}

void FairShares::set_weight_of(Clients::iterator client, std::size_t weight) {
  by_weight_.erase({client->second.weight, client->first});
  client->second.weight = weight;
  by_weight_.emplace(weight, client->first);
}

void FairShares::set_use(Entries::iterator entry, std::uint64_t use, Clock::time_point used) {
  auto& by_use = by_use_[entry->second.rank()];
  by_use.erase(entry->second.use);
  by_use.emplace(use, entry);
  entry->second.use = use;
  entry->second.used = used;
}

void FairShares::restore(const Loss& loss) {
  const auto [entry, is_new] = entries_.try_emplace(loss.id);
  set_use(entry, loss.use, loss.used);
  add_hold(entry, loss.client, loss.rank);
  if (is_new) set_weight(loss.id, loss.weight);
}

std::optional<FairShares::Loss> FairShares::longest_unused(Rank below) const {
  const auto now = now_();
  for (Rank rank = 0; rank < below; ++rank) {
    if (by_use_[rank].empty()) continue;
    const auto& [id, entry] = *by_use_[rank].begin()->second;
    if (now - entry.used <= protected_for_) continue;
    const auto& [client, hold] = *entry.holders.begin();
    return Loss{id, client, hold.rank, entry.weight, entry.use, entry.used};
  }
  return std::nullopt;
}

// Returns the client's least recently used entry of its lowest rank, or nullopt if all ranks are at least
// `below`. Updates the order of the client's list only here, so that the cost of a use does not depend on the
// number of holders.
std::optional<FairShares::Loss> FairShares::least_recently_used(Clients::iterator client, Rank below) {
  for (Rank rank = 0; rank < below; ++rank) {
    auto& entries = client->second.entries[rank];
    while (!entries.empty()) {
      const auto [seen, least] = *entries.begin();
      const auto& [id, entry] = *least;
      if (seen == entry.use) return Loss{id, client->first, rank, entry.weight, entry.use, entry.used};
      entries.erase(entries.begin());
      entries.emplace(entry.use, least);
      least->second.holders.at(client->first).seen = entry.use;
    }
  }
  return std::nullopt;
}

std::optional<FairShares::Loss> FairShares::next_loss(const std::string& client, std::size_t more,
                                                      Ranks ranks) {
  if (auto loss = longest_unused(ranks.others)) return loss;
  const auto own = clients_.find(client);
  const std::size_t own_weight = more + (own == clients_.end() ? 0 : own->second.weight);
  for (auto heaviest = by_weight_.rbegin(); heaviest != by_weight_.rend(); ++heaviest) {
    if (heaviest->first <= own_weight) break;
    if (heaviest->second == client) continue;
    if (auto loss = least_recently_used(clients_.find(heaviest->second), ranks.others)) return loss;
  }
  return own == clients_.end() ? std::nullopt : least_recently_used(own, ranks.own);
}

std::optional<std::vector<std::string>> FairShares::make_room(const std::string& client, std::size_t more,
                                                              std::size_t most, Ranks ranks) {
  std::vector<Loss> losses;
  std::vector<std::string> evicted;
  while (weight_ + more > most) {
    const auto loss = next_loss(client, more, ranks);
    if (!loss) {
      for (auto lost = losses.rbegin(); lost != losses.rend(); ++lost) restore(*lost);
      return std::nullopt;
    }
    losses.push_back(*loss);
    if (release(loss->id, loss->client)) evicted.push_back(loss->id);
  }
  return evicted;
}

}  // namespace orrery
