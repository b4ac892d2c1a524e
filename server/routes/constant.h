#pragma once

#include <functional>
#include <string_view>

#include "server/routes/router.h"

namespace orrery {

// Adds a GET route whose answer is the same for every request: `make` is called for the first, and then the
// bytes, their ETag and their compressed form are kept and shared. The answer has to be asked about each time
// (no-cache), which 304 then ends.
void add_constant(Router& router, std::string_view pattern, Scope scope, std::string_view type,
                  std::function<SharedBytes()> make);

}  // namespace orrery
