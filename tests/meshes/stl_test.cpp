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

}  // namespace
}  // namespace orrery::test
