#pragma once

namespace orrery {

// Runs the command line and returns the exit status: 0 done, 1 failed, 2 wrong input or usage, 3 budget
// missed, 130 interrupted. Throws nothing. liborrery.so exports no other symbol.
__attribute__((visibility("default"))) int run(int argc, char** argv);

}  // namespace orrery
