#pragma once

#include <string>
#include <string_view>

#include "core/study/study.h"

namespace orrery {

class Params;

// Reads the keys samples, rounds and width.
void read_extent(Params& p, Study::Extent& extent);

// Output format of a chart.
struct ChartForm {
  std::string_view ending, type;                                  // ".svg", "image/svg+xml"
  std::string (*write)(const Chart&, const std::string& prefix);  // links start with `prefix`
};
// Returns the format for the extension of a file name, or null if it is unknown.
const ChartForm* chart_form_of(std::string_view name);

// Returns the plan of a chart's point as command-line flags, without its seed: "--max-depth 3 --samples 16".
std::string flags_of_plan(const std::string& plan);

}  // namespace orrery
