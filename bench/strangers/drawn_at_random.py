#!/usr/bin/env python3
"""Rooms and grounds drawn at random (Mitsuba 3 XML), rendered by every default and compared with `lumirank reference`: what finds light that is missing or too much, where nobody looked for it.

    bench/strangers/drawn_at_random.py OUT FIRST LAST [--time 5] [--area-lights] [--program PATH]

Three to eight shapes of any material between up to five walls over a floor, one to three emitters. Scene k is the same each time. A line for each: the mean against the reference's, and the blocks of 10×10 pixels that
differ by more than 8 % and by more than five times what two references of the same time differ there. What is not a fault: light of points, spots and suns without a disc by way of mirrors and glass, which no path finds and
passes show once it has been scattered (--area-lights draws lamps with an area alone), and closed rooms, which let in a millionth of the sky along their edges.
"""
import argparse
import json
import pathlib
import random
import subprocess

import numpy as np
from compare_blocks import load

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = 10
AREAS = ["rect", "rect", "sphere", "env", "sphere", "cylinder"]
ALL = ["rect", "rect", "sphere", "point", "spot", "env", "sun", "cylinder"]
MATERIALS = ["diffuse", "diffuse", "diffuse", "roughplastic", "plastic", "roughconductor", "conductor", "dielectric", "roughdielectric", "thindielectric",
             "principled", "mask", "blend", "principledthin", "bump"]


def color(r, low=0.1, high=0.9):
    return ", ".join(f"{r.uniform(low, high):.3f}" for _ in range(3))


def twosided(inner):
    return f'<bsdf type="twosided">{inner}</bsdf>'


def number(name, value):
    return f'<float name="{name}" value="{value:.3f}"/>'


def material(r, nested=False):
    kind = r.choice(["diffuse", "roughplastic", "roughconductor"] if nested else MATERIALS)
    if kind == "diffuse":
        return twosided(f'<bsdf type="diffuse"><rgb name="reflectance" value="{color(r)}"/></bsdf>')
    if kind in ("roughplastic", "plastic"):
        paint = f'<rgb name="diffuse_reflectance" value="{color(r)}"/>'
        return twosided(f'<bsdf type="{kind}">{paint}{number("alpha", r.choice([0.03, 0.1, 0.3])) if kind == "roughplastic" else ""}</bsdf>')
    if kind == "roughconductor":
        metal = r.choice(["Al", "Au", "Cu"])
        return twosided(f'<bsdf type="{kind}"><string name="material" value="{metal}"/>{number("alpha", r.choice([0.03, 0.1, 0.3, 0.5]))}</bsdf>')
    if kind == "conductor":
        return twosided(f'<bsdf type="{kind}"><string name="material" value="{r.choice(["Al", "Au", "Cu"])}"/></bsdf>')
    if kind == "dielectric":
        return f'<bsdf type="{kind}">{number("int_ior", r.choice([1.33, 1.5, 1.8]))}</bsdf>'
    if kind == "roughdielectric":
        return f'<bsdf type="{kind}">{number("int_ior", 1.5)}{number("alpha", r.choice([0.05, 0.15, 0.4]))}</bsdf>'
    if kind == "thindielectric":
        return f'<bsdf type="{kind}"/>'
    if kind == "principled":
        paint = f'<rgb name="base_color" value="{color(r)}"/>'
        return twosided(f'<bsdf type="{kind}">{paint}{number("roughness", r.uniform(0.1, 0.8))}{number("metallic", r.choice([0, 0, 1, 0.5]))}'
                        f'{number("specular", r.uniform(0, 1))}{number("clearcoat", r.choice([0, 0, 1]))}{number("sheen", r.choice([0, 0, 1]))}</bsdf>')
    if kind == "principledthin":
        return (f'<bsdf type="{kind}"><rgb name="base_color" value="{color(r)}"/>{number("roughness", r.uniform(0.2, 0.8))}'
                f'{number("spec_trans", r.choice([0, 0.5]))}{number("diff_trans", r.choice([0, 1, 2]))}</bsdf>')
    if kind == "mask":
        return f'<bsdf type="mask">{number("opacity", r.choice([0.3, 0.7]))}{material(r, True)}</bsdf>'
    if kind == "blend":
        return f'<bsdf type="blendbsdf">{number("weight", r.uniform(0.2, 0.8))}{material(r, True)}{material(r, True)}</bsdf>'
    return ('<bsdf type="bumpmap"><texture type="checkerboard" name="arbitrary"><rgb name="color0" value="0.1"/><rgb name="color1" value="0.4"/>'
            f'<transform name="to_uv"><scale value="6"/></transform></texture>{number("scale", 0.1)}{material(r, True)}</bsdf>')


def shape(kind, transform, inside):
    return f'<shape type="{kind}"><transform name="to_world">{transform}</transform>{inside}</shape>'


def emitter(r, kind):
    x, y, z = r.uniform(-2, 2), r.uniform(1.6, 2.7), r.uniform(-2, 2)
    at = f'<point name="position" x="{x:.2f}" y="{y:.2f}" z="{z:.2f}"/>'

    def area(low, high):
        return f'<emitter type="area"><rgb name="radiance" value="{color(r, low, high)}"/></emitter>'
    if kind == "rect":
        return shape("rectangle", f'<scale value="{r.uniform(0.2, 0.8):.2f}"/><rotate x="1" angle="90"/><translate x="{x:.2f}" y="2.95" z="{z:.2f}"/>', area(4, 12))
    if kind == "sphere":
        return shape("sphere", f'<scale value="{r.uniform(0.08, 0.3):.2f}"/><translate x="{x:.2f}" y="{y:.2f}" z="{z:.2f}"/>', '<bsdf type="diffuse"/>' + area(5, 30))
    if kind == "cylinder":
        return shape("cylinder", f'<scale x="0.05" y="0.05" z="1"/><translate x="{x:.2f}" y="{y:.2f}" z="-0.5"/>', '<bsdf type="diffuse"/>' + area(5, 30))
    if kind == "point":
        return f'<emitter type="point">{at}<rgb name="intensity" value="{color(r, 1, 5)}"/></emitter>'
    if kind == "spot":
        return (f'<emitter type="spot"><transform name="to_world"><lookat origin="{x:.2f}, {y:.2f}, {z:.2f}" target="0, 0, 0" up="0, 0, 1"/></transform>'
                f'<rgb name="intensity" value="{color(r, 5, 20)}"/>{number("cutoff_angle", r.choice([20, 40, 60]))}</emitter>')
    if kind == "env":
        return f'<emitter type="constant"><rgb name="radiance" value="{color(r, 0.2, 1.5)}"/></emitter>'
    return (f'<emitter type="directional"><vector name="direction" x="{r.uniform(-1, 1):.2f}" y="-1" z="{r.uniform(-1, 1):.2f}"/>'
            f'<rgb name="irradiance" value="{color(r, 2, 6)}"/></emitter>')


def scene(number_of_scene, emitters):
    r = random.Random(number_of_scene)
    inside = r.random() < 0.65
    eye, fov = f"{r.uniform(-1.5, 1.5):.2f}, {r.uniform(0.6, 2.2):.2f}, 2.6", r.choice([40, 60, 80])
    target = f"{r.uniform(-0.5, 0.5):.2f}, {r.uniform(0.3, 1.2):.2f}, -1"
    parts = ['<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="-1"/></integrator>'
             f'<sensor type="perspective">{number("fov", fov)}<transform name="to_world"><lookat origin="{eye}" target="{target}" up="0, 1, 0"/></transform>'
             '<film type="hdrfilm"><integer name="width" value="160"/><integer name="height" value="90"/><rfilter type="box"/></film></sensor>']

    def wall(transform):
        any_material = r.random() < 0.3
        parts.append(shape("rectangle", transform, material(r, True) if any_material else
                           twosided(f'<bsdf type="diffuse"><rgb name="reflectance" value="{color(r, 0.3, 0.8)}"/></bsdf>')))
    wall('<scale x="4" y="4"/><rotate x="1" angle="-90"/>')
    if inside:
        wall('<scale x="3" y="1.5"/><translate x="0" y="1.5" z="-3"/>')
        wall('<scale x="3" y="1.5"/><rotate y="1" angle="90"/><translate x="-3" y="1.5"/>')
        wall('<scale x="3" y="1.5"/><rotate y="1" angle="-90"/><translate x="3" y="1.5"/>')
        wall('<scale x="3" y="3"/><rotate x="1" angle="90"/><translate y="3"/>')
        if r.random() < 0.7:
            wall('<scale x="3" y="1.5"/><rotate y="1" angle="180"/><translate x="0" y="1.5" z="3"/>')
    for _ in range(r.randint(3, 8)):
        kind, size = r.choice(["sphere", "cube", "cube", "cylinder", "disk", "rectangle"]), r.uniform(0.15, 0.6)
        x, z, y = r.uniform(-1.8, 1.8), r.uniform(-2, 1), r.choice([size, size + r.uniform(0, 1.2)])
        if kind == "cube":
            form = (f'<scale x="{size:.3f}" y="{size * r.choice([1, 1, 0.05]):.3f}" z="{size * r.choice([1, 0.04, 0.5]):.3f}"/>'
                    f'<rotate y="1" angle="{r.randint(0, 180)}"/>')
        else:
            form = f'<scale value="{size:.3f}"/><rotate x="{r.uniform(0, 1):.1f}" y="1" z="{r.uniform(0, 1):.1f}" angle="{r.randint(0, 180)}"/>'
        parts.append(shape(kind, f'{form}<translate x="{x:.3f}" y="{y:.3f}" z="{z:.3f}"/>', material(r)))
    made = set()
    for _ in range(r.randint(1, 3)):
        kind = r.choice(emitters)
        if kind not in made:
            made.add(kind)
            parts.append(emitter(r, kind))
    return "\n".join(parts) + "\n</scene>\n"


def blocks(picture):
    h, w = picture.shape[0] // BLOCK, picture.shape[1] // BLOCK
    return picture[:BLOCK * h, :BLOCK * w].mean(2).reshape(h, BLOCK, w, BLOCK).mean((1, 3))


def compared(picture, references):
    one, two = (blocks(reference) for reference in references)
    truth = (one + two) / 2
    if not truth.mean() > 0:
        return "the reference is black"
    usual = truth + 0.1 * truth.mean()
    off, noise = (blocks(picture) - truth) / usual, np.abs(one - two) / 2 / usual
    bad = (np.abs(off) > 0.08) & (noise < np.abs(off) / 5)
    worst = np.unravel_index(np.abs(off * bad).argmax(), off.shape)
    text = f"mean {100 * (picture.mean() / truth.mean() - 1):+.2f} % (two references: {100 * abs(one.mean() - two.mean()) / truth.mean():.2f} %), {bad.sum()} of {bad.size} blocks"
    return text + (f", {100 * off[worst]:+.0f} % in row {worst[0]}, column {worst[1]}" if bad.any() else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--time", type=float, default=5)
    parser.add_argument("--area-lights", action="store_true", help="no points, spots and suns")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    args = parser.parse_args()
    for k in range(args.first, args.last + 1):
        folder = args.out / str(k)
        folder.mkdir(parents=True, exist_ok=True)
        file, picture, report = folder / "scene.xml", folder / "render.exr", folder / "render.json"
        file.write_text(scene(k, AREAS if args.area_lights else ALL))
        done = subprocess.run([args.program, "render", file, "-o", picture, "--time", str(args.time), "--denoise", "off", "--report", report, "--quiet"], capture_output=True, text=True)
        if done.returncode:
            print(f"{k:5d} {done.stderr.strip()}", flush=True)
            continue
        references = []
        for seed in ("1", "2"):
            references.append(folder / f"reference-{seed}.exr")
            subprocess.run([args.program, "reference", file, "-o", references[-1], "--time", str(args.time), "--seed", seed, "--quiet"], check=True)
        made = json.loads(report.read_text())
        print(f"{k:5d} {made['method']:19s} {made['seconds.total']:.1f} s, {compared(load(picture), [load(r) for r in references])}", flush=True)


if __name__ == "__main__":
    main()
