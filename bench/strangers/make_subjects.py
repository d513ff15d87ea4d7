#!/usr/bin/env python3
"""Writes seven more scenes that nobody tuned for (Mitsuba 3 XML, PLY and PNG): what people usually render first, and what they render outdoors.

    bench/strangers/make_subjects.py OUT [plates egg ball hangar street villa classroom]

  plates     four round lamps of equal power mirrored in plates of four roughnesses
  egg        a lamp within a shade and one on the wall above a glass egg on a table
  ball       a ball of rough metal within a shell of lacquer under an environment map
  hangar     dark metal with hundreds of strips of light, near and far
  street     a wet street at night, with lanterns, windows and signs
  villa      a house in the sun, with panes, a hedge of cut-out leaves, and a pond
  classroom  desks beside a row of paned windows, under the sky alone
"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_daily_places import bulb  # noqa: E402
from make_hard_scenes import furniture, room  # noqa: E402
from make_lamps_and_glass import gloss, write_png  # noqa: E402
from make_small_and_colored import BITMAP, RAW, folder_of  # noqa: E402
from scene_parts import Scene, add, brushed, diffuse, number, rgb, write_scenes  # noqa: E402

GLASS = '<bsdf type="dielectric">' + number("int_ior", 1.5) + "</bsdf>"


def plates(out):
    scene = Scene("Round lamps of equal power mirrored in plates.", ((0, 2, 15), (0, -2, 2.5)), 28, (640, 360))
    wall = scene.material("wall", diffuse((0.25, 0.25, 0.25)))
    wall.patch((-10, -4.2, 10), (20, 0, 0), (0, 0, -22))
    wall.patch((-10, -10, -4), (20, 0, 0), (0, 20, 0))
    for k, (alpha, lean) in enumerate(((0.005, 55), (0.02, 40), (0.05, 24), (0.12, 10))):
        plate = scene.material(f"plate{k}", brushed("Al", alpha, alpha))
        a = math.radians(lean)
        plate.patch((-4, -2.6 - 0.4 * k, -1.6 + 1.9 * k), (8, 0, 0), (0, math.sin(a), -math.cos(a)))
    for k, radius in enumerate((0.033, 0.1, 0.3, 0.9)):
        scene.emitters.append(bulb((-3.75 + 2.5 * k, 0.2, 0), radius, [1.0 / radius ** 2] * 3))
    scene.emitters.append(bulb((10, 10, 4), 0.5, (800, 800, 800)))
    return scene, out / "plates"


def egg(out):
    scene = Scene("A shaded lamp above a glass egg.", ((2.9, 1.75, 2.6), (-0.1, 0.85, -0.4)), 52, (640, 360))
    walls, floor, wood = scene.material("walls", diffuse((0.66, 0.63, 0.57))), scene.material("floor", diffuse((0.3, 0.22, 0.15))), scene.material("wood", gloss((0.35, 0.2, 0.1), 0.15))
    metal, shade = scene.material("metal", brushed("Cu", 0.15, 0.15)), scene.material("shade", diffuse((0.55, 0.5, 0.4)))
    room(walls, floor, walls, (3.2, 3.2), 2.8)
    wood.box((-1.0, 0.7, -1.0), (1.0, 0.76, 0.6), 0.015)
    for x in (-0.9, 0.9):
        for z in (-0.9, 0.5):
            wood.box((x - 0.04, 0, z - 0.04), (x + 0.04, 0.7, z + 0.04))
    glass = scene.single("glass", GLASS)
    glass.revolve((0.25, 0.761, 0.05), [(0, 0), (0.1, 0.02), (0.17, 0.14), (0.14, 0.3), (0.07, 0.4), (0, 0.425)], 96, 12)
    # Light leaves the floor lamp upwards only; that on the wall through a slit onto the table.
    metal.tube([(-2.2, 0, -2.2), (-2.2, 1.6, -2.2)], 0.02, 16)
    metal.revolve((-2.2, 1.6, -2.2), [(0.03, 0), (0.03, 0), (0.2, 0.25), (0.22, 0.3)], 48, 3)
    scene.emitters.append(bulb((-2.2, 1.72, -2.2), 0.05, (330, 290, 230)))
    shade.revolve((1.9, 1.95, -2.7), [(0.24, 0.0), (0.16, 0.32), (0.16, 0.32), (0.0, 0.33)], 48, 2)
    scene.emitters.append(bulb((1.9, 2.1, -2.7), 0.04, (210, 180, 140)))
    scene.spot((0.9, 2.7, 1.8), (0.25, 0.9, 0.05), (9, 8.4, 7.5), 14, 9)
    metal.revolve((-0.55, 0.76, 0.0), [(0, 0), (0.1, 0.0), (0.1, 0.0), (0.12, 0.16), (0.12, 0.16), (0.112, 0.16), (0.112, 0.16), (0.09, 0.02), (0, 0.02)], 64, 5)
    return scene, out / "egg"


def ball(out):
    folder = folder_of(out, "ball")
    scene = Scene("A ball within a shell under an environment map.", ((1.5, 1.5, 3.1), (0, 0.62, 0)), 38, (640, 360))

    def checks(x, y):
        return (200, 196, 190) if (x // 8 + y // 8) % 2 else (70, 72, 78)
    write_png(folder / "checks.png", [[checks(x, y) for x in range(256)] for y in range(256)])

    def sky(x, y):
        up, a = math.cos(math.pi * (y + 0.5) / 128), 2 * math.pi * (x + 0.5) / 256
        if up > 0.3 and up < 0.75 and (math.cos(a - 1.2) > 0.94 or math.cos(a - 4.0) > 0.985):
            return (255, 250, 240)  # windows
        shade = 70 + 50 * up + 12 * math.sin(3 * a)
        return (round(shade), round(shade), round(shade * 1.08))
    write_png(folder / "around.png", [[sky(x, y) for x in range(256)] for y in range(128)])
    scene.emitters.append('<emitter type="envmap"><string name="filename" value="around.png"/>' + number("scale", 1.6) + "</emitter>")
    ground = scene.material("ground", '<bsdf type="diffuse">' + BITMAP.format("reflectance", "checks.png", "") + "</bsdf>")
    ground.patch((-2.5, 0, 2.5), (5, 0, 0), (0, 0, -5))
    metal, lacquer, core = scene.material("metal", brushed("Au", 0.2, 0.2)), scene.material("lacquer", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.35, 0.02, 0.03)) + "</bsdf>"), scene.material("core", brushed("Al", 0.08, 0.3))
    metal.revolve((0, 0, 0), [(0.62, 0), (0.62, 0.03), (0.62, 0.03), (0.5, 0.1), (0.3, 0.14), (0.0, 0.14)], 96, 4)
    core.sphere((0, 0.66, 0), 0.36, 96)

    def shell(radius, sign):
        def at(s, t):
            a, b = math.radians(20 + 250 * s), math.radians(10 + 160 * t)
            n = (math.sin(b) * math.sin(a), -math.cos(b), math.sin(b) * math.cos(a))
            return add((0, 0.66, 0), tuple(radius * c for c in n)), tuple(sign * c for c in n), (s, t)
        return at
    lacquer.grid(120, 80, shell(0.52, 1))
    metal.grid(120, 80, shell(0.49, -1))
    glass = scene.single("glass", GLASS)
    glass.sphere((0.95, 0.181, 0.75), 0.18, 64)
    return scene, folder


def hangar(out):
    rng = random.Random(41)
    scene = Scene("Strips of light on dark metal.", ((1.2, 2.0, 9.0), (-0.6, 2.4, -6)), 70, (640, 360))
    metals = [scene.material(f"metal{k}", brushed("Cr" if k % 2 else "Al", 0.08 + 0.1 * k, 0.08 + 0.1 * k)) for k in range(3)]
    floor, panel = scene.material("floor", gloss((0.05, 0.05, 0.055), 0.08)), scene.material("panel", gloss((0.12, 0.13, 0.15), 0.2))
    room(panel, floor, panel, (7, 11), 6)
    for k in range(12):
        z = -10.5 + 1.9 * k
        for side in (-1, 1):
            metals[k % 3].box((min(side * 6.2, side * 7), 0, z), (max(side * 6.2, side * 7), 5.4, z + 0.5), 0.05)
            for row in range(8):
                if rng.random() < 0.7:
                    color = rng.choice(((6, 9, 14), (14, 9, 4), (12, 12, 12), (14, 1.5, 1)))
                    scene.lamp((side * 6.99, 0.5 + 0.62 * row, z + 1.2), (0, 0.02 if row % 2 else 0.12, 0), (0, 0, -side * (0.5 if row % 2 else 0.05)), color)
        metals[(k + 1) % 3].box((-7, 5.4, z), (7, 5.8, z + 0.25), 0.04)
        scene.lamp((2.5 - 5 * (k % 2), 5.38, z + 0.12), (1.2, 0, 0), (0, 0, 0.04), (14, 15, 17))
    for k in range(9):
        x, z = rng.uniform(-4, 4), rng.uniform(-9, 4)
        size = rng.uniform(0.5, 1.3)
        rng.choice(metals).box((x - size, 0, z - size), (x + size, rng.uniform(0.5, 1.8), z + size), 0.08, 0, rng.uniform(0, 90))
        rng.choice(metals).sphere((x, 2.2 + 0.4 * rng.random(), z), 0.45, 48)
    hull = scene.material("hull", brushed("Cr", 0.12, 0.3))
    hull.revolve((-1, 0.9, -4), [(0, 0), (1.4, 0.1), (2.1, 0.5), (1.5, 1.0), (0.7, 1.2), (0.5, 1.6), (0, 1.75)], 96, 8)
    for k in range(24):
        a = 2 * math.pi * k / 24
        scene.emitters.append(bulb((-1 + 2.12 * math.cos(a), 1.42, -4 + 2.12 * math.sin(a)), 0.05, (30, 50, 60)))
    return scene, out / "hangar"


def street(out):
    rng = random.Random(42)
    folder = folder_of(out, "street")
    scene = Scene("A wet street at night.", ((1.0, 1.65, 8.0), (-0.2, 2.3, -12)), 62, (640, 360))

    def wet(x, y):
        v = 0.5 + 0.25 * math.sin(x / 9) * math.sin(y / 13) + 0.25 * math.sin(x / 23 + y / 31)
        return round(255 * (0.02 + 0.33 * v * v))
    write_png(folder / "wet.png", [[(wet(x, y),) * 3 for x in range(256)] for y in range(256)])
    road = scene.material("road", '<bsdf type="principled">' + rgb("base_color", (0.05, 0.05, 0.055)) + BITMAP.format("roughness", "wet.png", RAW) + number("specular", 0.5) + "</bsdf>")
    brick, plaster, stone = scene.material("brick", diffuse((0.3, 0.13, 0.09))), scene.material("plaster", diffuse((0.45, 0.42, 0.36))), scene.material("stone", diffuse((0.28, 0.28, 0.29)))
    iron = scene.material("iron", gloss((0.02, 0.02, 0.02), 0.15))
    for k in range(12):
        road.patch((-3.5, 0, 10 - 6 * k), (7, 0, 0), (0, 0, -6))
    for side in (-1, 1):
        stone.box((min(side * 3.5, side * 5.5), 0, -60), (max(side * 3.5, side * 5.5), 0.14, 12), 0.02)
        for k in range(9):
            z, height = 10 - 8 * k, rng.uniform(7, 13)
            front = rng.choice((brick, plaster))
            front.box((min(side * 5.5, side * 9), 0, z - 7.9), (max(side * 5.5, side * 9), height, z))
            for floor in range(1, int(height / 3)):
                for window in range(3):
                    at = (side * 5.49, 3.0 * floor + 1.4, z - 1.4 - 2.5 * window)
                    if rng.random() < 0.3:
                        scene.lamp(at, (0, 0.7, 0), (0, 0, -side * 0.45), rng.choice(((3.0, 2.0, 0.9), (2.2, 1.8, 1.2), (1.0, 1.3, 2.0))))
                    stone.box((min(side * 5.42, side * 5.5), at[1] - 0.8, at[2] - 0.55), (max(side * 5.42, side * 5.5), at[1] - 0.72, at[2] + 0.55))
            if rng.random() < 0.7:  # a shop's window and its sign
                scene.lamp((side * 5.48, 1.4, z - 4), (0, 0.9, 0), (0, 0, -side * 2.2), (2.6, 2.4, 2.0))
                scene.lamp((side * 5.2, 2.9, z - 4), (0, 0.2, 0), (0, 0, -side * 1.2), rng.choice(((14, 1, 2), (1, 9, 4), (2, 3, 16), (12, 8, 1))))
    for k in range(6):
        for side in (-1, 1):
            z = 4 - 10 * k - (5 if side > 0 else 0)
            iron.tube([(side * 3.9, 0.14, z), (side * 3.9, 4.4, z), (side * 3.7, 4.8, z), (side * 3.3, 4.9, z)], 0.05, 10)
            scene.spot((side * 3.2, 4.85, z), (side * 2.6, 0, z), (110, 78, 40), 65, 40)
            scene.emitters.append(bulb((side * 3.2, 4.93, z), 0.1, (60, 42, 20)))
    for k in range(5):
        body = scene.material(f"car{k}", '<bsdf type="roughplastic">' + rgb("diffuse_reflectance", rng.choice(((0.4, 0.02, 0.02), (0.02, 0.05, 0.25), (0.3, 0.3, 0.3)))) + number("alpha", 0.03) + "</bsdf>")
        x, z = (2.5 if k % 2 else -2.5), 1 - 7 * k
        body.box((x - 0.85, 0.25, z - 2), (x + 0.85, 0.85, z + 2), 0.15)
        body.box((x - 0.7, 0.8, z - 1.1), (x + 0.7, 1.4, z + 1.2), 0.2)
        for lamp in (-0.55, 0.55):
            scene.lamp((x + lamp, 0.65, z + 2.01), (0.12, 0, 0), (0, 0.06, 0), (25, 1, 0.7))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.004, 0.005, 0.009)) + "</emitter>")
    return scene, folder


def villa(out):
    rng = random.Random(43)
    folder = folder_of(out, "villa")
    scene = Scene("A house in the sun.", ((7.5, 1.7, 11.5), (-0.5, 2.2, 0)), 52, (640, 360))
    leaf = [[255 if abs(y - 16) < 7 * math.sin(math.pi * x / 31) ** 0.8 else 0 for x in range(32)] for y in range(32)]
    write_png(folder / "leaf.png", [[(v, v, v) for v in row] for row in leaf])
    lawn, concrete, wood = scene.material("lawn", diffuse((0.09, 0.2, 0.04))), scene.material("concrete", diffuse((0.6, 0.58, 0.55))), scene.material("wood", gloss((0.32, 0.17, 0.08), 0.3))
    white, frame = scene.material("white", diffuse((0.82, 0.81, 0.78))), scene.material("frame", brushed("Al", 0.2, 0.2))
    pane, water = scene.single("pane", '<bsdf type="thindielectric"/>'), scene.single("water", '<bsdf type="dielectric">' + number("int_ior", 1.33) + "</bsdf>")
    for x0, z0, x1, z1 in ((-60, -60, 60, 4.5), (-60, 8.5, 60, 60), (-60, 4.5, -1, 8.5), (5, 4.5, 60, 8.5)):
        lawn.patch((x0, 0, z1), (x1 - x0, 0, 0), (0, 0, z0 - z1), 4, 4)
    concrete.box((-1.2, -0.6, 4.3), (5.2, -0.5, 8.7))
    for lo, hi in (((-1.2, -0.6, 4.3), (-1, 0.05, 8.7)), ((5, -0.6, 4.3), (5.2, 0.05, 8.7)), ((-1, -0.6, 4.3), (5, 0.05, 4.5)), ((-1, -0.6, 8.5), (5, 0.05, 8.7))):
        concrete.box(lo, hi)
    water.grid(40, 30, lambda s, t: ((-1 + 6 * s, -0.08 + 0.004 * math.sin(40 * s + 11 * t) + 0.004 * math.sin(33 * t), 4.5 + 4 * t),
                                     (-0.025 * math.cos(40 * s + 11 * t), 1, -0.03 * math.cos(33 * t)), (s, t)))
    concrete.box((-6, 0, -6), (6, 0.25, 3.2), 0.01)
    white.box((-6, 3.0, -6), (6.4, 3.3, 2.4), 0.01)
    white.box((-5.8, 0.25, -5.8), (-5.6, 3.0, 2))
    white.box((-5.8, 0.25, -5.8), (5.8, 3.0, -5.6))
    white.box((-2, 3.3, -5), (4, 5.8, 1), 0.01)
    wood.box((-5.8, 0.25, 1.8), (-2.5, 3.0, 2.0))
    wood.box((5.6, 0.25, -5.6), (5.8, 3.0, -2))
    for k in range(6):
        x = -2.5 + 1.62 * k
        frame.box((x - 0.04, 0.25, 1.86), (x + 0.04, 3.0, 1.94))
        if k < 5:
            pane.patch((x, 0.25, 1.9), (1.62, 0, 0), (0, 2.75, 0))
    for k in range(3):
        z = -2 + 1.3 * k
        frame.box((5.66, 0.25, z - 0.04), (5.74, 3.0, z + 0.04))
        pane.patch((5.7, 0.25, z), (0, 0, 1.3), (0, 2.75, 0))
    furniture(rng, [wood], [scene.material("cloth", diffuse((0.5, 0.15, 0.1)))], (3.5, 1.2), 6)
    scene.lamp((0, 2.95, -2), (0.4, 0, 0), (0, 0, 0.4), (0.02, 0.018, 0.014))
    leaves = [scene.single(f"leaves{k}", '<bsdf type="mask">' + BITMAP.format("opacity", "leaf.png", RAW) + '<bsdf type="twosided">' + diffuse(color) + "</bsdf></bsdf>")
              for k, color in enumerate(((0.1, 0.3, 0.06), (0.16, 0.34, 0.07)))]

    def bush(center, radii, count):
        for _ in range(count):
            a, b, r = rng.uniform(0, 2 * math.pi), rng.uniform(-1, 1), rng.uniform(0.7, 1)
            s = math.sqrt(1 - b * b)
            p = add(center, (radii[0] * r * s * math.cos(a), radii[1] * r * b, radii[2] * r * s * math.sin(a)))
            u = tuple(0.12 * rng.uniform(-1, 1) for _ in range(3))
            v = (0.1 * rng.uniform(-1, 1), 0.1 * rng.uniform(-1, 1), 0.1 * rng.uniform(-1, 1))
            rng.choice(leaves).patch(p, u, v)
    for k in range(7):
        bush((-7 + 0.5 * k, 0.6, 4.5 + 0.8 * k), (0.6, 0.6, 0.6), 900)
    wood.tube([(-6.5, 0, 1), (-6.4, 2, 1.1), (-6.2, 4, 1)], [0.2, 0.14, 0.08], 12)
    bush((-6.2, 5, 1), (1.8, 1.6, 1.8), 5000)
    scene.sun_and_sky((0.5, 0.6, 0.62), 1)
    return scene, folder


def classroom(out):
    rng = random.Random(44)
    scene = Scene("Desks beside paned windows.", ((3.3, 1.6, 4.3), (-1.2, 1.15, -2)), 68, (640, 360))
    walls, floor, ceiling = scene.material("walls", diffuse((0.7, 0.68, 0.6))), scene.material("floor", gloss((0.32, 0.2, 0.11), 0.18)), scene.material("ceiling", diffuse((0.8, 0.8, 0.78)))
    wood, steel, board = scene.material("wood", gloss((0.45, 0.28, 0.13), 0.2)), scene.material("steel", brushed("Cr", 0.1, 0.1)), scene.material("board", gloss((0.02, 0.07, 0.05), 0.3))
    x, z = 3.8, 4.8
    floor.patch((-x, 0, z), (2 * x, 0, 0), (0, 0, -2 * z), 4, 4)
    ceiling.patch((-x, 3, -z), (2 * x, 0, 0), (0, 0, 2 * z), 4, 4)
    for lo, hi in (((x, 0, -z), (x + 0.2, 3, z)), ((-x - 0.2, 0, -z - 0.2), (x + 0.2, 3, -z)), ((-x - 0.2, 0, z), (x + 0.2, 3, z + 0.2)), ((-x - 0.2, 0, -z), (-x, 0.9, z)), ((-x - 0.2, 2.6, -z), (-x, 3, z))):
        walls.box(lo, hi)
    # Panes with two faces, as they are modelled most often.
    glass = scene.single("glass", GLASS)
    for k in range(5):
        at = -z + 1.92 * k
        walls.box((-x - 0.2, 0.9, at), (-x, 2.6, at + 0.4))
        glass.box((-x - 0.11, 0.9, at + 0.4), (-x - 0.1, 2.6, at + 1.92))
        for bar in range(1, 3):
            walls.box((-x - 0.13, 0.9, at + 0.4 + 0.507 * bar - 0.02), (-x - 0.08, 2.6, at + 0.4 + 0.507 * bar + 0.02))
        walls.box((-x - 0.13, 1.73, at + 0.4), (-x - 0.08, 1.77, at + 1.92))
    for row in range(4):
        for k in range(3):
            px, pz = -2.6 + 1.9 * k, -2.9 + 1.7 * row
            wood.box((px, 0.7, pz), (px + 1.1, 0.73, pz + 0.5), 0.01)
            wood.box((px + 0.3, 0.42, pz + 0.65), (px + 0.75, 0.45, pz + 1.05), 0.01)
            wood.box((px + 0.3, 0.45, pz + 1.03), (px + 0.75, 0.85, pz + 1.06), 0.01)
            for leg in (0.04, 1.06):
                steel.tube([(px + leg, 0, pz + 0.06), (px + leg, 0.7, pz + 0.06)], 0.016, 10)
                steel.tube([(px + leg, 0, pz + 0.44), (px + leg, 0.7, pz + 0.44)], 0.016, 10)
            for leg in (0.33, 0.72):
                steel.tube([(px + leg, 0, pz + 1.02), (px + leg, 0.43, pz + 1.02)], 0.012, 8)
                steel.tube([(px + leg, 0, pz + 0.68), (px + leg, 0.43, pz + 0.68)], 0.012, 8)
            if rng.random() < 0.6:
                wood.box((px + 0.2, 0.73, pz + 0.1), (px + 0.5, 0.76, pz + 0.35), 0.002, 0, rng.uniform(-20, 20))
    board.box((-1.8, 0.9, -z), (1.6, 2.1, -z + 0.03))
    wood.box((-1.9, 0.84, -z), (1.7, 0.9, -z + 0.08))
    for k in range(3):
        scene.lamp((0.2, 2.95, -3 + 3 * k), (0.08, 0, 0), (0, 0, 0.6), (0.01, 0.01, 0.01))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (1.0, 1.15, 1.4)) + "</emitter>")
    return scene, out / "classroom"


if __name__ == "__main__":
    write_scenes(__doc__, {"plates": plates, "egg": egg, "ball": ball, "hangar": hangar, "street": street, "villa": villa, "classroom": classroom})
