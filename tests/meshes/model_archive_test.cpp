#include "core/meshes/model_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string cube_with_file(const std::string& uri) { return gltf_of(cube()).with_file(kOneMesh, uri); }
std::string cube_buffer() { return gltf_of(cube()).binary(); }

// Returns an archive with a cube in chairs/new/, whose buffer has the name `entry` in the archive and the
// name `uri` in the model.
std::string archived_cube(const std::string& entry, const std::string& uri) {
  return Zip().add("chairs/new/chair.gltf", cube_with_file(uri)).add(entry, cube_buffer()).bytes();
}

// Returns the path of the model in an archive of these files, or the error.
std::string model_among(const std::vector<std::string>& names) {
  Zip zip;
  for (const std::string& name : names) zip.add(name, obj_of(cube()));
  const std::string bytes = zip.bytes();
  try {
    return ModelArchive(bytes).model_name();
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ModelArchive, ReadsModelOfEveryFormat) {
  const std::pair<std::string, std::string> files[] = {{"a.obj", obj_of(cube())},
                                                       {"a.ply", ply_of(cube())},
                                                       {"a.stl", binary_stl_of(cube())},
                                                       {"a.3mf", three_mf_of(cube())},
                                                       {"a.glb", gltf_of(cube()).glb(kOneMesh)},
                                                       {"A.GLTF", gltf_of(cube()).gltf(kOneMesh)}};
  for (const auto& [name, content] : files) {
    const MeshModel model = read_model(Zip().add("notes.txt", "old").add(name, content).bytes());
    EXPECT_EQ(corners_of(model.mesh), corners_of(cube())) << name;
    EXPECT_EQ(model.format, mesh_format(content)) << name;
  }
}

TEST(ModelArchive, ReadsFilesRelativeToTheModel) {
  const std::pair<const char*, const char*> names[] = {{"chairs/new/a.bin", "a.bin"},
                                                       {"chairs/new/data/a.bin", "data/a.bin"},
                                                       {"chairs/new/data/a.bin", "./data//./a.bin"},
                                                       {"chairs/a.bin", "../a.bin"},
                                                       {"a.bin", "x/../../../a.bin"},
                                                       {"chairs\\new\\data\\a.bin", "data/a.bin"},
                                                       {"chairs/new/data/a.bin", "data%5Ca.bin"},
                                                       {"./chairs/new/a.bin", "a.bin"},
                                                       {"/chairs/new/a.bin", "a.bin"},
                                                       {"Chairs/New/A.BIN", "a.bin"}};
  for (const auto& [entry, uri] : names)
    EXPECT_EQ(corners_of(read_mesh(archived_cube(entry, uri))), corners_of(cube())) << entry << ' ' << uri;
}

TEST(ModelArchive, ReadsMaterialLibraries) {
  const MeshModel model = read_model(Zip()
                                         .add("x/a.obj", "mtllib Paint.mtl\nusemtl red\n" + obj_of(cube()))
                                         .add("x/paint.mtl", "newmtl red\nKd 1 0 0\nmap_Kd maps\\wood.png\n")
                                         .add("x/maps/wood.png", "an image")
                                         .bytes());
  ASSERT_EQ(model.materials.size(), 1);
  EXPECT_EQ(model.materials[0].name, "red");
  ASSERT_EQ(model.images.size(), 1);
  EXPECT_EQ(*model.images[0].bytes, "an image");
}

TEST(ModelArchive, PrefersNamesOfEqualCase) {
  const std::string bytes = Zip()
                                .add("a.BIN", "another file")
                                .add("a.bin", cube_buffer())
                                .add("chair.gltf", cube_with_file("a.bin"))
                                .bytes();
  EXPECT_EQ(problem(bytes), "accepted");
}

TEST(ModelArchive, ReadsNothingOutsideOfTheArchive) {
  EXPECT_THAT(problem(archived_cube("a.bin", "../../../a.bin")),
              HasSubstr("chairs/new/chair.gltf\": /buffers/0/uri: must be in the archive (got "
                        "\"../../../a.bin\")"));
  EXPECT_THAT(problem(archived_cube("a.bin", "/etc/passwd")),
              HasSubstr("cannot read \"/etc/passwd\": not in the archive"));
  const ReadNearby nearby = [](const std::string&) -> std::string { return cube_buffer(); };
  EXPECT_THROW(read_mesh(archived_cube("a.bin", "b.bin"), {}, nearby), InputError);
  for (const char* name : {"../a.obj", "x/../../a.obj", "..\\a.obj", "../readme"})
    EXPECT_THAT(model_among({"chair.obj", name}),
                AllOf(HasSubstr("entry \"" + std::string(name)), HasSubstr("must have a path inside")));
}

TEST(ModelArchive, FindsTheModel) {
  EXPECT_EQ(model_among({"chair.mtl", "wood.png", "chair.obj"}), "chair.obj");
  EXPECT_EQ(model_among({"a.obj", "b.stl", "x/y/c.glb"}), "x/y/c.glb") << "glTF before others";
  EXPECT_EQ(model_among({"x/old.ply", "new.PLY", "x/y/other.stl"}), "new.PLY") << "the shallowest";
  EXPECT_EQ(model_among({"__MACOSX/._a.obj", "x/.b.obj", ".git/c.obj", "x/a.obj"}), "x/a.obj");
  EXPECT_EQ(model_among({"x\\chair.obj", "chair.obj/"}), "x/chair.obj");
  EXPECT_THAT(model_among({"b.obj", "x/a.obj", "a.stl"}),
              HasSubstr("archive must contain one model (got 2: \"b.obj\", \"a.stl\")"));
  EXPECT_THAT(model_among({"1.obj", "2.obj", "3.obj", "4.obj", "5.obj", "6.obj"}),
              HasSubstr("(got 6: \"1.obj\", \"2.obj\", \"3.obj\", \"4.obj\", \"5.obj\", ...)"));
  EXPECT_THAT(model_among({"readme.txt", ".a.obj"}), HasSubstr("archive must contain a model: .gltf, .glb"));
}

TEST(ModelArchive, RejectsArchivesInArchives) {
  const std::string inner = Zip().add("a.obj", obj_of(cube())).bytes();
  EXPECT_THAT(problem(Zip().add("b.obj", inner).bytes()), HasSubstr("must not be an archive in an archive"));
  EXPECT_THAT(problem(Zip().add("b.zip", inner).bytes()), HasSubstr("must contain a model"));
}

TEST(ModelArchive, LeavesPackagesToTheirReader) {
  EXPECT_TRUE(ModelArchive::is_archive(Zip().add("a.obj", "").bytes()));
  EXPECT_FALSE(ModelArchive::is_archive(three_mf_of(cube())));
  EXPECT_FALSE(ModelArchive::is_archive(obj_of(cube())));
}

TEST(ModelArchive, RejectsHostileArchives) {
  const std::string good = Zip().add("a.obj", obj_of(cube())).bytes();
  for (std::size_t size = 4; size < good.size(); ++size)
    EXPECT_THAT(problem(good.substr(0, size)), HasSubstr("archive: cannot read")) << size;

  std::string encrypted = good;  // bit 0 of the flags in both headers
  encrypted[6] |= 1;
  encrypted[encrypted.find("PK\1\2") + 8] |= 1;
  EXPECT_THAT(problem(encrypted), HasSubstr("entry \"a.obj\": must not be encrypted"));

  Zip many;
  for (int i = 0; i < 65535; ++i) many.add(std::to_string(i), "");
  EXPECT_THAT(problem(many.bytes()), HasSubstr("archive has more than 10,000 entries (limit 10,000)"));

  // 2 GB of content according to the directory.
  std::string large = good;
  large.replace(large.find("PK\1\2") + 24, 4, std::string("\0\0\0\x7f", 4));
  EXPECT_THAT(problem(large), HasSubstr("entries must unpack to at most 536,870,912 bytes"));

  // An end record that refers to sizes of 64 bits, which are missing.
  std::string wide = good;
  wide.replace(wide.size() - 10, 8, std::string(8, '\xff'));
  EXPECT_THAT(problem(wide), HasSubstr("archive: cannot read"));
}

TEST(ModelArchive, DoesNotEndNamesAtNul) {
  EXPECT_EQ(model_among({std::string("a.obj\0.png", 10), "b.obj"}), "b.obj");
}

}  // namespace
}  // namespace orrery::test
