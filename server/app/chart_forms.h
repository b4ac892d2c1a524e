#pragma once

#include <string>
#include <string_view>

#include "core/study/study.h"

namespace orrery {

class Params;

// Reads {samples, rounds}.
void read_extent(Params& p, Study::Extent& extent);

// What a chart can be had as.
struct ChartForm {
  std::string_view ending, type;  // ".svg", "image/svg+xml"
  std::string (*write)(const Chart&);
};
// The form that a file's name ends in; null if it is none of them.
const ChartForm* chart_form_of(std::string_view name);

}  // namespace orrery
