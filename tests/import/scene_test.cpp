#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/affine.h"
#include "server/import/mesh_writer.h"
#include "tests/import/support.h"

// Shapes, materials, textures and instances of converted scenes.
namespace orrery::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Returns the first material of a scene with one shape.
Json pbrt_material_of(const std::string& directives) {
  return Json(imported("WorldBegin " + directives + " Shape \"sphere\"").scene.at("materials"))
      .begin()
      .value();
}
Json mitsuba_material_of(const std::string& bsdf) {
  return Json(imported("<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'>" + bsdf +
                       "</shape></scene>")
                  .scene.at("materials"))
      .begin()
      .value();
}

// Fresnel reflectance along the normal.
double reflectance_of(const Json& material) {
  const auto first = [](const Json& value) { return (value.is_number() ? value : value[0]).get<double>(); };
  const double n = first(material.at("n")), k = first(material.at("k"));
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

TEST(ImportedMaterials, MapParametersOfPbrt) {
  EXPECT_EQ(pbrt_material_of("Material \"diffuse\"").at("reflectance"), Json({0.5, 0.5, 0.5}));
  EXPECT_NEAR(reflectance_of(pbrt_material_of("Material \"conductor\" \"rgb reflectance\" [0.8 0.8 0.8]")),
              0.8, 1e-12);
  EXPECT_EQ(pbrt_material_of("Material \"conductor\"").at("name"), "copper");
  EXPECT_EQ(pbrt_material_of(
                "Material \"conductor\" \"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" \"metal-Al-k\"")
                .at("name"),
            "aluminium");
  EXPECT_EQ(pbrt_material_of("Material \"dielectric\" \"float eta\" 1.7").at("ior"), 1.7);
  EXPECT_EQ(pbrt_material_of("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"").at("ior"), 1.5168);
  EXPECT_NEAR(
      pbrt_material_of("Material \"dielectric\" \"spectrum eta\" [400 1.6 700 1.5]").at("ior").get<double>(),
      1.6 - 0.1 * 189 / 300, 1e-12);
  const Json sheet = pbrt_material_of(
      "Material \"diffusetransmission\" \"rgb reflectance\" [0.2 0.2 0.2] \"float scale\" 2");
  EXPECT_EQ(sheet.at("reflectance"), Json({0.4, 0.4, 0.4}));
  EXPECT_EQ(sheet.at("transmittance"), Json({0.5, 0.5, 0.5}));
}

// alpha = sqrt(roughness) if pbrt remaps it. The parameter of scenes is sqrt(alpha).
TEST(ImportedMaterials, RoughnessKeepsAlpha) {
  const auto alpha = [](const std::string& parameters) {
    const double roughness =
        pbrt_material_of("Material \"dielectric\" " + parameters).at("roughness").get<double>();
    return roughness * roughness;
  };
  EXPECT_NEAR(alpha("\"float roughness\" 0.09"), 0.3, 1e-12);
  EXPECT_NEAR(alpha("\"float roughness\" 0.09 \"bool remaproughness\" false"), 0.09, 1e-12);
  EXPECT_NEAR(alpha("\"float uroughness\" 0.01 \"float vroughness\" 0.16"), 0.2, 1e-12);
  EXPECT_EQ(alpha(""), 0);
  const double rough =
      mitsuba_material_of("<bsdf type='roughdielectric'><float name='alpha' value='0.2'/></bsdf>")
          .at("roughness")
          .get<double>();
  EXPECT_NEAR(rough * rough, 0.2, 1e-12);
}

TEST(ImportedMaterials, MapParametersOfMitsuba) {
  EXPECT_NEAR(mitsuba_material_of("<bsdf type='dielectric'/>").at("ior").get<double>(), 1.5046 / 1.00028,
              1e-9);
  EXPECT_NEAR(
      mitsuba_material_of("<bsdf type='dielectric'><string name='intIOR' value='water'/><float name='extIOR' "
                          "value='1'/></bsdf>")
          .at("ior")
          .get<double>(),
      1.333, 1e-12);
  EXPECT_EQ(mitsuba_material_of(
                "<bsdf type='twosided'><bsdf type='diffuse'><rgb name='reflectance' value='#ff0000'/>"
                "</bsdf></bsdf>")
                .at("reflectance"),
            Json({1.0, 0.0, 0.0}));
  EXPECT_EQ(mitsuba_material_of(
                "<bsdf type='mask'><float name='opacity' value='0.25'/><bsdf type='diffuse'/></bsdf>")
                .at("opacity"),
            0.25);
  EXPECT_EQ(
      mitsuba_material_of("<bsdf type='conductor'><string name='material' value='Ag'/></bsdf>").at("name"),
      "silver");
  EXPECT_GT(reflectance_of(
                mitsuba_material_of("<bsdf type='conductor'><string name='material' value='none'/></bsdf>")),
            0.99999);
  const Json metal = mitsuba_material_of(
      "<bsdf type='principled'><rgb name='base_color' value='0.9 0.6 0.3'/><float "
      "name='metallic' value='1'/><float name='roughness' value='0.4'/></bsdf>");
  EXPECT_EQ(metal.at("metallic"), 1.0);
  EXPECT_EQ(metal.at("roughness"), 0.4);
  EXPECT_EQ(metal.at("base_color"), Json({0.9, 0.6, 0.3}));
}

TEST(ImportedMaterials, ScaleAndMixConstantTextures) {
  const std::string textures =
      "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [0.8 0.4 0.2] "
      "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5 "
      "Texture \"c\" \"spectrum\" \"mix\" \"texture tex1\" \"a\" \"texture tex2\" \"b\" \"float amount\" "
      "0.25 "
      "Texture \"d\" \"spectrum\" \"imagemap\" \"string filename\" \"t/x.png\" \"float scale\" 0.5 \"float "
      "uscale\" 3 ";
  EXPECT_EQ(
      pbrt_material_of(textures + "Material \"diffuse\" \"texture reflectance\" \"b\"").at("reflectance"),
      Json({0.4, 0.2, 0.1}));
  const Json mixed =
      pbrt_material_of(textures + "Material \"diffuse\" \"texture reflectance\" \"c\"").at("reflectance");
  EXPECT_NEAR(mixed[0].get<double>(), 0.7, 1e-12);
  const auto image = imported("WorldBegin " + textures +
                                  "Material \"diffuse\" \"texture reflectance\" \"d\" Shape \"sphere\"",
                              {}, {.folder = "room/"})
                         .scene;
  EXPECT_EQ(image.at("textures").at("t/x.png").at("file"), "room/t/x.png");
  EXPECT_EQ(image.at("textures").at("t/x.png").at("mapping").at("repeat_u"), 3.0);
  EXPECT_EQ(Json(image.at("materials")).begin().value().at("reflectance"),
            Json({{"texture", "t/x.png"}, {"tint", {0.5, 0.5, 0.5}}}));
}

// The upper left texel of an image is at v = 0 in Mitsuba and at v = 1 in scenes. OBJ files are turned over.
TEST(ImportedMaterials, ImagesOfMitsubaBeginAtTheTop) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  const auto mapping = [&](const std::string& shape) {
    const auto scene =
        imported("<scene version='3.0.0'><sensor type='perspective'/><shape type=" + shape +
                     "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' "
                     "value='a.png'/></texture></bsdf></shape></scene>",
                 {{"a.obj", obj}})
            .scene;
    return Json(scene.at("textures").at("a.png").value("mapping", nlohmann::ordered_json::object()));
  };
  EXPECT_EQ(
      mapping("'rectangle'>"),
      Json({{"type", "uv"}, {"repeat_u", 1.0}, {"repeat_v", -1.0}, {"shift_u", 0.0}, {"shift_v", 1.0}}));
  EXPECT_EQ(mapping("'obj'><string name='filename' value='a.obj'/>"), Json::object());
}

// Evaluates a rational Bezier patch (de Casteljau would give the same).
Vec3d patch_point(const Json& patch, std::size_t first, double u, double v) {
  const auto degree_u = patch.at("degree_u").get<std::size_t>(),
             degree_v = patch.at("degree_v").get<std::size_t>();
  const auto bernstein = [](std::size_t n, std::size_t i, double t) {
    const double choose = n == 2 && i == 1 ? 2 : 1;
    return choose * std::pow(t, static_cast<double>(i)) * std::pow(1 - t, static_cast<double>(n - i));
  };
  Vec3d sum(0.0);
  double weights = 0;
  for (std::size_t row = 0; row <= degree_v; ++row)
    for (std::size_t column = 0; column <= degree_u; ++column) {
      const std::size_t at = first + row * (degree_u + 1) + column;
      const double weight = patch.at("weights")[at].get<double>() * bernstein(degree_v, row, v) *
                            bernstein(degree_u, column, u);
      sum = sum + vector(patch.at("points")[at]) * weight;
      weights += weight;
    }
  return sum / weights;
}

TEST(ImportedShapes, PartsOfQuadricsLieOnTheQuadric) {
  const auto patch_of = [](const std::string& shape) {
    return Json(
        imported("Scale -1 1 1 Camera \"perspective\" WorldBegin Shape " + shape).scene.at("objects")[0]);
  };
  const Json sphere =
      patch_of("\"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 1.5 \"float phimax\" 200");
  const Json cylinder = patch_of("\"cylinder\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 3");
  ASSERT_EQ(sphere.at("type"), "patch");
  double low = 9, high = -9;
  for (std::size_t first = 0; first < sphere.at("points").size(); first += 9)
    for (const double u : {0.0, 0.3, 1.0})
      for (const double v : {0.0, 0.6, 1.0}) {
        const Vec3d p = patch_point(sphere, first, u, v);
        EXPECT_NEAR(length(p), 2, 1e-12);
        low = std::min(low, p.z);
        high = std::max(high, p.z);
      }
  EXPECT_NEAR(low, -1, 1e-12);
  EXPECT_NEAR(high, 1.5, 1e-12);
  for (std::size_t first = 0; first < cylinder.at("points").size(); first += 6)
    for (const double u : {0.0, 0.3, 1.0}) {
      const Vec3d p = patch_point(cylinder, first, u, 0.5);
      EXPECT_NEAR(std::hypot(p.x, p.y), 2, 1e-12);
      EXPECT_NEAR(p.z, 1, 1e-12);
    }
}

std::string lit(const std::string& shapes) {
  return "LookAt 3 4 -8  0 1 0  0 1 0 Camera \"perspective\" \"float fov\" 40\nFilm \"rgb\" \"integer "
         "xresolution\" 60 "
         "\"integer yresolution\" 40\nWorldBegin LightSource \"distant\" \"point3 from\" [1 3 -2] \"rgb L\" "
         "[3 3 3]\n" +
         shapes;
}

// Equal scenes, one with an instance and one without, have equal images.
TEST(ImportedShapes, InstancesEqualShapesInPlace) {
  const std::string body =
      "AttributeBegin Rotate 30 1 0 0 Translate 0.5 0 0 Shape \"sphere\" \"float radius\" 0.7 AttributeEnd "
      "Shape \"trianglemesh\" \"point3 P\" [-2 -1 0  2 -1 0  0 2 1] ";
  const std::string place = "Translate 0.3 0.5 1 Rotate 50 1 1 0 Scale 1.5 1.5 1.5 ";
  const Picture instanced = render(
      loaded(imported(lit("ObjectBegin \"o\" " + body + "ObjectEnd " + place + "ObjectInstance \"o\""))),
      in_double());
  const Picture direct = render(loaded(imported(lit(place + body))), in_double());
  EXPECT_GT(direct.brighter_than(0.1f), 100);
  EXPECT_LE(differing_pixels(instanced, direct, 1e-4), 2);
}

TEST(ImportedShapes, MirroredMeshFilesEqualInlineMeshes) {
  TriangleMesh mesh;
  mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 2, 0.5}, {0, 0.5, -1}};
  mesh.triangles = {{0, 3, 2}, {3, 1, 2}, {0, 1, 3}, {0, 2, 1}};
  const Files files{{"a.ply", ply_of(mesh)}};
  const std::string values =
      "\"point3 P\" [-1 0 0 1 0 0 0 2 0.5 0 0.5 -1] \"integer indices\" [0 3 2 3 1 2 0 1 3 0 2 1]";
  for (const char* const place : {"", "Scale 1 2 1 Rotate 30 1 0 0 ", "Scale -1 1 1 Translate 1 0 0 "}) {
    const Picture of_file = render(
        loaded(imported(lit(place + std::string("Shape \"plymesh\" \"string filename\" \"a.ply\"")), files),
               files),
        in_double());
    const Picture in_line =
        render(loaded(imported(lit(place + std::string("Shape \"trianglemesh\" ") + values))), in_double());
    EXPECT_GT(in_line.brighter_than(0.1f), 50);
    EXPECT_LE(differing_pixels(of_file, in_line, 1e-4), 2) << place;
  }
}

TEST(ImportedShapes, LargeMeshesBecomeFiles) {
  std::string points, indices;
  for (int i = 0; i < 1200; ++i) {
    points += std::to_string(i % 3) + " " + std::to_string(i / 3) + " 0 ";
    indices += std::to_string(i) + " ";
  }
  const std::string text =
      "WorldBegin Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [" + indices + "]";
  const ImportedScene made = imported(text);
  ASSERT_EQ(made.files.size(), 1u);
  EXPECT_EQ(made.files[0].name, "made-1.ply");
  EXPECT_EQ(read_model(made.files[0].bytes).mesh.positions.size(), 1200u);
  EXPECT_THAT(import_problem(text), HasSubstr("name the scene with --output"));
}

// Version 0.6 differs from version 3 in the spelling of names only.
TEST(ImportedScenes, VersionsOfMitsubaAreEqual) {
  const auto text = [](bool old) {
    const std::string world = old ? "toWorld" : "to_world", look = old ? "lookAt" : "lookat";
    return "<scene version='" + std::string(old ? "0.6.0" : "3.0.0") +
           "'><default name='w' value='50'/><sensor type='thinlens'>"
           "<float name='" +
           (old ? "apertureRadius" : "aperture_radius") + "' value='0.1'/><float name='" +
           (old ? "focusDistance" : "focus_distance") + "' value='6'/><transform name='" + world + "'><" +
           look +
           " origin='0, 1, 5' target='0, 0, 0' up='0, 1, 0'/></transform><film type='hdrfilm'><integer "
           "name='width' "
           "value='$w'/></film></sensor><bsdf type='roughplastic' id='p'><float name='" +
           (old ? "intIOR" : "int_ior") + "' value='1.6'/><rgb name='" +
           (old ? "diffuseReflectance" : "diffuse_reflectance") +
           "' value='.1 .2 .3'/></bsdf><shape type='cube'><transform name='" + world +
           "'><rotate y='1' angle='30'/><translate x='1'/></transform><ref id='p'/></shape></scene>";
  };
  EXPECT_EQ(imported(text(true)).scene.dump(), imported(text(false)).scene.dump());
  EXPECT_EQ(imported(text(false)).scene.at("image").at("width"), 50);
}

TEST(ImportedScenes, IncludesFilesAndShapegroups) {
  const std::string text =
      "<scene version='3.0.0'><sensor type='perspective'/><include filename='parts/a.xml'/><alias id='red' "
      "as='paint'/>"
      "<shape type='shapegroup' id='g'><shape type='sphere'><ref id='paint'/></shape></shape><shape "
      "type='instance'><ref id='g'/>"
      "<transform name='to_world'><translate x='2'/></transform></shape></scene>";
  const auto scene = imported(text, {{"parts/a.xml",
                                      "<scene version='3.0.0'><bsdf type='diffuse' id='red'><rgb "
                                      "name='reflectance' value='1 0 0'/></bsdf></scene>"}})
                         .scene;
  EXPECT_EQ(scene.at("instances")[0].at("translate"), Json({2.0, 0.0, 0.0}));
  EXPECT_EQ(scene.at("materials").at("red").at("reflectance"), Json({1.0, 0.0, 0.0}));
  const auto pbrt = imported("WorldBegin Include \"a.pbrt\" Import \"b.pbrt\" Shape \"sphere\"",
                             {{"a.pbrt", "Translate 1 0 0"}, {"b.pbrt", "Translate 5 0 0 Shape \"sphere\""}})
                        .scene;
  EXPECT_EQ(pbrt.at("objects")[0].at("center"), Json({6.0, 0.0, 0.0}));
  EXPECT_EQ(pbrt.at("objects")[1].at("center"), Json({1.0, 0.0, 0.0}));
}

TEST(ImportedScenes, NoteEachKindOnceWithItsNumber) {
  const ImportedScene made = imported(
      "WorldBegin Shape \"sphere\" \"float hue\" 1 Shape \"curve\" \"point3 P\" [0 0 0] Shape \"curve\" "
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" Material \"hair\" Shape \"disk\" Material "
      "\"interface\" Shape \"disk\"");
  EXPECT_THAT(made.notes,
              ElementsAre("parameter \"hue\" of shape \"sphere\" has no effect",
                          "shape \"curve\" is left out (2 times)", "medium is left out",
                          "material \"hair\" is replaced by a matt one",
                          "surface without a material, such as the boundary of a medium, is left out"));
  EXPECT_EQ(made.scene.at("objects").size(), 2u);
}

}  // namespace
}  // namespace orrery::test
