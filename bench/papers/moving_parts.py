"""Scenes that move, for make_animated_scenes.py: Mitsuba XML with <animation> and numbered meshes, and a small writer of animated glTF. Only the standard library."""
import json
import math
import struct

from scene_parts import Mesh, Scene, text


def look(origin, target):
    return f'<lookat origin="{text(origin)}" target="{text(target)}" up="0, 1, 0"/>'


def translated(p):
    return f'<translate value="{text(p)}"/>'


def turned(degrees, axis=(0, 1, 0)):
    return f'<rotate x="{axis[0]:g}" y="{axis[1]:g}" z="{axis[2]:g}" angle="{degrees:.6g}"/>'


class Clock:
    """Moments of a shot. Functions of motion take s from 0 (the first frame) to 1 (the last one)."""

    def __init__(self, frames, rate=24):
        self.frames, self.rate = frames, rate

    def seconds(self, s):
        return s * (self.frames - 1) / self.rate

    def animation(self, at, keys):
        """`at(s)`: a transform's XML. Between `keys` evenly spaced keys the program interpolates, turns spherically."""
        moments = [k / (keys - 1) for k in range(keys)]
        return '<animation name="to_world">' + "".join(f'<transform time="{self.seconds(s):.12g}">{at(s)}</transform>' for s in moments) + "</animation>"


class MovingScene(Scene):
    """A Scene whose camera, shapes and lamps may move; times are those of its clock."""

    def __init__(self, comment, clock, camera, fov, film):
        """camera(s): (origin, target)."""
        super().__init__(comment, camera(0), fov, film)
        self.clock, self.files, self.placed = clock, {}, 0
        still = next(k for k, line in enumerate(self.lines) if "<lookat" in line)
        if any(camera(s) != camera(0) for s in (0.1, 0.5, 1)):
            self.lines[still] = "\t\t" + clock.animation(lambda s: look(*camera(s)), 13)

    def moving(self, material, at, keys=13, name=None):
        """A mesh of a material that exists, carried by the transform at(s)."""
        name = name or f"moving{len(self.files)}"
        self.files[name] = [Mesh()]
        self.emitters.append(f'<shape type="ply" id="{name}"><string name="filename" value="{name}.ply"/>' + self.clock.animation(at, keys) +
                             f'<ref id="{material}"/></shape>')
        return self.files[name][0]

    def sequence(self, material, name, mesh_at):
        """A mesh for every frame, in numbered files; mesh_at(s)."""
        self.files[name] = [mesh_at(k / (self.clock.frames - 1)) for k in range(self.clock.frames)]
        self.emitters.append(f'<shape type="ply" id="{name}"><string name="filename" value="{name}.####.ply"/><ref id="{material}"/></shape>')

    def group(self, name, meshes):
        """What instances repeat; meshes: {material: mesh}."""
        shapes = ""
        for material, mesh in meshes.items():
            self.files[f"{name}_{material}"] = [mesh]
            shapes += f'<shape type="ply"><string name="filename" value="{name}_{material}.ply"/><ref id="{material}"/></shape>'
        self.lines.append(f'\t<shape type="shapegroup" id="{name}">{shapes}</shape>')
        return sum(len(m.triangles) for m in meshes.values())

    def instance(self, group, place):
        """`place`: a transform's XML."""
        self.emitters.append(f'<shape type="instance"><transform name="to_world">{place}</transform><ref id="{group}"/></shape>')

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        total = 0
        for name, meshes in self.files.items():
            for k, mesh in enumerate(meshes):
                mesh.write(folder / (f"{name}.{k:04d}.ply" if len(meshes) > 1 else f"{name}.ply"))
            total += len(meshes[0].triangles)
        return total + super().write(folder)


class Gltf:
    """A .glb: meshes with one material each, nodes, lamps and one animation."""

    def __init__(self, clock):
        self.clock, self.bytes = clock, b""
        self.root = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
                     "bufferViews": [], "cameras": [], "extensions": {"KHR_lights_punctual": {"lights": []}},
                     "extensionsUsed": ["KHR_lights_punctual", "KHR_animation_pointer", "KHR_materials_emissive_strength"],
                     "animations": [{"name": "shot", "samplers": [], "channels": []}]}
        self.triangles = 0

    def accessor(self, kind, values, code="f", bounds=False):
        components = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[kind]
        body = struct.pack(f"<{len(values)}{code}", *values)
        self.root["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(body)})
        self.bytes += body
        made = {"bufferView": len(self.root["bufferViews"]) - 1, "componentType": 5126 if code == "f" else 5125, "count": len(values) // components, "type": kind}
        if bounds:
            stored = struct.unpack(f"<{len(values)}{code}", body)
            made["min"] = [min(stored[c::components]) for c in range(components)]
            made["max"] = [max(stored[c::components]) for c in range(components)]
        self.root["accessors"].append(made)
        return len(self.root["accessors"]) - 1

    def material(self, name, color, roughness=0.9, metallic=0.0, emissive=None, strength=1.0):
        made = {"name": name, "doubleSided": emissive is None,
                "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "roughnessFactor": roughness, "metallicFactor": metallic}}
        if emissive:
            made |= {"emissiveFactor": list(emissive), "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}}
        self.root["materials"].append(made)
        return len(self.root["materials"]) - 1

    def mesh(self, mesh, material, name, translation=None):
        flat = [[c for v in mesh.vertices for c in v[a:b]] for a, b in ((0, 3), (3, 6), (6, 8))]
        primitive = {"attributes": {"POSITION": self.accessor("VEC3", flat[0], bounds=True), "NORMAL": self.accessor("VEC3", flat[1]),
                                    "TEXCOORD_0": self.accessor("VEC2", flat[2])},
                     "indices": self.accessor("SCALAR", [i for t in mesh.triangles for i in t], "I"), "material": material}
        self.triangles += len(mesh.triangles)
        self.root["meshes"].append({"name": name, "primitives": [primitive]})
        return self.node({"mesh": len(self.root["meshes"]) - 1, "name": name} | ({"translation": list(translation)} if translation else {}))

    def node(self, fields):
        self.root["nodes"].append(fields)
        self.root["scenes"][0]["nodes"].append(len(self.root["nodes"]) - 1)
        return len(self.root["nodes"]) - 1

    def camera(self, origin, yaw, pitch, fov, aspect):
        """Degrees; yaw 0 looks along -z, positive to the left; pitch positive upwards."""
        self.root["cameras"].append({"type": "perspective", "perspective": {"yfov": math.radians(fov), "znear": 0.01, "aspectRatio": aspect}})
        return self.node({"camera": 0, "translation": list(origin), "rotation": list(quaternion(yaw, pitch))})

    def lamp(self, fields, node):
        lights = self.root["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append(fields)
        return self.node(node | {"extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})

    def animate(self, target, kind, at, keys, interpolation="LINEAR"):
        """`target`: (node, path) or a JSON pointer; at(s): numbers."""
        moments = [k / (keys - 1) for k in range(keys)]
        values = [c for s in moments for c in at(s)]
        shot = self.root["animations"][0]
        shot["samplers"].append({"input": self.accessor("SCALAR", [self.clock.seconds(s) for s in moments], bounds=True), "output": self.accessor(kind, values),
                                 "interpolation": interpolation})
        if isinstance(target, str):
            where = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": target}}}
        else:
            where = {"node": target[0], "path": target[1]}
        shot["channels"].append({"sampler": len(shot["samplers"]) - 1, "target": where})

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        self.root["buffers"] = [{"byteLength": len(self.bytes)}]
        head = json.dumps(self.root, separators=(",", ":")).encode()
        head += b" " * (-len(head) % 4)
        body = self.bytes + b"\0" * (-len(self.bytes) % 4)
        (folder / "scene.glb").write_bytes(struct.pack("<4s2I", b"glTF", 2, 28 + len(head) + len(body)) + struct.pack("<I4s", len(head), b"JSON") + head +
                                           struct.pack("<I4s", len(body), b"BIN\0") + body)
        return self.triangles


def quaternion(yaw, pitch):
    """Turned up by `pitch`, then left by `yaw`, degrees."""
    y, p = math.radians(yaw) / 2, math.radians(pitch) / 2
    return (math.cos(y) * math.sin(p), math.sin(y) * math.cos(p), -math.sin(y) * math.sin(p), math.cos(y) * math.cos(p))
