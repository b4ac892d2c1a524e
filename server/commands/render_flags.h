#pragma once

#include <string>
#include <vector>

#include "core/plan/plan.h"
#include "core/plan/request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace orrery {

// The options of every command that renders or plans. Must stay where it is once added to a command line.
struct RenderFlags {
  std::string scene;                  // a file's name, or "-"
  std::vector<std::string> values;    // as render_options()
  std::vector<CLI::Option*> options;  // likewise
  bool full_model = false;
  int slice = Plan{}.slice;
};

void add_render_flags(CLI::App& app, RenderFlags& flags);
void add_threads_flag(CLI::App& app, int& threads);

// Both throw InputError with the names of the command line.
RenderRequest read_render_flags(const RenderFlags& flags);
Plan plan_for(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
