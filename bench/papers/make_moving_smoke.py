#!/usr/bin/env python3
"""Writes two scenes in which nothing but smoke moves (Mitsuba 3 XML, PLY, and a .vol for every frame), for tensor clustering over ray lights.

    bench/papers/make_moving_smoke.py OUT [plume basin] [--frames 24]

  plume    thick white smoke rises between a lamp and a colored wall: much of its light has been scattered many times
  basin    thin smoke drifts through a room under two lamps, and is all around the camera

Lumirank reads them as scenes that move at 24 frames per second (`lumirank animate`).
"""
import math

from make_media_scenes import MediaScene, noise, smoke
from scene_parts import diffuse, write_scenes


class Noise:
    """A block of noise that repeats along every axis, to be asked anywhere."""

    def __init__(self, seed, size=24, cell=6):
        self.size, self.values = size, noise(seed, (size, size, size), cell)
        low, high = min(self.values), max(self.values)
        self.values = [(v - low) / (high - low) for v in self.values]
        # Its borders are made to meet by mixing with the opposite ones.
        n, edge = size, size // 4
        for axis_step in (1, n, n * n):
            for base in range(n ** 3):
                k = base // axis_step % n
                if k < edge:
                    other = base + (n - edge) * axis_step
                    if k + n - edge < n:
                        t = 0.5 + 0.5 * k / edge
                        self.values[base] = t * self.values[base] + (1 - t) * self.values[other]

    def at(self, x, y, z):
        n = self.size
        (i, a), (j, b), (k, c) = [(math.floor(v), v - math.floor(v)) for v in (x, y, z)]
        total = 0.0
        for dz, wz in ((0, 1 - c), (1, c)):
            for dy, wy in ((0, 1 - b), (1, b)):
                row = ((k + dz) % n * n + (j + dy) % n) * n
                total += wz * wy * ((1 - a) * self.values[row + i % n] + a * self.values[row + (i + 1) % n])
        return total


class MovingSmoke(MediaScene):
    """With a grid for every frame, of density(x, y, z, seconds)."""

    def moving_grid(self, name, size, lo, hi, frames, density):
        for frame in range(frames):
            values = []
            for k in range(size[2]):
                for j in range(size[1]):
                    for i in range(size[0]):
                        at = [lo[d] + (hi[d] - lo[d]) * (n + 0.5) / size[d] for d, n in enumerate((i, j, k))]
                        values.append(density(*at, frame / 24))
            self.grid(f"{name}.{frame:04d}", size, lo, hi, values)


def plume(out, frames):
    scene = MovingSmoke("Thick smoke rises between a lamp and a colored wall.", ((0.4, 1.5, 4.6), (0.0, 1.25, 0.0)), 42, (240, 240))
    scene.medium("smoke", smoke("smoke.####.vol", 14.0, (0.97, 0.96, 0.94), 0.3))
    scene.material("floor", diffuse((0.5, 0.48, 0.44))).patch((-4, 0, 5), (8, 0, 0), (0, 0, -8), 16, 16)
    scene.material("wall", diffuse((0.2, 0.35, 0.55))).patch((-4, 0, -2.4), (8, 0, 0), (0, 4, 0), 8, 4)
    brick = scene.material("brick", diffuse((0.5, 0.22, 0.16)))
    brick.box((-0.45, 0, -0.45), (0.45, 0.35, 0.45))
    brick.sphere((1.5, 0.35, -0.6), 0.35, 40)
    scene.aimed_lamp((-2.6, 2.4, 1.4), (0, 1.3, 0), 0.25, 0.25, (90, 84, 74))
    scene.aimed_lamp((2.5, 0.8, -1.2), (0, 1.0, 0), 0.2, 0.2, (14, 20, 34))
    scene.sky((0.05, 0.06, 0.08))
    whirl, lo, hi = Noise(3), (-1.1, 0.35, -1.1), (1.1, 2.9, 1.1)

    def density(x, y, z, t):
        height = y - lo[1]
        bend = 0.22 * height * math.sin(1.7 * height - 1.3 * t)
        r = math.hypot(x - bend, z - 0.12 * height * math.cos(1.3 * height - t)) / (0.22 + 0.2 * height)
        if r >= 1.6:
            return 0.0
        n = 0.65 * whirl.at(5 * x, 5 * y - 4.5 * t, 5 * z) + 0.35 * whirl.at(11 * x + 3, 11 * y - 12 * t, 11 * z)
        return max(0.0, n - 0.28 * r * r - 0.16) * min(1.0, 8 * height) * min(1.0, 3 * (hi[1] - y))
    scene.moving_grid("smoke", (44, 52, 44), lo, hi, frames, density)
    scene.enclose("smoke", lo, hi)
    return scene, out / "plume"


def basin(out, frames):
    scene = MovingSmoke("Thin smoke drifts through a room under two lamps.", ((2.4, 1.5, 2.9), (-0.6, 1.0, -1.0)), 58, (320, 240))
    scene.medium("smoke", smoke("smoke.####.vol", 0.9, (0.95, 0.95, 0.95), 0.4), around_camera=True)
    wall, wood = scene.material("wall", diffuse((0.66, 0.63, 0.58))), scene.material("wood", diffuse((0.38, 0.25, 0.14)))
    wood.patch((-3, 0, 3.5), (6, 0, 0), (0, 0, -6.5), 12, 12)
    wall.patch((-3, 2.8, -3), (6, 0, 0), (0, 0, 6.5), 8, 8)
    for lo, hi in (((-3, 0, -3.2), (3, 2.8, -3)), ((-3.2, 0, -3), (-3, 2.8, 3.5)), ((3, 0, -3), (3.2, 2.8, 3.5)), ((-3, 0, 3.5), (3, 2.8, 3.7))):
        wall.box(lo, hi)
    red = scene.material("red", diffuse((0.6, 0.12, 0.08)))
    red.box((-1.6, 0, -1.7), (-0.7, 0.8, -0.9))
    red.sphere((0.7, 0.4, -1.1), 0.4, 48)
    scene.small_lamp((-1.1, 2.2, -1.2), 0.08, (190, 160, 110))
    scene.small_lamp((1.6, 1.7, -2.2), 0.06, (90, 120, 190))
    whirl, lo, hi = Noise(5), (-3.25, -0.1, -3.25), (3.25, 2.9, 3.75)

    def density(x, y, z, t):
        n = 0.7 * whirl.at(1.6 * x - 1.1 * t, 2.2 * y + 0.3 * t, 1.6 * z) + 0.3 * whirl.at(4 * x - 3.2 * t, 5 * y, 4 * z + 2)
        return 0.05 + 1.3 * max(0.0, n - 0.42)
    scene.moving_grid("smoke", (44, 20, 46), lo, hi, frames, density)
    scene.enclose("smoke", lo, hi)
    return scene, out / "basin"


SCENES = {"plume": plume, "basin": basin}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES, 24)
