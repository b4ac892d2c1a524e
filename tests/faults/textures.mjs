// Mistakes in textures (15).

export const textureFaults = [
  {
    fault: 15,
    about: "images are upside down",
    file: "core/textures/image_map.cpp",
    from: "y = place(T(1) - v, level.height)",
    to: "y = place(v, level.height)",
    target: "test_textures",
    tests: ["ImagePyramid.ReturnsTexelsAtTheirCentres"],
  },
  {
    fault: 15,
    about: "texels are placed at corners instead of centres",
    file: "core/textures/image_map.cpp",
    from: "static_cast<T>(size) - T(0.5), -kFar, kFar)",
    to: "static_cast<T>(size), -kFar, kFar)",
    target: "test_textures",
    tests: ["ImagePyramid.ReturnsTexelsAtTheirCentres"],
  },
  {
    fault: 15,
    about: "the footprint of a pixel ignores the angle of the surface",
    file: "core/lighting/texture_coordinates.h",
    from: "a * a + b * b + slope * slope",
    to: "a * a + b * b + T(0) * slope",
    target: "test_textures",
    tests: ["FootprintBox.EnclosesTheProjectedDisc"],
  },
  {
    fault: 15,
    about: "bumps rise toward the viewer on both sides",
    file: "core/lighting/textures.cpp",
    from: "(tangents.first * a + tangents.second * b) * side",
    to: "(tangents.first * a + tangents.second * b) * (side * side)",
    target: "test_textures",
    tests: ["BumpMaps.RiseOutward"],
  },
  {
    fault: 15,
    about: "bounds of a material ignore its textures",
    file: "core/materials/material_set.h",
    from: "if (!extremes_[i].empty()) return extremes_[i];",
    to: "",
    target: "test_textures",
    tests: ["Textures.BoundTheRadianceOfTexturedSurfaces"],
  },
];
