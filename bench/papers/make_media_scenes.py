#!/usr/bin/env python3
"""Writes five scenes with fog, smoke and liquids for the experiments of Huo et al. 2016 (Mitsuba 3 XML, PLY and .vol): after the paper's, of our own making.

    bench/papers/make_media_scenes.py OUT [fog street liquids statue studio]

  fog      a hall of columns in even fog: the sun falls through windows in shafts, a lamp hangs in it (the paper's Sponza)
  street   street lamps and a faint sky in uneven smoke between two rows of houses (city)
  liquids  six blocks of drink, jade, soap, juice, skin and milk under a lamp (laboratory). scene.xml: boundaries that do not refract, so that columns carry all of its light;
           glass.xml: the same of glass; named.xml: coefficients by the paper's names, which Mitsuba 3 does not have
  statue   a knotted body of a medium that scatters a lot; `--define g=0.5` for others than g = 0 (Figure 8)
  studio   a room full of thin uneven smoke, with a bright window: most of its light is indirect (Figure 9)

Both Mitsuba 3 and Lumirank read them. Directional and sky light would not get through endless fog, so every medium is in a box; the camera is in it where the picture is.
"""
import array
import math
import pathlib
import random
import struct
import sys

from make_occluded_scenes import column
from scene_parts import Scene, cross, diffuse, mul, number, rgb, sub, text, unit, write_scenes

# Coefficients of the paper's Table 1: σs, σa, and the mean of g over the channels, since Mitsuba's phase functions are gray.
TABLE = {"drink": ((0.04, 0.04, 0.06), (0.02, 0.02, 0.009), 0.933), "jade": ((1, 1, 1), (0.002, 0.004, 0.007), 0.9), "soap": ((0.2, 0.2, 0.22), (0.001, 0.001, 0.002), 0.95),
         "juice": ((0.15, 0.15, 0.16), (0.03, 0.17, 0.48), 0.93), "skin": ((0.74, 0.88, 1), (0.03, 0.17, 0.48), 0.0), "milk": ((1, 1, 1), (0.0026, 0.005, 0.01), 0.79)}
DEPTH = 32


def with_id(element, name):
    return element.replace(" type", f' id="{name}" type', 1)


class MediaScene(Scene):
    """A scene of the generators beside it, with media, and files of the same that differ in some words."""

    def __init__(self, comment, camera, fov, film):
        super().__init__(comment, camera, fov, film, DEPTH)
        self.lines = [line.replace('type="path"', 'type="volpath"') for line in self.lines]
        self.grids, self.others = {}, {}

    def medium(self, name, body, around_camera=False):
        """Before the sensor, which may refer to it."""
        self.lines.insert(2, "\t" + with_id(body, name))
        if around_camera:
            at = next(k for k, line in enumerate(self.lines) if "</sensor>" in line)
            self.lines.insert(at, f'\t\t<ref id="{name}"/>')

    def enclose(self, name, lo, hi):
        """The medium in a box that is not seen."""
        half, mid = [(b - a) / 2 for a, b in zip(lo, hi)], [(a + b) / 2 for a, b in zip(lo, hi)]
        self.emitters.append(f'<shape type="cube"><transform name="to_world"><scale value="{text(half)}"/><translate value="{text(mid)}"/></transform>'
                             f'<bsdf type="null"/><ref name="interior" id="{name}"/></shape>')

    def body(self, medium, boundary='<bsdf type="null"/>'):
        """A mesh that is full of the medium."""
        mesh = self.material(f"body_{medium}", boundary)
        self.lines[-1] = "\t" + with_id(boundary, f"body_{medium}")  # boundaries have an inside: not twosided
        self.inside[f"body_{medium}"] = f'<ref name="interior" id="{medium}"/>'
        return mesh

    def grid(self, name, size, lo, hi, values):
        self.grids[name] = (size, lo, hi, values)

    def aimed_lamp(self, center, target, width, height, radiance):
        """A rectangle that looks at a place; half sides."""
        along = unit(sub(target, center))
        u = unit(cross((0.0, 1.0, 0.0), along))
        self.lamp(center, mul(u, width), mul(cross(along, u), height), radiance)

    def small_lamp(self, center, radius, radiance):
        self.emitters.append(f'<shape type="sphere"><point name="center" value="{text(center)}"/>' + number("radius", radius) + diffuse((0, 0, 0)) +
                             '<emitter type="area">' + rgb("radiance", radiance) + "</emitter></shape>")

    def sky(self, radiance):
        self.emitters.append('<emitter type="constant">' + rgb("radiance", radiance) + "</emitter>")

    def write(self, folder):
        total = super().write(folder)
        written = (folder / "scene.xml").read_text()
        for name, changes in self.others.items():
            other = written
            for old, new in changes:
                other = other.replace(old, new)
            (folder / name).write_text(other)
        for name, (size, lo, hi, values) in self.grids.items():
            data = array.array("f", values)
            if sys.byteorder == "big":
                data.byteswap()
            (folder / f"{name}.vol").write_bytes(b"VOL\3" + struct.pack("<5i6f", 1, *size, 1, *lo, *hi) + data.tobytes())
        return total


def homogeneous(sigma_s, sigma_a, g, scale=1.0):
    # Mitsuba's colors are 1 at most: the rest is scale.
    sigma_t = [s + a for s, a in zip(sigma_s, sigma_a)]
    most = max(sigma_t)
    return ('<medium type="homogeneous">' + rgb("sigma_t", [t / most for t in sigma_t]) + rgb("albedo", [s / t for s, t in zip(sigma_s, sigma_t)]) + number("scale", most * scale) +
            f'<phase type="hg"><float name="g" value="{g}"/></phase></medium>')


def smoke(file, scale, albedo, g):
    return (f'<medium type="heterogeneous"><volume type="gridvolume" name="sigma_t"><string name="filename" value="{file}"/><boolean name="use_grid_bbox" value="true"/></volume>'
            f'<volume type="constvolume" name="albedo">{rgb("value", albedo)}</volume>' + number("scale", scale) + f'<phase type="hg"><float name="g" value="{g}"/></phase></medium>')


def noise(seed, size, cell, octaves=4):
    """Smoothed noise of a few octaves, between 0 and 1, at the middle of the cells of a grid; `cell`: cells to a wave of the first. x fastest."""
    rng = random.Random(seed)
    layers = []
    for k in range(octaves):
        step = max(1.0, cell / 2 ** k)
        dims = [int(n / step) + 3 for n in size]
        layers.append((step, dims, [rng.random() for _ in range(dims[0] * dims[1] * dims[2])], 0.5 ** k))
    whole = sum(weight for *_, weight in layers)

    def smooth(x):
        k = int(x)
        t = x - k
        return k, t * t * (3 - 2 * t)
    out = []
    for z in range(size[2]):
        for y in range(size[1]):
            for x in range(size[0]):
                total = 0.0
                for step, (nx, ny, _), values, weight in layers:
                    (i, a), (j, b), (k, c) = smooth(x / step), smooth(y / step), smooth(z / step)
                    at = (k * ny + j) * nx + i
                    plane = []
                    for o in (at, at + ny * nx):
                        low, high = values[o] + (values[o + 1] - values[o]) * a, values[o + nx] + (values[o + nx + 1] - values[o + nx]) * a
                        plane.append(low + (high - low) * b)
                    total += weight * (plane[0] + (plane[1] - plane[0]) * c)
                out.append(total / whole)
    return out


def wisps(seed, size, cell, threshold, fall):
    """Noise above a threshold, thinner with height by `fall`."""
    values = noise(seed, size, cell)
    return [max(0.0, (v - threshold) / (1 - threshold)) * math.exp(-fall * ((k // size[0]) % size[1]) / size[1]) for k, v in enumerate(values)]


# -------------------------------------------------------------------------------------------------------------------------------------------- fog


def wall_with_windows(stone, x, z0, z1, height, windows, sill, lintel, thick=0.5):
    """A wall across x with openings of (from, to) along z, all between the heights sill and lintel."""
    stone.box((x, 0, z0), (x + thick, sill, z1))
    stone.box((x, lintel, z0), (x + thick, height, z1))
    edges = [z0] + [z for w in windows for z in w] + [z1]
    for a, b in zip(edges[::2], edges[1::2]):
        stone.box((x, sill, a), (x + thick, lintel, b))


def fog(out):
    scene = MediaScene("A hall in fog; the sun falls in.", ((1.3, 1.7, 8.6), (-0.7, 2.5, -4.0)), 62, (320, 240))
    scene.medium("fog", homogeneous((0.055, 0.058, 0.062), (0.004, 0.004, 0.004), 0.3), around_camera=True)
    stone, floor = scene.material("stone", diffuse((0.62, 0.56, 0.47))), scene.material("floor", diffuse((0.32, 0.27, 0.22)))
    cloth = scene.material("cloth", diffuse((0.5, 0.09, 0.07)))
    floor.patch((-5.4, 0, 9.6), (10.8, 0, 0), (0, 0, -19.2), 12, 20)
    stone.patch((-5.4, 7, -9.6), (10.8, 0, 0), (0, 0, 19.2), 12, 20)  # seen from below
    windows = [(-7.2 + 3.2 * k, -5.9 + 3.2 * k) for k in range(5)]
    wall_with_windows(stone, -5.4, -9.6, 9.6, 7, windows, 3.0, 6.2)
    stone.box((4.9, 0, -9.6), (5.4, 7, 9.6))
    stone.box((-5.4, 0, -9.9), (5.4, 7, -9.6))
    stone.box((-5.4, 0, 9.6), (5.4, 7, 9.9))
    for k in range(6):
        for x in (-2.9, 2.9):
            column(stone, (x, 0, -8.2 + 3.2 * k), 5.2, 0.3)
    for x in (-2.9, 2.9):
        stone.box((x - 0.4, 5.2, -9.6), (x + 0.4, 5.8, 9.6), 0.02)
    for k in range(2):
        z = -5.0 + 6.4 * k
        cloth.grid(10, 16, lambda s, t, z=z: ((2.85 + 0.05 * math.sin(9 * s + 4 * t), 5.0 - 2.6 * t, z + 1.5 * s), (-1, 0, 0.3 * math.cos(9 * s)), (s, t)))
    scene.directional(unit((0.78, -0.56, -0.22)), (22, 19, 14))
    scene.small_lamp((1.2, 3.0, -1.6), 0.08, (420, 250, 110))
    scene.enclose("fog", (-5.6, -0.2, -10.0), (5.6, 7.2, 10.0))
    return scene, out / "fog"


# ----------------------------------------------------------------------------------------------------------------------------------------- street


def house(rng, wall, frames, x, z0, z1, height, side):
    """A facade with windows that stand back; `side`: 1 if it looks along +x."""
    deep = 0.25
    back = x - side * deep

    def slab(mesh, y0, y1, za, zb, a, b):
        mesh.box((min(a, b), y0, za), (max(a, b), y1, zb))
    floors, bays = max(2, int(height / 2.9)), max(2, int((z1 - z0) / 2.3))
    dy, dz = height / floors, (z1 - z0) / bays
    slab(frames, 0, height, z0, z1, back, back - side * 0.2)
    for k in range(floors + 1):
        slab(wall, max(0, k * dy - 0.55), min(height, k * dy + 0.6), z0, z1, x, back)
    for k in range(bays + 1):
        slab(wall, 0, height, max(z0, z0 + k * dz - 0.55), min(z1, z0 + k * dz + 0.55), x, back)
    slab(wall, height, height + 0.25, z0, z1, x + side * 0.2, back)


def street(out):
    rng = random.Random(11)
    scene = MediaScene("A street at night, in smoke.", ((0.9, 1.8, 12.5), (-0.5, 3.0, -6.0)), 58, (320, 240))
    scene.medium("smoke", smoke("smoke.vol", 0.13, (0.9, 0.91, 0.93), 0.4), around_camera=True)
    road, kerb = scene.material("road", diffuse((0.16, 0.16, 0.17))), scene.material("kerb", diffuse((0.36, 0.34, 0.32)))
    pole, dark = scene.material("pole", diffuse((0.1, 0.11, 0.1))), scene.material("dark", diffuse((0.07, 0.08, 0.1)))
    walls = [scene.material(f"wall_{k}", diffuse(c)) for k, c in enumerate(((0.5, 0.34, 0.25), (0.52, 0.47, 0.38), (0.36, 0.38, 0.42)))]
    road.patch((-3.4, 0, 15), (6.8, 0, 0), (0, 0, -41), 6, 20)
    for side in (-1, 1):
        kerb.box((min(3.4 * side, 5.6 * side), 0, -26), (max(3.4 * side, 5.6 * side), 0.14, 15))
        z = 15.0
        while z > -25:
            wide, height = rng.uniform(5.5, 8.5), rng.uniform(6.5, 10.5)
            house(rng, walls[rng.randrange(3)], dark, 5.6 * side, max(z - wide, -26), z, height, -side)
            z -= wide
    walls[1].box((-5.6, 0, -26.6), (5.6, 8, -26))
    for k in range(7):
        side = 1 if k % 2 else -1
        z = 10.0 - 5.2 * k
        x = side * 3.7
        pole.tube([(x, 0.1, z), (x, 4.2, z), (x - 0.15 * side, 4.5, z), (x - 0.85 * side, 4.6, z)], 0.05, 8)
        pole.revolve((x - 0.85 * side, 4.42, z), [(0.24, 0.0), (0.2, 0.1), (0.05, 0.2)], 20, 2)
        warm = (1.0, 0.72, 0.38) if k % 3 else (0.75, 0.9, 1.0)
        scene.small_lamp((x - 0.85 * side, 4.33, z), 0.07, mul(warm, 420))
    scene.sky((0.008, 0.011, 0.02))
    size, lo, hi = (36, 26, 112), (-6.4, -0.1, -27.0), (6.4, 9.2, 15.4)
    scene.grid("smoke", size, lo, hi, wisps(5, size, 14, 0.36, 1.1))
    scene.enclose("smoke", lo, hi)
    return scene, out / "street"


# ---------------------------------------------------------------------------------------------------------------------------------------- liquids


def liquids(out):
    scale = 3.0  # the paper names no unit: a block is six mean free paths of jade wide
    scene = MediaScene("Six blocks of liquids and solids under a lamp.", ((0, 5.2, 17.0), (0, 1.2, 0)), 46, (480, 200))
    table, wall = scene.material("table", diffuse((0.46, 0.44, 0.42))), scene.material("wall", diffuse((0.5, 0.55, 0.6)))
    dark = scene.material("dark", diffuse((0.12, 0.12, 0.14)))
    table.patch((-12, 0, 6), (24, 0, 0), (0, 0, -10), 18, 10)
    wall.patch((-12, 0, -4), (24, 0, 0), (0, 9, 0), 18, 9)
    for k, (name, (sigma_s, sigma_a, g)) in enumerate(TABLE.items()):
        x = -5.75 + 2.3 * k
        body = homogeneous(sigma_s, sigma_a, g, scale)
        scene.medium(name, body)
        scene.others.setdefault("named.xml", []).append((with_id(body, name),
                                                         f'<medium id="{name}" type="homogeneous"><string name="material" value="{name}"/>{number("scale", scale)}</medium>'))
        # Just over the table: a boundary on a surface would leave it open which of the two comes first.
        scene.body(name).box((x - 0.8, 0.02, -0.8), (x + 0.8, 2.3, 0.8), 0.12)
        scene.others.setdefault("glass.xml", []).append((f'<bsdf id="body_{name}" type="null"/>', f'<bsdf id="body_{name}" type="dielectric"><float name="int_ior" value="1.33"/></bsdf>'))
        dark.box((x - 0.06, 0.02, -2.6), (x + 0.06, 3.4, -2.5))  # what is behind shows how clear they are
    scene.aimed_lamp((-1.5, 7.5, 3.2), (0, 0.8, 0), 1.1, 1.0, (48, 44, 38))
    scene.aimed_lamp((6.5, 4.5, -2.6), (0, 1, 0.5), 0.35, 0.35, (60, 75, 100))
    return scene, out / "liquids"


# ----------------------------------------------------------------------------------------------------------------------------------------- statue


def statue(out):
    scene = MediaScene("A knotted body.", ((0, 1.9, 6.2), (0, 1.35, 0)), 34, (240, 240))
    # Figure 8 has 0.002, 0.005, 001: the last is taken for 0.01.
    scene.medium("body", homogeneous((1, 1, 1), (0.002, 0.005, 0.01), "$g", 5))
    scene.lines.insert(2, '\t<default name="g" value="0"/>')
    ground, wall = scene.material("ground", diffuse((0.4, 0.38, 0.36))), scene.material("wall", diffuse((0.3, 0.34, 0.42)))
    stand = scene.material("stand", diffuse((0.2, 0.17, 0.15)))
    ground.patch((-6, 0, 6), (12, 0, 0), (0, 0, -9), 12, 9)
    wall.patch((-6, 0, -3), (12, 0, 0), (0, 7, 0), 12, 7)
    stand.revolve((0, 0, 0), [(0.95, 0), (0.95, 0.12), (0.95, 0.12), (0.8, 0.2), (0.8, 0.3), (0.0, 0.3)], 48, 2)

    def radius(n):
        ridge = math.sin(3 * math.atan2(n[2], n[0]) + 4 * n[1])
        return 1.0 + 0.16 * ridge * (1 - n[1] ** 2) + 0.07 * math.sin(7 * n[1] + 2 * n[0])

    def surface(s, t):
        a, b = 2 * math.pi * s, math.pi * t
        n = (math.sin(b) * math.cos(a), -math.cos(b), math.sin(b) * math.sin(a))
        r = radius(n)
        return (0.82 * r * n[0], 1.42 + 1.05 * r * n[1], 0.82 * r * n[2])

    def at(s, t):
        e = 1e-3
        p = surface(s, t)
        across = [b - a for a, b in zip(surface(s - e, t), surface(s + e, t))]
        up = [b - a for a, b in zip(surface(s, max(0.0, t - e)), surface(s, min(1.0, t + e)))]
        n = (up[1] * across[2] - up[2] * across[1], up[2] * across[0] - up[0] * across[2], up[0] * across[1] - up[1] * across[0])
        outward = (p[0], (p[1] - 1.42), p[2])
        if sum(c * c for c in n) < 1e-20:
            n = outward
        if sum(a * b for a, b in zip(n, outward)) < 0:
            n = mul(n, -1)
        return p, n, (s, t)
    scene.body("body").grid(96, 64, at, close_u=True)
    scene.aimed_lamp((-2.6, 4.6, 1.6), (0, 1.3, 0), 0.6, 0.6, (42, 38, 31))
    scene.aimed_lamp((3.4, 2.8, -1.6), (0, 1.4, 0), 0.3, 0.35, (34, 42, 60))
    return scene, out / "statue"


# ----------------------------------------------------------------------------------------------------------------------------------------- studio


def studio(out):
    scene = MediaScene("A studio full of smoke; light comes from the window.", ((2.3, 1.6, 3.3), (-0.9, 1.25, -1.2)), 62, (320, 240))
    scene.medium("smoke", smoke("smoke.vol", 0.22, (0.96, 0.96, 0.96), 0.2), around_camera=True)
    wall, wood = scene.material("wall", diffuse((0.68, 0.66, 0.62))), scene.material("wood", diffuse((0.4, 0.25, 0.13)))
    blue, canvas = scene.material("blue", diffuse((0.16, 0.25, 0.45))), scene.material("canvas", diffuse((0.75, 0.7, 0.6)))
    wood.patch((-3, 0, 4), (6, 0, 0), (0, 0, -7), 12, 14)
    wall.patch((-3, 3, -3), (6, 0, 0), (0, 0, 7), 6, 7)
    wall_with_windows(wall, -3.3, -3, 4, 3, [(-1.6, 0.2)], 0.9, 2.5, 0.3)
    wall.box((-3, 0, -3.3), (3, 3, -3))
    blue.box((3, 0, -3), (3.3, 3, 4))
    wall.box((-3, 0, 4), (3, 3, 4.3))
    wood.box((-3.02, 1.66, -1.6), (-2.98, 1.72, 0.2))
    wood.box((-3.02, 0.9, -0.73), (-2.98, 2.5, -0.67))
    wood.box((-1.6, 0.72, -2.6), (0.5, 0.77, -1.7), 0.01)
    for x in (-1.5, 0.4):
        for z in (-2.5, -1.8):
            wood.tube([(x, 0, z), (x, 0.73, z)], 0.03, 8)
    blue.revolve((-0.9, 0.77, -2.1), [(0.09, 0), (0.14, 0.1), (0.12, 0.25), (0.05, 0.34), (0.08, 0.4), (0.075, 0.4), (0.0, 0.3)], 32, 4)
    for dx, dz in ((-0.35, 0.2), (0.35, 0.2), (0, -0.45)):  # an easel
        wood.tube([(1.1 + dx, 0, -1.2 + dz), (1.1 + 0.25 * dx, 2.0, -1.2 + 0.1 * dz)], 0.022, 8)
    canvas.box((0.65, 0.8, -1.13), (1.55, 1.75, -1.08))
    canvas.sphere((-0.2, 0.3, 0.2), 0.3, 40)
    # A bright panel before the window: nearly all that it lights directly is smoke, sill and floor.
    scene.aimed_lamp((-6.4, 3.6, -0.9), (-2.0, 1.2, -0.7), 1.0, 0.9, (150, 140, 120))
    size, lo, hi = (40, 22, 46), (-3.4, -0.1, -3.4), (3.4, 3.1, 4.4)
    scene.grid("smoke", size, lo, hi, [0.25 + 0.75 * v for v in wisps(9, size, 12, 0.3, 0.4)])
    scene.enclose("smoke", lo, hi)
    return scene, out / "studio"


SCENES = {"fog": fog, "street": street, "liquids": liquids, "statue": statue, "studio": studio}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES)
