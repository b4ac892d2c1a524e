#pragma once

#include "server/import/scene_writer.h"

namespace orrery {

// Camera of a description: its axes in the scene, and its view.
struct ImportCamera {
  Affined map = {};          // from camera space to the scene; the length of z is the unit of distances
  Vec3d right, up, forward;  // axes in camera space
  std::string type = "perspective";
  double half_height = 1;                      // half the height of the view, at distance 1 if not parallel
  double lens_radius = 0, focus_distance = 0;  // in camera space; 0: pinhole
  double target_distance = 1;                  // in camera space
};

// Returns whether the camera sees a right-handed scene mirrored.
bool sees_mirrored(const ImportCamera& camera);

// Sets the camera of a scene.
void set_camera(SceneWriter& scene, const ImportCamera& camera);

// Sets the size of the image, reduced to the limits with a note.
void set_image_size(SceneWriter& scene, double width, double height);

// Sets the render options: `samples` per pixel, `bounces` after the camera ray, which are at most the limits.
void set_render_options(SceneWriter& scene, double samples, double bounces, const std::string& filter);

}  // namespace orrery
