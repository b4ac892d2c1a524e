#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/framing/framing.h"
#include "core/model/asset_source.h"
#include "core/params/document.h"
#include "core/plan/request.h"
#include "server/api/model_materials.h"

namespace orrery {

// Options of the view of a model.
struct ViewOptions {
  enum class Ground { none, shadow, grid };

  std::optional<Vec3d> up;  // default: that of the format
  ViewDirection from = {};
  bool orthographic = false;
  Ground ground = Ground::none;
  Fit fit = Fit::view;
  std::string camera;       // name or number of a camera of the file; empty: framed exactly
  bool file_light = false;  // lights of the file, otherwise those of a studio
  ModelState state = {};
  bool plays = false;  // the scene moves through the animation `state.pose` of the model, if it has any
};

// Option of a view: query parameter and flag.
struct ViewParameter {
  std::string_view key, placeholder, help;
  std::string_view fallback;                     // value of a missing option
  std::span<const std::string_view> names = {};  // allowed values, unless any text is
};
std::span<const ViewParameter> view_parameters();

// Reads the options from an object of strings, of which `camera` is not checked. Throws InputError with
// pointers such as "/up".
ViewOptions read_view_options(const Document& document);

// Returns the request with an error budget of 0.02 if it has neither samples nor a budget.
RenderRequest with_view_budget(RenderRequest request);

struct ImageSize {
  int width, height;
};
// Returns the size of the image: that of the request, or 512 x 512.
ImageSize view_size(const RenderRequest& request);

// Direction that is up in files of this format, unless their makers agreed otherwise.
Vec3d usual_up(MeshFormat format);

// Reads the model of a view by read(state). If the view plays an animation, reads the poses of its keyframes:
// up to 24 per second, at most 121, and few enough for a million vertices in all. Images are in the first
// state only. Otherwise reads one state: also if the animation has no duration or invalid poses, or if it
// mirrors triangles. Throws InputError (pointer "/animation") if the model has other animations, but not the
// one that the options name.
ModelStates read_states(const ViewOptions& options,
                        const std::function<MeshModelPtr(const ModelState&)>& read);

// Returns a scene with the model in the first state, a camera that frames it exactly in an image of this
// size, uniform light from all directions and a soft key light from the upper left of the camera. Meshes
// without normals are smooth across edges of less than 30 degrees. Models without materials are grey. Further
// states are keyframes of motion, and the camera frames all of them. REQUIRES: the mesh has triangles. Throws
// InputError (pointer "/camera" or "/light") if the model lacks what the options name.
nlohmann::ordered_json view_scene(const ModelStates& states, const ModelReference& reference,
                                  const ViewOptions& options, int width, int height);

}  // namespace orrery
