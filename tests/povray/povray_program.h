#pragma once

#include <string>

#include "tests/povray/picture.h"

namespace orrery {

bool povray_is_installed();

// Runs POV-Ray on <folder>/povray.pov, one sample per pixel, and returns the image as linear values in [0,
// 1]. The output goes to <folder>/povray.log. Throws std::runtime_error with the path of the log if the run
// fails. Requires a folder below the working directory, because POV-Ray may be configured to write only
// there.
Picture run_povray(const std::string& folder, int width, int height);

}  // namespace orrery
