#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/meshes/note_list.h"

namespace orrery {

// Notes about contents of a scene description that the converted scene lacks, with the number of their
// occurrences.
class ImportNotes {
 public:
  // Adds a note of a kind, or counts it if the kind is known. `kind`: a sentence without a full stop.
  void add(const std::string& kind) {
    const auto [at, is_new] = counts_.try_emplace(kind, 0);
    if (is_new) {
      if (order_.size() == kMaxKinds) {
        ++further_;
        counts_.erase(at);
        return;
      }
      order_.push_back(kind);
    }
    ++at->second;
  }

  // Returns the notes in the order of their first occurrence.
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const std::string& kind : order_) {
      const std::size_t count = counts_.at(kind);
      texts.push_back(count == 1 ? kind : kind + " (" + grouped(count) + " times)");
    }
    if (further_ > 0) texts.push_back(grouped(further_) + " further things are not modelled");
    return texts;
  }

 private:
  static constexpr std::size_t kMaxKinds = 200;

  std::map<std::string, std::size_t> counts_;
  std::vector<std::string> order_;
  std::size_t further_ = 0;
};

}  // namespace orrery
