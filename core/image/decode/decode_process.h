#pragma once

#include "core/image/decode/picture_file.h"

namespace orrery {

// Decodes a file to linear light in a separate process, orrery-decode. The program must be in the folder of
// the executable, in the parent folder, or in ../libexec/orrery. Thread-safe. The process may allocate
// kDecoderBytes plus an allowance that depends on the image size. Both are charged to the memory account of
// the calling thread. Cancellation kills the process within 20 ms.
//
// Throws InputError (pointer "") if the file is damaged, needs more memory, or crashes the decoder, or if the
// program is missing. Throws std::system_error if the operating system refuses a process, pipe or file.
// Throws Cancelled, and std::bad_alloc if the account refuses the memory.
Texels decode_in_process(const PictureFile& file);

}  // namespace orrery
