#!/usr/bin/env python3
"""Writes six more scenes that nobody tuned for (Mitsuba 3 XML, PLY and PNG): many small lights, colored glass, bumps, and great contrast.

    bench/strangers/make_small_and_colored.py OUT [chapel wall workshop vitrines lanterns arch]

  chapel    sun and sky through tall windows of colored panes
  wall      a screen as large as a wall, of small bright dots, over a polished floor
  workshop  bumps on metal and tiles under bare lamps, one of them behind a thin sheet of plastic
  vitrines  objects in cases of thin glass, under a grid of spots
  lanterns  two hundred lanterns in trees of cut-out leaves at night
  arch      out of a dark vault into a court at noon
"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_hard_scenes import furniture, room  # noqa: E402
from make_lamps_and_glass import gloss, write_png  # noqa: E402
from scene_parts import Scene, add, brushed, diffuse, number, rgb, write_scenes  # noqa: E402

BITMAP = '<texture name="{0}" type="bitmap"><string name="filename" value="{1}"/>{2}</texture>'
RAW = '<boolean name="raw" value="true"/>'


def folder_of(out, name):
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def chapel(out):
    rng = random.Random(21)
    scene = Scene("Colored windows in the sun.", ((0.6, 1.7, 8.2), (-0.3, 3.0, -4)), 62, (640, 360))
    stone, floor = scene.material("stone", diffuse((0.55, 0.52, 0.46))), scene.material("floor", gloss((0.3, 0.27, 0.24), 0.12))
    wood = scene.material("wood", diffuse((0.22, 0.12, 0.06)))
    floor.patch((-3.5, 0, 9), (7, 0, 0), (0, 0, -18), 4, 4)
    stone.patch((-3.5, 8, -9), (7, 0, 0), (0, 0, 18), 4, 4)
    for z in (-9.3, 9.0):
        stone.box((-3.8, 0, z), (3.8, 8, z + 0.3))
    for side in (-1, 1):
        x0, x1 = (-3.8, -3.5) if side < 0 else (3.5, 3.8)
        stone.box((x0, 0, -9), (x1, 2.0, 9))
        stone.box((x0, 6.5, -9), (x1, 8, 9))
        for k in range(7):
            z = -9 + 3 * k
            stone.box((x0, 2.0, z - 0.8), (x1, 6.5, z + 0.8))
        for k in range(6):
            stone.revolve((side * 2.9, 0, -7.5 + 3 * k), [(0.28, 0), (0.28, 0.0), (0.22, 0.3), (0.2, 5.5), (0.3, 8)], 24, 2)
    for k, color in enumerate(((0.9, 0.1, 0.06), (0.08, 0.25, 0.9), (0.95, 0.7, 0.1), (0.1, 0.6, 0.2))):
        panes = scene.single(f"pane{k}", '<bsdf type="thindielectric">' + rgb("specular_transmittance", color) + "</bsdf>")
        for side in (-1, 1):
            for window in range(6):
                for row in range(9):
                    if (row + window + (row * 7 + window * 3) % 5) % 4 == k:
                        y, z = 2.0 + 0.5 * row, -8.2 + 3 * window
                        panes.patch((side * 3.6, y, z), (0, 0.5, 0), (0, 0, 1.4))
    for k in range(6):
        for x in (-1.9, 0.5):
            wood.box((x, 0.4, -5 + 1.7 * k), (x + 1.4, 0.45, -4.6 + 1.7 * k), 0.01)
            wood.box((x, 0, -5.0 + 1.7 * k), (x + 1.4, 0.9, -4.95 + 1.7 * k), 0.01)
    furniture(rng, [wood], [scene.material("red", diffuse((0.5, 0.06, 0.05)))], (1.2, 0.8), 2)
    scene.sun_and_sky((0.8, 0.62, 0.15), 1)
    return scene, out / "chapel"


def wall(out):
    rng = random.Random(22)
    folder = folder_of(out, "wall")
    scene = Scene("A wall of small bright dots.", ((3.2, 1.6, 4.2), (-0.3, 1.2, -2)), 64, (640, 360))
    side, floor = scene.material("side", diffuse((0.3, 0.3, 0.32))), scene.material("floor", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.06, 0.06, 0.07)) + "</bsdf>")
    ceiling, chrome = scene.material("ceiling", diffuse((0.2, 0.2, 0.2))), scene.material("chrome", brushed("Cr", 0.08, 0.08))
    room(side, floor, ceiling, (4, 4.5), 3.4)
    furniture(rng, [scene.material("wood", diffuse((0.4, 0.25, 0.13)))], [scene.material("white", gloss((0.6, 0.6, 0.6), 0.1))], (2.2, 1.5), 7)
    for k in range(3):
        chrome.sphere((-1.6 + 1.5 * k, 0.35, 1.2 - 0.5 * k), 0.35, 48)
    picture = [[(0, 0, 0)] * 512 for _ in range(256)]
    for y in range(4, 256, 8):
        for x in range(4, 512, 8):
            wave = 0.5 + 0.5 * math.sin(0.02 * x + 0.05 * y)
            color = tuple(round(255 * c) for c in ((wave, 0.2, 1 - wave) if rng.random() < 0.4 else (0.02, 0.02, 0.02)))
            for v in range(2):
                for u in range(2):
                    picture[y + v][x + u] = color
    write_png(folder / "dots.png", picture)
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><scale x="3.4" y="1.5"/><translate x="0" y="1.7" z="-4.45"/></transform>' + diffuse((0, 0, 0)) +
                          '<emitter type="area">' + BITMAP.format("radiance", "dots.png", RAW) + "</emitter></shape>")
    return scene, folder


def workshop(out):
    rng = random.Random(23)
    folder = folder_of(out, "workshop")
    scene = Scene("Bumps under bare lamps.", ((2.6, 1.7, 2.9), (-0.6, 0.8, -1.2)), 60, (640, 360))
    write_png(folder / "bumps.png", [[(round(127 + 90 * math.sin(x * 0.4) * math.sin(y * 0.4) + rng.uniform(-30, 30)),) * 3 for x in range(128)] for y in range(128)])

    def normal(x, y):
        edge = x % 32 < 2 or y % 32 < 2
        nx, ny = (rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4)) if edge else (0.06 * math.sin(x), 0.06 * math.cos(y))
        return tuple(round(127.5 * (c + 1)) for c in (nx, ny, math.sqrt(1 - nx * nx - ny * ny)))
    write_png(folder / "tiles.png", [[normal(x, y) for x in range(128)] for y in range(128)])
    bumpy = '<bsdf type="bumpmap">' + BITMAP.format("arbitrary", "bumps.png", RAW) + number("scale", 0.02) + brushed("Al", 0.15, 0.15) + "</bsdf>"
    tiles = '<bsdf type="normalmap">' + BITMAP.format("normalmap", "tiles.png", RAW) + gloss((0.5, 0.48, 0.42), 0.1) + "</bsdf>"
    walls, floor = scene.material("walls", diffuse((0.6, 0.62, 0.6))), scene.material("floor", tiles)
    ceiling, tin = scene.material("ceiling", diffuse((0.75, 0.75, 0.75))), scene.material("tin", bumpy)
    room(walls, floor, ceiling, (3.1, 3.1), 2.8)
    for k in range(5):
        tin.revolve((-1.6 + 0.8 * k, 0, -1.4 + 0.3 * (k % 2)), [(0, 0), (0.28, 0), (0.28, 0), (0.28, 0.7), (0.28, 0.7), (0, 0.7)], 40, 3)
    tin.box((-2.2, 0.9, -3.0), (2.2, 2.0, -2.95))
    furniture(rng, [scene.material("wood", diffuse((0.35, 0.22, 0.1)))], [scene.material("green", diffuse((0.1, 0.4, 0.15)))], (1.8, 1.2), 5)
    scene.emitters.append('<emitter type="point"><point name="position" x="0.9" y="2.3" z="0.4"/>' + rgb("intensity", (14, 12, 9)) + "</emitter>")
    scene.lamp((-1.4, 2.6, 0.4), (0.06, 0, 0), (0, 0, 0.06), (420, 400, 380))
    sheet = scene.single("sheet", '<bsdf type="roughdielectric"><float name="alpha" value="0.3"/><float name="int_ior" value="1.49"/></bsdf>')
    sheet.box((-1.75, 2.44, 0.05), (-1.05, 2.45, 0.75))
    return scene, folder


def vitrines(out):
    rng = random.Random(24)
    scene = Scene("Cases of thin glass under spots.", ((3.4, 1.6, 3.8), (-0.6, 1.0, -1.6)), 60, (640, 360))
    walls, floor = scene.material("walls", diffuse((0.35, 0.36, 0.4))), scene.material("floor", gloss((0.22, 0.16, 0.1), 0.15))
    ceiling, base = scene.material("ceiling", diffuse((0.25, 0.25, 0.25))), scene.material("base", diffuse((0.7, 0.7, 0.68)))
    room(walls, floor, ceiling, (4, 4), 3.2)
    thin = scene.single("thin", '<bsdf type="thindielectric"/>')
    things = [scene.material("gold", brushed("Au", 0.12, 0.12)), scene.material("clay", diffuse((0.5, 0.2, 0.1))), scene.material("china", gloss((0.55, 0.6, 0.65), 0.05))]
    for k in range(9):
        at = (-2.6 + 1.5 * (k % 3), 0, -2.6 + 1.6 * (k // 3))
        base.box(add(at, (-0.35, 0, -0.35)), add(at, (0.35, 0.9, 0.35)), 0.01)
        lo, hi = add(at, (-0.34, 0.9, -0.34)), add(at, (0.34, 1.6, 0.34))
        for corner, u, v in (((lo[0], lo[1], lo[2]), (0.68, 0, 0), (0, 0.7, 0)), ((lo[0], lo[1], hi[2]), (0.68, 0, 0), (0, 0.7, 0)),
                             ((lo[0], lo[1], lo[2]), (0, 0, 0.68), (0, 0.7, 0)), ((hi[0], lo[1], lo[2]), (0, 0, 0.68), (0, 0.7, 0)),
                             ((lo[0], hi[1], lo[2]), (0.68, 0, 0), (0, 0, 0.68))):
            thin.patch(corner, u, v)
        thing = things[k % 3]
        thing.revolve(add(at, (0, 0.9, 0)), [(0.0, 0), (0.12, 0), (0.08 + 0.1 * rng.random(), 0.15), (0.05 + 0.1 * rng.random(), 0.3), (0.1, 0.4), (0.02, 0.42)], 40, 4)
        scene.spot(add(at, (0.3, 3.1, 0.4)), add(at, (0, 1.0, 0)), (30, 28, 24), 22, 12)
    return scene, out / "vitrines"


def lanterns(out):
    rng = random.Random(25)
    folder = folder_of(out, "lanterns")
    scene = Scene("Lanterns in trees at night.", ((4.5, 1.7, 7.5), (-0.5, 2.0, -2)), 58, (640, 360))
    leaf = [[255 if (x - 32) ** 2 / 200 + (y - 32) ** 2 / 900 < 1 else 0 for x in range(64)] for y in range(64)]
    write_png(folder / "leaf.png", [[(v, v, v) for v in row] for row in leaf])
    ground, bark = scene.material("ground", diffuse((0.2, 0.22, 0.12))), scene.material("bark", diffuse((0.2, 0.14, 0.09)))
    stone = scene.material("stone", diffuse((0.5, 0.48, 0.45)))
    leaves = scene.single("leaves", '<bsdf type="mask">' + BITMAP.format("opacity", "leaf.png", RAW) + '<bsdf type="twosided">' + diffuse((0.18, 0.4, 0.1)) + "</bsdf></bsdf>")
    ground.patch((-25, 0, 25), (50, 0, 0), (0, 0, -50), 2, 2)
    stone.box((-1.2, 0.0, -9), (1.2, 0.03, 9))
    stone.box((-8, 0, -9.5), (8, 4, -9))
    for tree in range(8):
        at = (-4.5 if tree % 2 else 3.0, 0, -7.5 + 3.2 * (tree // 2))
        bark.tube([at, add(at, (0.1, 1.8, 0.05)), add(at, (0, 3.4, 0.1))], [0.18, 0.13, 0.07], 10)
        for _ in range(260):
            a, b, r = rng.uniform(0, 2 * math.pi), rng.uniform(-1, 1), 1.5 * rng.random() ** 0.4
            c = add(at, (r * math.cos(a), 3.4 + 0.9 * b, r * math.sin(a)))
            u = (0.15 * math.cos(2 * a), 0.15 * b, 0.15 * math.sin(2 * a))
            v = (-0.25 * math.sin(a), 0.1 * math.cos(3 * a), 0.25 * math.cos(a))
            leaves.patch(c, u, v)
        for _ in range(25):
            a, r = rng.uniform(0, 2 * math.pi), rng.uniform(0.3, 1.6)
            p = add(at, (r * math.cos(a), rng.uniform(1.9, 3.8), r * math.sin(a)))
            color = rng.choice(((9, 5, 2), (9, 2, 1.5), (3, 6, 9), (8, 7, 3)))
            scene.emitters.append(f'<shape type="sphere"><point name="center" x="{p[0]:.4f}" y="{p[1]:.4f}" z="{p[2]:.4f}"/><float name="radius" value="0.06"/>' +
                                  diffuse((0, 0, 0)) + '<emitter type="area">' + rgb("radiance", [2.5 * c for c in color]) + "</emitter></shape>")
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.002, 0.003, 0.006)) + "</emitter>")
    return scene, folder


def arch(out):
    rng = random.Random(26)
    scene = Scene("Out of a dark vault into a court at noon.", ((0.5, 1.6, 9.4), (-0.2, 1.9, 0)), 66, (640, 360))
    stone, court = scene.material("stone", diffuse((0.42, 0.38, 0.33))), scene.material("court", diffuse((0.66, 0.6, 0.5)))
    iron = scene.material("iron", brushed("Cr", 0.3, 0.3))
    court.patch((-9, 0, 2), (18, 0, 0), (0, 0, -16), 4, 4)
    stone.patch((-2.5, 0, 10), (5, 0, 0), (0, 0, -8), 2, 2)
    for x in (-2.7, 2.5):
        stone.box((x, 0, 2), (x + 0.2, 2.6, 10))
    stone.box((-2.7, 0, 10), (2.7, 5, 10.2))

    def vault(s, t):
        a = math.pi * s
        return (-2.5 * math.cos(a), 2.6 + 2.0 * math.sin(a), 10 - 8 * t), (math.cos(a), -math.sin(a), 0), (s, t)
    stone.grid(24, 4, vault)
    for x0, x1, y0 in ((-9, -2.5, 0), (2.5, 9, 0)):
        court.box((x0, y0, 1.8), (x1, 7, 2))
    court.box((-2.5, 4.6, 1.8), (2.5, 7, 2))
    for lo, hi in (((-9.2, 0, -14), (-9, 7, 2)), ((9, 0, -14), (9.2, 7, 2)), ((-9, 0, -14.2), (9, 7, -14))):
        court.box(lo, hi)
    for k in range(7):
        iron.tube([(-2.2 + 0.72 * k, 0, 2.4), (-2.2 + 0.72 * k, 2.4, 2.4)], 0.02, 8)
    furniture(rng, [scene.material("wood", diffuse((0.3, 0.18, 0.09)))], [scene.material("blue", diffuse((0.08, 0.14, 0.4)))], (1.5, 3.0), 6)
    for k in range(6):
        iron.sphere((rng.uniform(-1.8, 1.8), 0.2, rng.uniform(4, 7)), 0.2, 32)
    scene.sun_and_sky((0.35, 0.8, -0.3), 1)
    return scene, out / "arch"


if __name__ == "__main__":
    write_scenes(__doc__, {"chapel": chapel, "wall": wall, "workshop": workshop, "vitrines": vitrines, "lanterns": lanterns, "arch": arch})
