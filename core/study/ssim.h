#pragma once

#include <span>

namespace orrery {

// Returns the structural similarity (SSIM) of two images as displayed, in [-1, 1]; 1 if they are equal.
// Compares the luma of sRGB-encoded values, in [0, 1], in windows of 11 x 11 pixels. The windows have
// Gaussian weights of standard deviation 1.5 pixels and are clipped at the edges of the image (Wang, Bovik,
// Sheikh, Simoncelli, "Image quality assessment: from error visibility to structural similarity", IEEE
// Transactions on Image Processing 13, 2004). SSIM predicts visible differences better than RMSE, but has no
// bound. Non-finite values count as 0. REQUIRES: linear colour, three values per pixel, row by row; both
// images have the same size, in whole rows of `width` >= 1 pixels.
double ssim(std::span<const float> picture, std::span<const float> reference, int width);

}  // namespace orrery
