#!/usr/bin/env python3
"""Pictures by Mitsuba 3's path tracers and Intel's Open Image Denoise, at a given time for each: the rival of tensor_clustering_2008.py (frames of a shot) and of
column_completion_2016.py (--integrator volpath), which call it.

    denoised_path_tracer.py OUT SCENE_0000.xml [SCENE_0001.xml …] --size 320x240 --seconds 2.5 [--lines 24,72,120] [--truth 1024]

Needs the packages mitsuba, pyoidn and numpy, and for its LLVM variant a libLLVM that it knows (DRJIT_LIBLLVM_PATH). The scenes are what `lumirank convert --frame K` writes.
Of the variants (--variants) the one that is faster on the first frame is used. Paths per pixel are as many as take the seconds together with the denoiser, found by trials there when
everything is compiled; loading and compiling are not counted, which is in its favor. The same seed is used in every frame. Denoised with albedo and normals, rendered along.
OUT gets frame_0000.pfm (denoised), noisy_0000.pfm, with --lines truth_0000.pfm and other_truth_0000.pfm (those scanlines alone, one below the other, each with half of
--truth paths per pixel; "all": the whole picture), and shot.json.
"""
import argparse
import json
import pathlib
import time

import mitsuba as mi
import numpy as np

import pyoidn

def integrators(kind):
    """Alone, and with what the denoiser wants to know of surfaces. `kind`: name and depth."""
    path = {"type": kind[0], "max_depth": kind[1], "rr_depth": 6}
    return mi.load_dict(path), mi.load_dict({"type": "aov", "aovs": "al:albedo,nn:sh_normal", "img": path})


def write_pfm(path, image):
    height, width, _ = image.shape
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + np.ascontiguousarray(image[::-1], dtype="<f4").tobytes())


def load(path, size, crop=None):
    """The scene with a film of that size; crop: (x, y, width, height)."""
    scene = mi.load_file(str(path))
    sensor = scene.sensors()[0]
    width, height = sensor.film().size()
    if abs(size[0] * height - size[1] * width) > max(width, height, *size):
        raise SystemExit(f"{path} is {width}x{height}, and {size[0]}x{size[1]} would show another part of the scene: give a --size of the same shape")
    film = {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"}, "component_format": "float32"}
    if crop:
        film |= {"crop_offset_x": crop[0], "crop_offset_y": crop[1], "crop_width": crop[2], "crop_height": crop[3]}
    fov = float(np.array(mi.traverse(sensor)["x_fov"]).ravel()[0])
    medium = {"medium": sensor.get_medium()} if sensor.get_medium() else {}
    return scene, mi.load_dict({"type": "perspective", "fov": fov, "fov_axis": "x", "to_world": mi.ScalarTransform4f(np.array(sensor.world_transform().matrix).reshape(4, 4)),
                                "film": film, "sampler": {"type": "independent"}, "near_clip": sensor.near_clip(), "far_clip": sensor.far_clip()} | medium)


def render(scene, sensor, integrator, paths, seed):
    """At most 64 paths at a time, for the memory."""
    total, done, part = 0, 0, 0
    while done < paths:
        now = min(64, paths - done)
        total = total + np.array(mi.render(scene, integrator=integrator, sensor=sensor, spp=now, seed=seed + part), dtype=np.float64) * now
        done, part = done + now, part + 1
    return total / paths


def denoise(image):
    color, albedo, normal = (np.ascontiguousarray(image[..., k:k + 3], dtype=np.float32) for k in (0, image.shape[2] - 6, image.shape[2] - 3))
    return np.asarray(pyoidn.denoise(color, np.clip(albedo, 0, 1), normal, hdr=True))


def pace(file, size, kind):
    """Seconds for one path in each pixel, and a picture."""
    scene, sensor = load(file, size)
    _, integrator = integrators(kind)
    for paths in (1, 8, 8):  # the first two compile
        start = time.monotonic()
        image = render(scene, sensor, integrator, paths, 1)
        each = (time.monotonic() - start) / paths
    return each, image


def fitting_paths(file, size, kind, seconds, first):
    """How many paths for each pixel take the seconds, with the denoiser: a path among few costs more than one among many, so what was found is tried."""
    paths = max(1, round(first))
    _, integrator = integrators(kind)
    for _ in range(3):
        scene, sensor = load(file, size)
        render(scene, sensor, integrator, 1, 1)
        render(scene, sensor, integrator, paths, 2)
        start = time.monotonic()
        image = render(scene, sensor, integrator, paths, 1)
        rendered = time.monotonic() - start
        denoise(image)
        denoised = time.monotonic() - start - rendered
        fitting = max(1, round(paths * (seconds - denoised) / rendered))
        if abs(fitting - paths) <= 0.05 * paths:
            break
        paths = fitting
    return paths


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", required=True)
    parser.add_argument("--seconds", type=float, required=True, help="for each frame")
    parser.add_argument("--lines", default="", help="scanlines of which the truth is wanted, from the top, or \"all\"")
    parser.add_argument("--truth", type=int, default=1024, help="paths per pixel for it")
    parser.add_argument("--integrator", default="path", help="path, volpath or volpathmis")
    parser.add_argument("--depth", type=int, default=17)
    parser.add_argument("--variants", default="llvm_ad_rgb,scalar_rgb", help="of Mitsuba, to choose from; with hundreds of instances LLVM compiles for minutes")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    kind = (args.integrator, args.depth)
    size = tuple(map(int, args.size.split("x")))
    paces = {}
    for variant in args.variants.split(","):
        mi.set_variant(variant)
        paces[variant], noisy = pace(args.scenes[0], size, kind)
    variant = min(paces, key=paces.get)
    mi.set_variant(variant)
    plain, integrator = integrators(kind)
    denoise(noisy)
    start = time.monotonic()
    denoise(noisy)
    of_denoiser = time.monotonic() - start
    paths = fitting_paths(args.scenes[0], size, kind, args.seconds, (args.seconds - of_denoiser) / paces[variant])
    seconds = []
    for k, file in enumerate(args.scenes):
        scene, sensor = load(file, size)
        render(scene, sensor, integrator, 1, 1)  # what another scene compiles or builds is not counted either
        start = time.monotonic()
        noisy = render(scene, sensor, integrator, paths, 1)
        clean = denoise(noisy)
        seconds.append(time.monotonic() - start)
        write_pfm(args.out / f"frame_{k:04d}.pfm", clean)
        write_pfm(args.out / f"noisy_{k:04d}.pfm", noisy[..., :3])
        if args.lines:
            # Two independent halves: what is measured against both is free of their noise (shot_measures.py).
            for name, seed in (("truth", 1001), ("other_truth", 500_001)):
                crops = [None] if args.lines == "all" else [(0, int(y), size[0], 1) for y in args.lines.split(",")]
                lines = [render(*load(file, size, crop), plain, max(1, args.truth // 2), seed) for crop in crops]
                write_pfm(args.out / f"{name}_{k:04d}.pfm", np.concatenate([line[..., :3] for line in lines]))
    (args.out / "shot.json").write_text(json.dumps({"paths": paths, "seconds": seconds, "denoiser": of_denoiser, "paces": paces, "mitsuba": mi.__version__}))


if __name__ == "__main__":
    main()
