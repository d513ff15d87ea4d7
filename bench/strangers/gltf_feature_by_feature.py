#!/usr/bin/env python3
"""Renders one small glTF scene for each feature by `lumirank reference` and by Blender's Cycles, and says where they differ.

    bench/strangers/gltf_feature_by_feature.py OUT [NAME ...] [--program lumirank] [--paths 128]

The scenes are those of gltf_scenes.py, under an even dim sky. Printed: as by feature_by_feature.py. What differs for a reason stands in docs/decisions.md ("glTF is asked feature by feature, beside Cycles").

Needs from pip: bpy==4.5.15 (Python 3.11), numpy, pillow, OpenEXR.
"""
import bpy
import numpy as np
import OpenEXR

import compare_blocks
import gltf_scenes

SKY = (0.3, 0.35, 0.4)


def render_by_cycles(scene_file, picture, samples):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(scene_file), export_import_convert_lighting_mode="COMPAT")
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", samples, False, False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 16
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = cycles.blur_glossy = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    scene.render.resolution_x, scene.render.resolution_y = 96, 64
    for lamp in bpy.data.lights:
        if lamp.type == "SUN":
            lamp.angle = 0
        else:
            lamp.shadow_soft_size = 0
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (*SKY, 1)
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)


def main():
    def theirs(out, name, samples):
        picture = out / f"{name}_cycles.exr"
        render_by_cycles(out / f"{name}.gltf", picture, samples)
        return compare_blocks.load(picture)

    def write(out, name):
        gltf_scenes.write_scenes(out)
        sky = np.full((16, 32, 3), SKY, np.float32)
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": sky}).write(str(out / "sky.exr"))
        return out / f"{name}.gltf"

    compare_blocks.go_through(__doc__, list(gltf_scenes.build()), write, theirs, lambda out: ["--environment", str(out / "sky.exr"), "--size", "96x64"], paths=128)


if __name__ == "__main__":
    main()
