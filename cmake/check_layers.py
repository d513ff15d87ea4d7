#!/usr/bin/env python3
"""Fails if a file includes a room that its own room may not see, or if a public header sees anything but the standard library."""
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
    "emitters": ["base"],
    "image": ["base"],
    "film": ["image"],
    "oiio": ["image"],
    "scenedesc": ["base"],
    "world": ["scenedesc", "geometry", "scatter", "emitters", "film"],
    "pathtrace": ["world"],
    "transport": ["world", "matrix"],
    "settings": ["methods"],
    "pipeline": ["pathtrace", "transport", "methods", "settings"],
    "pages": ["image"],
    "study": ["pipeline", "pages"],
    "api": ["study"],
}

# Folders of a room from the bottom up, as far as they have an order: none includes one further up, nor one beside it.
FOLDERS = {
    "scenedesc": [["schema"], ["data"], ["meshes", "ies"], ["mitsuba", "pbrt", "gltf"], ["writer"], ["."]],
}


def out_of_order(room, path, name):
    """Whether a file includes a folder of its own room that does not lie below its own."""
    def rank(parts):
        folder = parts[0] if len(parts) > 1 else "."
        return folder, next(i for i, row in enumerate(FOLDERS[room]) if folder in row)
    own, own_rank = rank(path.relative_to(ROOT / "src" / room).parts)
    other, other_rank = rank(pathlib.PurePosixPath(name).parts[1:])
    return own != other and other_rank >= own_rank


def reachable(room):
    seen, todo = set(), [room]
    while todo:
        r = todo.pop()
        if r not in seen:
            seen.add(r)
            todo += ROOMS[r]
    return seen


def main():
    errors = []
    for room in sorted(p.name for p in (ROOT / "src").iterdir() if p.is_dir()):
        if room not in ROOMS:
            errors.append(f"src/{room}: an unknown room; name it in {pathlib.Path(__file__).name}")
            continue
        allowed = reachable(room)
        for path in sorted((ROOT / "src" / room).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            for quote, name in INCLUDE.findall(path.read_text()):
                top = name.split("/")[0]
                if quote == '"' and top in ROOMS and top not in allowed:
                    errors.append(f"{path.relative_to(ROOT)}: {room} may not include {name}")
                elif quote == '"' and top == room and room in FOLDERS and out_of_order(room, path, name):
                    errors.append(f"{path.relative_to(ROOT)}: may not include {name}, which is not below it")
    for path in sorted((ROOT / "include").rglob("*.h")):
        for quote, name in INCLUDE.findall(path.read_text()):
            if quote == '"' and not name.startswith("lumirank/"):
                errors.append(f"{path.relative_to(ROOT)}: a public header may not include {name}")
            if quote == "<" and ("/" in name or name.endswith(".h")):
                errors.append(f"{path.relative_to(ROOT)}: public headers use the standard library only, not {name}")
    for path in sorted((ROOT / "apps").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        for quote, name in INCLUDE.findall(path.read_text()):
            if quote == '"' and "/" in name and not name.startswith("lumirank/"):
                errors.append(f"{path.relative_to(ROOT)}: applications use the public headers only, not {name}")
    print("\n".join(errors) if errors else "layers: fine")
    return 1 if errors else 0


sys.exit(main())
