#include "server/commands/run.h"

#ifdef ORRERY_JEMALLOC
#include <jemalloc/jemalloc.h>

// jemalloc options. Free memory returns to the system after 1 s. Thread caches are limited to 8 blocks of
// each size up to 512 bytes, since each connection has a thread. Building trees without thread caches is 25 %
// slower.
const char* malloc_conf =
    "narenas:2,lg_tcache_max:9,tcache_nslots_small_max:8,"
    "background_thread:true,dirty_decay_ms:1000,muzzy_decay_ms:0";
#endif

// The dynamic loader picks the build of liborrery.so, the core library, for this CPU.
int main(int argc, char** argv) { return orrery::run(argc, argv); }
