#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/meshes/model.h"
#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TriangleMesh two_triangles() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  return mesh;
}
std::string object(int id, const std::string& content, const std::string& attributes = "") {
  return "<object id=\"" + std::to_string(id) + "\" " + attributes + ">" + content + "</object>";
}
std::string component(int id, const std::string& attributes = "") {
  return "<component objectid=\"" + std::to_string(id) + "\" " + attributes + "/>";
}
const std::string kItem = "<item objectid=\"1\"/>";

TEST(ThreeMf, ComposesTransformsOfItemsAndComponents) {
  // x' = 2y + 10, y' = x, z' = z mirrors; then x'' = x' + 100, which the rows of the matrices state.
  const std::string resources =
      object(1, three_mf_mesh(two_triangles())) +
      object(2, "<components>" + component(1, "transform=\"0 1 0 2 0 0 0 0 1 10 0 0\"") + component(1) +
                    "</components>");
  const TriangleMesh mesh =
      read_mesh(three_mf_of(resources, "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"/>"));
  const std::vector<Corners> corners = corners_of(mesh);
  ASSERT_EQ(corners.size(), 4u);
  EXPECT_EQ(corners[0], (Corners{Vec3d(110, 0, 0), Vec3d(112, 0, 0), Vec3d(110, 1, 0)}));
  EXPECT_EQ(corners[1], (Corners{Vec3d(112, 0, 0), Vec3d(112, 1, 1), Vec3d(110, 1, 0)}));
  EXPECT_EQ(corners[2], (Corners{Vec3d(100, 0, 0), Vec3d(101, 0, 0), Vec3d(100, 1, 0)}));
}

TEST(ThreeMf, ReadsBaseMaterials) {
  const std::string materials =
      "<basematerials id=\"7\"><base name=\"red\" displaycolor=\"#FF0000\"/>"
      "<base name=\"glass\" displaycolor=\"#00bc0080\"/></basematerials>";
  const MeshModel model =
      read_model(three_mf_of(materials + object(1, three_mf_mesh(two_triangles(), {"", "pid=\"7\" p1=\"1\""}),
                                                "pid=\"7\" pindex=\"0\""),
                             kItem, "unit=\"inch\""));
  EXPECT_EQ(model.unit, "inch");
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.materials[0].name, "red");
  EXPECT_EQ(model.materials[0].base_color.factor, Vec3d(1, 0, 0));
  EXPECT_EQ(model.materials[0].alpha, ModelMaterial::Alpha::opaque);
  EXPECT_NEAR(model.materials[1].base_color.factor.y, 0.502886, 1e-6);  // code 188 of sRGB
  EXPECT_EQ(model.materials[1].opacity, 128 / 255.0);
  EXPECT_EQ(model.materials[1].alpha, ModelMaterial::Alpha::blend);
  EXPECT_EQ(corners_of(part_of(model.mesh, 0)), std::vector{corners_of(two_triangles())[0]});
  EXPECT_EQ(corners_of(part_of(model.mesh, 1)), std::vector{corners_of(two_triangles())[1]});
}

TEST(ThreeMf, ReadsColoursOfCorners) {
  const std::string colors =
      "<m:colorgroup id=\"3\"><m:color color=\"#FF0000\"/><m:color color=\"#0000FFFF\"/></m:colorgroup>";
  const std::string two =
      object(1,
             three_mf_mesh(two_triangles(), {"pid=\"3\" p1=\"0\" p2=\"1\" p3=\"0\"", "pid=\"3\" p1=\"1\""})) +
      object(2, three_mf_mesh(two_triangles()));
  const TriangleMesh mesh = read_mesh(three_mf_of(colors + two, kItem + "<item objectid=\"2\"/>"));
  EXPECT_EQ(corners_of(mesh)[1], corners_of(two_triangles())[1]);
  EXPECT_EQ(mesh.positions.size(), 9u);  // vertex 2 of the first object has two colours
  const Vec3d red(1, 0, 0), blue(0, 0, 1);
  std::vector<Vec3d> found;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) found.push_back(mesh.colors[i]);
  const Vec3d white(1);
  EXPECT_EQ(found,
            (std::vector<Vec3d>{red, blue, red, blue, blue, blue, white, white, white, white, white, white}));
}

// assimp writes such objects. Each mesh numbers its own vertices.
TEST(ThreeMf, ReadsSeveralMeshesOfAnObject) {
  const std::string colors = "<colorgroup id=\"3\"><color color=\"#FF0000\"/></colorgroup>";
  const std::string meshes = three_mf_mesh(two_triangles(), {"pid=\"3\" p1=\"0\""}) + three_mf_mesh(cube());
  const TriangleMesh mesh = read_mesh(three_mf_of(colors + object(1, meshes), kItem));
  EXPECT_EQ(mesh.triangles.size(), 14u);
  EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
  EXPECT_EQ(corners_of(mesh)[2], corners_of(cube())[0]);
  EXPECT_EQ(corners_of(mesh)[13], corners_of(cube())[11]);
}

TEST(ThreeMf, FindsPartsOfThePackage) {
  const std::string outer = three_mf_model(
      object(5, "<components>" + component(1, "p:path=\"/3D/Parts/a.MODEL\"") + "</components>"),
      "<item objectid=\"5\"/>");
  const std::string inner = three_mf_model(object(1, three_mf_mesh(two_triangles())), "");
  const std::string relations =
      "<Relationships><Relationship Target=\"/t.png\" Type=\"http://a/thumbnail\"/><Relationship "
      "Target=\"/other/root.model\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
      "</Relationships>";
  const std::string whole = Zip()
                                .add("3D/3dmodel.model", "not XML")
                                .add("3D/parts/a.model", inner)
                                .add("_rels/.rels", relations)
                                .add("other/root.model", outer)
                                .bytes();
  EXPECT_EQ(corners_of(read_mesh(whole)), corners_of(two_triangles()));
  const std::string only = three_mf_model(object(1, three_mf_mesh(two_triangles())), kItem);
  EXPECT_EQ(corners_of(read_mesh(Zip().add("a.png", "").add("b.model", only).bytes())),
            corners_of(two_triangles()));
  EXPECT_THAT(problem(Zip().add("3D/3dmodel.model", outer).bytes()),
              HasSubstr("model part \"3d/parts/a.model\" is missing in the archive"));
  EXPECT_THAT(problem(Zip().add("a.txt", "v 0 0 0").bytes()), HasSubstr("archive must contain a model"));
}

TEST(ThreeMf, BoundsNestingAndRepetition) {
  EXPECT_THAT(problem(three_mf_of(object(1, "<components>" + component(1) + "</components>"), kItem)),
              HasSubstr("components must nest at most 64 deep (got object 1 in more, or in itself)"));
  std::string doubling = object(30, three_mf_mesh(two_triangles()));
  for (int i = 29; i > 0; --i)
    doubling += object(i, "<components>" + component(i + 1) + component(i + 1) + "</components>");
  EXPECT_THAT(problem(three_mf_of(doubling, kItem)), HasSubstr("file must place at most 250,000 objects"));
  const std::string one = object(1, three_mf_mesh(two_triangles()));
  EXPECT_EQ(problem(three_mf_of(one, kItem + kItem), {8, 4}), "accepted");
  EXPECT_THAT(problem(three_mf_of(one, kItem + kItem), {8, 3}), HasSubstr("mesh has at least 4 triangles"));
  EXPECT_THAT(problem(three_mf_of(one, kItem + kItem), {7, 4}), HasSubstr("mesh has at least 8 vertices"));
}

TEST(ThreeMf, ReportsInvalidContents) {
  const auto with = [](const std::string& resources, const std::string& item = kItem) {
    return problem(three_mf_of(resources, item));
  };
  const std::string place = "3D/3dmodel.model, element \"";
  TriangleMesh bad = two_triangles();
  bad.triangles[1][2] = 4;
  const std::string mesh = three_mf_mesh(two_triangles());
  EXPECT_THAT(with(object(1, three_mf_mesh(bad))), HasSubstr("v3 must be >= 0 and < 4 (got 4)"));
  EXPECT_THAT(with(object(2, mesh)), HasSubstr("objectid must be the id of an object (got 1)"));
  EXPECT_THAT(with(object(1, mesh) + object(1, mesh)),
              HasSubstr("id must differ from those of other objects"));
  EXPECT_THAT(with(object(1, mesh, "pid=\"4\" pindex=\"0\"")),
              HasSubstr("id of a group of properties (got 4)"));
  EXPECT_THAT(with("<basematerials id=\"4\"/>" + object(1, mesh, "pid=\"4\" pindex=\"0\"")),
              HasSubstr("index of a property must be >= 0 and < 0 (got 0)"));
  EXPECT_THAT(with("<basematerials id=\"4\"><base displaycolor=\"#12345\"/></basematerials>"),
              HasSubstr("displaycolor must be #RRGGBB or #RRGGBBAA (got \"#12345\")"));
  EXPECT_THAT(with(object(1, mesh), "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0\"/>"),
              HasSubstr("transform must be 12 finite numbers"));
  EXPECT_THAT(with(object(1, mesh), "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 1e13 0 0\"/>"),
              HasSubstr("placed object: coordinates must be at most"));
  EXPECT_THAT(with(object(1, mesh), ""), HasSubstr("mesh must have at least 1 triangle"));
  EXPECT_THAT(problem(three_mf_of(object(1, mesh), kItem, "unit=\"mile\"")),
              HasSubstr("unit must be micron"));
  EXPECT_THAT(with("<basematerials/>"), HasSubstr(place + "basematerials\""));
}

TEST(ThreeMf, NotesWhatIsNotModelled) {
  const std::string mesh = three_mf_mesh(two_triangles(), {"pid=\"9\" p1=\"0\" p2=\"1\" p3=\"2\""});
  const TriangleMesh read = read_mesh(three_mf_of(
      "<m:texture2dgroup id=\"9\" texid=\"8\"/>" +
          object(1, "<metadatagroup/>" + mesh.substr(0, mesh.size() - 7) + "<b:beamlattice/></mesh>"),
      kItem));
  EXPECT_EQ(corners_of(read), corners_of(two_triangles()));
  EXPECT_THAT(read.notes, ElementsAre("1 elements \"beamlattice\" are not modelled",
                                      "1 elements \"texture2dgroup\" are not modelled"));
}

}  // namespace
}  // namespace orrery::test
