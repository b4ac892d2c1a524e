#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace orrery {

// Prefix of group names. The help of a command lists the options of these groups by name only, and
// `orrery help options` describes them.
inline constexpr std::string_view kListed = "listed: ";

// Sets the help layout of `root` and of subcommands that are added later: at most 80 columns.
void set_help_layout(CLI::App& root);

// Returns the help of the app's options by group, in the same layout.
std::string option_groups_text(const CLI::App& app);

// Formats the range of a number: "1-4096", "-180 to 180".
std::string range_text(double min, double max);
// Appends a range and, unless `fallback` is empty, a default: "Frames (1-1000, default 120)".
std::string with_range(std::string_view help, double min, double max, std::string_view fallback);

}  // namespace orrery
