#!/usr/bin/env python3
"""Fails if a file includes a room that its own room may not see, or a folder of its room that its own folder may not, or if a public
header sees anything but the standard library. --graph prints which room really includes which."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)

# Direct dependencies; what they may include, the room may include as well.
ROOMS = {
    "base": [],
    "linalg": ["base"],
    "matrix": ["base"],
    "methods": ["matrix", "linalg"],
    "geometry": ["base"],
    "scatter": ["base"],
    "media": ["base"],
    "emitters": ["base"],
    "image": ["base"],
    "film": ["image"],
    "denoise": ["image"],
    "oiio": ["image"],
    "scenedesc": ["base"],
    "world": ["scenedesc", "geometry", "scatter", "media", "emitters", "film"],
    "pathtrace": ["world"],
    "transport": ["world", "matrix", "linalg"],
    "settings": ["methods"],
    "pipeline": ["pathtrace", "transport", "methods", "settings", "denoise"],
    "pages": ["image"],
    "study": ["pipeline", "pages"],
    "api": ["study"],
}

# The same inside of a room, for its folders; "*" are those that are not named. Every folder may include the headers that lie
# in the room itself, and a file that lies there (a list of what there is) may include all folders.
FOLDERS = {
    "transport": {
        "segments": [],
        "rows": ["segments"],
        "lights": ["rows"],
        "pairs": ["lights"],
        "cpu": ["pairs"],
    },
    "scenedesc": {
        "schema": [],
        "data": ["schema"],
        "meshes": ["data"],
        "ies": ["data"],
        "volumes": ["data"],
        "mitsuba": ["meshes", "ies"],
        "pbrt": ["meshes", "ies", "volumes"],
        "gltf": ["meshes", "ies"],
        "writer": ["meshes", "ies", "volumes"],
    },
    "scatter": {"lobes": []},
    "methods": {
        "common": [],
        "slice_cuts": ["common"],
        "sampling_recovery": ["slice_cuts"],
        "*": ["common"],
    },
}


def reachable(start, table):
    seen, todo = set(), [start]
    while todo:
        r = todo.pop()
        if r not in seen:
            seen.add(r)
            todo += table[r] if r in table else table["*"]
    return seen


def folder_errors(path, name):
    """What is wrong with a file of a room that includes `name`, as for folders."""
    room = path.relative_to(ROOT / "src").parts[0]
    parts = name.split("/")
    own = path.relative_to(ROOT / "src" / room).parts
    if room not in FOLDERS or parts[0] != room or len(own) == 1 or len(parts) == 2:
        return []
    if parts[1] in reachable(own[0], FOLDERS[room]):
        return []
    return [f"{path.relative_to(ROOT)}: {room}/{own[0]} may not include {name}"]


def sources(folder):
    return [p for p in sorted(folder.rglob("*")) if p.suffix in (".h", ".cpp")]


def graph():
    """The rooms and which of them really include which, as Mermaid draws it, without edges that longer ways imply."""
    used = {room: set() for room in ROOMS}
    for room in ROOMS:
        for path in sources(ROOT / "src" / room):
            tops = {name.split("/")[0] for quote, name in INCLUDE.findall(path.read_text()) if quote == '"'}
            used[room] |= (tops & set(ROOMS)) - {room}
    lines = ["graph BT"]
    for room, direct in used.items():
        implied = set().union(*(reachable(r, used) - {r} for r in direct)) if direct else set()
        lines += [f"  {room} --> {r}" for r in ROOMS if r in direct - implied]
    return "\n".join(lines)


def main():
    errors = []
    for room in sorted(p.name for p in (ROOT / "src").iterdir() if p.is_dir()):
        if room not in ROOMS:
            errors.append(f"src/{room}: an unknown room; name it in {pathlib.Path(__file__).name}")
            continue
        allowed = reachable(room, ROOMS)
        for path in sources(ROOT / "src" / room):
            for quote, name in INCLUDE.findall(path.read_text()):
                top = name.split("/")[0]
                if quote == '"' and top in ROOMS and top not in allowed:
                    errors.append(f"{path.relative_to(ROOT)}: {room} may not include {name}")
                if quote == '"':
                    errors += folder_errors(path, name)
    for path in sorted((ROOT / "include").rglob("*.h")):
        for quote, name in INCLUDE.findall(path.read_text()):
            if quote == '"' and not name.startswith("lumirank/"):
                errors.append(f"{path.relative_to(ROOT)}: a public header may not include {name}")
            if quote == "<" and ("/" in name or name.endswith(".h")):
                errors.append(f"{path.relative_to(ROOT)}: public headers use the standard library only, not {name}")
    for path in sources(ROOT / "apps"):
        for quote, name in INCLUDE.findall(path.read_text()):
            if quote == '"' and "/" in name and not name.startswith("lumirank/"):
                errors.append(f"{path.relative_to(ROOT)}: applications use the public headers only, not {name}")
    if f"```mermaid\n{graph()}\n```" not in (ROOT / "docs" / "architecture.md").read_text():
        errors.append("docs/architecture.md: its graph of rooms is not the includes'; put there what check_layers.py --graph prints")
    print("\n".join(errors) if errors else "layers: fine")
    return 1 if errors else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--graph"]:
        print(graph())
    else:
        sys.exit(main())
