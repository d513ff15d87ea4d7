#!/usr/bin/env python3
"""Scenes of furniture, plants and cars that other people modeled (Sweet Home 3D's catalog), put together in Blender and written by its glTF exporter as it stands.

    apt-get download sweethome3d-furniture && dpkg-deb -x sweethome3d-furniture_*.deb CATALOG
    bench/strangers/make_from_furniture.py CATALOG OUT LUMIRANK [NAME ...]

NAME.glb, and NAME/scene.xml for Mitsuba 3: the same through `LUMIRANK convert`, with sun and sky, which glTF has not. parlor: sun through a window; evening: the same room by its lamps; bath: mirrors, shower and small spots;
kitchen: daylight and lamps over an island; drive: cars, hedges and trees in the sun; nursery: a clouded sky behind curtains; club: many small lamps at night.

Models are as they come: open meshes, surfaces that lie in each other, normals of their own, colors of 1 and above. Needs from pip: bpy==4.5.15 (Python 3.11).
"""
import math
import pathlib
import re
import subprocess
import sys
import zipfile

import bpy
import mathutils

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from make_in_blender import box, glow, material, plane  # noqa: E402


class Catalog:
    """Models by name, with their sizes in meters."""

    def __init__(self, root, scratch):
        self.models = {}
        for file in sorted(pathlib.Path(root).rglob("*.sh3f")):
            folder = scratch / file.stem
            if not folder.is_dir():
                zipfile.ZipFile(file).extractall(folder)
            values = {}
            for line in (folder / "PluginFurnitureCatalog.properties").read_text("latin-1").splitlines():
                if m := re.match(r"(\w+)#(\d+)=(.*)", line):
                    values.setdefault(m[2], {})[m[1]] = m[3]
            for v in values.values():
                if v.get("model", "").endswith(".obj"):
                    name = pathlib.PurePosixPath(v["model"]).stem
                    turned = [float(x) for x in v.get("modelRotation", "1 0 0 0 1 0 0 0 1").split()]
                    size = tuple(float(v[k]) / 100 for k in ("width", "depth", "height"))
                    self.models.setdefault(name, (folder / v["model"].lstrip("/"), size, turned))

    def put(self, name, place, angle=0.0, height=None):
        """Stands on `place`, its front towards -y turned by `angle` degrees; returns its objects."""
        path, size, turned = self.models[name]
        before = set(bpy.data.objects)
        bpy.ops.wm.obj_import(filepath=str(path), forward_axis="Y", up_axis="Z")  # coordinates of the file
        objects = [o for o in bpy.data.objects if o not in before]
        frame = mathutils.Matrix([turned[3 * k:3 * k + 3] for k in range(3)]).to_4x4()
        upright = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1))) @ frame
        points = [upright @ o.matrix_world @ v.co for o in objects for v in o.data.vertices]
        low = [min(p[k] for p in points) for k in range(3)]
        high = [max(p[k] for p in points) for k in range(3)]
        scale = [size[k] / max(high[k] - low[k], 1e-6) for k in range(3)]
        if height:
            scale = [s * height / size[2] for s in scale]
        base = mathutils.Vector(((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]))
        there = (mathutils.Matrix.Translation(place) @ mathutils.Matrix.Rotation(math.radians(angle), 4, "Z")
                 @ mathutils.Matrix.Diagonal((*scale, 1)) @ mathutils.Matrix.Translation(-base) @ upright)
        for o in objects:
            o.matrix_world = there @ o.matrix_world
        return objects


def bulb(place, watts, radius=0.03, color=(1.0, 0.8, 0.55)):
    """A glowing ball: `watts` of light, as radiant exitance over its area."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=radius, location=place)
    bpy.context.object.data.materials.append(glow("bulb", color, watts / (4 * math.pi * radius * radius * math.pi)))


def panel(place, size, watts, rotation=(math.pi, 0, 0), color=(1.0, 0.93, 0.85)):
    plane("panel", place, size, glow("panel", color, watts / (size[0] * size[1] * math.pi)), rotation)


def room(width, depth, height, wall, floor, ceiling, window=None):
    """From (0, 0, 0); `window`: (y, z, width, height) of the hole in the wall at x = 0."""
    box("floor", (width / 2, depth / 2, -0.05), (width + 0.4, depth + 0.4, 0.1), floor)
    box("ceiling", (width / 2, depth / 2, height + 0.05), (width + 0.4, depth + 0.4, 0.1), ceiling)
    box("right", (width + 0.1, depth / 2, height / 2), (0.2, depth + 0.4, height), wall)
    box("back", (width / 2, depth + 0.1, height / 2), (width, 0.2, height), wall)
    box("front", (width / 2, -0.1, height / 2), (width, 0.2, height), wall)
    if not window:
        box("left", (-0.1, depth / 2, height / 2), (0.2, depth + 0.4, height), wall)
        return
    y, z, w, h = window
    box("left_low", (-0.1, depth / 2, z / 2), (0.2, depth + 0.4, z), wall)
    box("left_high", (-0.1, depth / 2, (z + h + height) / 2), (0.2, depth + 0.4, height - z - h), wall)
    box("left_near", (-0.1, (y - w / 2) / 2 - 0.1, z + h / 2), (0.2, y - w / 2 + 0.2, h), wall)
    box("left_far", (-0.1, (y + w / 2 + depth) / 2 + 0.1, z + h / 2), (0.2, depth - y - w / 2 + 0.2, h), wall)


def sky(azimuth, up, sky_scale, sun_scale):
    """`azimuth` of the sun in degrees from +x to +y; what the file's axes call x, z, -y."""
    a, flat = math.radians(azimuth), math.sqrt(1 - up * up)
    lines = ['<emitter type="sunsky">', f'    <vector name="sun_direction" value="{flat * math.cos(a):.5f} {up:.5f} {-flat * math.sin(a):.5f}"/>']
    lines += [f'    <float name="sky_scale" value="{sky_scale}"/>', f'    <float name="sun_scale" value="{sun_scale}"/>']
    # In Mitsuba 3 the sky's own frame has +z up.
    lines += ['    <transform name="to_world">', '        <rotate x="1" angle="-90"/>', "    </transform>", "</emitter>"]
    return "".join(f"    {line}\n" for line in lines)


def camera(place, target, degrees):
    data = bpy.data.cameras.new("camera")
    data.angle = math.radians(degrees)
    o = bpy.data.objects.new("camera", data)
    bpy.context.scene.collection.objects.link(o)
    o.location = place
    o.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = o


def salon(put):
    room(6.0, 5.0, 2.8, material("wall", (0.75, 0.7, 0.62)), material("planks", (0.34, 0.2, 0.11), Roughness=0.35), material("ceiling", (0.85, 0.85, 0.85)), (2.6, 0.9, 1.8, 1.5))
    put("oriental-rug", (3.0, 2.6, 0.005))
    put("winchesterSofa", (3.2, 4.3, 0))
    put("winchesterArmchair", (1.2, 3.3, 0), 60)
    put("armchair2", (5.0, 2.6, 0), -80)
    put("metal_glass_table", (3.0, 2.7, 0.01), height=0.42)
    put("bookcase", (5.75, 4.2, 0), -90)
    put("ficus", (0.6, 4.5, 0))
    put("pianoAQueue", (1.2, 1.0, 0), 150)
    put("frame1", (3.2, 4.97, 1.5))
    put("vase2", (3.3, 2.7, 0.43))
    put("wine_bottle", (2.75, 2.6, 0.43))
    put("glass", (2.6, 2.8, 0.43))
    put("table_lamp", (4.75, 4.6, 0.55))
    put("bedsideTable2", (4.75, 4.6, 0), height=0.55)
    put("fireplace1", (5.8, 1.6, 0), -90)
    camera((3.6, 0.25, 1.55), (2.7, 4.0, 0.85), 74)


def parlor(put):
    salon(put)
    return sky(205, 0.5, 30, 30)


def evening(put):
    salon(put)
    put("chandelier-lamp", (3.0, 2.7, 1.75), height=1.05)
    for k in range(6):
        a = math.radians(60 * k)
        bulb((3.0 + 0.33 * math.cos(a), 2.7 + 0.33 * math.sin(a), 2.2), 3, 0.02)
    bulb((4.75, 4.6, 0.55 + 0.38), 8, 0.025)
    put("living_lamp", (0.6, 1.9, 0))
    bulb((0.6, 1.9, 1.5), 14, 0.03)
    return ""


def bath(put):
    room(4.2, 3.4, 2.6, material("tiles", (0.8, 0.82, 0.82), Roughness=0.2), material("slate", (0.12, 0.12, 0.13), Roughness=0.25), material("ceiling", (0.85, 0.85, 0.85)), (2.2, 1.5, 0.8, 0.7))
    put("corner_bathtub", (0.85, 2.55, 0), 90)
    put("double_vanity", (2.6, 3.1, 0))
    plane("mirror", (2.6, 3.385, 1.6), (1.5, 1.0), material("mirror", (0.95, 0.95, 0.95), Metallic=1.0, Roughness=0.0), (math.pi / 2, 0, 0))
    put("showerStall", (3.7, 0.6, 0), -90)
    put("modernToilet", (3.75, 2.0, 0), -90)
    put("radiatorAndTowels", (4.15, 1.4, 0.6), -90)
    put("com_bath2_soap", (2.3, 3.05, 0.86))
    put("towel", (3.1, 3.05, 0.86))
    put("plant", (2.1, 3.2, 0.0), height=0.9)
    put("bathmat", (1.4, 1.6, 0.005))
    for x in (1.1, 2.1, 3.1):
        for y in (0.9, 2.5):
            panel((x, y, 2.595), (0.09, 0.09), 5)
    camera((1.1, 0.25, 1.5), (2.9, 2.9, 0.95), 78)
    return sky(180, 0.3, 30, 0)


def kitchen(put):
    room(6.5, 4.2, 2.7, material("wall", (0.78, 0.76, 0.72)), material("stone", (0.3, 0.28, 0.26), Roughness=0.15), material("ceiling", (0.85, 0.85, 0.85)), (2.4, 1.05, 1.6, 1.1))
    put("kitchenIsland", (3.0, 2.2, 0))
    for k, name in enumerate(("kitchenLowerCabinet", "largeStove", "kitchenDrawersCabinet", "kitchenSink", "kitchenLowerCabinet")):
        put(name, (1.6 + 0.75 * k, 3.85, 0))
    for k in range(4):
        put("kitchenGlassDoorCabinet", (1.4 + 0.62 * k + (0.9 if k > 1 else 0), 4.0, 1.5))
    put("refrigerator", (5.6, 3.8, 0))
    for k, name in enumerate(("kitchenaid", "kitchenblender", "espressokettle", "toaster", "utensilsPot")):
        put(name, (1.35 + 0.66 * k, 3.8, 0.93))
    for k, name in enumerate(("apples", "beer_bottle", "cocktailGlass", "choppingBoard", "coffeePress", "bowlWithFruits")):
        put(name, (2.3 + 0.28 * k, 2.1 + 0.15 * (k % 2), 0.93))
    for x in (2.4, 3.0, 3.6):
        put("hangingLight", (x, 2.2, 1.7), height=0.95)
        bulb((x, 2.2, 1.82), 6, 0.03)
        put("bar-stool", (x, 1.5, 0), 180)
    camera((5.6, 0.4, 1.6), (2.4, 3.0, 1.0), 72)
    return sky(195, 0.45, 30, 30)


def drive(put):
    plane("ground", (0, 0, 0), (80, 80), material("lawn", (0.12, 0.2, 0.06)))
    box("road", (0, 2.0, 0.005), (6.0, 16, 0.02), material("asphalt", (0.09, 0.09, 0.095)))
    box("house", (0, 12.5, 2.0), (12, 5, 4), material("plaster", (0.72, 0.66, 0.55)))
    put("garage-door", (0, 9.97, 0))
    put("exterior-door-01", (3.4, 9.97, 0))
    put("VW-new-beetle", (-1.3, 3.2, 0.02), 20)
    put("concept-sedan-02", (1.5, 5.6, 0.02), 0)
    put("japaneseMaple", (-4.6, 7.0, 0))
    put("sycamoreMaple", (6.0, 9.0, 0))
    put("pine", (-7.5, 11.0, 0))
    for k in range(4):
        put("hedge", (-4.2, -1.0 + 1.6 * k, 0), 90)
    put("bush", (4.2, 5.5, 0))
    put("fire-hydrant", (3.5, 1.0, 0))
    put("painted-bench", (5.4, 4.4, 0))
    put("classic-lamppost", (3.6, 3.0, 0))
    put("male-01-suit", (2.9, 2.2, 0), -30)
    put("motorbike", (-2.9, 0.6, 0), 60)
    camera((1.9, -4.2, 1.6), (-0.2, 5.0, 1.2), 62)
    return sky(-140, 0.75, 1, 1)


def nursery(put):
    room(4.6, 4.0, 2.6, material("wall", (0.62, 0.74, 0.78)), material("carpet", (0.5, 0.42, 0.36), Roughness=1.0), material("ceiling", (0.88, 0.88, 0.88)), (2.2, 0.6, 1.6, 1.7))
    put("curtain", (0.1, 2.2, 0.3), 90)
    put("children_bed", (3.6, 3.1, 0))
    put("doll-house", (0.7, 3.6, 0), height=0.8)
    put("teddyBear", (2.1, 2.7, 0))
    put("toyTrain", (1.6, 1.9, 0))
    put("xylophone", (2.4, 1.9, 0), 30)
    put("kids_desk_table", (2.0, 3.65, 0))
    put("kids_desk_chair", (2.0, 3.0, 0), 180)
    put("kids_shelves", (4.4, 1.4, 0), -90)
    put("babyRockingBed", (3.4, 1.5, 0), 20)
    put("caballito", (1.0, 2.8, 0), 40)
    put("spider_plant", (0.4, 1.0, 0.0), height=0.7)
    put("clock", (2.4, 3.97, 1.8))
    camera((3.9, 0.3, 1.5), (1.7, 3.2, 0.6), 70)
    return sky(180, 0.5, 30, 0)


def club(put):
    room(8.0, 6.0, 3.2, material("brick", (0.28, 0.12, 0.09)), material("parquet", (0.16, 0.08, 0.04), Roughness=0.2), material("ceiling", (0.06, 0.06, 0.065)))
    put("poolTable", (3.2, 3.0, 0))
    for x in (2.5, 3.2, 3.9):
        put("hanging-restaurant-light", (x, 3.0, 1.7), height=1.5)
        bulb((x, 3.0, 1.78), 5, 0.03)
    put("L_shaped_sofa", (6.6, 4.8, 0), -90)
    put("electricGuitar", (7.6, 3.2, 0), -90)
    put("piano", (0.5, 4.6, 0), 90)
    put("table_football", (6.3, 1.9, 0), 15)
    put("bar_table", (1.0, 2.0, 0))
    for k in range(6):
        put(("beer_bottle", "cocktailGlass", "wine_bottle")[k % 3], (0.8 + 0.1 * k, 1.9 + 0.12 * (k % 2), 1.05 if k else 1.05))
    put("lantern", (0.5, 4.6, 1.25))
    for k in range(6):
        put("wallLight", (1.0 + 1.2 * k, 5.97, 1.7))
        bulb((1.0 + 1.2 * k, 5.85, 2.15), 2, 0.02, (1.0, 0.6, 0.3))
    for k, color in enumerate(((1, 0.1, 0.2), (0.1, 0.3, 1), (0.2, 1, 0.3), (1, 0.6, 0.1))):
        box(f"neon{k}", (7.985, 1.0 + 0.9 * k, 2.3), (0.01, 0.6, 0.03), glow(f"neon{k}", color, 40))
    camera((5.6, 0.4, 1.65), (3.0, 4.2, 0.9), 74)
    return ""


SCENES = {f.__name__: f for f in (parlor, evening, bath, kitchen, drive, nursery, club)}

def main():
    catalog_root, out, program = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    out.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[4:] or SCENES:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        catalog = Catalog(catalog_root, out / "models")
        emitters = SCENES[name](catalog.put)
        file = out / f"{name}.glb"
        bpy.ops.export_scene.gltf(filepath=str(file), export_cameras=True, export_lights=True, export_apply=True)
        folder = out / name
        folder.mkdir(exist_ok=True)
        subprocess.run([program, "convert", str(file), str(folder / "scene.xml")], check=True)
        xml = folder / "scene.xml"
        # convert adds a white environment where the file has no light.
        text = re.sub(r'\s*<emitter type="constant".*?</emitter>', "", xml.read_text(), flags=re.DOTALL)
        xml.write_text(text.replace("</scene>", emitters + "</scene>"))


if __name__ == "__main__":
    main()
