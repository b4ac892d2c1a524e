#include "server/app/chart_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/params/params.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

ordered_json configuration_json(const Configuration& configuration) {
  return {{"technique", configuration.technique},
          {"max_depth", configuration.max_depth},
          {"precision", precision_name(configuration.double_precision)},
          {"samples", configuration.samples}};
}

ordered_json point_json(const Point& point, double cheapest_ms) {
  const auto mean = [&](double Difference::*value) {
    return point.mean([&](const Measurement& s) { return s.difference.*value; });
  };
  ordered_json json = configuration_json(point.configuration);
  json["accelerator"] = point.accelerator;
  json["cpu_ms"] = point.cpu_ms();
  json["times_cheapest"] = point.cpu_ms() / cheapest_ms;
  json["rays"] = point.rays();
  json["rmse"] = point.rmse();
  json["rmse_sd"] = point.rmse_sd();
  json["relative_mse"] = mean(&Difference::relative_mse);
  json["mean_absolute"] = mean(&Difference::mean_absolute);
  json["largest"] = mean(&Difference::largest);
  json["bias"] = mean(&Difference::bias);
  const double psnr_db = point.psnr_db();
  json["psnr_db"] = std::isfinite(psnr_db) ? ordered_json(psnr_db) : ordered_json();
  json["non_finite"] = point.mean([](const Measurement& s) { return double(s.difference.non_finite); });
  json["on_front"] = point.on_front;
  return json;
}

ordered_json points_json(const Chart& chart) {
  ordered_json points = ordered_json::array();
  const double cheapest_ms = chart.cheapest_ms();
  for (const Point& point : chart.points) points.push_back(point_json(point, cheapest_ms));
  return points;
}

// A line of names, then one for each point; nothing between the commas for null. RFC 4180.
std::string csv_of(const Chart& chart) {
  const ordered_json points = points_json(chart);
  std::string text;
  const auto add_line = [&](const auto& text_of) {
    for (const auto& member : points.front().items()) text += text_of(member.key()) + ",";
    text.replace(text.size() - 1, 1, "\r\n");
  };
  add_line([](const std::string& name) { return name; });
  for (const ordered_json& point : points)
    add_line([&](const std::string& name) {
      const ordered_json& value = point.at(name);
      if (value.is_null()) return std::string();
      return value.is_string() ? value.get<std::string>() : value.dump();
    });
  return text;
}

std::string json_of(const Chart& chart) {
  ordered_json reference = configuration_json(chart.reference);
  reference["cpu_ms"] = chart.reference_cpu_ms;
  reference["rmse"] = chart.reference_rmse;
  const ordered_json json = {{"scene", {{"id", chart.scene_id}, {"title", chart.title}}},
                             {"image", {{"width", chart.width}, {"height", chart.height}}},
                             {"rounds", chart.points.front().rounds.size()},
                             {"reference", std::move(reference)},
                             {"cheapest_ms", chart.cheapest_ms()},
                             {"points", points_json(chart)}};
  return json.dump(2) + "\n";
}

constexpr std::array kForms{ChartForm{".svg", "image/svg+xml", svg_of},
                            ChartForm{".csv", "text/csv; charset=utf-8", csv_of},
                            ChartForm{".json", "application/json", json_of}};

}  // namespace

void read_extent(Params& p, Study::Extent& extent) {
  extent.samples =
      static_cast<int>(p.integer("samples", "Of the highest configuration: 1, 4, 16, ... up to it.", 1,
                                 kMostChartSamples, extent.samples));
  extent.rounds = static_cast<int>(p.integer(
      "rounds", "Pictures of each configuration, with different seeds.", 1, kMostChartRounds, extent.rounds));
}

const ChartForm* chart_form_of(std::string_view name) {
  const auto found = std::find_if(kForms.begin(), kForms.end(),
                                  [&](const ChartForm& f) { return name.ends_with(f.ending); });
  return found == kForms.end() ? nullptr : &*found;
}

}  // namespace orrery
