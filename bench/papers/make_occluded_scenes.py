#!/usr/bin/env python3
"""Writes four scenes with many occluders for the experiments of Huo et al. 2015 (Mitsuba 3 XML and PLY): after the paper's, of our own making.

    bench/papers/make_occluded_scenes.py OUT [courtyard fair room arcade]

  courtyard  plants, tables and chairs between walls with galleries, under sun and sky (the paper's San Miguel)
  fair       stalls and a big wheel at night, under some 600 small lamps and a faint sky (carnival)
  room       shelves full of small things, a table with chairs, glossy crockery; light comes from a lamp outside of the window (room)
  arcade     a long hall of columns and arches with hanging cloths, under a strip of sky (Sponza)
"""
import math
import pathlib
import random

from scene_parts import Scene, add, catmull_rom, diffuse, mul, rgb, unit, ward, write_scenes
from make_fur_and_trees import leaf, on_sphere


def chair(wood, at, turn):
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def place(p):
        return (at[0] + c * p[0] + s * p[2], at[1] + p[1], at[2] - s * p[0] + c * p[2])
    for x in (-0.2, 0.2):
        wood.tube([place((x, 0, -0.2)), place((x, 0.95, -0.24))], 0.018, 8)
        wood.tube([place((x, 0, 0.2)), place((x, 0.44, 0.2))], 0.018, 8)
    for k in range(4):
        y = 0.55 + 0.12 * k
        wood.tube([place((-0.2, y, -0.215)), place((0.2, y, -0.215))], 0.011, 6)
    wood.box(add(at, (-0.22, 0.44, -0.22)), add(at, (0.22, 0.475, 0.22)), 0.01, 0, turn)


def table(wood, at, half, height=0.74):
    wood.box(add(at, (-half[0], height - 0.035, -half[1])), add(at, (half[0], height, half[1])), 0.008)
    for x in (-1, 1):
        for z in (-1, 1):
            leg = add(at, (x * (half[0] - 0.06), 0, z * (half[1] - 0.06)))
            wood.tube([leg, add(leg, (0, height - 0.03, 0))], 0.024, 8)


def plant(rng, pots, stems, leaves, at, size, count):
    pots.revolve(at, [(0.0, 0.0), (0.2 * size, 0.0), (0.2 * size, 0.0), (0.27 * size, 0.4 * size), (0.27 * size, 0.4 * size), (0.24 * size, 0.4 * size), (0.0, 0.36 * size)], 24, 2)
    for _ in range(count // 60 + 2):
        direction = unit(add(on_sphere(rng), (0, 1.4, 0)))
        root, points = add(at, (0, 0.36 * size, 0)), []
        for k in range(5):
            points.append(root)
            direction = unit(add(add(direction, mul(on_sphere(rng), 0.25)), (0, -0.1, 0)))
            root = add(root, mul(direction, 0.28 * size * rng.uniform(0.7, 1.2)))
        stems.tube(catmull_rom(points, 2), 0.012 * size, 5)
        for _ in range(60):
            where = points[rng.randrange(1, 5)]
            leaf(leaves[rng.randrange(len(leaves))], rng, add(where, mul(on_sphere(rng), 0.08 * size)), unit(add(on_sphere(rng), (0, -0.2, 0))), rng.uniform(0.1, 0.2) * size)


def arch(stone, x0, x1, spring, depth, z, pieces=10):
    """A round arch across x at the height `spring`, as wedge-like boxes between the radii of its ring."""
    middle, radius = (x0 + x1) / 2, (x1 - x0) / 2
    for k in range(pieces):
        a0, a1 = math.pi * k / pieces, math.pi * (k + 1) / pieces
        for r in (radius,):
            p0 = (middle - r * math.cos(a0), spring + r * math.sin(a0), z)
            p1 = (middle - r * math.cos(a1), spring + r * math.sin(a1), z)
            stone.patch(p0, (0, 0, depth), tuple(b - a for a, b in zip(p0, p1)))
        for face, sign in ((z, 1), (z + depth, -1)):
            p = (middle - radius * math.cos(a0), spring + radius * math.sin(a0), face)
            q = (middle - radius * math.cos(a1), spring + radius * math.sin(a1), face)
            top = spring + radius + 0.35
            first = len(stone.vertices)
            for v in (p, q, (q[0], top, face), (p[0], top, face)):
                stone.vertices.append((*v, 0, 0, -sign, v[0], v[1]))
            stone.triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]


def column(stone, at, height, radius):
    stone.box(add(at, (-1.5 * radius, 0, -1.5 * radius)), add(at, (1.5 * radius, 0.2, 1.5 * radius)), 0.02)
    stone.revolve(add(at, (0, 0.2, 0)), [(1.3 * radius, 0), (1.05 * radius, 0.12), (radius, 0.3), (0.9 * radius, height - 0.6), (1.25 * radius, height - 0.4)], 24, 3)
    stone.box(add(at, (-1.4 * radius, height - 0.2, -1.4 * radius)), add(at, (1.4 * radius, height, 1.4 * radius)), 0.02)


def gallery(stone, z, depth, spring, xs, radius=0.17):
    for x in xs:
        column(stone, (x, 0, z + depth / 2), spring, radius)
        stone.box((x - 0.13, spring, z), (x + 0.13, spring + 1.3, z + depth))
    for a, b in zip(xs, xs[1:]):
        arch(stone, a + 0.12, b - 0.12, spring, depth, z)


def courtyard(out):
    rng = random.Random(3)
    scene = Scene("A courtyard with plants.", ((-5.6, 2.9, 4.9), (0.8, 0.9, -0.6)), 62, (960, 540))
    ground, plaster = scene.material("ground", diffuse((0.42, 0.33, 0.26))), scene.material("plaster", diffuse((0.62, 0.42, 0.26)))
    stone, wood = scene.material("stone", diffuse((0.55, 0.5, 0.44))), scene.material("wood", diffuse((0.24, 0.13, 0.07)))
    pots, stems = scene.material("pots", diffuse((0.45, 0.2, 0.11))), scene.material("stems", diffuse((0.2, 0.16, 0.08)))
    leaves = [scene.material(f"leaves{k}", diffuse(c)) for k, c in enumerate(((0.12, 0.3, 0.06), (0.2, 0.38, 0.07)))]
    cloth = scene.material("cloth", diffuse((0.7, 0.68, 0.62)))
    ground.patch((-8, 0, 7), (16, 0, 0), (0, 0, -14), 8, 8)
    # Walls behind galleries on three sides, the fourth behind the camera; a roof over the galleries.
    plaster.box((-7.4, 0, -6.2), (7.4, 5.2, -6.0))
    plaster.box((7.2, 0, -6.2), (7.4, 5.2, 6.2))
    plaster.box((-7.4, 0, -6.2), (-7.2, 5.2, 6.2))
    plaster.box((-7.4, 0, 6.0), (7.4, 5.2, 6.2))
    xs = [-7.0 + 2.0 * k for k in range(8)]
    gallery(stone, -4.2, 0.4, 2.2, xs)
    plaster.box((-7.2, 3.5, -6.0), (7.2, 3.65, -3.6))
    stone.box((-7.2, 3.65, -3.75), (7.2, 4.3, -3.65))
    for _ in range(26):
        x, z = rng.uniform(-6, 6.6), rng.uniform(-3.2, 5.0)
        if x < -3.2 and z > 2.4:
            continue
        plant(rng, pots, stems, leaves, (x, 0, z), rng.uniform(0.7, 1.4), 400)
    for x, z in ((-1.8, 0.8), (1.0, -1.6), (2.6, 1.8), (4.8, -0.8), (-3.6, -2.0)):
        table(wood, (x, 0, z), (0.45, 0.45))
        cloth.box((x - 0.47, 0.742, z - 0.47), (x + 0.47, 0.75, z + 0.47), 0.002)
        for k in range(4):
            a = 90 * k + rng.uniform(-15, 15)
            chair(wood, (x - 0.75 * math.sin(math.radians(a)), 0, z - 0.75 * math.cos(math.radians(a))), a)
        plant(rng, pots, stems, leaves, (x, 0.75, z), 0.35, 120)
    scene.sun_and_sky((0.42, 0.78, 0.46), 3)
    return scene, out / "courtyard"


def fair(out):
    rng = random.Random(5)
    scene = Scene("A fair at night.", ((0.5, 1.75, 13.0), (0, 3.0, 0)), 58, (960, 540))
    ground, wood = scene.material("ground", diffuse((0.3, 0.27, 0.24))), scene.material("wood", diffuse((0.35, 0.24, 0.15)))
    steel = scene.material("steel", diffuse((0.5, 0.5, 0.52)))
    roofs = [scene.material(f"roof{k}", diffuse(c)) for k, c in enumerate(((0.65, 0.1, 0.08), (0.75, 0.7, 0.6), (0.1, 0.2, 0.5), (0.7, 0.5, 0.08)))]
    goods = [scene.material(f"goods{k}", diffuse(c)) for k, c in enumerate(((0.7, 0.25, 0.2), (0.25, 0.5, 0.25), (0.6, 0.6, 0.65)))]
    ground.patch((-40, 0, 30), (80, 0, 0), (0, 0, -80), 8, 8)
    lamps = []

    def lamp(p, power, tint):
        lamps.append(f'<emitter type="point"><point name="position" x="{p[0]:.4g}" y="{p[1]:.4g}" z="{p[2]:.4g}"/>' + rgb("intensity", mul(tint, power)) + "</emitter>")
    warm, cold, red, blue = (1, 0.72, 0.4), (0.8, 0.9, 1), (1, 0.25, 0.15), (0.25, 0.4, 1)
    for k in range(18):
        side, row = (-1, 1)[k % 2], k // 2
        x, z = side * (4.2 + 0.5 * rng.random()), 8.5 - 2.9 * row
        w, d, h = 1.1, 0.9, 2.5
        for px in (-w, w):
            for pz in (-d, d):
                wood.tube([(x + px, 0, z + pz), (x + px, h, z + pz)], 0.04, 6)
        wood.box((x - w, 0, z - d), (x + w, 0.9, z - d + 0.08), 0.01)
        wood.box((x - w, 0.9, z - d), (x + w, 0.96, z + d), 0.01)
        for s in range(2):
            wood.box((x + side * (w - 0.25), 1.2 + 0.5 * s, z - d), (x + side * w, 1.24 + 0.5 * s, z + d), 0.005)
            for _ in range(14):
                g = rng.uniform(0.05, 0.11)
                c = (x + side * (w - 0.12), 1.24 + 0.5 * s + g, z + rng.uniform(-d, d) * 0.9)
                goods[rng.randrange(3)].box(add(c, (-g, -g, -g)), add(c, (g, g * rng.uniform(0.2, 1.4), g)), 0.01, 0, rng.uniform(0, 90))
        roof = roofs[k % 4]
        for s in range(8):
            roofs[(k + s % 2) % 4].patch((x - 1.25 * w + 2.5 * w * s / 8, h, z + d * 1.3), (2.5 * w / 8, 0, 0), (0, 0.55, -d * 1.3))
            roof.patch((x - 1.25 * w + 2.5 * w * s / 8, h + 0.55, z), (2.5 * w / 8, 0, 0), (0, -0.55, -d * 1.3))
        for s in range(12):
            lamp((x - 1.2 * w + 2.4 * w * (s + 0.5) / 12, h - 0.06, z + d * 1.28), 0.35, (warm, red, cold, warm)[(k + s) % 4])
        lamp((x, h - 0.15, z), 1.6, warm)
    # A big wheel.
    center, radius = (0, 7.2, -9), 6.2
    for side in (-0.6, 0.6):
        ring = [add(center, (radius * math.cos(a), radius * math.sin(a), side)) for a in (2 * math.pi * k / 48 for k in range(48))]
        steel.tube(ring, 0.07, 6, closed=True)
        for k in range(24):
            steel.tube([add(center, (0, 0, side)), ring[2 * k]], 0.03, 5)
            lamp(add(ring[2 * k], (0, 0, 0.15 if side > 0 else -0.15)), 1.2, (red, blue, warm)[k % 3])
            lamp(add(center, mul(add(ring[2 * k], mul(center, -1)), 0.6)), 0.6, cold)
        steel.tube([(-3.6, 0, center[2] + side * 2), add(center, (0, 0, side)), (3.6, 0, center[2] + side * 2)], 0.14, 8)
    for k in range(12):
        a = 2 * math.pi * k / 12
        p = add(center, (radius * math.cos(a), radius * math.sin(a) - 0.9, 0))
        roofs[k % 4].box(add(p, (-0.5, -0.4, -0.5)), add(p, (0.5, 0.1, 0.5)), 0.05)
        roofs[(k + 1) % 4].box(add(p, (-0.55, 0.7, -0.55)), add(p, (0.55, 0.78, 0.55)), 0.02)
        for px in (-0.45, 0.45):
            steel.tube([add(p, (px, 0, 0)), add(p, (px, 0.7, 0))], 0.03, 5)
    # Strings of lamps across the alley, and a crowd of posts and barrels in it.
    for k in range(10):
        z = 9.5 - 2.6 * k
        line = [(-3.4 + 6.8 * t, 3.4 - 2.0 * t * (1 - t), z) for t in (i / 20 for i in range(21))]
        steel.tube(line, 0.012, 4)
        for i in range(1, 20):
            lamp(add(line[i], (0, -0.06, 0)), 0.3, (warm, red, blue, cold)[(i + k) % 4])
    for _ in range(60):
        x, z, r, h = rng.uniform(-2.8, 2.8), rng.uniform(-6, 9.5), rng.uniform(0.12, 0.22), rng.uniform(0.5, 1.8)
        if abs(x) < 0.7 and z > 7:
            continue
        goods[rng.randrange(3)].revolve((x, 0, z), [(r, 0), (r * 1.2, h * 0.4), (r * 0.9, h * 0.75), (r * 0.6, h * 0.8), (r * 0.7, h * 0.92), (0, h)], 16, 3)
    scene.emitters += lamps
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.003, 0.004, 0.008)) + "</emitter>")
    return scene, out / "fair"


def room(out):
    rng = random.Random(8)
    scene = Scene("A room full of things.", ((2.3, 1.55, 2.5), (-0.7, 0.85, -0.9)), 64, (960, 720))
    walls, floor = scene.material("walls", diffuse((0.72, 0.7, 0.66))), scene.material("floor", diffuse((0.35, 0.22, 0.13)))
    wood, glossy = scene.material("wood", diffuse((0.3, 0.18, 0.1))), scene.material("crockery", ward((0.5, 0.5, 0.52), (0.25, 0.25, 0.25), 0.15))
    books = [scene.material(f"books{k}", diffuse(c)) for k, c in enumerate(((0.5, 0.1, 0.08), (0.1, 0.25, 0.4), (0.12, 0.35, 0.15), (0.6, 0.5, 0.2)))]
    cloth, frame = scene.material("curtains", diffuse((0.55, 0.3, 0.2))), scene.material("frame", diffuse((0.8, 0.8, 0.78)))
    x, z, h = 2.8, 3.0, 2.6
    floor.patch((-x, 0, z), (2 * x, 0, 0), (0, 0, -2 * z), 4, 4)
    walls.patch((-x, h, -z), (2 * x, 0, 0), (0, 0, 2 * z), 4, 4)
    walls.patch((-x, 0, -z), (2 * x, 0, 0), (0, h, 0), 4, 4)
    walls.patch((x, 0, z), (-2 * x, 0, 0), (0, h, 0), 4, 4)
    walls.patch((x, 0, -z), (0, 0, 2 * z), (0, h, 0), 4, 4)
    # The window is in the wall at -x.
    z0, z1, y0, y1 = -1.5, 1.1, 0.8, 2.2
    for za, zb, ya, yb in ((-z, z0, 0, h), (z1, z, 0, h), (z0, z1, 0, y0), (z0, z1, y1, h)):
        walls.patch((-x, ya, zb), (0, 0, za - zb), (0, yb - ya, 0))
        walls.patch((-x - 0.2, ya, za), (0, 0, zb - za), (0, yb - ya, 0))
    for k in range(4):
        zz = z0 + (z1 - z0) * k / 3
        frame.box((-x - 0.12, y0, zz - 0.03), (-x - 0.06, y1, zz + 0.03))
    for yy in (y0, 0.5 * (y0 + y1), y1):
        frame.box((-x - 0.12, yy - 0.03, z0), (-x - 0.06, yy + 0.03, z1))
    for side, base in ((1, z0 - 0.25), (-1, z1 + 0.25)):
        cloth.grid(60, 8, lambda s, t, side=side, base=base: ((-x + 0.12 + 0.05 * math.sin(40 * s), 0.1 + 2.3 * t, base + side * 0.6 * s), (1, 0, -side * 3.33 * math.cos(40 * s)), (s, t)))
    # Shelves along the back and the right wall.
    for back in (True, False):
        for k in range(5):
            y = 0.35 + 0.42 * k
            if back:
                wood.box((-2.4, y - 0.02, -z), (1.9, y, -z + 0.32), 0.004)
            else:
                wood.box((x - 0.32, y - 0.02, -2.3), (x, y, 0.4), 0.004)
            p, end = (-2.36, 1.86) if back else (-2.26, 0.36)
            while p < end - 0.3:
                if rng.random() < 0.2:
                    c = p + 0.12
                    at = (c, y, -z + 0.17) if back else (x - 0.17, y, c)
                    r, hh = rng.uniform(0.05, 0.09), rng.uniform(0.1, 0.3)
                    glossy.revolve(at, [(r * 0.6, 0), (r, hh * 0.4), (r * 0.5, hh * 0.8), (r * 0.7, hh)], 24, 4)
                    p += 0.26
                else:
                    w, hh, d = rng.uniform(0.02, 0.05), rng.uniform(0.2, 0.34), rng.uniform(0.16, 0.26)
                    lo, hi = ((p, y, -z + 0.02), (p + w, y + hh, -z + d)) if back else ((x - d, y, p), (x - 0.02, y + hh, p + w))
                    books[rng.randrange(4)].box(lo, hi, 0.003)
                    p += w + 0.003
    table(wood, (-0.4, 0, -0.4), (0.9, 0.5))
    for cx, cz, a in ((-0.9, -1.05, 0), (0.1, -1.1, 8), (-0.8, 0.35, 175), (0.2, 0.3, 190), (0.85, -0.4, -90), (-1.7, -0.4, 95)):
        chair(wood, (cx, 0, cz), a)
    for _ in range(22):
        at = (rng.uniform(-1.2, 0.4), 0.74, rng.uniform(-0.8, 0.0))
        r, hh = rng.uniform(0.03, 0.07), rng.uniform(0.03, 0.22)
        glossy.revolve(at, [(r * 0.5, 0), (r, hh * 0.3), (r * 0.9, hh), (r * 0.9, hh), (r * 0.82, hh), (r * 0.8, hh * 0.4), (0, 0.01)], 20, 3)
    for _ in range(14):
        at, s = (rng.uniform(-2.3, 2.2), 0, rng.uniform(-2.2, 2.2)), rng.uniform(0.08, 0.22)
        if abs(at[0] - 2.3) < 0.6 and abs(at[2] - 2.5) < 0.8:
            continue
        books[rng.randrange(4)].box(add(at, (-s, 0, -s)), add(at, (s, 1.5 * s, s)), 0.01, 0, rng.uniform(0, 90))
    scene.lamp((-x - 1.6, 2.0, 0.0), (0, 0, -1.4), (0.5, 0.9, 0), (24, 23, 21))
    return scene, out / "room"


def arcade(out):
    rng = random.Random(9)
    scene = Scene("A long hall of columns.", ((-9.5, 2.4, 0.7), (4, 2.6, -0.4)), 64, (960, 720))
    stone, floor = scene.material("stone", diffuse((0.6, 0.53, 0.44))), scene.material("floor", diffuse((0.38, 0.33, 0.29)))
    cloths = [scene.material(f"cloth{k}", diffuse(c)) for k, c in enumerate(((0.55, 0.08, 0.06), (0.1, 0.3, 0.12), (0.1, 0.15, 0.45)))]
    pots, stems = scene.material("pots", diffuse((0.45, 0.3, 0.2))), scene.material("stems", diffuse((0.2, 0.16, 0.08)))
    leaves = [scene.material("leaves", diffuse((0.15, 0.32, 0.07)))]
    floor.patch((-12, 0, 5.5), (24, 0, 0), (0, 0, -11), 8, 8)
    for sign in (-1, 1):
        xs = [-11 + 2.2 * k for k in range(11)]
        for story in (0, 1):
            y = 4.1 * story
            z = sign * 2.3 - 0.25
            for c in xs:
                column(stone, (c, y, sign * 2.3), 2.5, 0.22)
                stone.box((c - 0.16, y + 2.5, z), (c + 0.16, y + 3.86, z + 0.5))
            for a, b in zip(xs, xs[1:]):
                first = len(stone.vertices)
                arch(stone, a + 0.15, b - 0.15, 2.5, 0.5, z)
                for k in range(first, len(stone.vertices)):
                    v = stone.vertices[k]
                    stone.vertices[k] = (v[0], v[1] + y, *v[2:])
            lo, hi = sorted((sign * 2.0, sign * 5.5))
            stone.box((-12, y + 3.85, lo), (12, y + 4.1, hi))
        stone.box((-12, 0, min(sign * 5.4, sign * 5.6)), (12, 8.4, max(sign * 5.4, sign * 5.6)))
        for k, c in enumerate(xs[:-1]):
            if k % 2 == 0:
                cloth = cloths[k // 2 % 3]
                cloth.grid(40, 10, lambda s, t, c=c, sign=sign: ((c + 0.3 + 1.6 * s, 6.4 - 2.2 * t, sign * (1.8 + 0.08 * math.sin(22 * s) * (0.3 + t))),
                                                                 (-1.1 * math.cos(22 * s) * (0.3 + t), 0, sign), (s, t)))
            if rng.random() < 0.7:
                plant(rng, pots, stems, leaves, (c + 1.1, 0, sign * 1.5), rng.uniform(0.8, 1.2), 300)
    for x in (-12, 12):
        stone.box((x - 0.1, 0, -5.6), (x + 0.1, 8.4, 5.6))
    scene.sun_and_sky((0.25, 0.93, 0.27), 3)
    return scene, out / "arcade"


SCENES = {"courtyard": courtyard, "fair": fair, "room": room, "arcade": arcade}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES)
