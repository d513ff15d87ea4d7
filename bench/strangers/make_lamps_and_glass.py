#!/usr/bin/env python3
"""Writes seven more scenes that nobody tuned for (Mitsuba 3 XML, PLY and a PNG): lamps of many kinds, and glass that is more than a pane.

    bench/strangers/make_lamps_and_glass.py OUT [bottles glass screen gallery pool stair shop]

  bottles  bottles of colored glass, which absorbs, and a ball of clear glass on a table, by sun and sky from behind
  glass    balls of glass on a table under two bulbs, each a lamp within a ball of glass: no path from the eye finds what these light
  screen   a room at night, lit by the picture of a television and by one lamp within a shade
  gallery  spots on pictures and on bronze statues under a black ceiling; a block of glass on a pedestal
  pool     an indoor pool: sun and sky come in by a glazed wall, and to the bottom of the water by its waves
  stair    sharp gloss on floor and steps, a mirror and thin steel by a tall window
  shop     a street at night before lit shop windows of thick glass, and a car
"""
import math
import pathlib
import random
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_hard_scenes import furniture, room  # noqa: E402
from scene_parts import Scene, brushed, diffuse, number, rgb, write_scenes  # noqa: E402

GLASS = '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf>'


def gloss(color, alpha):
    return '<bsdf type="roughplastic">' + number("alpha", alpha) + rgb("diffuse_reflectance", color) + "</bsdf>"


def absorbing(per_meter):
    """A medium that only absorbs. Mitsuba takes colors up to 1, so the coefficient is in `scale`."""
    most = max(per_meter)
    return ('<medium name="interior" type="homogeneous">' + rgb("sigma_t", [a / most for a in per_meter]) + number("scale", most) +
            rgb("albedo", (0, 0, 0)) + "</medium>")


def write_png(path, rows):
    """`rows`: of pixels, each three bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + b"".join(bytes(p) for p in row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def bottles(out):
    scene = Scene("Bottles of colored glass on a table.", ((0.2, 1.35, 1.5), (0, 1.0, 0)), 45, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.7, 0.68, 0.62))), scene.material("floor", diffuse((0.3, 0.2, 0.12)))
    ceiling, cloth = scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), scene.material("cloth", diffuse((0.75, 0.75, 0.72)))
    room(wall, floor, ceiling, (2.5, 2.5), 2.6, [(-1, 1, 0.9, 2.2)])
    cloth.box((-0.8, 0.7, -0.4), (0.8, 0.75, 0.4), 0.01)
    for k, color in enumerate(((2, 30, 40), (35, 8, 30), (30, 30, 5), (3, 6, 40))):
        bottle = scene.single(f"bottle{k}", GLASS, absorbing(color))
        bottle.revolve((-0.55 + 0.36 * k, 0.752, -0.1 * (k % 2)),
                       [(0, 0), (0.06, 0), (0.065, 0.02), (0.065, 0.2), (0.03, 0.28), (0.025, 0.36), (0, 0.365)], 48, 4)
    scene.single("clear", GLASS).sphere((0.3, 0.83, 0.22), 0.075, 64)
    scene.sun_and_sky((0.3, 0.6, -0.8), 1)
    scene.lamp((0, 2.55, 0.8), (0.3, 0, 0), (0, 0, 0.3), (5, 4.8, 4.4))
    return scene, out / "bottles"


def glass(out):
    rng = random.Random(3)
    scene = Scene("Glass on a table under bulbs.", ((1.6, 1.5, 2.0), (0, 0.8, 0)), 50, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.7, 0.68, 0.64))), scene.material("floor", diffuse((0.3, 0.2, 0.12)))
    ceiling, top = scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), scene.material("top", diffuse((0.6, 0.5, 0.4)))
    balls, bulbs = scene.single("balls", GLASS), scene.single("bulbs", GLASS)
    room(wall, floor, ceiling, (2.5, 2.5), 2.5)
    top.box((-1, 0.68, -0.6), (1, 0.72, 0.6), 0.01)
    for _ in range(12):
        x, z, r = rng.uniform(-0.9, 0.9), rng.uniform(-0.5, 0.5), rng.uniform(0.06, 0.14)
        balls.sphere((x, 0.722 + r, z), r, 48)
    for x in (-0.5, 0.5):
        bulbs.sphere((x, 1.9, 0), 0.12, 48)
        scene.lamp((x, 1.9, 0), (0.03, 0, 0), (0, 0, 0.03), (900, 800, 640))
        scene.lamp((x, 1.901, 0), (0.03, 0, 0), (0, 0, -0.03), (900, 800, 640))
    return scene, out / "glass"


def screen(out):
    rng = random.Random(12)
    scene = Scene("A room lit by its television and a lamp.", ((2.2, 1.4, 2.3), (-1.0, 0.9, -1.2)), 62, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.5, 0.5, 0.55))), scene.material("floor", gloss((0.25, 0.15, 0.08), 0.08))
    ceiling, dark = scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), scene.material("dark", diffuse((0.04, 0.04, 0.04)))
    room(wall, floor, ceiling, (3, 2.8), 2.5)
    furniture(rng, [scene.material("wood", diffuse((0.35, 0.2, 0.1)))], [scene.material("red", diffuse((0.6, 0.1, 0.1)))], (1.6, 1.2), 8)
    dark.box((-1.9, 0.5, -2.75), (-0.1, 1.55, -2.7))
    folder = out / "screen"
    folder.mkdir(parents=True, exist_ok=True)
    tints = [(1, 0.3, 0.1) if x < 5 else (1, 1, 1) if x < 9 else (0.1, 0.4, 1) for x in range(16)]
    cells = [[[round(255 * t * rng.random() ** 3) for t in tints[x]] for x in range(16)] for _ in range(9)]
    write_png(folder / "picture.png", [[cells[y // 20][x // 20] for x in range(320)] for y in range(180)])
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><scale x="0.85" y="0.48"/><translate x="-1" y="1.02" z="-2.69"/></transform>' +
                          diffuse((0, 0, 0)) + '<emitter type="area"><texture name="radiance" type="bitmap"><string name="filename" value="picture.png"/>'
                          '<boolean name="raw" value="true"/></texture></emitter></shape>')
    scene.material("shade", diffuse((0.6, 0.55, 0.4))).revolve((2.2, 1.3, -2.2), [(0.16, 0), (0.1, 0.22)], 32, 2)
    scene.lamp((2.2, 1.4, -2.2), (0.02, 0, 0), (0, 0, 0.02), (300, 220, 120))
    return scene, folder


def gallery(out):
    rng = random.Random(13)
    scene = Scene("Spots on pictures and statues.", ((3.6, 1.7, 4.6), (-0.4, 1.3, -2)), 60, (640, 360))
    wall = scene.material("wall", diffuse((0.75, 0.75, 0.73)))
    floor = scene.material("floor", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.3, 0.2, 0.12)) + "</bsdf>")
    ceiling, frame = scene.material("ceiling", diffuse((0.15, 0.15, 0.15))), scene.material("frame", brushed("Au", 0.2, 0.2))
    bronze = scene.material("bronze", brushed("Cu", 0.12, 0.12))
    room(wall, floor, ceiling, (4.5, 5), 3.6)
    for k in range(5):
        x = -3.4 + 1.7 * k
        picture = scene.material(f"picture{k}", diffuse([0.8 * rng.random() ** 2 for _ in range(3)]))
        frame.box((x - 0.55, 1.1, -4.98), (x + 0.55, 2.2, -4.93), 0.01)
        picture.patch((x - 0.5, 1.15, -4.925), (1, 0, 0), (0, 1, 0))
        scene.spot((x, 3.5, -3.2), (x, 1.6, -4.95), (14, 12.5, 10), 22, 14)
    for k in range(3):
        x = -2.2 + 2.2 * k
        wall.box((x - 0.3, 0, -0.9), (x + 0.3, 1, -0.3), 0.01)
        bronze.revolve((x, 1, -0.6), [(0.2, 0), (0.08, 0.15), (0.22, 0.5), (0.05, 0.7), (0.14, 0.85), (0, 1.0)], 64, 6)
        scene.spot((x + 0.6, 3.5, 1.2), (x, 1.4, -0.6), (30, 28, 24), 16, 9)
    scene.single("block", GLASS).box((1.5, 1, 0.9), (2.1, 1.7, 1.5))
    wall.box((1.5, 0, 0.9), (2.1, 0.98, 1.5))
    return scene, out / "gallery"


def pool(out):
    scene = Scene("An indoor pool behind a glazed wall.", ((3.8, 1.8, 5.6), (-0.8, 0.4, -1)), 65, (640, 360))
    wall, deck = scene.material("wall", diffuse((0.7, 0.68, 0.64))), scene.material("deck", gloss((0.5, 0.45, 0.4), 0.15))
    ceiling, tiles = scene.material("ceiling", diffuse((0.75, 0.75, 0.75))), scene.material("tiles", diffuse((0.25, 0.55, 0.65)))
    wood = scene.material("wood", diffuse((0.4, 0.25, 0.12)))
    x, z, h = 5, 7, 4
    for lo, hi in (((-x - 0.2, -2, -z - 0.2), (-x, h, z + 0.2)), ((-x - 0.2, -2, z), (x + 0.2, h, z + 0.2)), ((-x - 0.2, -2, -z - 0.2), (x + 0.2, h, -z)),
                   ((x, -2, -z), (x + 0.2, 0.3, z))):
        wall.box(lo, hi)
    ceiling.box((-x - 0.2, h, -z - 0.2), (x + 0.4, h + 0.2, z + 0.2))
    for k in range(8):
        wall.box((x, -2, -z + 2 * z * k / 7 - 0.08), (x + 0.2, h, -z + 2 * z * k / 7 + 0.08))
    for lo, hi in (((-x, -0.2, -z), (-2.5, 0, z)), ((2.5, -0.2, -z), (x, 0, z)), ((-2.5, -0.2, -z), (2.5, 0, -5)), ((-2.5, -0.2, 4), (2.5, 0, z))):
        deck.box(lo, hi)
    for lo, hi in (((-2.7, -2, -5.2), (-2.5, -0.2, 4.2)), ((2.5, -2, -5.2), (2.7, -0.2, 4.2)), ((-2.7, -2, -5.2), (2.7, -0.2, -5)), ((-2.7, -2, 4), (2.7, -0.2, 4.2))):
        tiles.box(lo, hi)
    tiles.patch((-2.5, -1.7, 4), (5, 0, 0), (0, 0, -9))
    waves = ((3.1, 1.2, 0.012), (-1.7, 4.3, 0.008), (5.2, -3.1, 0.005))  # wave numbers along x and z, amplitude

    def surface(s, t):
        px, pz = -2.5 + 5 * s, 4 - 9 * t
        y, nx, nz = -0.15, 0.0, 0.0
        for kx, kz, a in waves:
            phase = kx * px + kz * pz
            y, nx, nz = y + a * math.sin(phase), nx - a * kx * math.cos(phase), nz - a * kz * math.cos(phase)
        return (px, y, pz), (nx, 1, nz), (s, t)
    scene.single("water", '<bsdf type="dielectric"><float name="int_ior" value="1.33"/></bsdf>').grid(100, 180, surface)
    scene.single("panes", '<bsdf type="thindielectric"/>').patch((x + 0.1, 0.3, z), (0, 0, -2 * z), (0, h - 0.3, 0))
    for k in range(4):
        wood.box((3.2, 0.25, -4 + 2.2 * k), (4.4, 0.35, -3 + 2.2 * k), 0.02)
    scene.sun_and_sky((0.8, 0.45, 0.15), 1)
    return scene, out / "pool"


def stair(out):
    scene = Scene("Stairs of polished wood and steel by a tall window.", ((1.6, 1.5, 3.4), (-0.3, 1.6, -1)), 70, (360, 640))
    wall, step = scene.material("wall", diffuse((0.8, 0.78, 0.74))), scene.material("step", gloss((0.35, 0.18, 0.08), 0.03))
    floor, ceiling = scene.material("floor", gloss((0.08, 0.08, 0.09), 0.02)), scene.material("ceiling", diffuse((0.8, 0.8, 0.8)))
    steel, vase = scene.material("steel", brushed("Cr", 0.02, 0.02)), scene.material("vase", gloss((0.1, 0.15, 0.5), 0.01))
    mirror = scene.material("mirror", '<bsdf type="conductor"><string name="material" value="Ag"/></bsdf>')
    room(wall, floor, ceiling, (2.4, 4), 5.2, [(-0.8, 1.4, 0.4, 4.6)])
    for k in range(14):
        y, z = 0.18 * (k + 1), 1.6 - 0.3 * k
        step.box((-2.4, y - 0.05, z - 0.3), (-1.0, y, z), 0.01)
        steel.tube([(-1.05, y, z - 0.15), (-1.05, y + 0.9, z - 0.15)], 0.012, 10)
    steel.tube([(-1.05, 1.1, 1.45), (-1.05, 1.1 + 0.18 * 13, 1.45 - 0.3 * 13)], 0.025, 16)
    vase.revolve((0.7, 0, 0.4), [(0.1, 0), (0.25, 0.3), (0.1, 0.7), (0.16, 0.9)], 64, 6)
    mirror.patch((2.38, 0.8, 2.6), (0, 0, -1.2), (0, 1.4, 0))
    for k in range(3):
        scene.lamp((-0.2 + 0.8 * k, 5.1, 1.5), (0.05, 0, 0), (0, 0, 0.05), (60, 50, 38))
    scene.sun_and_sky((-0.3, 0.5, -0.7), 1)
    return scene, out / "stair"


def shop(out):
    rng = random.Random(5)
    scene = Scene("A street at night before lit shop windows.", ((0.5, 1.7, 7.5), (-1.5, 1.6, -1)), 66, (640, 360))
    house, road = scene.material("house", diffuse((0.35, 0.25, 0.2))), scene.material("road", gloss((0.08, 0.08, 0.09), 0.2))
    inner, window = scene.material("inner", diffuse((0.7, 0.7, 0.65))), scene.single("window", GLASS)
    car = scene.material("car", '<bsdf type="principled">' + rgb("base_color", (0.6, 0.05, 0.04)) + number("roughness", 0.3) + number("metallic", 0.5) +
                         number("clearcoat", 1) + number("clearcoat_gloss", 0.95) + "</bsdf>")
    road.patch((-14, 0, 10), (28, 0, 0), (0, 0, -12), 4, 4)
    for k, light in enumerate(((60, 54, 42), (30, 42, 60), (60, 24, 36), (36, 60, 30))):
        x = -9 + 4.5 * k
        goods = scene.material(f"goods{k}", diffuse([rng.random() for _ in range(3)]))
        house.box((x, 3, -5), (x + 4.5, 7, -2))
        house.box((x, 0, -5), (x + 0.5, 3, -2))
        house.box((x + 4.0, 0, -5), (x + 4.5, 3, -2))
        house.box((x + 0.5, 2.7, -2.1), (x + 4, 3, -2))
        inner.box((x, 0, -5.2), (x + 4.5, 3, -5))
        inner.box((x + 0.5, -0.1, -5), (x + 4, 0.3, -2.05))
        window.box((x + 0.5, 0.3, -2.06), (x + 4, 2.7, -2.04))
        for j in range(8):
            r = 0.1 + 0.15 * rng.random()
            goods.sphere((x + 0.8 + 0.4 * j, 0.3 + r, -4.4 + 1.8 * rng.random()), r, 24)
        for j in range(6):
            scene.lamp((x + 0.9 + 0.55 * j, 2.95, -3.2), (0.06, 0, 0), (0, 0, 0.06), light)
    for k in range(3):
        x = -6 + 5 * k
        house.tube([(x, 0, 3), (x, 5, 3)], 0.06, 12)
        scene.lamp((x, 4.95, 3.2), (0.12, 0, 0), (0, 0, 0.12), (60, 45, 22))
    car.box((-4, 0.25, 1.0), (0, 0.9, 2.6), 0.2)
    car.box((-3.2, 0.85, 1.1), (-0.8, 1.45, 2.5), 0.25)
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.004, 0.005, 0.01)) + "</emitter>")
    return scene, out / "shop"


SCENES = {"bottles": bottles, "glass": glass, "screen": screen, "gallery": gallery, "pool": pool, "stair": stair, "shop": shop}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES)
