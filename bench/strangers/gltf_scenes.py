"""Small glTF scenes, one for each feature: a ball or another shape on a floor under a panel lamp.

Used by gltf_feature_by_feature.py. `write_scenes(folder)` writes NAME.gltf for every feature and returns the names.
"""
import base64
import json
import math

import numpy as np
from PIL import Image


def ball(rings=48, sectors=96, radius=0.7, center=(0, 0.7, 0)):
    """Positions, normals, uvs and triangles of a sphere; v runs down from the pole, as glTF has it."""
    positions, normals, uvs, triangles = [], [], [], []
    for i in range(rings + 1):
        for j in range(sectors + 1):
            theta, phi = math.pi * i / rings, 2 * math.pi * j / sectors
            n = (math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi))
            normals.append(n)
            positions.append([c + radius * x for c, x in zip(center, n)])
            uvs.append((j / sectors, i / rings))
            if i < rings and j < sectors:
                a = i * (sectors + 1) + j
                triangles += [(a, a + sectors + 1, a + sectors + 2), (a, a + sectors + 2, a + 1)]
    return positions, normals, uvs, triangles


def sheet(corner, u, v, n=1):
    """A rectangle of n×n cells facing u × v; its uv (0, 0) is at `corner` + v, the upper left."""
    corner, u, v = (np.array(x, float) for x in (corner, u, v))
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    grid = [(i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
    triangles = [t for j in range(n) for i in range(n) for a in [j * (n + 1) + i] for t in ((a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1))]
    return [corner + a * u + b * v for a, b in grid], [normal] * len(grid), [(a, 1 - b) for a, b in grid], triangles


class File:
    """A glTF file that grows: meshes, materials, lamps; everything embedded but the pictures."""

    def __init__(self):
        self.bytes = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "cameras": []}

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def accessor(self, values, kind, component=5126, normalized=False):
        values = np.asarray(values, {5126: np.float32, 5125: np.uint32, 5121: np.uint8, 5123: np.uint16}[component])
        data = values.tobytes()
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data + b"\0" * (-len(data) % 4)
        out = {"bufferView": view, "componentType": component, "count": len(values), "type": kind}
        if normalized:
            out["normalized"] = True
        if kind == "VEC3" and component == 5126:
            out.update(min=values.min(0).tolist(), max=values.max(0).tolist())
        return self.add("accessors", out)

    def mesh(self, geometry, material, colors=None, **node):
        positions, normals, uvs, triangles = geometry
        attributes = {"POSITION": self.accessor(positions, "VEC3"), "NORMAL": self.accessor(normals, "VEC3"), "TEXCOORD_0": self.accessor(uvs, "VEC2")}
        if colors is not None:
            attributes["COLOR_0"] = self.accessor(colors, "VEC4")
        primitive = {"attributes": attributes, "indices": self.accessor(np.ravel(triangles), "SCALAR", 5125), "material": self.add("materials", material)}
        return self.node(mesh=self.add("meshes", {"primitives": [primitive]}), **node)

    def node(self, **what):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", what))
        return self.json["nodes"][-1]

    def texture(self, file, sampler=None, **info):
        image = self.add("images", {"uri": file})
        texture = {"source": image}
        if sampler:
            texture["sampler"] = self.add("samplers", sampler)
        return {"index": self.add("textures", texture), **info}

    def lamp(self, rotation=(0, 0, 0, 1), translation=(0, 0, 0), **light):
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        self.node(rotation=list(rotation), translation=list(translation), extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def save(self, path):
        used = sorted({key for object_ in walk(self.json) for key in object_.get("extensions", {})})
        out = dict(self.json, buffers=[{"byteLength": len(self.bytes), "uri": "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()}])
        if used:
            out["extensionsUsed"] = used
        path.write_text(json.dumps({k: v for k, v in out.items() if v != []}))


def walk(value):
    if isinstance(value, dict):
        yield value
        for inner in value.values():
            yield from walk(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from walk(inner)


def about_x(degrees):
    return (math.sin(math.radians(degrees) / 2), 0, 0, math.cos(math.radians(degrees) / 2))


def pbr(base=(0.8, 0.8, 0.8), metallic=0.0, roughness=0.5, **more):
    return {"baseColorFactor": [*base, more.pop("alpha", 1)], "metallicFactor": metallic, "roughnessFactor": roughness, **more}


def material(inner=None, extensions=None, **more):
    out = {"pbrMetallicRoughness": inner or pbr(), **more}
    if extensions:
        out["extensions"] = {"KHR_materials_" + k: v for k, v in extensions.items()}
    return out


def write_pictures(folder):
    rng = np.random.default_rng(1)
    save = lambda name, values: Image.fromarray((np.clip(values, 0, 1) * 255).astype(np.uint8)).save(folder / name)
    save("colors.png", rng.random((16, 16, 3)))
    save("holes.png", np.concatenate([np.full((16, 16, 3), 0.6), np.kron(rng.random((8, 8, 1)) > 0.5, np.ones((2, 2, 1)))], 2))
    save("half.png", np.concatenate([np.full((16, 16, 3), 0.6), np.kron(rng.random((8, 8, 1)), np.ones((2, 2, 1)))], 2))
    save("orm.png", np.kron(rng.random((4, 4, 3)), np.ones((8, 8, 1))))
    y, x = np.mgrid[0:128, 0:128] / 128 * 2 * math.pi * 4
    n = np.stack([-0.4 * np.cos(x) * np.sin(y), 0.4 * np.sin(x) * np.cos(y), np.ones_like(x)], 2)
    save("normals.png", n / np.linalg.norm(n, axis=2, keepdims=True) / 2 + 0.5)


def base_scene(of_ball=None, floor=None, panel=True, shape=None, colors=None):
    f = File()
    f.json["cameras"].append({"type": "perspective", "perspective": {"yfov": math.radians(28), "aspectRatio": 1.5, "znear": 0.01}})
    # From (0.6, 1.8, 4) towards (0, 0.6, 0).
    back = np.array([0.6, 1.2, 4.0]) / np.linalg.norm([0.6, 1.2, 4.0])
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(back, right), back, (0.6, 1.8, 4)
    f.node(camera=0, matrix=matrix.T.ravel().tolist(), name="camera")
    f.mesh(sheet((-4, 0, 4), (8, 0, 0), (0, 0, -8)), floor or material(pbr((0.4, 0.5, 0.3), roughness=1)))
    if of_ball is not False:
        f.mesh(shape or ball(), of_ball or material(), colors)
    if panel:
        f.mesh(sheet((0, 2.5, 0.3), (1, 0, 0), (0, 0, 1)), material(pbr((0, 0, 0), roughness=1), {"emissive_strength": {"emissiveStrength": 12}}, emissiveFactor=[1, 0.92, 0.75]))
    return f


def build():
    """File of every scene, by name."""
    out = {}
    red, gold = (0.7, 0.3, 0.2), (1, 0.77, 0.34)
    for roughness in (0.1, 0.3, 0.6, 1):
        out[f"plastic-{roughness}"] = base_scene(material(pbr(red, 0, roughness)))
        out[f"metal-{roughness}"] = base_scene(material(pbr(gold, 1, roughness)))
    out["half-metal"] = base_scene(material(pbr(red, 0.5, 0.3)))
    out["specular-0"] = base_scene(material(pbr(red), {"specular": {"specularFactor": 0}}))
    out["specular-tint"] = base_scene(material(pbr(red, 0, 0.2), {"specular": {"specularColorFactor": [0.2, 1, 0.4]}}))
    out["ior-1.9"] = base_scene(material(pbr(red, 0, 0.2), {"ior": {"ior": 1.9}}))
    out["clearcoat"] = base_scene(material(pbr(red, 0.6, 0.5), {"clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1}}))
    out["sheen"] = base_scene(material(pbr((0.1, 0.1, 0.3), 0, 0.9), {"sheen": {"sheenColorFactor": [0.8, 0.7, 0.5], "sheenRoughnessFactor": 0.4}}))
    out["anisotropy"] = base_scene(material(pbr(gold, 1, 0.4), {"anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": 0.6}}))
    out["iridescence"] = base_scene(material(pbr((0.5, 0.5, 0.5), 1, 0.2), {"iridescence": {"iridescenceFactor": 1, "iridescenceThicknessMaximum": 400}}))
    out["glass-solid"] = base_scene(material(pbr((1, 1, 1), 0, 0), {"transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 1}}))
    out["glass-rough"] = base_scene(material(pbr((1, 1, 1), 0, 0.4), {"transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 1}}))
    out["glass-tinted"] = base_scene(material(pbr((1, 1, 1), 0, 0), {"transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [0.2, 0.7, 0.5]}}))
    out["sheet-frosted"] = base_scene(material(pbr((1, 1, 1), 0, 0.4), {"transmission": {"transmissionFactor": 1}}))
    out["glass-half"] = base_scene(material(pbr(red, 0, 0.1), {"transmission": {"transmissionFactor": 0.5}, "volume": {"thicknessFactor": 1}}))
    out["diffuse-transmission"] = base_scene(material(pbr((0.3, 0.6, 0.2), 0, 0.8), {"diffuse_transmission": {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [0.8, 0.9, 0.2]}}, doubleSided=True), shape=sheet((-0.8, 0.1, 0), (1.6, 0, 0), (0, 1.4, -0.3)))
    out["specular-glossiness"] = base_scene({"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.2, 0.1, 1], "specularFactor": [0.3, 0.3, 0.2], "glossinessFactor": 0.7}}})
    out["unlit"] = base_scene(material(pbr(red), {"unlit": {}}))
    for name, options in {"mask": {"alphaMode": "MASK"}, "blend": {"alphaMode": "BLEND"}, "opaque": {}}.items():
        f = base_scene(False)
        f.mesh(ball(), material({"baseColorTexture": f.texture("half.png"), "metallicFactor": 0}, **options))
        out["alpha-" + name] = f
    out["alpha-factor"] = base_scene(material(pbr(red, alpha=0.4), alphaMode="BLEND"))
    for name, transform in {"plain": {}, "moved": {"offset": [0.1, 0.3], "scale": [3, 2], "rotation": 0.5}}.items():
        f = base_scene(False)
        f.mesh(ball(), material({"baseColorTexture": f.texture("colors.png", {"magFilter": 9729}, **({"extensions": {"KHR_texture_transform": transform}} if transform else {})), "metallicFactor": 0}))
        out["texture-" + name] = f
    f = base_scene(False)
    f.mesh(ball(), material({"metallicRoughnessTexture": f.texture("orm.png"), "baseColorFactor": [*gold, 1]}, occlusionTexture=f.texture("orm.png")))
    out["orm"] = f
    for name, scale in {"normal-map": 1, "normal-map-strong": 2}.items():
        f = base_scene(False)
        f.mesh(ball(), material(pbr(red, 0, 0.4), normalTexture=f.texture("normals.png", scale=scale)))
        out[name] = f
    f = base_scene(False)
    f.mesh(sheet((-0.8, 0.1, 0), (1.6, 0, 0), (0, 1.4, -0.3)), material(pbr(red, 0, 0.4), normalTexture=f.texture("normals.png")))
    out["normal-map-flat"] = f
    f = base_scene(False, panel=False)
    f.mesh(ball(), material(pbr((0, 0, 0), 0, 1), {"emissive_strength": {"emissiveStrength": 5}}, emissiveFactor=[1, 0.9, 0.8], emissiveTexture=f.texture("colors.png")))
    out["emission-texture"] = f
    for name, flipped in {"emission-front": False, "emission-back": True}.items():
        f = base_scene(panel=False)
        u, v = ((1, 0, 0), (0, 0, 1)) if not flipped else ((0, 0, 1), (1, 0, 0))
        f.mesh(sheet((0, 2.5, 0.3), u, v), material(pbr((0, 0, 0), roughness=1), {"emissive_strength": {"emissiveStrength": 12}}, emissiveFactor=[1, 0.92, 0.75], doubleSided=True))
        out[name] = f
    g = ball()
    out["vertex-colors"] = base_scene(material(pbr((1, 1, 1))), shape=g, colors=[(0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5, 1) for n in g[1]])
    for name, light in {"point": dict(type="point", translation=(1, 2, 1), color=[1, 0.9, 0.7], intensity=6),
                        "spot": dict(type="spot", translation=(0.3, 3, 0.5), rotation=about_x(-90), intensity=20, spot={"innerConeAngle": 0.2, "outerConeAngle": 0.5}),
                        "sun": dict(type="directional", rotation=about_x(-60), intensity=2)}.items():
        f = base_scene(panel=False)
        f.lamp(**light)
        out[name] = f
    f = base_scene(False)
    f.mesh(ball(center=(0, 0, 0), radius=0.4), material(pbr(red)))
    f.json["nodes"][-1].update(translation=[-0.4, 0.6, 0], rotation=list(about_x(30)), scale=[1.5, 0.6, 1])
    f.node(mesh=f.json["nodes"][-1]["mesh"], translation=[0.5, 0.5, 0.4], scale=[-1, 1, 1])
    out["instances"] = f
    f = base_scene(False)
    f.mesh(ball(center=(0, 0, 0), radius=0.25), material(pbr(red)))
    places = [(-0.6, 0.3, 0), (0, 0.5, -0.2), (0.6, 0.3, 0.3)]
    f.json["nodes"][-1]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": f.accessor(places, "VEC3"), "SCALE": f.accessor([(1, 1, 1), (1.5, 1, 1), (1, 1.2, 1)], "VEC3")}}}
    out["gpu-instances"] = f
    f = base_scene()
    f.json["cameras"][0] = {"type": "orthographic", "orthographic": {"xmag": 1.8, "ymag": 1.2, "znear": 0.01, "zfar": 100}}
    out["orthographic"] = f
    return out


def write_scenes(folder):
    folder.mkdir(parents=True, exist_ok=True)
    write_pictures(folder)
    scenes = build()
    for name, file in scenes.items():
        file.save(folder / f"{name}.gltf")
    return list(scenes)
