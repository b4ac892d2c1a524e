#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/model/scene.h"
#include "server/commands/render_flags.h"

namespace orrery {

// Options of a command that renders one image.
struct RenderOptions {
  std::string stats, format;
  std::optional<std::string> output, certificate;
  RenderRequest (*complete)(RenderRequest) = nullptr;  // adds defaults of the command to a request
  int threads = 0;
  RenderFlags render;
};

// Adds the flags of the output, statistics and threads.
void add_output_flags(CLI::App& app, RenderOptions& options);

using LoadScene = std::function<std::shared_ptr<const Scene>(const RenderRequest&)>;

// Loads the scene, renders it, writes the files and prints the statistics that the options ask for. Returns
// the exit status. Throws as Command::run.
int render_image(const RenderOptions& options, const LoadScene& load);

}  // namespace orrery
