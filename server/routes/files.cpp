#include <array>

#include "server/app/app.h"
#include "server/base/embedded.h"
#include "server/routes/constant.h"

// Serves embedded files: GET / and the files of the page, GET /scenes/{name}.json and GET
// /scenes/thumbnails/{name}.webp.
namespace orrery {
namespace {

std::string_view type_of(std::string_view path) {
  struct Ending {
    std::string_view ending, type;
  };
  constexpr std::array kEndings{
      Ending{".html", "text/html; charset=utf-8"},
      Ending{".js", "text/javascript; charset=utf-8"},
      Ending{".css", "text/css; charset=utf-8"},
      Ending{".json", "application/json"},
      Ending{".svg", "image/svg+xml; charset=utf-8"},
      Ending{".png", "image/png"},
      Ending{".webp", "image/webp"},
      Ending{".ico", "image/x-icon"},
      Ending{".webmanifest", "application/manifest+json"},
  };
  for (const auto& [ending, type] : kEndings)
    if (path.ends_with(ending)) return type;
  return "application/octet-stream";
}

Route& add_file(Router& router, std::string_view address, const EmbeddedFile& file) {
  return add_constant(router, address, Scope::none, type_of(file.path),
                      [file] { return SharedBytes(nullptr, file.bytes); });
}

}  // namespace

void add_files_routes(Router& router, App&) {
  const Operation sample{.id = "get_sample",
                         .summary = "Returns a sample scene",
                         .parameters = {{"file", "path", "Name of a sample scene, followed by .json"}},
                         .etag = Operation::ETag::always,
                         .answers = {{200, "The scene", {}, {{"application/json", "/schemas/scene.json"}}}},
                         .documented_path = "/scenes/{file}"};
  const Operation thumbnail{.id = "get_thumbnail",
                            .summary = "Returns a thumbnail of a sample scene",
                            .parameters = {{"file", "path", "Name of a sample scene, followed by .webp"}},
                            .etag = Operation::ETag::always,
                            .answers = {{200, "The image, at most 384 x 288 pixels", {}, {{"image/webp"}}}},
                            .documented_path = "/scenes/thumbnails/{file}"};
  constexpr std::string_view kPage = "web/", kScenes = "scenes/", kSchemas = "scenes/schema/";
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.path == "web/index.html") add_file(router, "/", file);
    if (file.path.starts_with(kPage))
      add_file(router, "/" + std::string(file.path.substr(kPage.size())), file);
    else if (file.path.starts_with(kScenes) && !file.path.starts_with(kSchemas))
      add_file(router, "/" + std::string(file.path), file)
          .describe(file.path.ends_with(".webp") ? thumbnail : sample);
  }
}

}  // namespace orrery
