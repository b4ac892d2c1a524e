#include "server/api/view_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/shorten.h"
#include "core/math/angles.h"
#include "core/math/bounds.h"
#include "core/meshes/repair.h"
#include "core/params/params.h"

namespace orrery {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSize = 512;
constexpr double kFieldOfView = 30, kMargin = 0.05, kCreaseDegrees = 30, kMaxError = 0.02;
// Radiance of the surroundings, and intensity and place of the key light relative to the camera.
constexpr double kSurroundings = 0.5, kKeyLight = 0.7, kKeyAzimuth = -40, kKeyElevation = 50, kKeyWidth = 15;
constexpr double kFill = 0.02;  // radiance of the surroundings with the lights of the file
constexpr double kModelReflectance = 0.3;

struct NamedDirection {
  std::string_view name;
  ViewDirection from;
};
// `iso` is the direction of the diagonal of a cube: atan(1 / sqrt(2)) above the horizon.
constexpr std::array<NamedDirection, 7> kDirections{{{"front", {0, 0}},
                                                     {"right", {90, 0}},
                                                     {"back", {180, 0}},
                                                     {"left", {-90, 0}},
                                                     {"top", {0, 90}},
                                                     {"bottom", {0, -90}},
                                                     {"iso", {45, 35.264389682754654}}}};

std::optional<ViewDirection> parse_direction(std::string_view text) {
  for (const NamedDirection& named : kDirections)
    if (text == named.name) return named.from;
  const std::size_t comma = text.find(',');
  if (comma == text.npos) return std::nullopt;
  const auto azimuth = parse_number<double>(std::string(text.substr(0, comma)));
  const auto elevation = parse_number<double>(std::string(text.substr(comma + 1)));
  if (!azimuth || !elevation || !(std::abs(*azimuth) <= 360) || !(std::abs(*elevation) <= 90))
    return std::nullopt;
  return ViewDirection{*azimuth, *elevation};
}

constexpr std::array<std::string_view, 7> kAxes{"auto", "x", "-x", "y", "-y", "z", "-z"};
constexpr std::array<std::string_view, 2> kProjections{"perspective", "orthographic"};
constexpr std::array<std::string_view, 3> kGrounds{"none", "shadow", "grid"};  // in the order of Ground
constexpr std::array<std::string_view, 2> kFits{"view", "turn"};               // in the order of Fit

constexpr std::array<std::string_view, 2> kLights{"studio", "file"};

enum Parameter : std::size_t {
  kFrom,
  kUp,
  kProjection,
  kGround,
  kFit,
  kCamera,
  kLight,
  kPoseTime,
  kAnimation,
  kVariant
};
constexpr std::array<ViewParameter, 10> kParameters{
    {{"from", "DIRECTION",
      "Direction from the model to the camera: front, right, back, left, top, bottom, iso, or azimuth and "
      "elevation in degrees.",
      "30,20"},
     {"up", "AXIS", "Axis of the file that is up; auto: z in STL and 3MF files, y in others.", "auto", kAxes},
     {"projection", "NAME", "Projection of the camera.", "perspective", kProjections},
     {"ground", "NAME", "Plane below the model; shadow: it shows nothing but shadows.", "none", kGrounds},
     {"fit", "NAME", "Content of the image: the model as seen, or the model from every azimuth.", "view",
      kFits},
     {"camera", "NAME", "Camera of a glTF file, by name or number from 0, instead of a framed view.", ""},
     {"light", "NAME", "Light of a studio, or the lights of a glTF file.", "studio", kLights},
     {"pose_time", "SECONDS",
      "Time of the pose in an animation of a glTF model, in seconds; none: at rest; all: the scene moves "
      "through the animation.",
      "none"},
     {"animation", "NUMBER", "Number of the animation of pose_time, from 0.", "0"},
     {"variant", "NAME", "Variant of the materials of a glTF file, by name.", ""}}};

ViewDirection read_direction(Params& p) {
  const ViewParameter& row = kParameters[kFrom];
  const std::string text = p.text(row.key, row.help, 80, row.fallback.data());
  if (const auto direction = parse_direction(text)) return *direction;
  p.fail(
      row.key,
      "must be front, right, back, left, top, bottom, iso, or azimuth and elevation in degrees, -360 to 360 "
      "and -90 to 90, such as 30,20 (got \"" +
          shortened(text, 40) + "\")");
  return {};
}

constexpr std::string_view kWholeAnimation = "all";  // value of pose_time

// Returns nullopt for a model at rest, and the time 0 for a whole animation.
std::optional<ModelPose> read_pose(Params& p) {
  const auto text_of = [&](Parameter which) {
    const ViewParameter& row = kParameters[which];
    return p.text(row.key, row.help, 80, row.fallback.data());
  };
  const auto fail = [&](Parameter which, const char* allowed, const std::string& got) {
    p.fail(kParameters[which].key,
           std::string("must be ") + allowed + " (got \"" + shortened(got, 40) + "\")");
    return std::nullopt;
  };
  const std::string seconds = text_of(kPoseTime), number = text_of(kAnimation);
  const auto animation = parse_number<int>(number);
  if (!animation || *animation < 0 || *animation > 1'000'000)
    return fail(kAnimation, "an integer from 0 to 1,000,000", number);
  if (seconds == "none") return std::nullopt;
  if (seconds == kWholeAnimation) return ModelPose{*animation, 0};
  const auto time = parse_number<double>(seconds);
  if (!time || !(std::abs(*time) <= 1e6))
    return fail(kPoseTime, "none, all, or seconds from -1e6 to 1e6", seconds);
  return ModelPose{*animation, *time};
}

Vec3d axis_of(std::string_view name) {
  const double sign = name.front() == '-' ? -1 : 1;
  switch (name.back()) {
    case 'x': return {sign, 0, 0};
    case 'y': return {0, sign, 0};
    default: return {0, 0, sign};
  }
}

Json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

// Vertices of the triangles with an area, which are drawn, or of all triangles if none has.
std::vector<Vec3d> corners_of(const TriangleMesh& mesh) {
  TriangleMesh drawn{mesh.positions, mesh.triangles, {}, {}};
  drop_degenerate(drawn);
  if (drawn.triangles.empty()) return mesh.positions;
  drop_unused(drawn);
  return std::move(drawn.positions);
}

// Returns the reflectance at which unshadowed ground has the radiance of the surroundings.
double ground_reflectance() {
  const double lit = kSurroundings + kKeyLight * sine_cosine_degrees(kKeyElevation).sine;
  return kSurroundings / lit;
}

// Returns 1, 2 or 5 times a power of 10, about a fifth of `size`.
double grid_step(double size) {
  const double power = std::pow(10, std::floor(std::log10(size / 5)));
  const double steps = size / 5 / power;
  return power * (steps < 1.5 ? 1 : steps < 3.5 ? 2 : steps < 7.5 ? 5 : 10);
}

// Adds the plane below the model, unless the camera is below it: the plane would hide the model.
void add_ground(Json& scene, const ViewOptions& options, const StudioAxes& axes,
                std::span<const Vec3d> corners, const Vec3d& eye) {
  if (options.ground == ViewOptions::Ground::none) return;
  const Vec3d* lowest = &corners.front();
  Boundsd bounds;
  for (const Vec3d& corner : corners) {
    bounds.include(corner);
    if (dot(corner, axes.up) < dot(*lowest, axes.up)) lowest = &corner;
  }
  const Vec3d origin = axes.up * dot(*lowest, axes.up);
  if (!(dot(eye - origin, axes.up) > 0)) return;
  const double reflectance = ground_reflectance();
  Json material{{"type", "lambert"}, {"reflectance", reflectance}};
  if (options.ground == ViewOptions::Ground::grid) {
    const double size = bounds.diagonal() > 0 ? bounds.diagonal() : 1, step = grid_step(size);
    scene["textures"]["grid"] = {{"type", "checker"},
                                 {"even", reflectance},
                                 {"odd", reflectance * 0.85},
                                 {"mapping",
                                  {{"type", "planar"},
                                   {"origin", numbers(origin)},
                                   {"u_edge", numbers(axes.right * step)},
                                   {"v_edge", numbers(-axes.front * step)}}}};
    material["reflectance"] = {{"texture", "grid"}};
  }
  scene["materials"]["ground"] = std::move(material);
  scene["objects"].push_back(
      {{"type", "plane"}, {"point", numbers(origin)}, {"normal", numbers(axes.up)}, {"material", "ground"}});
}

Json camera_json(const Framing& framing, bool orthographic) {
  Json camera{{"type", orthographic ? "orthographic" : "perspective"},
              {"eye", numbers(framing.eye)},
              {"look_at", numbers(framing.look_at)},
              {"up", numbers(framing.up)}};
  if (orthographic)
    camera["height"] = framing.height;
  else
    camera["fov_degrees"] = kFieldOfView;
  return camera;
}

Vec3d key_direction(const StudioAxes& axes, const ViewDirection& from) {
  const SineCosine turn = sine_cosine_degrees(from.azimuth + kKeyAzimuth);
  const SineCosine rise = sine_cosine_degrees(kKeyElevation);
  return (axes.front * turn.cosine + axes.right * turn.sine) * rise.cosine + axes.up * rise.sine;
}

// Returns the camera of the file that the options name, or null.
const ModelCamera* camera_of(const MeshModel& model, const ViewOptions& options) {
  if (options.camera.empty()) return nullptr;
  for (std::size_t i = 0; i < model.cameras.size(); ++i)
    if (model.cameras[i].name == options.camera || std::to_string(i) == options.camera)
      return &model.cameras[i];
  std::vector<std::string_view> names;
  for (const ModelCamera& camera : model.cameras) names.push_back(camera.name);
  throw InputError("/camera", "must be a camera of the file, which has " + shortened_names(names) +
                                  " (got \"" + shortened(options.camera, 40) + "\")");
}

// `corners`: of the mesh, near which the camera focuses.
Json camera_json(const ModelCamera& camera, std::span<const Vec3d> corners) {
  Boundsd bounds;
  for (const Vec3d& corner : corners) bounds.include(corner);
  const double ahead = dot((bounds.lo + bounds.hi) * 0.5 - camera.eye, camera.direction);
  Json json{{"type", camera.fov_degrees > 0 ? "perspective" : "orthographic"},
            {"eye", numbers(camera.eye)},
            {"look_at", numbers(camera.eye + camera.direction * (ahead > 0 ? ahead : 1))},
            {"up", numbers(camera.up)}};
  if (camera.fov_degrees > 0)
    json["fov_degrees"] = camera.fov_degrees;
  else
    json["height"] = camera.height;
  return json;
}

// A white surface that faces a light of I candela at a distance of d has the radiance I / (pi d^2).
Json light_json(const ModelLight& light) {
  const Json intensity = numbers(light.intensity / std::numbers::pi);
  if (light.kind == ModelLight::Kind::directional)
    return {
        {"type", "directional"}, {"direction_to_light", numbers(-light.direction)}, {"intensity", intensity}};
  Json json{{"type", light.kind == ModelLight::Kind::point ? "point" : "spot"},
            {"position", numbers(light.position)},
            {"intensity", intensity},
            {"attenuation", {0, 0, 1}},
            {"clamp_to_one", false}};
  if (light.kind == ModelLight::Kind::point) return json;
  json["direction"] = numbers(light.direction);
  json["inner_degrees"] = light.inner_degrees;
  json["outer_degrees"] = light.outer_degrees;
  return json;
}

void add_light(Json& scene, const MeshModel& model, const ViewOptions& options, const StudioAxes& axes) {
  scene["environment"] = {{"type", "constant"},
                          {"radiance", numbers(Vec3d(options.file_light ? kFill : kSurroundings))}};
  if (!options.file_light) {
    scene["lights"] = {{{"type", "directional"},
                        {"direction_to_light", numbers(key_direction(axes, options.from))},
                        {"intensity", numbers(Vec3d(kKeyLight))},
                        {"angle_degrees", kKeyWidth}}};
    return;
  }
  if (model.lights.empty())
    throw InputError("/light", "must be studio: the file has no lights (got \"file\")");
  for (const ModelLight& light : model.lights) scene["lights"].push_back(light_json(light));
}

// Returns the times of the poses that play an animation, or none if it has no duration or the model has too
// many vertices.
std::vector<double> pose_times(double seconds, std::size_t vertices) {
  constexpr double kPosesPerSecond = 24, kMaxSeconds = 1e6;
  constexpr std::size_t kMaxPoses = 121, kMaxVertices = 1'000'000;  // in all
  const double last = std::min(seconds, kMaxSeconds);
  const auto wanted = static_cast<std::size_t>(std::ceil(last * kPosesPerSecond)) + 1;
  const std::size_t most = std::min(kMaxPoses, kMaxVertices / std::max<std::size_t>(1, vertices));
  if (!(seconds > 0) || most < 2) return {};
  std::vector<double> times(std::min(wanted, most));
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = last * static_cast<double>(i) / static_cast<double>(times.size() - 1);
  return times;
}

void add_state(Json& json, const ModelState& state) {
  if (state.pose) {
    json["pose_time"] = state.pose->time;
    json["animation"] = state.pose->animation;
  }
  if (!state.variant.empty()) json["variant"] = state.variant;
}

// Returns the keyframe of a mesh object.
Json keyframe_of(const Json& object, const ModelState& state, const ModelReference& reference) {
  Json key{{"time", state.pose->time}, {reference.key, reference.name}};
  if (object.contains("part")) key["part"] = object["part"];
  add_state(key, state);
  return key;
}

}  // namespace

Vec3d usual_up(MeshFormat format) {
  const bool is_z_up = format == MeshFormat::stl || format == MeshFormat::three_mf;
  return is_z_up ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);
}

std::span<const ViewParameter> view_parameters() { return kParameters; }

ViewOptions read_view_options(const Document& document) {
  ViewOptions options;
  read_document(document, [&](Params& p) {
    const auto choice = [&](Parameter which) {
      const ViewParameter& row = kParameters[which];
      const std::string name = p.choice(row.key, row.help, row.names, row.fallback);
      return static_cast<std::size_t>(std::find(row.names.begin(), row.names.end(), name) -
                                      row.names.begin());
    };
    options.from = read_direction(p);
    if (const std::size_t up = choice(kUp); up > 0) options.up = axis_of(kAxes[up]);
    options.orthographic = choice(kProjection) == 1;
    options.ground = static_cast<ViewOptions::Ground>(choice(kGround));
    options.fit = static_cast<Fit>(choice(kFit));
    const auto name = [&](Parameter which) {
      return p.text(kParameters[which].key, kParameters[which].help, 200, "");
    };
    options.camera = name(kCamera);
    options.file_light = choice(kLight) == 1;
    options.state = {read_pose(p), name(kVariant)};
    options.plays = name(kPoseTime) == kWholeAnimation;
  });
  return options;
}

RenderRequest with_view_budget(RenderRequest request) {
  if (!request.samples && !request.error && !request.seconds) request.error = kMaxError;
  return request;
}

ImageSize view_size(const RenderRequest& request) {
  return {request.width.value_or(kSize), request.height.value_or(kSize)};
}

ModelStates read_states(const ViewOptions& options,
                        const std::function<MeshModelPtr(const ModelState&)>& read) {
  if (!options.plays) return {{options.state, read(options.state)}};
  const ModelState rest{.variant = options.state.variant};
  const MeshModelPtr model = read(rest);
  const std::vector<ModelAnimation>& animations = model->animations;
  if (animations.empty()) return {{rest, model}};
  const auto number = static_cast<std::size_t>(options.state.pose->animation);
  if (number >= animations.size())
    throw InputError("/animation", "must be from 0 to " + std::to_string(animations.size() - 1) + " (got " +
                                       std::to_string(number) + ")");
  ModelStates states;
  try {
    for (const double time : pose_times(animations[number].seconds, model->mesh.positions.size())) {
      const ModelState state{ModelPose{static_cast<int>(number), time}, rest.variant};
      const MeshModelPtr posed = read(state);
      if (posed->mesh.triangles != model->mesh.triangles) return {{rest, model}};  // it turns inside out
      states[state] = states.empty() ? posed : without_images(posed);
    }
  } catch (const InputError&) {
    return {{rest, model}};
  }
  return states.empty() ? ModelStates{{rest, model}} : states;
}

Json view_scene(const ModelStates& states, const ModelReference& reference, const ViewOptions& options,
                int width, int height) {
  const auto& [state, first] = *states.begin();
  const MeshModel& model = *first;
  const StudioAxes axes = StudioAxes::with_up(options.up.value_or(usual_up(model.format)));
  std::vector<Vec3d> corners;
  for (const auto& [_, posed] : states) {
    const std::vector<Vec3d> own = corners_of(posed->mesh);
    corners.insert(corners.end(), own.begin(), own.end());
  }
  const Framing framing = frame_points(corners, {.axes = axes,
                                                 .from = options.from,
                                                 .aspect = static_cast<double>(width) / height,
                                                 .fov_degrees = options.orthographic ? 0 : kFieldOfView,
                                                 .margin = kMargin,
                                                 .fit = options.fit});
  Json scene{{"version", 1}, {"title", shortened(reference.title, 200)}};
  const ModelCamera* const camera = camera_of(model, options);
  scene["camera"] = camera ? camera_json(*camera, corners) : camera_json(framing, options.orthographic);
  scene["image"] = {{"width", width}, {"height", height}};
  add_light(scene, model, options, axes);
  add_model(scene, model, reference, {{"type", "lambert"}, {"reflectance", kModelReflectance}},
            kCreaseDegrees);
  for (Json& object : scene["objects"]) {
    if (states.size() > 1)
      for (const auto& [moment, _] : states)
        object["motion"].push_back(keyframe_of(object, moment, reference));
    add_state(object, state);
  }
  add_ground(scene, options, axes, corners, camera ? camera->eye : framing.eye);
  // In the open, sharing paths costs more than it gains.
  scene["render"] = {{"technique", "path"}, {"max_depth", 4}, {"path_reuse", 1}};
  return scene;
}

}  // namespace orrery
