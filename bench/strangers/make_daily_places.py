#!/usr/bin/env python3
"""Writes six more scenes that nobody tuned for (Mitsuba 3 XML, PLY and PNG): places of every day.

    bench/strangers/make_daily_places.py OUT [bathroom studio tunnel concert greenhouse cove]

  bathroom    globes of frosted glass beside a mirror, tiles, chrome, a shower screen
  studio      products on a white sweep under soft boxes
  tunnel      a hundred meters of wet road under two rows of lamps
  concert     colored spots in haze
  greenhouse  sun through a roof of panes, plants of cut-out leaves
  cove        lights hidden behind ledges: all light has been reflected at least once
"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_hard_scenes import furniture, room  # noqa: E402
from make_lamps_and_glass import gloss, write_png  # noqa: E402
from make_small_and_colored import BITMAP, RAW, folder_of  # noqa: E402
from scene_parts import Scene, add, brushed, diffuse, number, rgb, write_scenes  # noqa: E402


def bulb(center, radius, radiance):
    x, y, z = center
    return (f'<shape type="sphere"><point name="center" x="{x}" y="{y}" z="{z}"/>' + number("radius", radius) + diffuse((0, 0, 0)) +
            '<emitter type="area">' + rgb("radiance", radiance) + "</emitter></shape>")


def bathroom(out):
    folder = folder_of(out, "bathroom")
    scene = Scene("Frosted globes beside a mirror.", ((1.25, 1.55, 1.75), (-0.35, 1.05, -1.2)), 66, (640, 360))

    def tile(x, y):
        u, v = x % 32, y % 32
        nx = -0.5 if u < 2 else 0.5 if u > 29 else 0.0
        ny = -0.5 if v < 2 else 0.5 if v > 29 else 0.0
        return tuple(round(127.5 * (c + 1)) for c in (nx, ny, math.sqrt(1 - nx * nx - ny * ny)))
    write_png(folder / "tiles.png", [[tile(x, y) for x in range(256)] for y in range(256)])
    tiles = '<bsdf type="normalmap">' + BITMAP.format("normalmap", "tiles.png", RAW) + gloss((0.62, 0.66, 0.64), 0.06) + "</bsdf>"
    walls, floor = scene.material("walls", tiles), scene.material("floor", gloss((0.16, 0.16, 0.17), 0.1))
    ceiling, china = scene.material("ceiling", diffuse((0.8, 0.8, 0.78))), scene.material("china", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.8, 0.8, 0.78)) + "</bsdf>")
    chrome, mirror = scene.material("chrome", '<bsdf type="conductor"><string name="material" value="Cr"/></bsdf>'), scene.material("mirror", '<bsdf type="conductor"><string name="material" value="Ag"/></bsdf>')
    wood, towel = scene.material("wood", gloss((0.3, 0.16, 0.07), 0.2)), scene.material("towel", diffuse((0.1, 0.28, 0.35)))
    room(walls, floor, ceiling, (1.7, 2.0), 2.5)
    wood.box((-1.3, 0.45, -2.0), (0.5, 0.85, -1.45), 0.01)
    for x in (-0.85, 0.05):
        china.revolve((x, 0.85, -1.72), [(0.05, 0.0), (0.16, 0.02), (0.21, 0.12), (0.215, 0.13), (0.2, 0.12), (0.14, 0.04), (0, 0.03)], 48, 4)
        chrome.tube([(x, 0.85, -1.93), (x, 1.1, -1.93), (x, 1.16, -1.88), (x, 1.14, -1.78), (x, 1.08, -1.76)], 0.013, 14)
    mirror.box((-1.3, 1.2, -2.0), (0.5, 2.1, -1.985))
    frosted = scene.single("frosted", '<bsdf type="roughdielectric">' + number("alpha", 0.35) + number("int_ior", 1.5) + "</bsdf>")
    for x in (-1.45, 0.65):
        frosted.sphere((x, 1.7, -1.86), 0.1, 48)
        frosted.sphere((x, 1.7, -1.86), 0.094, 48)
        scene.emitters.append(bulb((x, 1.7, -1.86), 0.03, (260, 215, 160)))
        chrome.tube([(x, 1.7, -2.0), (x, 1.7, -1.96)], 0.03, 16)
    screen = scene.single("screen", '<bsdf type="dielectric">' + number("int_ior", 1.5) + "</bsdf>")
    screen.box((1.0, 0.02, -1.95), (1.01, 2.0, -0.7))
    chrome.tube([(1.6, 1.0, -1.9), (1.6, 2.15, -1.9), (1.5, 2.25, -1.7), (1.45, 2.2, -1.5)], 0.012, 12)
    chrome.revolve((1.45, 2.15, -1.5), [(0.1, 0), (0.1, 0.015), (0.02, 0.05)], 32, 2)
    towel.box((-1.7, 0.7, -0.6), (-1.66, 1.3, 0.0), 0.01)
    chrome.tube([(-1.66, 1.3, -0.65), (-1.66, 1.3, 0.05)], 0.01, 10)
    scene.lamp((0.3, 2.49, 0.6), (0.15, 0, 0), (0, 0, 0.15), (5, 4.6, 4))
    return scene, folder


def studio(out):
    scene = Scene("Products on a white sweep.", ((0.0, 0.75, 2.6), (0.0, 0.32, 0)), 36, (640, 360))
    white = scene.material("white", diffuse((0.9, 0.9, 0.9)))

    def sweep(s, t):
        x = -4 + 8 * s
        if t < 0.4:
            return (x, 0, 3.5 - 4.5 * t / 0.4), (0, 1, 0), (s, t)
        if t < 0.6:
            a = (t - 0.4) / 0.2 * math.pi / 2
            return (x, 1 - math.cos(a), -1 - math.sin(a)), (0, math.cos(a), math.sin(a)), (s, t)
        return (x, 1 + 4 * (t - 0.6) / 0.4, -2), (0, 0, 1), (s, t)
    white.grid(4, 60, sweep)
    steel, black = scene.material("steel", brushed("Al", 0.06, 0.25)), scene.material("black", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.01, 0.01, 0.012)) + "</bsdf>")
    gold, card = scene.material("gold", brushed("Au", 0.05, 0.05)), scene.material("card", gloss((0.55, 0.07, 0.05), 0.25))
    steel.revolve((-0.55, 0, 0), [(0, 0), (0.2, 0), (0.2, 0), (0.19, 0.2), (0.12, 0.36), (0.05, 0.4), (0.02, 0.44)], 96, 6)
    black.box((-0.22, 0, -0.35), (0.12, 0.5, -0.1), 0.02, 0, 15)
    gold.revolve((0.32, 0, 0.2), [(0.0, 0), (0.06, 0), (0.06, 0), (0.06, 0.1), (0.05, 0.13), (0.05, 0.2), (0.04, 0.21), (0, 0.21)], 64, 4)
    card.box((0.45, 0, -0.25), (0.75, 0.28, 0.0), 0.004, 0, -20)
    glass = scene.single("glass", '<bsdf type="dielectric">' + number("int_ior", 1.5) + "</bsdf>")
    glass.revolve((0.02, 0.001, 0.35), [(0, 0), (0.07, 0), (0.07, 0), (0.08, 0.22), (0.08, 0.22), (0.074, 0.22), (0.074, 0.22), (0.065, 0.02), (0, 0.02)], 72, 6)
    scene.lamp((-1.5, 1.5, 1.0), (0.25, 0.0, 0.43), (0.33, 0.5, -0.2), (9, 9, 9.3))
    scene.lamp((1.6, 1.2, 0.6), (0.15, 0, -0.4), (-0.3, 0.5, 0), (4, 3.9, 3.7))
    scene.lamp((0, 2.2, -0.6), (0.8, 0, 0), (0, 0.05, 0.12), (14, 14, 14))
    return scene, out / "studio"


def tunnel(out):
    rng = random.Random(32)
    scene = Scene("A tunnel with a wet road.", ((1.2, 1.5, 2.0), (-0.6, 1.9, -30)), 64, (640, 360))
    road, wall = scene.material("road", '<bsdf type="roughplastic">' + rgb("diffuse_reflectance", (0.08, 0.08, 0.085)) + number("alpha", 0.12) + "</bsdf>"), scene.material("wall", diffuse((0.45, 0.44, 0.4)))
    paint, steel = scene.material("paint", diffuse((0.7, 0.7, 0.65))), scene.material("steel", brushed("Al", 0.2, 0.2))
    road.patch((-4.5, 0, 4), (9, 0, 0), (0, 0, -124), 2, 12)
    wall.grid(24, 12, lambda s, t: ((-4.5 * math.cos(math.pi * s), 1.2 + 4.2 * math.sin(math.pi * s), 4 - 124 * t), (math.cos(math.pi * s), -math.sin(math.pi * s), 0), (s, t)))
    for x in (-4.5, 4.5):
        wall.box((min(x, 0.92 * x), 0, -120), (max(x, 0.92 * x), 1.2, 4))
    wall.box((-5, 0, 4), (5, 6, 4.2))
    wall.box((-5, 0, -120.2), (5, 6, -120))
    for k in range(30):
        paint.box((-0.08, 0, -2 - 4 * k), (0.08, 0.004, 0 - 4 * k))
    for k in range(40):
        for x in (-2.2, 2.2):
            scene.lamp((x, 4.75, 2 - 3 * k), (0.1, 0, 0), (0, 0, 0.5), (30, 20, 8) if k % 8 else (4, 16, 6))
            steel.box((x - 0.15, 4.76, 1.4 - 3 * k), (x + 0.15, 4.85, 2.6 - 3 * k))
    for k, color in enumerate(((0.5, 0.03, 0.03), (0.03, 0.1, 0.4), (0.5, 0.5, 0.5), (0.3, 0.3, 0.05))):
        body = scene.material(f"car{k}", '<bsdf type="roughplastic">' + rgb("diffuse_reflectance", color) + number("alpha", 0.04) + "</bsdf>")
        x, z = (2.1 if k % 2 else -2.0), -7 - 9 * k - rng.uniform(0, 3)
        body.box((x - 0.85, 0.25, z - 2.1), (x + 0.85, 0.85, z + 2.1), 0.15)
        body.box((x - 0.7, 0.8, z - 1.1), (x + 0.7, 1.4, z + 1.2), 0.2)
        for side in (-0.55, 0.55):
            scene.lamp((x + side, 0.65, z + 2.11), (0.12, 0, 0), (0, 0.06, 0), (40, 1.5, 1))
    return scene, out / "tunnel"


def concert(out):
    rng = random.Random(33)
    scene = Scene("Colored spots in haze.", ((0.6, 1.7, 8.5), (0, 2.4, -2)), 60, (640, 360))
    scene.lines[2] = '\t<integrator type="volpath"><integer name="max_depth" value="-1"/></integrator>'
    haze = ('<medium id="haze" type="homogeneous">' + rgb("sigma_t", (0.05, 0.05, 0.052)) + rgb("albedo", (0.95, 0.95, 0.95)) + '<phase type="hg"><float name="g" value="0.4"/></phase></medium>')
    scene.lines.insert(2, "\t" + haze)
    at = next(k for k, line in enumerate(scene.lines) if "<sampler" in line)
    scene.lines.insert(at, '\t\t<ref id="haze"/>')
    floor, cloth = scene.material("floor", gloss((0.1, 0.09, 0.09), 0.15)), scene.material("cloth", diffuse((0.12, 0.02, 0.03)))
    walls, steel = scene.material("walls", diffuse((0.25, 0.25, 0.27))), scene.material("steel", brushed("Al", 0.2, 0.2))
    skin = scene.material("figures", diffuse((0.35, 0.25, 0.2)))
    room(walls, floor, walls, (6.5, 9.5), 7)
    floor.box((-5, 0, -9), (5, 0.8, -3), 0.02)
    for k in range(24):
        cloth.revolve((-5.5 + 0.48 * k, 0.8, -9.0), [(0.2, 0), (0.22, 2), (0.2, 5.5)], 12, 2)
    for k in range(5):
        p = (-2.8 + 1.4 * k, 0.8, -5 + 0.7 * (k % 2))
        skin.revolve(p, [(0.15, 0), (0.2, 0.7), (0.25, 1.3), (0.08, 1.5), (0.12, 1.62), (0.1, 1.75), (0, 1.8)], 24, 4)
    steel.box((-1.2, 0.8, -6.8), (1.2, 1.5, -6.2), 0.03)
    for z in (-3.5, -6.5):
        steel.tube([(-6, 6.2, z), (6, 6.2, z)], 0.06, 10)
        for k in range(7):
            x = -4.8 + 1.6 * k
            color = rng.choice(((60, 8, 6), (8, 20, 70), (60, 40, 10), (10, 55, 20), (45, 8, 50)))
            scene.spot((x, 6.0, z), (x + rng.uniform(-2.5, 2.5), 0.8, z - 1 + rng.uniform(-1.5, 3)), color, 11, 7)
    scene.lamp((0, 6.9, 4), (0.4, 0, 0), (0, 0, 0.4), (0.6, 0.6, 0.7))
    scene.emitters.append('<shape type="cube"><transform name="to_world"><scale x="6.45" y="3.49" z="9.45"/><translate x="0" y="3.5" z="0"/></transform>'
                          '<bsdf type="null"/><ref name="interior" id="haze"/></shape>')
    return scene, out / "concert"


def greenhouse(out):
    rng = random.Random(34)
    folder = folder_of(out, "greenhouse")
    scene = Scene("Sun through a roof of panes.", ((0.5, 1.65, 5.6), (-0.2, 1.6, -2)), 66, (640, 360))
    leaf = [[255 if abs(y - 32) < 14 * math.sin(math.pi * x / 63) ** 0.8 else 0 for x in range(64)] for y in range(64)]
    write_png(folder / "leaf.png", [[(v, v, v) for v in row] for row in leaf])
    soil, path = scene.material("soil", diffuse((0.1, 0.07, 0.05))), scene.material("path", diffuse((0.45, 0.42, 0.38)))
    iron, clay = scene.material("iron", diffuse((0.7, 0.72, 0.7))), scene.material("clay", diffuse((0.5, 0.22, 0.12)))
    leaves = [scene.single(f"leaves{k}", '<bsdf type="mask">' + BITMAP.format("opacity", "leaf.png", RAW) + '<bsdf type="twosided">' + gloss(color, 0.3) + "</bsdf></bsdf>")
              for k, color in enumerate(((0.12, 0.35, 0.08), (0.25, 0.45, 0.1), (0.08, 0.25, 0.12)))]
    pane = scene.single("pane", '<bsdf type="thindielectric"/>')
    soil.patch((-30, -0.01, 30), (60, 0, 0), (0, 0, -60), 2, 2)
    path.box((-0.6, 0, -6), (0.6, 0.02, 6))
    x, z, eaves, ridge = 3.2, 6.0, 2.2, 3.8
    for k in range(13):
        at = -z + k
        iron.tube([(-x, 0, at), (-x, eaves, at), (0, ridge, at), (x, eaves, at), (x, 0, at)], 0.025, 8)
        if k < 12:
            for side in (-1, 1):
                pane.patch((side * x, 0.5, at), (0, eaves - 0.5, 0), (0, 0, 1))
                pane.patch((side * x, eaves, at), (-side * x, ridge - eaves, 0), (0, 0, 1))
    for side in (-1, 1):
        iron.box((side * x - 0.06, 0, -z), (side * x + 0.06, 0.5, z))
        iron.tube([(side * x, eaves, -z), (side * x, eaves, z)], 0.03, 8)
        soil.box((min(side * 0.7, side * 3.0), 0, -5.8), (max(side * 0.7, side * 3.0), 0.5, 5.5), 0.01)
    iron.tube([(0, ridge, -z), (0, ridge, z)], 0.03, 8)
    for plant in range(46):
        side = rng.choice((-1, 1))
        at = (side * rng.uniform(0.9, 2.7), 0.5, rng.uniform(-5.5, 4.5))
        if rng.random() < 0.5:
            clay.revolve(at, [(0.1, 0), (0.15, 0.25), (0.16, 0.26), (0.13, 0.24), (0, 0.23)], 24, 2)
            at = add(at, (0, 0.24, 0))
        mesh, count, size = rng.choice(leaves), rng.randint(14, 34), rng.uniform(0.3, 0.8)
        for _ in range(count):
            a, b = rng.uniform(0, 2 * math.pi), rng.uniform(0.3, 1.3)
            u = (size * math.cos(a) * math.cos(b), size * math.sin(b), size * math.sin(a) * math.cos(b))
            v = (-0.35 * size * math.sin(a), 0.08 * size * rng.uniform(-1, 1), 0.35 * size * math.cos(a))
            mesh.patch(add(at, (-0.5 * v[0], -0.5 * v[1] + 0.15 * rng.random(), -0.5 * v[2])), u, v)
    scene.sun_and_sky((0.55, 0.75, 0.3), 1)
    return scene, folder


def cove(out):
    rng = random.Random(35)
    scene = Scene("Lights hidden behind ledges.", ((3.6, 1.6, 3.4), (-1.0, 1.15, -1.4)), 68, (640, 360))
    walls, floor = scene.material("walls", diffuse((0.74, 0.72, 0.68))), scene.material("floor", gloss((0.28, 0.17, 0.09), 0.12))
    ceiling, panel = scene.material("ceiling", diffuse((0.84, 0.84, 0.82))), scene.material("panel", diffuse((0.3, 0.19, 0.12)))
    cloths, desk = [scene.material("blue", diffuse((0.12, 0.2, 0.42)))], scene.material("desk", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.03, 0.03, 0.03)) + "</bsdf>")
    x, z = 4.2, 3.8
    room(walls, floor, ceiling, (x, z), 3.0)
    for side in (-1, 1):
        walls.box((min(side * x, side * (x - 0.35)), 2.55, -z), (max(side * x, side * (x - 0.35)), 2.6, z))
        walls.box((min(side * (x - 0.35), side * (x - 0.38)), 2.55, -z), (max(side * (x - 0.35), side * (x - 0.38)), 2.75, z))
        scene.lamp((side * (x - 0.1), 2.63, 0), (0, 0, 3.6), (0.02, 0, 0), (150, 118, 80))
    walls.box((-x, 2.55, -z), (x, 2.6, -z + 0.35))
    walls.box((-x, 2.55, -z + 0.35), (x, 2.75, -z + 0.38))
    scene.lamp((0, 2.63, -z + 0.1), (0.02, 0, 0), (0, 0, 0.02), (150, 118, 80))
    scene.lamp((0, 2.63, -z + 0.12), (0, 0, 0.02), (3.6, 0, 0), (110, 90, 70))
    panel.box((-2.4, 0.3, -z), (1.6, 2.2, -z + 0.08))
    for at in (-2.42, 1.62):
        panel.box((at - 0.02, 0.25, -z), (at + 0.02, 2.25, -z + 0.16))
    scene.lamp((-0.4, 0.24, -z + 0.04), (1.9, 0, 0), (0, 0, 0.02), (40, 50, 70))
    desk.box((-1.4, 0.72, -1.6), (0.9, 0.76, -0.6), 0.005)
    for px in (-1.3, 0.8):
        panel.box((px - 0.04, 0, -1.5), (px + 0.04, 0.72, -0.7))
    furniture(rng, [panel], cloths, (2.8, 2.2), 7)
    return scene, out / "cove"


if __name__ == "__main__":
    write_scenes(__doc__, {"bathroom": bathroom, "studio": studio, "tunnel": tunnel, "concert": concert, "greenhouse": greenhouse, "cove": cove})
