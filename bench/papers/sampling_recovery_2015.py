#!/usr/bin/env python3
"""Repeats the experiments of Huo, Wang, Jin, Liu and Bao 2015 on scenes of our own making (make_occluded_scenes.py) or on others.

    bench/papers/sampling_recovery_2015.py OUT [scene.xml …] [--quick] [--parts table,steps,…]

  table     Table 1: all methods of the project swept by their budgets; error against time and against rays, and from these curves the time of every method at the
            error of sampling-recovery, and its error at the rays of it, with the seconds of the steps
  steps     Figure 8: sampling-recovery without prediction, without separation, without correction, and with the separation as printed
  rays      Figure 9: the error ratio that predictions are held to, and the splitting threshold alpha
  separation  Figure 6: how far the separation is after how many iterations
  clusters  Figure 3: light clusters without splitting, without sparse visibility, and with both

Errors are relative L1 against the sum of all columns, at the pixels of 4,096 stratified receivers of the full-size render unless --receivers says otherwise.
OUT gets index.html, tables.md, and the page of every comparison. What is finished with the same settings is not run again. --quick: small sizes, minutes
instead of hours; its numbers show that the script works and nothing else.
"""
import argparse
import hashlib
import json
import math
import pathlib
import subprocess
import sys

from experiment_page import Page, percent, plot

HERE = pathlib.Path(__file__).resolve().parent
OWN = ("courtyard", "fair", "room", "arcade")
OURS = "sampling-recovery"
# Budgets, from poor to good.
LADDERS = {
    "lightcuts": ("most-nodes", (100, 300, 1000)),
    "multidimensional-lightcuts": ("most-pairs", (60, 250, 1000, 4000)),
    "lightslice": ("columns", (50, 100, 300, 600)),
    "stochastic-lightcuts": ("nodes", (16, 64, 256)),
    "row-column-sampling": ("rows:columns", ("30:90", "100:300", "300:900", "600:2400")),
    "visibility-completion": ("columns", (100, 300, 600)),
    OURS: ("alpha", (0.08, 0.02, 0.005)),
}
STEPS = ("prediction", "separation", "correction", "constraint")


def at_level(curve, level, x, y):
    """Where a curve of runs, best first of its kind, reaches y = level: x there, by straight lines in logarithms; None outside of what was measured."""
    points = sorted((r[y], r[x]) for r in curve if r[y] > 0 and r[x] > 0)
    for (y0, x0), (y1, x1) in zip(points, points[1:]):
        if y0 <= level <= y1 and y1 > y0:
            t = math.log(level / y0) / math.log(y1 / y0)
            return math.exp(math.log(x0) + t * math.log(x1 / x0))
    return None


class Experiments:
    def __init__(self, args):
        self.args, self.out = args, args.out
        quick = args.quick
        self.size = args.size or ("80x60" if quick else "800x600")
        self.lights = args.lights or (10000 if quick else 1000000)
        self.receivers = args.receivers or (256 if quick else 4096)
        width, height = map(int, self.size.split("x"))
        self.pixels = width * height
        self.page = Page("Matrix sampling and recovery: the experiments of the 2015 paper", args.out)
        self.scenes = {f"{s.parent.name}/{s.stem}" if s.stem != "scene" else s.parent.name: s for s in args.scenes}
        if not self.scenes:
            folder = args.out / "scenes"
            needed = [s for s in OWN if not (folder / s / "scene.xml").exists()]
            if needed:
                subprocess.run([sys.executable, str(HERE / "make_occluded_scenes.py"), str(folder), *needed], check=True)
            self.scenes = {s: folder / s / "scene.xml" for s in OWN}
        listed = subprocess.run([str(args.program), "methods", "--json"], check=True, capture_output=True, text=True).stdout
        self.known = {m["name"] for m in json.loads(listed)}

    def compare(self, name, scene, methods, sweeps, more=()):
        """The runs of one comparison: label, method, seconds, rays per pixel, l1 and all that the trace tells."""
        command = ["compare", str(self.scenes[scene]), "--size", self.size, "--lights", str(self.lights), "--spp", "4", "--direct", "matrix",
                   "--reference", f"brute-force:{self.receivers}", "--methods", ",".join(methods), "--quiet", "--threads", str(self.args.threads), *more]
        for sweep in sweeps:
            command += ["--sweep", sweep]
        folder = self.out / "runs" / f"{name}_{scene.replace('/', '_')}"
        mark, stamp = folder / "asked", hashlib.sha256("\n".join(command).encode()).hexdigest()
        if not (mark.exists() and mark.read_text() == stamp):
            folder.mkdir(parents=True, exist_ok=True)
            print("$", self.args.program, *command, "-o", folder, flush=True)
            subprocess.run([str(self.args.program), *command, "-o", str(folder)], check=True)
            mark.write_text(stamp)
        runs = []
        for r in json.loads((folder / "results.json").read_text())["runs"]:
            runs.append({"label": r["label"], "series": r["series"], "method": r["method"], "seconds": r["seconds"], "rays": r["rays"] / self.pixels,
                         "l1": r["error"]["relative_l1"], "bias": r["error"]["bias"], "numbers": r["numbers"], "picture": folder / r["image"]})
        return runs

    def table(self):
        page = self.page
        page.heading("Table 1: equal quality and equal rays")
        page.say(f"{self.size}, 4 receivers per pixel, {self.lights} lights. Every method is swept by its budget; times and errors at the level of {OURS} are read off its curve "
                 "by straight lines in logarithms, and left open where the curve does not reach it.")
        methods = [m for m in LADDERS if m in self.known]
        for scene in self.scenes:
            runs = self.compare("table", scene, methods, [f"{m}.{key}=" + ",".join(map(str, values)) for m, (key, values) in LADDERS.items() if m in methods])
            curves = {m: [r for r in runs if r["method"] == m] for m in methods}
            page.heading(scene)
            page.table(("", "seconds", "rays per pixel", "relative L1", "bias", "sampling rate", "columns"),
                       [(r["label"], f"{r['seconds']:.2f}", f"{r['rays']:.0f}", percent(r["l1"]), percent(r["bias"]), percent(r["numbers"].get("sampling_rate", 1)),
                         f"{r['numbers'].get('columns', 0):.0f}") for r in runs])
            page.svg(plot(f"{scene}: error against time", "seconds", "relative L1, %", {m: sorted((r["seconds"], 100 * r["l1"]) for r in c) for m, c in curves.items()}))
            page.svg(plot(f"{scene}: error against rays", "rays per pixel", "relative L1, %", {m: sorted((r["rays"], 100 * r["l1"]) for r in c) for m, c in curves.items()}))
            if OURS in curves:
                for ours in curves[OURS]:
                    rows = []
                    for m in methods:
                        if m == OURS:
                            continue
                        seconds, rays = at_level(curves[m], ours["l1"], "seconds", "l1"), at_level(curves[m], ours["l1"], "rays", "l1")
                        error = at_level(curves[m], ours["rays"], "l1", "rays")
                        rows.append((m, f"{seconds:.2f}" if seconds else "–", f"{seconds / ours['seconds']:.2f}" if seconds else "–", f"{rays:.0f}" if rays else "–",
                                     percent(error) if error else "–"))
                    page.say(f"At the level of {ours['label']}: {percent(ours['l1'])}, {ours['seconds']:.2f} s, {ours['rays']:.0f} rays per pixel.")
                    page.table(("", "seconds at equal error", "times as long", "rays at equal error", "error at equal rays"), rows)
                    page.table(("step", "seconds of all cores", "share"), self.step_rows(ours))
            page.write()

    @staticmethod
    def step_rows(run):
        steps = {k[12:]: v for k, v in run["numbers"].items() if k.startswith("cpu_seconds.")}
        whole = sum(steps.values())
        return [(k, f"{v:.1f}", percent(v / whole)) for k, v in sorted(steps.items(), key=lambda s: -s[1])] if whole > 0 else []

    def switched(self, title, words, name, settings):
        """Runs of our method with single settings changed, scene by scene."""
        page = self.page
        page.heading(title)
        page.say(words)
        for scene in self.scenes:
            runs = self.compare(name, scene, [OURS], [f"{OURS}.{key}=" + ",".join(map(str, values)) for key, values in settings])
            page.table((scene, "relative L1", "bias", "rays per pixel", "sampling rate", "columns", "seconds"),
                       [(r["label"], percent(r["l1"]), percent(r["bias"]), f"{r['rays']:.1f}", percent(r["numbers"].get("sampling_rate", 1)),
                         f"{r['numbers'].get('columns', 0):.0f}", f"{r['seconds']:.2f}") for r in runs])
            page.write()

    def steps(self):
        self.switched("Figure 8: steps switched off", "Each row without one step; the first with all.", "steps", [("prediction", ("on",)), *((s, ("off",)) for s in STEPS)])

    def rays(self):
        self.switched("Figure 9: rays per pixel", "The error ratio that a predictor must keep on fresh samples, and the splitting threshold.", "rays",
                      [("prediction-error", (0.4, 0.2, 0.1, 0.05, 0.02)), ("alpha", (0.1, 0.04, 0.02, 0.01, 0.005))])

    def clusters(self):
        self.switched("Figure 3: light clusters", "Without splitting, without sparse visibility, with both.", "clusters",
                      [("splitting", ("off", "on")), ("sparse-visibility", ("off",))])

    def separation(self):
        self.switched("Figure 6: iterations of the separation", "The error of the whole after so many iterations at most.", "separation", [("iterations", (1, 2, 4, 8, 20))])


PARTS = {"table": Experiments.table, "steps": Experiments.steps, "rays": Experiments.rays, "separation": Experiments.separation, "clusters": Experiments.clusters}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=HERE.parents[1] / "build/release/lumirank")
    parser.add_argument("--parts", default=",".join(PARTS), help="which parts, in this order; default: all")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--size", help="default 800x600")
    parser.add_argument("--lights", type=int, help="default 1000000")
    parser.add_argument("--receivers", type=int, help="at which the truth is known; default 4096")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    wanted = args.parts.split(",")
    for part in wanted:
        if part not in PARTS:
            parser.error(f"there is no part {part}; the parts are {', '.join(PARTS)}")
    experiments = Experiments(args)
    for part in wanted:
        PARTS[part](experiments)
        experiments.page.write()
    print(f"wrote {args.out / 'index.html'}")


if __name__ == "__main__":
    sys.exit(main())
