#!/usr/bin/env python3
"""Repeats the experiments of Huo, Wang, Hu, Hua and Jin 2016 on scenes of our own making (make_media_scenes.py) or on others.

    bench/papers/column_completion_2016.py OUT [fog street liquids statue studio | scene.xml …] [--quick] [--parts figure6,sigma,…] [--mitsuba-python PYTHON]

  figure6     Figure 6: rays partitioned by the graph, by k-means, not at all, at equal sampling
  sigma       Figure 7: the error threshold of the completion
  anisotropy  Figure 8: forward scattering and the sampling ratio (statue)
  rho         Figure 9: the sampling ratio (studio)
  equal       Figures 1, 10 and 11: all methods at equal time, and Mitsuba 3's volpath, as it is and denoised
  scaling     Figure 10, below: the time for the same relative L1 from 10,000 to a million light segments
  smoke       scenes of others (--smoke), beside path-traced references: whether the same picture is aimed at

Parts that vary the method at given lights know the truth at some spans of scanlines, spread over the picture: there all columns of the same lights are summed (brute-force
--crop), so the pictures can be larger than brute force would allow. Errors are relative L1 over the spans, with a 95 % interval that leaves out one of them at a time.
Part equal averages passes of fresh lights, as --time does, and is measured against two long path-traced references whose own noise cancels in relative L2
(experiment_page.Truth); its relative L1 holds their noise. Seconds of Mitsuba leave out loading and compiling.
Methods that the program does not have are left out, and the page says so. --try-with METHOD:KEY=A,B,C runs the sweeps of the paper's method with another one's parameter instead,
to try the script.
OUT gets index.html, tables.md, images/ and parts/. What is finished with the same settings is not run again. --quick: small sizes, minutes instead of hours; its numbers show
that the script works and nothing else.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

from experiment_page import Page, Runs, Truth, at_level, best, percent, plot, read_pfm, run_parts

HERE = pathlib.Path(__file__).resolve().parent

# Methods and parameters, as the program names them.
OURS, SLICES, ALL, PLAIN, TRUTH = "column-completion", "adaptive-lightslice", "virtual-ray-lights", "row-column-sampling", "brute-force"
CUTS = "scalable-virtual-ray-lights"
PARTITIONS = ("graph", "k-means", "places", "stretches")
SIGMAS, RHOS = (0.05, 0.01, 0.005), (0, 0.1, 0.05, 0.01)
STATUE = [(g, rho) for g in (0, 0.5, 0.9, 0.99) for rho in (0, 0.1, 0.2)]  # 0: found for each slice
EVERY_COLUMN = {"beta": 0}  # section 6.2: completion alone, without choosing among columns
AT_EQUAL_TIME = {OURS: {}, SLICES: {}, CUTS: {}, ALL: {}, PLAIN: {"rows": 100, "columns": 200}}
LADDERS = {  # of part scaling, from poor to good
    OURS: [{"samples": 5, "sigma": 0.01}, {"sigma": 0.01, "beta": 0.02}, {"sigma": 0.01}, {}, {"samples": 20}],
    SLICES: [{"error": e} for e in (0.05, 0.02, 0.01, 0.005)],
    CUTS: [{"max-nodes": n} for n in (250, 500, 1000, 2000, 4000)],
    PLAIN: [{"rows": r, "columns": 3 * r} for r in (50, 100, 200, 400, 800)],
}
# The same as its paper has it.
WHOLE_RAYS = f"{SLICES} on whole eye rays"
TOLD = ("sampling_rate", "completion.rank", "columns", "passes")  # numbers of the report that tables show where there are such

SIZES = {"fog": (320, 240), "street": (320, 240), "liquids": (480, 200), "statue": (240, 240), "studio": (320, 240)}
DEPTH = 32


class Spans:
    """The sums of all columns at some pieces of scanlines."""

    def __init__(self, spans, pictures):
        self.spans, self.values = spans, [p[2] for p in pictures]

    def of(self, image):
        width = image[0]
        return [image[2][3 * (y * width + x):3 * (y * width + x + count)] for x, y, count in self.spans]

    def error(self, image):
        parts = []
        for have, true in zip(self.of(image), self.values):
            if len(have) != len(true):
                raise ValueError(f"{len(have)} numbers against {len(true)} of the truth")
            parts.append((sum(abs(a - b) for a, b in zip(have, true)), sum((a - b) ** 2 for a, b in zip(have, true)), sum(have) - sum(true), sum(true), sum(b * b for b in true)))
        absolute, square, off, total, squares = (sum(p[k] for p in parts) for k in range(5))
        without = [(absolute - p[0]) / (total - p[3]) for p in parts if total > p[3]]
        middle = sum(without) / len(without)
        spread = math.sqrt((len(parts) - 1) / len(parts) * sum((w - middle) ** 2 for w in without))
        return {"l1": absolute / total, "l1_width": 1.96 * spread, "l2": math.sqrt(square / squares), "bias": off / total}

    def exposure(self):
        values = [v for part in self.values for v in part]
        return 0.25 * len(values) / max(sum(values), 1e-12)


def words(settings):
    return ", ".join(f"{k} {v}" for k, v in settings.items()) or "as by default"


class Experiments:
    def __init__(self, args):
        self.args, quick = args, args.quick
        self.lights = args.lights or (2000 if quick else 100_000)
        self.spp, self.shrink = args.spp, 4 if quick else 1
        self.seconds = args.seconds or ([4.0] if quick else [60.0, 240.0])
        self.truth_seconds = args.truth_seconds or (20 if quick else 1800)
        self.counts = args.counts or ([500, 2000] if quick else [10_000, 30_000, 100_000, 300_000, 1_000_000])
        self.runs = Runs(args.program.resolve(), args.out, args.threads)
        listed = subprocess.run([str(args.program), "methods", "--json"], check=True, capture_output=True, text=True).stdout
        self.known = {m["name"] for m in json.loads(listed)}
        needed = [n for n in SIZES if not (args.scenes / n / "scene.xml").exists()]
        if needed:
            subprocess.run([sys.executable, str(HERE / "make_media_scenes.py"), str(args.scenes), *needed], check=True)
        self.page = Page("Column completion in participating media: the experiments of the 2016 paper", args.out)
        self.page.say(f"{self.lights:,} lights, {self.spp} receivers per pixel, at most {DEPTH} segments of a path."
                      + (f" Sweeps with {args.try_with} in place of {OURS}." if args.try_with else "")
                      + (" Quick run: its numbers show that the script works and nothing else." if quick else ""))

    # ------------------------------------------------------------------------------------------------------------------------------------ scenes and runs

    def scene(self, name):
        return self.args.scenes / name / "scene.xml" if name in SIZES else pathlib.Path(name)

    @staticmethod
    def label(name):
        path = pathlib.Path(name)
        return name if name in SIZES else f"{path.parent.name}_{path.stem}"

    def size(self, name):
        width, height = SIZES.get(name) or self.args.size
        return width // self.shrink, height // self.shrink

    def scenes(self, default):
        return self.args.of or list(default)

    def has(self, *methods):
        """Those of the methods that there are; the page names the others."""
        missing = [m for m in methods if m not in self.known]
        if missing:
            self.page.say(f"Not in the program, and left out: {', '.join(missing)}.")
        return [m for m in methods if m in self.known]

    def render(self, what, name, method, settings, lights=None, more=()):
        width, height = self.size(name)
        sets = [word for k, v in settings.items() for word in ("--set", f"{k}={v}")]
        return self.runs.run(f"{self.label(name)}_{what}", "render", self.scene(name), ["--size", f"{width}x{height}", "--spp", self.spp, "--lights", lights or self.lights, "--direct", "matrix",
                             "--max-depth", DEPTH, "--method", method, *sets, *more])

    def truth(self, name, lights=None, more=(), tag="", count=None, long=None):
        """All columns at the spans, and the seconds that they would take for the whole picture."""
        width, height = self.size(name)
        lines, parts = count or (self.args.lines, 4)
        long = long or max(4, width // (4 * parts))
        spans = [((2 * p + 1) * width // (2 * parts) - long // 2, (2 * k + 1) * height // (2 * lines), long) for k in range(lines) for p in range(parts)]
        runs = [self.render(f"all{tag}_{lights or self.lights}_{x}_{y}_{n}", name, TRUTH, {}, lights, [*more, "--crop", f"{x},{y},{n},1"]) for x, y, n in spans]
        seconds = sum(r["seconds.columns"] for _, r in runs) * width * height / (long * len(spans))
        return Spans(spans, [p for p, _ in runs]), seconds

    def sweep_of(self, values, key, fixed):
        """(method, settings, label) of the runs of a sweep: the paper's method, or what --try-with says."""
        if self.args.try_with:
            method, rest = self.args.try_with.split(":")
            key, values = rest.split("=")
            return [(method, {key: v}, f"{key} {v}") for v in values.split(",")]
        if not self.has(OURS):
            return []
        return [(OURS, {key: v, **fixed}, f"{key} {v}") for v in values]

    def told(self, report):
        return [f"{report[k]:.3g}" if k in report else "" for k in TOLD]

    def sweep(self, title, say, scenes, runs, more=(), tag=""):
        """One table for each scene, with pictures."""
        page = self.page
        page.heading(title)
        page.say(say)
        for name in scenes if runs else []:
            truth, brute = self.truth(name, more=more, tag=tag)
            rows = []
            for method, settings, label in runs:
                picture, report = self.render(f"{tag}{method}_{'_'.join(f'{k}{v}' for k, v in settings.items())}", name, method, settings, more=more)
                e = truth.error(picture)
                rows.append((label, f"{percent(e['l1'])} ± {100 * e['l1_width']:.1f}", percent(e["l2"]), f"{100 * e['bias']:+.1f} %", f"{report['seconds.total']:.1f}",
                             f"{brute / max(report['seconds.total'], 1e-9):.1f}×", *self.told(report)))
                page.picture(f"{self.label(name)}_{tag}{label.replace(' ', '_')}", picture, truth.exposure(), f"{self.label(name)}, {label}: relative L1 {percent(e['l1'])}")
            page.table((self.label(name), "relative L1", "relative L2", "bias", "seconds", "brute force's columns over that", *TOLD), rows)
            page.write()

    # ---------------------------------------------------------------------------------------------------------------------------------------------- parts

    def figure6(self):
        self.sweep("Figure 6: partition of rays", f"{OURS} with its rays partitioned by the graph, by k-means, or not, with the same sampling ratio and columns for a node.",
                   self.scenes(("fog", "studio")), self.sweep_of(PARTITIONS, "partition", {"tree": "graph"}))

    def sigma(self):
        self.sweep("Figure 7: the completion's threshold", "Every column is completed, none is left out. The paper: 40, 48 and 52 s, and details lost with 0.05.",
                   self.scenes(("fog",)), self.sweep_of(SIGMAS, "sigma", EVERY_COLUMN))

    def rho(self):
        self.sweep("Figure 9: the sampling ratio", "Every column is completed. The paper: 0.1 is close to the reference, 7 times as fast; below, blocks show, at the boundary of light shafts first.",
                   self.scenes(("studio",)), self.sweep_of(RHOS, "rho", EVERY_COLUMN))

    def anisotropy(self):
        page = self.page
        page.heading("Figure 8: forward scattering")
        page.say("The statue with three mean cosines, each at two sampling ratios. The paper goes up to 0.99, and takes 62 to 75 s at 0.2.")
        if self.args.of and "statue" not in self.args.of:
            return
        for g in sorted({g for g, _ in STATUE}):
            self.sweep(f"g = {g}", "", ["statue"], self.sweep_of([r for k, r in STATUE if k == g], "rho", {}), ("--define", f"g={g}"), f"g{g}_")

    def references(self, name):
        """Two long path-traced pictures with seeds that nothing else has."""
        width, height = self.size(name)
        pair = [self.runs.run(f"{self.label(name)}_reference_{seed}", "reference", self.scene(name), ["--size", f"{width}x{height}", "--max-depth", DEPTH, "--time", self.truth_seconds / 2, "--seed", seed])
                for seed in (90001, 90002)]
        return Truth(pair[0][0], pair[1][0]), [r["error.relative_l1"] for _, r in pair]

    def volpath(self, name, seconds, integrator="volpath", truth_paths=0):
        """(noisy, denoised, what was done, its own two references) by Mitsuba, or None."""
        if not self.args.mitsuba_python:
            return None
        width, height = self.size(name)
        out = self.args.out.resolve() / "parts" / f"{self.label(name)}_{integrator}_{seconds:g}"
        record = out / "asked.json"
        asked = [width, height, seconds, truth_paths]
        if not record.exists() or json.loads(record.read_text()) != asked:
            line = [self.args.mitsuba_python, str(HERE / "denoised_path_tracer.py"), str(out), str(self.scene(name).resolve()), "--size", f"{width}x{height}", "--seconds", str(seconds),
                    "--integrator", integrator, "--depth", str(DEPTH), *(["--lines", "all", "--truth", str(truth_paths)] if truth_paths else [])]
            print("$", " ".join(line), flush=True)
            subprocess.run(line, check=True)
            record.write_text(json.dumps(asked))
        own = [read_pfm(out / f"{n}_0000.pfm") for n in ("truth", "other_truth")] if truth_paths else None
        return read_pfm(out / "noisy_0000.pfm"), read_pfm(out / "frame_0000.pfm"), json.loads((out / "shot.json").read_text()), own

    def equal(self):
        page = self.page
        page.heading("All methods at equal time")
        page.say("Each averages passes of its own until the time is over. Relative L2 without the references' noise; relative L1 with it.")
        methods = self.has(*AT_EQUAL_TIME)
        for name in self.scenes(SIZES):
            truth, stated = self.references(name)
            page.heading(self.label(name))
            page.say("Stated errors (relative L1) of the two references: " + ", ".join(map(percent, stated)) + ".")
            page.picture(f"{self.label(name)}_reference", (truth.width, truth.height, truth.mean), truth.exposure, f"{self.label(name)}: path traced")
            rows = []
            for seconds in self.seconds:
                shown = []
                for method in methods:
                    picture, report = self.render(f"equal_{method}_{seconds:g}", name, method, AT_EQUAL_TIME[method], more=["--time", seconds])
                    shown.append((method, picture, f"{report['seconds.total']:.1f}", f"{report.get('passes', 1):.0f} passes, {words(AT_EQUAL_TIME[method])}"))
                picture, report = self.runs.run(f"{self.label(name)}_equal_reference_{seconds:g}", "reference", self.scene(name),
                                                ["--size", f"{truth.width}x{truth.height}", "--max-depth", DEPTH, "--time", seconds])
                shown.append(("our path tracer", picture, f"{report['wall']:.1f}", ""))
                if found := self.volpath(name, seconds):
                    noisy, clean, done, _ = found
                    took, how = f"{done['seconds'][0]:.1f}", f"{done['paths']} paths per pixel"
                    shown += [("volpath", noisy, took, how), ("volpath, denoised", clean, took, how)]
                for label, picture, took, how in shown:
                    e = truth.error(picture)
                    rows.append((label, took, percent(e["l1"]), f"{percent(e['l2'])} ± {100 * e['l2_width']:.1f}", f"{100 * e['bias']:+.1f} %", how))
                    if seconds == self.seconds[0]:
                        page.picture(f"{self.label(name)}_{label.replace(', ', '_')}", picture, truth.exposure, f"{label}, {took} s: relative L1 {percent(e['l1'])}")
            page.table((self.label(name), "seconds", "relative L1", "relative L2", "bias", ""), rows)
            page.write()

    def scaling(self):
        page = self.page
        page.heading("Time at equal error, by the number of lights")
        page.say(f"Seconds until relative L1 is {percent(self.args.level)} of all columns of the same lights, read off the sweep of each method by straight lines in logarithms; left open where it does not get "
                 f"there. {ALL} has no error to speak of: its time is that of all columns, from the spans of the truth.")
        asked = self.args.methods.split(",") if self.args.methods else list(LADDERS)
        ladders = {m: LADDERS[m] for m in self.has(*LADDERS) if m in asked}
        if SLICES in ladders:
            ladders[WHOLE_RAYS] = [{"eye-rays": "whole", **settings} for settings in LADDERS[SLICES]]
        for name in self.scenes(("fog",)):
            curves, rows = {m: [] for m in (ALL, *ladders)}, []
            for lights in self.counts:
                truth, brute = self.truth(name, lights, count=(4, 8), long=10)
                curves[ALL].append((lights, brute))
                row = [f"{lights:,}", f"{brute:.0f}"]
                for method, ladder in ladders.items():
                    curve = []
                    for settings in ladder:
                        of = SLICES if method == WHOLE_RAYS else method
                        picture, report = self.render(f"scaling_{lights}_{of}_{'_'.join(map(str, settings.values()))}", name, of, settings, lights)
                        curve.append({"seconds": report["seconds.total"], "l1": truth.error(picture)["l1"]})
                    seconds = at_level(curve, self.args.level, "seconds", "l1")
                    if seconds:
                        curves[method].append((lights, seconds))
                    row.append(f"{seconds:.1f}" if seconds else ", ".join(f"{t:.1f} s: {percent(e)}" for t, e in best(curve, "seconds", "l1")))
                rows.append(row)
                page.write()
            page.table((f"{self.label(name)}: lights", f"all columns ({ALL})", *ladders), rows)
            page.svg(plot(f"{self.label(name)}: seconds for a relative L1 of {percent(self.args.level)}", "lights", "seconds", curves))
            page.write()

    def smoke(self):
        page = self.page
        page.heading("Scenes of others, beside references")
        page.say("Our reference, row-column sampling and Mitsuba, each against our two references. The last column: blocks of 16×16 pixels against ours, relative L1. Two programs that aim at the same picture differ by noise alone.")
        for name in map(str, self.args.smoke):
            truth, stated = self.references(name)
            rows = [("our references", percent(sum(stated) / 2), "", "", f"{truth.level:.5g}", "")]
            shown = [(PLAIN, self.render(f"smoke_{PLAIN}", name, PLAIN, AT_EQUAL_TIME[PLAIN], more=["--time", self.seconds[0]])[0])]
            for integrator in ("volpath", "volpathmis"):
                if found := self.volpath(name, self.seconds[0], integrator, self.args.truth_paths):
                    one, other = found[3]
                    shown.append((integrator, (*one[:2], [(a + b) / 2 for a, b in zip(one[2], other[2])])))
            page.picture(f"{self.label(name)}_reference", (truth.width, truth.height, truth.mean), truth.exposure, f"{self.label(name)}: our reference")
            for label, picture in shown:
                e = truth.error(picture)
                level = sum(picture[2]) / len(picture[2])
                rows.append((label, percent(e["l1"]), percent(e["l2"]), f"{100 * e['bias']:+.2f} %", f"{level:.5g}", percent(block_difference(truth, picture))))
                page.picture(f"{self.label(name)}_smoke_{label}", picture, truth.exposure, f"{label}: mean {level:.5g}")
            page.table((self.label(name), "relative L1", "relative L2", "bias", "mean", "blocks"), rows)
            page.write()


def block_difference(truth, image, across=16):
    blocks = {}
    for y in range(truth.height):
        for x in range(truth.width):
            at, key = 3 * (y * truth.width + x), (y // across, x // across)
            mine, theirs = blocks.get(key, (0.0, 0.0))
            blocks[key] = (mine + sum(truth.mean[at:at + 3]), theirs + sum(image[2][at:at + 3]))
    return sum(abs(a - b) for a, b in blocks.values()) / sum(a for a, _ in blocks.values())


PARTS = {"figure6": Experiments.figure6, "sigma": Experiments.sigma, "anisotropy": Experiments.anisotropy, "rho": Experiments.rho, "equal": Experiments.equal,
         "scaling": Experiments.scaling, "smoke": Experiments.smoke}


def size_of(argument):
    return tuple(map(int, argument.split("x")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("of", nargs="*", metavar="scene", help=f"{', '.join(SIZES)}, or scene files; default: those of each figure")
    parser.add_argument("--program", type=pathlib.Path, default=HERE.parents[1] / "build/release/lumirank")
    parser.add_argument("--scenes", type=pathlib.Path, help="folder of the generated scenes; default: OUT/scenes")
    parser.add_argument("--parts", default=",".join(p for p in PARTS if p != "smoke"), help="which parts, in this order; default: all but smoke")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--size", type=size_of, default=(320, 240), help="of scene files that are given; default 320x240")
    parser.add_argument("--lights", type=int, help="default 100000")
    parser.add_argument("--spp", type=int, default=1, help="receivers per pixel; default 1")
    parser.add_argument("--lines", type=int, default=4, help="scanlines with spans of known truth, four on each; default 4")
    parser.add_argument("--seconds", type=lambda s: [float(t) for t in s.split(",")], help="of part equal; default 60,240")
    parser.add_argument("--truth-seconds", type=float, help="of the two references together; default 1800")
    parser.add_argument("--counts", type=lambda s: [int(n) for n in s.split(",")], help="lights of part scaling; default 10000 … 1000000")
    parser.add_argument("--level", type=float, default=0.05, help="relative L1 of part scaling; default 0.05")
    parser.add_argument("--methods", help="of part scaling, by commas; default: all")
    parser.add_argument("--smoke", type=pathlib.Path, nargs="+", default=[], metavar="SCENE", help="of part smoke")
    parser.add_argument("--truth-paths", type=int, default=512, help="of Mitsuba in part smoke; default 512")
    parser.add_argument("--try-with", metavar="METHOD:KEY=A,B,C")
    parser.add_argument("--mitsuba-python", help="a Python with the packages mitsuba, pyoidn and numpy, for volpath")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    args.scenes = args.scenes or args.out / "scenes"
    run_parts(parser, args, PARTS, Experiments)


if __name__ == "__main__":
    sys.exit(main())
