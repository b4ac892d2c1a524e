#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/support.h"

// Invalid and hostile descriptions. Errors state file, line, value and limit.
namespace orrery::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Refusal {
  const char *text, *problem;
};

class PbrtRefusals : public ::testing::TestWithParam<Refusal> {};
class MitsubaRefusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(PbrtRefusals, StatePlaceAndValue) {
  EXPECT_THAT(import_problem(GetParam().text), StartsWith(std::string("x.scene:") + GetParam().problem));
}

INSTANTIATE_TEST_SUITE_P(
    All, PbrtRefusals,
    ::testing::Values(
        Refusal{"", "1: scene must have WorldBegin (got none)"},
        Refusal{"WorldBegin", "1: scene must have an object that can be drawn (got none)"},
        Refusal{"WorldBegin WorldBegin", "1: WorldBegin must be once"},
        Refusal{"\nWorldBegin\nSpere \"sphere\"", "3: directive must be one of pbrt's (got \"Spere\""},
        Refusal{"WorldBegin \"text\"", "1: line must begin with a directive"},
        Refusal{"WorldBegin\nShape sphere", "2: type of a shape must be in quotes (got \"sphere\")"},
        Refusal{"WorldBegin\nShape \"ball\"", "2: type of a shape must be one of pbrt's"},
        Refusal{"Shape \"sphere\"", "1: Shape must be after WorldBegin"},
        Refusal{"WorldBegin\nShape \"sphere\n\"", "2: text must end with \" on its line"},
        Refusal{"WorldBegin\nShape \"sphere", "2: text must end with \" on its line"},
        Refusal{"WorldBegin Shape \"sphere\" \"radius\" 1", "1: parameter must have a type and a name"},
        Refusal{"WorldBegin Shape \"sphere\" \"size radius\" 1",
                "1: type of parameter \"radius\" must be one of pbrt's"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float radius\" [1",
                "2: values of parameter \"radius\" must end with ]"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float radius\" nan",
                "2: parameter \"radius\" must be a finite number (got \"nan\")"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float radius\" 1e999",
                "2: parameter \"radius\" must be a finite number (got \"1e999\")"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float radius\" -1",
                "2: radius must be a number from 1e-12 to 1e12 (got -1)"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float radius\" [1 2]",
                "2: parameter \"radius\" must have one number (got 2 numbers"},
        Refusal{"WorldBegin Shape \"sphere\"\n\"float phimax\" 400",
                "1: phimax must be above 0 and at most 360 degrees (got 400)"},
        Refusal{"WorldBegin Shape \"disk\" \"float innerradius\" 2",
                "1: innerradius must be at least 0 and less than radius (got 2)"},
        Refusal{
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]",
            "1: index of a vertex must be an integer from 0 to 2 (got 3)"},
        Refusal{"WorldBegin Shape \"trianglemesh\"", "1: indices must be in groups of 3 (got 0 indices)"},
        Refusal{"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1]",
                "1: N must have one value for each of 3 vertices (got 1)"},
        Refusal{"WorldBegin Shape \"plymesh\" \"string filename\" \"/etc/x.ply\"",
                "1: name of a file must be relative to the scene"},
        Refusal{"WorldBegin Shape \"plymesh\"", "1: name of a file must not be empty"},
        Refusal{"WorldBegin Translate 1e13 0 0 Shape \"sphere\"",
                "1: coordinates in the scene must be from -1e12 to 1e12 (got 1e13)"},
        Refusal{"Translate 1 2", "1: Translate must be a finite number (got nothing)"},
        Refusal{"Scale 1e200 1 1", "1: transformation must be finite"},
        Refusal{"LookAt 0 0 0 0 0 0 0 1 0", "1: LookAt must have two different points"},
        Refusal{"Rotate 1 0 0 0", "1: axis of Rotate must not be 0"},
        Refusal{"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", "1: transformation must be affine"},
        Refusal{"Scale 0 1 1 Camera \"perspective\"", "1: camera must have a transformation with an inverse"},
        Refusal{"Camera \"perspective\" \"float fov\" 180 WorldBegin",
                "1: fov must be above 0 and below 180 degrees (got 180)"},
        Refusal{"Film \"rgb\" \"integer xresolution\" 0 WorldBegin",
                "1: xresolution must be an integer from 1"},
        Refusal{"CoordSysTransform \"a\"",
                "1: coordinate system must be defined before it is used (got \"a\")"},
        Refusal{"AttributeEnd", "1: AttributeEnd must close the innermost open block (got no open block)"},
        Refusal{"AttributeBegin TransformEnd",
                "1: TransformEnd must close the innermost open block (got another block)"},
        Refusal{"WorldBegin\nAttributeBegin", "2: block must have an end (got none)"},
        Refusal{"WorldBegin ObjectInstance \"a\"", "1: object must be defined before it is used (got \"a\")"},
        Refusal{"WorldBegin ObjectBegin \"a\" ObjectInstance \"a\"",
                "1: ObjectInstance must not be inside an object"},
        Refusal{"WorldBegin NamedMaterial \"a\"",
                "1: material must be defined before it is used (got \"a\")"},
        Refusal{"WorldBegin Material \"gold\" Shape \"sphere\"",
                "1: type of a material must be one of pbrt's"},
        Refusal{"WorldBegin Material \"diffuse\" \"texture reflectance\" \"a\" Shape \"sphere\"",
                "1: texture must be defined before it is used (got \"a\")"},
        Refusal{"Texture \"a\" \"spectrum\" \"stripes\"", "1: type of a texture must be one of pbrt's"},
        Refusal{"Texture \"a\" \"colour\" \"constant\"", "1: kind of a texture must be spectrum or float"},
        Refusal{"WorldBegin LightSource \"lamp\"", "1: type of a light must be one of pbrt's"},
        Refusal{"WorldBegin LightSource \"point\" \"blackbody I\" 0",
                "1: temperature of a black body must be a number from 100"},
        Refusal{"WorldBegin LightSource \"point\" \"spectrum I\" [500 1 400 2]",
                "1: wavelengths must be in ascending order (got 400)"},
        Refusal{"WorldBegin LightSource \"point\" \"rgb I\" [1 2]",
                "1: parameter \"I\" must have three numbers (got 2)"},
        Refusal{"Attribute \"shape\" \"float radius\" [1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 "
                "1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1]",
                "1: parameter \"radius\" must have at most 64 values"},
        Refusal{"Include \"b.pbrt\"", "1: file \"b.pbrt\": no such file"},
        Refusal{"\x1f\x8b", "1: file must not be compressed (got gzip)"}));

// A description that is valid but for the scene's contents.
std::string mitsuba_scene(const std::string& contents) {
  return "<scene version='3.0.0'><sensor type='perspective'/>\n" + contents + "</scene>";
}

TEST_P(MitsubaRefusals, StatePlaceAndValue) {
  EXPECT_THAT(import_problem(mitsuba_scene(GetParam().text)),
              StartsWith(std::string("x.scene:") + GetParam().problem));
}

INSTANTIATE_TEST_SUITE_P(
    All, MitsubaRefusals,
    ::testing::Values(
        Refusal{"", "1: scene must have an object that can be drawn (got none)"},
        Refusal{"<shape type='sphere'><flot name='radius' value='1'/></shape>",
                "2: element must be one of Mitsuba's"},
        Refusal{"<shape type='sphere'><float name='radius' value='x'/></shape>",
                "2: value must be a finite number (got \"x\")"},
        Refusal{"<shape type='sphere'><float name='radius' value='inf'/></shape>",
                "2: value must be a finite number (got \"inf\")"},
        Refusal{"<shape type='sphere'><float name='radius' value='0'/></shape>",
                "2: radius must be a number from 1e-12 to 1e12 (got 0)"},
        Refusal{"<shape type='sphere'><float name='radius' value='$r'/></shape>",
                "2: parameter must have a <default> (got \"$r\")"},
        Refusal{"<shape type='sphere'><ref id='a'/></shape>",
                "2: ref must name an object of the scene (got \"a\")"},
        Refusal{"<alias id='a' as='b'/>", "2: alias must name an object that is defined before it"},
        Refusal{"<shape type='sphere'><transform name='to_world'><spin/></transform></shape>",
                "2: transform must have steps"},
        Refusal{"<shape type='sphere'><transform name='to_world'><matrix value='1 2'/></transform></shape>",
                "2: matrix must have 9 or 16 numbers (got 2)"},
        Refusal{"<shape type='sphere'><transform name='to_world'><rotate angle='3'/></transform></shape>",
                "2: rotate must have an axis"},
        Refusal{"<shape type='instance'/>", "2: instance must refer to a shapegroup"},
        Refusal{"<shape type='cylinder'><point name='p1'/></shape>",
                "2: p0 and p1 of a cylinder must differ"},
        Refusal{"<shape type='obj'><string name='filename' value='a.obj'/></shape>",
                "2: mesh \"a.obj\": no such file"},
        Refusal{"<shape type='sphere'><bsdf type='twosided'/></shape>",
                "2: bsdf \"twosided\" must have a nested bsdf"},
        Refusal{"<shape type='sphere'><bsdf type='dielectric'><string name='int_ior' "
                "value='jelly'/></bsdf></shape>",
                "2: int_ior must be a number or a material"},
        Refusal{
            "<shape type='sphere'><bsdf type='diffuse'><rgb name='reflectance' value='1 2'/></bsdf></shape>",
            "2: colour must have one or three numbers"},
        Refusal{"<shape type='sphere'/><emitter type='spot'><float name='cutoff_angle' value='0'/></emitter>",
                "2: cutoff_angle must be above 0"},
        Refusal{"<include filename='b.xml'/>", "2: file \"b.xml\": no such file"}));

TEST(ImportRefusals, OfDocumentsNameTheFile) {
  EXPECT_THAT(import_problem("<scene>"), StartsWith("x.scene: document: must be XML in UTF-8"));
  EXPECT_THAT(import_problem("<!DOCTYPE a><scene/>"), HasSubstr("must not have a document type definition"));
  EXPECT_THAT(import_problem("<image/>"), HasSubstr("root of the document must be a scene (got \"image\")"));
  EXPECT_THAT(import_problem("<scene/>"), HasSubstr("scene must have a sensor (got none)"));
}

TEST(ImportRefusals, LimitIncludes) {
  EXPECT_THAT(import_problem("\nInclude \"a.pbrt\"", {{"a.pbrt", "\n\nInclude \"a.pbrt\""}}),
              StartsWith("a.pbrt:3: includes must be nested at most 32 deep"));
  const std::string loop = "<scene><include filename='a.xml'/></scene>";
  EXPECT_THAT(import_problem(loop, {{"a.xml", loop}}),
              StartsWith("a.xml:1: includes must be nested at most 32 deep"));
  // Two includes in each file would be 2^32 files.
  EXPECT_THAT(
      import_problem("Include \"a\"",
                     {{"a", "Include \"b\" Include \"b\""}, {"b", "Include \"c\" Include \"c\""}, {"c", ""}},
                     {.limits = {.files = 5}}),
      HasSubstr("scene must include at most 5 files (got more)"));
  EXPECT_THAT(import_problem("Include \"a\"", {{"a", std::string(100, ' ')}}, {.limits = {.bytes = 50}}),
              StartsWith("a:1: files of a scene must have at most 50 bytes together (got more)"));
}

TEST(ImportRefusals, LimitNestingAndNumbers) {
  std::string blocks, bsdfs = "<bsdf type='diffuse'/>", deep;
  for (int i = 0; i < 1001; ++i) blocks += "AttributeBegin\n";
  EXPECT_THAT(import_problem(blocks),
              StartsWith("x.scene:1001: blocks must be nested at most 1,000 deep (got more)"));
  for (int i = 0; i < 30; ++i) bsdfs = "<bsdf type='twosided'>" + bsdfs + "</bsdf>";
  EXPECT_THAT(import_problem(mitsuba_scene("<shape type='sphere'>" + bsdfs + "</shape>")),
              HasSubstr("bsdfs must be nested at most 16 deep"));
  for (int i = 0; i < 200; ++i) deep += "<scene>";
  EXPECT_THAT(import_problem(deep), HasSubstr("must have at most 100 levels of elements"));
  EXPECT_THAT(import_problem("WorldBegin Shape \"sphere\" Shape \"sphere\" Shape \"sphere\"", {},
                             {.limits = {.objects = 2}}),
              HasSubstr("scene must have at most 2 objects and instances (got more)"));
  EXPECT_THAT(import_problem("WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]", {},
                             {.limits = {.mesh_vertices = 3}}),
              HasSubstr("meshes of the description must have at most 3 vertices and triangles"));
}

// A bsdf that contains itself.
TEST(ImportRefusals, LimitReferences) {
  EXPECT_THAT(
      import_problem(mitsuba_scene(
          "<bsdf type='twosided' id='a'><ref id='a'/></bsdf><shape type='sphere'><ref id='a'/></shape>")),
      HasSubstr("bsdfs must be nested at most 16 deep"));
}

TEST(ImportRefusals, FilesOutsideOfTheFolderNeedAnOutput) {
  EXPECT_THAT(import_problem("WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"", {},
                             {.folder = std::nullopt}),
              HasSubstr("must be in the folder of the written scene or below it"));
}

}  // namespace
}  // namespace orrery::test
