#pragma once

#include <string>
#include <vector>

#include "core/base/shorten.h"

namespace orrery {

// Notes of one kind about a file, of which only the first ones are kept.
class NoteList {
 public:
  // `more`: text of the note about further ones, after their number, such as " more files are missing".
  NoteList(std::size_t most, std::string more) : most_(most), more_(std::move(more)) {}

  void add(std::string note) {
    if (++count_ <= most_) notes_.push_back(std::move(note));
  }
  // Appends the notes, and one about the number of further ones.
  void move_to(std::vector<std::string>& notes) {
    for (std::string& note : notes_) notes.push_back(std::move(note));
    if (count_ > most_) notes.push_back(grouped(count_ - most_) + more_);
  }

 private:
  std::size_t most_, count_ = 0;
  std::string more_;
  std::vector<std::string> notes_;
};

}  // namespace orrery
