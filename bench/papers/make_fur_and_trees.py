#!/usr/bin/env python3
"""Writes two scenes after Figure 7 of Hašan, Pellacini and Bala 2007 (Mitsuba 3 XML, PLY and a file of curves), of our own making.

    bench/papers/make_fur_and_trees.py OUT [trees fur] [--hairs 48000] [--leaves 48000] [--mitsuba-hair]

  trees  some trees with tens of thousands of small leaves on a lawn, under sun and sky
  fur    a rounded animal with long ears in tens of thousands of fibers, under sun and sky and one lamp

Neighboring pixels see other leaves or hairs in other shadows: the rows of the matrix, and its columns, are of high frequency.
The fur has the BSDF "kajiyakay", which Mitsuba does not have; --mitsuba-hair writes its "hair" instead.
"""
import argparse
import math
import pathlib
import random

from scene_parts import Scene, add, catmull_rom, cross, diffuse, dot, mul, number, rgb, sub, unit

SUN = (0.55, 0.62, 0.56)


def lerp(a, b, t):
    return add(mul(a, 1 - t), mul(b, t))


def on_sphere(rng):
    z, a = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
    r = math.sqrt(1 - z * z)
    return (r * math.cos(a), r * math.sin(a), z)


def aside(rng, direction, angle):
    """A direction at `angle` (radians) from a unit direction, all around."""
    n = on_sphere(rng)
    side = unit(sub(n, mul(direction, dot(n, direction))))
    return add(mul(direction, math.cos(angle)), mul(side, math.sin(angle)))


def hollow(mesh, reach, flat, height):
    """Ground that is flat out to `flat` and then rises to `height`, so that nobody sees its end."""
    def at(s, t):
        r, a = reach * t, 2 * math.pi * s
        k = max(0.0, min(1.0, (r - flat) / (reach - flat)))
        slope = height * 6 * k * (1 - k) / (reach - flat)
        c, d = math.cos(a), math.sin(a)
        return (r * c, height * k * k * (3 - 2 * k), -r * d), (-slope * c, 1, slope * d), (s, t)
    mesh.grid(64, 40, at, close_u=True)


# ---------------------------------------------------------------------------------------------------------------------------------------- trees


def branch(rng, bark, twigs, base, direction, length, radius, level):
    """A bent limb with its offspring; the ends of the thinnest are noted in `twigs`."""
    points, p, d = [base], base, direction
    for _ in range(4):
        # Limbs seek the light, the more the thinner they are.
        d = unit(add(add(d, mul(on_sphere(rng), 0.22)), (0, 0.05 * level, 0)))
        p = add(p, mul(d, length / 4))
        points.append(p)
    curve = catmull_rom(points, 1 if level > 1 else 2)
    n = len(curve) - 1
    bark.tube(curve, [radius * (1 - 0.45 * k / n) for k in range(n + 1)], (9, 7, 5, 3)[level])
    if level == 3:
        twigs.append((points[0], p))
        return
    for k in range(rng.choice((4, 5)) if level else 7):
        at = rng.uniform(0.45, 1) if level else 0.35 + 0.65 * (k + rng.random()) / 7
        root = curve[min(n, max(1, round(at * n)))]
        away = aside(rng, d, math.radians(rng.uniform(28, 62)))
        branch(rng, bark, twigs, root, away, length * rng.uniform(0.6, 0.8), radius * 0.55 * (1 - 0.3 * at), level + 1)
    branch(rng, bark, twigs, p, d, length * 0.6, radius * 0.5, level + 1)


def leaf(mesh, rng, root, direction, size):
    """A rhombus folded along its midrib: two triangles."""
    x = unit(direction)
    y = unit(cross(x, on_sphere(rng)))
    z = cross(x, y)
    a, tip = root, add(root, mul(x, size))
    wings = [add(add(root, mul(x, 0.45 * size)), add(mul(y, s * 0.28 * size), mul(z, 0.08 * size))) for s in (-1, 1)]
    for s, wing in zip((1, -1), wings):
        n = unit(mul(cross(sub(wing, a), sub(tip, a)), s))
        first = len(mesh.vertices)
        for q, uv in ((a, (0, 0.5)), (wing, (0.45, 0.5 - 0.5 * s)), (tip, (1, 0.5))):
            mesh.vertices.append((*q, *n, *uv))
        mesh.triangles.append((first, first + 1, first + 2) if s > 0 else (first, first + 2, first + 1))


def trees(args):
    rng = random.Random(7)
    scene = Scene("Trees on a lawn.", ((0.5, 2.0, 11.5), (0, 3.1, 0)), 44, (720, 540))
    lawn = scene.material("lawn", diffuse((0.16, 0.2, 0.07)))
    bark = scene.material("bark", diffuse((0.19, 0.13, 0.09)))
    greens = [scene.material(f"leaves{k}", diffuse(c)) for k, c in enumerate(((0.16, 0.34, 0.06), (0.25, 0.42, 0.07), (0.42, 0.4, 0.08)))]
    hollow(lawn, 40, 11, 3.2)
    places = [(-3.9, 0, -0.6, 1.0), (0.2, 0, -2.2, 1.15), (4.2, 0, -0.4, 0.95), (-1.6, 0, -6.2, 1.2), (7.0, 0, -5.6, 1.2), (-8.4, 0, -5.0, 1.1)]
    for x, y, z, size in places:
        twigs = []
        branch(rng, bark, twigs, (x, y, z), (0, 1, 0), 2.3 * size, 0.17 * size, 0)
        for k in range(args.leaves // len(places)):
            a, b = twigs[rng.randrange(len(twigs))]
            root = lerp(a, b, rng.random())
            out = unit(add(add(sub(b, a), mul(on_sphere(rng), 0.25)), (0, -0.06, 0)))
            leaf(greens[0 if rng.random() < 0.55 else 1 if rng.random() < 0.8 else 2], rng, root, out, rng.uniform(0.13, 0.22) * size)
    scene.sun_and_sky(SUN, 3)
    return scene, args.out / "trees"


# ------------------------------------------------------------------------------------------------------------------------------------------ fur


class Ellipsoid:
    """Center, radii, and degrees about x and about z (in this order); how long its hair is, and which way that is combed."""

    def __init__(self, center, radii, turn=(0, 0), hair=0.1, comb=(0, -0.5, -0.4)):
        self.center, self.radii, self.turn, self.hair, self.comb = center, radii, turn, hair, comb
        a, b = (math.radians(t) for t in turn)
        ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
        # Columns: where the own axes point.
        self.axes = [(cb, sb, 0), (-sb * ca, cb * ca, sa), (sb * sa, -cb * sa, ca)]

    def world(self, local):
        return add(mul(self.axes[0], local[0]), add(mul(self.axes[1], local[1]), mul(self.axes[2], local[2])))

    def inside(self, p, margin=1.0):
        q = sub(p, self.center)
        return sum((dot(q, e) / r) ** 2 for e, r in zip(self.axes, self.radii)) < margin

    def draw(self, rng):
        """A point evenly on the surface, and its normal."""
        min_radius = min(self.radii)
        while True:
            d = on_sphere(rng)
            n = tuple(c / r for c, r in zip(d, self.radii))
            stretch = math.sqrt(dot(n, n))  # of area, but for a constant
            if rng.random() * (1 / min_radius) <= stretch:
                return add(self.center, self.world(tuple(c * r for c, r in zip(d, self.radii)))), unit(self.world(n))

    def area(self):
        p = 1.6075  # Thomsen's approximation, good to 1 %
        a, b, c = (r ** p for r in self.radii)
        return 4 * math.pi * ((a * b + a * c + b * c) / 3) ** (1 / p)

    def skin(self, mesh):
        def at(s, t):
            a, b = 2 * math.pi * s, math.pi * t
            d = (math.sin(b) * math.cos(a), -math.cos(b), math.sin(b) * math.sin(a))
            return (add(self.center, self.world(tuple(c * r for c, r in zip(d, self.radii)))), self.world(tuple(c / r for c, r in zip(d, self.radii))),
                    (s, t))
        mesh.grid(48, 24, at, close_u=True)


ANIMAL = [
    Ellipsoid((0, 0.56, -0.06), (0.47, 0.5, 0.62), (-12, 0), 0.13),
    Ellipsoid((0, 0.6, 0.4), (0.36, 0.36, 0.3), (0, 0), 0.13, (0, -0.8, 0)),
    Ellipsoid((0, 1.08, 0.56), (0.3, 0.28, 0.34), (0, 0), 0.075, (0, -0.1, -0.9)),
    Ellipsoid((0.15, 0.99, 0.76), (0.13, 0.11, 0.13), (0, 0), 0.06, (0.2, -0.3, -0.7)),
    Ellipsoid((-0.15, 0.99, 0.76), (0.13, 0.11, 0.13), (0, 0), 0.06, (-0.2, -0.3, -0.7)),
    Ellipsoid((0.2, 1.56, 0.4), (0.1, 0.36, 0.055), (-16, -14), 0.045, (0, 0.9, 0)),
    Ellipsoid((-0.2, 1.56, 0.4), (0.1, 0.36, 0.055), (-16, 14), 0.045, (0, 0.9, 0)),
    Ellipsoid((0.34, 0.36, -0.14), (0.26, 0.34, 0.4), (0, 0), 0.12),
    Ellipsoid((-0.34, 0.36, -0.14), (0.26, 0.34, 0.4), (0, 0), 0.12),
    Ellipsoid((0.33, 0.09, 0.24), (0.12, 0.09, 0.27), (0, 0), 0.05, (0, -0.2, 0.8)),
    Ellipsoid((-0.33, 0.09, 0.24), (0.12, 0.09, 0.27), (0, 0), 0.05, (0, -0.2, 0.8)),
    Ellipsoid((0.16, 0.2, 0.58), (0.1, 0.22, 0.11), (0, 0), 0.06, (0, -0.9, 0.1)),
    Ellipsoid((-0.16, 0.2, 0.58), (0.1, 0.22, 0.11), (0, 0), 0.06, (0, -0.9, 0.1)),
    Ellipsoid((0, 0.42, -0.72), (0.15, 0.15, 0.15), (0, 0), 0.14, (0, 0.1, -0.3)),
]
EYES = [(0.205, 1.17, 0.735), (-0.205, 1.17, 0.735)]
NOSE = (0, 1.06, 0.895)


def fiber(rng, part, root, normal):
    """Control points of a cubic b-spline with radii; the curve begins just under the skin."""
    comb = add(part.comb, mul(on_sphere(rng), 0.35))
    comb = sub(comb, mul(normal, dot(comb, normal)))
    length = part.hair * rng.uniform(0.75, 1.2)
    points, d, p, count = [], normal, sub(root, mul(normal, 0.45 * length)), 6
    for k in range(count):
        points.append((p, 0.0032 * (1 - 0.75 * k / (count - 1))))
        p = add(p, mul(d, length / (count - 2.5)))
        if k >= 1:
            d = unit(add(d, add(mul(comb, 0.55), mul(on_sphere(rng), 0.16))))
    return points


def hair_lines(rng, hairs):
    """Lines of a file of curves: so many fibers all over the animal."""
    area = [part.area() * (0.8 if part.hair > 0.1 else 1.5) for part in ANIMAL]
    lines, made = [], 0
    while made < hairs:
        part = rng.choices(ANIMAL, area)[0]
        root, normal = part.draw(rng)
        bald = root[1] < 0.01 or any(other is not part and other.inside(root) for other in ANIMAL)
        bald = bald or any(dot(sub(root, e), sub(root, e)) < 0.085 ** 2 for e in EYES) or dot(sub(root, NOSE), sub(root, NOSE)) < 0.06 ** 2
        if bald:
            continue
        points = fiber(rng, part, root, normal)
        if any(p[1] < 0.002 for p, _ in points[2:]):  # not through the floor
            points = [((p[0], max(p[1], 0.004), p[2]), r) for p, r in points]
        lines += [f"{p[0]:.5f} {p[1]:.5f} {p[2]:.5f} {r:.5f}" for p, r in points] + [""]
        made += 1
    return lines


def fur(args):
    rng = random.Random(11)
    scene = Scene("A furry animal.", ((1.75, 1.35, 3.35), (0, 0.83, 0.12)), 36, (640, 640))
    floor = scene.material("floor", diffuse((0.4, 0.38, 0.35)))
    skin = scene.material("skin", diffuse((0.22, 0.14, 0.09)))
    dark = scene.material("dark", '<bsdf type="plastic">' + rgb("diffuse_reflectance", (0.02, 0.015, 0.01)) + "</bsdf>")
    pink = scene.material("pink", diffuse((0.5, 0.22, 0.2)))
    hollow(floor, 9, 2.2, 2.4)
    for part in ANIMAL:
        part.skin(skin)
    for eye in EYES:
        dark.sphere(eye, 0.062, 32)
    pink.sphere(NOSE, 0.04, 24)
    folder = args.out / "fur"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fur.txt").write_text("\n".join(hair_lines(rng, args.hairs)) + "\n")
    if args.mitsuba_hair:
        bsdf = '<bsdf type="hair">' + number("eumelanin", 0.35) + number("pheomelanin", 0.3) + "</bsdf>"
    else:
        bsdf = ('<bsdf type="kajiyakay">' + rgb("diffuse_reflectance", (0.62, 0.43, 0.25)) + rgb("specular_reflectance", (0.16, 0.15, 0.14)) +
                number("exponent", 45) + "</bsdf>")
    scene.emitters.append('<shape type="bsplinecurve"><string name="filename" value="fur.txt"/>' + bsdf + "</shape>")
    scene.sun_and_sky(SUN, 2)
    scene.lamp((-2.6, 2.4, 1.2), (0.35, 0, 0.78), (0.5, 0.66, -0.22), (40, 34, 26))
    return scene, folder


SCENES = {"trees": trees, "fur": fur}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", metavar="scene", help="trees or fur; default: both")
    parser.add_argument("--hairs", type=int, default=48000)
    parser.add_argument("--leaves", type=int, default=48000)
    parser.add_argument("--mitsuba-hair", action="store_true")
    args = parser.parse_args()
    for name in args.scenes or SCENES:
        if name not in SCENES:
            parser.error(f"there is no scene {name}; the scenes are {', '.join(SCENES)}")
        scene, folder = SCENES[name](args)
        hairs = f" and {args.hairs} hairs" if name == "fur" else ""
        print(f"{name}: {scene.write(folder)} triangles{hairs}", flush=True)


if __name__ == "__main__":
    main()
