#!/usr/bin/env python3
"""Writes six scenes whose light the eye meets by water, mirrors, frosted or brushed things (Mitsuba 3 XML and PLY).

    bench/strangers/make_water_and_panes.py OUT [lido nightpool diver bath frost brushed]

  lido       an outdoor pool at noon: sun reaches its floor by waves, and the eye sees that by waves
  nightpool  the same at night, lit by six lamps under water
  diver      the same at noon, from under water
  bath       a bathroom whose lamps are within globes of clear glass: a mirror shows what these light, water covers the tub's floor
  frost      a room behind a pane of frosted glass that fills the view
  brushed    a plate of brushed metal that fills the view
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "papers"))
from make_hard_scenes import room  # noqa: E402
from scene_parts import Scene, brushed as brushed_metal, diffuse, number, rgb, write_scenes  # noqa: E402

WATER = '<bsdf type="dielectric"><float name="int_ior" value="1.33"/></bsdf>'
GLASS = '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf>'
MIRROR = '<bsdf type="twosided"><bsdf type="conductor"><string name="material" value="none"/></bsdf></bsdf>'


def waves(mesh, corner, size, level, parts, of):
    """A surface of water over size = (x, z), as a sum of waves `of` (wave number along x, along z, phase, amplitude)."""
    def at(s, t):
        x, z = corner[0] + size[0] * s, corner[1] - size[1] * t
        y, nx, nz = level, 0.0, 0.0
        for kx, kz, phase, a in of:
            angle = kx * x + kz * z + phase
            y, nx, nz = y + a * math.sin(angle), nx - a * kx * math.cos(angle), nz - a * kz * math.cos(angle)
        return (x, y, z), (nx, 1, nz), (s, t)
    mesh.grid(parts[0], parts[1], at)


def pool(comment, camera, fov):
    scene = Scene(comment, camera, fov, (640, 360))
    deck, tile = scene.material("deck", diffuse((0.6, 0.55, 0.5))), scene.material("tile", diffuse((0.35, 0.6, 0.7)))
    house, grass = scene.material("house", diffuse((0.8, 0.78, 0.75))), scene.material("grass", diffuse((0.2, 0.3, 0.1)))
    for lo, hi in (((-4.5, -2, -7), (-2.5, 0, 7)), ((2.5, -2, -7), (4.5, 0, 7)), ((-2.5, -2, 5), (2.5, 0, 7)), ((-2.5, -2, -7), (2.5, 0, -5))):
        deck.box(lo, hi)
    for lo, hi in (((-2.5, -2.4, -5), (2.5, -1.8, 5)), ((-2.51, -1.8, -5), (-2.47, 0, 5)), ((2.47, -1.8, -5), (2.51, 0, 5)),
                   ((-2.5, -1.8, -5.01), (2.5, 0, -4.97)), ((-2.5, -1.8, 4.97), (2.5, 0, 5.01))):
        tile.box(lo, hi)
    house.box((-6, 0, -11.5), (6, 3, -7.5))
    for x in (-44.5, 4.5):
        grass.box((x, -0.6, -40), (x + 40, 0, 40))
    for z in (-2, 0, 2):
        house.box((2.9, 0.2, z - 0.25), (3.9, 0.3, z + 0.25), 0.02)
    scene.single("steel", MIRROR).sphere((-3.2, 0.4, 1), 0.4)
    waves(scene.single("water", WATER), (-2.5, 5), (5, 10), -0.15, (120, 200),
          ((5, 2, 0, 0.012), (-3, 6, 1, 0.01), (11, -7, 0, 0.006)))
    return scene


def lido(out):
    scene = pool("An outdoor pool at noon.", ((4.2, 2.2, 6), (-0.5, -0.6, -1)), 55)
    scene.sun_and_sky((0.5, 0.7, 0.3), 1)
    return scene, out / "lido"


def nightpool(out):
    scene = pool("An outdoor pool at night.", ((4.2, 2.2, 6), (-0.5, -0.6, -1)), 55)
    for z in (-3, 0, 3):
        scene.lamp((-2.4, -1, z), (0, 0.08, 0), (0, 0, 0.08), (50, 48, 40))
        scene.lamp((2.4, -1, z), (0, 0.08, 0), (0, 0, -0.08), (50, 48, 40))
    scene.emitters.append('<emitter type="constant">' + rgb("radiance", (0.004, 0.005, 0.009)) + "</emitter>")
    return scene, out / "nightpool"


def diver(out):
    scene = pool("Under water at noon.", ((-1.6, -1.4, 4.2), (0.6, -0.7, -2)), 80)
    scene.material("ball", diffuse((0.8, 0.5, 0.3))).sphere((0.3, -1.2, 0.5), 0.35)
    scene.sun_and_sky((0.5, 0.7, 0.3), 1)
    return scene, out / "diver"


def bath(out):
    scene = Scene("A bathroom with globes of clear glass.", ((-1.2, 1.6, 1.7), (0.4, 1.1, -1.5)), 65, (640, 360))
    wall, floor = scene.material("wall", diffuse((0.75, 0.73, 0.7))), scene.material("floor", diffuse((0.3, 0.28, 0.26)))
    ceiling, white = scene.material("ceiling", diffuse((0.8, 0.8, 0.8))), scene.material("white", diffuse((0.85, 0.85, 0.85)))
    room(wall, floor, ceiling, (2, 2), 2.6)
    scene.single("mirror", MIRROR).box((-1.6, 1.0, -1.99), (-0.3, 2.0, -1.97))
    white.box((-1.7, 0.75, -2), (-0.2, 0.85, -1.5), 0.01)
    for lo, hi in (((0.25, 0, -2), (1.95, 0.15, -1.1)), ((0.25, 0, -1.15), (1.95, 0.55, -1.09)), ((0.24, 0, -2), (0.3, 0.55, -1.1)), ((1.9, 0, -2), (1.96, 0.55, -1.1))):
        white.box(lo, hi)
    waves(scene.single("water", WATER), (0.3, -1.15), (1.6, 0.85), 0.45, (60, 40), ((14, 3, 0, 0.004),))
    scene.single("screen", GLASS).box((0.15, 0.2, -2), (0.17, 2.0, -1.1))
    globes = scene.single("globes", GLASS)
    for at, r in (((-1.4, 2.2, -1.8), 0.1), ((-0.5, 2.2, -1.8), 0.1), ((0.5, 2.4, 0.3), 0.14)):
        globes.sphere(at, r)
        for side in (1, -1):
            scene.lamp((at[0], at[1] + 0.001 * side, at[2]), (0.03, 0, 0), (0, 0, -0.03 * side), (260, 220, 160))
    return scene, out / "bath"


def behind(name, body, out):
    scene = Scene(f"A room and a large pane: {name}.", ((0, 1.2, 2), (0, 1, -1)), 60, (640, 360))
    wall, red = scene.material("wall", diffuse((0.7, 0.7, 0.65))), scene.material("red", diffuse((0.7, 0.2, 0.15)))
    room(wall, wall, wall, (3, 3), 3)
    red.patch((2.99, 0, -3), (0, 0, 6), (0, 3, 0))
    red.sphere((0.6, 0.6, -1.2), 0.5)
    scene.single("pane", body).box((-1.4, 0.1, -0.02), (1.4, 2.3, 0.02))
    for z in (-1, 1):
        scene.lamp((0, 2.9, z), (0.15, 0, 0), (0, 0, 0.15), (60, 56, 50))
    return scene, out / name


def frost(out):
    return behind("frost", '<bsdf type="roughdielectric">' + number("alpha", 0.15) + "</bsdf>", out)


def brushed(out):
    return behind("brushed", brushed_metal("Al", 0.05, 0.3), out)


SCENES = {"lido": lido, "nightpool": nightpool, "diver": diver, "bath": bath, "frost": frost, "brushed": brushed}


if __name__ == "__main__":
    write_scenes(__doc__, SCENES)
