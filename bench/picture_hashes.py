#!/usr/bin/env python3
"""The bits of small pictures, per method and scene: picture_hashes.py PROGRAM [-o FILE] [--against FILE].

For a change that must not change a picture: run it with the program from before and `-o`, then with the new one and
`--against`. Bits are equal on one machine only (the build uses its instruction set). Ends with 1 if a hash differs.
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = {name: ROOT / "examples" / f"{name}.xml" for name in ["box", "courtyard", "interior", "lamps", "recesses"]}
SCENES["materials"] = ROOT / "bench" / "scenes" / "materials.xml"  # every BSDF
SIZE = ["--size", "64x36", "--seed", "3", "--threads", "2"]
# Beside every method with its defaults: what else goes through code of its own. Name, command, options.
MORE = [
    ("spheres", "render", ["--method", "row-column-sampling", "--light-type", "sphere"]),
    ("spheres, brute force", "render", ["--method", "brute-force", "--light-type", "sphere"]),
    ("local paths", "render", ["--light-type", "sphere", "--local-paths", "2"]),
    ("compensated", "render", ["--method", "row-column-sampling", "--compensate", "2"]),
    ("direct in the matrix", "render", ["--method", "brute-force", "--direct", "matrix", "--rest", "skip"]),
    ("all direct traced", "render", ["--direct", "traced"]),
    ("the rest traced", "render", ["--rest", "trace"]),
    ("indirect only", "render", ["--only", "indirect", "--max-depth", "4"]),
    ("layers", "render", ["--aov", "albedo,normal,depth,direct,indirect,emission,illuminance"]),
    ("crop", "render", ["--crop", "8,8,24,16"]),
    ("reference", "reference", ["--spp", "4"]),
    ("reference, columns' paths", "reference", ["--spp", "4", "--paths", "columns"]),
    ("reference, the rest", "reference", ["--spp", "4", "--paths", "rest"]),
]


def digest(program, command, scene, options, also):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "picture.exr"
        own = SIZE if command == "reference" else SIZE + ["--lights", "2000"] + (
            [] if "--spp" in options else ["--spp", "2"]) + also
        line = [program, command, str(SCENES[scene]), "-o", str(out), *own, *options]
        done = subprocess.run(line, capture_output=True, text=True)
        if done.returncode != 0:
            return "refused: " + done.stderr.strip().splitlines()[-1][:100]
        return hashlib.sha256(out.read_bytes()).hexdigest()[:12]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("-o", dest="out")
    parser.add_argument("--against")
    parser.add_argument("--only", help="rows whose name holds this")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--also", default="", help="options for every render, for a default that was changed: "
                        "--also='--film-samples 0' makes the pictures from before film samples")
    args = parser.parse_args()
    methods = [m["name"] for m in json.loads(
        subprocess.run([args.program, "methods", "--json"], capture_output=True, text=True, check=True).stdout)
               if not m.get("of_shots")]
    rows = [(m, "render", ["--method", m]) for m in methods] + MORE
    table = {name: {scene: digest(args.program, command, scene, options, args.also.split()) for scene in SCENES}
             for name, command, options in rows if not args.only or args.only in name}
    before = json.loads(pathlib.Path(args.against).read_text()) if args.against else {}
    differing = [(n, s) for n, row in table.items() for s, h in row.items()
                 if n in before and before[n].get(s) != h]
    if args.out:
        pathlib.Path(args.out).write_text(json.dumps(table, indent=1) + "\n")
    if args.markdown:
        print("| |" + "|".join(SCENES) + "|\n|---|" + "---|" * len(SCENES))
        for name, row in table.items():
            print(f"| {name} | " + " | ".join(row[s] for s in SCENES) + " |")
    for name, scene in differing:
        print(f"differs: {name}, {scene}: {before[name].get(scene)} → {table[name][scene]}")
    missing = [n for n in before if n not in table] if not args.only else []
    print(f"{sum(len(r) for r in table.values())} pictures, {len(differing)} differ" +
          (f", {len(missing)} rows of the table are gone: {missing}" if missing else ""))
    return 1 if differing or missing else 0


sys.exit(main())
