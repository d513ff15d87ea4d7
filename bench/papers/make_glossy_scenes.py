#!/usr/bin/env python3
"""Writes the scenes for the experiments of Hašan, Křivánek, Walter and Bala 2009 (Mitsuba 3 XML and PLY): after the paper's, of our own making.

    bench/papers/make_glossy_scenes.py OUT [kitchen hall tableau box glossy-box]

  kitchen     brushed anisotropic metal; the only lamps are spots above the stove, so that the room is lit by what it reflects
  hall        a façade of curved sails without any diffuse part, under sun and sky
  tableau     glossy objects on an anisotropic plane under three distant lights
  box         a diffuse box with two blocks (corner darkening)
  glossy-box  all surfaces glossy with alpha 0.03; a narrow spot makes one virtual light on the left wall
"""
import argparse
import math
import pathlib
import random

from scene_parts import Scene, add, brushed, catmull_rom, cross, diffuse, mul, sub, unit, ward


def pot(steel, rim, base, radius, height, handles="sides"):
    """A pan with a lip and handles."""
    r, h = radius, height
    steel.revolve(base, [(0.0, 0.0), (r * 0.93, 0.0), (r * 0.93, 0.0), (r, 0.03 * h / 0.2), (r, h), (r, h), (r * 1.04, h + 0.006), (r * 1.04, h + 0.006),
                         (r * 0.97, h + 0.004), (r * 0.95, h - 0.01), (r * 0.95, 0.02), (r * 0.95, 0.02), (0.0, 0.012)], 64, 3)
    if handles == "sides":
        for side in (-1, 1):
            p = [(side * r, h * 0.75, -0.05), (side * (r + 0.045), h * 0.78, -0.045), (side * (r + 0.055), h * 0.78, 0), (side * (r + 0.045), h * 0.78, 0.045),
                 (side * r, h * 0.75, 0.05)]
            rim.tube([add(base, q) for q in catmull_rom(p, 5)], 0.007, 10)
    else:
        p = [(0.0, h * 0.8, r), (0.02, h * 0.95, r + 0.07), (0.03, h + 0.02, r + 0.2)]
        rim.tube([add(base, q) for q in catmull_rom(p, 6)], 0.011, 12)


def lid(steel, knob, base, radius):
    steel.revolve(base, [(radius * 1.02, 0.0), (radius * 1.02, 0.008), (radius * 0.8, 0.03), (radius * 0.3, 0.048), (0.0, 0.05)], 64, 4)
    knob.revolve(add(base, (0, 0.048, 0)), [(0.012, 0.0), (0.01, 0.012), (0.022, 0.02), (0.022, 0.03), (0.0, 0.036)], 24, 3)


def handle(metal, a, b, out, radius=0.006):
    """A bar handle between two points of a front, standing off it by `out`."""
    metal.tube(catmull_rom([a, a, add(a, out), add(a, out), add(b, out), add(b, out), b, b], 3), radius, 10)


def chair(wood, seat, at, turn):
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def place(p):
        return (at[0] + c * p[0] + s * p[2], at[1] + p[1], at[2] - s * p[0] + c * p[2])
    for x in (-0.19, 0.19):
        wood.tube([place(q) for q in catmull_rom([(x * 1.1, 0, -0.2), (x, 0.45, -0.18), (x * 0.98, 0.7, -0.2), (x * 0.95, 0.92, -0.25)], 6)], 0.016, 12)
        wood.tube([place(q) for q in catmull_rom([(x * 1.1, 0, 0.22), (x, 0.44, 0.18)], 4)], 0.016, 12)
    for y, z in ((0.6, -0.19), (0.74, -0.208), (0.88, -0.242)):
        wood.tube([place(q) for q in catmull_rom([(-0.19, y, z), (0, y, z - 0.03), (0.19, y, z)], 8)], 0.012, 10)
    seat.box(add(at, (-0.21, 0.44, -0.21)), add(at, (0.21, 0.475, 0.21)), 0.014, 0, turn)


def cupboards(front, metal, xs, y0, y1, z, out=0.022, low_handle=False, drawers=0):
    """Fronts along x facing +z, with a bar handle each."""
    for x0, x1 in zip(xs, xs[1:]):
        g = 0.002
        if drawers:
            step = (y1 - y0) / drawers
            for k in range(drawers):
                a, b = y0 + k * step, y0 + (k + 1) * step
                front.box((x0 + g, a + g, z), (x1 - g, b - g, z + out), 0.005, 0)
                handle(metal, ((x0 + x1) / 2 - 0.1, b - 0.06, z + out), ((x0 + x1) / 2 + 0.1, b - 0.06, z + out), (0, 0, 0.03))
            continue
        front.box((x0 + g, y0 + g, z), (x1 - g, y1 - g, z + out), 0.005, 0)
        front.box((x0 + 0.06, y0 + 0.06, z + out - 0.002), (x1 - 0.06, y1 - 0.06, z + out + 0.006), 0.006, 0)
        y = y0 + 0.08 if low_handle else y1 - 0.08
        handle(metal, (x1 - 0.035, y - 0.07, z + out), (x1 - 0.035, y + 0.07, z + out), (0, 0, 0.03))


def kitchen():
    scene = Scene("A kitchen of brushed metal, lit by spots above the stove alone.", ((1.15, 1.62, 2.75), (-0.28, 1.22, -1.6)), 72, (800, 600), 32)
    add_ = scene.material
    wall = add_("wall", ward((0.6, 0.58, 0.52), (0.06, 0.06, 0.06), 0.25))
    ceiling = add_("ceiling", ward((0.74, 0.73, 0.7), (0.03, 0.03, 0.03), 0.3))
    floor = add_("floor_tile", ward((0.3, 0.2, 0.13), (0.16, 0.16, 0.16), 0.1))
    grout = add_("grout", diffuse((0.35, 0.33, 0.3)))
    tile = add_("tile", ward((0.5, 0.55, 0.53), (0.1, 0.1, 0.1), 0.12))
    lacquer = add_("lacquer", ward((0.24, 0.045, 0.03), (0.09, 0.09, 0.09), 0.15))
    body = add_("carcass", ward((0.4, 0.36, 0.3), (0.05, 0.05, 0.05), 0.25))
    counter = add_("counter", ward((0.02, 0.02, 0.02), (0.62, 0.62, 0.6), 0.06, 0.26))
    stove = add_("stove", ward((0.02, 0.02, 0.02), (0.78, 0.77, 0.74), 0.07, 0.3))
    fridge = add_("fridge", ward((0.03, 0.03, 0.03), (0.6, 0.61, 0.62), 0.08, 0.3))
    hood = add_("hood", brushed("Al", 0.08, 0.3))
    metal = add_("handles", ward((0.03, 0.03, 0.03), (0.65, 0.64, 0.6), 0.14))
    pan = add_("pan", ward((0.02, 0.02, 0.02), (0.66, 0.64, 0.6), 0.09, 0.2))
    copper = add_("copper", ward((0.04, 0.02, 0.01), (0.72, 0.42, 0.26), 0.12, 0.2))
    iron = add_("iron", ward((0.03, 0.03, 0.03), (0.12, 0.12, 0.12), 0.2))
    wood = add_("wood", ward((0.3, 0.17, 0.08), (0.08, 0.08, 0.08), 0.15))
    china = add_("china", ward((0.66, 0.65, 0.6), (0.08, 0.08, 0.08), 0.1))
    fruit = add_("fruit", ward((0.55, 0.16, 0.03), (0.06, 0.06, 0.06), 0.15))

    # The room: x −2.4 … 2.4, z −2 … 3, 2.6 high.
    ceiling.patch((-2.4, 2.6, -2), (4.8, 0, 0), (0, 0, 5))
    grout.patch((-2.4, 0, 3), (4.8, 0, 0), (0, 0, -5))
    wall.patch((-2.4, 0, -2), (4.8, 0, 0), (0, 2.6, 0))
    wall.patch((-2.4, 0, 3), (0, 0, -5), (0, 2.6, 0))
    wall.patch((2.4, 0, -2), (0, 0, 5), (0, 2.6, 0))
    wall.patch((2.4, 0, 3), (-4.8, 0, 0), (0, 2.6, 0))
    step = 0.4
    for i in range(12):
        for k in range(13):
            x, z = -2.4 + i * step, -2 + k * step
            floor.box((x + 0.004, -0.01, z + 0.004), (x + step - 0.004, 0.006, min(z + step, 3.0) - 0.004), 0.004)
    for x0, x1, y0, y1 in ((-2.4, -0.9, 0.92, 1.42), (-0.9, 0.9, 0.92, 1.92), (0.9, 1.42, 0.92, 1.42)):
        nx, ny = round((x1 - x0) / 0.1), round((y1 - y0) / 0.1)
        for i in range(nx):
            for k in range(ny):
                a, b = x0 + (x1 - x0) * i / nx, y0 + (y1 - y0) * k / ny
                tile.box((a + 0.0015, b + 0.0015, -2.001), (a + (x1 - x0) / nx - 0.0015, b + (y1 - y0) / ny - 0.0015, -1.991), 0.003)

    # Back wall: counters on both sides of the stove, cupboards above, fridge at the right.
    for x0, x1 in ((-2.4, -0.76), (0.76, 1.44)):
        body.box((x0, 0.1, -2), (x1, 0.88, -1.42))
        iron.box((x0, 0, -2), (x1, 0.1, -1.48))
        counter.box((x0, 0.88, -2), (x1, 0.92, -1.37), 0.006, 0)
    cupboards(lacquer, metal, [-1.82, -1.29], 0.1, 0.88, -1.42)
    cupboards(lacquer, metal, [-1.29, -0.76], 0.1, 0.88, -1.42, drawers=3)
    cupboards(lacquer, metal, [0.76, 1.1, 1.44], 0.1, 0.88, -1.42)
    for xs in ([-2.4, -1.9, -1.4, -0.9], [0.9, 1.42]):
        body.box((xs[0], 1.42, -2), (xs[-1], 2.2, -1.68))
        cupboards(lacquer, metal, xs, 1.42, 2.2, -1.68, low_handle=True)
    fridge.box((1.46, 0.05, -2), (2.2, 1.2, -1.36), 0.02, 1)
    fridge.box((1.46, 1.21, -2), (2.2, 1.95, -1.36), 0.02, 1)
    iron.box((1.48, 0, -1.98), (2.18, 0.05, -1.42))
    handle(metal, (1.54, 0.7, -1.36), (1.54, 1.15, -1.36), (0, 0, 0.045), 0.01)
    handle(metal, (1.54, 1.26, -1.36), (1.54, 1.6, -1.36), (0, 0, 0.045), 0.01)

    # Left wall: a counter up to the door.
    body.box((-2.4, 0.1, -1.42), (-1.82, 0.88, 0.5))
    iron.box((-2.4, 0, -1.42), (-1.88, 0.1, 0.5))
    counter.box((-2.4, 0.88, -1.37), (-1.77, 0.92, 0.52), 0.006, 2)
    for z0, z1 in ((-1.36, -0.9), (-0.9, -0.43), (-0.43, 0.04), (0.04, 0.5)):
        lacquer.box((-1.82, 0.102, z0 + 0.002), (-1.798, 0.878, z1 - 0.002), 0.005)
        handle(metal, (-1.798, 0.73, z1 - 0.035), (-1.798, 0.83, z1 - 0.035), (0.03, 0, 0))

    # The stove: a wide brushed top on which the spots shine, rings, knobs, two ovens with a bar each.
    body.box((-0.75, 0.02, -2), (0.75, 0.88, -1.42))
    stove.box((-0.75, 0.88, -2), (0.75, 0.925, -1.34), 0.008, 0)
    for x in (-0.375, 0.375):
        fridge.box((x - 0.365, 0.12, -1.42), (x + 0.365, 0.72, -1.39), 0.008, 0)
        iron.box((x - 0.25, 0.22, -1.392), (x + 0.25, 0.56, -1.386), 0.004)
        handle(metal, (x - 0.3, 0.66, -1.39), (x + 0.3, 0.66, -1.39), (0, 0, 0.05), 0.011)
    fridge.box((-0.74, 0.74, -1.42), (0.74, 0.87, -1.38), 0.008, 0)
    for k in range(8):
        x = -0.63 + 0.18 * k
        metal.tube([(x, 0.805, -1.38), (x, 0.805, -1.375), (x, 0.805, -1.345)], [0.028, 0.026, 0.022], 24)
    for x, z in ((-0.5, -1.84), (0.0, -1.84), (0.5, -1.84)):
        iron.tube([(x + 0.1 * math.cos(a * math.pi / 24), 0.935, z + 0.1 * math.sin(a * math.pi / 24)) for a in range(48)], 0.008, 8, closed=True)
        for a in range(4):
            d = (math.cos(a * math.pi / 2), 0, math.sin(a * math.pi / 2))
            iron.tube([add((x, 0.94, z), mul(d, 0.03)), add((x, 0.94, z), mul(d, 0.125))], 0.006, 8)
    pot(pan, metal, (-0.5, 0.948, -1.84), 0.105, 0.13)
    lid(pan, metal, (-0.5, 1.082, -1.84), 0.105)
    pot(copper, iron, (0.5, 0.948, -1.84), 0.09, 0.08, "long")

    # The hood hangs well back, so that what the stove reflects reaches the ceiling in front of it.
    hood.box((-0.75, 1.62, -2), (0.75, 1.69, -1.62), 0.008, 0)
    hood.box((-0.16, 1.69, -2), (0.16, 2.6, -1.74), 0.004, 1)
    for x in (-0.6, -0.3, 0.0, 0.3, 0.6):
        metal.tube([(x, 1.68, -1.62), (x, 1.68, -1.56)], 0.012, 12)
        metal.tube([(x, 1.7, -1.55), (x, 1.66, -1.55)], [0.03, 0.036], 24)
        scene.spot((x, 1.65, -1.55), (x, 0.92, -1.57), (60, 54, 46), 38, 30)

    # On the counters.
    for k, (r, h) in enumerate(((0.07, 0.17), (0.06, 0.14), (0.05, 0.11))):
        base = (-1.02 - 0.17 * k, 0.92, -1.82)
        pan.revolve(base, [(0, 0), (r, 0), (r, 0), (r, h), (r, h), (r * 0.9, h + 0.012), (0, h + 0.018)], 48, 3)
        iron.sphere(add(base, (0, h + 0.025, 0)), 0.011, 16)
    copper.revolve((1.12, 0.92, -1.72), [(0, 0), (0.1, 0), (0.1, 0), (0.115, 0.05), (0.09, 0.13), (0.045, 0.165), (0.045, 0.165), (0.03, 0.18), (0, 0.185)], 64, 5)
    copper.tube(catmull_rom([(1.21, 1.0, -1.72), (1.27, 1.03, -1.72), (1.295, 1.1, -1.72)], 8), [0.02 - 0.0007 * k for k in range(17)], 16)
    iron.tube(catmull_rom([(1.04, 1.06, -1.72), (1.06, 1.16, -1.72), (1.12, 1.19, -1.72), (1.18, 1.16, -1.72), (1.2, 1.06, -1.72)], 8), 0.008, 10)
    china.revolve((-2.08, 0.92, -0.55), [(0, 0.01), (0.05, 0.0), (0.05, 0.0), (0.06, 0.012), (0.13, 0.06), (0.16, 0.105), (0.155, 0.105), (0.12, 0.06), (0, 0.02)], 64, 4)
    for k in range(5):
        a = 2 * math.pi * k / 5
        fruit.sphere((-2.08 + 0.065 * math.cos(a), 1.01, -0.55 + 0.065 * math.sin(a)), 0.042, 32)
    fruit.sphere((-2.08, 1.06, -0.55), 0.042, 32)
    wood.box((-2.12, 0.92, -1.2), (-1.9, 0.945, -0.85), 0.008, 2)
    for k in range(3):
        china.revolve((-2.05, 0.92 + 0.012 * k, 0.12), [(0, 0), (0.07, 0), (0.07, 0), (0.12, 0.014), (0.118, 0.018), (0.07, 0.006), (0, 0.006)], 48, 3)

    # A rail with ladles on the tiles, a table and chairs.
    metal.tube([(-2.2, 1.34, -1.96), (-1.0, 1.34, -1.96)], 0.007, 10)
    for k in range(6):
        x = -2.05 + 0.19 * k
        metal.tube(catmull_rom([(x, 1.34, -1.95), (x, 1.22, -1.94), (x, 1.1, -1.95)], 6), 0.005, 8)
        pan.revolve((x, 1.05, -1.94), [(0, 0), (0.03, 0.01), (0.042, 0.04), (0.04, 0.04), (0.028, 0.013), (0, 0.004)], 24, 3)
    wood.box((-0.95, 0.71, 0.05), (0.25, 0.75, 0.85), 0.012, 0)
    for x in (-0.88, 0.18):
        for z in (0.12, 0.78):
            wood.tube([(x, 0, z), (x, 0.71, z)], [0.022, 0.032], 16)
    chair(wood, lacquer, (-0.72, 0, -0.12), 8)
    chair(wood, lacquer, (0.0, 0, -0.15), -6)
    chair(wood, lacquer, (-1.28, 0, 0.5), 95)
    china.revolve((-0.62, 0.75, 0.35), [(0, 0), (0.07, 0), (0.07, 0), (0.12, 0.014), (0.118, 0.018), (0.07, 0.006), (0, 0.006)], 48, 3)
    china.revolve((-0.3, 0.75, 0.52), [(0, 0), (0.025, 0), (0.025, 0), (0.04, 0.03), (0.043, 0.08), (0.04, 0.08), (0.037, 0.03), (0, 0.006)], 40, 3)
    pan.revolve((-0.12, 0.75, 0.32), [(0, 0), (0.045, 0), (0.045, 0), (0.06, 0.06), (0.045, 0.14), (0.03, 0.19), (0.035, 0.22), (0.032, 0.22), (0.026, 0.19), (0, 0.03)], 48, 4)
    return scene


def sail(mesh, frame, ring, plan, heights, lean, bulge, columns, rows, rng):
    """A wall of cladding panels over the plan curve: it leans by `lean` of its height and bulges outwards; small gaps between the panels, each tilted a little."""
    base = catmull_rom([(x, 0.0, z) for x, z in plan], 12)
    tops = catmull_rom([(h, 0.0, 0.0) for h in heights], 12)

    def along(curve, s):
        k = min(int(s * (len(curve) - 1)), len(curve) - 2)
        f = s * (len(curve) - 1) - k
        return add(mul(curve[k], 1 - f), mul(curve[k + 1], f))

    def point(s, t, off=0.0):
        s = min(max(s, 0.0), 1.0)
        p, d = along(base, s), sub(along(base, min(s + 0.01, 1)), along(base, max(s - 0.01, 0)))
        out = unit(cross((0, 1, 0), d))
        h = along(tops, s)[0]
        reach = lean * h * t * t + bulge * math.sin(math.pi * t) + off
        return add(add(p, mul(out, reach)), (0, h * t, 0))

    def normal(s, t):
        return cross(sub(point(s, min(t + 0.005, 1)), point(s, max(t - 0.005, 0))), sub(point(s + 0.005, t), point(s - 0.005, t)))
    for j in range(rows):
        for i in range(columns):
            shift = 0.5 / columns * (j % 2)
            s0, s1 = i / columns + shift, (i + 1) / columns + shift
            s0, s1 = min(s0, 1.0), min(s1, 1.0)
            if s1 - s0 < 0.2 / columns:
                continue
            t0, t1 = j / rows, (j + 1) / rows
            gap_s, gap_t = 0.012 * (s1 - s0), 0.02 * (t1 - t0)
            tilt = (rng.gauss(0, 0.004), rng.gauss(0, 0.004), rng.gauss(0, 0.004))

            def at(u, v):
                s, t = s0 + gap_s + (s1 - s0 - 2 * gap_s) * u, t0 + gap_t + (t1 - t0 - 2 * gap_t) * v
                return point(s, t), mul(add(unit(normal(s, t)), tilt), -1), (u, v)
            mesh.grid(3, 3, at)
    # What is behind the gaps, and the edge along the top.
    frame.grid(columns, rows, lambda u, v: (point(u, v, -0.06), mul(normal(u, v), -1), (u, v)))
    ring.tube([point(k / 60, 1.0, -0.03) for k in range(61)], 0.06, 8)


def hall():
    rng = random.Random(2009)
    scene = Scene("A concert hall clad in metal sails, under sun and sky.", ((3.0, 1.9, 27.0), (0.2, 6.4, 0.0)), 62, (800, 600), 16)
    steel = scene.material("steel", ward((0, 0, 0), (0.72, 0.71, 0.69), 0.1, 0.16))
    satin = scene.material("satin", ward((0, 0, 0), (0.66, 0.66, 0.66), 0.16))
    frame = scene.material("frame", ward((0.04, 0.04, 0.04), (0.1, 0.1, 0.1), 0.2))
    edge = scene.material("edge", ward((0, 0, 0), (0.6, 0.6, 0.6), 0.15))
    paving = scene.material("paving", ward((0.4, 0.37, 0.33), (0.04, 0.04, 0.04), 0.2))
    joint = scene.material("joint", diffuse((0.22, 0.2, 0.19)))
    stone = scene.material("stone", ward((0.5, 0.45, 0.36), (0.04, 0.04, 0.04), 0.2))
    glass = scene.material("glazing", ward((0.02, 0.025, 0.03), (0.28, 0.3, 0.32), 0.06))
    town = scene.material("town", diffuse((0.38, 0.33, 0.28)))
    leaf = scene.material("leaf", diffuse((0.09, 0.17, 0.05)))

    joint.patch((-60, -0.02, 45), (120, 0, 0), (0, 0, -100))
    for i in range(30):
        for k in range(24):
            x, z = -30 + 2 * i, -12 + 2 * k
            paving.box((x + 0.015, -0.2, z + 0.015), (x + 1.985, 0.006 * rng.random(), z + 1.985), 0.012)
    # Sails from the back to the front; plan curves run from left to right as seen from the street.
    sail(satin, frame, edge, [(-15, -7), (-9, -6), (-3, -8), (3, -9)], [8, 12, 14.5, 11], 0.08, 0.5, 26, 16, rng)
    sail(steel, frame, edge, [(-2, -6), (4, -4.5), (9, -6), (15, -10)], [12, 15.5, 13, 8], 0.12, 0.7, 28, 18, rng)
    sail(steel, frame, edge, [(-17, 1), (-12, 2.2), (-7, 0), (-4, -4)], [6, 9.5, 12.5, 15], 0.14, 0.8, 26, 16, rng)
    sail(satin, frame, edge, [(-6.5, 1), (-3, 3.2), (0.5, 1.5), (2.5, -3)], [4.5, 8, 12, 14], 0.16, 0.6, 22, 16, rng)
    sail(steel, frame, edge, [(1.5, 1.5), (5, 4), (9.5, 3.4), (13, -1)], [10.5, 8.5, 6.5, 4.5], -0.1, 0.9, 26, 12, rng)
    sail(satin, frame, edge, [(11, 3), (14, 4.5), (18, 2), (20, -3)], [4, 6.5, 9, 10], 0.1, 0.5, 20, 12, rng)
    # The entrance: a glazed gap, steps, a low wall, planters.
    glass.box((-0.6, 0.9, 0.4), (2.2, 5.2, 0.6))
    for k in range(7):
        frame.box((-0.62 + 0.46 * k, 0.9, 0.58), (-0.56 + 0.46 * k, 5.2, 0.68), 0.01)
    for k in range(6):
        stone.box((-3.4 - 0.35 * k, 0, 1.0), (6.0 + 0.35 * k, 0.9 - 0.15 * k, 5.2 + 0.38 * k), 0.015)
    stone.box((-15, 0, 7.2), (-7, 0.8, 7.9), 0.03)
    stone.box((9, 0, 8.2), (19, 0.8, 8.9), 0.03)
    for x, z, r in ((-12, 9, 0.85), (-9.4, 9.4, 0.7), (12.4, 10.4, 0.9), (15.6, 10.2, 0.75)):
        stone.revolve((x, 0, z), [(0, 0), (0.5, 0), (0.5, 0), (0.75, 0.65), (0.75, 0.65), (0.66, 0.66), (0.6, 0.55), (0, 0.55)], 32, 3)
        for k in range(220):
            d = unit((rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0, 1)))
            c = add((x, 0.6 + 0.8 * r, z), mul(d, r * (0.75 + 0.3 * rng.random())))
            u, w = unit(cross(d, (0.3, 1, 0.1))), unit((rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0, 1)))
            leaf.patch(sub(c, mul(u, 0.08)), mul(u, 0.16), mul(unit(cross(w, u)), 0.1))
    for x in (-5.5, 8.5):
        edge.tube([(x, 0, 11.5), (x, 4.2, 11.5)], [0.07, 0.045], 16)
        edge.revolve((x, 4.2, 11.5), [(0.05, 0), (0.28, 0.1), (0.3, 0.16), (0.1, 0.24), (0, 0.26)], 32, 4)
    # The town behind the street: it is what the façade mirrors and what the sun does not reach.
    for x0, x1, z0, z1, h in ((-30, -22, -16, 6, 9), (24, 32, -14, 8, 11), (-26, -8, 36, 42, 9), (-4, 9, 37, 43, 13), (12, 28, 36, 42, 8)):
        town.box((x0, 0, z0), (x1, h, z1), 0.05)
    scene.sun_and_sky((-0.62, 0.6, 0.42), 4)
    return scene


def torus_knot(mesh, center, size, p, q, tube, turns=420, sides=28):
    points = []
    for k in range(turns):
        a = 2 * math.pi * k / turns
        r = size * (0.62 + 0.26 * math.cos(q * a))
        points.append((center[0] + r * math.cos(p * a), center[1] + 0.3 * size * math.sin(q * a), center[2] + r * math.sin(p * a)))
    mesh.tube(points, tube, sides, closed=True)


def teapot(mesh, base, s):
    mesh.revolve(base, [(0, 0), (0.55 * s, 0.0), (0.55 * s, 0.0), (0.6 * s, 0.04 * s), (0.95 * s, 0.38 * s), (1.0 * s, 0.62 * s), (0.8 * s, 1.0 * s), (0.55 * s, 1.14 * s),
                        (0.55 * s, 1.14 * s), (0.56 * s, 1.18 * s), (0.3 * s, 1.31 * s), (0.1 * s, 1.36 * s), (0.07 * s, 1.4 * s), (0.14 * s, 1.48 * s), (0.1 * s, 1.55 * s),
                        (0, 1.57 * s)], 112, 7)
    spout = catmull_rom([add(base, mul(q, s)) for q in ((0.82, 0.4, 0), (1.12, 0.5, 0), (1.28, 0.78, 0), (1.5, 1.06, 0))], 14)
    mesh.tube(spout, [s * (0.21 - 0.13 * (k / (len(spout) - 1)) ** 0.8) for k in range(len(spout))], 28)
    mesh.tube(catmull_rom([add(base, mul(q, s)) for q in ((-0.8, 0.98, 0), (-1.2, 1.08, 0), (-1.42, 0.85, 0), (-1.25, 0.5, 0), (-0.93, 0.36, 0))], 12), 0.075 * s, 20)


def goblet(mesh, base, s):
    mesh.revolve(base, [(0, 0), (0.36 * s, 0), (0.36 * s, 0), (0.34 * s, 0.03 * s), (0.1 * s, 0.08 * s), (0.055 * s, 0.2 * s), (0.1 * s, 0.32 * s), (0.05 * s, 0.44 * s),
                        (0.08 * s, 0.6 * s), (0.3 * s, 0.75 * s), (0.4 * s, 1.0 * s), (0.36 * s, 1.3 * s), (0.36 * s, 1.3 * s), (0.34 * s, 1.3 * s), (0.37 * s, 1.0 * s),
                        (0.27 * s, 0.79 * s), (0, 0.7 * s)], 96, 6)


def tableau():
    scene = Scene("Glossy objects on an anisotropic plane under three distant lights.", ((0.2, 3.3, 5.9), (0.05, 0.38, 0.25)), 42, (800, 600), 16)
    plane = scene.material("plane", ward((0.015, 0.014, 0.013), (0.72, 0.7, 0.66), 0.07, 0.28))
    gold = scene.material("gold", ward((0.01, 0.006, 0.002), (0.82, 0.6, 0.26), 0.13))
    silver = scene.material("silver", ward((0.008, 0.008, 0.008), (0.8, 0.8, 0.78), 0.1))
    copper = scene.material("copper", ward((0.01, 0.005, 0.003), (0.8, 0.44, 0.3), 0.12, 0.22))
    blue = scene.material("blue", ward((0.01, 0.012, 0.02), (0.3, 0.42, 0.75), 0.15))
    green = scene.material("green", ward((0.01, 0.015, 0.01), (0.36, 0.66, 0.34), 0.12))
    brass = scene.material("brass", brushed("Au", 0.15, 0.15))

    plane.patch((-9, 0, 7), (18, 0, 0), (0, 0, -18))
    teapot(silver, (-0.15, 0, -0.35), 0.62)
    torus_knot(gold, (-1.75, 0.4, 0.35), 0.85, 2, 3, 0.13)
    torus_knot(blue, (1.75, 0.34, -0.65), 0.78, 3, 2, 0.1)
    goblet(copper, (1.2, 0, 0.75), 0.8)
    goblet(brass, (-0.8, 0, 1.35), 0.7)
    goblet(green, (-1.5, 0, -1.3), 0.9)
    for mesh, x, z, r in ((green, 0.35, 1.2, 0.3), (copper, 1.95, 0.55, 0.26), (silver, 0.75, 1.75, 0.2), (gold, 0.9, -1.6, 0.42), (blue, -1.0, 0.62, 0.22), (brass, -0.25, 2.0, 0.16)):
        mesh.sphere((x, r, z), r, 128)
    scene.directional((0.62, -0.75, -0.25), (2.6, 2.4, 2.0))
    scene.directional((-0.7, -0.6, -0.2), (1.3, 1.5, 1.9))
    scene.directional((0.12, -0.62, -0.78), (1.6, 1.5, 1.5))
    return scene


def walls(white, left, right):
    white.patch((-1, 0, 1), (2, 0, 0), (0, 0, -2))
    white.patch((-1, 2, -1), (2, 0, 0), (0, 0, 2))
    white.patch((-1, 0, -1), (2, 0, 0), (0, 2, 0))
    left.patch((-1, 0, 1), (0, 0, -2), (0, 2, 0))
    right.patch((1, 0, -1), (0, 0, 2), (0, 2, 0))


def box():
    scene = Scene("A diffuse box with two blocks.", ((0, 1, 3.7), (0, 1, 0)), 39, (512, 512))
    white = scene.material("white", diffuse((0.73, 0.72, 0.69)))
    red = scene.material("red", diffuse((0.6, 0.07, 0.05)))
    green = scene.material("green", diffuse((0.12, 0.42, 0.1)))
    walls(white, red, green)
    white.box((-0.65, 0, -0.6), (-0.05, 1.2, 0.0), turn=18)
    white.box((0.05, 0, -0.05), (0.6, 0.55, 0.5), turn=-16)
    scene.lamp((0, 1.98, 0), (0.25, 0, 0), (0, 0, 0.25), (16, 12.5, 8))
    return scene


def glossy_box():
    scene = Scene("A box of which all surfaces are glossy; a narrow spot shines on its left wall.", ((0, 1, 3.7), (0, 1, 0)), 39, (512, 512), 3)
    gray = scene.material("gray", ward((0.25, 0.25, 0.25), (0.4, 0.4, 0.4), 0.03))
    red = scene.material("red", ward((0.3, 0.06, 0.05), (0.4, 0.4, 0.4), 0.03))
    green = scene.material("green", ward((0.08, 0.25, 0.07), (0.4, 0.4, 0.4), 0.03))
    walls(gray, red, green)
    gray.box((0.05, 0, -0.5), (0.55, 0.6, 0.0), turn=-16)
    scene.spot((0.9, 1.2, 0.2), (-1, 0.8, -0.2), (60, 56, 50), 1, 0.8)
    return scene


SCENES = {"kitchen": kitchen, "hall": hall, "tableau": tableau, "box": box, "glossy-box": glossy_box}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", metavar="scene", help="one of " + ", ".join(SCENES) + "; default: all")
    args = parser.parse_args()
    for name in args.scenes or SCENES:
        if name not in SCENES:
            parser.error(f"there is no scene {name}; the scenes are {', '.join(SCENES)}")
        print(f"{name}: {SCENES[name]().write(args.out / name)} triangles", flush=True)


if __name__ == "__main__":
    main()
