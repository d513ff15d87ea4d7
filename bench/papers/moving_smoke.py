#!/usr/bin/env python3
"""Error and flicker of smoke that moves (make_moving_smoke.py): tensor clustering over ray lights, other methods and paths frame by frame.

    bench/papers/moving_smoke.py OUT scene.xml [--frames 6:17] [--size 96] [--paths 768] [--columns 200] [--lights 5000]

The truth are two independent path traced pictures of every frame, so that their own noise counts neither as error nor as flicker (shot_measures.py); flicker also of blocks of
4×4 pixels, in which fine noise cancels. Seconds are those of the whole process by its frames; --time of what is path traced is what tensor clustering took.
OUT gets tables.md, sheet.png and the frames; what is there is not rendered again. Only the standard library.
"""
import argparse
import pathlib
import subprocess
import time

from experiment_page import percent, read_pfm
from shot_measures import Frames, Lines, mean, sheet

BLOCK = 4


def blocks(picture):
    width, height, values = picture
    across, down = width // BLOCK, height // BLOCK
    out = [0.0] * (3 * across * down)
    for y in range(down * BLOCK):
        for x in range(across * BLOCK):
            at, to = 3 * (y * width + x), 3 * (y // BLOCK * across + x // BLOCK)
            for c in range(3):
                out[to + c] += values[at + c]
    return across, down, out


class Coarse:
    """The frames in blocks."""

    def __init__(self, frames):
        self.frames, self.folder, self.made = frames, frames.folder, {}

    def __getitem__(self, k):
        if k not in self.made:
            self.made[k] = blocks(self.frames[k])
        return self.made[k]

    def lines(self, k, lines):
        width, _, values = self[k]
        return [v for y in lines for v in values[3 * width * y:3 * width * (y + 1)]]


def run(line):
    print("$", " ".join(map(str, line)), flush=True)
    start = time.monotonic()
    subprocess.run([*map(str, line)], check=True)
    return time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--frames", default="6:17")
    parser.add_argument("--size", type=int, default=96, help="width and height in pixels, a multiple of 4; default 96")
    parser.add_argument("--paths", type=int, default=768, help="of each half of the truth, per pixel; default 768")
    parser.add_argument("--columns", type=int, default=200)
    parser.add_argument("--lights", type=int, default=5000)
    parser.add_argument("--program", default="build/release/lumirank")
    args = parser.parse_args()
    first, last = map(int, args.frames.split(":"))
    count, size = last - first + 1, f"{args.size}x{args.size}"
    args.out.mkdir(parents=True, exist_ok=True)
    for k in range(count):
        for half, name in enumerate(("truth", "other_truth")):
            file = args.out / f"{name}_{k:04d}.pfm"
            if not file.exists():
                run([args.program, "reference", args.scene, "--frame", first + k, "--size", size, "--spp", args.paths, "--seed", 2 * k + half + 1, "-o", file, "--quiet"])

    def shot(name, arguments):
        folder, seconds = args.out / name, args.out / f"{name}.seconds"
        if not seconds.exists():
            took = run([args.program, "animate", args.scene, "-o", folder, "--frames", args.frames, "--size", size, "--format", "pfm", "--quiet", *arguments])
            seconds.write_text(str(took / count))
        frames = Frames(folder, count)
        frames.kept = {k: read_pfm(folder / f"frame_{first + k:04d}.pfm") for k in range(count)}
        return name, frames, float(seconds.read_text())

    by_frame = ["--spp", 1, "--lights", args.lights]
    clustered = shot("tensor-clustering", [*by_frame, "--method", "tensor-clustering", "--set", f"columns={args.columns}", "--set", f"chunk={count}", "--set", "overlap=0"])
    limit = f"{clustered[2]:.2f}"
    shots = [clustered, shot("row-column-sampling", [*by_frame, "--method", "row-column-sampling", "--set", "rows=100", "--set", f"columns={2 * args.columns}"]),
             shot("adaptive-lightslice", [*by_frame, "--method", "adaptive-lightslice", "--set", "error=0.001"]),
             shot("paths", ["--time", limit, "--temporal-filter", 0]), shot("paths-averaged", ["--time", limit])]
    truth = Lines.of_pictures(args.out, count)
    coarse = Lines([[blocks(read_pfm(args.out / f"truth_{k:04d}.pfm"))] for k in range(count)], [[blocks(read_pfm(args.out / f"other_truth_{k:04d}.pfm"))] for k in range(count)])
    rows = ["| | seconds a frame | relative L2 | flicker | of blocks | mean |", "|---|---|---|---|---|---|"]
    for name, frames, seconds in shots:
        fine, rough = truth.measure(frames, range(args.size)), coarse.measure(Coarse(frames), range(args.size // BLOCK))
        rows.append(f"| {name} | {seconds:.1f} | {percent(mean(fine['l2']))} | {percent(mean(fine['flicker']))} | {percent(mean(rough['flicker']))} | {1 + fine['bias']:.3f} |")
    (args.out / "tables.md").write_text("\n".join(rows) + "\n")
    print("\n".join(rows))
    light = sorted(truth.values[0])
    sheet(args.out / "sheet.png", [Frames(args.out, count, "truth_{:04d}.pfm"), *(frames for _, frames, _ in shots)], count, 0.25 / light[len(light) // 2])


if __name__ == "__main__":
    main()
