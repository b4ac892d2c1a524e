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

// The options of every command that renders or plans. Must stay where it is once added to a command line.
struct RenderFlags {
  std::string scene;                  // a file's name, or "-"
  std::string plan;                   // options as a query has them
  std::vector<std::string> texts;     // of values, as render_options()
  std::vector<CLI::Option*> options;  // likewise
  bool full_model = false;
  int slice = Plan{}.slice;
};

void add_render_flags(CLI::App& app, RenderFlags& flags);
void add_threads_flag(CLI::App& app, int& threads);

// Throws InputError with the names of the flags.
RenderRequest read_render_flags(const RenderFlags& flags);
// Likewise, of a picture for a file of this format; none: that is not kept.
RenderRequest read_picture_flags(const RenderFlags& flags, std::optional<FileFormat> format);
// The same problems, with the names of flags in place of pointers to options.
InputError with_flag_names(const InputError& error);

}  // namespace orrery
