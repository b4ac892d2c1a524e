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

// Render options as queries and command lines have them: names and texts.
namespace orrery {

// The option that has the name or the short name; null if none has.
const RenderOption* find_render_option(std::string_view name);
// All names and short names.
std::vector<std::string_view> render_option_names();

struct OptionText {
  const RenderOption* option;
  std::string given_as;  // what errors call it: "/azimuth" in a query, "--azimuth" on the command line
  std::string text;
};

// The options of a query, which errors call what `called` makes of their names; the names of `more` are
// passed over. Throws InputError for all others, and where an option has both of its names.
std::vector<OptionText> option_texts(const Fields& query,
                                     const std::function<std::string(std::string_view)>& called,
                                     std::span<const std::string_view> more = {});

// Lists have commas between their values. Throws InputError, as read_request() but with the names given.
RenderRequest read_option_texts(std::span<const OptionText> texts);

}  // namespace orrery
