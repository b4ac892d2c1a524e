// Renders a scene with the core library: render SCENE.json OUTPUT.png
#include <fstream>
#include <iostream>

#include "core/budget/renderer.h"
#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "core/render/views.h"

int main(int argc, char** argv) try {
  using namespace orrery;
  if (argc != 3) throw Error("usage: render SCENE.json OUTPUT.png");
  const PreparedScene scene(load_scene_file(argv[1]));
  RenderRequest request;  // options that are not set come from the scene
  request.width = 640;
  request.height = 480;
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), request));
  ThreadExecutor executor;
  const RenderResult result = render_frame(scene, plan, FilmStorage::srgb8, executor);
  std::ofstream(argv[2], std::ios::binary) << encode_film(result.film, FileFormat::png);
  std::cout << result.stats.counts.rays.total() << " rays in " << result.stats.trace_ms << " ms\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
