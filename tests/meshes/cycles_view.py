# Renders a glTF model with Blender's Cycles: `blender -b --factory-startup -P FILE -- ORDER`. ORDER is a JSON
# object with model, camera, light and radiance as in a scene of `orrery view`, samples per pixel, side in
# pixels, and file, a PNG file to write. Blender turns models from y up to z up: (x, y, z) becomes (x, -z, y).

import json
import math
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # an alias that numpy 1.24 removed and that the importer of Blender 3.4 uses

order = json.loads(sys.argv[sys.argv.index("--") + 1])


def turned(v):
    return mathutils.Vector((v[0], -v[2], v[1]))


def frame(z, up):
    """Returns a rotation whose third column is z."""
    z = z.normalized()
    x = up.cross(z)
    x = (x if x.length > 1e-6 else mathutils.Vector((1, 0, 0)).cross(z)).normalized()
    y = z.cross(x)
    return mathutils.Matrix([(x[i], y[i], z[i], 0) for i in range(3)] + [(0, 0, 0, 1)])


scene = bpy.context.scene
for placed in list(bpy.data.objects):
    bpy.data.objects.remove(placed)
bpy.ops.import_scene.gltf(filepath=order["model"])
for placed in list(bpy.data.objects):
    if placed.type in ("CAMERA", "LIGHT"):
        bpy.data.objects.remove(placed)

record = order["camera"]
camera = bpy.data.cameras.new("view")
camera.sensor_fit = "VERTICAL"
camera.angle = math.radians(record["fov_degrees"])
eye, target = turned(record["eye"]), turned(record["look_at"])
camera.clip_start, camera.clip_end = (eye - target).length / 1000, (eye - target).length * 100
placed = bpy.data.objects.new("view", camera)
placed.matrix_world = mathutils.Matrix.Translation(eye) @ frame(eye - target, turned(record["up"]))
scene.collection.objects.link(placed)
scene.camera = placed

# A white surface that faces a light of pi lux has radiance 1.
sun = bpy.data.lights.new("key", "SUN")
sun.energy = math.pi * order["light"]["intensity"][0]
sun.angle = math.radians(order["light"].get("angle_degrees", 0))
placed = bpy.data.objects.new("key", sun)
placed.matrix_world = frame(turned(order["light"]["direction_to_light"]), mathutils.Vector((0, 0, 1)))
scene.collection.objects.link(placed)

world = bpy.data.worlds.new("sky")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (*order["radiance"], 1)
world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1
scene.world = world

scene.render.engine = "CYCLES"
scene.cycles.samples = order["samples"]
scene.cycles.use_adaptive_sampling = False
scene.cycles.use_denoising = False
scene.cycles.max_bounces = 4
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x = scene.render.resolution_y = order["side"]
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGB"
scene.render.filepath = order["file"]
bpy.ops.render.render(write_still=True)
