#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/import/pbrt_scene.h"

namespace orrery {

// Graphics state of pbrt: the values that AttributeBegin saves.
struct PbrtState {
  Affined ctm = {};
  bool reversed = false;      // ReverseOrientation
  bool changes_start = true;  // whether transformations apply to the start of the motion
  std::shared_ptr<PbrtMaterial> material =
      std::make_shared<PbrtMaterial>(PbrtMaterial{.name = "diffuse", .type = "diffuse", .parameters = {}});
  std::shared_ptr<const PbrtParameters> area_light = {};
  // Parameters of the directive Attribute, by target.
  std::shared_ptr<const std::map<std::string, PbrtParameters>> defaults =
      std::make_shared<const std::map<std::string, PbrtParameters>>();
};

struct PbrtTransform {
  Affined map;
  double target_distance = 0;  // distance of the points of LookAt
};

// Reads the numbers after a transformation directive: LookAt, Translate, Scale, Rotate, Transform or
// ConcatTransform. Throws InputError if the map is not affine.
PbrtTransform pbrt_transform(std::string_view directive, PbrtLexer& lexer);
bool is_pbrt_transform(std::string_view directive);

}  // namespace orrery
