#include "server/run.h"

// All of the program lives in liborrery.so, of which the loader picks the build for this machine.
int main(int argc, char** argv) { return orrery::run(argc, argv); }
