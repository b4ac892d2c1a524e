#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace orrery {

// A subcommand. `run` is called after parsing, on the main thread. It returns the exit status or throws a
// std::exception: InputError or BadScene (kBadInput), BudgetMissed (kMissed), Cancelled (kInterrupted), or
// any other (kFailed).
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command add_render(CLI::App& root);
Command add_view(CLI::App& root);
Command add_inspect(CLI::App& root);
Command add_import(CLI::App& root);
Command add_orbit(CLI::App& root);
Command add_serve(CLI::App& root);
Command add_token(CLI::App& root);
Command add_check(CLI::App& root);
Command add_explain(CLI::App& root);
Command add_chart(CLI::App& root);
Command add_history(CLI::App& root);
Command add_audit(CLI::App& root);
Command add_catalog(CLI::App& root);
Command add_schema(CLI::App& root);
Command add_openapi(CLI::App& root);
Command add_stability(CLI::App& root);
Command add_help(CLI::App& root);

// Exit statuses of the program.
inline constexpr int kDone = 0, kFailed = 1, kBadInput = 2, kMissed = 3, kInterrupted = 130;

}  // namespace orrery
