#include "core/meshes/mtl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/base/error.h"

namespace orrery::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Returns a function that reads the files of a map.
ReadNearby files(const std::map<std::string, std::string>& files) {
  return [files](const std::string& name) {
    const auto at = files.find(name);
    if (at == files.end()) throw InputError("", "cannot read " + name);
    return at->second;
  };
}

// Returns the material "m" of a library with these lines, and images named a.png and b c.png.
MtlMaterials material_of(const std::string& lines) {
  return read_mtl({"l.mtl"}, {"m"},
                  files({{"l.mtl", "newmtl m\n" + lines}, {"a.png", "A"}, {"b c.png", "B"}}));
}

TEST(Mtl, ReadsColoursAndNumbers) {
  const ModelMaterial m =
      material_of("Kd 0.1 0.2 0.3\nKe 2 0 0\nPr 0.25\nPm 0.5\nd 0.75\nNi 1.5\n").materials.at(0);
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.base_color.factor, Vec3d(0.1, 0.2, 0.3));
  EXPECT_EQ(m.emission.factor, Vec3d(2, 0, 0));
  EXPECT_EQ(m.roughness.factor, 0.25);
  EXPECT_EQ(m.metallic.factor, 0.5);
  EXPECT_EQ(m.opacity, 0.75);
  EXPECT_EQ(m.alpha, ModelMaterial::Alpha::blend);
  EXPECT_EQ(material_of("Kd 0.5\n").materials.at(0).base_color.factor, Vec3d(0.5));
  EXPECT_EQ(material_of("Tr 0.25\n").materials.at(0).opacity, 0.75);
  EXPECT_EQ(material_of("d 1\nTr 1\n").materials.at(0).alpha, ModelMaterial::Alpha::opaque);
}

// The exponent of a Beckmann width alpha is 2 / alpha^2 - 2 (Walter et al. 2007), and alpha is roughness^2.
TEST(Mtl, DerivesRoughnessFromTheExponentOfHighlights) {
  const auto roughness = [](const std::string& lines) {
    return material_of(lines).materials.at(0).roughness.factor;
  };
  for (const double wanted : {0.1, 0.3, 0.9}) {
    const double alpha = wanted * wanted;
    EXPECT_NEAR(roughness("Ks 0.5 0.5 0.5\nillum 2\nNs " + std::to_string(2 / (alpha * alpha) - 2)), wanted,
                1e-6);
  }
  EXPECT_EQ(roughness("Ks 0 0 0\nNs 100\nillum 2\n"), 1);
  EXPECT_EQ(roughness("Ks 1 1 1\nNs 100\nillum 1\n"), 1);
  EXPECT_EQ(roughness("Ks 1 1 1\nNs 100\nPr 0.2\n"), 0.2);
  EXPECT_EQ(roughness("Ks 1 1 1\nNs -5\n"), 1);
}

TEST(Mtl, ReadsMapsWithOptions) {
  const MtlMaterials found = material_of(
      "Kd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 -blendu off -clamp on -mm 0 1 a.png\n"
      "map_Ke -imfchan r b c.png\nmap_Pr a.png\nPr 0.5\nnorm -bm 0.5 sub\\a.png\n");
  EXPECT_THAT(found.notes, IsEmpty());
  ASSERT_EQ(found.images.size(), 3u);
  const ModelMaterial& m = found.materials.at(0);
  ASSERT_TRUE(m.base_color.texture && m.emission.texture && m.roughness.texture && m.normal);
  EXPECT_EQ(*m.base_color.texture,
            (ModelTexture{0, ModelTexture::Wrap::clamp, ModelTexture::Wrap::clamp, {2, 3}, {0.5, 0}}));
  EXPECT_EQ(m.base_color.factor, Vec3d(1));
  EXPECT_EQ(*m.emission.texture, ModelTexture{1});
  EXPECT_EQ(m.emission.factor, Vec3d(1));
  EXPECT_EQ(m.roughness.texture->image, 0);
  EXPECT_EQ(m.roughness.factor, 0.5);
  EXPECT_EQ(m.normal->factor, 0.5);
  EXPECT_EQ(*found.images[1].bytes, "B");
  EXPECT_EQ(found.images[2].name, "sub/a.png");
}

TEST(Mtl, FindsLibrariesByTheFormsOfTheirNames) {
  const ReadNearby nearby = files({{"my materials.mtl", "newmtl a b\n"},
                                   {"x/y.mtl", "newmtl c\r\n"},
                                   {"z.mtl", "newmtl d\nKd 1 0 0\nnewmtl a b\n"}});
  EXPECT_THAT(read_mtl({"my materials.mtl"}, {"c", "a b"}, nearby).indices, ElementsAre(-1, 0));
  EXPECT_THAT(read_mtl({"x\\y.mtl z.mtl"}, {"d", "c", "a b"}, nearby).indices, ElementsAre(0, 1, 2));
  EXPECT_THAT(read_mtl({"C:\\home\\z.mtl"}, {"d"}, nearby).indices, ElementsAre(0));
  const MtlMaterials lacking = read_mtl({"z.mtl missing.mtl"}, {"d", "c"}, nearby);
  EXPECT_THAT(lacking.indices, ElementsAre(0, -1));
  EXPECT_THAT(lacking.notes,
              ElementsAre("material library \"z.mtl missing.mtl\" is missing: cannot read missing.mtl"));
  EXPECT_THAT(read_mtl({"z.mtl"}, {"e"}, nearby).notes, ElementsAre("material \"e\" is not defined"));
  EXPECT_THAT(read_mtl({"z.mtl"}, {"d"}, {}).notes, ElementsAre(HasSubstr("other files are not available")));
}

TEST(Mtl, NotesWhatIsInvalidOrNotModelled) {
  const MtlMaterials found = material_of(
      "Kd spectral a.rfl\nNs\nmap_Bump -bm 1 a.png\nmap_d a.png\nmap_Kd\nmap_Pm missing.png\n"
      "map_Ke -s 1e9 a.png\nKd 2 -1 0.5\nTf 1 1 1\nmap_d a.png\n");
  EXPECT_EQ(found.materials.at(0).base_color.factor, Vec3d(1, 0, 0.5));
  EXPECT_FALSE(found.materials.at(0).emission.texture);
  EXPECT_THAT(found.notes, ElementsAre("image \"missing.png\" is missing: cannot read missing.png",
                                       "\"l.mtl\": line 2: Kd must be a finite number (got \"spectral\")",
                                       "\"l.mtl\": line 3: Ns must be a finite number (got nothing)",
                                       "\"l.mtl\": line 6: map_Kd must name a file",
                                       "\"l.mtl\": line 8: -s must be at most 1e+05 in magnitude (got 1e+09)",
                                       "key \"Tf\" of materials is not modelled",
                                       "key \"map_Bump\" of materials is not modelled",
                                       "key \"map_d\" of materials is not modelled"));
}

TEST(Mtl, BoundsNotes) {
  std::string lines;
  for (int i = 0; i < 50; ++i)
    lines += "Ns x\nmap_Kd no" + std::to_string(i) + "\nkey" + std::to_string(i) + " 1\n";
  const MtlMaterials found = material_of(lines);
  EXPECT_LT(found.notes.size(), 30u);
  EXPECT_THAT(found.notes, Contains("42 more lines of material libraries are invalid"));
}

TEST(Mtl, MakesNamesValidUtf8) {
  EXPECT_EQ(read_mtl({"l"}, {"caf\xe9"}, files({{"l", "newmtl caf\xe9"}})).materials.at(0).name, "caf?");
  EXPECT_EQ(read_mtl({"l"}, {"caf\xc3\xa9"}, files({{"l", "newmtl caf\xc3\xa9"}})).materials.at(0).name,
            "caf\xc3\xa9");
}

}  // namespace
}  // namespace orrery::test
