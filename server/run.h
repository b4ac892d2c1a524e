#pragma once

namespace orrery {

// Runs the command line and returns the exit status of the process: 0 done, 1 failed, 2 wrong usage. Throws
// nothing. The one symbol that liborrery.so exports.
__attribute__((visibility("default"))) int run(int argc, char** argv);

}  // namespace orrery
