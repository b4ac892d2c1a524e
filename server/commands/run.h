#pragma once

namespace orrery {

// Runs the command line and returns the exit status: 0 success, 1 failure, 2 invalid input or usage, 3 missed
// budget, 130 interrupted. Throws nothing.
int run(int argc, char** argv);

}  // namespace orrery
