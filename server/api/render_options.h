#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/plan/options.h"
#include "core/plan/request.h"
#include "server/http/message.h"

// Render options given as names and texts, in queries and on command lines.
namespace orrery {

// Returns the option with this name or short name, or null if the name is unknown.
const RenderOption* find_render_option(std::string_view name);
// Returns all names and short names.
std::vector<std::string_view> render_option_names();

struct OptionText {
  const RenderOption* option;
  std::string given_as;  // in errors: "/azimuth" (query), "--azimuth" (command line)
  std::string text;
};

// Returns the options of a query. `called` maps a name to the name in error messages. Skips the names in
// `more`. Throws InputError for other unknown names, and if an option is given under both of its names.
std::vector<OptionText> option_texts(const Fields& query,
                                     const std::function<std::string(std::string_view)>& called,
                                     std::span<const std::string_view> more = {});

// Parses the options. The values of a list are separated by commas. Throws the errors of read_request(), with
// `given_as` as their place.
RenderRequest read_option_texts(std::span<const OptionText> texts);

}  // namespace orrery
