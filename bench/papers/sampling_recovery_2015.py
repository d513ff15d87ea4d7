#!/usr/bin/env python3
"""Repeats the experiments of Huo, Wang, Jin, Liu and Bao 2015 on scenes of our own making (make_occluded_scenes.py) or on others.

    bench/papers/sampling_recovery_2015.py OUT [scene.xml …] [--quick] [--parts table,steps,…]

  table     Table 1: all methods of the project swept by their budgets; error against time and against rays, and from these curves the time of every method at the
            error of sampling-recovery, and its error at the rays of it, with the seconds of the steps
  steps     Figure 8: sampling-recovery without prediction, without separation, without correction, and with the separation as printed
  rays      Figure 9: the error ratio that predictions are held to, and the splitting threshold alpha
  separation  Figure 6: how far the separation is after how many iterations
  predictors  Figures 4 and 5: how often each predictor is wrong, and which is chosen, slice by slice
  matrices  Figure 7: the matrices of two slices, step by step
  clusters  Figure 3: light clusters without splitting, without sparse visibility, and with both

Errors are relative L1 against the sum of all columns, at the pixels of 4,096 stratified receivers of the full-size render unless --receivers says otherwise.
Parts separation, predictors and matrices need bench/inspect_recovery.cpp (cmake -DLUMIRANK_BENCH=ON), which asks for all visibilities of the reduced matrices;
its size and lights are smaller: --inspect-size and --inspect-lights.
OUT gets index.html, tables.md, and the page of every comparison. What is finished with the same settings is not run again. --quick: small sizes, minutes
instead of hours; its numbers show that the script works and nothing else.
"""
import argparse
import functools
import hashlib
import json
import math
import pathlib
import subprocess
import sys

from experiment_page import Page, at_level, bars, best, percent, plot, read_pfm, run_parts, to_display

HERE = pathlib.Path(__file__).resolve().parent
OWN = ("courtyard", "fair", "room", "arcade")
OURS = "sampling-recovery"
TRACED = "slice-cuts"
# Budgets, from poor to good: parameters, values. LightSlice's slices are swept with its columns, since at a million lights most of its time goes into
# reading rows and clustering for each slice. slice-cuts has the
# clusters of sampling-recovery and all their visibilities, one for each surface of a pixel.
LADDERS = {
    "lightcuts": ("max-nodes", (100, 300, 1000)),
    "multidimensional-lightcuts": ("max-pairs", (60, 250, 500, 1000)),
    "lightslice": ("columns:slice-rows:neighbors", ("100:16384:8", "200:16384:8", "200:8192:8", "400:8192:8", "800:8192:8", "400:4096:16")),
    "stochastic-lightcuts": ("nodes", (8, 16, 64)),
    "row-column-sampling": ("rows:columns", ("30:90", "100:300", "300:900", "600:2400")),
    "visibility-completion": ("columns:slice-rows:neighbors", ("100:16384:8", "300:16384:8", "300:8192:8", "600:8192:8")),
    "power-sampling": ("columns", (100, 300, 1000)),
    "instant-radiosity": ("lights", (100, 300, 1000)),
    OURS: ("initial-columns:alpha", ("100:0.02", "250:0.008", "500:0.003", "1000:0.001")),
    TRACED: ("initial-columns:alpha", ("100:0.02", "250:0.008", "500:0.003", "1000:0.001")),
}
PREDICTORS = {"nearest": "Nearest samples", "plane": "Plane", "bayes": "Naive Bayes", "all": "Best of the three"}
SAMPLED = (("guessed", (20, 20, 30)), ("sampled", (235, 235, 220)), ("uncertain", (250, 170, 40)), ("corrected", (225, 50, 60)))
STEPS = ("prediction", "calibration", "separation", "correction", "constraint")


def exposure(values):
    """Takes the median to a third of the range: a window may be a hundred times brighter than the room."""
    middle = sorted(values)[len(values) // 2]
    return 0.1 / middle if middle > 0 else 1.0


class Experiments:
    def __init__(self, args):
        self.args, self.out = args, args.out
        quick = args.quick
        self.size = args.size or ("80x60" if quick else "800x600")
        self.lights = args.lights or (10000 if quick else 1000000)
        self.receivers = args.receivers or (256 if quick else 4096)
        width, height = map(int, self.size.split("x"))
        self.pixels = width * height
        self.inspect_size = args.inspect_size or ("100x75" if quick else "400x300")
        self.inspect_lights = args.inspect_lights or (5000 if quick else 20000)
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
                 "by straight lines in logarithms, and left open where the curve does not reach it. Curves are the best of each method's runs: none that another beats in both.")
        ladders = {m: ladder for m, ladder in LADDERS.items() if m in self.known}
        for scene in self.scenes:
            runs = self.compare("table", scene, list(ladders), [f"{m}.{key}=" + ",".join(map(str, values)) for m, (key, values) in ladders.items()])
            curves = {m: [r for r in runs if r["method"] == m] for m in ladders}
            page.heading(scene)
            page.table(("", "seconds", "rays per pixel", "relative L1", "bias", "sampling rate", "columns"),
                       [(r["label"], f"{r['seconds']:.2f}", f"{r['rays']:.0f}", percent(r["l1"]), percent(r["bias"]), percent(r["numbers"].get("sampling_rate", 1)),
                         f"{r['numbers'].get('columns', 0):.0f}") for r in runs])
            page.svg(plot(f"{scene}: error against time", "seconds", "relative L1, %", {m: [(x, 100 * y) for x, y in best(c, "seconds", "l1")] for m, c in curves.items()}))
            page.svg(plot(f"{scene}: error against rays", "rays per pixel", "relative L1, %", {m: [(x, 100 * y) for x, y in best(c, "rays", "l1")] for m, c in curves.items()}))
            for own in (OURS, TRACED):
                for ours in curves[own]:
                    rows = []
                    for m in curves:
                        if m == own:
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

    def switched(self, title, words, name, settings, beside=()):
        """Runs of our method with single settings changed, scene by scene; other methods as they are beside it."""
        page = self.page
        page.heading(title)
        page.say(words)
        for scene in self.scenes:
            runs = self.compare(name, scene, [OURS, *beside], [f"{OURS}.{key}=" + ",".join(map(str, values)) for key, values in settings])
            page.table((scene, "relative L1", "bias", "rays per pixel", "sampling rate", "columns", "seconds"),
                       [(r["label"], percent(r["l1"]), percent(r["bias"]), f"{r['rays']:.1f}", percent(r["numbers"].get("sampling_rate", 1)),
                         f"{r['numbers'].get('columns', 0):.0f}", f"{r['seconds']:.2f}") for r in runs])
            page.write()

    def steps(self):
        self.switched("Figure 8: steps switched off", "Each row without one step; the first with all, slice-cuts knows all visibilities, which is what recovery could reach at best.", "steps",
                      [("prediction", ("on",)), *((s, ("off",)) for s in STEPS)], (TRACED,))

    def rays(self):
        self.switched("Figure 9: rays per pixel", "The error ratio that a predictor must keep on fresh samples, and the splitting threshold.", "rays",
                      [("prediction-error", (0.4, 0.2, 0.1, 0.05, 0.02)), ("alpha", (0.1, 0.04, 0.02, 0.01, 0.005))])

    def clusters(self):
        self.switched("Figure 3: light clusters", "Without splitting, without sparse visibility, with both.", "clusters",
                      [("splitting", ("off", "on")), ("sparse-visibility", ("off",))])

    def inspect(self, scene):
        """What inspect_recovery finds, and the folder of its pictures."""
        folder = self.out / "runs" / f"inspect_{scene.replace('/', '_')}"
        command = ["--size", self.inspect_size, "--lights", str(self.inspect_lights), "--spp", "4"]
        mark, stamp = folder / "asked", hashlib.sha256("\n".join([str(self.scenes[scene]), *command]).encode()).hexdigest()
        if not (mark.exists() and mark.read_text() == stamp):
            folder.mkdir(parents=True, exist_ok=True)
            line = [str(self.args.inspector), str(self.scenes[scene]), str(folder), *command, "--threads", str(self.args.threads)]
            print("$", *line, flush=True)
            subprocess.run(line, check=True)
            mark.write_text(stamp)
        return json.loads((folder / "results.json").read_text()), folder

    def inspected(self, found):
        slices = found["per_slice"]
        return (f"{self.inspect_size}, {found['receivers']} receivers in {len(slices)} slices, {found['lights']} lights, "
                f"{found['sums']['columns'] / len(slices):.0f} columns per slice; {percent(found['sums']['hidden'] / found['sums']['entries'])} of the entries that light could reach are hidden.")

    def predictors(self):
        page = self.page
        page.heading("Figures 4 and 5: predictors")
        page.say("The share of wrong predictions among the entries that were not sampled, against all visibilities of the reduced matrices. Predictions are drawn by their probability, as the "
                 "method does. Predictors stand alone: nothing is separated, corrected or sampled for being uncertain.")
        for scene in self.scenes:
            found, folder = self.inspect(scene)
            name = "inspect_" + scene.replace("/", "_")
            page.heading(scene)
            page.say(self.inspected(found))
            image = read_pfm(folder / "image.pfm")
            page.picture(f"{name}_image", image, exposure(image[2]), "What the method renders")
            pictures = {p: read_pfm(folder / f"wrong_{p}.pfm") for p in PREDICTORS}
            high = 0.05 * math.ceil(20 * max(max(p[2]) for p in pictures.values()))
            for p, words in PREDICTORS.items():
                figures = found["predictors"][f"wrong_{p}"]
                page.scaled(f"{name}_wrong_{p}", pictures[p], 0, high, f"{words}: {percent(figures['wrong'])} wrong after sampling {percent(figures['sampled'])}", nothing=lambda v: v < 0, label=percent)
            choice = read_pfm(folder / "choice.pfm")
            page.raw(f"{name}_choice", choice[0], choice[1], bytes(112 if v < 0 else min(255, round(255 * v)) for v in choice[2]),
                     "Columns by the predictor chosen: red nearest samples, green Bayes, blue plane")
            for channel, words in ((2, "the plane"), (1, "Bayes")):
                share = choice[2][channel::3]
                page.scaled(f"{name}_choice_{channel}", (choice[0], choice[1], [v for v in share for _ in range(3)]), 0, max(0.05, 0.05 * math.ceil(20 * max(share))),
                            f"Share of the columns that chose {words}", nothing=lambda v: v < 0, label=percent)
            page.scaled(f"{name}_mixed", read_pfm(folder / "mixed.pfm"), 0, 0.5, "How mixed columns are: the share of the rarer of visible and hidden, mean over columns", nothing=lambda v: v < 0, label=percent)
            rows = []
            for equal, until in (("", "until the prediction error is met"), ("equal_", "after five rounds")):
                for p, words in PREDICTORS.items():
                    figures = found["predictors"][f"wrong_{equal}{p}"]
                    rows.append((f"{words}, {until}", percent(figures["wrong"]), percent(figures["wrong_light"]), percent(figures["sampled"]), "" if p == "all" else percent(figures["best_in_slices"]),
                                 "" if equal else percent(figures["failed_columns"]), " / ".join(percent(figures["columns"][c]) for c in ("nearest", "plane", "bayes")) if p == "all" else ""))
            page.table(("", "wrong", "weighted by light", "sampled", "best of the three in slices", "columns that failed", "tested columns: nearest / plane / Bayes"), rows)
            page.say(f"Columns that reach too few rows to be tested ({percent(1 - found['predictors']['wrong_all']['tested_columns'])}) are not counted among those that chose.")
            page.write()

    def matrices(self):
        page = self.page
        page.heading("Figure 7: matrices of two slices")
        page.say("Columns along the light tree, rows along Hilbert's curve through the slice; gray where the light does not reach (E = 0). The slices stand at 25 % and 90 % of all by how mixed "
                 "their columns are. What is separated is visibility, 0 or 1.")
        for scene in self.scenes:
            found, folder = self.inspect(scene)
            stem = "inspect_" + scene.replace("/", "_")
            page.heading(scene)
            page.say(self.inspected(found))
            width, height, values = read_pfm(folder / "image.pfm")
            shown = bytearray(to_display(values, exposure(values)))
            for which, tint in (("few", (230, 40, 40)), ("many", (50, 90, 255))):
                for k, v in enumerate(read_pfm(folder / f"{which}_where.pfm")[2]):
                    shown[k] = round(shown[k] + 0.6 * v * (tint[k % 3] - shown[k]))
            page.raw(f"{stem}_slices", width, height, bytes(shown), "Where the two slices are: red few differences, blue many")
            for which, words in (("few", "Few differences"), ("many", "Many differences")):
                figures, name = found[which], f"{stem}_{which}"
                page.say(f"{words}: {figures['rows']} × {figures['columns']}, {percent(figures['hidden'])} hidden, rank {figures['rank']:.0f}, {figures['iterations']:.0f} iterations; sampled {percent(figures['sampled'])} "
                         f"for prediction, {percent(figures['uncertain'])} where a guess would cost much, {percent(figures['corrected'])} by correction; Z is above half an entry at {percent(figures['nonzero'])}. "
                         f"Row sums are off by {percent(figures['error_drawn'])} as predicted, {percent(figures['error_separated'])} as separated, {percent(figures['error_final'])} with correction.")
                read = lambda what: read_pfm(folder / f"{which}_{what}.pfm")
                paint = functools.partial(page.scaled, shown=270)
                paint(f"{name}_predicted", read("predicted"), 0, 1, "(a) D: sampled or predicted")
                page.codes(f"{name}_sampled", read("sampled"), SAMPLED, "(b) What was sampled", shown=270)
                paint(f"{name}_low_rank", read("low_rank"), 0, 1, "(c) L = X·Y, held to 0 … 1 in the picture")
                paint(f"{name}_sparse", read("sparse"), -1, 1, "(d) Z", signed=True)
                paint(f"{name}_density", read("density"), 0, 1, "(e) Density of errors")
                paint(f"{name}_recovered", read("recovered"), 0, 1, "(f) Recovered visibility")
                paint(f"{name}_error", read("error"), -1, 1, "(g) Recovered less true", signed=True)
                paint(f"{name}_reference", read("reference"), 0, 1, "(h) True visibility")
                light, recovered, error = read("light_reference"), read("light_recovered"), read("light_error")
                seen = sorted(v for v in light[2][::3] if v > 0)
                white = seen[int(0.98 * (len(seen) - 1))] if seen else 1.0
                paint(f"{name}_light_reference", light, 0, white, "True contributions E·V; white: the 98th percentile", label="{:.2g}".format)
                paint(f"{name}_light_recovered", recovered, 0, white, "Recovered contributions", label="{:.2g}".format)
                paint(f"{name}_light_error", error, -white, white, "Recovered less true contributions", signed=True, label="{:.2g}".format)
            curves = {}
            for which in ("few", "many"):
                for what, words in (("visibility", "V"), ("light", "E·V")):
                    values = found[which]["singular_values"][what]
                    curves[f"{which}, {words}"] = [(k + 1, v / values[0]) for k, v in enumerate(values[:400]) if v > 1e-5 * values[0]]
            page.svg(plot(f"{scene}: (i) singular values of the reference", "number", "share of the first", curves, log_x=False))
            rows = []
            for which in ("few", "many"):
                for what in ("visibility", "light", "unoccluded"):
                    values = found[which]["singular_values"][what]
                    squares = [v * v for v in values]
                    whole, rank = sum(squares), found[which]["rank"]
                    beyond = [sum(squares[k:]) / whole for k in (int(rank), 50, 100)]
                    rows.append((f"{which}, {what}", sum(v > 0.01 * values[0] for v in values), *(percent(math.sqrt(b)) for b in beyond)))
            page.table(("", "values above 1 % of the first", "Frobenius norm beyond the rank used", "beyond 50", "beyond 100"), rows)
            page.write()

    def separation(self):
        page = self.page
        page.heading("Figure 6: convergence of the separation")
        page.say("Slices by the number of iterations after which the separation stops, and the mean of ‖XY + Z − D‖ / ‖D‖ after each iteration were it not to stop. As the method is set, predictions are fitted too, and "
                 "entries that were sampled have no Z: these alone are mostly of a higher rank, so that no X·Y meets them and the residual cannot vanish. As the paper prints it (equations 6 and 11) only what was "
                 "sampled is fitted, and may have a Z. The rule stops below 1 %, or from the fourth iteration on when one brings less than 10 % of what is left.")
        for scene in self.scenes:
            found, _ = self.inspect(scene)
            c = found["convergence"]
            pick = lambda r: [(k + 1, v) for k, v in enumerate(r)]
            page.svg(bars(f"{scene}: {c['slices']:.0f} slices", "iterations", "slices", {"fit of all": c["slices_by_iterations"], "as printed": c["slices_by_iterations_as_printed"]},
                          {"residual, fit of all": pick(c["residual_without_stopping"]), "residual, as printed": pick(c["residual_as_printed"]),
                           "of all, Z everywhere": pick(c["residual_with_sparse_everywhere"])}))
            rows = []
            for words, stopped, residual in (("fit of all", "slices_by_iterations", "residual_without_stopping"), ("as printed", "slices_by_iterations_as_printed", "residual_as_printed"),
                                            ("fit of all, Z everywhere", None, "residual_with_sparse_everywhere")):
                by = lambda n: "" if stopped is None else percent(sum(c[stopped][:n + 1]) / max(c["slices"], 1))
                rows.append((words, by(4), by(10), *(percent(c[residual][k - 1]) for k in (1, 4, 10, 20))))
            page.table((scene, "stopped by 4", "by 10", "residual after 1", "after 4", "after 10", "after 20"), rows)
            sums = found["sums"]
            off = lambda step: f"{percent(sums['error_' + step] / sums['light'])} (bias {percent(sums['bias_' + step] / sums['light'])})"
            page.say(f"Row sums over all slices are off by {off('drawn')} as predicted, {off('separated')} as separated, {off('final')} with correction; "
                     f"guesses are wrong by {percent(found['guesses_drawn']['wrong'])} as predicted and by {percent(found['guesses_separated']['wrong'])} "
                     f"on average as separated. Mean rank {sums['rank'] / len(found['per_slice']):.1f}; Z is above half an entry at {percent(sums['nonzero'] / sums['entries'])} of the entries; "
                     f"correction samples {percent(sums['corrected'] / sums['entries'])}.")
            page.write()
        self.switched("Figure 6: the whole method by iterations", "The error of the picture after so many iterations at most.", "separation", [("iterations", (1, 2, 4, 8, 20))])


PARTS = {"table": Experiments.table, "steps": Experiments.steps, "rays": Experiments.rays, "separation": Experiments.separation,
         "predictors": Experiments.predictors, "matrices": Experiments.matrices, "clusters": Experiments.clusters}


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
    parser.add_argument("--inspector", type=pathlib.Path, default=HERE.parents[1] / "build/release/bench/inspect_recovery")
    parser.add_argument("--inspect-size", help="of the parts that inspect; default 400x300")
    parser.add_argument("--inspect-lights", type=int, help="default 20000")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    run_parts(parser, args, PARTS, Experiments)


if __name__ == "__main__":
    sys.exit(main())
