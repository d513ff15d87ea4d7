"""Meshes and Mitsuba 3 XML for the scene generators beside it. Only the standard library; the same input writes the same bytes.

Units are meters, +y is up. Every mesh has texture coordinates, because the direction of brushing of an anisotropic metal is that of u.
"""
import argparse
import math
import pathlib
import struct
import sys


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1 / length) if length > 0 else (0.0, 1.0, 0.0)


def text(v):
    return ", ".join(f"{c:.6g}" for c in v)


class Mesh:
    """Triangles with normals and texture coordinates; the parts of one material are collected in one mesh."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def grid(self, nu, nv, at, close_u=False):
        """Patch of nu × nv quads; at(s, t) with s, t in [0, 1] gives (position, normal, uv). Oriented by its normals."""
        first = len(self.vertices)
        for j in range(nv + 1):
            for i in range(nu + 1):
                p, n, uv = at(0 if close_u and i == nu else i / nu, j / nv)
                if close_u and i == nu:
                    uv = (1.0, uv[1])
                self.vertices.append((*p, *unit(n), *uv))
        for j in range(nv):
            for i in range(nu):
                a = first + j * (nu + 1) + i
                for tri in ((a, a + 1, a + nu + 2), (a, a + nu + 2, a + nu + 1)):
                    p = [self.vertices[k][:3] for k in tri]
                    n = cross(sub(p[1], p[0]), sub(p[2], p[0]))
                    if dot(n, n) < 1e-20:  # the pole of a surface of revolution
                        continue
                    mean = add(add(self.vertices[tri[0]][3:6], self.vertices[tri[1]][3:6]), self.vertices[tri[2]][3:6])
                    self.triangles.append(tri if dot(n, mean) > 0 else (tri[0], tri[2], tri[1]))

    def patch(self, corner, u, v, nu=1, nv=1):
        """Parallelogram from `corner` along u and v; its normal is u × v."""
        n = cross(u, v)
        self.grid(nu, nv, lambda s, t: (add(corner, add(mul(u, s), mul(v, t))), n, (s, t)))

    def box(self, lo, hi, bevel=0.0, grain=0, turn=0.0):
        """Axis-aligned box with rounded edges. `grain`: the axis that u follows on faces that contain it; `turn`: degrees about its own vertical axis."""
        mid = [(a + b) / 2 for a, b in zip(lo, hi)]
        half = [(b - a) / 2 for a, b in zip(lo, hi)]
        bevel = min(bevel, *(0.999 * h for h in half))
        inner = [h - bevel for h in half]
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

        def place(p):
            return (mid[0] + c * p[0] + s * p[2], mid[1] + p[1], mid[2] - s * p[0] + c * p[2])

        def spin(n):
            return (c * n[0] + s * n[2], n[1], -s * n[0] + c * n[2])

        # Along an edge of a face: two steps of the rounding, the flat part, two steps.
        arc = [math.tan(math.pi / 4 * k / 2) for k in (2, 1, 0)] if bevel > 0 else [0]
        knots = [(-1, -a) for a in arc] + [(1, a) for a in reversed(arc)]
        for axis in range(3):
            a, b = [k for k in range(3) if k != axis]
            if b == grain or (a != grain and axis == 0):
                a, b = b, a
            for side in (-1, 1):
                def at(x, y, axis=axis, a=a, b=b, side=side):
                    ku, kv = knots[round(x * (len(knots) - 1))], knots[round(y * (len(knots) - 1))]
                    n = [0.0, 0.0, 0.0]
                    n[axis], n[a], n[b] = side, ku[1], kv[1]
                    n = unit(n)
                    p = [0.0, 0.0, 0.0]
                    p[axis], p[a], p[b] = side * inner[axis], ku[0] * inner[a], kv[0] * inner[b]
                    p = [q + bevel * m for q, m in zip(p, n)]
                    return place(p), spin(n), (p[a], p[b])
                self.grid(len(knots) - 1, len(knots) - 1, at)

    def revolve(self, base, profile, segments=48, smooth=4):
        """Surface of revolution about the vertical through `base`; `profile`: (radius, height) from below, drawn as a Catmull-Rom curve of `smooth` steps."""
        curve = catmull_rom([(r, h, 0.0) for r, h in profile], smooth)
        count = len(curve) - 1

        def at(s, t):
            k = round(t * count)
            r, h, _ = curve[k]
            d = sub(curve[min(k + 1, count)], curve[max(k - 1, 0)])
            a = 2 * math.pi * s
            return ((base[0] + r * math.cos(a), base[1] + h, base[2] + r * math.sin(a)),
                    (d[1] * math.cos(a), -d[0], d[1] * math.sin(a)), (s, t))
        self.grid(segments, count, at, close_u=True)

    def sphere(self, center, radius, segments=64):
        def at(s, t):
            a, b = 2 * math.pi * s, math.pi * t
            n = (math.sin(b) * math.cos(a), -math.cos(b), math.sin(b) * math.sin(a))
            return add(center, mul(n, radius)), n, (s, t)
        self.grid(segments, segments // 2, at, close_u=True)

    def tube(self, points, radius, sides=12, closed=False):
        """Round tube about a polyline; `radius` a number or one for each point. u runs around it."""
        count = len(points)
        radii = radius if isinstance(radius, (list, tuple)) else [radius] * count
        tangents = []
        for k in range(count):
            before, after = (points[k - 1], points[(k + 1) % count]) if closed else (points[max(k - 1, 0)], points[min(k + 1, count - 1)])
            tangents.append(unit(sub(after, before)))
        # Parallel transport, so that the tube does not twist; the rest of the turn of a closed one is spread evenly.
        x = cross(tangents[0], (0.0, 1.0, 0.0))
        x = unit(x) if dot(x, x) > 1e-6 else (1.0, 0.0, 0.0)
        frames = []
        for t in tangents + ([tangents[0]] if closed else []):
            x = unit(sub(x, mul(t, dot(x, t))))
            frames.append((x, cross(t, x)))
        twist = 0.0
        if closed:
            twist = math.atan2(dot(frames[-1][0], frames[0][1]), dot(frames[-1][0], frames[0][0]))
        rings = count + 1 if closed else count

        def at(s, v):
            k = round(v * (rings - 1))
            a = 2 * math.pi * s - twist * v
            fx, fy = frames[k]
            n = add(mul(fx, math.cos(a)), mul(fy, math.sin(a)))
            return add(points[k % count], mul(n, radii[k % count])), n, (s, v)
        self.grid(sides, rings - 1, at, close_u=True)
        if not closed:
            for k, sign in ((0, -1), (count - 1, 1)):
                self.disk(points[k], mul(tangents[k], sign), radii[k], sides)

    def disk(self, center, normal, radius, segments=32):
        n = unit(normal)
        x = cross(n, (0.0, 1.0, 0.0))
        x = unit(x) if dot(x, x) > 1e-6 else (1.0, 0.0, 0.0)
        y = cross(n, x)

        def at(s, t):
            a = 2 * math.pi * s
            p = (t * radius * math.cos(a), t * radius * math.sin(a))
            return add(center, add(mul(x, p[0]), mul(y, p[1]))), n, p
        self.grid(segments, 1, at)

    def write(self, path):
        header = ("ply\nformat binary_little_endian 1.0\n"
                  f"element vertex {len(self.vertices)}\n" + "".join(f"property float {k}\n" for k in ("x", "y", "z", "nx", "ny", "nz", "u", "v")) +
                  f"element face {len(self.triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        body = b"".join(struct.pack("<8f", *v) for v in self.vertices) + b"".join(struct.pack("<B3i", 3, *t) for t in self.triangles)
        path.write_bytes(header.encode() + body)


def catmull_rom(points, steps):
    """The curve through the points, `steps` pieces to a span; a point given twice makes a corner."""
    out = []
    for k in range(len(points) - 1):
        p0, p1, p2, p3 = points[max(k - 1, 0)], points[k], points[k + 1], points[min(k + 2, len(points) - 1)]
        if p1 == p2:
            continue
        for i in range(steps):
            t = i / steps
            out.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3)
                             for a, b, c, d in zip(p0, p1, p2, p3)))
    return out + [points[-1]]


def rgb(name, value):
    return f'<rgb name="{name}" value="{text(value)}"/>'


def number(name, value):
    return f'<float name="{name}" value="{value:g}"/>'


def ward(diffuse, specular, alpha_u, alpha_v=None):
    alphas = number("alpha", alpha_u) if alpha_v is None else number("alpha_u", alpha_u) + number("alpha_v", alpha_v)
    return ('<bsdf type="ward"><string name="variant" value="balanced"/>' + alphas + rgb("diffuse_reflectance", diffuse) +
            rgb("specular_reflectance", specular) + "</bsdf>")


def brushed(material, alpha_u, alpha_v):
    return (f'<bsdf type="roughconductor"><string name="material" value="{material}"/><string name="distribution" value="ggx"/>' +
            number("alpha_u", alpha_u) + number("alpha_v", alpha_v) + "</bsdf>")


def diffuse(value):
    return '<bsdf type="diffuse">' + rgb("reflectance", value) + "</bsdf>"


class Scene:
    """A folder with scene.xml and one mesh file per material."""

    def __init__(self, comment, camera, fov, film, depth=-1):
        origin, target = camera
        self.meshes, self.inside = {}, {}
        self.lines = [
            f"<!-- {comment} Written by {pathlib.Path(sys.argv[0]).name}. -->",
            '<scene version="3.0.0">',
            f'\t<integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>',
            '\t<sensor type="perspective">',
            f'\t\t<float name="fov" value="{fov:g}"/>',
            f'\t\t<transform name="to_world"><lookat origin="{text(origin)}" target="{text(target)}" up="0, 1, 0"/></transform>',
            '\t\t<sampler type="independent"><integer name="sample_count" value="4"/></sampler>',
            '\t\t<film type="hdrfilm">',
            f'\t\t\t<integer name="width" value="{film[0]}"/>',
            f'\t\t\t<integer name="height" value="{film[1]}"/>',
            '\t\t\t<rfilter type="box"/>',
            "\t\t</film>",
            "\t</sensor>",
        ]
        self.emitters = []

    def material(self, name, body):
        self.lines.append(f'\t<bsdf type="twosided" id="{name}">{body}</bsdf>')
        self.meshes[name] = Mesh()
        return self.meshes[name]

    def single(self, name, body, inside=""):
        """A material that is another one from behind; `inside`: XML of each shape that has it, as a medium."""
        self.lines.append("\t" + body.replace("<bsdf ", f'<bsdf id="{name}" ', 1))
        self.meshes[name] = Mesh()
        self.inside[name] = inside
        return self.meshes[name]

    def spot(self, origin, target, intensity, cutoff, beam):
        self.emitters.append(f'<emitter type="spot"><transform name="to_world"><lookat origin="{text(origin)}" target="{text(target)}" up="0, 0, 1"/></transform>' +
                             rgb("intensity", intensity) + number("cutoff_angle", cutoff) + number("beam_width", beam) + "</emitter>")

    def directional(self, direction, irradiance):
        self.emitters.append(f'<emitter type="directional"><vector name="direction" value="{text(direction)}"/>' + rgb("irradiance", irradiance) + "</emitter>")

    def sun_and_sky(self, towards, scale):
        # In Mitsuba 3 the sky's own frame has +z up.
        self.emitters.append('<emitter type="sunsky">' + number("turbidity", 3) + (number("sun_scale", scale) + number("sky_scale", scale) if scale != 1 else "") +
                             f'<vector name="sun_direction" value="{text(towards)}"/><transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>')

    def lamp(self, center, u, v, radiance):
        n = unit(cross(u, v))
        m = " ".join(f"{c:.6g}" for i in range(3) for c in (u[i], v[i], n[i], center[i])) + " 0 0 0 1"
        self.emitters.append(f'<shape type="rectangle"><transform name="to_world"><matrix value="{m}"/></transform>' + diffuse((0.0, 0.0, 0.0)) +
                             '<emitter type="area">' + rgb("radiance", radiance) + "</emitter></shape>")

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        lines = self.lines + ["\t" + e for e in self.emitters]
        total = 0
        for name, mesh in self.meshes.items():
            if not mesh.triangles:
                continue
            mesh.write(folder / f"{name}.ply")
            total += len(mesh.triangles)
            lines.append(f'\t<shape type="ply"><string name="filename" value="{name}.ply"/><ref id="{name}"/>{self.inside.get(name, "")}</shape>')
        (folder / "scene.xml").write_text("\n".join(lines + ["</scene>"]) + "\n")
        return total


def write_scenes(description, scenes, frames=None):
    """The command line of a generator: OUT and the names of scenes (all by default); scenes[name](OUT) gives (scene, folder). With `frames`, the default of --frames, scenes[name](OUT, frames) does."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*")
    if frames:
        parser.add_argument("--frames", type=int, default=frames, help=f"of the shot, 24 a second; default {frames}")
    args = parser.parse_args()
    if frames and args.frames < 2:
        parser.error("a shot has at least two frames")
    for name in args.scenes or scenes:
        if name not in scenes:
            parser.error(f"there is no scene {name}; the scenes are {', '.join(scenes)}")
        scene, folder = scenes[name](args.out, args.frames) if frames else scenes[name](args.out)
        print(f"{folder}/scene.xml: {scene.write(folder)} triangles")
