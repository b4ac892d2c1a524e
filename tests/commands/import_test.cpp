#include <nlohmann/json.hpp>

#include "tests/commands/command_line.h"
#include "tests/meshes/writers.h"

// Tests `orrery import`.
namespace orrery {
namespace {

constexpr const char* kRoom =
    "LookAt 0 1 -4  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 30\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]\nShape \"plymesh\" \"string filename\" "
    "\"parts/cube.ply\"\n"
    "Shape \"curve\"\nShape \"curve\"\n";

class ImportCommand : public CommandLine {
 protected:
  void write_cube(const std::string& name) const {
    fs::create_directories((folder_ / name).parent_path());
    write(name,
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 0 0\n1 0 0\n0 2 0\n3 0 1 "
          "2\n");
  }
};

TEST_F(ImportCommand, WritesSceneThatRenders) {
  write_cube("parts/cube.ply");
  const Outcome made = run("import " + write("room.pbrt", kRoom) + " -o " + file("room.json"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.err, "orrery: warning: room.pbrt: shape \"curve\" is left out (2 times)\n");
  EXPECT_EQ(run("check " + file("room.json")).status, 0);
  EXPECT_EQ(run("render " + file("room.json") + " --samples 1 -o " + file("room.png")).status, 0);
  EXPECT_EQ(run("import " + file("room.pbrt")).out, bytes_of(file("room.json"))) << "standard output";
}

// Files are relative to the written scene.
TEST_F(ImportCommand, RefersToFilesFromTheFolderAbove) {
  write_cube("rooms/parts/cube.ply");
  const std::string room = write("rooms/room.pbrt", kRoom);
  ASSERT_EQ(run("import " + room + " -o " + file("above.json")).status, 0);
  const auto scene = nlohmann::json::parse(bytes_of(file("above.json")));
  EXPECT_NE(scene.dump().find("\"rooms/parts/cube.ply\""), std::string::npos);
  EXPECT_EQ(run("check " + file("above.json")).status, 0);
  fs::create_directories(folder_ / "other");
  const Outcome beside = run("import " + room + " -o " + file("other/a.json"));
  EXPECT_EQ(beside.status, 2);
  EXPECT_NE(beside.err.find("must be in the folder of the written scene or below it"), std::string::npos)
      << beside.err;
}

TEST_F(ImportCommand, ReadsMitsubaScenesAndStandardInput) {
  const std::string scene =
      write("a.xml",
            "<scene version='3.0.0'><sensor type='perspective'><transform name='to_world'>"
            "<lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform></sensor>"
            "<shape type='sphere'/><emitter type='constant'/></scene>");
  const Outcome made = run("import - -o " + file("a.json") + " < " + scene);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(run("check " + file("a.json")).err, "");
}

TEST_F(ImportCommand, RejectsInvalidScenes) {
  const auto expect = [&](const std::string& arguments, int status, const std::string& message) {
    const Outcome result = run("import " + arguments);
    EXPECT_EQ(result.status, status) << arguments;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  expect(write("b.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" -1"), 2,
         "b.pbrt:2: radius must be a number from 1e-12 to 1e12 (got -1)");
  expect(write("c.pbrt", "Include \"../x.pbrt\""), 2, "c.pbrt:1: file \"../x.pbrt\": ");
  expect(write("d.pbrt", kRoom) + " -o " + file("d.json"), 2, "d.pbrt, converted: /");
  EXPECT_FALSE(fs::exists(file("d.json"))) << "the mesh is missing";
  expect(file("none.pbrt"), 1, "cannot read ");
  expect(write("e.pbrt", kRoom) + " -o " + file("none/e.json"), 1, "cannot write ");
  expect("", 2, "SCENE");
}

}  // namespace
}  // namespace orrery
