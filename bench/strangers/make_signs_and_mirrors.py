#!/usr/bin/env python3
"""Writes four more scenes that nobody tuned for (Mitsuba 3 XML, PLY and PNG): light from pictures, and light by way of mirrors.

    bench/strangers/make_signs_and_mirrors.py OUT [neon mirrors flashlight office]

  neon        a bent tube of light, and signs whose pictures are mostly dark, over a polished floor
  mirrors     a room of mirrors with a lamp, a glass ball, and things to be mirrored
  flashlight  a narrow beam in a dark hall, which everything else is lit by
  office      panels of light over desks, seen through panes, with a band of windows
"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_hard_scenes import room  # noqa: E402
from make_lamps_and_glass import gloss, write_png  # noqa: E402
from make_small_and_colored import BITMAP, RAW, folder_of  # noqa: E402
from scene_parts import Scene, diffuse, rgb, write_scenes  # noqa: E402

MIRROR = '<bsdf type="conductor"><string name="material" value="Ag"/></bsdf>'


def shining(radiance):
    return '<emitter type="area">' + rgb("radiance", radiance) + "</emitter>"


def neon(out):
    rng, folder = random.Random(3), folder_of(out, "neon")
    scene = Scene("A tube of light and two dark signs.", ((0, 1.5, 3.4), (0, 1.2, -3)), 70, (640, 360))
    walls, floor, crates = scene.material("walls", diffuse((0.25, 0.25, 0.28))), scene.material("floor", gloss((0.05, 0.05, 0.06), 0.06)), scene.material("crates", gloss((0.3, 0.3, 0.35), 0.1))
    room(walls, floor, walls, (4.5, 4), 4)
    tube = scene.single("tube", diffuse((0.5, 0.5, 0.5)), shining((1.5, 0.25, 0.75)))
    turns = [6 * math.pi * k / 999 for k in range(1000)]
    tube.tube([(2.2 * math.sin(0.37 * t) + 0.2 * math.sin(5 * t), 1.6 + 0.9 * math.cos(0.61 * t), -3.4 - 0.05 * math.cos(3 * t)) for t in turns], 0.02, 24)
    picture = [[(0, 0, 0)] * 512 for _ in range(128)]
    for _ in range(14):
        x, y, w, h = rng.randrange(480), rng.randrange(5, 100), rng.randrange(5, 30), rng.randrange(3, 20)
        color = (rng.randrange(190), rng.randrange(90), rng.randrange(256))
        for row in picture[y:y + h]:
            row[x:x + w] = [color] * w
    write_png(folder / "sign.png", picture)
    for x, turn in ((-4.3, 90), (4.3, -90)):
        scene.emitters.append(f'<shape type="rectangle"><transform name="to_world"><scale x="1.6" y="0.4"/><rotate y="1" angle="{turn}"/><translate x="{x}" y="2" z="-1"/></transform>' +
                              diffuse((0.1, 0.1, 0.1)) + '<emitter type="area">' + BITMAP.format("radiance", "sign.png", RAW) + "</emitter></shape>")
    for k in range(5):
        x, z = -3 + 1.5 * k, -1.5 - 0.4 * (k % 2)
        crates.box((x - 0.3, 0, z - 0.3), (x + 0.3, 1 + 0.3 * (k % 3), z + 0.3), 0, 0, 17 * k)
    return scene, folder


def mirrors(out):
    scene = Scene("A room of mirrors.", ((-1.8, 1.6, 1.8), (1, 1, -1)), 75, (640, 360), 17)
    glass, floor = scene.material("mirror", MIRROR), scene.material("floor", diffuse((0.35, 0.25, 0.18)))
    room(glass, floor, glass, (2.5, 2.5), 2.6)
    red, green = scene.material("red", gloss((0.6, 0.15, 0.1), 0.1)), scene.material("green", diffuse((0.2, 0.5, 0.3)))
    red.box((0.2, 0, -0.6), (1, 1, 0.2), 0, 0, 25)
    green.sphere((-0.6, 0.5, -0.9), 0.5, 48)
    scene.single("ball", '<bsdf type="dielectric"/>').sphere((1.3, 0.35, 1.0), 0.35, 64)
    scene.lamp((0, 2.56, 0), (0.35, 0, 0), (0, 0, 0.35), (14, 13, 11))
    return scene, out / "mirrors"


def flashlight(out):
    rng = random.Random(4)
    scene = Scene("A narrow beam in a dark hall.", ((-6, 1.7, 6), (2, 1.8, -3)), 65, (640, 360))
    walls, floor = scene.material("walls", diffuse((0.75, 0.72, 0.68))), scene.material("floor", diffuse((0.35, 0.25, 0.18)))
    room(walls, floor, walls, (8, 8), 6)
    for k in range(14):
        x, z, w, d = rng.uniform(-6, 6), rng.uniform(-7, 4), rng.uniform(0.2, 0.75), rng.uniform(0.2, 0.75)
        scene.material(f"block{k}", gloss([rng.uniform(0.1, 0.8) for _ in range(3)], 0.1)).box((x - w, 0, z - d), (x + w, rng.uniform(1.3, 2.3), z + d), 0, 0, rng.uniform(0, 90))
    scene.material("mirror", MIRROR).patch((2, 0.6, -7.9), (2.4, 0, 0), (0, 2, 0))
    scene.spot((-5.5, 1.3, 5.8), (3, 0.8, -6.5), (600, 560, 480), 9, 6)
    return scene, out / "flashlight"


def office(out):
    scene = Scene("Panels of light over desks.", ((-9, 1.7, 7), (4, 1, -5)), 70, (640, 360))
    walls, floor = scene.material("walls", diffuse((0.75, 0.72, 0.68))), scene.material("floor", gloss((0.3, 0.3, 0.32), 0.2))
    room(walls, floor, walls, (11, 8), 3, [(-9, 9, 0.8, 2.6)])
    tops, legs, screens = scene.material("tops", gloss((0.6, 0.5, 0.4), 0.1)), scene.material("legs", diffuse((0.5, 0.5, 0.5))), scene.material("screens", gloss((0.02, 0.02, 0.02), 0.1))
    for i in range(8):
        for j in range(6):
            scene.lamp((-9 + 2.6 * i, 2.98, 6.5 - 2.6 * j), (0.3, 0, 0), (0, 0, 0.6), (9, 9.3, 10))
    for i in range(7):
        for j in range(5):
            x, z = -8 + 2.6 * i, 5 - 2.6 * j
            tops.box((x - 0.7, 0.72, z - 0.35), (x + 0.7, 0.76, z + 0.35))
            screens.box((x - 0.25, 0.79, z - 0.32), (x + 0.25, 1.11, z - 0.28))
            for side in (-0.6, 0.6):
                legs.box((x + side - 0.025, 0, z - 0.3), (x + side + 0.025, 0.72, z + 0.3))
    pane = scene.single("pane", '<bsdf type="thindielectric"/>')
    for x in (-4.2, 1, 6.2):
        pane.patch((x, 0, 5), (0, 2.8, 0), (0, 0, -12))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.8, 1, 1.4)) + "</emitter>")
    return scene, out / "office"


if __name__ == "__main__":
    write_scenes(__doc__, {"neon": neon, "mirrors": mirrors, "flashlight": flashlight, "office": office})
