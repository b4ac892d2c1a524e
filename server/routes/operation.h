#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Description of an endpoint in the OpenAPI document. Views refer to texts that live as long as the program.
// The document adds the parts that follow from the route:
//   scope other than `none`                   401, 403
//   placeholder in the path, except for PUT   404
//   body                                      400, 408, 411, 413, 415, 422, 429, 503, 504
//   render options                            400, 422, 429, 503, 504
//   ETag                                      304, If-None-Match
//   GET with the scope `read`                 parameters of signed links
//   every endpoint                            default, X-Request-ID
struct Operation {
  // Schema of a value: name of a component, path of a document that starts with "/", JSON text that starts
  // with "{", or "" for any value.
  using Schema = std::string_view;
  struct Content {
    std::string_view type;  // media type
    Schema schema = {};
  };
  struct Parameter {
    std::string_view name;
    std::string_view in;  // "path", "query" or "header"
    std::string_view description = {};
    Schema schema = R"({"type": "string"})";
  };
  struct Answer {  // response that is not one of the common errors
    int status;
    std::string description;
    std::vector<std::string_view> headers = {};  // names of components
    std::vector<Content> content = {};
    bool has_results = false;  // has the headers of an image, see server/api/results.h
  };
  enum class ETag { none, always, if_it_lasts };

  std::string_view id;  // operationId
  std::string_view summary;
  std::string_view description = {};
  std::vector<Parameter> parameters = {};  // includes the placeholders of the path
  bool renders = false;                    // takes render options as query parameters
  ETag etag = ETag::none;
  Content body = {};  // without a type: no body
  bool body_required = true;
  std::vector<Answer> answers;
  std::vector<int> errors = {};           // statuses of further errors
  std::string_view documented_path = {};  // path in the document if it differs from the pattern of the route
};

}  // namespace orrery
