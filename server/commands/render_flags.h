#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/files.h"
#include "core/plan/request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace orrery {

// Flags of every command that renders or plans. Must not move after add_render_flags().
struct RenderFlags {
  std::string scene;                  // file name, or "-"
  std::string plan;                   // options as a query
  std::vector<std::string> texts;     // values, in the order of render_options()
  std::vector<CLI::Option*> options;  // in the order of render_options()
  bool full_model = false;
  int slice = Plan{}.slice;
};

void add_render_flags(CLI::App& app, RenderFlags& flags);
void add_threads_flag(CLI::App& app, int& threads);

// Returns the request of the flags. Throws InputError with flag names.
RenderRequest read_render_flags(const RenderFlags& flags);
// Returns the request for a picture in a file of this format; nullopt: no file. Throws InputError with flag
// names.
RenderRequest read_picture_flags(const RenderFlags& flags, std::optional<FileFormat> format);
// Returns the same problems with flag names instead of pointers to options.
InputError with_flag_names(const InputError& error);

}  // namespace orrery
