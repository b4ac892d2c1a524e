#include "server/run.h"

#ifdef ORRERY_JEMALLOC
#include <jemalloc/jemalloc.h>

// Memory that is free goes back to the system after a second. A thread, of which there is one for each
// connection, holds back at most eight pieces of each size up to 512 bytes: none made trees a quarter slower.
const char* malloc_conf =
    "narenas:2,lg_tcache_max:9,tcache_nslots_small_max:8,"
    "background_thread:true,dirty_decay_ms:1000,muzzy_decay_ms:0";
#endif

// All of the program lives in liborrery.so, of which the loader picks the build for this machine.
int main(int argc, char** argv) { return orrery::run(argc, argv); }
