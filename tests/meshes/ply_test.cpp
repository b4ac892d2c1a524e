#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;
using Triangle = std::array<std::uint32_t, 3>;

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}
const std::string kVertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kFourRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

// Expects read_mesh() to read a mesh whose coordinates, list lengths and indices have the PLY type `type`, in
// both byte orders. If the type is not an integer type, list lengths have the type char.
template <class T>
void reads_as(const std::string& type) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    const bool integer = std::numeric_limits<T>::is_integer;
    std::string bytes = header(format, "element vertex 3\nproperty " + type + " x\nproperty " + type +
                                           " y\nproperty " + type + " z\nelement face 1\nproperty list " +
                                           (integer ? type : "char") + " " + type + " vertex_index\n");
    for (const int x : {0, 1, 2, 3, 4, 5, 6, 70, 8}) append(bytes, static_cast<T>(x), order);
    if (integer)
      append(bytes, static_cast<T>(3), order);
    else
      append(bytes, std::int8_t{3}, order);
    for (const int i : {2, 0, 1}) append(bytes, static_cast<T>(i), order);
    const TriangleMesh mesh = read_mesh(bytes);
    EXPECT_EQ(mesh.positions[2], Vec3d(6, 70, 8)) << type << format;
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 0, 1}})) << type << format;
  }
}
TEST(Ply, ReadsEveryTypeInBothByteOrders) {
  reads_as<std::int8_t>("char"), reads_as<std::int8_t>("int8");
  reads_as<std::uint8_t>("uchar"), reads_as<std::uint8_t>("uint8");
  reads_as<std::int16_t>("short"), reads_as<std::int16_t>("int16");
  reads_as<std::uint16_t>("ushort"), reads_as<std::uint16_t>("uint16");
  reads_as<std::int32_t>("int"), reads_as<std::int32_t>("int32");
  reads_as<std::uint32_t>("uint"), reads_as<std::uint32_t>("uint32");
  reads_as<float>("float"), reads_as<float>("float32");
  reads_as<double>("double"), reads_as<double>("float64");
}

TEST(Ply, ReadsNormalsAndUvsInAnyOrder) {
  for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v")}) {
    std::string text = header(
        "ascii", std::string("element vertex 3\nproperty float ny\nproperty float z\nproperty float ") + v +
                     "\nproperty float x\nproperty float nx\nproperty uchar red\n"
                     "property float nz\nproperty float y\nproperty float " +
                     u + "\n" + kFace);
    for (int i = 0; i < 3; ++i)
      text += "0 " + std::to_string(i) + " 0.5 " + std::to_string(i * i) + " 0 255 2 1 0.25\n";
    const TriangleMesh mesh = read_mesh(text + "3 0 1 2\n");
    EXPECT_EQ(mesh.positions[2], Vec3d(4, 1, 2));
    EXPECT_EQ(mesh.normals[2], Vec3d(0, 0, 1));
    EXPECT_EQ(mesh.uvs[2], (std::array<double, 2>{0.25, 0.5}));
  }
}

TEST(Ply, SplitsPolygonsAndSkipsOtherProperties) {
  const std::string elements =
      "element material 1\nproperty list uint double shades\nproperty int id\n" + kVertex +
      "property list uchar short tags\nelement nothing 7\n"
      "element face 2\nproperty uchar flags\nproperty list ushort uint vertex_index\n"
      "property list uchar float texcoord\nelement edge 1\nproperty int vertex1\n";
  const std::vector<Triangle> expected = {{0, 1, 2}, {3, 2, 1}, {3, 1, 0}};
  EXPECT_EQ(read_mesh(header("ascii", elements) + "2 0.5 nan nan\n0 0 0 0\n1 0 0 2 7 8\n1 1 0 1 9\n0 1 0 0\n"
                                                  "1 3 0 1 2 0\n1 4 3 2 1 0 2 0.5 0.5\n7\n")
                .triangles,
            expected);
  std::string bytes = header("binary_big_endian", elements);
  const auto put = [&](auto... values) { (append(bytes, values, std::endian::big), ...); };
  put(std::uint32_t{2}, 0.5, 0.25, 9);
  for (int i = 0; i < 4; ++i) {
    put(static_cast<float>(i), 0.0f, static_cast<float>(i * i), static_cast<std::uint8_t>(i));
    for (int k = 0; k < i; ++k) put(std::int16_t{-1});
  }
  put(std::uint8_t{1}, std::uint16_t{3}, 0u, 1u, 2u, std::uint8_t{0});
  put(std::uint8_t{1}, std::uint16_t{4}, 3u, 2u, 1u, 0u, std::uint8_t{2}, 0.5f, 0.5f, 7);
  const TriangleMesh mesh = read_mesh(bytes);
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.positions[3], Vec3d(3, 0, 9));
}

TEST(Ply, ReadsFacesBeforeVertices) {
  EXPECT_EQ(read_mesh(header("ascii", kFace + kVertex) + "3 0 1 3\n" + kFourRows).triangles,
            (std::vector<Triangle>{{0, 1, 3}}));
}

// A binary body begins right after the last line of the header, whatever its first byte.
TEST(Ply, StartsBinaryBodyRightAfterHeaderLine) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes;
    for (const char c : header("binary_little_endian",
                               "element vertex 3\nproperty char x\nproperty char y\n"
                               "property char z\n" +
                                   kFace))
      bytes += c == '\n' ? end : std::string(1, c);
    for (const char c : {'\n', '\r', '\n', ' ', '\r', '\0', '\1', '\2', '\4'}) bytes += c;
    append(bytes, std::uint8_t{3});
    for (const int i : {0, 1, 2}) append(bytes, i);
    EXPECT_EQ(read_mesh(bytes).positions[0], Vec3d(10, 13, 10));
  }
}

TEST(Ply, ReportsLineOfHeaderErrors) {
  const auto ascii = [](const std::string& elements) { return problem(header("ascii", elements)); };
  EXPECT_EQ(problem("ply\nformat ascii 2.0\n"), "line 2: must be version 1.0 (got \"2.0\")");
  EXPECT_THAT(problem("ply\nformat binary 1.0\n"),
              HasSubstr("line 2: must be one of ascii, binary_little_endian"));
  EXPECT_THAT(problem("ply\n"), HasSubstr("must be \"end_header\" (got the end of the file)"));
  EXPECT_THAT(problem("ply\nend_header\n"),
              HasSubstr("line 2: \"end_header\" must follow a line \"format\""));
  EXPECT_THAT(ascii("element vertex 0\nelephant 3\n"),
              HasSubstr("line 4: must be a PLY header keyword (got \"elephant\")"));
  EXPECT_THAT(ascii("element vertex -1\n"), HasSubstr("must be at least 0 (got -1)"));
  EXPECT_THAT(ascii("element vertex many\n"),
              HasSubstr("number of elements must be an integer (got \"many\")"));
  EXPECT_THAT(ascii("property float x\n"), HasSubstr("property must follow an element"));
  EXPECT_THAT(ascii("element vertex 1\nproperty half x\n"),
              HasSubstr("line 4: must be a PLY type such as int or float32 (got \"half\")"));
  EXPECT_THAT(ascii("element face 1\nproperty list float int vertex_index\n"),
              HasSubstr("list length must have an integer type (got float)"));
  EXPECT_THAT(ascii(kFace), HasSubstr("must have exactly one element \"vertex\" (got 0)"));
  EXPECT_THAT(ascii("element vertex 0\nproperty float x\n" + kFace), HasSubstr("properties x, y and z"));
  EXPECT_THAT(ascii(kVertex + kVertex), HasSubstr("must have exactly one element \"vertex\" (got 2)"));
  EXPECT_THAT(problem(header("ascii", kVertex + "element face 1\nproperty int a\n") + kFourRows + "1"),
              HasSubstr("face must have a list property \"vertex_indices\""));
  std::string many = "element vertex 1\n";
  for (int i = 0; i < 1001; ++i) many += "property float a\n";
  EXPECT_THAT(ascii(many), HasSubstr("more than 1,000 elements and properties (limit 1,000)"));
}

// An element count that exceeds the file size is rejected before memory for the elements is allocated.
TEST(Ply, ChecksCountsAgainstFileSize) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_THAT(problem(ply_header(format, 9'999'999, 1)),
                HasSubstr("element \"vertex\" must have 9999999 entries"));
    EXPECT_THAT(problem(ply_header(format, 0, 9'999'999)),
                HasSubstr("element \"face\" must have 9999999 entries"));
    EXPECT_THAT(problem(ply_header(format, 9'223'372'036'854'775'807, 1)),
                HasSubstr("vertices (limit 10,000,000, mesh_vertices)"));
    EXPECT_THAT(problem(ply_header(format, 0, 9'223'372'036'854'775'807)),
                HasSubstr("element \"face\" must have"));
    // 8 times the second count overflows to 0.
    for (const char* count : {"9223372036854775807", "2305843009213693952"})
      EXPECT_THAT(problem(header(format, std::string("element x ") + count +
                                             "\nproperty list uint int y\nproperty int z\n" + kVertex)),
                  HasSubstr("element \"x\" must have"));
  }
  EXPECT_THAT(problem(header("ascii", kVertex + "element face 1\nproperty list uint int vertex_index\n") +
                      kFourRows + "4000000000 0 1"),
              HasSubstr("triangles (limit 10,000,000, mesh_triangles)"));
}

TEST(Ply, ReportsPositionOfBodyErrors) {
  const auto ascii = [](const std::string& body) { return problem(header("ascii", kVertex + kFace) + body); };
  EXPECT_EQ(ascii("0 0 0\n1 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
            "line 12: value must be a finite number (got \"nan\")");
  EXPECT_EQ(ascii(kFourRows + "2 0 1 2 3\n"), "line 14: face 0 must have at least 3 corners (got 2)");
  EXPECT_THAT(ascii(kFourRows + "3 0 1 4\n"),
              HasSubstr("line 14: vertex of face 0 must be an integer >= 0 and < 4 (got 4)"));
  EXPECT_THAT(ascii(kFourRows + "3 0 1 -1\n"), HasSubstr("got -1"));
  EXPECT_THAT(ascii(kFourRows + "3 0 1 1.5\n"), HasSubstr("got 1.5"));
  EXPECT_THAT(ascii(kFourRows + "-3 0 1 1\n"),
              HasSubstr("list length must be an integer from 0 to 4294967295 (got -3)"));
  EXPECT_THAT(ascii(kFourRows + "4 0 1 2"), HasSubstr("got nothing"));
  std::string bytes = header("binary_little_endian",
                             "element vertex 1\nproperty float x\nproperty float y\n"
                             "property float z\n" +
                                 kFace);
  append(bytes, 0.0f), append(bytes, std::numeric_limits<float>::infinity()), append(bytes, 0.0f);
  append(bytes, std::uint8_t{3});
  for (int i = 0; i < 3; ++i) append(bytes, 0);
  EXPECT_THAT(problem(bytes),
              HasSubstr("coordinates must be at most 1e+12 m in magnitude (got (0, inf, 0) for vertex 0)"));
}

TEST(Ply, SkipsHeaderLinesWithoutKeyword) {
  std::string bytes = ply_of(cube());
  bytes.replace(bytes.find("comment made"), 7, "Created");
  const TriangleMesh mesh = read_mesh(bytes);
  EXPECT_EQ(corners_of(mesh), corners_of(cube()));
  EXPECT_EQ(mesh.notes, std::vector<std::string>{"1 header lines without a keyword were skipped"});
  bytes.insert(bytes.find("property"), "Created again\n");
  EXPECT_NE(problem(bytes).find("must be a PLY header keyword (got \"Created\")"), std::string::npos);
}

// Returns the colours of a triangle whose vertices have three properties of a type, with these names.
std::vector<Vec3d> ply_colors(const std::string& type, const std::string& prefix, const std::string& first) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* name : {"red", "green", "blue"}) text += "property " + type + ' ' + prefix + name + '\n';
  text += "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  return read_mesh(text + "0 0 0 " + first + " 9\n1 0 0 0 0 0 9\n0 1 0 1 0 0 9\n3 0 1 2\n").colors;
}

// The linear values of the codes 188 and 55 are those of tables of sRGB.
TEST(Ply, DecodesColoursOfVertices) {
  for (const auto& colors :
       {ply_colors("uchar", "", "188 55 255"), ply_colors("int", "diffuse_", "188 55 255"),
        ply_colors("ushort", "", "48316 14135 65535"), ply_colors("float", "", "188 55 255"),
        ply_colors("double", "", "0.737254901960784 0.215686274509804 1")}) {
    ASSERT_EQ(colors.size(), 3u);
    EXPECT_NEAR(colors[0].x, 0.502886, 1e-6);
    EXPECT_NEAR(colors[0].y, 0.038204, 1e-6);
    EXPECT_EQ(colors[0].z, 1);
    EXPECT_EQ(colors[1], Vec3d(0));
  }
  EXPECT_TRUE(ply_colors("uchar", "ambient_", "1 2 3").empty());
}

TEST(Ply, ClampsColoursWithANote) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n";
  std::string text = head;
  for (const char* name : {"x", "y", "z", "red", "green", "blue"})
    text += std::string("property float ") + name + '\n';
  text += "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value :
       {0.f, 0.f, 0.f, -1.f, 1.f, nan, 1.f, 0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f})
    append(text, value);
  append(text, std::uint8_t{3});
  for (const std::uint32_t i : {0u, 1u, 2u}) append(text, i);
  append(text, std::uint8_t{1});
  const TriangleMesh mesh = read_mesh(text);
  EXPECT_EQ(mesh.colors.at(0), Vec3d(0, 1, 0));
  EXPECT_EQ(mesh.notes, (std::vector<std::string>{"colours of faces are not modelled",
                                                  "1 colours beyond the range of their type were clamped"}));
}

}  // namespace
}  // namespace orrery::test
