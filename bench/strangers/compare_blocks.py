"""What the scripts that go through a format feature by feature have in common: the command line, our picture, and what is said of it and another one of the same scene."""
import argparse
import pathlib
import subprocess

import numpy as np
import OpenEXR


def load(file):
    channels = OpenEXR.File(str(file)).channels()
    return np.array((channels["RGB"] if "RGB" in channels else channels["RGBA"]).pixels, dtype=np.float64)[..., :3]


def blocks(picture):
    h, w = picture.shape[0] // 8, picture.shape[1] // 8
    return picture[:8 * h, :8 * w].mean(2).reshape(h, 8, w, 8).mean((1, 3))


def line(name, ours, theirs, messages, max_block=0.06, max_mean=0.012):
    """The ratio of the means of the channels; the least and greatest difference of blocks of 8×8 pixels, relative to theirs; <<< where these are beyond the limits."""
    mean = ours.mean((0, 1)) / theirs.mean((0, 1))
    off = (blocks(ours) - blocks(theirs)) / (blocks(theirs) + 0.05 * theirs.mean())
    mark = "   <<<" if np.abs(off).max() > max_block or np.abs(mean - 1).max() > max_mean else ""
    return f"{name:26s} {' '.join(f'{m:.3f}' for m in mean)}   {off.min():+.3f} {off.max():+.3f} {messages}{mark}"


def go_through(doc, scenes, write, theirs, options=lambda out: [], paths=256):
    """For each of `scenes` asked for: `write(out, name)` returns its file, which `lumirank reference` renders with `options(out)`; `theirs(out, name, samples)` returns the picture that it is compared with."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--program", default="lumirank")
    parser.add_argument("--paths", type=int, default=paths)
    args = parser.parse_args()
    out = args.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    for name in args.names or scenes:
        if name not in scenes:
            parser.error(f"there is no scene {name}; there are {', '.join(scenes)}")
        file, picture = write(out, name), out / f"{name}.exr"
        run = subprocess.run([args.program, "reference", str(file), *options(out), "-o", str(picture), "--spp", str(args.paths), "--quiet"], capture_output=True, text=True)
        if run.returncode:
            print(f"{name:26s} {run.stderr.strip()}")
            continue
        print(line(name, load(picture), theirs(out, name, 2 * args.paths), run.stderr.strip()), flush=True)
