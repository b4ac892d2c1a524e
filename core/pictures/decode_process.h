#pragma once

#include "core/pictures/picture_file.h"

namespace orrery {

// Decodes a file to linear light in a separate process, orrery-decode. The program must be in the folder of
// the executable or in its parent. The process may allocate kDecoderBytes and what the file's size justifies.
// Both are charged to the memory account of this thread. Cancellation kills the process within 20 ms.
//
// Throws InputError (pointer "") if the file is damaged, needs more memory, or crashes the library. Throws
// Cancelled, and std::bad_alloc if the account rejects the memory.
Texels decode_in_process(const PictureFile& file);

}  // namespace orrery
