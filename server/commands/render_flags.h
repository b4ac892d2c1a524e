#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/image/encode/files.h"
#include "core/plan/request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace orrery {

// Group of the options that the help of a command describes first.
inline constexpr const char* kCommonGroup = "Common options";
// Keys of the image options in that group. The help lists the other image options by name.
using CommonOptions = std::span<const std::string_view>;
inline constexpr std::array<std::string_view, 5> kCommonOptions{"width", "height", "samples", "max_error",
                                                                "time_limit_seconds"};

// Flags of every command that renders or plans. Must not move after add_render_flags().
struct RenderFlags {
  std::string scene;                  // file name, or "-"
  std::string plan;                   // options as a query
  std::vector<std::string> texts;     // values, in the order of render_options()
  std::vector<CLI::Option*> options;  // in the order of render_options()
  bool full_model = false;
  int slice = Plan{}.slice;
};

// Adds the argument SCENE and the image options.
void add_render_flags(CLI::App& app, RenderFlags& flags, CommonOptions common = kCommonOptions);
// The same with the argument MODEL, a mesh file.
void add_model_flags(CLI::App& app, RenderFlags& flags);
void add_threads_flag(CLI::App& app, int& threads);

// Returns the text of `orrery help options`.
std::string image_options_help();

// Returns the request of the flags. Throws InputError with flag names.
RenderRequest read_render_flags(const RenderFlags& flags);
// Returns the request for an image. `format`: format of its file, or nullopt if none is written. Throws
// InputError with flag names.
RenderRequest read_picture_flags(const RenderFlags& flags, std::optional<FileFormat> format);
// Returns the same problems with flag names instead of pointers to options.
InputError name_flags(const InputError& error);

// Returns make(). Throws InputError with flag names.
template <class Make>
auto with_flag_names(const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw name_flags(error);
  }
}

}  // namespace orrery
