#include "server/routes/constant.h"

#include <memory>
#include <mutex>
#include <string>

#include "core/base/hash.h"
#include "core/base/task_scope.h"
#include "server/http/compression.h"
#include "server/routes/answers.h"

namespace orrery {
namespace {

class Constant {
 public:
  Constant(std::string_view type, std::function<SharedBytes()> make) : type_(type), make_(std::move(make)) {}

  Response answer(const Request& request) {
    std::call_once(made_, [this] {
      const TaskScope nobody({});  // memory is charged to no client, since any client may be the first
      bytes_ = make_();
      gzip_ = gzip_of(type_, bytes_);
      etag_ = "\"" + sha256_hex(bytes_).substr(0, 32) + "\"";
    });
    Response response{.status = 304};
    if (!has_current(request, etag_)) {
      response = text_response(200, type_, bytes_);
      response.gzip = gzip_;
    }
    response.set("ETag", etag_).set("Cache-Control", "no-cache");
    return response;
  }

 private:
  const std::string type_;
  const std::function<SharedBytes()> make_;
  std::once_flag made_;
  SharedBytes bytes_, gzip_;  // const after the first request
  std::string etag_;          // const after the first request
};

}  // namespace

Route& add_constant(Router& router, std::string_view pattern, Scope scope, std::string_view type,
                    std::function<SharedBytes()> make) {
  const auto constant = std::make_shared<Constant>(type, std::move(make));
  return router.add("GET", pattern, scope, LogLevel::info,
                    [constant](Request& request) { return constant->answer(request); });
}

}  // namespace orrery
