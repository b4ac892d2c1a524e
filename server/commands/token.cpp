#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "server/base/request_id.h"
#include "server/commands/commands.h"
#include "server/security/access.h"

namespace orrery {
namespace {

constexpr const char* kTokenExamples = R"(
Examples:
  orrery token alice --scopes read,render >> tokens      # prints the token
  orrery serve --tokens-file tokens
  curl -H "Authorization: Bearer $TOKEN" http://127.0.0.1:8080/v1/limits
)";

struct TokenOptions {
  std::string name, scopes = "read,render,write";
};

int make_token(const TokenOptions& options) {
  const bool word =
      !options.name.empty() && std::all_of(options.name.begin(), options.name.end(),
                                           [](char c) { return c > ' ' && c != 0x7F && c != '#'; });
  if (!word) throw InputError("NAME", "must not be empty or contain spaces, control characters or \"#\"");
  parse_scopes(options.scopes);
  constexpr std::size_t kBytes = 32;
  const std::string token = random_hex(kBytes);
  std::cout << token_line(options.name, options.scopes, token) << std::endl;
  std::cerr << "token: " << token << "\n";
  return kDone;
}

}  // namespace

Command add_token(CLI::App& root) {
  const auto options = std::make_shared<TokenOptions>();
  CLI::App* app = root.add_subcommand("token", "Create an access token for the service");
  app->footer(kTokenExamples);
  app->add_option("NAME", options->name, "Name of the client")->required()->group("Arguments");
  app->add_option("--scopes", options->scopes,
                  "Scopes: read, render, write, or admin to remove data of other clients too (default " +
                      options->scopes + ")")
      ->type_name("SCOPE,...");
  return {app, [options] { return make_token(*options); }};
}

}  // namespace orrery
