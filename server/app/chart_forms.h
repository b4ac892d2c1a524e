#pragma once

#include <string>
#include <string_view>

#include "core/study/study.h"

namespace orrery {

class Params;

// Reads {samples, rounds, width}.
void read_extent(Params& p, Study::Extent& extent);

// What a chart can be had as.
struct ChartForm {
  std::string_view ending, type;                                  // ".svg", "image/svg+xml"
  std::string (*write)(const Chart&, const std::string& prefix);  // links in it stand below `prefix`
};
// The form that a file's name ends in; null if it is none of them.
const ChartForm* chart_form_of(std::string_view name);

// The flags that give a command line the plan of a chart's point, but for its seed: "--max-depth 3 --samples
// 16".
std::string flags_of_plan(const std::string& plan);

}  // namespace orrery
