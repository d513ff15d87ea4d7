#!/usr/bin/env python3
"""Repeats the experiments of Hašan, Křivánek, Walter and Bala 2009 on scenes of our own making (make_glossy_scenes.py).

    bench/papers/virtual_spherical_lights_2009.py OUT [--quick] [--parts table,columns,…]

  table     relative L2 on indirect light only: clamped diffuse VPL, glossy VPL with and without clamping, VSL, VSL with local compensation (section 4, Figures 6 and 7)
  columns   error against columns, and radius: error against the radius scale 0.5 … 16 and the automatic radius (Figure 8)
  cost      a VSL against a VPL at equal rays
  corner    corners of a diffuse box (Figure 4)
  cone      cone sampling alone against all three strategies (Figure 5)
  remedies  no clamping, glossy VPL, path-traced compensation of what clamping takes (Figure 2)
  time      error against seconds, also of the project's own path tracer
  fur       the 2007 paper's Figure 7: trees and a furry bunny (make_fur_and_trees.py)

All errors are relative L2 of indirect light against two independent path-traced references whose own noise cancels (experiment_page.Truth), with a 95 %
interval over image blocks. OUT gets index.html, tables.md, images/ and parts/. What is finished in parts/ with the same settings is not run again, so a
run that was cut short goes on where it was; the page shows the parts that were asked for. --quick: small sizes, minutes instead of hours; its numbers show that the script works and nothing else.
"""
import argparse
import json
import pathlib
import subprocess
import sys

from experiment_page import Page, Runs, Truth, percent, plot, read_pfm, run_parts

HERE = pathlib.Path(__file__).resolve().parent
GLOSSY = ("kitchen", "hall", "tableau")
PAPER = {"kitchen": ("94.6 %", "27.7 %"), "hall": ("96.7 %", "34.3 %"), "tableau": ("97.4 %", "17.5 %")}
CLAMPS = ("0.03", "0.1", "0.3")
VSL = ("--light-type", "sphere")
LOCAL = (*VSL, "--local-paths")
# As published: fixed scale, cosine as indicator, samples by the cone alone.
PAPER_VSL = (*VSL, "--sphere-indicator", "cosine", "--sphere-samples", "cone", "--radius-scale")


class Experiments:
    def __init__(self, args):
        self.args, self.out = args, args.out
        quick = args.quick
        self.size = args.size or ("80x60" if quick else "200x150")
        self.lights = args.lights or (10000 if quick else 200000)
        self.rows, self.columns = args.rows or (150 if quick else 900), args.columns or (500 if quick else 8000)
        self.spp = args.spp or ("4" if quick else "9")
        self.seconds = args.reference_seconds or (8 if quick else 480)
        self.runs = Runs(args.program, args.out, args.threads)
        self.page = Page("Virtual spherical lights: the experiments of the 2009 paper", args.out)
        self.truths = {}
        needed = [s for s in (*GLOSSY, "box", "glossy-box") if not (args.scenes / s / "scene.xml").exists()]
        if needed:
            subprocess.run([sys.executable, str(HERE / "make_glossy_scenes.py"), str(args.scenes), *needed], check=True)

    def scene(self, name):
        return self.args.scenes / name / "scene.xml"

    def truth(self, name, size=None, seconds=None):
        """Two references with seeds that no render uses."""
        key = (name, size)
        if key not in self.truths:
            made = [self.args.references / f"{name}_{k}.pfm" for k in "ab"] if self.args.references else []
            if made and all(f.exists() for f in made):
                pair = [(read_pfm(f), json.loads(f.with_suffix(".json").read_text())) for f in made]
            else:
                pair = [self.runs.run(f"reference_{name}_{seed}", "reference", self.scene(name),
                                      ["--only", "indirect", "--paths", "columns", "--size", size or self.size, "--time", seconds or self.seconds, "--seed", seed])
                        for seed in (90001, 90002)]
            self.truths[key] = Truth(pair[0][0], pair[1][0])
            self.truths[key].stated = [r["error.relative_l1"] for _, r in pair]
            self.truths[key].picture = (self.truths[key].width, self.truths[key].height, self.truths[key].mean)
        return self.truths[key]

    def render(self, name, label, arguments, rows=None, columns=None, only="indirect", size=None, lights=None, spp=None, seed=1):
        """Row-column sampling with given numbers, so that only the kind of light differs."""
        return self.runs.run(f"{name}_{label}", "render", self.scene(name),
                             ["--only", only, "--size", size or self.size, "--spp", spp or self.spp, "--lights", lights or self.lights, "--seed", seed,
                              "--method", "row-column-sampling", "--set", f"rows={rows or self.rows}", "--set", f"columns={columns or self.columns}", *arguments])

    def best_clamp(self, name, label, arguments, truth):
        """The clamping that suits the baseline best: the least error of a sweep."""
        tried = []
        for clamp in CLAMPS:
            picture, report = self.render(name, f"{label}_clamp_{clamp}", [*arguments, "--clamp", clamp])
            tried.append((truth.error(picture), clamp, picture, report))
        return min(tried, key=lambda t: t[0]["l2"])

    def row(self, label, error, report, extra=""):
        return (label, f"{percent(error['l2'])} ± {100 * error['l2_width']:.1f}", percent(error["bias"]), f"{report['seconds.total']:.1f}",
                f"{report['rays.shadow'] / 1e6:.0f}" if "rays.shadow" in report else "", extra)

    HEAD = ("", "relative L2", "bias", "seconds", "million rays", "")

    def table(self):
        page = self.page
        page.heading("Indirect light only: relative L2 against the path tracer")
        page.say(f"{self.size}, {self.spp} receivers per pixel, {self.lights} lights, {self.rows} rows, {self.columns} columns. The clamping of the baselines is the best of "
                 f"{', '.join(CLAMPS)}. Pictures of one scene have one exposure; differences are white at twice the mean.")
        summary = []
        for name in GLOSSY:
            truth = self.truth(name)
            rows, shown = [], []
            e, clamp, picture, report = self.best_clamp(name, "diffuse_vpl", ["--light-type", "diffuse-point"], truth)
            rows.append(self.row(f"diffuse VPL, clamped ({clamp})", e, report, f"clamping took {percent(report['clamp.removed_fraction'])}"))
            shown.append(("VPL", picture, e))
            clamped = e
            e, clamp, picture, report = self.best_clamp(name, "glossy_vpl", [], truth)
            rows.append(self.row(f"glossy VPL, clamped ({clamp})", e, report, f"clamping took {percent(report['clamp.removed_fraction'])}"))
            glossy = e
            picture, report = self.render(name, "glossy_vpl_free", ["--clamp", "0"])
            e = truth.error(picture)
            rows.append(self.row("glossy VPL, no clamping", e, report))
            free = e
            picture, report = self.render(name, "vsl_paper", [*PAPER_VSL, "8"])
            published = truth.error(picture)
            rows.append(self.row("VSL as published, radius scale 8", published, report))
            picture, report = self.render(name, "vsl", VSL)
            e = truth.error(picture)
            rows.append(self.row("VSL", e, report))
            shown.append(("VSL", picture, e))
            vsl = e
            picture, report = self.render(name, "vsl_local", [*LOCAL, "64"])
            e = truth.error(picture)
            rows.append(self.row("VSL, local compensation with 64 paths per receiver", e, report))
            shown.append(("VSL with local paths", picture, e))
            page.heading(name)
            page.say("Stated errors (relative L1) of the two references: " + ", ".join(percent(s) for s in truth.stated) + ".")
            page.table(self.HEAD, rows)
            page.picture(f"{name}_reference", truth.picture, truth.exposure, "path traced")
            for label, picture, error in shown:
                page.picture(f"{name}_{label.replace(' ', '_')}", picture, truth.exposure, f"{label}, relative L2 {percent(error['l2'])}")
                page.difference(f"{name}_{label.replace(' ', '_')}_difference", truth, picture, f"{label}: difference")
            summary.append((name, percent(clamped["l2"]), percent(glossy["l2"]), percent(free["l2"]), percent(published["l2"]), percent(vsl["l2"]), percent(e["l2"]), *PAPER[name]))
            self.page.write()
        page.heading("In short")
        page.table(("scene", "diffuse VPL, clamped", "glossy VPL, clamped", "glossy VPL, free", "VSL as published", "VSL", "VSL, local compensation", "paper: VPL", "paper: VSL"), summary)

    def columns_and_radius(self):
        page = self.page
        page.heading("Figure 8: error against columns and against the radius")
        counts = (100, 200, 400, 800) if self.args.quick else [round(self.columns * f) for f in (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2)]
        curves, table = {}, []
        for name in GLOSSY:
            truth = self.truth(name)
            curve = []
            for c in counts:
                picture, report = self.render(name, f"vsl_columns_{c}", VSL, columns=c)
                e = truth.error(picture)
                curve.append((c, 100 * e["l2"]))
                table.append((name, c, percent(e["l2"]), percent(e["bias"]), f"{report['seconds.total']:.1f}"))
            curves[name] = curve
        page.table(("scene", "columns", "relative L2", "bias", "seconds"), table)
        page.svg(plot("Error against columns", "columns", "relative L2, %", curves))
        scales = ("0.5", "1", "2", "4", "8", "16")
        curves, table = {}, []
        for name in GLOSSY:
            truth = self.truth(name)
            curve = []
            for s in scales:
                picture, _ = self.render(name, f"vsl_radius_{s}", [*VSL, "--radius-scale", s])
                e = truth.error(picture)
                curve.append((float(s), 100 * e["l2"]))
                table.append((name, s, f"{percent(e['l2'])} ± {100 * e['l2_width']:.1f}", percent(e["bias"])))
            picture, _ = self.render(name, "vsl", VSL)
            e = truth.error(picture)
            curves[name] = curve
            curves[f"{name}, automatic"] = [(0, 100 * e["l2"])]
            table.append((name, "automatic", f"{percent(e['l2'])} ± {100 * e['l2_width']:.1f}", percent(e["bias"])))
        page.table(("scene", "radius scale", "relative L2", "bias"), table)
        page.svg(plot("Error against the radius scale", "radius scale", "relative L2, %", curves, log_x=True))

    def cost(self):
        page = self.page
        page.heading("What a VSL costs over a VPL at equal rays")
        page.say("The same rows, columns, lights and receivers; seconds of the columns alone, per million rays. The paper: 16 % in the kitchen.")
        table = []
        for name in GLOSSY:
            times = {}
            for label, arguments in (("diffuse VPL", ["--light-type", "diffuse-point"]), ("glossy VPL", []), ("VSL", VSL)):
                # Three times each, the fastest counts: the machine may be busy.
                reports = [self.render(name, f"cost_{label.replace(' ', '_')}_{k}", [*arguments, "--method-seed", k], columns=max(200, self.columns // 8))[1] for k in (1, 2, 3)]
                times[label] = min(r["seconds.columns"] / (r["rays.shadow"] / 1e6) for r in reports)
            table.append((name, *(f"{1000 * t:.1f} ms" for t in times.values()), f"{100 * (times['VSL'] / times['diffuse VPL'] - 1):+.0f} %",
                          f"{100 * (times['VSL'] / times['glossy VPL'] - 1):+.0f} %"))
        page.table(("scene", "diffuse VPL", "glossy VPL", "VSL", "VSL over diffuse VPL", "VSL over glossy VPL"), table)

    def corner(self):
        page = self.page
        size = "64x64" if self.args.quick else "128x128"
        truth = self.truth("box", size, 6 if self.args.quick else 120)
        size = f"{truth.width}x{truth.height}"
        page.heading("Figure 4: corners of a diffuse box, indirect light only")
        # Few lights, as far apart as in the paper's figure; of the published radii the best.
        common = ["--only", "indirect", "--size", size, "--spp", 4, "--lights", 2000, "--method", "brute-force"]
        rows, profiles = [], {"path traced": self.profile(truth.picture)}
        page.picture("box_reference", truth.picture, truth.exposure, "path traced")
        tries = (("VPL, clamped", "vpl", [["--clamp", c] for c in ("0.03", "0.3", "1")]),
                 ("VSL as published", "vsl_paper", [[*PAPER_VSL, s] for s in ("0.5", "1", "2", "4")]), ("VSL", "vsl", [VSL]), ("VSL, local compensation", "vsl_local", [[*LOCAL, "64"]]))
        for label, file, choices in tries:
            done = []
            for arguments in choices:
                picture, report = self.runs.run(f"box_{file}_{arguments[-1]}", "render", self.scene("box"), [*common, *arguments])
                done.append((truth.error(picture), arguments[-1], picture, report))
            e, value, picture, report = min(done, key=lambda d: d[0]["l2"])
            rows.append(self.row(f"{label} ({value})" if len(choices) > 1 else label, e, report))
            profiles[label] = self.profile(picture)
            page.picture(f"box_{file}", picture, truth.exposure, f"{label}, relative L2 {percent(e['l2'])}")
        page.table(self.HEAD, rows)
        page.svg(plot("Back wall, from the left corner to the middle", "pixels from the left edge of the picture", "radiance", profiles, log_x=False, log_y=False))

    @staticmethod
    def profile(image):
        """Mean of the channels along the back wall above the blocks, over a band of rows."""
        width, height, v = image
        rows = range(round(0.3 * height), round(0.36 * height) + 1)
        return [(x, sum(v[3 * (y * width + x) + c] for y in rows for c in range(3)) / (3 * len(rows))) for x in range(round(0.08 * width), round(0.5 * width))]

    def cone(self):
        page = self.page
        page.heading("Figure 5: the cone alone against all three strategies")
        page.say("A few virtual lights with a large radius on the left wall of a box whose surfaces have a glossy component of alpha 0.03. The deviation is from the "
                 "same lights seen by 64 receivers per pixel with all strategies.")
        size = "64x64" if self.args.quick else "160x160"
        base = ["--only", "indirect", "--size", size, "--spp", 1, "--lights", 8, "--method", "brute-force", *VSL, "--radius-scale", "15", "--sphere-samples", "cone"]
        at = base.index("--spp") + 1
        many, _ = self.runs.run("cone_mean", "render", self.scene("glossy-box"), [*base[:at], 64, *base[at + 1:]])
        level = sum(many[2]) / len(many[2])
        for strategies in ("cone", "all"):
            picture, report = self.runs.run(f"cone_{strategies}", "render", self.scene("glossy-box"), [*base, "--sphere-strategies", strategies])
            deviation = sum(abs(a - b) for a, b in zip(picture[2], many[2])) / len(many[2]) / level
            page.picture(f"cone_{strategies}", picture, 0.25 / level, f"strategies: {strategies}; relative L1 deviation {percent(deviation)}, {report['seconds.method']:.2f} s")
        page.picture("cone_mean", many, 0.25 / level, "64 receivers per pixel")

    def remedies(self):
        page = self.page
        page.heading("Figure 2: other remedies, kitchen")
        truth = self.truth("kitchen")
        rows = []
        shown = [("VPL, clamped", ["--light-type", "diffuse-point", "--clamp", "0.03"]), ("no clamping", ["--light-type", "diffuse-point", "--clamp", "0"]),
                 ("glossy VPL, clamped", ["--clamp", "0.03"]), ("glossy VPL, no clamping", ["--clamp", "0"])]
        paths = (4, 16) if self.args.quick else (16, 64, 256, 1024)
        shown += [(f"glossy VPL, clamped, and compensated with {n} paths per pixel", ["--clamp", "0.03", "--compensate", n]) for n in paths]
        shown += [("VSL", VSL)]
        for k, (label, arguments) in enumerate(shown):
            picture, report = self.render("kitchen", f"remedy_{k}", arguments)
            e = truth.error(picture)
            rows.append(self.row(label, e, report))
            page.picture(f"remedy_{k}", picture, truth.exposure, f"{label}: {percent(e['l2'])}, {report['seconds.total']:.0f} s")
        page.table(self.HEAD, rows)

    def time(self):
        page = self.page
        page.heading("Error against seconds, also of the path tracer")
        # Rows, columns and, for local compensation, paths.
        ladder = ((50, 100, 4), (75, 200, 8), (150, 400, 16)) if self.args.quick else ((100, 300, 4), (200, 1000, 16), (400, 2500, 48), (900, 8000, 128))
        budgets = (1, 2, 4) if self.args.quick else (4, 10, 25, 60)
        for name in GLOSSY:
            truth = self.truth(name)
            curves, table = {"VSL": [], "VSL, local paths": [], "glossy VPL, clamped": [], "path tracer": []}, []
            for label, file, arguments in (("VSL", "vsl", VSL), ("VSL, local paths", "local", LOCAL), ("glossy VPL, clamped", "vpl", ["--clamp", "0.03"])):
                for r, c, paths in ladder:
                    picture, report = self.render(name, f"time_{file}_{c}", [*arguments, paths] if arguments is LOCAL else arguments, rows=r, columns=c)
                    e = truth.error(picture)
                    curves[label].append((report["seconds.total"], 100 * e["l2"]))
                    table.append((label, f"{r} rows, {c} columns", f"{report['seconds.total']:.1f}", percent(e["l2"]), percent(e["l1"])))
            for s in budgets:
                picture, report = self.runs.run(f"{name}_time_path_{s}", "reference", self.scene(name),
                                                ["--only", "indirect", "--paths", "columns", "--size", self.size, "--time", s, "--seed", 7])
                e = truth.error(picture)
                curves["path tracer"].append((report["seconds.total"], 100 * e["l2"]))
                table.append(("path tracer", f"{report['spp']} paths per pixel", f"{report['seconds.total']:.1f}", percent(e["l2"]), percent(e["l1"])))
            page.table((name, "", "seconds", "relative L2", "relative L1"), table)
            page.svg(plot(name, "seconds", "relative L2, %", curves))
            self.page.write()

    def fur(self):
        page = self.page
        page.heading("The 2007 paper's Figure 7: trees and a furry bunny")
        page.say("Point lights; the truth is the sum of all columns.")
        needed = [s for s in ("trees", "fur") if not self.scene(s).exists()]
        if needed:
            subprocess.run([sys.executable, str(HERE / "make_fur_and_trees.py"), str(self.args.scenes), *needed], check=True)
        table = []
        common = ["--size", self.size, "--spp", 4, "--lights", min(self.lights, 20000)]
        for name in ("trees", "fur"):
            truth, report = self.runs.run(f"{name}_all", "render", self.scene(name), [*common, "--method", "brute-force"])
            level = sum(truth[2]) / len(truth[2])
            page.picture(f"{name}_all", truth, 0.25 / level, f"{name}: all {report['virtual_lights']} columns, {report['seconds.total']:.0f} s")
            for r, c in ((100, 300), (300, 900), (600, 1800)):
                picture, report = self.runs.run(f"{name}_{c}", "render", self.scene(name),
                                                [*common, "--method", "row-column-sampling", "--set", f"rows={r}", "--set", f"columns={c}"])
                l1 = sum(abs(a - b) for a, b in zip(picture[2], truth[2])) / sum(truth[2])
                l2 = (sum((a - b) ** 2 for a, b in zip(picture[2], truth[2])) / sum(b * b for b in truth[2])) ** 0.5
                table.append((name, f"{r} rows, {c} columns", f"{report['seconds.total']:.1f}", percent(l1), percent(l2)))
            page.picture(f"{name}_sampled", picture, 0.25 / level, f"{name}: {r} rows, {c} columns")
        page.table(("scene", "", "seconds", "relative L1 against all columns", "relative L2"), table)


PARTS = {"table": Experiments.table, "columns": Experiments.columns_and_radius, "cost": Experiments.cost, "corner": Experiments.corner, "cone": Experiments.cone,
         "remedies": Experiments.remedies, "time": Experiments.time, "fur": Experiments.fur}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=HERE.parents[1] / "build/release/lumirank")
    parser.add_argument("--scenes", type=pathlib.Path, help="folder of the generated scenes; default: OUT/scenes")
    parser.add_argument("--parts", default=",".join(PARTS), help="which parts, in this order; default: all")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--size", help="default 200x150")
    parser.add_argument("--lights", type=int, help="default 200000")
    parser.add_argument("--rows", type=int, help="default 900")
    parser.add_argument("--columns", type=int, help="default 8000; Figure 8 goes from a sixteenth of them to twice as many")
    parser.add_argument("--spp", help="receivers per pixel; default 9")
    parser.add_argument("--reference-seconds", type=float, help="of each of the two references; default 480")
    parser.add_argument("--references", type=pathlib.Path, help="folder of finished references: SCENE_a.pfm and SCENE_b.pfm, of different seeds, each with its report beside it")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    args.scenes = args.scenes or args.out / "scenes"
    run_parts(parser, args, PARTS, Experiments)


if __name__ == "__main__":
    sys.exit(main())
