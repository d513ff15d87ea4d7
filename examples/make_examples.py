#!/usr/bin/env python3
"""Writes the example scenes (Mitsuba 3 XML) into this folder. The XML files are committed; run this after changing a scene.

Units are meters, +y is up. Everything is made of the format's own shapes, so a scene is one small text file.
"""
import math
import pathlib
import random

HERE = pathlib.Path(__file__).resolve().parent


class Scene:
    def __init__(self, comment, camera, film=(800, 600), depth=-1, spp=4):
        origin, target, fov = camera
        self.lines = [
            f"<!-- {comment} Written by make_examples.py. -->",
            '<scene version="3.0.0">',
            f'\t<integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>',
            '\t<sensor type="perspective">',
            f'\t\t<float name="fov" value="{fov}"/>',
            f'\t\t<transform name="to_world"><lookat origin="{vec(origin)}" target="{vec(target)}" up="0, 1, 0"/></transform>',
            f'\t\t<sampler type="independent"><integer name="sample_count" value="{spp}"/></sampler>',
            '\t\t<film type="hdrfilm">',
            f'\t\t\t<integer name="width" value="{film[0]}"/>',
            f'\t\t\t<integer name="height" value="{film[1]}"/>',
            '\t\t\t<rfilter type="box"/>',
            "\t\t</film>",
            "\t</sensor>",
        ]

    def add(self, text):
        self.lines.append("\t" + text)

    def bsdf(self, name, body):
        self.add(f'<bsdf type="twosided" id="{name}">{body}</bsdf>')

    def diffuse(self, name, r, g, b):
        self.bsdf(name, f'<bsdf type="diffuse"><rgb name="reflectance" value="{r}, {g}, {b}"/></bsdf>')

    def rough_plastic(self, name, r, g, b, alpha):
        self.bsdf(name, f'<bsdf type="roughplastic"><string name="distribution" value="ggx"/><float name="alpha" value="{alpha}"/>'
                        f'<rgb name="diffuse_reflectance" value="{r}, {g}, {b}"/></bsdf>')

    def metal(self, name, material, alpha):
        self.bsdf(name, f'<bsdf type="roughconductor"><string name="material" value="{material}"/>'
                        f'<string name="distribution" value="ggx"/><float name="alpha" value="{alpha}"/></bsdf>')

    def shape(self, kind, bsdf, transform, emit=None, extra="", name=None):
        ident = f' id="{name}"' if name else ""
        light = f'<emitter type="area"><rgb name="radiance" value="{vec(emit)}"/></emitter>' if emit else ""
        self.add(f'<shape type="{kind}"{ident}><transform name="to_world">{transform}</transform>{extra}<ref id="{bsdf}"/>{light}</shape>')

    def box(self, bsdf, lo, hi, turn=0, **kw):
        """Axis-aligned box from corner to corner, turned about its own vertical axis by `turn` degrees."""
        half = [(h - l) / 2 for l, h in zip(lo, hi)]
        mid = [(h + l) / 2 for l, h in zip(lo, hi)]
        spin = f'<rotate y="1" angle="{turn:g}"/>' if turn else ""
        self.shape("cube", bsdf, f'<scale value="{vec(half)}"/>{spin}<translate value="{vec(mid)}"/>', **kw)

    def rect(self, bsdf, center, u, v, **kw):
        """Rectangle around `center` with half edges u and v; its normal is u × v."""
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.sqrt(sum(c * c for c in n))
        n = [c / length for c in n]
        rows = [(u[i], v[i], n[i], center[i]) for i in range(3)]
        m = " ".join(f"{c:g}" for row in rows for c in row) + " 0 0 0 1"
        self.shape("rectangle", bsdf, f'<matrix value="{m}"/>', **kw)

    def sphere(self, bsdf, center, radius, **kw):
        self.shape("sphere", bsdf, "", extra=f'<point name="center" value="{vec(center)}"/><float name="radius" value="{radius:g}"/>', **kw)

    def cylinder(self, bsdf, p0, p1, radius):
        self.shape("cylinder", bsdf, "", extra=f'<point name="p0" value="{vec(p0)}"/><point name="p1" value="{vec(p1)}"/><float name="radius" value="{radius:g}"/>')

    def room(self, wall, floor, ceiling, lo, hi, front=True):
        (x0, y0, z0), (x1, y1, z1) = lo, hi
        cx, cy, cz = (x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2
        hx, hy, hz = (x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2
        self.rect(floor, (cx, y0, cz), (hx, 0, 0), (0, 0, -hz))
        if ceiling:
            self.rect(ceiling, (cx, y1, cz), (hx, 0, 0), (0, 0, hz))
        self.rect(wall, (x0, cy, cz), (0, 0, -hz), (0, hy, 0))
        self.rect(wall, (x1, cy, cz), (0, 0, hz), (0, hy, 0))
        self.rect(wall, (cx, cy, z0), (hx, 0, 0), (0, hy, 0))
        if front:
            self.rect(wall, (cx, cy, z1), (-hx, 0, 0), (0, hy, 0))

    def write(self, name):
        (HERE / f"{name}.xml").write_text("\n".join(self.lines + ["</scene>", ""]))


def vec(v):
    return ", ".join(f"{c:.5g}" for c in v)


def box():
    s = Scene("A box with two blocks under one lamp: the smallest scene with all of direct and indirect light.",
              ((0, 1, 3.4), (0, 1, 0), 40), film=(512, 512))
    s.diffuse("white", 0.73, 0.71, 0.68)
    s.diffuse("red", 0.61, 0.06, 0.05)
    s.diffuse("green", 0.12, 0.44, 0.10)
    s.rect("white", (0, 0, 0), (1, 0, 0), (0, 0, -1))
    s.rect("white", (0, 2, 0), (1, 0, 0), (0, 0, 1))
    s.rect("white", (0, 1, -1), (1, 0, 0), (0, 1, 0))
    s.rect("red", (-1, 1, 0), (0, 0, -1), (0, 1, 0))
    s.rect("green", (1, 1, 0), (0, 0, 1), (0, 1, 0))
    s.box("white", (-0.65, 0, -0.6), (-0.05, 1.2, 0.0), turn=18)
    s.box("white", (0.05, 0, -0.05), (0.6, 0.6, 0.5), turn=-16)
    s.rect("white", (0, 1.99, 0), (0.25, 0, 0), (0, 0, 0.25), emit=(17, 12, 6), name="lamp")
    s.write("box")


def interior():
    s = Scene("A living room lit only indirectly: lamps in coves and an uplight shine at the ceiling; no lamp is seen from the room.",
              ((2.55, 1.55, 2.75), (-0.7, 0.85, -1.2), 68), film=(960, 640), depth=24)
    s.diffuse("plaster", 0.82, 0.80, 0.76)
    s.diffuse("accent", 0.30, 0.42, 0.46)
    s.rough_plastic("oak", 0.42, 0.26, 0.14, 0.25)
    s.rough_plastic("lacquer", 0.75, 0.74, 0.70, 0.2)
    s.diffuse("cloth", 0.46, 0.14, 0.10)
    s.diffuse("linen", 0.70, 0.66, 0.55)
    s.diffuse("dark", 0.08, 0.07, 0.07)
    s.metal("brass", "Au", 0.25)
    s.rough_plastic("ceramic", 0.10, 0.24, 0.45, 0.15)
    s.room("plaster", "oak", "plaster", (-3, 0, -3), (3, 3.0, 3))
    s.box("accent", (-3, 0, -2.99), (3, 2.1, -2.95))
    # Coves: a shelf along two walls hides strips of lamps that face the ceiling.
    for k in range(8):
        x = -2.45 + k * 0.7
        s.rect("dark", (x, 2.2, -2.82), (0.3, 0, 0), (0, 0, -0.1), emit=(20, 16.5, 12), name=f"cove_back_{k}")
    s.box("plaster", (-3, 2.1, -2.95), (3, 2.18, -2.62))
    s.box("plaster", (-3, 2.18, -2.64), (3, 2.42, -2.62))
    for k in range(8):
        z = -2.3 + k * 0.7
        s.rect("dark", (-2.86, 2.2, z), (0, 0, 0.3), (0.1, 0, 0), emit=(14, 15.4, 18), name=f"cove_left_{k}")
    s.box("plaster", (-3, 2.1, -2.62), (-2.66, 2.18, 3))
    s.box("plaster", (-2.68, 2.18, -2.62), (-2.66, 2.42, 3))
    # Uplight: a bowl on a pole.
    s.cylinder("brass", (2.35, 0, -2.2), (2.35, 1.75, -2.2), 0.02)
    s.cylinder("brass", (2.35, 1.75, -2.2), (2.35, 1.95, -2.2), 0.16)
    s.rect("dark", (2.35, 1.78, -2.2), (0.1, 0, 0), (0, 0, -0.1), emit=(120, 85, 47), name="uplight")
    s.cylinder("brass", (2.35, 0, -2.2), (2.35, 0.03, -2.2), 0.18)
    # Sofa, table, shelf, rug, things.
    s.box("linen", (-2.2, 0.005, -1.1), (0.9, 0.012, 1.5))
    s.box("cloth", (-2.2, 0.12, -2.55), (0.3, 0.45, -1.65))
    s.box("cloth", (-2.2, 0.45, -2.75), (0.3, 0.95, -2.45))
    s.box("cloth", (-2.4, 0.12, -2.75), (-2.2, 0.68, -1.65))
    s.box("cloth", (0.3, 0.12, -2.75), (0.5, 0.68, -1.65))
    for x in (-2.3, 0.4):
        for z in (-2.65, -1.75):
            s.cylinder("dark", (x, 0, z), (x, 0.12, z), 0.03)
    s.box("linen", (-1.9, 0.45, -2.45), (-1.45, 0.85, -2.3), turn=14)
    s.box("accent", (-0.35, 0.45, -2.45), (0.1, 0.83, -2.3), turn=-10)
    s.box("lacquer", (-1.5, 0.36, -0.75), (0.0, 0.42, 0.15))
    for x in (-1.42, -0.08):
        for z in (-0.67, 0.07):
            s.box("oak", (x - 0.03, 0, z - 0.03), (x + 0.03, 0.36, z + 0.03))
    s.sphere("ceramic", (-1.05, 0.53, -0.35), 0.11)
    s.sphere("brass", (-0.62, 0.49, -0.15), 0.07)
    s.box("oak", (-0.55, 0.42, -0.6), (-0.2, 0.46, -0.35), turn=24)
    s.box("cloth", (-0.53, 0.46, -0.58), (-0.22, 0.49, -0.37), turn=12)
    for y in (0.3, 0.75, 1.2, 1.65):
        s.box("oak", (-2.98, y, 0.2), (-2.65, y + 0.03, 2.2))
    rng = random.Random(7)
    for y in (0.33, 0.78, 1.23, 1.68):
        z = 0.28
        while z < 2.0:
            thick, high = rng.uniform(0.025, 0.06), rng.uniform(0.2, 0.33)
            if rng.random() < 0.8:
                s.box(rng.choice(["cloth", "linen", "accent", "ceramic", "dark"]), (-2.95, y, z), (-2.72, y + high, z + thick))
            z += thick + 0.004
    s.box("lacquer", (2.55, 0, -1.2), (2.98, 0.8, 1.2))
    s.sphere("lacquer", (2.76, 0.98, -0.6), 0.18)
    s.box("dark", (-2.0, 1.2, -2.95), (0.1, 1.9, -2.92))
    s.box("linen", (-1.94, 1.26, -2.925), (0.04, 1.84, -2.915))
    s.write("interior")


def lamps():
    s = Scene("A hall under garlands: 2,000 small lamps of many colors, each an emitter of its own.",
              ((0, 1.7, 7.4), (0, 1.45, 0), 62), depth=12)
    s.diffuse("wall", 0.62, 0.60, 0.58)
    s.rough_plastic("floor", 0.25, 0.22, 0.20, 0.3)
    s.diffuse("cloth", 0.75, 0.73, 0.70)
    s.diffuse("wood", 0.34, 0.20, 0.11)
    s.diffuse("lamp", 0.1, 0.1, 0.1)
    s.room("wall", "floor", "wall", (-5, 0, -8), (5, 4.5, 8))
    for z in (-5, -2, 1, 4):
        for x in (-2.6, 2.6):
            s.box("cloth", (x - 0.9, 0.72, z - 0.5), (x + 0.9, 0.76, z + 0.5))
            s.cylinder("wood", (x, 0, z), (x, 0.72, z), 0.08)
            for dx in (-0.6, 0.6):
                for dz in (-0.85, 0.85):
                    s.box("wood", (x + dx - 0.2, 0.43, z + dz - 0.2), (x + dx + 0.2, 0.47, z + dz + 0.2))
                    s.box("wood", (x + dx - 0.2, 0.47, z + dz + (0.17 if dz > 0 else -0.2)),
                          (x + dx + 0.2, 0.95, z + dz + (0.2 if dz > 0 else -0.17)))
                    s.box("wood", (x + dx - 0.18, 0, z + dz - 0.18), (x + dx + 0.18, 0.43, z + dz + 0.18))
    for z in range(-7, 8, 2):
        for x in (-4.6, 4.6):
            s.cylinder("wall", (x, 0, z), (x, 4.5, z), 0.22)
    rng = random.Random(3)
    colors = [(1, 0.75, 0.42), (1, 0.55, 0.25), (0.95, 0.3, 0.25), (0.35, 0.6, 1), (0.5, 0.95, 0.45)]
    count = 0
    for strand in range(40):
        z = -7.6 + strand * 15.2 / 39
        sag = 0.5 + 0.35 * rng.random()
        for k in range(50):
            t = (k + 0.5) / 50
            x = -4.7 + 9.4 * t
            y = 4.2 - sag * 4 * t * (1 - t) + 0.03 * rng.random()
            c = colors[rng.choice([0, 0, 0, 1, 2, 3, 4])]
            power = 55 * rng.uniform(0.6, 1.4)
            s.rect("lamp", (x, y, z + 0.04 * rng.random()), (0.012, 0, 0), (0, 0, 0.012), emit=[power * v for v in c],
                   name=f"strand_{strand}_{k}")
            count += 1
    assert count == 2000
    s.write("lamps")


def courtyard():
    s = Scene("A courtyard with arcades under sun and sky: most of what is seen lies in shade.",
              ((-2.6, 1.7, 5.6), (0.6, 2.2, -2), 74), depth=16)
    s.diffuse("stone", 0.58, 0.52, 0.43)
    s.diffuse("plaster", 0.72, 0.62, 0.48)
    s.diffuse("paving", 0.42, 0.40, 0.37)
    s.diffuse("tile", 0.45, 0.19, 0.11)
    s.diffuse("leaf", 0.12, 0.25, 0.07)
    s.diffuse("earth", 0.2, 0.14, 0.09)
    s.add('<emitter type="sunsky"><float name="turbidity" value="3"/><float name="scale" value="5"/><vector name="sun_direction" value="0.62, 0.66, 0.12"/>'
          '<transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>')
    s.rect("paving", (0, 0, 0), (30, 0, 0), (0, 0, -30))
    # Four wings around the court [-6, 6] × [-6, 6]; each has a gallery of pillars, a back wall, a ceiling and a story above.
    for turn in range(4):
        def place(lo, hi, bsdf):
            half = [(h - l) / 2 for l, h in zip(lo, hi)]
            mid = [(h + l) / 2 for l, h in zip(lo, hi)]
            s.shape("cube", bsdf, f'<scale value="{vec(half)}"/><translate value="{vec(mid)}"/><rotate y="1" angle="{90 * turn}"/>')
        open_front = turn == 2  # the camera stands in this wing
        place((-9, 0, -9.2), (9, 7.2, -8.9), "plaster")
        place((-9, 3.4, -9), (9, 3.7, -6), "stone")
        place((-9, 3.7, -6.3), (9, 6.6, -6), "plaster")
        place((-9.2, 6.6, -9.2), (9.2, 6.75, -5.6), "tile")
        for k in range(7):
            x = -6 + 2 * k
            place((x - 0.22, 0, -6.35), (x + 0.22, 3.0, -5.95), "stone")
            place((x - 0.32, 0, -6.45), (x + 0.32, 0.25, -5.85), "stone")
            place((x - 0.32, 2.8, -6.45), (x + 0.32, 3.05, -5.85), "stone")
        place((-6.4, 3.05, -6.4), (6.4, 3.4, -5.9), "stone")
        if not open_front:
            for k in range(6):
                x = -5 + 2 * k
                place((x - 0.35, 4.4, -6.0), (x + 0.35, 5.7, -5.9), "earth")
                place((x - 0.5, 4.3, -6.0), (x + 0.5, 4.4, -5.85), "stone")
    # A fountain and two planters.
    s.cylinder("stone", (0, 0, 0), (0, 0.6, 0), 1.3)
    s.shape("disk", "paving", '<scale value="1.3"/><rotate x="1" angle="-90"/><translate value="0, 0.55, 0"/>')
    s.cylinder("stone", (0, 0.5, 0), (0, 1.5, 0), 0.2)
    s.sphere("stone", (0, 1.65, 0), 0.32)
    for x in (-3.6, 3.6):
        s.box("tile", (x - 0.45, 0, 2.2), (x + 0.45, 0.7, 3.1))
        s.sphere("leaf", (x, 1.25, 2.65), 0.62)
        s.box("tile", (x - 0.45, 0, -3.1), (x + 0.45, 0.7, -2.2))
        s.sphere("leaf", (x, 1.25, -2.65), 0.62)
    s.write("courtyard")


def recesses():
    s = Scene("The adversary after Figure 8 of the 2007 paper: 432 omni lamps in recesses between stone blocks, each lighting its own recess "
              "and little else, so that columns are hardly combinations of other columns.",
              ((0, 2.6, 8.5), (0, 2.4, 0), 60), depth=8)
    s.diffuse("stone", 0.55, 0.50, 0.42)
    s.diffuse("floor", 0.35, 0.33, 0.30)
    s.rect("floor", (0, 0, 0), (8, 0, 0), (0, 0, -10))
    s.rect("stone", (0, 6, 0), (8, 0, 0), (0, 0, 10))
    s.rect("stone", (0, 3, 10), (-8, 0, 0), (0, 3, 0))
    rng = random.Random(11)

    def wall(origin, along, out, columns, rows):
        """Blocks in a grid with gaps; a lamp sits deep in each gap between four blocks."""
        w = 0.62
        back = [o - 0.42 * n for o, n in zip(origin, out)]
        mid = [b + a * columns * w / 2 for b, a in zip(back, along)]
        mid[1] = rows * w / 2
        s.rect("stone", mid, [a * columns * w / 2 for a in along], (0, rows * w / 2, 0))
        for c in range(columns):
            for r in range(rows):
                depth = rng.uniform(0.3, 0.42)
                middle = [o + a * (c + 0.5) * w - n * (0.42 - depth / 2) for o, a, n in zip(origin, along, out)]
                middle[1] = (r + 0.5) * w
                half = [abs(a) * 0.25 + abs(n) * depth / 2 for a, n in zip(along, out)]
                half[1] = 0.25
                s.box("stone", [m - h for m, h in zip(middle, half)], [m + h for m, h in zip(middle, half)])
        for c in range(columns):
            for r in range(rows - 1):
                p = [o + a * (c + 1.0) * w - n * 0.3 for o, a, n in zip(origin, along, out)]
                p[1] = (r + 1.0) * w
                warm = rng.uniform(0.45, 0.8)
                power = rng.uniform(0.5, 1.5) * 0.12
                s.add(f'<emitter type="point" id="lamp_{len(s.lines)}"><point name="position" value="{vec(p)}"/>'
                      f'<rgb name="intensity" value="{vec((power, power * warm, power * warm * warm))}"/></emitter>')

    wall((-5.0, 0, -6.0), (1, 0, 0), (0, 0, 1), 16, 9)
    wall((-5.0, 0, 5.8), (0, 0, -1), (1, 0, 0), 19, 9)
    wall((4.92, 0, -6.0), (0, 0, 1), (-1, 0, 0), 19, 9)
    s.box("stone", (-1.8, 0, -2.2), (-1.0, 3.0, -1.4))
    s.box("stone", (1.0, 0, -2.2), (1.8, 3.0, -1.4))
    s.sphere("stone", (0, 0.8, 1.0), 0.8)
    # A dim lamp over all, so that the room between the walls is not black.
    s.add('<emitter type="point" id="over_all"><point name="position" value="0, 5, 2"/><rgb name="intensity" value="3, 3.2, 3.6"/></emitter>')
    print("recesses:", sum("type=\"point\"" in line for line in s.lines), "point lamps")
    s.write("recesses")


if __name__ == "__main__":
    for make in (box, interior, lamps, courtyard, recesses):
        make()
