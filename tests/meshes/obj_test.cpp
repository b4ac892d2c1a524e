#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/meshes/model.h"
#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;
using Triangle = std::array<std::uint32_t, 3>;

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, SplitsPolygonsIntoFans) {
  const TriangleMesh mesh = read_mesh(kFour + "v -1 0.5 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Obj, ResolvesNegativeIndices) {
  const TriangleMesh mesh = read_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 1 -2\n");
  EXPECT_EQ(corners_of(mesh)[0], (Corners{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0)}));
  EXPECT_EQ(corners_of(mesh)[1], (Corners{Vec3d(5, 5, 5), Vec3d(0, 0, 0), Vec3d(1, 1, 0)}));
}

TEST(Obj, SplitsVerticesByNormalAndUv) {
  const TriangleMesh mesh = read_mesh(kFour +
                                      "vn 0 0 2\nvn 0 3 0\nvt 0.25 0.5\nvt 0.75\n"
                                      "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/2/1 4/1/2\n");
  ASSERT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(mesh.positions[2], mesh.positions[3]);
  EXPECT_EQ(mesh.normals[0], Vec3d(0, 0, 1));
  EXPECT_EQ(mesh.normals[4], Vec3d(0, 1, 0));
  EXPECT_EQ(mesh.uvs[0], (std::array<double, 2>{0.25, 0.5}));
  EXPECT_EQ(mesh.uvs[3], (std::array<double, 2>{0.75, 0}));
}

TEST(Obj, DropsAttributesMissingAtSomeCorners) {
  const TriangleMesh mesh = read_mesh(kFour + "vn 0 0 1\nvt 0 0\nf 1//1 2//1 3//1\nf 1/1/1 3/1/1 4/1/1\n");
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Obj, ReplacesZeroNormalsByFaceNormals) {
  const TriangleMesh mesh = read_mesh(kFour + "vn 0 0 0\nvn 0 1 0\nf 1//1 2//2 3//2\n");
  EXPECT_EQ(mesh.normals[0], Vec3d(0, 0, 1));
  EXPECT_EQ(mesh.normals[1], Vec3d(0, 1, 0));
}

TEST(Obj, AcceptsAllLineEndingsCommentsAndIgnoredStatements) {
  const std::vector<Corners> plain = corners_of(read_mesh("v 0 0 0\nv 1 0 0\nv 1 1.5 0\nf 1 2 3\n"));
  for (const char* text :
       {"v 0 0 0\r\nv 1 0 0\r\nv 1 1.5 0\r\nf 1 2 3", "v 0 0 0\rv 1 0 0\rv 1 1.5 0\rf 1 2 3\r",
        "\xef\xbb\xbfv 0 0 0\nv +1 0 0\nv 1 1.5 0\nf 1 2 3\n",
        "mtllib a.mtl\n\n\tv  0 0 -0 1 # home\nv 1e0 0 0 0.5 0.5 0.5\nv 1 15e-1 1e-400\nusemtl x\ns off\nl 1 "
        "2\n"
        "f 1 2 \\\n 3 # end\n"})
    EXPECT_EQ(corners_of(read_mesh(text)), plain) << text;
}

TEST(Obj, RoundsNumbersToNearestDouble) {
  const TriangleMesh mesh = read_mesh("v 0.1 123456.789012 -8.371950\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], Vec3d(0.1, 123456.789012, -8.371950));
}

TEST(Obj, EndsCommentAtLineEndDespiteBackslash) {
  EXPECT_EQ(read_mesh("# from C:\\models\\\n" + kFour + "f 1 2 3\n").triangles,
            (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, RejectsOverflowingAndRoundsUnderflowingNumbers) {
  const std::string large = "1" + std::string(400, '0') + "e-5", small = "0." + std::string(400, '0') + "1";
  EXPECT_THROW(read_mesh("v " + large + " 0 0\n" + kFour + "f 1 2 3\n"), InputError);
  EXPECT_EQ(read_mesh("v " + small + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").positions[0].x, 0);
}

TEST(Obj, ReportsLineOfErrors) {
  const auto with = [](const std::string& line) { return problem(kFour + line + "\nf 1 2 3\n"); };
  EXPECT_EQ(with("v 1 nan 0"), "line 5: v must be a finite number (got \"nan\")");
  EXPECT_EQ(with("v 1 0 -inf"), "line 5: v must be a finite number (got \"-inf\")");
  EXPECT_EQ(with("v 1 0 1e999"), "line 5: v must be a finite number (got \"1e999\")");
  EXPECT_EQ(with("v 1 -2e12 0"),
            "line 5: coordinates must be at most 1e+12 m in magnitude (got (1, -2e+12, 0))");
  EXPECT_EQ(with("v 1 0"), "line 5: v must be a finite number (got nothing)");
  EXPECT_EQ(with("vn 1 0 0x1"), "line 5: vn must be a finite number (got \"0x1\")");
  EXPECT_EQ(with("vt u"), "line 5: vt must be a finite number (got \"u\")");
  EXPECT_EQ(with("f 1 2"), "line 5: face must have at least 3 corners (got 2)");
  EXPECT_EQ(with("f 1 2 5"), "line 5: v of a corner must be from 1 to 4 or -1 to -4 (got 5)");
  EXPECT_EQ(with("f 1 2 -5"), "line 5: v of a corner must be from 1 to 4 or -1 to -4 (got -5)");
  EXPECT_EQ(with("f 1 2 0"), "line 5: v of a corner must be from 1 to 4 or -1 to -4 (got 0)");
  EXPECT_EQ(with("f 1 2 4294967299"),
            "line 5: v of a corner must be from 1 to 4 or -1 to -4 (got 4294967299)");
  EXPECT_EQ(with("f 1 2 99999999999999999999"),
            "line 5: v of a corner must be an integer (got \"99999999999999999999\")");
  EXPECT_EQ(with("f 1//1 2 3"), "line 5: vn of a corner must refer to an earlier vn line (got 1)");
  EXPECT_EQ(with("f 1/1/1/1 2 3"), "line 5: corner must be position/uv/normal (got \"1/1/1/1\")");
  EXPECT_EQ(with("f \\\n1 2 x"), "line 6: v of a corner must be an integer (got \"x\")");
}

TEST(Obj, ReadsUtf16) {
  for (const std::endian order : {std::endian::little, std::endian::big})
    EXPECT_EQ(corners_of(read_mesh(utf16_of(obj_of(cube()), order))), corners_of(cube()));
}

TEST(Obj, IgnoresTextureIndicesWithoutCoordinates) {
  const TriangleMesh mesh = read_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.notes,
            std::vector<std::string>{"3 texture indices without texture coordinates were ignored"});
}

TEST(Obj, NotesContentsThatAreNotModelled) {
  const TriangleMesh mesh =
      read_mesh("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nl 1 2\nl 2 3\np 1\n");
  EXPECT_EQ(mesh.notes,
            (std::vector<std::string>{"material library \"a.mtl\" is missing: other files are not available",
                                      "2 lines are not rendered", "1 points are not rendered"}));
}

TEST(Obj, KeepsAttributesThatAllCornersOfAPartHave) {
  const MeshModel model =
      read_model(kFour +
                     "vn 0 0 1\nvt 0.5 0\nvt 0 0.5\nmtllib m\nusemtl a\nf 1/1/1 2/2/1 3/1/1\n"
                     "usemtl b\nf 1//1 3//1 4//1\nusemtl a\nf 2/1/1 3/2/1 4/1\n",
                 {}, [](const std::string&) { return "newmtl a\nnewmtl b\n"; });
  ASSERT_EQ(model.materials.size(), 2u);
  ASSERT_EQ(model.mesh.parts.size(), 2u);
  const TriangleMesh a = part_of(model.mesh, 0), b = part_of(model.mesh, 1);
  EXPECT_EQ(corners_of(a)[1], (Corners{Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0)}));
  EXPECT_TRUE(a.normals.empty());
  EXPECT_EQ(a.uvs[a.triangles[0][1]], (std::array<double, 2>{0, 0.5}));
  EXPECT_EQ(corners_of(b)[0], (Corners{Vec3d(0, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0)}));
  EXPECT_EQ(b.normals.size(), 3u);
  EXPECT_TRUE(b.uvs.empty());
}

TEST(Obj, ReadsColoursOfVertices) {
  const auto colors = [](const std::string& text) { return read_mesh(text + "f 1 2 3\n").colors; };
  // Codes of 0.5 and 1, as tables of sRGB list them.
  const auto half = [](const Vec3d& color) {
    return std::abs(color.x - 0.214041) < 1e-6 && color.y == 0 && color.z == 1;
  };
  EXPECT_TRUE(half(colors("v 0 0 0 0.5 0 1\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\n").at(0)));
  EXPECT_TRUE(half(colors("v 0 0 0 127.5 0 255\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\n").at(0)));
  EXPECT_TRUE(half(colors("v 0 0 0 1 0.5 0 1\nv 1 0 0 1 0 0 0\nv 0 1 0 1 1 1 1\n").at(0)));
  EXPECT_TRUE(colors("v 0 0 0 1 # 1 1\nv 1 0 0 2\nv 0 1 0 1 1\n").empty());
  EXPECT_TRUE(colors("v 0 0 0 1 1 nan\nv 1 0 0 -1 0 0\nv 0 1 0 256 0 0\n").empty());

  const TriangleMesh mesh =
      read_mesh("v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 1 1 0 0\nf 1 2 3\nf 2 3 4\n");
  EXPECT_TRUE(mesh.colors.empty());
  EXPECT_EQ(mesh.notes, std::vector<std::string>{"1 of 4 vertices have no colour"});
}

}  // namespace
}  // namespace orrery::test
