#!/usr/bin/env python3
"""Scenes (Mitsuba 3 XML) in which glass, water, fog or a lamp ends in the very plane of something else, and the same a little apart or a little larger, which is what they should look like.

    bench/strangers/make_touching.py OUT [--program PATH] [--paths 400]

A line for each: the mean of `lumirank reference` and that of its middle, of the scene that touches and of its twin.

  block     a block of glass on a floor; apart it shows that floor by way of a gap, in which light is reflected, so the two differ
  thin      a box of thin panes on a floor; apart there is one pane more between the floor and the eye
  fog       a room filled with fog by a box of the room's size
  water     a basin filled with water by a block of the basin's size
  glass     a glass vessel filled with water by a block of its inside's size; also with a third twin, whose water borders on glass by definition (ext_ior)
  wine      the same with colored water
  ceiling, panel, screen  a lamp flush with the ceiling, one sunk into it, and one on a wall, and each a little before it
"""
import argparse
import pathlib
import re
import subprocess

import numpy as np
from compare_blocks import load

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE = (120, 90)
LAMP = '<emitter type="area"><rgb name="radiance" value="8, 8, 8"/></emitter>'
GLASS = '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf>'
WATER = '<bsdf type="dielectric"><float name="int_ior" value="1.33"/></bsdf>'


def twosided(color):
    return f'<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{color}"/></bsdf></bsdf>'


def shape(kind, transform, inside):
    return f'<shape type="{kind}"><transform name="to_world">{transform}</transform>{inside}</shape>'


def scene(origin, target, parts, fov=40, sensor="", integrator="path"):
    return (f'<scene version="3.0.0"><integrator type="{integrator}"><integer name="max_depth" value="-1"/></integrator>\n{parts[0]}\n'
            f'<sensor type="perspective"><float name="fov" value="{fov}"/><transform name="to_world"><lookat origin="{origin}" target="{target}" up="0, 1, 0"/></transform>{sensor}'
            f'<film type="hdrfilm"><integer name="width" value="{SIZE[0]}"/><integer name="height" value="{SIZE[1]}"/><rfilter type="box"/></film></sensor>\n' + "\n".join(parts[1:]) + "\n</scene>\n")


def on_floor(bsdf, gap):
    return scene("0.3, 2.5, 4", "0, 0.3, 0", [
        shape("cube", f'<scale value="0.571"/><rotate y="1" angle="30"/><translate y="{0.571 + gap}"/>', bsdf),
        shape("rectangle", '<scale x="4" y="4"/><rotate x="1" angle="-90"/>', twosided("0.6, 0.6, 0.6")),
        shape("rectangle", '<scale value="1.5"/><rotate x="1" angle="90"/><translate y="4"/>', LAMP),
        '<emitter type="constant"><rgb name="radiance" value="0.3, 0.3, 0.3"/></emitter>'])


def room(lamp=True):
    gray = twosided("0.6, 0.6, 0.6")
    return [shape("rectangle", '<rotate x="1" angle="-90"/><translate y="-1"/>', gray), shape("rectangle", '<rotate x="1" angle="90"/><translate y="1"/>', gray),
            shape("rectangle", '<translate z="-1"/>', gray), shape("rectangle", '<rotate y="1" angle="180"/><translate z="1"/>', gray),
            shape("rectangle", '<rotate y="1" angle="90"/><translate x="-1"/>', twosided("0.7, 0.2, 0.2")),
            shape("rectangle", '<rotate y="1" angle="-90"/><translate x="1"/>', twosided("0.2, 0.7, 0.2")),
            *([shape("rectangle", '<scale value="0.3"/><rotate x="1" angle="90"/><translate y="0.98"/>', LAMP)] if lamp else [])]


def lit_by(kind, transform):
    lamp = '<emitter type="area"><rgb name="radiance" value="3, 3, 3"/></emitter>'
    return scene("0, 0, 0.95", "0, 0.1, -1", [shape(kind, transform, lamp), *room(False)], 80)


def flush(apart):
    return {"ceiling": lit_by("rectangle", f'<scale value="0.6"/><rotate x="1" angle="90"/><translate y="{1 - apart}"/>'),
            "panel": lit_by("cube", f'<scale x="0.6" y="0.05" z="0.6"/><translate y="{1.05 - apart}"/>'),
            "screen": lit_by("rectangle", f'<scale value="0.6"/><translate z="{-1 + apart}"/>')}


def fog(more):
    medium = '<medium name="interior" type="homogeneous" id="fog"><float name="sigma_t" value="0.3"/><rgb name="albedo" value="0.9, 0.9, 0.9"/></medium>'
    box = shape("cube", f'<scale value="{1 + more}"/>', f'<bsdf type="null"/>{medium}')
    return scene("0, 0, 0.95", "0, 0, -1", [box, *room()], 80, '<ref name="medium" id="fog"/>', "volpath")


def basin(more):
    water = shape("cube", f'<scale x="{1 + more}" y="{0.5 + more}" z="{1 + more}"/><translate y="-0.5"/>', WATER)
    return scene("0, 0.7, 0.95", "0, -0.4, -0.5", [water, *room()], 80)


def write_vessel(file):
    corners = [((k & 1) * 2 - 1, (k >> 1 & 1) * 2 - 1, (k >> 2 & 1) * 2 - 1) for k in range(8)]
    order = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5]
    lines = [f"v {x * s} {y * s} {z * s}" for s in (0.5, 0.425) for x, y, z in corners]
    for a, b, c in zip(*[iter(order)] * 3):
        lines += [f"f {a + 1} {b + 1} {c + 1}", f"f {a + 9} {c + 9} {b + 9}"]
    file.write_text("\n".join(lines) + "\n")


def filled(more, colored):
    medium = '<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.3, 2, 3"/><float name="albedo" value="0"/></medium>' if colored else ""
    floor = '<bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><transform name="to_uv"><scale value="20"/></transform></texture></bsdf></bsdf>'
    at = '<translate y="0.51"/>'
    return scene("0.9, 1.0, 2.4", "0, 0.45, 0", [
        shape("cube", f'<scale value="{0.425 * (1 + more)}"/>{at}', WATER + medium),
        shape("rectangle", '<scale x="4" y="4"/><rotate x="1" angle="-90"/>', floor),
        shape("obj", at, f'<string name="filename" value="vessel.obj"/><boolean name="face_normals" value="true"/>{GLASS}'),
        '<emitter type="constant"><rgb name="radiance" value="1, 1, 1"/></emitter>'], 35, "", "volpath" if colored else "path")


def bordering():
    solid = shape("cube", '<scale value="0.5"/><translate y="0.51"/>', GLASS)
    text = re.sub(r'<shape type="obj">.*?</shape>', solid, filled(0, False))
    return text.replace('value="1.33"/>', 'value="1.33"/><float name="ext_ior" value="1.5"/>')


SCENES = {"block": [on_floor(GLASS, 0), on_floor(GLASS, 0.002)], "thin": [on_floor('<bsdf type="thindielectric"/>', 0), on_floor('<bsdf type="thindielectric"/>', 0.002)],
          "fog": [fog(0), fog(0.002)], "water": [basin(0), basin(0.002)], "glass": [filled(0, False), filled(0.001, False), bordering()],
          "wine": [filled(0, True), filled(0.001, True)], **{name: [flush(0)[name], flush(0.002)[name]] for name in ("ceiling", "panel", "screen")}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    parser.add_argument("--paths", type=int, default=400)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    write_vessel(args.out / "vessel.obj")
    for name, twins in SCENES.items():
        said = []
        for k, text in enumerate(twins):
            file, picture = args.out / f"{name}{k}.xml", args.out / f"{name}{k}.exr"
            file.write_text(text)
            subprocess.run([args.program, "reference", file, "-o", picture, "--spp", str(args.paths), "--quiet"], check=True)
            seen = load(picture)
            said.append(f"{seen.mean():.4f}, {seen[30:62, 45:75].mean():.4f}")
        print(f"{name:6s} {'; '.join(said)}", flush=True)


if __name__ == "__main__":
    main()
