#!/usr/bin/env python3
"""Writes five scenes that are hard for virtual lights and that nobody tuned for (Mitsuba 3 XML and PLY).

    bench/strangers/make_hard_scenes.py OUT [atrium shades blinds mirror gloss]

  atrium  four stories of galleries around a court under a glazed roof: sun and sky come in from above
  shades  a living room at night: six lamps, each inside a shade that is open above and below
  blinds  a room behind a window with slats: stripes of sun on the floor, everything else by bounces
  mirror  a room whose light is seen and thrown by a large mirror, with a polished metal ball
  gloss   sharp gloss on floor, balls and crockery; one of its meshes has no usable triangle, another has many broken ones
"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from scene_parts import Scene, add, brushed, diffuse, rgb, ward, write_scenes  # noqa: E402


def room(wall, floor, ceiling, half, height, openings=()):
    """A box of inner half sizes (x, z); `openings` = (x0, x1, y0, y1) in the wall at -z."""
    x, z = half
    floor.patch((-x, 0, z), (2 * x, 0, 0), (0, 0, -2 * z), 4, 4)
    if ceiling is not None:
        ceiling.patch((-x, height, -z), (2 * x, 0, 0), (0, 0, 2 * z), 4, 4)
    wall.box((-x - 0.2, 0, -z - 0.2), (-x, height, z + 0.2))
    wall.box((x, 0, -z - 0.2), (x + 0.2, height, z + 0.2))
    wall.box((-x, 0, z), (x, height, z + 0.2))
    left = -x
    for x0, x1, y0, y1 in sorted(openings):
        wall.box((left, 0, -z - 0.2), (x0, height, -z))
        wall.box((x0, 0, -z - 0.2), (x1, y0, -z))
        wall.box((x0, y1, -z - 0.2), (x1, height, -z))
        left = x1
    wall.box((left, 0, -z - 0.2), (x, height, -z))


def furniture(rng, woods, cloths, around, count):
    for _ in range(count):
        at = (rng.uniform(-around[0], around[0]), 0, rng.uniform(-around[1], around[1]))
        w, h, d = rng.uniform(0.2, 0.5), rng.uniform(0.3, 0.9), rng.uniform(0.2, 0.5)
        rng.choice(woods).box(add(at, (-w, 0, -d)), add(at, (w, h, d)), 0.02, 0, rng.uniform(0, 90))
        rng.choice(cloths).sphere(add(at, (0, h + 0.15, 0)), 0.15, 24)


def atrium(out):
    rng = random.Random(1)
    scene = Scene("Four stories around a court under a roof of glass.", ((2.9, 1.7, 9.2), (-1.2, 5.2, -3)), 74, (640, 360))
    stone, floor = scene.material("stone", diffuse((0.7, 0.68, 0.63))), scene.material("floor", diffuse((0.45, 0.42, 0.4)))
    rails, woods = scene.material("rails", diffuse((0.2, 0.2, 0.22))), [scene.material("wood", diffuse((0.4, 0.25, 0.13)))]
    cloths = [scene.material("red", diffuse((0.6, 0.08, 0.06))), scene.material("green", diffuse((0.12, 0.4, 0.15)))]
    x, z, story = 7.0, 10.0, 3.6
    room(stone, floor, None, (x, z), 4 * story)
    for s in range(1, 4):
        y = story * s
        for lo, hi in (((-x, -z), (-4, z)), ((4, -z), (x, z)), ((-4, -z), (4, -6.5)), ((-4, 6.5), (4, z))):
            stone.box((lo[0], y - 0.3, lo[1]), (hi[0], y, hi[1]))
        for side in (-4.0, 4.0):
            rails.box((side - 0.03, y + 0.9, -6.5), (side + 0.03, y + 0.96, 6.5))
            for k in range(40):
                rails.box((side - 0.012, y, -6.5 + 13 * k / 39 - 0.012), (side + 0.012, y + 0.9, -6.5 + 13 * k / 39 + 0.012))
        for cx in (-4.0, 4.0):
            for k in range(5):
                cz = -6.5 + 13 * k / 4
                stone.revolve((cx, y - story, cz), [(0.22, 0), (0.2, 0.2), (0.18, story - 0.3)], 20, 2)
    for k in range(9):  # beams of the roof
        zz = -z + 2 * z * k / 8
        rails.box((-x, 4 * story, zz - 0.08), (x, 4 * story + 0.3, zz + 0.08))
    for k in range(6):
        xx = -x + 2 * x * k / 5
        rails.box((xx - 0.05, 4 * story, -z), (xx + 0.05, 4 * story + 0.2, z))
    furniture(rng, woods, cloths, (3.2, 5.5), 14)
    scene.sun_and_sky((0.35, 0.85, 0.2), 1)
    return scene, out / "atrium"


def shades(out):
    rng = random.Random(2)
    scene = Scene("Six lamps behind shades.", ((3.6, 1.6, 3.3), (-1.2, 1.0, -1.0)), 68, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.72, 0.7, 0.64))), scene.material("floor", diffuse((0.35, 0.22, 0.12)))
    ceiling, cover = scene.material("ceiling", diffuse((0.8, 0.8, 0.78))), scene.material("cover", diffuse((0.5, 0.42, 0.3)))
    woods, cloths = [scene.material("wood", diffuse((0.3, 0.17, 0.08)))], [scene.material("blue", diffuse((0.1, 0.16, 0.45)))]
    brass = scene.material("brass", brushed("Cu", 0.25, 0.25))
    room(wall, floor, ceiling, (4.0, 3.6), 2.7)
    for k in range(6):
        a = 2 * math.pi * k / 6 + 0.3
        at = (3.1 * math.cos(a), 0, 2.7 * math.sin(a))
        height = 1.5 if k % 2 else 0.9
        brass.tube([at, add(at, (0, height, 0))], 0.015, 10)
        brass.revolve(at, [(0.16, 0.0), (0.15, 0.02), (0.02, 0.04)], 24, 2)
        cover.revolve(add(at, (0, height - 0.12, 0)), [(0.2, 0), (0.13, 0.3)], 32, 2)
        scene.lamp(add(at, (0, height, 0)), (0.03, 0, 0), (0, 0, -0.03), (900, 700, 420))
        scene.lamp(add(at, (0, height + 0.05, 0)), (0.03, 0, 0), (0, 0, 0.03), (900, 700, 420))
    furniture(rng, woods, cloths, (2.0, 1.6), 6)
    return scene, out / "shades"


def blinds(out):
    rng = random.Random(3)
    scene = Scene("Sun through the slats of a blind.", ((2.6, 1.5, 2.4), (-0.9, 1.0, -1.6)), 66, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.75, 0.73, 0.7))), scene.material("floor", diffuse((0.42, 0.28, 0.16)))
    ceiling, slats = scene.material("ceiling", diffuse((0.82, 0.82, 0.82))), scene.material("slats", diffuse((0.65, 0.63, 0.58)))
    woods, cloths = [scene.material("wood", diffuse((0.35, 0.2, 0.1)))], [scene.material("orange", diffuse((0.7, 0.3, 0.05)))]
    room(wall, floor, ceiling, (3.0, 2.6), 2.7, [(-1.8, 1.2, 0.8, 2.3)])
    for k in range(26):
        y = 0.8 + 1.5 * (k + 0.5) / 26
        slats.patch((-1.8, y + 0.006, -2.62), (3.0, 0, 0), (0, -0.012, 0.04))
        slats.patch((-1.8, y + 0.006, -2.62), (0, -0.012, 0.04), (3.0, 0, 0))
    furniture(rng, woods, cloths, (1.8, 1.4), 7)
    scene.sun_and_sky((0.25, 0.6, -0.75), 1)
    return scene, out / "blinds"


def mirror(out):
    rng = random.Random(4)
    scene = Scene("A large mirror and a polished ball.", ((2.9, 1.5, 2.7), (-0.8, 1.1, -1.2)), 66, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.7, 0.7, 0.72))), scene.material("floor", diffuse((0.4, 0.35, 0.3)))
    ceiling, frame = scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), scene.material("frame", diffuse((0.3, 0.2, 0.08)))
    glass = scene.material("mirror", '<bsdf type="conductor"><string name="material" value="Ag"/></bsdf>')
    woods, cloths = [scene.material("wood", diffuse((0.35, 0.22, 0.12)))], [scene.material("red", diffuse((0.6, 0.1, 0.08)))]
    room(wall, floor, ceiling, (3.2, 3.0), 2.8)
    glass.patch((-3.17, 0.5, 1.6), (0, 0, -3.2), (0, 1.9, 0))
    for a, b in (((-3.2, 0.4, -1.7), (-3.12, 0.5, 1.7)), ((-3.2, 2.4, -1.7), (-3.12, 2.5, 1.7)), ((-3.2, 0.4, -1.7), (-3.12, 2.5, -1.6)), ((-3.2, 0.4, 1.6), (-3.12, 2.5, 1.7))):
        frame.box(a, b, 0.01)
    glass.sphere((0.4, 0.4, 0.2), 0.4, 64)
    furniture(rng, woods, cloths, (2.0, 1.6), 6)
    # A wall washer that shines at the mirror: much of the room's light comes off it.
    frame.box((-1.5, 2.3, -2.95), (1.5, 2.34, -2.6))
    scene.lamp((0.6, 2.3, 0.0), (0, 0, 0.18), (-0.05, 0.15, 0), (90, 82, 72))
    scene.lamp((1.8, 2.75, 1.8), (0.3, 0, 0), (0, 0, 0.3), (6, 5.6, 5))
    return scene, out / "mirror"


def gloss(out):
    rng = random.Random(5)
    scene = Scene("Sharp gloss, and meshes that are broken.", ((2.4, 1.6, 2.6), (-0.4, 0.7, -0.8)), 62, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.68, 0.66, 0.6))), scene.material("floor", ward((0.25, 0.2, 0.16), (0.35, 0.35, 0.35), 0.04))
    ceiling = scene.material("ceiling", diffuse((0.8, 0.8, 0.8)))
    metals = [scene.material("steel", brushed("Cr", 0.05, 0.05)), scene.material("gold", brushed("Au", 0.1, 0.1)), scene.material("pan", brushed("Al", 0.03, 0.2))]
    china = scene.material("china", '<bsdf type="roughplastic"><float name="alpha" value="0.04"/>' + rgb("diffuse_reflectance", (0.6, 0.6, 0.62)) + "</bsdf>")
    broken, dust = scene.material("broken", diffuse((0.5, 0.1, 0.1))), scene.material("dust", diffuse((0.5, 0.5, 0.5)))
    room(wall, floor, ceiling, (2.8, 2.8), 2.6, [(-1.6, 0.4, 0.9, 2.2)])
    china.box((-1.2, 0, -1.4), (1.2, 0.75, -0.4), 0.03)
    for k in range(14):
        at = (rng.uniform(-1.1, 1.1), 0.75, rng.uniform(-1.3, -0.5))
        if k % 3:
            r = rng.uniform(0.06, 0.13)
            metals[k % 3].sphere(add(at, (0, r, 0)), r, 40)
        else:
            china.revolve(at, [(0.05, 0), (0.06, 0.02), (0.1, 0.12), (0.12, 0.16)], 32, 3)
    metals[0].sphere((-1.6, 0.45, 0.3), 0.45, 64)
    metals[1].sphere((1.4, 0.3, 0.2), 0.3, 64)
    # Nothing but triangles without area; and a ball of which every third triangle is one.
    dust.vertices += [(0.01 * k, 0.0, 0.0, 0, 1, 0, 0, 0) for k in range(30)]
    dust.triangles += [(k, k + 1, k + 2) for k in range(28)] + [(4, 4, 4)]
    broken.sphere((0.2, 0.25, 1.0), 0.25, 32)
    broken.triangles = [(t[0], t[0], t[1]) if k % 3 == 0 else t for k, t in enumerate(broken.triangles)]
    scene.sun_and_sky((-0.3, 0.5, -0.8), 1)
    scene.lamp((1.2, 2.55, 1.0), (0.25, 0, 0), (0, 0, 0.25), (9, 8.5, 8))
    return scene, out / "gloss"


SCENES = {"atrium": atrium, "shades": shades, "blinds": blinds, "mirror": mirror, "gloss": gloss}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES)
