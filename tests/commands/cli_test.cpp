#include <fcntl.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/commands/command_line.h"

// Tests the command line of the program.
namespace orrery {
namespace {

const std::string kScene =
    R"({"version": 1, "camera": {"type": "perspective", "eye": [0, 0, 4], "look_at": [0, 0, 0]},
 "image": {"width": 40, "height": 30}, "materials": {"m": {"type": "rough"}},
 "lights": [{"type": "directional", "direction_to_light": [1, 1, 1]}],
 "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}]})";

TEST_F(CommandLine, WritesFormatOfFileExtension) {
  const std::string scene = write("s.json", kScene);
  const std::pair<const char*, const char*> formats[] = {
      {"a.png", "\x89PNG"}, {"a.jpg", "\xFF\xD8\xFF"}, {"a.exr", "\x76\x2f\x31\x01"}};
  for (const auto& [name, magic] : formats) {
    EXPECT_EQ(run("render " + scene + " -o " + file(name)).status, 0);
    EXPECT_EQ(bytes_of(file(name)).rfind(magic, 0), 0u) << name;
  }
  EXPECT_EQ(run("render " + scene + " -o " + file("a.bmp")).status, 2);
  EXPECT_EQ(run("render " + scene + " -o " + file("nosuch/a.png")).status, 1);
}

TEST_F(CommandLine, ReportsRaysTimesAndOptionsInStats) {
  const Outcome result = run("render " + write("s.json", kScene) + " --stats=json --samples 4 --width 20");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto stats = nlohmann::json::parse(result.out);
  EXPECT_EQ(stats.at("rays").at("camera"), 20 * 30 * 4);
  EXPECT_EQ(stats.at("samples"), 4);
  EXPECT_EQ(run("render " + file("s.json") + " --stats=xml").status, 2);
  for (const char* name : {"structure_bytes", "structure_depth", "node_visits", "box_tests"})
    EXPECT_TRUE(stats.at(name).is_number_unsigned() || stats.at(name).is_number_integer()) << name;
  for (const char* name : {"load_ms", "build_ms", "trace_ms", "mrays_per_s", "cpu_s"})
    EXPECT_GE(stats.at(name), 0.0) << name;
  for (const char* option : {"max_depth", "azimuth_degrees", "pan", "technique"})
    EXPECT_TRUE(stats.contains(option)) << option;
}

TEST_F(CommandLine, AcceptsJsonNamesAsOptions) {
  const std::string explain = "explain --json " + write("s.json", kScene);
  const std::string parameter_name =
      run(explain + " --azimuth-degrees 30 --elevation-degrees 5 --fov-degrees 40 --max-depth 2").out;
  ASSERT_TRUE(nlohmann::json::accept(parameter_name));
  EXPECT_EQ(run(explain + " --azimuth 30 --elevation 5 --fov 40 --depth 2").out, parameter_name);
  EXPECT_EQ(nlohmann::json::parse(parameter_name).at("request").at("camera").at("azimuth_degrees"), 30);
}

TEST_F(CommandLine, ReproducesImageFromPrintedPlan) {
  const std::string render = "render " + write("s.json", kScene) + " -o ";
  ASSERT_EQ(run(render + file("a.png") + " --error 0.2 --azimuth 30 --certificate " + file("c.json")).status,
            0);
  const std::string plan = nlohmann::json::parse(bytes_of(file("c.json"))).at("plan");
  ASSERT_NE(plan.find("samples="), std::string::npos) << plan;
  EXPECT_EQ(run(render + file("b.png") + " --plan '" + plan + "'").status, 0);
  EXPECT_EQ(bytes_of(file("a.png")), bytes_of(file("b.png")));
  const std::string address = " --plan '/v1/scenes/0/frame.png?azimuth=40&samples=4&pan=0,0.5,0'";
  EXPECT_EQ(run(render + file("c.png") + address).status, 0);
  EXPECT_EQ(run(render + file("d.png") + " --azimuth 40 --samples 4 --pan 0,0.5,0").status, 0);
  EXPECT_EQ(bytes_of(file("c.png")), bytes_of(file("d.png")));
  EXPECT_EQ(run(render + file("e.png") + address + " --azimuth-degrees 50").status, 0);
  EXPECT_EQ(run(render + file("f.png") + " --azimuth 50 --samples 4 --pan 0,0.5,0").status, 0);
  EXPECT_EQ(bytes_of(file("e.png")), bytes_of(file("f.png"))) << "flags override the plan";
  EXPECT_EQ(run("explain " + file("s.json") + " --plan /v1/scenes/0/frame.png").status, 0)
      << "a plan may be empty";
  const std::pair<const char*, const char*> wrong[] = {
      {"samples=0", "--plan samples: must be an integer from 1 to "},
      {"sampels=4", "--plan sampels: unknown query parameter \"sampels\" (did you mean \"samples\"?)"},
      {"azimuth=1&azimuth_degrees=2", "--plan azimuth_degrees: cannot be used with \"azimuth\""},
      {"samples=1&samples=2", "--plan: duplicate query parameter \"samples\""},
      {"samples=%zz", "--plan: "}};
  for (const auto& [given, said] : wrong) {
    const Outcome refused = run(render + file("g.png") + " --plan '" + given + "'");
    EXPECT_EQ(refused.status, 2) << given;
    EXPECT_NE(refused.err.find(said), std::string::npos) << refused.err;
  }
}

TEST_F(CommandLine, ReadsSceneFromStandardInput) {
  const std::string scene = write("s.json", kScene);
  EXPECT_EQ(run("render - -o " + file("a.png") + " <" + scene).status, 0);
  EXPECT_EQ(run("render " + scene + " -o " + file("b.png")).status, 0);
  EXPECT_EQ(bytes_of(file("a.png")), bytes_of(file("b.png")));
}

TEST_F(CommandLine, CheckReportsFileAndPointerOfProblems) {
  const std::string good = write("good.json", kScene);
  std::string text = kScene;
  text.replace(text.find("\"radius\": 1"), 11, "\"radius\": -1");
  const std::string bad = write("bad.json", text);
  EXPECT_EQ(run("check " + good).status, 0);
  const Outcome result = run("check " + good + " " + bad);
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out.rfind(bad + ": /objects/0/radius: must be ", 0), 0u) << result.out;
  const std::string none = file("none.json");
  const Outcome with_none = run("check " + none + " " + bad);
  EXPECT_EQ(with_none.status, 1);
  EXPECT_EQ(with_none.err, "orrery: cannot read " + none + ": No such file or directory\n");
  EXPECT_EQ(with_none.out, result.out);
  const auto problems = nlohmann::json::parse(run("check --json " + good + " " + bad).out);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].at("file"), bad);
  EXPECT_EQ(problems[0].at("pointer"), "/objects/0/radius");
  EXPECT_EQ(problems[0].at("severity"), "error");
}

TEST_F(CommandLine, WarnsAboutCameraInsideOpaqueShape) {
  std::string text = kScene;
  text.replace(text.find("[0, 0, 4]"), 9, "[0, 0, 0.5]");
  const std::string inside = write("inside.json", text), said = "camera is inside an opaque shape";
  const Outcome checked = run("check " + inside);
  EXPECT_EQ(checked.status, 0);
  EXPECT_EQ(checked.out.rfind(inside + ": /camera/eye: warning: " + said, 0), 0u) << checked.out;
  const auto problems = nlohmann::json::parse(run("check --json " + inside).out);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].at("severity"), "warning");
  const Outcome rendered = run("render " + inside + " -o " + file("a.png"));
  EXPECT_EQ(rendered.status, 0);
  EXPECT_NE(rendered.err.find("orrery: warning: /camera/eye: " + said), std::string::npos) << rendered.err;
  EXPECT_NE(run("explain " + inside).out.find("warning: /camera/eye: " + said), std::string::npos);
  EXPECT_EQ(run("render " + write("s.json", kScene) + " -o " + file("a.png")).err, "");
  text.replace(text.find(R"("rough")"), 7, R"("rough", "emission": [1, 1, 1])");
  EXPECT_EQ(run("check " + write("lamp.json", text)).out.find("warning"), std::string::npos);
}

TEST_F(CommandLine, RejectsLayersForFormatsWithoutLayers) {
  const std::string scene = write("s.json", kScene);
  EXPECT_EQ(run("render " + scene + " --layers depth -o " + file("a.exr")).status, 0);
  const Outcome png = run("render " + scene + " --layers depth -o " + file("a.png"));
  EXPECT_EQ(png.status, 2);
  EXPECT_NE(png.err.find("--layers: cannot be used with PNG (only EXR stores layers); use EXR"),
            std::string::npos)
      << png.err;
  EXPECT_EQ(run("orbit " + scene + " --frames 2 --layers depth -o " + file("a-%d.png")).status, 2);
}

TEST_F(CommandLine, NamesInvalidOptionAndSuggestsCorrection) {
  const std::string scene = write("s.json", kScene);
  const Outcome number = run("render " + scene + " --azimuth x --width 5000");
  EXPECT_EQ(number.status, 2);
  EXPECT_NE(number.err.find("--azimuth: must be a number"), std::string::npos) << number.err;
  EXPECT_NE(number.err.find("--width: "), std::string::npos) << number.err;
  const Outcome word = run("render " + scene + " --technique witted");
  EXPECT_NE(word.err.find("did you mean \"whitted\""), std::string::npos) << word.err;
  const Outcome command = run("redner " + scene);
  EXPECT_EQ(command.status, 2);
  EXPECT_NE(command.err.find("unknown command \"redner\" (did you mean render?)"), std::string::npos)
      << command.err;
  const Outcome slip = run("render " + scene + " --widht 5 --samples=2");
  EXPECT_EQ(slip.status, 2);
  EXPECT_EQ(slip.err, "orrery: unknown option --widht (did you mean --width?); see orrery render --help\n");
  EXPECT_EQ(run("check " + scene + " --quiet=1").err,
            "orrery: unknown option --quiet; see orrery check --help\n");
  EXPECT_NE(run("schema more").err.find("unknown argument \"more\";"), std::string::npos);
  const Outcome flag = run("render " + scene + " --reorder maybe");
  EXPECT_NE(flag.err.find("--reorder: must be true or false"), std::string::npos) << flag.err;
  EXPECT_EQ(run("render " + scene + " --reorder true").status, 0);
  EXPECT_EQ(run("render nosuch.json").status, 1);
  EXPECT_EQ(run("render").status, 2);
  EXPECT_EQ(run("render " + scene + " -o ''").status, 2);
  EXPECT_NE(run("render " + scene + " --spp 4").err.find("unknown option --spp (did you mean --samples?)"),
            std::string::npos);
  const Outcome slice = run("render " + scene + " --slice 0");
  EXPECT_NE(slice.err.find("--slice: must be an integer from 16 to 1024 (got 0)"), std::string::npos)
      << slice.err;
  const Outcome limit = run("serve --connections 0");
  EXPECT_NE(limit.err.find("--connections: must be an integer from 1 to 10000 (got 0)"), std::string::npos)
      << limit.err;
}

TEST_F(CommandLine, RejectsIntegersBeyondExactRange) {
  const std::string scene = write("s.json", kScene);
  EXPECT_EQ(run("render " + scene + " --seed 9007199254740992").status, 0);
  const Outcome beyond = run("render " + scene + " --seed 9007199254740993");
  EXPECT_EQ(beyond.status, 2);
  EXPECT_NE(beyond.err.find("--seed: must be an integer from 0 to 9007199254740992 (got 9007199254740993)"),
            std::string::npos)
      << beyond.err;
}

TEST_F(CommandLine, RejectsFoldersAndEndlessFiles) {
  const Outcome folder = run("render " + folder_.string());
  EXPECT_EQ(folder.status, 1);
  EXPECT_EQ(folder.err, "orrery: cannot read " + folder_.string() + ": Is a directory\n");
  const Outcome endless = run("check /dev/zero");
  EXPECT_EQ(endless.status, 1);
  EXPECT_NE(endless.err.find("file has more than 1,073,741,824 bytes"), std::string::npos) << endless.err;
}

TEST_F(CommandLine, PrintsHelpForEveryCommand) {
  EXPECT_EQ(run("--help").status, 0);
  for (const char* command : {"serve", "render", "orbit", "check", "explain", "chart", "stability"}) {
    const Outcome help = run(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Examples:"), std::string::npos) << command;
  }
}

TEST_F(CommandLine, WritesStabilityAsTextJsonAndDocs) {
  const Outcome text = run("stability"), json = run("stability --json");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.out.rfind("A1 ", 0), 0u) << text.out;
  const auto rows = nlohmann::json::parse(json.out).at("rows");
  const std::string count = std::to_string(rows.size());
  EXPECT_NE(text.out.find(count + " of " + count + " rows are within their bounds\n"), std::string::npos)
      << text.out;
  fs::create_directory(folder_ / "pictures");
  EXPECT_EQ(run("stability --docs " + folder_.string()).status, 0);
  EXPECT_NE(bytes_of(file("stability.md")).find("(pictures/stability-far-sphere.svg)"), std::string::npos);
  EXPECT_EQ(bytes_of(folder_ / "pictures/stability-far-sphere.svg").rfind("<svg ", 0), 0u);
  for (const char* wrong :
       {"--json --docs .", "--svg a.svg", "--rounds 9", "--speed --json", "--speed --rounds 6"})
    EXPECT_EQ(run(std::string("stability ") + wrong).status, 2) << wrong;
  EXPECT_EQ(run("stability --docs " + file("none")).status, 1);
}

// Browsers do not play the pixel format that ffmpeg would choose (4:4:4). The format yuv420p requires even
// width and height.
TEST_F(CommandLine, SuggestsBrowserPlayableVideoInOrbitHelp) {
  const std::string help = run("orbit --help").out;
  EXPECT_NE(help.find("-pix_fmt yuv420p orbit.mp4"), std::string::npos) << help;
  EXPECT_NE(help.find("pad=ceil(iw/2)*2:ceil(ih/2)*2"), std::string::npos) << help;
}

TEST_F(CommandLine, PrintsSchemaCatalogAndExplanationAsJson) {
  EXPECT_TRUE(nlohmann::json::accept(run("schema").out));
  EXPECT_EQ(nlohmann::json::parse(run("openapi").out).at("openapi"), "3.1.0");
  EXPECT_TRUE(nlohmann::json::parse(run("catalog").out).contains("shapes"));
  const std::string scene = write("s.json", kScene);
  EXPECT_FALSE(nlohmann::json::parse(run("explain --json " + scene).out).at("decisions").empty());
  EXPECT_NE(run("explain " + scene).out.find("shadows"), std::string::npos);
  EXPECT_EQ(run("explain " + scene).out.find("forecast"), std::string::npos);
  EXPECT_NE(run("explain --measure --error 0.05 " + scene).out.find("forecast: about "), std::string::npos);
}

TEST_F(CommandLine, WritesChartFormatOfFileExtension) {
  const std::string few = "chart " + write("s.json", kScene) + " --chart-samples 4 --rounds 1 -o ";
  for (const char* name : {"c.svg", "c.csv", "c.json"}) EXPECT_EQ(run(few + file(name)).status, 0) << name;
  EXPECT_EQ(nlohmann::json::parse(bytes_of(file("c.json"))).at("points").size(), 4U);
  const Outcome wrong = run(few + file("c.png"));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--output"), std::string::npos) << wrong.err;
  EXPECT_NE(run(few + file("c.svg") + " --samples 4").err.find("--samples"), std::string::npos);
  EXPECT_EQ(run(few + file("c.svg") + " --rounds 99").status, 2);
  EXPECT_EQ(run(few + file("nowhere/c.svg")).status, 1);
  EXPECT_EQ(run(few + file("C.SVG")).status, 0);
}

TEST_F(CommandLine, PrintsChartFlagsAndWritesFrontImages) {
  const std::string scene = write("s.json", kScene);
  const Outcome told = run("chart " + scene + " --chart-samples 4 --chart-width 24 --rounds 2 -o " +
                           file("c.json") + " --pictures " + file("pictures"));
  ASSERT_EQ(told.status, 0) << told.err;
  const auto chart = nlohmann::json::parse(bytes_of(file("c.json")));
  std::size_t pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(file("pictures")))
    pictures += entry.path().extension() == ".png";
  EXPECT_EQ(pictures, chart.at("front").size());
  EXPECT_NE(told.out.find("error < "), std::string::npos) << told.out;
  for (const auto& each : chart.at("recommendations")) {
    const std::string flags = each.at("flags");
    EXPECT_NE(told.out.find(flags), std::string::npos) << told.out;
    EXPECT_EQ(run("render " + scene + " -o " + file("again.png") + " " + flags).status, 0) << flags;
  }
  EXPECT_EQ(run("chart " + scene + " -o " + file("c.json") + " --pictures " + file("c.json/in")).status, 1);
}

TEST_F(CommandLine, WritesNumberedOrbitFrames) {
  const std::string scene = write("s.json", kScene);
  ASSERT_EQ(run("orbit " + scene + " --frames 3 --step 90 -o " + file("f-%03d.png")).status, 0);
  for (const char* name : {"f-000.png", "f-001.png", "f-002.png"})
    EXPECT_TRUE(fs::exists(file(name))) << name;
  EXPECT_FALSE(fs::exists(file("f-003.png")));
  const auto stats = nlohmann::json::parse(run("orbit " + scene + " --frames 5 --discard --stats=json").out);
  EXPECT_EQ(stats.at("frames"), 5);
  for (const char* pattern : {"plain.png", "%d-%d.png", "%s.png", "%5d.png"})
    EXPECT_EQ(run("orbit " + scene + " --frames 1 -o " + file(pattern)).status, 2) << pattern;
}

TEST_F(CommandLine, AppliesBudgetToOrbit) {
  const std::string orbit = "orbit " + write("s.json", kScene) + " --frames 3 --discard --stats=json ";
  const auto budget = nlohmann::json::parse(run(orbit + "--error 0.2").out).at("budget");
  EXPECT_EQ(budget.at("frames_met"), 3);
  EXPECT_LE(budget.at("largest_bound"), 0.2);
  const auto late = nlohmann::json::parse(run(orbit + "--error 0.5 --seconds 0.000001").out).at("budget");
  EXPECT_EQ(late.at("met"), false);
  EXPECT_EQ(late.at("frames_met"), 3) << "the error budget is met";
  const auto in_time = nlohmann::json::parse(run(orbit + "--seconds 60 --samples 2").out).at("budget");
  EXPECT_EQ(in_time.at("met"), true);
  EXPECT_EQ(in_time.at("frames_met"), nullptr);
  const Outcome missed = run(orbit + "--error 0.0001 --samples 2");
  EXPECT_EQ(missed.status, 0);
  EXPECT_NE(missed.err.find("budget missed: met by 0 of 3 frames"), std::string::npos) << missed.err;
  EXPECT_EQ(run(orbit + "--error 0.0001 --samples 2 --on-miss fail").status, 3);
}

TEST_F(CommandLine, RejectsErrorBudgetForJpeg) {
  const std::string scene = write("s.json", kScene);
  for (const std::string command : {"render ", "orbit --frames 2 "}) {
    const Outcome jpeg = run(command + scene + " --error 0.1 -o " + file("a-%d.jpg"));
    EXPECT_EQ(jpeg.status, 2) << command;
    EXPECT_NE(jpeg.err.find("--error: cannot be used with JPEG"), std::string::npos) << jpeg.err;
  }
}

TEST_F(CommandLine, WritesThroughSymbolicLinks) {
  fs::create_directory(folder_ / "far");
  write("far/a.png", "an older picture");
  fs::create_symlink(folder_ / "far" / "a.png", folder_ / "link.png");
  EXPECT_EQ(run("render " + write("s.json", kScene) + " -o " + file("link.png")).status, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
  EXPECT_EQ(bytes_of(folder_ / "far" / "a.png").rfind("\x89PNG", 0), 0u);
}

TEST_F(CommandLine, RejectsCertificateAtPathOfImage) {
  const std::string render = "render " + write("s.json", kScene) + " -o " + file("a.png") + " --certificate ";
  EXPECT_EQ(run(render + (folder_ / "." / "a.png").string()).status, 2);
  const Outcome bound = run("render " + file("s.json") + " --view bound --error 0.1");
  EXPECT_EQ(bound.status, 2);
  EXPECT_NE(bound.err.find("--view: must be \"picture\""), std::string::npos) << bound.err;
}

TEST_F(CommandLine, PlaysMotionInOrbit) {
  auto moving = nlohmann::json::parse(kScene);
  moving["models"]["ball"]["objects"] = moving["objects"];
  moving["instances"] = {
      {{"model", "ball"}, {"motion", {{{"time", 0}}, {{"time", 2}, {"translate", {1, 0, 1}}}}}}};
  const std::string scene = write("s.json", moving.dump());
  ASSERT_EQ(run("orbit " + scene + " --frames 4 --step 0 -o " + file("f-%d.png")).status, 0);
  ASSERT_EQ(
      run("orbit " + scene + " --frames 2 --step 0 --time 0.5 --time-step 1 -o " + file("g-%d.png")).status,
      0);
  EXPECT_EQ(bytes_of(file("f-1.png")), bytes_of(file("g-0.png")));
  EXPECT_EQ(bytes_of(file("f-3.png")), bytes_of(file("g-1.png")));
  EXPECT_NE(bytes_of(file("f-0.png")), bytes_of(file("f-1.png")));
  const auto stats = nlohmann::json::parse(
      run("orbit " + scene + " --frames 5 --accelerator bvh --discard --stats=json").out);
  EXPECT_EQ(stats.at("refitted"), 4);
  for (const char* wrong :
       {"--time-step 4000", "--time-step nan", "--step nan", "--step inf", "--step 361"}) {
    const Outcome outcome = run("orbit " + scene + " --discard " + wrong);
    EXPECT_EQ(outcome.status, 2) << wrong;
    EXPECT_NE(outcome.err.find(std::string(wrong, 6)), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run("render " + scene + " --time 1e7").status, 2);
  EXPECT_NE(run("explain " + scene + " --time 0.5").out.find("0.5 s"), std::string::npos);
}

TEST_F(CommandLine, LeavesNoFileAfterInterrupt) {
  const std::string scene = write("s.json", kScene), picture = file("never.png");
  const std::string self = program();
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDERR_FILENO);
    execl(self.c_str(), self.c_str(), "render", scene.c_str(), "-o", picture.c_str(), "--width", "4096",
          "--height", "4096", "--samples", "4096", nullptr);
    _exit(127);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().filename().string().find("never"), std::string::npos) << entry.path();
}

TEST_F(CommandLine, ReadsMeshesOnlyFromSceneFolder) {
  const std::string mesh = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
  const auto scene_with = [](const std::string& name) {
    auto scene = nlohmann::json::parse(kScene);
    scene["objects"] = {{{"type", "mesh"}, {"file", name}, {"material", "m"}}};
    return scene.dump();
  };
  fs::create_directories(folder_ / "scenes" / "meshes");
  write("scenes/meshes/one.obj", mesh);
  write("outside.obj", mesh);
  write("scenes/bad.obj", "v 0 0\n");
  fs::create_symlink(folder_ / "outside.obj", folder_ / "scenes" / "link.obj");
  const auto check = [&](const std::string& name) {
    return run("check " + write("scenes/scene.json", scene_with(name)));
  };
  EXPECT_EQ(check("meshes/one.obj").status, 0);
  for (const std::string& outside :
       {std::string("../outside.obj"), std::string("link.obj"), file("outside.obj")}) {
    const Outcome refused = check(outside);
    EXPECT_EQ(refused.status, 2) << outside;
    EXPECT_NE(refused.out.find("/objects/0/file: must be a file in the scene's folder"), std::string::npos)
        << refused.out;
  }
  EXPECT_NE(check("none.obj").out.find("/objects/0/file: cannot read"), std::string::npos);
  EXPECT_NE(check("meshes").out.find("not a regular file"), std::string::npos);
  EXPECT_NE(check("bad.obj").out.find("bad.obj: line 1"), std::string::npos) << check("bad.obj").out;
}

}  // namespace
}  // namespace orrery
