#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "server/routes/router.h"

// OpenAPI description of the service.
namespace orrery {

// Returns the description of the routes that have an Operation, as JSON text. REQUIRES: all routes are added.
std::string openapi_text(const Router& router);

// Response that many endpoints share.
struct CommonResponse {
  int status;             // 0: any other error
  std::string_view name;  // name of the component
  std::string_view description;
  std::string_view header = {};  // name of a further header; empty: none
};
// Returns the common responses, in ascending order of status.
std::span<const CommonResponse> common_responses();

// Returns the shared parts of the document: schemas, parameters, headers, responses and securitySchemes.
nlohmann::ordered_json openapi_components();
// Returns a reference to a component: {"$ref": "#/components/KIND/NAME"}.
nlohmann::ordered_json component(std::string_view kind, std::string_view name);
// Returns the references to the query parameters of all render options.
nlohmann::ordered_json option_parameters();

}  // namespace orrery
