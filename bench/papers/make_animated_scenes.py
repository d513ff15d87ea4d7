#!/usr/bin/env python3
"""Writes six shots for the experiments of the 2008 paper (Mitsuba 3 XML with PLY, curves, and one glTF), of our own making; 48 frames at 24 per second.

    bench/papers/make_animated_scenes.py OUT [temple room cloth stage fur forest] [--frames 48] [--hairs 24000] [--trees 500]

  temple  nothing moves but the camera: a colonnade of fluted columns (instances), polished floor, lanterns, sun and sky
  room    a crate that turns, a metal ball that slides, a vase that does both, on a polished floor, under two area lamps
  cloth   a banner that waves (a mesh for every frame), before a wall in sun and sky, with a brass ball
  stage   lamps that move and switch (glTF, KHR_animation_pointer): panels one after the other, spots that sweep, a glowing ball that swings
  fur     the furry animal of make_fur_and_trees.py, turning on its place
  forest  500 instances of three trees, 8 million triangles in all; the camera flies over them

All can be read by `lumirank animate`. The fur has the BSDF "kajiyakay", which Mitsuba does not have; `lumirank convert` replaces it.
"""
import argparse
import math
import pathlib
import random

import make_fur_and_trees as nature
from moving_parts import Clock, Gltf, MovingScene, look, translated, turned
from scene_parts import Mesh, add, diffuse, mul, number, rgb, unit, ward

SUN = (0.55, 0.62, 0.56)


def conductor(material, alpha):
    return f'<bsdf type="roughconductor"><string name="material" value="{material}"/><string name="distribution" value="ggx"/>' + number("alpha", alpha) + "</bsdf>"


def polished(color, alpha):
    return ('<bsdf type="roughplastic"><string name="distribution" value="ggx"/>' + rgb("diffuse_reflectance", color) + number("int_ior", 1.5) +
            number("alpha", alpha) + "</bsdf>")


# --------------------------------------------------------------------------------------------------------------------------------------- temple


def fluted(mesh, radius, height, flutes, across, up):
    """A column with a slight swelling; its base is at the origin."""
    def at(s, t):
        a = 2 * math.pi * s
        groove = 0.055 * radius * abs(math.sin(flutes * a / 2))
        slope = 0.055 * radius * flutes / 2 * math.copysign(math.cos(flutes * a / 2), math.sin(flutes * a / 2))
        r = radius * (1 - 0.16 * t * t) - 0.055 * radius + groove
        n = (r * math.cos(a) + slope * math.sin(a), 0.32 * radius * t * r / height, r * math.sin(a) - slope * math.cos(a))
        return (r * math.cos(a), height * t, r * math.sin(a)), n, (s, t)
    mesh.grid(across, up, at, close_u=True)


def temple(args, clock):
    bays = 9

    def camera(s):
        return (1.1 - 1.7 * s, 1.75 + 0.25 * s, 10.6 - 5.2 * s), (-0.7 + 0.9 * s, 1.95, -4.0)
    scene = MovingScene("A colonnade; the camera walks through it.", clock, camera, 58, (640, 480))
    stone, floor = scene.material("stone", diffuse((0.62, 0.56, 0.46))), scene.material("floor", polished((0.34, 0.27, 0.21), 0.2))
    earth, bronze = scene.material("earth", diffuse((0.4, 0.34, 0.24))), scene.material("bronze", conductor("Cu", 0.25))
    floor.patch((-4.4, 0, 12), (8.8, 0, 0), (0, 0, -26), 22, 65)
    for k in range(4):  # steps all around
        stone.box((-4.8 - 0.35 * k, -0.17 * (k + 1), -14.4 - 0.35 * k), (4.8 + 0.35 * k, -0.17 * k - 0.004, 12.4 + 0.35 * k), 0.02)
    nature.hollow(earth, 170, 26, 11)
    earth.vertices = [(v[0], v[1] - 0.7, *v[2:]) for v in earth.vertices]
    column = Mesh()
    column.box((-0.56, 0, -0.56), (0.56, 0.22, 0.56), 0.03)
    fluted(column, 0.42, 4.3, 20, 240, 44)
    column.revolve((0, 4.28, 0), [(0.34, 0.0), (0.42, 0.1), (0.56, 0.24), (0.57, 0.3), (0.57, 0.3), (0.3, 0.31)], 64, 6)
    column.box((-0.62, 4.58, -0.62), (0.62, 4.78, 0.62), 0.02)
    count = scene.group("column", {"stone": column})
    for k in range(bays):
        for x in (-3.3, 3.3):
            scene.instance("column", translated((x, 0, 10.5 - 3 * k)))
    for x in (-3.3, 3.3):
        stone.box((x - 0.6, 4.78, -14.2), (x + 0.6, 5.6, 11.2), 0.03)
    for k in range(bays):  # beams, and gaps between them through which the sun falls
        stone.box((-3.9, 5.6, 10.1 - 3 * k), (3.9, 6.1, 10.9 - 3 * k), 0.03)
        stone.box((-3.9, 6.1, 9.3 - 3 * k), (3.9, 6.3, 11.7 - 3 * k), 0.03)
    stone.box((-4.4, 0, -14.4), (4.4, 5.6, -14.0), 0.02)
    stone.box((-1.3, 0, -13.2), (1.3, 0.7, -11.4), 0.03)
    bronze.revolve((0, 0.7, -12.3), [(0.5, 0), (0.5, 0.1), (0.5, 0.1), (0.2, 0.25), (0.16, 0.6), (0.5, 1.0), (0.85, 1.5), (0.9, 1.75), (0.86, 1.72), (0.4, 1.2)], 96, 8)
    for k in range(0, bays, 2):  # lanterns
        z = 9 - 3 * k
        for dx in (-0.2, 0.2):
            for dz in (-0.2, 0.2):
                bronze.box((dx - 0.02, 4.0, z + dz - 0.02), (dx + 0.02, 5.7, z + dz + 0.02))
        scene.lamp((0, 4.0, z), (0.2, 0, 0), (0, 0, 0.2), (46, 27, 12))
    scene.sun_and_sky((0.62, 0.6, 0.5), 2.2)
    print(f"temple: {count} triangles in each of {2 * bays} columns")
    return scene


# ----------------------------------------------------------------------------------------------------------------------------------------- room


def room(args, clock):
    def ball(s):
        return (-1.35 + 2.5 * s, 0.32, 0.95 - 0.25 * s)
    scene = MovingScene("Things turn and slide on a polished floor.", clock, lambda s: ((0.15, 1.75, 4.6), (0, 0.75, -0.2)), 46, (640, 480))
    wall, floor = scene.material("wall", diffuse((0.68, 0.65, 0.6))), scene.material("floor", polished((0.42, 0.3, 0.2), 0.15))
    red, blue = scene.material("red", diffuse((0.6, 0.12, 0.08))), scene.material("blue", diffuse((0.1, 0.2, 0.5)))
    crate, brass = scene.material("crate", polished((0.5, 0.36, 0.18), 0.2)), scene.material("brass", conductor("Au", 0.18))
    glaze = scene.material("glaze", polished((0.12, 0.4, 0.38), 0.1))
    floor.patch((-2.2, 0, 5), (4.4, 0, 0), (0, 0, -6.8), 22, 34)
    wall.patch((-2.2, 0, -1.8), (4.4, 0, 0), (0, 2.6, 0), 22, 13)
    wall.patch((-2.2, 2.6, -1.8), (4.4, 0, 0), (0, 0, 6.8), 22, 34)
    wall.patch((2.2, 0, 5), (-4.4, 0, 0), (0, 2.6, 0), 22, 13)
    red.patch((-2.2, 0, 5), (0, 0, -6.8), (0, 2.6, 0), 34, 13)
    blue.patch((2.2, 0, -1.8), (0, 0, 6.8), (0, 2.6, 0), 34, 13)
    wall.box((-2.2, 0, -1.8), (2.2, 0.09, -1.77))
    box = scene.moving("crate", lambda s: turned(20 + 150 * s) + translated((-0.75, 0.45, -0.55)))
    for k in range(3):  # slats around a core
        y = -0.45 + 0.31 * k
        box.box((-0.45, y, -0.45), (0.45, y + 0.28, 0.45), 0.02)
    box.box((-0.41, -0.44, -0.41), (0.41, 0.44, 0.41))
    scene.moving("brass", lambda s: turned(200 * s, (0, 0, 1)) + translated(ball(s))).sphere((0, 0, 0), 0.32, 64)
    vase = scene.moving("glaze", lambda s: turned(220 * s) + translated((0.95, 0, -0.75 + 0.85 * math.sin(math.pi * s))), 25)
    vase.revolve((0, 0, 0), [(0.2, 0), (0.24, 0.04), (0.36, 0.3), (0.3, 0.65), (0.12, 0.9), (0.2, 1.05), (0.19, 1.05), (0.1, 0.92)], 64, 8)
    vase.tube([(0.3, 0.6, 0), (0.46, 0.66, 0), (0.44, 0.86, 0), (0.14, 0.93, 0)], 0.035, 10)
    scene.lamp((-0.4, 2.58, 0.4), (0.45, 0, 0), (0, 0, 0.25), (15, 12.5, 9.5))
    scene.lamp((1.5, 2.3, 2.6), (0.22, 0, -0.22), (0.1, 0.25, 0.1), (9, 11, 15))
    return scene


# ---------------------------------------------------------------------------------------------------------------------------------------- cloth


def banner(s, wide, high, nu, nv):
    """Hangs from y = 0; waves run down it twice in a shot, the wider the farther below."""
    def place(u, v):
        free = v ** 1.3
        a = 2 * math.pi * (1.6 * u + 0.9 * v - 2 * s)
        b = 2 * math.pi * (0.7 * u - 1.7 * v + 3 * s)
        return (wide * (u - 0.5) + 0.03 * free * math.sin(b), -high * v * (1 - 0.03 * free), free * (0.2 * math.sin(a) + 0.09 * math.sin(b)) + 0.32 * free * (0.5 - 0.5 * math.cos(2 * math.pi * s)))

    def at(u, v):
        d = 1e-3
        p = place(u, v)
        x = tuple((b - a) / (2 * d) for a, b in zip(place(u - d, v), place(u + d, v)))
        y = tuple((b - a) / d for a, b in zip(place(u, v), place(u, v + d)))
        return p, (y[1] * x[2] - y[2] * x[1], y[2] * x[0] - y[0] * x[2], y[0] * x[1] - y[1] * x[0]), (u, v)
    mesh = Mesh()
    mesh.grid(nu, nv, at)
    return mesh


def cloth(args, clock):
    scene = MovingScene("A banner waves before a wall.", clock, lambda s: ((1.5, 1.5, 5.2), (0.1, 1.4, 0)), 42, (640, 480))
    plaster, floor = scene.material("plaster", diffuse((0.66, 0.6, 0.5))), scene.material("floor", polished((0.36, 0.33, 0.3), 0.2))
    scene.material("silk", ward((0.62, 0.08, 0.07), (0.06, 0.06, 0.06), 0.25))
    wood, brass = scene.material("wood", diffuse((0.25, 0.15, 0.08))), scene.material("brass", conductor("Au", 0.15))
    floor.patch((-8, 0, 8), (16, 0, 0), (0, 0, -9.2), 40, 23)
    plaster.patch((-8, 0, -1.2), (16, 0, 0), (0, 4.2, 0), 40, 12)
    plaster.box((-2.6, 0, -1.2), (-2.1, 4.2, 0.4), 0.02)
    plaster.box((2.4, 0, -1.2), (2.9, 4.2, 0.0), 0.02)
    plaster.box((-8, 4.2, -1.6), (8, 4.5, -0.9), 0.02)
    wood.tube([(-1.35, 2.78, 0), (1.35, 2.78, 0)], 0.035, 16)
    for x in (-1.3, 1.3):
        wood.tube([(x, 2.78, 0), (x, 2.78, -1.2)], 0.03, 12)
    brass.sphere((-1.25, 0.3, 0.75), 0.3, 48)
    wood.box((0.9, 0, 0.1), (1.7, 0.5, 0.7), 0.02, turn=20)

    def mesh_at(s):
        mesh = banner(s, 2.3, 2.25, args.weave, args.weave)
        mesh.vertices = [(v[0], v[1] + 2.74, v[2] + 0.04, *v[3:]) for v in mesh.vertices]
        return mesh
    scene.sequence("silk", "cloth", mesh_at)
    scene.sun_and_sky(unit((0.75, 0.62, 0.62)), 2.5)
    return scene


# ---------------------------------------------------------------------------------------------------------------------------------------- stage


def stage(args, clock):
    scene = Gltf(clock)
    scene.camera((0, 1.7, 6.2), 0, -3, 40, 4 / 3)
    matte, floor = scene.material("wall", (0.55, 0.53, 0.5)), scene.material("floor", (0.28, 0.24, 0.22), 0.35)
    marble, gold = scene.material("marble", (0.75, 0.72, 0.68), 0.5), scene.material("gold", (0.95, 0.7, 0.3), 0.3, 1.0)

    def still(name, material, build):
        mesh = Mesh()
        build(mesh)
        scene.mesh(mesh, material, name)

    def walls(m):
        m.patch((-4, 0, -2.5), (8, 0, 0), (0, 3.6, 0), 32, 14)
        m.patch((-4, 0, 7), (0, 0, -9.5), (0, 3.6, 0), 38, 14)
        m.patch((4, 0, -2.5), (0, 0, 9.5), (0, 3.6, 0), 38, 14)
        m.patch((-4, 3.6, -2.5), (8, 0, 0), (0, 0, 9.5), 32, 38)
        m.patch((4, 0, 7), (-8, 0, 0), (0, 3.6, 0), 32, 14)
    still("walls", matte, walls)
    still("floor", floor, lambda m: m.patch((-4, 0, 7), (8, 0, 0), (0, 0, -9.5), 32, 38))

    def plinths(m):
        for k in range(4):
            m.box((-2.75 + 1.6 * k, 0, -1.2 + 0.35 * (k % 2)), (-2.05 + 1.6 * k, 0.8, -0.5 + 0.35 * (k % 2)), 0.03)
    still("plinths", marble, plinths)

    def works(m):
        m.sphere((-2.4, 1.12, -0.85), 0.32, 48)
        m.revolve((0.8, 0.8, -0.85), [(0.26, 0), (0.1, 0.12), (0.08, 0.3), (0.3, 0.55), (0.28, 0.75), (0.12, 0.95), (0.0, 1.0)], 48, 6)
    still("gold works", gold, works)

    def others(m):
        m.box((-1.05, 0.8, -0.75), (-0.55, 1.55, -0.25), 0.04, turn=30)
        m.tube([(2.4 + 0.26 * math.cos(a), 1.2 + 0.26 * math.sin(a), -0.5) for a in (2 * math.pi * k / 40 for k in range(40))], 0.11, 20, closed=True)
    still("marble works", marble, others)

    # Panels in the ceiling: on one after the other, each for half of the shot; one is dim and always on.
    for k in range(4):
        x = -2.4 + 1.6 * k
        panel = Mesh()
        panel.patch((x - 0.35, 3.58, -0.9), (0.7, 0, 0), (0, 0, 0.7))
        tint = ((1, 0.82, 0.6), (0.75, 0.9, 1), (1, 0.65, 0.5), (0.8, 1, 0.8))[k]
        glow = scene.material(f"panel{k}", (0, 0, 0), emissive=tint, strength=9.0)
        scene.mesh(panel, glow, f"panel{k}")
        scene.animate(f"/materials/{glow}/emissiveFactor", "VEC3", lambda s, k=k, tint=tint: tint if (s - 0.25 * k) % 1 < 0.5 else (0, 0, 0), 9, "STEP")
    night = Mesh()
    night.patch((-0.5, 3.58, 3.0), (1, 0, 0), (0, 0, 0.5))
    scene.mesh(night, scene.material("night", (0, 0, 0), emissive=(1, 0.9, 0.8), strength=3.0), "night")
    # A glowing ball that swings.
    ball = Mesh()
    ball.sphere((0, 0, 0), 0.13, 32)
    swing = scene.mesh(ball, scene.material("lantern", (0, 0, 0), emissive=(1, 0.55, 0.2), strength=30), "lantern", (0, 1.5, 0.6))
    scene.animate((swing, "translation"), "VEC3", lambda s: (1.9 * math.cos(math.pi * s), 1.75 + 0.5 * abs(math.cos(math.pi * s)), 0.7), 25)
    # Two spots that sweep over the back wall; one of them changes its color.
    for k, color in enumerate(((1, 0.3, 0.35), (0.3, 0.45, 1))):
        x = -2.5 + 5 * k
        spot = scene.lamp({"type": "spot", "name": f"spot{k}", "color": list(color), "intensity": 60, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.32}},
                          {"translation": [x, 3.3, 3.0]})
        side = 1 - 2 * k

        def turn(s, side=side):
            half_yaw, half_pitch = math.radians(side * (12 - 45 * s)) / 2, math.radians(-22) / 2
            return (math.cos(half_yaw) * math.sin(half_pitch), math.sin(half_yaw) * math.cos(half_pitch), -math.sin(half_yaw) * math.sin(half_pitch),
                    math.cos(half_yaw) * math.cos(half_pitch))
        scene.animate((spot, "rotation"), "VEC4", turn, 13)
    scene.animate("/extensions/KHR_lights_punctual/lights/1/color", "VEC3", lambda s: (0.3 + 0.7 * s, 0.45, 1 - 0.7 * s), 7)
    return scene


# ------------------------------------------------------------------------------------------------------------------------------------------ fur


def fur(args, clock):
    rng = random.Random(11)
    scene = MovingScene("A furry animal turns.", clock, lambda s: ((1.75, 1.35, 3.35), (0, 0.83, 0.12)), 36, (640, 640))
    floor = scene.material("floor", polished((0.4, 0.38, 0.35), 0.25))
    scene.material("skin", diffuse((0.22, 0.14, 0.09)))
    scene.material("dark", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.02, 0.015, 0.01)) + "</bsdf>")
    scene.material("pink", diffuse((0.5, 0.22, 0.2)))
    nature.hollow(floor, 9, 2.2, 2.4)

    def turn(s):
        return turned(-35 + 95 * s)
    skin, dark, pink = (scene.moving(name, turn, 5, f"animal_{name}") for name in ("skin", "dark", "pink"))
    for part in nature.ANIMAL:
        part.skin(skin)
    for eye in nature.EYES:
        dark.sphere(eye, 0.062, 32)
    pink.sphere(nature.NOSE, 0.04, 24)
    folder = args.out / "fur"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fur.txt").write_text("\n".join(nature.hair_lines(rng, args.hairs)) + "\n")
    bsdf = ('<bsdf type="kajiyakay">' + rgb("diffuse_reflectance", (0.62, 0.43, 0.25)) + rgb("specular_reflectance", (0.16, 0.15, 0.14)) + number("exponent", 45) +
            "</bsdf>")
    scene.emitters.append('<shape type="bsplinecurve" id="hair"><string name="filename" value="fur.txt"/>' + clock.animation(turn, 5) + bsdf + "</shape>")
    scene.sun_and_sky(SUN, 2)
    scene.lamp((-2.6, 2.4, 1.2), (0.35, 0, 0.78), (0.5, 0.66, -0.22), (40, 34, 26))
    return scene


# --------------------------------------------------------------------------------------------------------------------------------------- forest


def hills(x, z):
    far = max(0.0, min(1.0, (math.hypot(x, z) - 75) / 125))  # a rim, so that nobody sees the end
    return 1.7 * math.sin(0.085 * x + 0.6) * math.cos(0.07 * z) + 0.6 * math.sin(0.21 * x - 0.17 * z) + 24 * far * far * (3 - 2 * far)


def tree(rng, triangles, crown):
    """A tree of a given number of triangles: bark first, the rest are leaves; `crown`: their size."""
    bark, leaves, twigs = Mesh(), Mesh(), []
    nature.branch(rng, bark, twigs, (0, -0.2, 0), (0, 1, 0), 2.3, 0.17, 0)
    while len(bark.triangles) + len(leaves.triangles) + 2 <= triangles:
        a, b = twigs[rng.randrange(len(twigs))]
        out = unit(add(add(nature.sub(b, a), mul(nature.on_sphere(rng), 0.25)), (0, -0.06, 0)))
        nature.leaf(leaves, rng, nature.lerp(a, b, rng.random()), out, rng.uniform(0.8, 1.3) * crown)
    return bark, leaves


def forest(args, clock):
    rng = random.Random(5)

    def camera(s):
        a = math.radians(-28 + 34 * s)
        return (44 * math.sin(a), 12 - 3 * s, 44 * math.cos(a) - 9 * s), (3 * s, 4.2, -4)
    scene = MovingScene("A forest; the camera flies over it.", clock, camera, 40, (640, 480))
    ground = scene.material("ground", diffuse((0.2, 0.2, 0.09)))
    scene.material("bark", diffuse((0.19, 0.13, 0.09)))
    for k, color in enumerate(((0.14, 0.32, 0.06), (0.27, 0.4, 0.07), (0.5, 0.3, 0.06))):
        scene.material(f"leaf{k}", polished(color, 0.35))

    def land(s, t):
        x, z, d = 440 * (s - 0.5), 440 * (0.5 - t), 0.05
        n = (hills(x - d, z) - hills(x + d, z), 2 * d, hills(x, z - d) - hills(x, z + d))
        return (x, hills(x, z), z), n, (s, t)
    ground.grid(160, 160, land)
    each = 0
    for k in range(3):
        bark, leaves = tree(rng, 16000, (0.2, 0.24, 0.18)[k])
        each = scene.group(f"tree{k}", {"bark": bark, f"leaf{k}": leaves})
    places = []
    while len(places) < args.trees:
        x, z = rng.uniform(-55, 55), rng.uniform(-60, 34)
        if x * x + (z + 6) ** 2 > 36 and all((x - p) ** 2 + (z - q) ** 2 > 2.6 ** 2 for p, q in places):  # around a glade
            places.append((x, z))
            scene.instance(f"tree{rng.randrange(3)}", f'<scale value="{rng.uniform(0.75, 1.25):.4g}"/>' + turned(rng.uniform(0, 360)) + translated((x, hills(x, z), z)))
    scene.sun_and_sky(unit((0.65, 0.5, 0.35)), 3)
    print(f"forest: {args.trees} instances of {each} triangles, {args.trees * each / 1e6:.1f} million in all")
    return scene


SCENES = {"temple": temple, "room": room, "cloth": cloth, "stage": stage, "fur": fur, "forest": forest}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", metavar="scene", help=f"{', '.join(SCENES)}; default: all")
    parser.add_argument("--frames", type=int, default=48, help="in which the same motion is shown; default 48, two seconds")
    parser.add_argument("--hairs", type=int, default=24000)
    parser.add_argument("--trees", type=int, default=500)
    parser.add_argument("--weave", type=int, default=64, help="pieces of the banner along an edge; default 64")
    args = parser.parse_args()
    if args.frames < 2:
        parser.error("a shot has at least two frames")
    for name in args.scenes or SCENES:
        if name not in SCENES:
            parser.error(f"there is no scene {name}; the scenes are {', '.join(SCENES)}")
        scene = SCENES[name](args, Clock(args.frames))
        print(f"{name}: {scene.write(args.out / name)} triangles in files", flush=True)


if __name__ == "__main__":
    main()
