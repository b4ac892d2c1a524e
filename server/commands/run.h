#pragma once

namespace orrery {

// Runs the command line and returns the exit status: 0 success, 1 failure, 2 invalid input or usage, 3 missed
// budget, 130 interrupted. Throws nothing. liborrery.so exports no other symbol.
__attribute__((visibility("default"))) int run(int argc, char** argv);

}  // namespace orrery
