# Renders one of orrery's scenes with Blender's Cycles: `blender -b --factory-startup -P FILE -- SCENE`.
# Supports meshes, parallelograms, environment images, Lambert surfaces, emitters, smooth glass, and metal
# that reflects all light. Each input line is a JSON object with samples, seed, bounces, size in pixels,
# threads, preset ("fair" or "defaults") and out, a file that ends with .exr. The reply is a line "rendered
# SECONDS" with the CPU time of all threads, including scene conversion and writing.

import json
import math
import os
import resource
import sys

import bpy
import mathutils

SHADERS = {
    "emission": "ShaderNodeEmission",
    "rough": "ShaderNodeBsdfDiffuse",
    "lambert": "ShaderNodeBsdfDiffuse",
    "metal": "ShaderNodeBsdfGlossy",
    "glass": "ShaderNodeBsdfGlass",
}


def material_of(name, record):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader = nodes.new(SHADERS["emission" if "emission" in record else record["type"]])
    color = (1, 1, 1)
    if "emission" in record:
        shader.inputs["Strength"].default_value = 1
        color = record["emission"]
    elif record["type"] == "glass":
        shader.distribution = "SHARP"
        shader.inputs["IOR"].default_value = record["ior"]
    elif record["type"] == "metal":
        assert min(record["k"]) >= 1000
        shader.distribution = "MULTI_GGX"
        shader.inputs["Roughness"].default_value = record["roughness"]
    else:
        shader.inputs["Roughness"].default_value = 0
        color = record["kd"] if "kd" in record else record["reflectance"]
    shader.inputs["Color"].default_value = (*color, 1)
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def vertices_and_faces(record):
    if record["type"] == "mesh":
        return record["positions"], record["indices"]
    corner, a, b = (mathutils.Vector(record[key]) for key in ("corner", "edge_u", "edge_v"))
    return [corner, corner + a, corner + a + b, corner + b], [[0, 1, 2], [0, 2, 3]]


def add_camera(scene, record):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(record["fov_degrees"])
    camera.clip_start = 0.001
    eye, target = mathutils.Vector(record["eye"]), mathutils.Vector(record["look_at"])
    z = (eye - target).normalized()
    x = mathutils.Vector(record.get("up", (0, 1, 0))).cross(z).normalized()
    y = z.cross(x)
    placed = bpy.data.objects.new("camera", camera)
    placed.matrix_world = mathutils.Matrix([(x[i], y[i], z[i], eye[i]) for i in range(3)] + [(0, 0, 0, 1)])
    scene.collection.objects.link(placed)
    scene.camera = placed


def convert(record, folder):
    scene = bpy.context.scene
    for placed in list(bpy.data.objects):
        bpy.data.objects.remove(placed)
    materials = {name: material_of(name, one) for name, one in record["materials"].items()}
    for i, one in enumerate(record["objects"]):
        mesh = bpy.data.meshes.new(str(i))
        vertices, faces = vertices_and_faces(one)
        mesh.from_pydata(vertices, [], faces)
        mesh.materials.append(materials[one["material"]])
        scene.collection.objects.link(bpy.data.objects.new(str(i), mesh))
    add_camera(scene, record["camera"])
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    if "environment" in record:
        surround(scene.world.node_tree, record["environment"], folder)
    return scene


# Adds an environment. The middle of the image is toward +x in Cycles and toward -z in orrery. The top of the
# image is toward +z in Cycles and toward +y in orrery.
def surround(tree, record, folder):
    nodes, links = tree.nodes, tree.links
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(os.path.join(folder, record["file"]))
    mapping = nodes.new("ShaderNodeMapping")
    turn = mathutils.Matrix.Rotation(math.radians(-record.get("rotation_degrees", 0)), 3, "Y")
    axes = mathutils.Matrix(((0, 0, -1), (-1, 0, 0), (0, 1, 0)))
    mapping.inputs["Rotation"].default_value = (axes @ turn).to_euler("XYZ")
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])


# Sets the options of a preset. "fair" is unbiased: no clamping, no light threshold, no glossy filter, no
# adaptive sampling. The samples are numbered N to 2N - 1, because Cycles traces sample 0 of every pixel
# through the centre instead of sampling the filter. Sample 0 would cause an error of 1/N at edges, equal for
# every seed. Samples N to 2N - 1 are equally well stratified. "defaults" has Blender's values of all five
# options. A `threshold` enables adaptive sampling in both presets. Neither preset denoises. Both use orrery's
# pixel filter and path length.
def choose_preset(cycles, preset, samples, threshold):
    fair = preset == "fair"
    cycles.sample_offset = samples if fair else 0
    cycles.use_adaptive_sampling = not fair or threshold is not None
    cycles.adaptive_threshold = threshold or 0.01
    cycles.sample_clamp_direct = 0
    cycles.sample_clamp_indirect = 0 if fair else 10
    cycles.light_sampling_threshold = 0 if fair else 0.01
    cycles.blur_glossy = 0 if fair else 1
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1


def render(scene, order):
    cycles, settings = scene.cycles, scene.render
    settings.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.samples, cycles.seed = order["samples"], order["seed"]
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = order["bounces"]
    cycles.transmission_bounces = order["bounces"]
    cycles.use_auto_tile = False
    choose_preset(cycles, order["preset"], order["samples"], order.get("threshold"))
    settings.resolution_x = settings.resolution_y = order["size"]
    settings.resolution_percentage = 100
    settings.threads_mode, settings.threads = "FIXED", order["threads"]
    image = settings.image_settings
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    settings.filepath = order["out"]
    before = resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render(write_still=True)
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main():
    path = os.path.abspath(sys.argv[sys.argv.index("--") + 1])
    with open(path, encoding="utf-8") as file:
        scene = convert(json.load(file), os.path.dirname(path))
    for line in sys.stdin:
        print("\nrendered", render(scene, json.loads(line)), flush=True)


main()
