#include "server/api/chart_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/params/params.h"
#include "core/plan/limits.h"
#include "server/api/error_report.h"
#include "server/api/frame_path.h"
#include "server/config/flag_name.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

ordered_json configuration_json(const Configuration& configuration) {
  return {{"technique", configuration.technique},
          {"max_depth", configuration.max_depth},
          {"precision", precision_name(configuration.double_precision)},
          {"samples", configuration.samples}};
}

ordered_json size_json(const PictureSize& size) { return {{"width", size.width}, {"height", size.height}}; }

ordered_json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return {{"low", interval->low}, {"high", interval->high}};
}

// Returns the scalar values of a point, which are the columns of the CSV file.
ordered_json figures_json(const Point& point, double cheapest_ms) {
  const auto mean = [&](double Difference::*value) {
    return point.mean([&](const Measurement& s) { return s.difference.*value; });
  };
  ordered_json json = configuration_json(point.configuration);
  json["accelerator"] = point.accelerator;
  json["rounds"] = point.rounds.size();
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
  json["ssim"] = point.mean([](const Measurement& s) { return s.ssim; });
  json["non_finite"] = point.mean([](const Measurement& s) { return double(s.difference.non_finite); });
  json["on_front"] = point.on_front();
  json["undecided"] = point.pareto_status == ParetoStatus::undecided;
  json["plan"] = point.plan;
  return json;
}

// Returns the predicted seconds of the full-size image. `low` and `high` are null for a single round.
ordered_json full_size_json(const Chart& chart, const Point& point) {
  const auto interval = point.cpu_ms_interval();
  return {{"seconds", chart.full_seconds(point.cpu_ms())},
          {"low", interval ? ordered_json(chart.full_seconds(interval->low)) : ordered_json()},
          {"high", interval ? ordered_json(chart.full_seconds(interval->high)) : ordered_json()}};
}

ordered_json points_json(const Chart& chart, const std::string& prefix) {
  ordered_json points = ordered_json::array();
  const double cheapest_ms = chart.cheapest_ms();
  for (const Point& point : chart.points) {
    ordered_json json = figures_json(point, cheapest_ms);
    json["interval"] = point.rounds.size() < 2
                           ? ordered_json()
                           : ordered_json{{"rmse", interval_json(point.rmse_interval())},
                                          {"cpu_ms", interval_json(point.cpu_ms_interval())}};
    json["certificate"] = certificate_json(*point.certificate);
    json["picture"] = frame_path(prefix, chart.scene_id, point.picture_plan);
    json["full_size"] = full_size_json(chart, point);
    points.push_back(std::move(json));
  }
  return points;
}

ordered_json recommendations_json(const Chart& chart) {
  ordered_json all = ordered_json::array();
  for (const Recommendation& r : recommendations(chart)) {
    const Point& point = chart.points[r.point];
    all.push_back({{"error", r.error},
                   {"point", r.point},
                   {"flags", flags_of_plan(point.plan)},
                   {"full_size", full_size_json(chart, point)}});
  }
  return all;
}

// Returns the chart as CSV: a header line and a line for each point. A null value is an empty field. A plan
// with commas is quoted (RFC 4180).
std::string csv_of(const Chart& chart, const std::string&) {
  ordered_json points = ordered_json::array();
  for (const Point& point : chart.points) points.push_back(figures_json(point, chart.cheapest_ms()));
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
      if (!value.is_string()) return value.dump();
      const std::string word = value.get<std::string>();
      return word.find(',') == std::string::npos ? word : "\"" + word + "\"";
    });
  return text;
}

std::string json_of(const Chart& chart, const std::string& prefix) {
  ordered_json reference = configuration_json(chart.reference);
  reference["cpu_ms"] = chart.reference_cpu_ms;
  reference["rmse"] = chart.reference_rmse;
  reference["plan"] = chart.reference_plan;
  reference["picture"] = frame_path(prefix, chart.scene_id, chart.reference_picture_plan);
  const ordered_json json = {{"scene", {{"id", chart.scene_id}, {"title", chart.title}}},
                             {"image", size_json(chart.size)},
                             {"measured", size_json(chart.measured)},
                             {"threads", chart.threads},
                             {"rounds", chart.rounds},
                             {"reference", std::move(reference)},
                             {"noise_floor", chart.reference_rmse},
                             {"cheapest_ms", chart.cheapest_ms()},
                             {"front", chart.front()},
                             {"recommendations", recommendations_json(chart)},
                             {"points", points_json(chart, prefix)}};
  return json.dump(2) + "\n";
}

std::string drawing_of(const Chart& chart, const std::string&) { return svg_of(chart); }

constexpr std::array kForms{ChartForm{".svg", "image/svg+xml", drawing_of},
                            ChartForm{".csv", "text/csv; charset=utf-8", csv_of},
                            ChartForm{".json", "application/json", json_of}};

}  // namespace

void read_extent(Params& p, Study::Extent& extent) {
  extent.samples =
      static_cast<int>(p.integer("samples", "Maximum samples per pixel of the configurations 1, 4, 16, ...",
                                 1, kMaxChartSamples, extent.samples));
  extent.rounds = static_cast<int>(
      p.integer("rounds", "Maximum images per configuration, with different seeds; two if dominated.", 1,
                kMaxChartRounds, extent.rounds));
  extent.width = static_cast<int>(
      p.integer("width", "Width of the rendered images in pixels; default and maximum: that of the image.", 1,
                kMaxImageSide, derived(std::int64_t{0})));
}

std::string flags_of_plan(const std::string& plan) {
  std::string flags;
  for (std::size_t begin = 0, end; begin < plan.size(); begin = end + 1) {
    end = std::min(plan.find('&', begin), plan.size());
    const std::string pair = plan.substr(begin, end - begin);
    const std::size_t equals = pair.find('=');
    const std::string name = pair.substr(0, equals);
    if (name == "seed") continue;
    flags += (flags.empty() ? "" : " ") + flag_of(name) + " " + pair.substr(equals + 1);
  }
  return flags;
}

const ChartForm* chart_form_of(std::string_view name) {
  const auto found = std::find_if(kForms.begin(), kForms.end(),
                                  [&](const ChartForm& f) { return name.ends_with(f.ending); });
  return found == kForms.end() ? nullptr : &*found;
}

}  // namespace orrery
