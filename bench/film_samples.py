#!/usr/bin/env python3
"""Film samples against receivers: error and seconds of each number of both, and close-ups of edges.

    bench/film_samples.py OUT scene.xml [scene.xml …] [--size 320x180] [--truth 256] [--close-up NAME:X,Y,W,H …]
                          [--options "…"] [--program PATH]

Renders every scene with 4 receivers per pixel and 0, 4, 16 and 64 film samples, and with 16 and 64 receivers without. The truth is a
picture of --truth receivers without film samples and of the same lights, so that errors are those of the film. OUT/table.md has
relative L1 and L2 errors, those of the edges as they are displayed (colors cut off at 1; pixels beside which the truth leaps by more
than EDGE), and processor seconds of the whole process, which other work on the machine disturbs less than the clock. Every --close-up
(of the scene in folder NAME) becomes a PNG: truth, then all pictures, eight times as large. Finished runs are not repeated.
"""
import argparse
import json
import math
import pathlib
import resource
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "bench/papers"))
from experiment_page import read_pfm, to_display, write_png  # noqa: E402

RUNS = [(4, 0), (4, 4), (4, 16), (4, 64), (16, 0), (64, 0)]  # receivers, film samples
EDGE = 0.1  # of displayed color: a leap to a neighbor that makes a pixel one of an edge


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def picture(args, scene, receivers, film_samples):
    """(width, height, floats), report with "cpu"."""
    base = args.out / f"{scene.parent.name}-{receivers}-{film_samples}"
    image, report, seconds = (base.with_name(base.name + end) for end in (".pfm", ".json", ".seconds"))
    if not seconds.exists():
        line = [str(args.program), "render", str(scene), "-o", str(image), "--report", str(report), "--quiet", "--rest", "skip", "--size", args.size,
                "--spp", str(receivers), "--film-samples", str(film_samples), *shlex.split(args.options)]
        print("$", shlex.join(line), flush=True)
        before = processor_seconds()
        subprocess.run(line, check=True)
        seconds.write_text(str(processor_seconds() - before))
    return read_pfm(image), json.loads(report.read_text()) | {"cpu": float(seconds.read_text())}


def displayed(values):
    return [min(1.0, max(0.0, v)) ** (1 / 2.2) for v in values]


def edges(width, height, shown):
    """Pixels beside which the picture leaps, by the largest of the three colors."""
    marked = set()
    for y in range(height):
        for x in range(width):
            p = y * width + x
            for q in (p + 1 if x + 1 < width else p, p + width if y + 1 < height else p):
                if max(abs(shown[3 * p + c] - shown[3 * q + c]) for c in range(3)) > EDGE:
                    marked |= {p, q}
    return sorted(marked)


def errors(values, truth, shown, marked):
    own, n = displayed(values), 3 * len(marked)
    at_edges = math.sqrt(sum((own[3 * p + c] - shown[3 * p + c]) ** 2 for p in marked for c in range(3)) / max(1, n))
    absolute = sum(abs(a - b) for a, b in zip(values, truth)) / sum(truth)
    square = math.sqrt(sum((a - b) ** 2 for a, b in zip(values, truth)) / sum(b * b for b in truth))
    return absolute, square, (sum(values) - sum(truth)) / sum(truth), at_edges


def close_up(args, place, pictures):
    """The same window of all pictures side by side."""
    name, box = place.split(":")
    x0, y0, w, h = map(int, box.split(","))
    scale, gap = 8, 4
    width = len(pictures) * (w * scale + gap) - gap
    out = bytearray(b"\xff" * (3 * width * h * scale))
    for k, (across, _, values) in enumerate(pictures):
        for y in range(h):
            row = to_display(values[3 * (across * (y0 + y) + x0):3 * (across * (y0 + y) + x0 + w)], 1)
            line = b"".join(row[3 * x:3 * x + 3] * scale for x in range(w))
            for s in range(scale):
                at = 3 * ((y * scale + s) * width + k * (w * scale + gap))
                out[at:at + len(line)] = line
    write_png(args.out / f"{name}-{box.replace(',', '-')}.png", width, h * scale, bytes(out))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path, nargs="+")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--truth", type=int, default=256, help="receivers per pixel of the truth")
    parser.add_argument("--close-up", action="append", default=[])
    parser.add_argument("--options", default="", help="for every render")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/lumirank")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    lines = ["| scene | receivers | film samples | L1 | L2 | bias | edges | processor s | receivers added |", "|" + "---|" * 9]
    for scene in (s.resolve() for s in args.scenes):
        name = scene.parent.name
        truth, _ = picture(args, scene, args.truth, 0)
        shown = displayed(truth[2])
        marked = edges(truth[0], truth[1], shown)
        made = [truth]
        for receivers, film_samples in RUNS:
            image, report = picture(args, scene, receivers, film_samples)
            made.append(image)
            l1, l2, bias, at_edges = errors(image[2], truth[2], shown, marked)
            pixels = report["receivers_per_pixel"] * truth[0] * truth[1]
            lines.append(f"| {name} | {receivers} | {film_samples} | {100 * l1:.1f} % | {100 * l2:.1f} % | {100 * bias:+.1f} % | {at_edges:.3f} | "
                         f"{report['cpu']:.1f} | {100 * report.get('film.receivers_added', 0) / pixels:.1f} % |")
            print(lines[-1], flush=True)
        for place in args.close_up:
            if place.split(":")[0] == name:
                close_up(args, place, made)
    (args.out / "table.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
