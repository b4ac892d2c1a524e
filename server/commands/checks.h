#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/number.h"
#include "core/params/params.h"

// Validators of option values. Their error messages match those of the scene reader. CLI::Range would accept
// NaN.
namespace orrery {

inline CLI::Validator integer_from(std::int64_t min, std::int64_t max) {
  return CLI::Validator(
      [min, max](const std::string& text) {
        const auto number = parse_number<std::int64_t>(text);
        if (number && *number >= min && *number <= max) return std::string();
        return "must be an integer from " + std::to_string(min) + " to " + std::to_string(max) + " (got " +
               text.substr(0, 40) + ")";
      },
      "");
}

inline CLI::Validator number_from(double min, double max) {
  return CLI::Validator(
      [min, max](const std::string& text) {
        const auto number = parse_number<double>(text);
        if (number && *number >= min && *number <= max) return std::string();
        return "must be a number from " + number_text(min) + " to " + number_text(max) + " (got " +
               text.substr(0, 40) + ")";
      },
      "");
}

}  // namespace orrery
