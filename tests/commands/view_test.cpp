#include <nlohmann/json.hpp>

#include "tests/commands/command_line.h"
#include "tests/meshes/writers.h"

// Tests `orrery view`.
namespace orrery {
namespace {

class ViewCommand : public CommandLine {
 protected:
  std::string model() const { return write("a cube.stl", test::binary_stl_of(test::cube())); }
  std::string view(const std::string& more) const { return "view '" + model() + "' " + more; }
};

TEST_F(ViewCommand, RendersModelWithoutScene) {
  const Outcome to_file = run(view("--width 40 --height 30 --samples 2 -o " + file("a.png")));
  EXPECT_EQ(to_file.status, 0) << to_file.err;
  const Outcome to_output = run(view("--width 40 --height 30 --samples 2 -o -"));
  EXPECT_EQ(to_output.status, 0) << to_output.err;
  EXPECT_EQ(to_output.out, bytes_of(file("a.png")));
  EXPECT_EQ(to_output.out.substr(1, 3), "PNG");
  EXPECT_EQ(run(view("--width 8 --height 8 --samples 1 -o - --format jpeg")).out.substr(0, 3),
            "\xFF\xD8\xFF");
  EXPECT_EQ(run("view - --width 40 --height 30 --samples 2 -o - < '" + model() + "'").out, to_output.out);
}

TEST_F(ViewCommand, ReadsArchives) {
  const std::string archive =
      write("cube.zip", test::Zip().add("a/cube.stl", test::binary_stl_of(test::cube())).bytes());
  const std::string options = " --width 40 --height 30 --samples 2 -o -";
  const Outcome image = run("view " + archive + options);
  ASSERT_EQ(image.status, 0) << image.err;
  EXPECT_TRUE(image.out == run(view(options)).out);
  EXPECT_TRUE(run("view - " + options + " < " + archive).out == image.out);
  ASSERT_EQ(run("view " + archive + " --width 40 --height 30 --print-scene -o " + file("s.json")).status, 0);
  EXPECT_TRUE(run("render " + file("s.json") + options).out == image.out) << "the mesh of a scene";
  EXPECT_EQ(nlohmann::json::parse(run("inspect --json " + archive).out).at("format"), "stl");
  const Outcome refused = run("inspect " + write("none.zip", test::Zip().add("a.txt", "").bytes()));
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("archive must contain a model"), std::string::npos) << refused.err;
}

// The printed scene, rendered in the folder of the model, is the same image.
TEST_F(ViewCommand, PrintsSceneOfImage) {
  const std::string options = "--from iso --ground grid --width 40 --height 30 ";
  const Outcome scene = run(view(options + "--print-scene -o " + file("s.json")));
  ASSERT_EQ(scene.status, 0) << scene.err;
  EXPECT_EQ(run("render " + file("s.json") + " --samples 2 -o " + file("a.png")).err, "");
  EXPECT_EQ(run(view(options + "--samples 2 -o " + file("b.png"))).status, 0);
  EXPECT_EQ(bytes_of(file("a.png")), bytes_of(file("b.png")));
  const auto json = nlohmann::json::parse(bytes_of(file("s.json")));
  EXPECT_EQ(json.at("camera").at("up"), nlohmann::json({0.0, 0.0, 1.0})) << "z is up in STL files";
  EXPECT_EQ(json.at("title"), "a cube.stl");
}

TEST_F(ViewCommand, RejectsBadOptions) {
  const std::pair<const char*, const char*> cases[] = {
      {"--from up", "--from: must be front, right, back, left, top, bottom, iso, or azimuth and elevation"},
      {"--from 0,91", "(got \"0,91\")"},
      {"--from 1,2,3", "(got \"1,2,3\")"},
      {"--up w", "--up: must be one of"},
      {"--ground sand", "--ground: must be one of"},
      {"-o - --stats", "--stats: cannot be used with --output -"},
      {"-o a.bmp", "--output: must be a name that ends in"}};
  for (const auto& [option, message] : cases) {
    const Outcome result = run(view(option));
    EXPECT_EQ(result.status, 2) << option;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  }
  EXPECT_EQ(run("view " + file("none.stl")).status, 1);
  const Outcome broken = run("view " + write("b.stl", "solid\nfacet"));
  EXPECT_EQ(broken.status, 2);
  EXPECT_NE(broken.err.find("b.stl: "), std::string::npos) << broken.err;
}

// Buffers of a .gltf file are read from its folder, and from nowhere else.
TEST_F(ViewCommand, ReadsBuffersBesideModel) {
  test::Gltf gltf = test::gltf_of(test::cube());
  fs::create_directories(folder_ / "models/parts");
  std::ofstream(folder_ / "models/parts/cube 1.bin", std::ios::binary) << gltf.binary();
  std::ofstream(folder_ / "secret.bin", std::ios::binary) << gltf.binary();
  fs::create_symlink("../secret.bin", folder_ / "models/link.bin");
  const auto view_with = [&](const std::string& uri) {
    return run("view " + write("models/a.gltf", gltf.with_file(test::kOneMesh, uri)) +
               " --samples 1 --width 8 --height 8 -o " + file("a.png"));
  };
  EXPECT_EQ(view_with("parts/cube%201.bin").status, 0);
  for (const std::string uri : {"../secret.bin", "link.bin", "parts/../../secret.bin"}) {
    const Outcome result = view_with(uri);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("/buffers/0/uri: must be a file in the model's folder or below it"),
              std::string::npos)
        << result.err;
  }
  EXPECT_NE(view_with(file("secret.bin")).status, 0) << "an absolute path";
}

TEST_F(ViewCommand, WarnsAboutContentsThatAreNotModelled) {
  const Outcome result = run("view " + write("a.obj", "l 1 2\n" + test::obj_of(test::cube())) +
                             " --samples 1 --width 8 --height 8 -o -");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "orrery: warning: " + file("a.obj") + ": 1 lines are not rendered\n");
}

TEST_F(ViewCommand, ReadsMaterialLibrariesInTheFolderOfTheModel) {
  fs::create_directory(folder_ / "models");
  write("a.mtl", "newmtl red\nKd 0.5 0 0\n");
  const auto base_color_with = [&](const std::string& library) {
    const std::string text = "mtllib " + library + "\nusemtl red\n" + test::obj_of(test::cube());
    const Outcome result = run("view " + write("models/a.obj", text) + " --print-scene -o -");
    EXPECT_EQ(result.status, 0) << result.err;
    const auto material = nlohmann::json::parse(result.out).at("materials");
    return material.contains("red") ? material.at("red").at("base_color") : nlohmann::json();
  };
  EXPECT_EQ(base_color_with("../a.mtl"), nlohmann::json());
  write("models/a.mtl", "newmtl red\nKd 0 0.5 0\n");
  EXPECT_EQ(base_color_with("C:\\programs\\a.mtl"), nlohmann::json({0, 0.5, 0}));
}

TEST_F(ViewCommand, TakesZAsUpIn3mfFiles) {
  const auto camera_of = [&](const std::string& name, const std::string& bytes) {
    return nlohmann::json::parse(run("view " + write(name, bytes) + " --print-scene -o -").out).at("camera");
  };
  const nlohmann::json from_stl = camera_of("a.stl", test::binary_stl_of(test::cube()));
  EXPECT_EQ(camera_of("a.3mf", test::three_mf_of(test::cube())), from_stl);
  EXPECT_NE(camera_of("a.obj", test::obj_of(test::cube())), from_stl);
}

// From below, the plane would hide the model. Triangles without area are not drawn and do not count.
TEST_F(ViewCommand, ShowsModelFromEverywhere) {
  const auto scene_of = [&](const std::string& more) {
    return nlohmann::json::parse(run("view " + more + " --print-scene").out);
  };
  const std::string cube = write("c.obj", test::obj_of(test::cube()));
  EXPECT_EQ(scene_of(cube + " --ground shadow").at("objects").size(), 2u);
  EXPECT_EQ(scene_of(cube + " --ground shadow --from bottom").at("objects").size(), 1u);
  EXPECT_EQ(scene_of(cube + " --ground grid --from=30,-20").at("objects").size(), 1u);
  const std::string stray = write("d.obj", test::obj_of(test::cube()) + "v 100 100 100\nf 9 9 9\n");
  EXPECT_EQ(scene_of(stray).at("camera"), scene_of(cube).at("camera"));
}

}  // namespace
}  // namespace orrery
