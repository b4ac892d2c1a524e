#pragma once

#include <span>

namespace orrery {

// Structural similarity of two pictures as a screen shows them, in [-1, 1]; 1 for equal ones. Of the luma of
// sRGB codes from 0 to 1, in windows of 11 x 11 pixels with Gaussian weights of standard deviation 1.5, which
// are cut at the picture's edge (Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error
// visibility to structural similarity", IEEE Transactions on Image Processing 13, 2004). It tells what people
// see better than RMSE does, and nobody can bound it. Values that are not finite count as 0.
// REQUIRES: linear colour, three values a pixel, row by row; as many in both, whole rows of `width` >= 1.
double ssim(std::span<const float> picture, std::span<const float> reference, int width);

}  // namespace orrery
