#!/usr/bin/env python3
"""What a person gets who brings a scene, gives a time or an error and takes every other default: seconds asked and taken, stated and true error.

    bench/strangers/asked_and_taken.py OUT scene.xml [scene.pbrt …] [--times 3 8 20] [--errors 0.1 0.05] [--size 320x180] [--program PATH]
                                       [--reference-time 60] [--options "--rest skip"]

With --errors and without --times, no times are asked for.

References are path traced once and kept in OUT/references; a picture's true error is against that reference, so it holds the
reference's own (also in the table). OUT/table.md has a line for each; OUT/NAME--time-T.png and OUT/NAME--error-E.png are the pictures, to be looked at.
The seconds are the report's seconds.total, everything from the loaded scene on, without writing files.
"""
import argparse
import json
import pathlib
import shlex
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(command):
    print("$", shlex.join(map(str, command)), flush=True)
    return subprocess.run([str(c) for c in command], capture_output=True, text=True)


def name_of(scene):
    """Folder and file, so that several files of one folder differ."""
    return f"{scene.parent.name}-{scene.stem}" if scene.stem != "scene" else scene.parent.name


def reference(args, scene):
    image = args.out / "references" / (name_of(scene) + ".exr")
    report = image.with_suffix(".json")
    if not report.exists():
        image.parent.mkdir(parents=True, exist_ok=True)
        done = run([args.program, "reference", scene, "-o", image, "-o", image.with_suffix(".png"), "--tonemap", "agx", "--time", args.reference_time,
                    "--size", args.size, "--report", report, "--quiet"])
        if done.returncode:
            return None, done.stderr.strip()[-300:]
    return image, json.loads(report.read_text()).get("error.relative_l1", float("nan"))


def measure(args, scene, option, asked):
    image, report, shown, said = (args.out / f"{name_of(scene)}{option}-{asked:g}{kind}" for kind in (".exr", ".json", ".png", ".txt"))
    done = run([args.program, "render", scene, "-o", image, "-o", shown, "--tonemap", "agx", option, asked, "--size", args.size,
                "--report", report, *shlex.split(args.options)])
    said.write_text(done.stderr)
    if done.returncode:
        return None
    return image, json.loads(report.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path, nargs="+")
    parser.add_argument("--times", type=float, nargs="+")
    parser.add_argument("--errors", type=float, nargs="+", default=[], help="relative L1")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--reference-time", type=float, default=60)
    parser.add_argument("--options", default="")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    args = parser.parse_args()
    wanted = [("--time", s) for s in args.times or ([] if args.errors else [3, 8, 20])] + [("--error", e) for e in args.errors]
    args.out.mkdir(parents=True, exist_ok=True)
    head = "| scene | asked | taken | ratio | stated error | true L1 | bias | reference's own | method |\n|" + "---|" * 9 + "\n"
    table = args.out / "table.md"
    table.write_text(head)
    for scene in args.scenes:
        truth, own = reference(args, scene.resolve())
        for option, asked in wanted:
            got = measure(args, scene.resolve(), option, asked)
            shown = f"{asked:g} s" if option == "--time" else f"{100 * asked:g} %"
            if got is None or truth is None:
                line = f"| {name_of(scene)} | {shown} | failed: {own if truth is None else 'see its .txt'} |" + " |" * 6
            else:
                image, report = got
                error = json.loads(run([args.program, "error", image, truth]).stdout)
                stated = report.get("error.estimate")
                taken = report["seconds.total"]
                said = "—" if stated is None else f"{100 * stated:.1f} %"
                ratio = f"{taken / asked:.2f}" if option == "--time" else ""
                line = (f"| {name_of(scene)} | {shown} | {taken:.2f} | {ratio} | {said} | {100 * error['relative_l1']:.1f} % | "
                        f"{100 * error['bias']:+.1f} % | {100 * own:.1f} % | {report['method']} |")
            with table.open("a") as out:
                out.write(line + "\n")
            print(line, flush=True)


if __name__ == "__main__":
    main()
