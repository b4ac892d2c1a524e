#pragma once

#include <span>

namespace orrery {

// Returns the structural similarity of two pictures as displayed, in [-1, 1]; 1 if they are equal. Compares
// luma of sRGB codes from 0 to 1 in windows of 11 x 11 pixels. The windows have Gaussian weights of standard
// deviation 1.5 and are cut at the picture's edge (Wang, Bovik, Sheikh, Simoncelli, "Image quality
// assessment: from error visibility to structural similarity", IEEE Transactions on Image Processing 13,
// 2004). SSIM predicts visible differences better than RMSE, but has no bound. Values that are not finite
// count as 0. REQUIRES: linear colour, three values per pixel, row by row; equal sizes, whole rows of `width`
// >= 1.
double ssim(std::span<const float> picture, std::span<const float> reference, int width);

}  // namespace orrery
