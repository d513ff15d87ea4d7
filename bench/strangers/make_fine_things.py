#!/usr/bin/env python3
"""Writes nine more scenes that nobody tuned for (Mitsuba 3 XML, PLY and PNG): fine detail, and what is blurred on purpose.

    bench/strangers/make_fine_things.py OUT [bokeh candles white fence prints jewels pendants crystal reflectors]

  bokeh       a figure in focus before a hundred small lamps that are not
  candles     a table laid for six by the light of twelve flames, four of them in glasses
  white       a gallery of white walls, lit by slots in its ceiling: light is reflected many times
  fence       a fence of wire, a cut-out picture, before a checkered yard in the sun
  prints      floor and table whose gloss is a picture: its detail is in reflections alone
  jewels      cut stones of high index, gold and pearls on dark cloth under three small lamps
  pendants    lamps within shades of thin cloth, through which most of their light comes
  crystal     a ball and a block of glass and a ring of brass in the sun, on a wide table
  reflectors  small lamps in cups of mirror, behind glass, from which half of the light comes
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
from scene_parts import Scene, brushed, diffuse, number, rgb, write_scenes  # noqa: E402

GLASS = '<bsdf type="dielectric"/>'


def bokeh(out):
    rng = random.Random(31)
    scene = Scene("Small lamps out of focus.", ((0, 1.25, 2.2), (0, 1.1, 0)), 38, (640, 360))
    scene.lines = [line.replace('type="perspective">', 'type="thinlens">' + number("aperture_radius", 0.035) + number("focus_distance", 2.15)) for line in scene.lines]
    wall, floor = scene.material("wall", diffuse((0.3, 0.28, 0.3))), scene.material("floor", gloss((0.2, 0.15, 0.12), 0.1))
    room(wall, floor, wall, (6, 9), 4)
    scene.material("figure", gloss((0.6, 0.25, 0.15), 0.15)).revolve((-0.25, 0.8, 0), [(0.16, 0), (0.12, 0.05), (0.06, 0.25), (0.14, 0.42), (0.07, 0.56), (0.09, 0.68), (0.0, 0.78)], 64, 8)
    scene.material("brass", brushed("Au", 0.08, 0.08)).revolve((0.3, 0.8, 0.1), [(0.13, 0), (0.1, 0.02), (0.03, 0.2), (0.1, 0.3), (0.12, 0.42)], 64, 8)
    scene.material("table", gloss((0.25, 0.16, 0.1), 0.12)).box((-1.2, 0.74, -0.5), (1.2, 0.8, 0.6), 0.01)
    leaves = scene.material("leaves", diffuse((0.1, 0.3, 0.1)))
    for k in range(110):
        x, y, z = rng.uniform(-4, 4), rng.uniform(0.4, 3.4), rng.uniform(-8, -3)
        color = rng.choice(((90, 60, 25), (90, 75, 50), (80, 25, 20), (30, 60, 90)))
        scene.emitters.append(bulb((x, y, z), 0.018, color))
        for _ in range(4):
            leaves.sphere((x + rng.gauss(0, 0.2), y + rng.gauss(0, 0.2), z + rng.gauss(0, 0.2)), 0.07, 12)
    scene.lamp((1.6, 2.6, 1.8), (0.25, 0, 0.2), (0, 0.2, -0.1), (9, 8.5, 8))
    return scene, out / "bokeh"


def candles(out):
    scene = Scene("A table by the light of candles.", ((1.9, 1.65, 1.9), (-0.1, 0.8, -0.2)), 50, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.45, 0.3, 0.25))), scene.material("floor", gloss((0.2, 0.13, 0.08), 0.15))
    room(wall, floor, scene.material("ceiling", diffuse((0.7, 0.7, 0.68))), (3, 3), 2.7, [(-1, 1, 1, 2)])
    scene.material("cloth", diffuse((0.75, 0.72, 0.68))).box((-1.1, 0.7, -0.6), (1.1, 0.75, 0.6), 0.02)
    china, silver, wax = scene.material("china", gloss((0.8, 0.8, 0.8), 0.05)), scene.material("silver", brushed("Ag", 0.1, 0.1)), scene.material("wax", diffuse((0.8, 0.75, 0.6)))
    glass = scene.single("glass", GLASS)
    for k in range(6):
        x, z, side = -0.75 + 0.75 * (k % 3), 0.38 if k < 3 else -0.38, 1 if k < 3 else -1
        china.revolve((x, 0.752, z), [(0.0, 0.004), (0.09, 0.004), (0.13, 0.022), (0.135, 0.024), (0.09, 0.008), (0.0, 0.008)], 48, 4)
        for dx in (-0.19, 0.18, 0.21):
            silver.box((x + dx - 0.008, 0.752, z - 0.1), (x + dx + 0.008, 0.756, z + 0.1), 0.002)
        # A wine glass with walls of its own.
        glass.revolve((x + 0.12, 0.752, z - 0.2 * side), [(0.0, 0.0), (0.035, 0.001), (0.006, 0.012), (0.005, 0.08), (0.035, 0.11), (0.038, 0.16), (0.031, 0.2), (0.0295, 0.2), (0.036, 0.16), (0.033, 0.112), (0.0, 0.086)], 48, 6)
    for k in range(12):
        x, z, high = -0.85 + 0.155 * k, 0.03 * (-1) ** k, 0.08 + 0.03 * (k % 4)
        wax.revolve((x, 0.752, z), [(0.0, 0), (0.014, 0), (0.014, 0), (0.014, high), (0.014, high), (0.0, high - 0.003)], 24, 2)
        scene.single(f"flame{k}", diffuse((0, 0, 0)), '<emitter type="area">' + rgb("radiance", (260, 150, 55)) + "</emitter>").revolve(
            (x, 0.762 + high, z), [(0.0, 0), (0.005, 0.008), (0.0045, 0.016), (0.0, 0.032)], 12, 3)
        if k % 3 == 1:
            glass.revolve((x, 0.7521, z), [(0.05, 0.0), (0.055, 0.2), (0.055, 0.2), (0.052, 0.2), (0.052, 0.2), (0.047, 0.0)], 48, 2)
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.01, 0.015, 0.03)) + "</emitter>")
    return scene, out / "candles"


def white(out):
    rng = random.Random(33)
    scene = Scene("White walls, lit by slots.", ((-5, 1.6, 6.5), (1, 1.5, -3)), 62, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.92, 0.92, 0.92))), scene.material("floor", gloss((0.75, 0.74, 0.72), 0.25))
    room(wall, floor, None, (6, 8), 4)
    for k in range(7):  # beams that hide the lamps from everything but the floor
        z = -8 + 16 * k / 7
        wall.box((-6, 3.4, z), (6, 4, z + 1.9))
        scene.lamp((0, 3.98, z + 2.1), (5.8, 0, 0), (0, 0, 0.08), (7, 7, 7.2))
    wall.patch((-6, 4, -8), (12, 0, 0), (0, 0, 16))
    wall.box((-1.5, 0, -3), (-1.3, 3.4, 2))
    wall.box((1.5, 0, -6), (5.9, 3.4, -5.8))
    for k in range(9):
        x, z, h = rng.uniform(-4.5, 5), rng.uniform(-6, 3), rng.uniform(0.6, 1.2)
        wall.box((x - 0.25, 0, z - 0.25), (x + 0.25, h, z + 0.25), 0.01, 0, rng.uniform(0, 90))
        scene.material(f"thing{k}", gloss([rng.uniform(0.1, 0.8) for _ in range(3)], 0.1)).sphere((x, h + 0.22, z), 0.22, 48)
    return scene, out / "white"


def fence(out):
    folder = folder_of(out, "fence")
    scene = Scene("A fence of wire before a checkered yard.", ((0.3, 1.5, 3.2), (-0.3, 1.2, -4)), 58, (640, 360))
    wire = [[(255, 255, 255) if min((x + y) % 64, (x - y) % 64) < 5 or y < 10 else (0, 0, 0) for x in range(512)] for y in range(512)]
    write_png(folder / "wire.png", wire)
    checks = [[((190, 185, 175), (60, 62, 66))[(x // 16 + y // 16) % 2] for x in range(512)] for y in range(512)]
    write_png(folder / "checks.png", checks)
    scene.lines.append('\t<bsdf type="mask" id="wire">' + BITMAP.format("opacity", "wire.png", RAW) + '<bsdf type="twosided">' + brushed("Al", 0.2, 0.2) + "</bsdf></bsdf>")
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><scale x="3" y="1.5"/><translate x="0" y="1.5" z="0.6"/></transform><ref id="wire"/></shape>')
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="30"/><translate z="-20"/></transform><bsdf type="diffuse">' +
                          BITMAP.format("reflectance", "checks.png", '<transform name="to_uv"><scale value="6"/></transform>') + "</bsdf></shape>")
    wall, frames = scene.material("wall", diffuse((0.6, 0.5, 0.4))), scene.material("frames", gloss((0.7, 0.7, 0.68), 0.1))
    wall.box((-8, 0, -12), (2, 5, -10))
    for k in range(5):
        frames.box((-7.4 + 1.9 * k, 1.2, -10.1), (-6.2 + 1.9 * k, 3.2, -9.9))
    slats = scene.material("slats", diffuse((0.35, 0.2, 0.1)))
    for k in range(40):
        slats.box((2.2 + 0.09 * k, 0, -6 - 0.1 * k), (2.25 + 0.09 * k, 1.6, -5.95 - 0.1 * k))
    rng = random.Random(34)
    furniture(rng, [slats], [wall], (2.5, 4), 6)
    scene.sun_and_sky((0.5, 0.55, 0.4), 0.05)
    return scene, folder


def prints(out):
    rng, folder = random.Random(35), folder_of(out, "prints")
    marks = [[70] * 512 for _ in range(512)]
    for _ in range(260):  # fingerprints and wiped streaks
        x, y, w, h, value = rng.randrange(512), rng.randrange(512), rng.randrange(3, 60), rng.randrange(2, 9), rng.choice((25, 110, 150, 40))
        for j in range(h):
            for i in range(w):
                marks[(y + j + i // 4) % 512][(x + i) % 512] = value
    write_png(folder / "marks.png", [[(v, v, v) for v in row] for row in marks])
    boards = [[25 + 45 * ((x // 64 + 3 * (y // 128)) % 3) for x in range(512)] for y in range(512)]
    write_png(folder / "boards.png", [[(v, v, v) for v in row] for row in boards])
    scene = Scene("Gloss that is a picture.", ((0.2, 1.45, 2.4), (0, 0.6, -1.2)), 60, (640, 360))
    wall = scene.material("wall", diffuse((0.6, 0.58, 0.55)))
    room(wall, scene.material("under", diffuse((0.1, 0.1, 0.1))), wall, (3, 3.5), 2.6, [(-1.8, 1.8, 0.5, 2.2)])
    for name, file, scale in (("board", "boards.png", 4), ("plate", "marks.png", 1)):
        alpha = BITMAP.format("roughness", file, RAW + f'<transform name="to_uv"><scale value="{scale}"/></transform>')
        color = (0.06, 0.05, 0.05) if name == "plate" else (0.18, 0.1, 0.06)
        scene.lines.append(f'\t<bsdf type="twosided" id="{name}"><bsdf type="principled">' + rgb("base_color", color) + number("specular", 0.6) + alpha + "</bsdf></bsdf>")
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale x="3" z="3.5"/><translate y="0.002"/></transform><ref id="board"/></shape>')
    scene.emitters.append('<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale x="0.9" z="0.5"/><translate y="0.75" z="-0.6"/></transform><ref id="plate"/></shape>')
    legs, cups = scene.material("legs", brushed("Cr", 0.1, 0.1)), scene.material("cups", gloss((0.7, 0.7, 0.72), 0.05))
    for x in (-0.8, 0.8):
        for z in (-1.0, -0.2):
            legs.box((x - 0.02, 0, z - 0.02), (x + 0.02, 0.749, z + 0.02))
    for x, z in ((-0.5, -0.75), (0.1, -0.5), (0.6, -0.8)):
        cups.revolve((x, 0.751, z), [(0.0, 0), (0.03, 0), (0.045, 0.04), (0.05, 0.09), (0.047, 0.09), (0.04, 0.04), (0.0, 0.01)], 48, 4)
    scene.emitters.append(bulb((1.6, 2.2, -1.6), 0.05, (60, 50, 38)))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (1.6, 1.9, 2.4)) + "</emitter>")
    return scene, folder


def jewels(out):
    rng = random.Random(36)
    scene = Scene("Cut stones on dark cloth.", ((0.05, 0.16, 0.22), (0, 0.012, 0)), 36, (640, 360))
    scene.material("cloth", diffuse((0.05, 0.03, 0.06))).patch((-0.6, 0, 0.6), (1.2, 0, 0), (0, 0, -1.2))
    back = scene.material("back", diffuse((0.25, 0.24, 0.24)))
    back.patch((-0.6, 0, -0.45), (1.2, 0, 0), (0, 0.9, 0))
    for k, (index, tint) in enumerate(((2.4, (1, 1, 1)), (1.77, (0.9, 0.25, 0.3)), (1.77, (0.3, 0.4, 0.95)), (1.58, (0.4, 0.9, 0.5)))):
        stone = scene.single(f"stone{k}", '<bsdf type="dielectric">' + number("int_ior", index) + rgb("specular_transmittance", tint) + "</bsdf>")
        for _ in range(3):
            x, z, size, turn = rng.uniform(-0.09, 0.09), rng.uniform(-0.07, 0.08), rng.uniform(0.009, 0.016), rng.uniform(0, 6)
            rings = [(0.0, 0.0), (1.0, 0.8), (1.0, 0.86), (0.6, 1.15), (0.0, 1.15)]  # pavilion, girdle, crown, table
            corners = [[(x + size * r * math.cos(turn + math.pi * s / 4), size * h + 0.0005, z + size * r * math.sin(turn + math.pi * s / 4)) for s in range(8)] for r, h in rings]
            middle = (x, size * 0.8, z)
            for a, b in zip(corners, corners[1:]):
                for s in range(8):
                    quad = [a[s], a[(s + 1) % 8], b[(s + 1) % 8], b[s]]
                    for tri in (quad[:3], (quad[0], quad[2], quad[3])):
                        facet(stone, tri, middle)
    gold, pearl = scene.material("gold", brushed("Au", 0.06, 0.06)), scene.material("pearl", gloss((0.75, 0.7, 0.66), 0.2))
    for x, z in ((-0.05, 0.05), (0.06, -0.03)):
        gold.tube([(x + 0.012 * math.cos(t), 0.012 + 0.011 * math.sin(t), z) for t in (2 * math.pi * k / 48 for k in range(48))], 0.0016, 16, True)
    for k in range(26):
        t = 0.24 * k
        pearl.sphere((-0.02 + 0.075 * math.cos(t), 0.005, -0.02 + 0.05 * math.sin(t)), 0.005, 24)
    for x, z, power in ((-0.25, 0.1, 900), (0.2, 0.25, 700), (0.05, -0.3, 600)):
        scene.emitters.append(bulb((x, 0.4, z), 0.006, (power, power, 0.9 * power)))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.04, 0.04, 0.05)) + "</emitter>")
    return scene, out / "jewels"


def facet(mesh, triangle, inside):
    """A flat triangle that faces away from `inside`; none where it has no area."""
    a, b, c = triangle
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    size = math.sqrt(sum(x * x for x in n))
    if size < 1e-12:
        return
    if sum(x * (p - q) for x, p, q in zip(n, a, inside)) < 0:
        b, c, size = c, b, -size
    first = len(mesh.vertices)
    mesh.vertices += [(*p, *(x / size for x in n), 0.0, 0.0) for p in (a, b, c)]
    mesh.triangles.append((first, first + 1, first + 2))


def pendants(out):
    rng = random.Random(37)
    scene = Scene("Lamps within shades of cloth.", ((2.6, 1.6, 3.1), (-0.4, 1.2, -0.8)), 60, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.65, 0.62, 0.58))), scene.material("floor", gloss((0.3, 0.2, 0.12), 0.15))
    room(wall, floor, scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), (3.2, 3.6), 2.7)
    woods, cloths = [scene.material("wood", diffuse((0.4, 0.25, 0.13)))], [scene.material("wool", diffuse((0.2, 0.25, 0.35)))]
    furniture(rng, woods, cloths, (2, 2), 7)
    for k, (x, y, z, color) in enumerate(((-0.9, 1.75, -0.9, (0.9, 0.8, 0.6)), (0.7, 1.9, -1.6, (0.85, 0.85, 0.8)), (-1.9, 1.55, 0.9, (0.9, 0.55, 0.4)))):
        shade = scene.single(f"shade{k}", '<bsdf type="principledthin">' + rgb("base_color", color) + number("roughness", 0.8) + number("diff_trans", 1.2) + "</bsdf>")
        shade.revolve((x, y, z), [(0.28, 0), (0.28, 0), (0.17, 0.3), (0.17, 0.3)], 64, 2)
        scene.emitters.append(bulb((x, y + 0.13, z), 0.035, (95, 78, 55)))
    scene.lamp((1.5, 0.02, 3.2), (0.2, 0, 0), (0, 0, 0.1), (0.5, 0.5, 0.6))
    return scene, out / "pendants"


def crystal(out):
    scene = Scene("Glass and brass in the sun.", ((0.3, 1.6, 2.6), (0, 0.25, 0)), 40, (640, 360))
    scene.material("table", diffuse((0.5, 0.42, 0.33))).box((-20, -0.1, -20), (20, 0, 20), 0.01)
    glass = scene.single("glass", GLASS)
    glass.sphere((-0.55, 0.301, 0), 0.3, 96)
    glass.box((-0.05, 0.001, -0.35), (0.25, 0.7, -0.05), 0.02)
    scene.material("brass", brushed("Au", 0.05, 0.05)).revolve((0.75, 0.001, 0.1), [(0.3, 0), (0.3, 0.3), (0.29, 0.3), (0.29, 0)], 128, 2)
    scene.emitters.append('<emitter type="sunsky"><transform name="to_world"><rotate x="1" angle="-90"/></transform><vector name="sun_direction" x="-0.7" y="0.35" z="0.8"/></emitter>')
    return scene, out / "crystal"


def reflectors(out):
    scene = Scene("Lamps in reflectors.", ((1.2, 1.5, 3.0), (0, 1.3, -1)), 50, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.65, 0.62, 0.6))), scene.material("floor", diffuse((0.35, 0.3, 0.28)))
    room(wall, floor, scene.material("ceiling", diffuse((0.75, 0.75, 0.75))), (2.5, 3), 2.8)
    cup, glass = scene.material("cup", '<bsdf type="conductor"><string name="material" value="Al"/></bsdf>'), scene.single("glass", GLASS)
    picture = scene.material("picture", diffuse((0.2, 0.35, 0.6)))
    for x in (-1.5, -0.5, 0.5, 1.5):
        cup.revolve((x, 2.45, -1.9), [(0.10, 0), (0.09, 0.05), (0.06, 0.1), (0.02, 0.13), (0, 0.135)], 48, 6)
        scene.emitters.append(bulb((x, 2.525, -1.9), 0.02, (400, 350, 280)))
        glass.revolve((x, 2.43, -1.9), [(0, 0), (0.1, 0), (0.1, 0.008), (0, 0.008)], 48, 1)
        picture.box((x - 0.3, 1.0, -2.98), (x + 0.3, 1.8, -2.95), 0.004)
    furniture(random.Random(41), [scene.material("wood", diffuse((0.4, 0.25, 0.13)))], [scene.material("wool", diffuse((0.2, 0.3, 0.25)))], (2, 2), 4)
    return scene, out / "reflectors"


if __name__ == "__main__":
    write_scenes(__doc__, {"bokeh": bokeh, "candles": candles, "white": white, "fence": fence, "prints": prints, "jewels": jewels, "pendants": pendants, "crystal": crystal, "reflectors": reflectors})
