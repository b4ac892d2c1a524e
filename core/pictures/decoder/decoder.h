#pragma once

#include <string>
#include <string_view>

#include "core/pictures/picture.h"

// What liborrery_pictures.so exports. It stands apart because OpenImageIO loads 261 shared objects:
// read_picture() opens it once a scene has a picture.
extern "C" {

// Sets `picture` to the values as they are encoded in a file of this format, or `problem` to what is wrong
// with it. `stopped` is asked now and then; once it returns true the work is left with a problem.
using OrreryDecodePicture = void(std::string_view bytes, orrery::PictureFormat format,
                                 const orrery::PictureLimits& limits, bool (*stopped)(),
                                 orrery::Texels& picture, std::string& problem);

[[gnu::visibility("default")]] OrreryDecodePicture orrery_decode_picture;
}
