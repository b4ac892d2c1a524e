#include "core/stability/speed.h"

#include <algorithm>
#include <cmath>

#include "core/accelerators/registry.h"
#include "core/base/clock.h"
#include "core/load/load.h"
#include "core/shapes/triangle_hit.h"
#include "core/stability/ball_mesh.h"
#include "core/stability/moller_trumbore.h"
#include "core/stability/pictures.h"
#include "core/stability/registry.h"
#include "core/stability/report.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

// Method to measure. run() returns the CPU time of one run, in milliseconds.
struct TimedMethod {
  std::string name;
  std::function<double()> run;
  std::string error;
};
struct MethodComparison {
  std::string name;
  std::vector<TimedMethod> contenders;
};

// Returns a scene with 512 balls of glass over a floor. `fresnel` is the key of the glass material.
std::shared_ptr<const Scene> balls(const char* fresnel) {
  std::string objects =
      R"({"type": "rectangle", "corner": [-6, -4.5, -6], "edge_u": [0, 0, 12], "edge_v": [12, 0, 0], "material": "floor"})";
  for (int i = 0; i < 512; ++i)
    objects += printed(R"(,{"type": "sphere", "center": [%d, %d, %d], "radius": 0.4, "material": "glass"})",
                       i % 8 - 4, i / 8 % 8 - 4, i / 64 - 4);
  return load_scene(printed(R"({"version": 1, "ambient": [0.3, 0.3, 0.3], "background": [0.4, 0.6, 0.9],
      "camera": {"type": "perspective", "eye": [4, 6, 14], "look_at": [0, 0, 0]},
      "lights": [{"type": "directional", "direction_to_light": [1, 2, 1]}],
      "materials": {"floor": {"type": "rough"}, "glass": {"type": "refractive", "ior": 1.5, "fresnel": "%s"}},
      "objects": [)",
                            fresnel) +
                    objects + "]}");
}

RenderRequest picture_of(Precision precision) {
  RenderRequest request;
  request.width = request.height = 160;
  request.technique = "whitted";
  request.precision = precision;
  request.accelerator = "bvh";
  return request;
}

double rms_difference(const std::shared_ptr<const Scene>& a, const RenderRequest& request,
                      const std::shared_ptr<const Scene>& b, const RenderRequest& other) {
  const std::vector<float> x = values_of(rendered(a, request).film), y = values_of(rendered(b, other).film);
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) squares += std::pow(double{x[i]} - double{y[i]}, 2);
  return std::sqrt(squares / static_cast<double>(x.size()));
}

std::function<double()> tracing(const std::shared_ptr<const Scene>& scene, const RenderRequest& request) {
  return [scene, request] { return rendered(scene, request).stats.cpu_ms; };
}

MethodComparison number_types() {
  const auto scene = balls("exact");
  const RenderRequest in_double = picture_of(Precision::double_precision),
                      in_float = picture_of(Precision::single_precision);
  return {"Number type",
          {{"double", tracing(scene, in_double), "reference"},
           {"float", tracing(scene, in_float),
            "RMS " + figure_text(rms_difference(scene, in_float, scene, in_double), "radiance")}}};
}

MethodComparison reflectances() {
  const auto exact = balls("exact"), schlick = balls("schlick");
  const RenderRequest request = picture_of(Precision::double_precision);
  return {"Reflectance of glass",
          {{"Fresnel", tracing(exact, request), "reference"},
           {"Schlick", tracing(schlick, request),
            "RMS " + figure_text(rms_difference(schlick, request, exact, request), "radiance")}}};
}

// Returns a TimedMethod::run that calls distance(ray, a, b, c) for 200 rays and every triangle of a ball
// mesh.
template <class Distance>
std::function<double()> testing(const Distance& distance) {
  return [distance] {
    static const BallMesh mesh(2, Vec3d());
    SplitMix random(7);
    std::vector<Ray<double>> rays;
    for (int vertex = 0; vertex < 200; ++vertex)
      rays.push_back(mesh.ray_at<double>(vertex, mesh.around(vertex), Vec3d(), random));
    const double begin = thread_cpu_ms();
    double sum = 0;
    for (const Ray<double>& ray : rays)
      for (const auto& corners : mesh.triangles) {
        const auto at = [&](std::size_t i) { return mesh.positions[static_cast<std::size_t>(corners[i])]; };
        sum += 1 / distance(ray, at(0), at(1), at(2));
      }
    return sum > 0 ? thread_cpu_ms() - begin : 0;
  };
}

MethodComparison triangles() {
  const auto figures = stability_row("A12").measure();
  return {"Ray-triangle test, single rays",
          {{"Moeller-Trumbore",
            testing([](const Ray<double>& ray, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
              return moller_trumbore(ray, a, b, c, 0.0);
            }),
            "leaks " + figure_text(figures.known, "%")},
           {"watertight", testing([](const Ray<double>& ray, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
              return Corners<double>{a, b, c}.distance(ray);
            }),
            "leaks " + figure_text(figures.ours, "%")}}};
}

MethodComparison structures() {
  const auto scene = balls("exact");
  RenderRequest list = picture_of(Precision::double_precision);
  list.accelerator = "list";
  MethodComparison contest{"Structure, 513 objects", {{"list", tracing(scene, list), "reference"}}};
  for (const AcceleratorType& type : accelerator_types()) {
    if (type.name == std::string_view("list")) continue;
    RenderRequest request = list;
    request.accelerator = type.name;
    contest.contenders.push_back(
        {type.name, tracing(scene, request),
         "RMS " + figure_text(rms_difference(scene, request, scene, list), "radiance")});
  }
  return contest;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

std::vector<SpeedGroup> measure_speed(int rounds, const std::function<void(int done, int all)>& progress) {
  const std::vector<MethodComparison> contests{number_types(), reflectances(), triangles(), structures()};
  std::vector<SpeedGroup> groups;
  int done = 0;
  for (const auto& [name, contenders] : contests) {
    std::vector<std::vector<double>> ratios(contenders.size());
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> ms(contenders.size());
      for (std::size_t i = 0; i < ms.size(); ++i) {
        const std::size_t turn = round % 2 == 0 ? i : ms.size() - 1 - i;
        ms[turn] = contenders[turn].run();
      }
      for (std::size_t i = 0; i < ms.size(); ++i) ratios[i].push_back(ms[i] / ms[0]);
      progress(++done, rounds * static_cast<int>(contests.size()));
    }
    SpeedGroup& group = groups.emplace_back(SpeedGroup{name, {}});
    for (std::size_t i = 0; i < ratios.size(); ++i)
      group.methods.push_back({contenders[i].name, median(ratios[i]), contenders[i].error});
  }
  return groups;
}

std::string speed_text(const std::vector<SpeedGroup>& groups) {
  std::string text;
  for (const SpeedGroup& group : groups) {
    text += group.name + "\n";
    for (const auto& [name, time, error] : group.methods)
      text += printed("  %-18s %6.2f  %s\n", name.c_str(), time, error.c_str());
  }
  return text;
}

std::string svg_of(const std::vector<SpeedGroup>& groups) {
  constexpr double kWidth = 760, kLeft = 170, kRight = 520, kRow = 20, kTop = 62;
  double most = 1, rows = 0;
  for (const SpeedGroup& group : groups) {
    rows += static_cast<double>(group.methods.size()) + 1.5;
    for (const auto& method : group.methods) most = std::max(most, method.time);
  }
  std::string text = svg_begin(kWidth, kTop + rows * kRow, "Speed and accuracy");
  text += svg_text(20, 28, "Speed and accuracy", "font-size=\"15\" font-weight=\"bold\"");
  text += svg_text(20, 46,
                   "CPU time relative to the first method of the group, and error; measured on one machine",
                   "font-size=\"11\"");
  double y = kTop;
  const Axis axis{0, most, kLeft, kRight, false};
  for (const SpeedGroup& group : groups) {
    text += svg_text(20, y + 14, group.name, "font-weight=\"bold\"");
    y += kRow;
    for (std::size_t i = 0; i < group.methods.size(); ++i, y += kRow) {
      const auto& [name, time, error] = group.methods[i];
      text += svg_text(kLeft - 8, y + 14, name, "text-anchor=\"end\"") +
              printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"14\" fill=\"%s\"/>\n", kLeft,
                      y + 3, axis.place(time) - kLeft, line_color(i == 0 ? 0 : 1)) +
              svg_text(axis.place(time) + 8, y + 14, printed("%.2f; %s", time, error.c_str()),
                       "font-size=\"11\"");
    }
    y += kRow / 2;
  }
  return text + "</svg>\n";
}

}  // namespace orrery
