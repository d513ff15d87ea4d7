#!/usr/bin/env python3
"""Scenes as a designer makes them in Blender, written by its glTF exporter as it stands, each with Cycles' picture.

    bench/strangers/make_in_blender.py OUT [--reference-seconds 60] [--seconds 10] [NAME ...]

NAME.glb, NAME_reference.exr (Cycles, without a denoiser) and NAME_cycles.exr (Cycles and OIDN in the time that a user gives). flat: a flat in the sun; desk: a lamp of glass and metal at night; shop: 60 small lamps, shelves of bottles; pavilion: columns, water, low sun.

Needs from pip: bpy==4.5.15 (Python 3.11).
"""
import argparse
import math
import pathlib
import random
import time

import bpy

SIZE = (640, 360)


def material(name, color=(0.8, 0.8, 0.8), **inputs):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    node = m.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return m


def glow(name, color, strength):
    return material(name, (0, 0, 0), Emission_Color=(*color, 1), Emission_Strength=strength)


def finish(name, m, bevel=0, subdivide=0, smooth=False):
    o = bpy.context.object
    o.name = name
    o.data.materials.append(m)
    if bevel:
        modifier = o.modifiers.new("bevel", "BEVEL")
        modifier.width, modifier.segments = bevel, 3
    if subdivide:
        o.modifiers.new("subdivide", "SUBSURF").levels = subdivide
    if smooth:
        bpy.ops.object.shade_smooth()
    return o


def box(name, place, size, m, bevel=0):
    bpy.ops.mesh.primitive_cube_add(size=1, location=place)
    bpy.context.object.scale = size
    bpy.ops.object.transform_apply(location=False, rotation=False)
    return finish(name, m, bevel)


def plane(name, place, size, m, rotation=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=1, location=place, rotation=rotation)
    bpy.context.object.scale = (*size, 1)
    return finish(name, m)


def ball(name, place, radius, m):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place, segments=48, ring_count=24)
    return finish(name, m, smooth=True)


def turned(name, place, outline, m, segments=48):
    """A solid of revolution about z of the (radius, height) in `outline`."""
    rings = [[(r * math.cos(2 * math.pi * k / segments), r * math.sin(2 * math.pi * k / segments), z) for k in range(segments)] for r, z in outline]
    faces = [(i * segments + k, i * segments + (k + 1) % segments, (i + 1) * segments + (k + 1) % segments, (i + 1) * segments + k) for i in range(len(outline) - 1) for k in range(segments)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([p for ring in rings for p in ring], [], faces)
    o = bpy.data.objects.new(name, mesh)
    o.location = place
    bpy.context.collection.objects.link(o)
    bpy.context.view_layer.objects.active = o
    for other in bpy.context.selected_objects:
        other.select_set(False)
    o.select_set(True)
    return finish(name, m, smooth=True)


def lamp(kind, place, rotation=(0, 0, 0), **settings):
    bpy.ops.object.light_add(type=kind, location=place, rotation=rotation)
    for key, value in settings.items():
        setattr(bpy.context.object.data, key, value)


def camera(place, target, lens=24):
    bpy.ops.object.camera_add(location=place)
    c = bpy.context.object
    c.data.lens = lens
    import mathutils

    c.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = c


def room(x, y, z, wall, floor, window=None):
    """Of x × y × z about the origin; the wall at -x has a hole (y0, y1, z0, z1)."""
    box("floor", (0, 0, -0.05), (x, y, 0.1), floor)
    box("ceiling", (0, 0, z + 0.05), (x, y, 0.1), wall)
    box("back", (0, y / 2 + 0.05, z / 2), (x, 0.1, z), wall)
    box("front", (0, -y / 2 - 0.05, z / 2), (x, 0.1, z), wall)
    box("right", (x / 2 + 0.05, 0, z / 2), (0.1, y, z), wall)
    y0, y1, z0, z1 = window or (0, 0, 0, 0)
    for k, (a, b, low, high) in enumerate([(-y / 2, y0, 0, z), (y1, y / 2, 0, z), (y0, y1, 0, z0), (y0, y1, z1, z)]):
        if b > a and high > low:
            box(f"left {k}", (-x / 2 - 0.1, (a + b) / 2, (low + high) / 2), (0.2, b - a, high - low), wall)


def flat():
    white, wood = material("white wall", (0.82, 0.8, 0.76), Roughness=0.9), material("parquet", (0.36, 0.2, 0.1), Roughness=0.25)
    room(6, 5, 2.7, white, wood, window=(-1.2, 1.4, 0.7, 2.3))
    plane("pane", (-3.1, 0.1, 1.5), (2.6, 1.6), material("glass pane", (1, 1, 1), Roughness=0, Transmission_Weight=1, IOR=1.5), (0, math.pi / 2, math.pi / 2))
    sofa = material("sofa", (0.12, 0.2, 0.32), Roughness=1, Sheen_Weight=0.5)
    box("seat", (1.2, 1.8, 0.3), (2.2, 0.9, 0.4), sofa, 0.08)
    box("rest", (1.2, 2.25, 0.7), (2.2, 0.25, 0.7), sofa, 0.08)
    box("table", (0.6, 0.2, 0.42), (1.3, 0.7, 0.05), material("table", (0.5, 0.33, 0.2), Roughness=0.4, Coat_Weight=1.0, Coat_Roughness=0.05), 0.01)
    for dx in (-0.55, 0.55):
        for dy in (-0.28, 0.28):
            box("leg", (0.6 + dx, 0.2 + dy, 0.2), (0.05, 0.05, 0.4), material("steel", (0.6, 0.6, 0.62), Metallic=1, Roughness=0.3))
    turned("vase", (0.4, 0.2, 0.445), [(0.001, 0), (0.08, 0), (0.1, 0.1), (0.05, 0.25), (0.07, 0.3), (0.06, 0.3), (0.04, 0.25), (0.09, 0.1), (0.001, 0.02)], material("vase", (0.9, 0.97, 0.95), Roughness=0, Transmission_Weight=1, IOR=1.5))
    ball("pot", (0.95, 0.25, 0.545), 0.1, material("brass", (0.9, 0.65, 0.25), Metallic=1, Roughness=0.15))
    plane("mirror", (2.98, -0.3, 1.5), (1.4, 1.0), material("mirror", (0.95, 0.95, 0.95), Metallic=1, Roughness=0.02), (0, -math.pi / 2, math.pi))
    plane("picture", (-1.2, 2.495, 1.6), (0.9, 0.7), material("picture", (0.7, 0.25, 0.15), Roughness=0.5), (math.pi / 2, 0, 0))
    plane("panel", (0, 0, 2.69), (1.2, 0.3), glow("panel", (1, 0.85, 0.65), 4))
    lamp("SUN", (0, 0, 5), (0, math.radians(-55), math.radians(-15)), energy=8, angle=0.009, color=(1, 0.93, 0.82))
    camera((2.4, -2.2, 1.5), (-0.6, 0.8, 0.9), 22)


def desk():
    room(4, 4, 2.6, material("wall", (0.55, 0.6, 0.55), Roughness=1), material("carpet", (0.25, 0.08, 0.06), Roughness=1))
    box("desk", (0, 1.4, 0.72), (1.8, 0.8, 0.06), material("walnut", (0.18, 0.09, 0.05), Roughness=0.2, Coat_Weight=0.6, Coat_Roughness=0.1), 0.01)
    for dx in (-0.8, 0.8):
        box("side", (dx, 1.4, 0.36), (0.06, 0.7, 0.7), material("side", (0.18, 0.09, 0.05), Roughness=0.4))
    brass = material("brass", (0.9, 0.65, 0.25), Metallic=1, Roughness=0.2)
    turned("foot", (-0.5, 1.5, 0.75), [(0.001, 0), (0.1, 0), (0.1, 0.02), (0.015, 0.03), (0.015, 0.4), (0.001, 0.4)], brass)
    turned("shade", (-0.5, 1.5, 1.1), [(0.2, 0), (0.1, 0.2)], material("green shade", (0.05, 0.3, 0.12), Roughness=0.3))
    ball("bulb", (-0.5, 1.5, 1.18), 0.035, glow("bulb", (1, 0.75, 0.45), 250))
    for k in range(9):
        box(f"book {k}", (0.2 + 0.055 * k, 1.62, 0.75 + 0.11 + 0.01 * (k % 3)), (0.045, 0.16, 0.22 + 0.02 * (k % 3)), material(f"book {k}", ((0.1 + 0.09 * k) % 0.7, (0.5 - 0.05 * k) % 0.6, (0.2 + 0.13 * k) % 0.6), Roughness=0.6), 0.003)
    turned("glass", (0.05, 1.2, 0.75), [(0.001, 0), (0.03, 0), (0.035, 0.1), (0.033, 0.1), (0.028, 0.01), (0.001, 0.01)], material("tumbler", (1, 1, 1), Roughness=0, Transmission_Weight=1, IOR=1.5))
    ball("globe", (0.6, 1.15, 0.85), 0.1, material("globe", (0.1, 0.25, 0.5), Roughness=0.15))
    lamp("SPOT", (-1.8, -1.5, 2.4), (math.radians(50), 0, math.radians(-40)), energy=15, spot_size=0.9, spot_blend=0.4, shadow_soft_size=0.03)
    camera((0.9, -0.4, 1.5), (-0.05, 1.4, 0.9), 30)


def shop():
    room(7, 5, 3, material("plaster", (0.7, 0.66, 0.6), Roughness=1), material("stone", (0.3, 0.3, 0.32), Roughness=0.15))
    rng = random.Random(3)
    shelf, colors = material("oak", (0.42, 0.27, 0.14), Roughness=0.5), [(0.2, 0.5, 0.2), (0.5, 0.15, 0.05), (0.9, 0.9, 0.9), (0.6, 0.4, 0.1)]
    bottles = [material(f"bottle {k}", c, Roughness=0.02, Transmission_Weight=1, IOR=1.5) for k, c in enumerate(colors)]
    jars = [material(f"jar {k}", c, Roughness=0.4) for k, c in enumerate(colors)]
    for level in range(4):
        box(f"board {level}", (0, 2.3, 0.5 + 0.55 * level), (6.4, 0.35, 0.04), shelf, 0.005)
        for k in range(22):
            x, tall = -3.0 + 0.28 * k + rng.uniform(-0.05, 0.05), rng.uniform(0.2, 0.4)
            outline = [(0.001, 0), (0.06, 0), (0.06, 0.6 * tall), (0.02, 0.8 * tall), (0.02, tall), (0.001, tall)]
            turned(f"bottle {level} {k}", (x, 2.25 + rng.uniform(-0.05, 0.05), 0.52 + 0.55 * level), outline, rng.choice(bottles if (k + level) % 3 == 0 else jars), 24)
    box("counter", (0.5, 0, 0.5), (2.4, 0.7, 1), material("counter", (0.1, 0.12, 0.16), Roughness=0.08), 0.02)
    for i in range(10):
        for k in range(6):
            place = (-3 + 0.66 * i, -2 + 0.75 * k, 2.95)
            ball(f"lamp {i} {k}", place, 0.04, glow(f"lamp {i} {k}", (1, rng.uniform(0.6, 0.9), rng.uniform(0.3, 0.8)), rng.uniform(5, 60)))
    camera((-2.6, -2.2, 1.6), (0.6, 1.4, 1.1), 24)


def pavilion():
    plane("ground", (0, 0, 0), (60, 60), material("ground", (0.35, 0.3, 0.22), Roughness=1))
    plane("pool", (0, -1.5, 0.02), (7, 3), material("water", (0.02, 0.05, 0.06), Roughness=0.03))
    marble = material("marble", (0.85, 0.83, 0.8), Roughness=0.2)
    box("base", (0, 3, 0.1), (9, 5, 0.2), marble, 0.02)
    box("roof", (0, 3, 3.4), (9.4, 5.4, 0.3), material("concrete", (0.5, 0.5, 0.48), Roughness=1), 0.03)
    for k in range(7):
        for y in (0.8, 5.2):
            turned(f"column {k} {y}", (-4.2 + 1.4 * k, y, 0.2), [(0.001, 0), (0.25, 0), (0.25, 0.1), (0.17, 0.2), (0.15, 2.8), (0.22, 2.9), (0.22, 3.05), (0.001, 3.05)], marble)
    ball("steel ball", (-1.5, 2.6, 0.75), 0.55, material("steel", (0.7, 0.72, 0.75), Metallic=1, Roughness=0.05))
    ball("red ball", (1.2, 3.2, 0.7), 0.5, material("red", (0.7, 0.05, 0.03), Roughness=0.35, Coat_Weight=1.0, Coat_Roughness=0.02))
    plane("sky", (0, 10, 25), (70, 70), glow("sky", (0.45, 0.65, 1), 0.8), (math.radians(200), 0, 0))
    lamp("SUN", (0, 0, 5), (math.radians(58), 0, math.radians(35)), energy=5, angle=0.009, color=(1, 0.9, 0.75))
    camera((-4.5, -6.5, 1.7), (0.3, 2.5, 1.3), 26)


def render(picture, seconds, denoise):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.time_limit, cycles.use_denoising = "CPU", 100000, seconds, denoise
    cycles.use_adaptive_sampling = denoise
    if not denoise:
        cycles.sample_clamp_indirect = 0
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 16
        cycles.blur_glossy = 0
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    cycles.pixel_filter_type = "BOX"
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(picture)
    start = time.time()
    bpy.ops.render.render(write_still=True)
    return time.time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--reference-seconds", type=float, default=60)
    parser.add_argument("--seconds", type=float, default=10)
    args = parser.parse_args()
    out = args.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    every = {"flat": flat, "desk": desk, "shop": shop, "pavilion": pavilion}
    for name in args.names or every:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        every[name]()
        bpy.ops.export_scene.gltf(filepath=str(out / f"{name}.glb"), export_cameras=True, export_lights=True, export_apply=True)
        bpy.context.scene.world = bpy.data.worlds.new("black")
        bpy.context.scene.world.use_nodes = True
        bpy.context.scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0
        took = render(out / f"{name}_cycles.exr", args.seconds, True)
        print(f"{name}: Cycles and OIDN took {took:.1f} s")
        render(out / f"{name}_reference.exr", args.reference_seconds, False)


if __name__ == "__main__":
    main()
