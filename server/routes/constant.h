#pragma once

#include <functional>
#include <string_view>

#include "server/routes/router.h"

namespace orrery {

// Adds a GET route with the same response for every request. `make` is called for the first request, on its
// connection thread. Concurrent requests wait for it. If `make` throws, that request fails and another
// request calls `make` again. The bytes, their ETag and their compressed form are cached. Clients must
// revalidate (no-cache) and then get a 304. The returned route can be described.
Route& add_constant(Router& router, std::string_view pattern, Scope scope, std::string_view type,
                    std::function<SharedBytes()> make);

}  // namespace orrery
