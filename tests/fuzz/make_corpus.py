#!/usr/bin/env python3
"""Writes the seed corpora of the fuzz targets: small good files that reach every branch of the readers once."""
import base64
import json
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent / "corpus"


def write(target, name, data):
    (HERE / target).mkdir(parents=True, exist_ok=True)
    (HERE / target / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def obj():
    write("obj", "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    write("obj", "full.obj", "# corners of every form\nmtllib a.mtl\no part\ng group\nusemtl m\ns 1\nv 0 0 0\nv 1 0 0 1\nv 0 1 0\n"
          "vt 0 0\nvt 1 0 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1//1 2//1 3//1\nf 1/1 2/2 3/3\nf -3 -2 \\\n-1\n")


def ply():
    head = "ply\nformat {} 1.0\ncomment seed\nelement vertex 3\n"
    xyz = "property float x\nproperty float y\nproperty float z\n"
    rest = xyz + "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\nproperty uchar red\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    write("ply", "ascii.ply", head.format("ascii") + xyz + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    for order, name in (("<", "binary_little_endian"), (">", "binary_big_endian")):
        body = b"".join(struct.pack(order + "8fB", *c, 0, 0, 1, c[0], c[1], 200) for c in corners)
        body += struct.pack(order + "B3i", 3, 0, 1, 2)
        write("ply", name + ".ply", (head.format(name) + rest + faces).encode() + body)


def mesh(version, flags, real):
    """One mesh of one triangle: the file's header and the deflated body."""
    body = struct.pack("<I", flags)
    if version == 4:
        body += b"seed\0"
    body += struct.pack("<QQ", 3, 1)
    body += struct.pack("<9" + real, 0, 0, 0, 1, 0, 0, 0, 1, 0)
    if flags & 0x1:
        body += struct.pack("<9" + real, *[0, 0, 1] * 3)
    if flags & 0x2:
        body += struct.pack("<6" + real, 0, 0, 1, 0, 0, 1)
    if flags & 0x8:
        body += struct.pack("<9" + real, *[0.5] * 9)
    body += struct.pack("<3I", 0, 1, 2)
    return struct.pack("<HH", 0x041C, version) + zlib.compress(body)


def serialized():
    files = {
        "single.serialized": (4, [mesh(4, 0x1000, "f")]),
        "double.serialized": (4, [mesh(4, 0x2000 | 0x1 | 0x2 | 0x8, "d")]),
        "version3.serialized": (3, [mesh(3, 0x1000 | 0x2, "f")]),
        "three.serialized": (4, [mesh(4, 0x1000 | 0x10, "f"), mesh(4, 0x1000, "f"), mesh(4, 0x2000, "d")]),
    }
    for name, (version, meshes) in files.items():
        offsets, at = [], 0
        for m in meshes:
            offsets.append(at)
            at += len(m)
        table = struct.pack("<%d%s" % (len(meshes), "Q" if version == 4 else "I"), *offsets)
        # The target takes the mesh's index from the size of the file, modulo 3.
        padding = b"\0" * (-(at + len(table) + 4) % 3 if len(meshes) == 1 else 0)
        data = b"".join(meshes) + padding + table + struct.pack("<I", len(meshes))
        write("serialized", name, data)


SCENES = {
    "modern.xml": """<scene version="3.0.0">
<default name="w" value="8"/>
<integrator type="path"><integer name="max_depth" value="5"/></integrator>
<sensor type="perspective" id="eye"><float name="fov" value="45"/><string name="fov_axis" value="x"/>
<transform name="to_world"><lookat origin="0,1,5" target="0 1 0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="$w"/><integer name="height" value="6"/><rfilter type="gaussian"/></film>
<sampler type="independent"><integer name="sample_count" value="4"/></sampler></sensor>
<bsdf type="twosided" id="b"><bsdf type="diffuse"><rgb name="reflectance" value="0.5 0.4 0.3"/></bsdf></bsdf>
<texture type="checkerboard" id="t"><rgb name="color0" value="0.1"/><transform name="to_uv"><scale x="4" y="4"/></transform></texture>
<bsdf type="principled" id="p"><ref name="base_color" id="t"/><float name="roughness" value="0.3"/></bsdf>
<bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="roughconductor"><string name="material" value="Au"/></bsdf></bsdf>
<shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="0.5"/><ref id="b"/></shape>
<shape type="cube"><transform name="to_world"><rotate y="1" angle="30"/><translate value="1,2,3"/></transform>
<bsdf type="roughdielectric"><float name="alpha" value="0.2"/><string name="int_ior" value="bk7"/></bsdf></shape>
<shape type="rectangle"><emitter type="area"><spectrum name="radiance" value="400:1, 500:2, 700:3"/></emitter></shape>
<emitter type="constant"><rgb name="radiance" value="#ff8000"/></emitter>
</scene>
""",
    "older.xml": """<?xml version="1.0" encoding="utf-8"?>
<scene version="0.6.0">
<sensor type="thinlens"><string name="fovAxis" value="smaller"/><float name="fov" value="50"/><float name="apertureRadius" value="0.1"/>
<float name="focusDistance" value="3"/><transform name="toWorld"><matrix value="1 0 0 0 0 1 0 0 0 0 1 4 0 0 0 1"/></transform>
<film type="ldrfilm"><integer name="width" value="4"/><integer name="height" value="4"/><boolean name="banner" value="false"/></film></sensor>
<shape type="shapegroup" id="g"><shape type="cylinder"><float name="radius" value="0.2"/><bsdf type="phong"><float name="exponent" value="30"/></bsdf></shape></shape>
<shape type="instance"><ref id="g"/><transform name="toWorld"><translate x="1"/></transform></shape>
<shape type="disk"><bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="ward"/><bsdf type="plastic"><srgb name="diffuseReflectance" value="#336699"/></bsdf></bsdf>
<emitter type="area"><blackbody name="radiance" temperature="5000K"/></emitter></shape>
<emitter type="sunsky"><float name="turbidity" value="3"/><vector name="sunDirection" x="0" y="1" z="0.5"/></emitter>
<emitter type="spot"><spectrum name="intensity" value="2"/><float name="cutoffAngle" value="20"/></emitter>
<emitter type="point"><point name="position" x="0" y="2" z="0"/></emitter>
<emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/></emitter>
</scene>
""",
}


def ies():
    for path in sorted((HERE.parent.parent / "data" / "ies").glob("*.ies")):
        write("ies", path.name, path.read_bytes())


def brdf():
    def tensors(**fields):
        size = 18 + sum(13 + len(name) + 8 * len(shape) for name, (shape, _) in fields.items())
        head, body = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
        for name, (shape, values) in fields.items():
            byte = name == "jacobian"
            head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), 1 if byte else 10, size + len(body))
            head += struct.pack(f"<{len(shape)}Q", *shape)
            body += bytes(values) if byte else struct.pack(f"<{len(values)}f", *values)
        return head + body

    for name, phi in (("isotropic", [0]), ("anisotropic", [-3.14159265, -1.5, 0])):
        n = len(phi)
        write("brdf", name + ".bsdf", tensors(
            phi_i=([n], phi), theta_i=([2], [0, 1.5]), jacobian=([1], [1]), ndf=([2, 2], [1, 2, 3, 1]), sigma=([2, 2], [1] * 4),
            vndf=([n, 2, 2, 2], [1, 2, 3, 4] * 2 * n), wavelengths=([3], [400, 500, 700]), spectra=([n, 2, 3, 2, 2], [0.1, 0.2, 0.3, 0.4] * 6 * n)))
    write("brdf", "rgb.bsdf", tensors(
        phi_i=([1], [0]), theta_i=([2], [0, 1.5]), jacobian=([1], [0]), ndf=([2, 2], [1] * 4), sigma=([2, 2], [1] * 4), vndf=([1, 2, 2, 2], [1] * 8),
        rgb=([1, 2, 3, 2, 2], [0.5] * 24)))
    write("brdf", "merl.binary", struct.pack("<3i", 2, 2, 2) + struct.pack("<24d", *[100.0] * 24))


def gltf():
    corners = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)

    def scene(data=corners):
        return {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
            "buffers": [{"byteLength": len(data),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}

    def write_json(name, content):
        write("gltf", name, json.dumps(content) + "\n")

    write_json("plain.gltf", scene())
    binary = scene()
    del binary["buffers"][0]["uri"]
    text = json.dumps(binary).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(corners)) + b"BIN\0" + corners
    write("gltf", "plain.glb", b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)

    rich = scene()
    rich["materials"] = [
        {"name": "m", "doubleSided": True, "alphaMode": "MASK", "alphaCutoff": 0.4, "emissiveFactor": [1, 0.5, 0],
         "normalTexture": {"index": 0, "scale": 0.5, "texCoord": 1},
         "pbrMetallicRoughness": {
             "baseColorFactor": [1, 0.5, 0.2, 0.9], "metallicFactor": 0.5, "roughnessFactor": 0.3,
             "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {
                 "offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 3], "texCoord": 0}}},
             "metallicRoughnessTexture": {"index": 0}},
         "extensions": {
             "KHR_materials_ior": {"ior": 1.4},
             "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 1, 0.5]},
             "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.1},
             "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3]},
             "KHR_materials_transmission": {"transmissionFactor": 0.2},
             "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2},
             "KHR_materials_emissive_strength": {"emissiveStrength": 3}}},
        {"extensions": {"KHR_materials_unlit": {}}}]
    rich["textures"] = [{"source": 0, "sampler": 0}]
    rich["samplers"] = [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]
    rich["images"] = [{"bufferView": 1, "mimeType": "image/png"}]
    rich["accessors"][0]["sparse"] = {"count": 1, "indices": {"bufferView": 1, "componentType": 5121},
                                      "values": {"bufferView": 0}}
    rich["accessors"].append({"bufferView": 0, "componentType": 5121, "normalized": True, "count": 4, "type": "VEC4"})
    rich["meshes"][0]["weights"] = [0.5]
    rich["meshes"][0]["primitives"][0].update(material=0, targets=[{"POSITION": 0}])
    rich["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0, "COLOR_0": 2}, "mode": 5, "material": 1})
    rich["nodes"] = [{"mesh": 0, "children": [1, 2], "rotation": [0, 0, 0.7, 0.7], "scale": [1, 2, 3]},
                     {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]},
                     {"extensions": {"KHR_lights_punctual": {"light": 0}}}]
    rich["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 1.5}},
                       {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 10}}]
    rich["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 3, "range": 10, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}}]}}
    rich["animations"], rich["extensionsUsed"] = [{}], ["EXT_unheard_of", "KHR_materials_ior"]
    write_json("rich.gltf", rich)

    skin = scene(corners + bytes(16) + struct.pack("<16f", 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
                 + bytes([255, 0, 0, 0] * 4))
    skin["nodes"] = [{"mesh": 0, "skin": 0}, {"translation": [0, 1, 0]}]
    skin["scenes"] = [{"nodes": [0, 1]}]
    skin["skins"] = [{"joints": [1], "inverseBindMatrices": 3}]
    skin["bufferViews"] += [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in
                            ((60, 16), (76, 64), (140, 16))]
    skin["accessors"] += [{"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"},
                          {"bufferView": 3, "componentType": 5126, "count": 1, "type": "MAT4"},
                          {"bufferView": 4, "componentType": 5121, "normalized": True, "count": 4, "type": "VEC4"}]
    skin["meshes"][0]["primitives"][0]["attributes"].update(JOINTS_0=2, WEIGHTS_0=4)
    write_json("skin.gltf", skin)

    instances = scene()
    instances["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}
    write_json("instances.gltf", instances)
    packed = {"buffer": 0, "byteLength": 48, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}
    meshopt = scene()
    meshopt["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": packed}
    write_json("meshopt.gltf", meshopt)
    # Keys at 0 and 1 s; a translation, a rotation as a cubic spline of six values, an intensity by a pointer.
    moving = scene(corners + struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 1, 2, 3)
                   + struct.pack("<24f", *([0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0] * 2)) + struct.pack("<2f", 1, 0))
    moving["bufferViews"] += [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in
                              ((60, 8), (68, 24), (92, 96), (188, 8))]
    moving["accessors"] += [{"bufferView": view, "componentType": 5126, "count": count, "type": kind} for view, count, kind in
                            ((2, 2, "SCALAR"), (3, 2, "VEC3"), (4, 6, "VEC4"), (5, 2, "SCALAR"))]
    moving["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 1}]}}
    pointer = {"path": "pointer", "extensions": {"KHR_animation_pointer": {
        "pointer": "/extensions/KHR_lights_punctual/lights/0/intensity"}}}
    moving["animations"] = [{
        "name": "walk",
        "samplers": [{"input": 2, "output": 3}, {"input": 2, "output": 4, "interpolation": "CUBICSPLINE"},
                     {"input": 2, "output": 5, "interpolation": "STEP"}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}},
                     {"sampler": 1, "target": {"node": 0, "path": "rotation"}}, {"sampler": 2, "target": pointer}]}]
    write_json("moving.gltf", moving)
    draco = scene()
    draco["meshes"][0]["primitives"][0]["extensions"] = {
        "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    write_json("draco.gltf", draco)


def curves():
    # The first byte: basis (0 b-spline, 1 bezier, 2 linear), plus 4 where the radius is given from outside.
    write("curves", "bspline", "\0" + "0 0 0 .1\n1 0 0 .1\n2 1 0 .1\n3 1 0 0\n4 0 0 1e-3\n")
    write("curves", "bezier", "\1" + "0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n\n0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n")
    write("curves", "linear", "\6" + "0 0 0\n1 0 0\n\n -1 +2 3e1\r\n4 5 6")
    write("curves", "binary", b"\6BINARY_HAIR" + struct.pack("<I13f", 4, float("inf"), 0, 0, 0, 1, 0, 0, float("inf"), 0, 1, 0, 0, 2) + struct.pack("<f", 0))


def vol():
    def grid(encoding, size, channels, values):
        return b"VOL\3" + struct.pack("<5i6f", encoding, *size, channels, -1, 0, 2, 1, 4, 3) + values
    write("vol", "floats.vol", grid(1, (3, 2, 1), 1, struct.pack("<6f", *range(6))))
    write("vol", "colors.vol", grid(1, (2, 1, 1), 3, struct.pack("<6f", *range(6))))
    write("vol", "halves.vol", grid(2, (1, 1, 3), 1, struct.pack("<3e", 0.5, -2, 1e-7)))
    write("vol", "bytes.vol", grid(3, (2, 2, 1), 1, bytes([0, 1, 128, 255])))
    write("vol", "directions.vol", grid(4, (1, 1, 1), 3, bytes(2)))


def nanovdb():
    def about(kind, size, stored, name, grid_class):
        return struct.pack("<4Q2I6d6i3dI4I3I2HI", size, stored, 0, 0, kind, grid_class, *[0.0] * 6, *[0] * 6, 1, 1, 1, len(name) + 1,
                           1, 1, 1, 1, 0, 0, 0, 0, 0, 32 << 21) + name + b"\0"

    # A root with one child and a tile; a chain of nodes down to one leaf of numbers; the rest is the background, 0.
    def grid(kind, leaf, grid_class=2):
        root_size, leaf_table = (96, 128) if kind == 2 else (64, 96)
        head = bytearray(672 + 64 + root_size + 64)
        head[0:8] = b"NanoVDB0"
        struct.pack_into("<2I", head, 632, grid_class, kind)
        struct.pack_into("<9d", head, 384, .5, 0, 0, 0, .25, 0, 0, 0, 1)
        struct.pack_into("<3d", head, 528, 1, 2, 3)
        struct.pack_into("<Q", head, 672 + 24, 64)
        root = 672 + 64
        struct.pack_into("<6iI", head, root, 0, 0, 0, 7, 7, 7, 2)
        struct.pack_into("<QqI", head, root + root_size, 0, root_size + 64, 0)
        struct.pack_into("<QqI", head, root + root_size + 32, 1 << 42, 0, 1)
        upper, lower = bytearray(270400), bytearray(33856)
        upper[4128] = lower[544] = 1
        struct.pack_into("<q", upper, 8256, len(upper))
        struct.pack_into("<q", lower, 1088, len(lower))
        return bytes(head + upper + lower) + leaf.ljust(leaf_table, b"\0")[:leaf_table] + leaf[leaf_table:]

    def file(*grids):
        stored = [struct.pack("<Q", len(z)) + z for z in (zlib.compress(body, 9) for _, _, body in grids)]
        return (b"NanoVDB0" + struct.pack("<I2H", 32 << 21, len(grids), 1) +
                b"".join(about(kind, len(body), len(z), name, 2) for (name, kind, body), z in zip(grids, stored)) + b"".join(stored))

    floats = bytes(96) + struct.pack("<512f", *(k / 512 for k in range(512)))
    packed = bytes(80) + struct.pack("<2f4H", 1, .5, 0, 0, 0, 0)
    write("nanovdb", "floats.nvdb", file((b"density", 1, grid(1, floats))))
    write("nanovdb", "doubles.nvdb", file((b"density", 2, grid(2, bytes(128) + struct.pack("<512d", *range(512))))))
    write("nanovdb", "fp4.nvdb", file((b"heat", 13, grid(13, packed + bytes(range(256))))))
    bits = bytearray(packed)
    bits[15] = 1 << 5  # two for each number
    write("nanovdb", "fpn.nvdb", file((b"density", 16, grid(16, bytes(bits) + bytes(range(128)))), (b"heat", 1, grid(1, floats))))
    # Changes to files of the fuzz target: the tree refers to a root elsewhere, the root says that it has many parts, a box is large.
    for name, changes in {"root": [(896, 255)], "parts": [(960, 9), (961, 1)], "box": [(950, 127)], "none": []}.items():
        for kind in range(4):
            write("nanovdb", f"{name}_{kind}", bytes([kind]) + b"".join(struct.pack("<IB", *c) for c in changes))


def images():
    # The JPEG seeds beside these are of write_sample_jpeg in tests/film.
    def png(name, depth, color, interlace, rows, *more):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        head = struct.pack(">IIBBBBB", 3, 2, depth, color, 0, 0, interlace)
        chunks = [(b"IHDR", head), *more, (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
        write("images", name, b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*c) for c in chunks))

    png("color.png", 8, 2, 0, b"\0abcdefghi" b"\1ihgfedcba")
    png("deep_alpha.png", 16, 6, 0, (b"\0" + bytes(range(24))) * 2)
    png("palette.png", 2, 3, 0, b"\0\x1b" * 2, (b"PLTE", bytes(range(12))), (b"tRNS", b"\0\x80"))
    png("interlaced_gray.png", 8, 0, 1, b"\0a\0b\0cc\0dd\0eee", (b"gAMA", struct.pack(">I", 45455)))

    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n"
    write("images", "flat.hdr", head + b"+X 2 -Y 2\n" + bytes([9, 8, 128, 129]) * 4)
    write("images", "runs.hdr", head + b"-Y 1 +X 8\n" + bytes([2, 2, 0, 8, 136, 64, 131, 128, 5, 1, 2, 3, 4, 5, 136, 0, 136, 129]))
    write("images", "old_runs.hdr", head + b"-Y 1 +X 515\n" + bytes([64, 128, 0, 129, 1, 1, 1, 1, 1, 1, 1, 2, 128, 0, 0, 129]))


def main():
    images()
    curves()
    obj()
    ply()
    serialized()
    ies()
    brdf()
    vol()
    nanovdb()
    gltf()
    for name, text in SCENES.items():
        write("mitsuba", name, text)


main()
