// Mistakes of pictures and their files, as faults.mjs has them: fault 25.

const entry = (about, file, from, to, ...tests) => ({
  fault: 25, about, file: `core/image/${file}`, from, to, target: "test_image", tests,
});

export const imageFaults = [
  entry("NaN is white", "srgb.h", "max_first(N(Scalar(0)), linear)", "max_first(linear, N(Scalar(0)))",
        "Srgb.CutsWhatNoScreenShows"),
  entry("codes are cut, not rounded", "image.cpp", "* 255.0f + 0.5f", "* 255.0f",
        "Srgb.CodesAreTheNearestToTheStandardCurve"),
  entry("the sRGB curve has no straight part", "srgb.h", "kEndOfLine = 0.0031308", "kEndOfLine = 0",
        "Srgb.CodesAreTheNearestToTheStandardCurve"),
  entry("the last pixel of a row spills into its neighbour", "image.cpp", "std::memcpy(out, &pixels[lanes - 1], 3);",
        "std::memcpy(out, &pixels[lanes - 1], 4);", "Image.RowsTouchNoOtherPixel"),
  entry("a PNG is read however large it is", "png.cpp", "check_size(header.width, header.height, max_pixels);", "",
        "Hostile.PicturesOverTheLimitAreRefused"),
  entry("red and blue of a JPEG change places", "jpeg.cpp", "TJPF_RGB, &bytes", "TJPF_BGR, &bytes",
        "Jpeg.RoundTripsNearly"),
];
