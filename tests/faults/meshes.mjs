// Mistakes of readers of mesh files, as faults.mjs has them: fault 11 trusts the file, 12 misreads its
// conventions, 13 averages normals wrongly.

import {posix} from "node:path";

const entry = (fault, about, file, from, to, test) => ({
  fault, about, file: posix.join("core/meshes", file), from, to, target: "test_meshes", tests: [test],
});

export const meshFaults = [
  entry(11, "an OBJ index may reach back past the first vertex", "obj.cpp", "|| index < -size", "",
        "Obj.RefusalsNameTheLine"),
  entry(11, "a PLY count times its row overflows", "ply.cpp", "element.count > body_.bytes_left() / fewest",
        "element.count * fewest > body_.bytes_left()", "Ply.CountsAreCheckedAgainstTheBytes"),
  entry(11, "a glTF view's offset and length overflow", "gltf_file.cpp",
        "offset > bytes.size() || length > bytes.size() - offset", "offset + length > bytes.size()",
        "GltfRefusals.OfRangesThatLeaveTheirBuffer"),
  entry(11, "a glTF accessor's last element is not counted in full", "gltf_file.cpp",
        "element > bytes.size() - offset ||", "", "GltfRefusals.OfRangesThatLeaveTheirBuffer"),
  entry(11, "a binary STL is told by the word solid", "stl.cpp", "return binary_stl_triangles(bytes) > 0 ?",
        'return !bytes.starts_with("solid") ?', "Stl.BinaryIsToldByItsSizeWhateverItsTitle"),
  entry(12, "negative OBJ indices count from the wrong end", "obj.cpp", "index - 1 : size + index",
        "index - 1 : -index - 1", "Obj.NegativeIndicesCountBackFromTheLastSoFar"),
  entry(12, "only the first triangles of a polygon are a fan", "obj.cpp", "fan[1] = vertex;", "fan[0] = vertex;",
        "Obj.PolygonsBecomeFans"),
  entry(12, "big-endian PLY is read as little-endian", "ply_body.h", "if constexpr (order != std::endian::native)",
        "if constexpr (order != order)", "Ply.EveryTypeInBothByteOrders"),
  entry(12, "every other triangle of a strip faces backwards", "gltf.cpp", "{i, i + 1 + i % 2, i + 2 - i % 2}",
        "{i, i + 1, i + 2}", "Gltf.TrianglesStripsAndFans"),
  entry(12, "a mirrored mesh is inside out", "gltf.cpp", "if (mirrored)", "if (mirrored && false)",
        "Gltf.AMirroredCubeKeepsItsFrontOutside"),
  entry(12, "normals are transformed like points", "../math/affine.h",
        "return scaled_determinant(a) < 0 ? -turned : turned;", "return a.vector(n);", "Gltf.NormalsStayPerpendicularUnderAShear"),
  entry(12, "transforms nest in the wrong order", "gltf.cpp",
        "compose(visit.world_from_parent, transform_of(node))",
        "compose(transform_of(node), visit.world_from_parent)", "Gltf.TranslationRotationAndScaleNest"),
  entry(12, "the uvs of a glTF stand on their head", "gltf.cpp", "{u, 1 - v}", "{u, v}",
        "Gltf.AttributesMayBeInterleavedAndNormalized"),
  entry(12, "-0 and 0 are different corners", "vertex_list.cpp", "(x + 0.0)", "(x)",
        "Stl.MinusZeroIsZeroWhereCornersAreJoined"),
  entry(13, "the cut of a polygon into triangles decides its weight", "smooth_normals.cpp",
        "sum = sum + facets.weighted[other]", "sum = sum + facets.normals[other / 3]",
        "SmoothNormals.ACubeIsCreasedAt30DegreesAndRoundAt100"),
  entry(13, "a crease is no crease at its own angle", "smooth_normals.cpp", "> min_cosine", ">= min_cosine",
        "SmoothNormals.FacesThatDifferByTheCreaseAngleStayApart"),
];
