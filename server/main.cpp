#include "server/run.h"

#ifdef ORRERY_JEMALLOC
#include <jemalloc/jemalloc.h>

// Memory that is free goes back to the system after a second, and no thread holds back some of its own: there
// is one for each connection.
const char* malloc_conf =
    "narenas:2,tcache:false,background_thread:true,dirty_decay_ms:1000,muzzy_decay_ms:0";
#endif

// All of the program lives in liborrery.so, of which the loader picks the build for this machine.
int main(int argc, char** argv) { return orrery::run(argc, argv); }
