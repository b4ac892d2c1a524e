#pragma once

#include <string_view>

#include "server/routes/answers.h"

namespace orrery {

// Returns the PNG image of an order that depends only on the URL of the request, with its ETag and this
// Cache-Control. Renders nothing if the client has the current image or asks for the headers only. Images
// with a time budget or a missed budget have no ETag. Throws the errors of RenderService::render().
Response frame_response(App& app, const Request& request, const RenderOrder& order, RequestTrace& trace,
                        std::string_view cache_control);

}  // namespace orrery
