#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/plan/request.h"

namespace orrery {

// One thing that a render may be asked beside its scene. It has three names: one in the query of an address,
// one in the JSON of a request and one on the command line; all three are read by the same code,
// read_request().
struct RenderOption {
  std::string_view name;          // "azimuth"
  std::string_view section, key;  // "camera", "azimuth_degrees"
  std::string_view flags;         // "--azimuth"
  std::string_view value;         // what the help calls its value: "DEGREES"
  std::string_view help;
};
std::span<const RenderOption> render_options();

// Names of options and their values as text.
using OptionValues = std::vector<std::pair<std::string, std::string>>;

// Throws InputError; its pointers are those of the JSON form ("/camera/azimuth_degrees").
// REQUIRES: every name is one of render_options().
RenderRequest read_render_options(const OptionValues& values);

// The same problems, with the pointers of options replaced by the names under which they were given:
// "/azimuth" for a query, "--azimuth" for the command line. Other pointers stay.
enum class Naming { query, command_line };
InputError named_for(Naming naming, const InputError& error);

// Calls `work`; what it throws about options gets the names that the user knows.
template <class Work>
auto with_names_for(Naming naming, const Work& work) {
  try {
    return work();
  } catch (const MalformedJson&) {
    throw;
  } catch (const InputError& error) {
    throw named_for(naming, error);
  }
}

}  // namespace orrery
