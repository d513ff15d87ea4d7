#!/usr/bin/env python3
"""Repeats the experiments of Hašan, Velázquez-Armendáriz, Pellacini and Bala 2008 on shots of our own making (make_animated_scenes.py) or on others.

    bench/papers/tensor_clustering_2008.py OUT [temple room cloth stage fur forest | scene.xml …] [--quick] [--parts table,frames,…] [--mitsuba-python PYTHON]

  table     Table 2: seconds of each stage, shadow rays, brute force (from scanlines), their ratio; relative L2 against all columns
  frames    error and flicker of every frame at equal time: tensor clustering, row-column sampling and slice-cuts frame by frame, and Mitsuba 3's path tracer, denoised
  clusters  how many clusters act in each frame, and Figure 3: lights × frames in the colors of the clusters
  pictures  contact sheets, a scanline through time, and videos where there is ffmpeg

The truth is known on some scanlines, evenly spaced over the picture (--lines): there all columns are summed in every frame (--set columns=0: of the very lights that are
clustered), so the pictures can be larger than brute force would allow. What is rendered frame by frame has the same lights in every frame too (--light-placement gather), planned for
the whole motion instead of a chunk: it is measured against all of those as well as against the chunk's. The denoised path tracer carries all paths and is filtered over pixels:
it is measured against itself converged, and against the chunk's truth too. Flicker: mean over frames of ‖(I′ − I) − (R′ − R)‖ / ‖R‖.
The path tracer's truth comes in two independent halves, so that its own noise counts neither as error nor as flicker.
Table 2 has few columns (--columns), what is compared at equal time more (--equal-columns).
Equal time: seconds of tensor clustering's whole process, loading and writing included, divided by the frames; the others' settings are found by trials on two frames and
put right once by the whole shot.
OUT gets index.html, tables.md, images/ and parts/. What is finished with the same settings is not run again. --quick: small sizes, minutes instead of hours; its numbers show
that the script works and nothing else.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

from experiment_page import Page, percent, plot, run_parts
from shot_measures import Frames, Lines, clustering_picture, mean, sheet, slice_of, video

HERE = pathlib.Path(__file__).resolve().parent
OWN = ("temple", "room", "cloth", "stage", "fur", "forest")
OURS = "tensor-clustering"
SAME_LIGHTS = ("--light-placement", "gather")
MANY_INSTANCES = 100  # Mitsuba compiles minutes for more of them


class Shots:
    """Shots that the program renders, each kept in a folder: what is finished with the same arguments is not run again."""

    def __init__(self, program, folder, threads):
        self.program, self.folder, self.threads = program, folder, threads
        folder.mkdir(parents=True, exist_ok=True)

    def run(self, name, scene, first, last, arguments):
        """(Frames counted from `first`, reports, seconds for a frame of the whole process)."""
        folder, record = self.folder / name, self.folder / f"{name}.run.json"
        asked = [scene.parent.name, scene.name, first, last, *map(str, arguments)]
        known = json.loads(record.read_text()) if record.exists() else None
        if not known or known["asked"] != asked:
            shutil.rmtree(folder, ignore_errors=True)
            line = [str(self.program), "animate", str(scene), "-o", str(folder), "--frames", f"{first}:{last}", "--format", "pfm", "--rest", "skip", "--quiet",
                    "--threads", str(self.threads), *map(str, arguments)]
            print("$", " ".join(line), flush=True)
            start = time.monotonic()
            subprocess.run(line, check=True)
            known = {"asked": asked, "wall": time.monotonic() - start}
            record.write_text(json.dumps(known))
        count = last - first + 1
        reports = [json.loads((folder / f"frame_{k:04d}.json").read_text()) for k in range(first, last + 1)]
        return Frames(folder, count), reports, known["wall"] / count


class Shot:
    """Everything about one scene that parts share; made when it is asked for."""

    def __init__(self, of, name):
        self.of, self.args = of, of.args
        path = pathlib.Path(name)
        if name in OWN:
            path = next(p for p in (of.args.scenes / name / f"scene.{e}" for e in ("xml", "glb")) if p.exists())
        self.scene, self.name = path, name if name in OWN else f"{path.parent.name}_{path.stem}"
        self.last = of.frames - 1
        self.common = ["--size", of.size, "--spp", of.spp, "--film-samples", "0", "--lights", of.lights, "--direct", of.args.direct]
        self.made = {}
        info = subprocess.run([str(of.args.program), "info", str(path), "--json", "--quiet"], check=True, capture_output=True, text=True)
        self.info = json.loads(info.stdout)
        if self.info["motion"]["end"] * 24 + 1e-6 < self.last:
            raise SystemExit(f"{path} has fewer than {of.frames} frames: give --frames {int(self.info['motion']['end'] * 24) + 1}")

    def once(self, key, make):
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    def render(self, what, arguments, last=None, first=0):
        return self.of.shots.run(f"{self.name}_{what}", self.scene, first, self.last if last is None else last, [*self.common, *arguments])

    def clustered(self, columns):
        return ["--method", OURS, "--set", f"columns={columns}", "--set", f"rows={self.of.rows}", "--set", f"chunk={self.of.frames}", "--set", "overlap=0", "--set", "clusters=on"]

    def tensor(self, columns=None):
        """With the columns of Table 2, or with others."""
        columns = columns or self.of.columns
        changed = [word for setting in self.args.set for word in ("--set", setting)]
        return self.once(f"tensor_{columns}", lambda: self.render(f"tensor_{columns}", [*self.clustered(columns), *changed]))

    def rival(self):
        return self.tensor(self.of.equal_columns)

    def line_runs(self, what, arguments):
        return self.once(what, lambda: [self.render(f"{what}_{y}", [*arguments, "--crop", f"0,{y},{self.of.width},1"]) for y in self.of.lines])

    def truth(self, what="all"):
        """"all": columns of the shot's lights; "own": those of frames by themselves."""
        runs = self.line_runs(what, self.clustered(0) if what == "all" else [*SAME_LIGHTS, "--method", "brute-force"])
        return self.once(f"truth {what}", lambda: Lines.of_folders([self.of.shots.folder / f"{self.name}_{what}_{y}" for y in self.of.lines], len(runs[0][1])))

    def level(self):
        values = self.truth().values
        return mean(mean(v) for v in values)

    # ------------------------------------------------------------------------------------------------------------------------------ equal time

    def trial(self, what, arguments):
        """Seconds for a frame of the whole shot, by two of its frames: what is done once for all is shared by all."""
        middle = self.last // 2
        _, reports, seconds = self.render(f"trial_{what}", arguments, first=middle, last=middle + 1)
        each = mean(r["seconds.total"] for r in reports)
        return each + len(reports) * (seconds - each) / self.of.frames

    def fitted(self, what, settings, first, most):
        """The number with which a frame takes as long as tensor clustering's, by a line through the seconds of trials: at first of `first`, then of what the line says."""
        wanted, times = self.rival()[2], {}
        for value in first:
            times[value] = self.trial(f"{what}_{value:.6g}", settings(value))
        for n in range(2):
            x, y = mean(times), mean(times.values())
            slope = sum((v - x) * (t - y) for v, t in times.items()) / sum((v - x) ** 2 for v in times)
            value = min(most, max(min(first) / 8, x + (wanted - y) / max(slope, 1e-9)))
            if n == 0:
                times[value] = self.trial(f"{what}_{value:.6g}", settings(value))
        return value

    def at_equal_time(self, what, settings, first, most, described):
        """Rendered with the fitted setting; once more where the whole shot, unlike the trials, is more than 5 % off the seconds."""
        value, wanted = self.fitted(what, settings, first, most), self.rival()[2]
        done = self.render(what, settings(value))
        if abs(done[2] - wanted) > 0.05 * wanted and (other := min(most, value * wanted / done[2])) != value:
            again = self.render(f"{what}_again", settings(other))
            if abs(again[2] - wanted) < abs(done[2] - wanted):
                value, done = other, again
        return (*done, described(value))

    def row_column(self):
        # Rows that all count alike are best in the 2-norm, and as the paper has them.
        settings = lambda c: [*SAME_LIGHTS, "--method", "row-column-sampling", "--set", f"rows={self.of.rows}", "--set", f"columns={round(c)}", "--set", "row-weights=light"]
        return self.once("row-column", lambda: self.at_equal_time("row_column", settings, (200, 800), self.of.lights // 2, lambda c: f"{self.of.rows} rows, {round(c)} columns"))

    def slice_cuts(self):
        settings = lambda q: [*SAME_LIGHTS, "--method", "slice-cuts", "--set", f"initial-columns={max(20, round(500 * q))}", "--set", f"alpha={min(1, 0.003 / q):.6g}"]
        return self.once("slice-cuts", lambda: self.at_equal_time("slice_cuts", settings, (0.25, 1), 8, lambda q: f"initial-columns {max(20, round(500 * q))}, alpha {0.003 / q:.3g}"))

    def denoised(self):
        """(denoised frames, noisy frames, its own truth, seconds for a frame, what was done), or None without --mitsuba-python."""
        if not self.args.mitsuba_python:
            return None
        return self.once("denoised", self.make_denoised)

    def make_denoised(self):
        out, scenes = self.of.shots.folder / f"{self.name}_denoised", self.of.shots.folder / f"{self.name}_scenes"
        asked = [self.of.size, self.of.frames, self.of.lines, round(self.rival()[2], 4), self.args.truth_paths]
        record = self.of.shots.folder / f"{self.name}_denoised.run.json"
        if not record.exists() or json.loads(record.read_text()) != asked:
            scenes.mkdir(exist_ok=True)
            files = []
            for k in range(self.of.frames):
                files.append(scenes / f"frame_{k:04d}.xml")
                subprocess.run([str(self.args.program), "convert", str(self.scene), str(files[-1]), "--frame", str(k), "--quiet"], check=True)
            line = [self.args.mitsuba_python, str(HERE / "denoised_path_tracer.py"), str(out), *map(str, files), "--size", self.of.size, "--seconds", f"{self.rival()[2]:.4f}",
                    "--lines", ",".join(map(str, self.of.lines)), "--truth", str(self.args.truth_paths)]
            if self.info["instances"] > MANY_INSTANCES:
                line += ["--variants", "scalar_rgb"]
            print("$", " ".join(line[:3]), "…", flush=True)
            subprocess.run(line, check=True)
            record.write_text(json.dumps(asked))
        done = json.loads((out / "shot.json").read_text())
        return (Frames(out, self.of.frames), Frames(out, self.of.frames, "noisy_{:04d}.pfm"), Lines.of_pictures(out, self.of.frames), mean(done["seconds"]),
                f"{done['paths']} paths per pixel ({min(done['paces'], key=done['paces'].get)})")

    def contenders(self):
        """(name, frames, seconds for a frame, setting, [(truth's name, truth)])."""
        shots, own = ("all columns of the chunk's lights", self.truth()), ("all columns of the motion's lights", self.truth("own"))
        frames, _, seconds = self.rival()
        out = [(OURS, frames, seconds, f"{self.of.rows} rows, {self.of.equal_columns} columns", [shots])]
        for name, (frames, _, seconds, setting) in (("row-column-sampling", self.row_column()), ("slice-cuts", self.slice_cuts())):
            out.append((name, frames, seconds, setting, [own, shots]))
        if found := self.denoised():
            clean, noisy, converged, seconds, setting = found
            itself = (f"itself with {self.args.truth_paths} paths per pixel", converged)
            out.append(("path tracer, denoised", clean, seconds, setting, [itself, shots]))
            out.append(("path tracer, as it is", noisy, seconds, setting, [itself]))
        return out


class Experiments:
    def __init__(self, args):
        self.args, quick = args, args.quick
        self.size = args.size or ("96x72" if quick else "320x240")
        self.width, self.height = map(int, self.size.split("x"))
        self.lights = args.lights or (8000 if quick else 65536)
        self.frames = args.frames or (8 if quick else 40)
        self.rows, self.columns, self.equal_columns, self.spp = args.rows, args.columns, args.equal_columns, args.spp
        count = args.lines or (2 if quick else 4)
        self.lines = [self.height * (2 * k + 1) // (2 * count) for k in range(count)]
        self.shots = Shots(args.program.resolve(), args.out / "parts", args.threads)
        self.ffmpeg = args.ffmpeg or shutil.which("ffmpeg")
        names = args.shots or (["room"] if quick else list(OWN))
        needed = [n for n in names if n in OWN and not (args.scenes / n).exists()]
        if needed:
            subprocess.run([sys.executable, str(HERE / "make_animated_scenes.py"), str(args.scenes), *needed], check=True)
        self.of_scenes = [Shot(self, n) for n in names]
        self.page = Page("Tensor clustering: the experiments of the 2008 paper", args.out)
        self.page.say(f"{self.size}, {self.spp} receivers per pixel, {self.lights:,} lights, {self.frames} frames in one chunk; truth on scanlines {', '.join(map(str, self.lines))}. "
                      f"{args.threads or os.cpu_count()} threads."
                      + (" Quick run: its numbers show that the script works and nothing else." if quick else ""))

    def table(self):
        page = self.page
        page.heading("Table 2: seconds for a frame")
        page.say("Means over the frames. Receivers: eye rays and their surfaces. Scene, files: reading and building the scene at every moment, and the rest of the "
                 "process. Brute force: all columns, by the seconds that the scanlines took for each receiver, and the same rest. The second ratio is of the matrix alone: brute "
                 "force's columns by all from mappings to changed rows. The paper's ratios: 18 (51k and 107k triangles), 65 (869k), 76 (2.1 M), 269 (8.2 M, instances).")
        rows = []
        for shot in self.of_scenes:
            frames, reports, total = shot.tensor()
            stage = {s: mean(r.get(f"seconds.{s}", 0) for r in reports) for s in ("lights", "receivers", "mappings", "rows", "clustering", "columns", "changes")}
            stage["changes"] += mean(r.get("seconds.filter", 0) for r in reports)
            rest = total - sum(stage.values())
            receivers = self.width * self.height * self.spp
            part = [r["seconds.columns"] for run in shot.line_runs("all", shot.clustered(0)) for r in run[1]]
            brute = mean(part) / (self.width * self.spp) * receivers
            method = sum(stage.values()) - stage["receivers"] - stage["lights"]
            error, half = self.error(shot)
            active = [r["clusters.active"] for r in reports]
            rows.append((shot.name, f"{shot.info['triangles']:,}" + (f" + {shot.info['fiber_segments']:,} fiber segments" if shot.info["fiber_segments"] else ""),
                         f"{mean(r['rows'] for r in reports):.0f} / {self.columns}", f"{min(active):.0f}–{max(active):.0f}", f"{mean(r['rays.shadow'] for r in reports) / 1e6:.2f} M",
                         f"{rest:.2f}", *(f"{stage[s]:.2f}" for s in stage), f"{total:.2f}", f"{brute + total - method:.0f}",
                         f"{(brute + total - method) / total:.0f}×", f"{brute / method:.0f}×", f"{percent(error)} ± {100 * half:.1f}"))
        page.table(("scene", "triangles", "rows / columns for a frame", "clusters that act", "shadow rays", "scene, files", "lights", "receivers", "mappings", "rows", "clustering", "columns", "changed rows, filter",
                    "total", "brute force", "ratio", "of the matrix", "relative L2"), rows)

    def error(self, shot):
        truth, (frames, _, _) = shot.truth(), shot.tensor()
        return mean(truth.measure(frames, self.lines)["l2"]), truth.interval(frames, self.lines, self.width)

    def of_frames(self):
        page = self.page
        page.heading("Error and flicker at equal time")
        if not self.args.mitsuba_python:
            page.say("The denoised path tracer is left out: --mitsuba-python names no Python that has Mitsuba.")
        page.say("The first line of each method is the fair one: against what it would converge to. All have the same lights in every frame; those of the methods that work frame by frame "
                 "are planned for the whole motion, so against the chunk's they also differ by that, and the path tracer by pixel filter, clamping, and what `convert` has to replace (the sky's model, hair). Seconds of the path tracer leave out loading and compiling.")
        claims = []
        for shot in self.of_scenes:
            rows, errors, flickers, first = [], {}, {}, {}
            for name, frames, seconds, setting, truths in shot.contenders():
                for which, (against, truth) in enumerate(truths):
                    m = truth.measure(frames, self.lines)
                    rows.append((name, setting, f"{seconds:.2f}", against, percent(mean(m["l2"])), percent(max(m["l2"])), percent(mean(m["l1"])), f"{100 * m['bias']:+.1f} %",
                                 f"{100 * mean(m['flicker']):.2f} %"))
                    if which == 0:
                        first[name] = mean(m["flicker"])
                        errors[name] = [(k + 1, 100 * v) for k, v in enumerate(m["l2"])]
                        flickers[name] = [(k + 1, 100 * v) for k, v in enumerate(m["flicker"])]
            page.heading(shot.name)
            page.table((shot.name, "setting", "seconds for a frame", "against", "relative L2", "worst frame", "relative L1", "bias", "flicker"), rows)
            page.svg(plot(f"{shot.name}: error", "frame", "relative L2, %", errors, log_x=False))
            page.svg(plot(f"{shot.name}: flicker", "frame", "flicker, %", flickers, log_x=False))
            claims.append((shot.name, *(f"{first[OURS] / first[n]:.2f}" if n in first else "" for n in ("row-column-sampling", "slice-cuts", "path tracer, denoised"))))
            page.write()
        page.heading("Flicker of tensor clustering, as a part of the others'")
        page.table(("scene", "row-column-sampling", "slice-cuts", "path tracer, denoised"), claims)

    def clusters(self):
        page = self.page
        page.heading("Clusters that act in a frame")
        page.say(f"{self.columns} columns are computed for a frame in the mean; clusters that span frames act in all of them (section 6 of the paper: 230–400, 1,500–7,000 and 7,000–7,300).")
        page.svg(plot("Effective number of clusters", "frame", "clusters", {s.name: [(k + 1, r["clusters.active"]) for k, r in enumerate(s.tensor()[1])] for s in self.of_scenes}, log_x=False))
        for shot in self.of_scenes:
            file = self.shots.folder / f"{shot.name}_tensor_{self.columns}" / "clusters_0000.json"
            width, height, pixels = clustering_picture(json.loads(file.read_text()))
            page.raw(f"{shot.name}_clusters", width, height, pixels, f"{shot.name}: lights (down) × frames (across); a color is a cluster (Figure 3)")

    def pictures(self):
        page = self.page
        page.heading("Pictures")
        for shot in self.of_scenes:
            exposure = 0.25 / shot.level() if shot.level() > 0 else 1.0
            rivals = [c for c in shot.contenders() if c[0] != "path tracer, as it is"]
            page.heading(shot.name)
            width, _ = sheet(page.folder / "images" / f"{shot.name}_sheet.png", [c[1] for c in rivals], self.frames, exposure)
            page.figure(f"{shot.name}_sheet", width, "From above: " + ", ".join(c[0] for c in rivals), shown=min(1160, 2 * width))
            row = len(self.lines) // 2
            times = max(1, 160 // self.frames)
            truth = shot.truth().values
            at = slice(3 * self.width * row, 3 * self.width * (row + 1))
            page.raw(f"{shot.name}_slice_truth", *slice_of(lambda k: truth[k][at], self.frames, self.width, exposure, times), f"Scanline {self.lines[row]} through time (down): all columns")
            for k, (name, frames, *_) in enumerate(rivals):
                page.raw(f"{shot.name}_slice_{k}", *slice_of(lambda f, frames=frames: frames.lines(f, [self.lines[row]]), self.frames, self.width, exposure, times), name)
            if self.ffmpeg:
                file = page.folder / "images" / f"{shot.name}.mp4"
                video(file, [c[1] for c in rivals], self.frames, exposure, self.ffmpeg)
                page.video(file.name, "From the left: " + ", ".join(c[0] for c in rivals))
            page.write()


PARTS = {"table": Experiments.table, "frames": Experiments.of_frames, "clusters": Experiments.clusters, "pictures": Experiments.pictures}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("shots", nargs="*", help=f"{', '.join(OWN)}, or scene files that move; default: all six, with --quick the room")
    parser.add_argument("--program", type=pathlib.Path, default=HERE.parents[1] / "build/release/lumirank")
    parser.add_argument("--scenes", type=pathlib.Path, help="folder of the generated scenes; default: OUT/scenes")
    parser.add_argument("--parts", default=",".join(PARTS), help="which parts, in this order; default: all")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--size", help="default 320x240")
    parser.add_argument("--spp", type=int, default=1, help="receivers per pixel; default 1, as in the paper")
    parser.add_argument("--lights", type=int, help="default 65536")
    parser.add_argument("--direct", choices=("matrix", "auto"), default="matrix",
                        help="matrix: direct light by columns too, so that the truth has no noise (default); auto: as by default, where sharp lobes trace theirs with the same noise in all pictures")
    parser.add_argument("--frames", type=int, help="default 40; the shots have 48")
    parser.add_argument("--rows", type=int, default=100)
    parser.add_argument("--columns", type=int, default=300, help="for a frame in the mean; default 300")
    parser.add_argument("--equal-columns", type=int, default=1000, help="the same at equal time; default 1000")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE",
                        help="a parameter of tensor clustering; as in the paper: max-distance=0, max-change=0, max-peak=0, filter=0, carry=on, initial-clusters=100, representatives=largest")
    parser.add_argument("--lines", type=int, help="scanlines with known truth; default 4")
    parser.add_argument("--mitsuba-python", help="a Python with the packages mitsuba, pyoidn and numpy, for the denoised path tracer")
    parser.add_argument("--truth-paths", type=int, default=1024, help="paths per pixel of its own truth; default 1024")
    parser.add_argument("--ffmpeg", help="for videos; default: the one that is installed, if any")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    args.scenes = args.scenes or args.out / "scenes"
    run_parts(parser, args, PARTS, Experiments)


if __name__ == "__main__":
    sys.exit(main())
