#!/usr/bin/env python3
"""Where the seconds of a default render go, phase by phase: a table of milliseconds for each pass, and of seconds once.

    bench/phases.py scene.xml [scene.pbrt …] [--size 640x360] [--passes 4] [--program PATH] [--against OTHER_PROGRAM]

With --against every cell is "other → this". Passes are given by number, so that both programs do the same; run it on a quiet machine.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
EACH_PASS = ["receivers", "traced_direct", "lights", "traced_near", "matrix", "method", "film", "rest"]
ONCE = ["build", "survey", "rest_pilot", "features", "denoise"]


def seconds_of(program, scene, args):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        subprocess.run([program, "render", scene, "-o", pathlib.Path(folder) / "picture.exr", "--size", args.size, "--passes", str(args.passes),
                        "--report", report, "--quiet"], check=True, stderr=subprocess.DEVNULL)
        return json.loads(report.read_text())


def name_of(scene):
    return scene.parent.name if scene.stem == "scene" else scene.stem


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    parser.add_argument("--against", type=pathlib.Path)
    args = parser.parse_args()
    programs = ([args.against] if args.against else []) + [args.program]
    columns = {name_of(scene): [seconds_of(program, scene, args) for program in programs] for scene in args.scenes}
    print("| | " + " | ".join(columns) + " |\n|---|" + "---|" * len(columns))
    for title, phases, scale, form in [("ms of a pass", EACH_PASS, 1000 / args.passes, "{:.0f}"), ("seconds, once", ONCE, 1, "{:.2f}"),
                                       ("all seconds", ["total"], 1, "{:.1f}")]:
        for phase in phases:
            cells = [" → ".join(form.format(scale * report.get("seconds." + phase, 0)) for report in reports)
                     for reports in columns.values()]
            print(f"| {title}: {phase.replace('_', ' ')} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
