#pragma once

#include "core/pictures/picture_file.h"

namespace orrery {

// Decodes a file to linear light in a process of its own, orrery-decode, which lies beside the executable or
// in the folder above. The process may allocate kDecoderBytes and what the file's size explains; both are
// charged to the memory account of this thread. It is killed if this work is cancelled, within 20 ms.
//
// Throws InputError (pointer "") if the file is damaged, needs more memory, or makes the library crash;
// Cancelled; std::bad_alloc if the account refuses the memory.
Texels decode_in_process(const PictureFile& file);

}  // namespace orrery
