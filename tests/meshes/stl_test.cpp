#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;

TEST(Stl, JoinsSharedEdgesOfClosedMesh) {
  for (const std::string& bytes : {ascii_stl_of(cube()), binary_stl_of(cube())}) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    const TriangleMesh mesh = read_mesh(bytes);
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    EXPECT_EQ(edges.size(), 36u);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ((edges.count({edge.second, edge.first})), 1u);
    }
  }
}

TEST(Stl, JoinsCornersAtNegativeZero) {
  const TriangleMesh mesh = read_mesh(
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex -0 0 -0\nvertex 0 1 0\nvertex -1 0 "
      "0\nendloop\nendfacet\nendsolid");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles[1][0], 0u);
}

TEST(Stl, DetectsBinaryBySizeDespiteTitle) {
  for (const char* title : {"solid", "solid cube\nfacet normal", "ply", "", "v 1 2 3\nf 1 2 3\n"})
    EXPECT_EQ(corners_of(read_mesh(binary_stl_of(cube(), title))), corners_of(cube())) << title;
}

TEST(Stl, AcceptsByteOrderMarkInBinaryTitle) {
  EXPECT_EQ(corners_of(read_mesh(binary_stl_of(cube(), "\xEF\xBB\xBF part"))), corners_of(cube()));
}

TEST(Stl, AcceptsUppercaseKeywordsMultipleSolidsAndArbitraryNames) {
  const std::string facet =
      "FACET NORMAL nan nan nan OUTER LOOP VERTEX 0 0 0 VERTEX 1 0 0 VERTEX 0 1 0 ENDLOOP ENDFACET\n";
  const TriangleMesh mesh =
      read_mesh("SOLID C:\\models\\\n" + facet + "ENDSOLID facet\n\nsolid\n" + facet + facet + "endsolid\n");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.positions.size(), 3u);
}

TEST(Stl, ReportsPositionOfErrors) {
  std::string bytes = binary_stl_of(cube());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 3 * 50 + 12 + 12, &nan, 4);
  EXPECT_THAT(problem(bytes),
              HasSubstr("facet 3 at byte 234: coordinates must be at most 1e+12 m in magnitude (got ("));
  const std::string facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  EXPECT_EQ(problem("solid\n" + facet + "vertex 1 inf 0\n"),
            "line 6: y must be a finite number (got \"inf\")");
  EXPECT_EQ(problem("solid\n" + facet + "endloop\n"), "line 6: must be \"vertex\" (got \"endloop\")");
  EXPECT_EQ(problem("solid\n" + facet), "line 6: must be \"vertex\" (got the end of the file)");
  EXPECT_EQ(problem("solid\n"), "line 2: must be \"endsolid\" (got the end of the file)");
  EXPECT_EQ(problem("solid\nvertex\n"), "line 2: must be \"facet\" or \"endsolid\" (got \"vertex\")");
  EXPECT_EQ(problem("solid\nendsolid\nfacet\n"), "line 3: must be \"solid\" (got \"facet\")");
}

TEST(Stl, SkipsBytesAfterLastTriangle) {
  const TriangleMesh mesh = read_mesh(binary_stl_of(cube()) + "made by a program");
  EXPECT_EQ(corners_of(mesh), corners_of(cube()));
  EXPECT_EQ(mesh.notes, std::vector<std::string>{"17 bytes after the last triangle were skipped"});
  EXPECT_EQ(problem(binary_stl_of(cube()) + std::string(4097, ' ')).find("accepted"), std::string::npos);
}

// Returns the colours of the first corners of the facets of a cube whose facets store these words,
// repeatedly.
std::vector<Vec3d> facet_colors(const std::vector<std::uint16_t>& words, const std::string& title = "") {
  std::string bytes = binary_stl_of(cube(), title);
  for (std::size_t i = 0; i < 12; ++i) {
    const std::uint16_t word = words[i % words.size()];
    bytes[84 + 50 * i + 48] = static_cast<char>(word & 255);
    bytes[84 + 50 * i + 49] = static_cast<char>(word >> 8);
  }
  const TriangleMesh mesh = read_mesh(bytes);
  EXPECT_EQ(corners_of(mesh), corners_of(cube()));
  std::vector<Vec3d> colors;
  for (std::size_t i = 0; i < 12 && !mesh.colors.empty(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i])
      EXPECT_EQ(mesh.colors[vertex], mesh.colors[mesh.triangles[i][0]]);
    colors.push_back(mesh.colors[mesh.triangles[i][0]]);
  }
  return colors;
}

TEST(Stl, ReadsColoursOfVisCam) {
  const std::vector<Vec3d> colors = facet_colors({0x8000 | 31 << 10, 0x8000 | 31 << 5, 0x8000 | 31, 0});
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_EQ(colors[0], Vec3d(1, 0, 0));
  EXPECT_EQ(colors[5], Vec3d(0, 1, 0));
  EXPECT_EQ(colors[10], Vec3d(0, 0, 1));
  EXPECT_EQ(colors[11], Vec3d(1));
  // Code 16 / 31 of sRGB.
  EXPECT_NEAR(facet_colors({0x8000 | 16}).at(0).z, 0.229275, 1e-6);
}

TEST(Stl, ReadsColoursOfMagics) {
  const std::string title = std::string("made by a program COLOR=\xff\x00\xff\xff,MATERIAL=", 38);
  const std::vector<Vec3d> colors = facet_colors({31, 31 << 5, 31 << 10, 0x8000 | 31}, title);
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_EQ(colors[0], Vec3d(1, 0, 0));
  EXPECT_EQ(colors[1], Vec3d(0, 1, 0));
  EXPECT_EQ(colors[2], Vec3d(0, 0, 1));
  EXPECT_EQ(colors[3], Vec3d(1, 0, 1));
}

TEST(Stl, IgnoresOtherBytesAfterFacets) {
  EXPECT_TRUE(facet_colors({0}).empty());
  EXPECT_TRUE(facet_colors({0}, "COLOR=abcd").empty());
  EXPECT_TRUE(facet_colors({0x8000 | 31, 7}).empty());
  EXPECT_TRUE(facet_colors({31}, std::string(74, ' ') + "COLOR=").empty());
}

}  // namespace
}  // namespace orrery::test
