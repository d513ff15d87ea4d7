#!/usr/bin/env python3
"""Memory of row-column sampling with lights in the millions, structure by structure.

    bench/memory.py OUT scene.xml [scene.xml …] [--lights 1000000 4000000] [--light-type sphere] [--rows 1024]
                    [--columns 10000] [--size 800x600] [--spp 4] [--time SECONDS] [--limit GB] [--program PATH]

One render per scene and number of lights. OUT/memory.md has a table of what each part takes, in all and per light (or per
receiver), beside the peak of the process; OUT/memory.json holds the same in full. With --limit the exit code is 1 if a peak
less its scene is above it (10⁹ bytes). --time cuts the columns short; they need no memory of their own.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PARTS = ["scene", "receivers", "lights", "matrix", "sketch", "held_out"]


def render(args, scene, lights, report):
    settings = [f"{key}={value}" for key, value in (("rows", args.rows), ("columns", args.columns)) if value > 0]
    command = [str(args.program.resolve()), "render", str(scene), "-o", str(report.with_suffix(".exr")), "--report", str(report), "--quiet", "--rest", "skip", "--method", "row-column-sampling",
               "--lights", str(lights), "--light-type", args.light_type, "--size", args.size, "--spp", str(args.spp), "--time", str(args.time)]
    for setting in settings:
        command += ["--set", setting]
    print("$", " ".join(command), flush=True)
    subprocess.run(command, check=True)
    return json.loads(report.read_text())


def megabytes(b):
    return f"{b / 1e6:.0f}"


def line(scene, report):
    lights, receivers = report["virtual_lights"], report["receivers"]
    peak, parts = report["memory.peak_bytes"], {p: report.get(f"memory.{p}_bytes", 0) for p in PARTS}
    cells = [scene, f"{lights:,}", f"{receivers:,}", f"{report['rows']:.0f}, {report['columns']:.0f}", f"**{megabytes(peak)}**",
             f"{megabytes(peak - parts['scene'])}"]
    cells += [megabytes(parts[p]) for p in PARTS]
    cells += [f"{(parts['lights']) / lights:.0f}, {(parts['sketch']) / lights:.0f}"]
    seconds = [f"{report.get('seconds.' + p, 0):.1f}" for p in ("lights", "rows", "clustering", "columns", "total")]
    return "| " + " | ".join(cells + seconds) + " |\n"


HEAD = ["scene", "lights", "receivers", "rows, columns", "peak MB", "over the scene"] + [f"{p.replace('_', ' ')} MB" for p in PARTS] + [
    "bytes per light: lights, sketch", "lights s", "rows s", "clustering s", "columns s", "total s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path, nargs="+")
    parser.add_argument("--lights", type=int, nargs="+", default=[1000000, 4000000])
    parser.add_argument("--light-type", default="sphere")
    parser.add_argument("--rows", type=int, default=1024, help="0: automatic")
    parser.add_argument("--columns", type=int, default=10000, help="0: automatic")
    parser.add_argument("--size", default="800x600")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--time", type=float, default=0)
    parser.add_argument("--limit", type=float, default=0)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    table = "| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD) + "\n"
    reports, over = [], []
    for scene in args.scenes:
        name = scene.stem if scene.stem != "scene" else scene.resolve().parent.name
        for lights in args.lights:
            report = render(args, scene, lights, args.out / f"{name}-{lights}.json")
            reports.append({"scene": name, **report})
            table += line(name, report)
            if args.limit > 0 and report["memory.peak_bytes"] - report["memory.scene_bytes"] > args.limit * 1e9:
                over.append(f"{name} with {lights} lights")
            (args.out / "memory.md").write_text(table)
            (args.out / "memory.json").write_text(json.dumps(reports, indent=1))
    print(table)
    if over:
        sys.exit(f"above the limit of {args.limit} GB over the scene: {', '.join(over)}")


if __name__ == "__main__":
    main()
