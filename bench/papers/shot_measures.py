"""Errors and flicker of a shot on some of its scanlines, contact sheets, slices through time: what tensor_clustering_2008.py measures with. Only the standard library."""
import math
import pathlib
import subprocess
import tempfile

from experiment_page import read_pfm, to_display, write_png


class Frames:
    """The PFM frames of a folder, read when they are asked for."""

    def __init__(self, folder, count, name="frame_{:04d}.pfm"):
        self.folder, self.count, self.name, self.kept = pathlib.Path(folder), count, name, {}

    def __getitem__(self, k):
        if k not in self.kept:
            self.kept[k] = read_pfm(self.folder / self.name.format(k))
        return self.kept[k]

    def lines(self, k, lines):
        """Scanlines, one after the other, as one list of numbers."""
        width, _, values = self[k]
        return [v for y in lines for v in values[3 * width * y:3 * width * (y + 1)]]


class Lines:
    """The truth of a shot: scanlines of all frames, each in a folder of its own; or all lines of a frame in one picture."""

    def __init__(self, frames, again=None):
        """`again`: the same once more, of independent noise. Squares of differences are then products of those to the one and to the other, in which noise cancels in the mean."""
        flat = [[[v for picture in of_frame for v in picture[2]] for of_frame in half] for half in (frames, again or frames)]
        self.halves = list(zip(*flat))
        self.values = [[(a + b) / 2 for a, b in zip(*both)] for both in self.halves]

    @staticmethod
    def of_folders(folders, count):
        return Lines([[read_pfm(pathlib.Path(f) / f"frame_{k:04d}.pfm") for f in folders] for k in range(count)])

    @staticmethod
    def of_pictures(folder, count):
        return Lines(*([[read_pfm(pathlib.Path(folder) / f"{name}_{k:04d}.pfm")] for k in range(count)] for name in ("truth", "other_truth")))

    def measure(self, frames, lines):
        """Relative L2 and L1 of each frame, flicker of each step, and bias over all: of `frames` on `lines` against this truth. Where it is noisy, relative L1 holds its noise."""
        have = [frames.lines(k, lines) for k in range(len(self.values))]
        l2, l1, flicker, sums = [], [], [], [0.0, 0.0]
        for k, (i, r) in enumerate(zip(have, self.values)):
            if len(i) != len(r):
                raise ValueError(f"{frames.folder}: {len(i)} numbers against {len(r)} of the truth")
            one, other = self.halves[k]
            square, total = sum(a * b for a, b in zip(one, other)), sum(r)
            l2.append(math.sqrt(max(0.0, sum((a - b) * (a - c) for a, b, c in zip(i, one, other))) / square))
            l1.append(sum(abs(a - b) for a, b in zip(i, r)) / total)
            sums = [sums[0] + sum(i) - total, sums[1] + total]
            if k + 1 < len(have):
                steps = [[(d - c) - (b - a) for a, b, c, d in zip(half, later, i, have[k + 1])] for half, later in zip(self.halves[k], self.halves[k + 1])]
                flicker.append(math.sqrt(max(0.0, sum(a * b for a, b in zip(*steps))) / square))
        return {"l2": l2, "l1": l1, "flicker": flicker, "bias": sums[0] / sums[1]}

    def interval(self, frames, lines, width, parts=8):
        """Half of the 95 % interval of relative L2 over all frames: leaves out one piece of a scanline at a time."""
        pieces = len(lines) * parts
        top, bottom = [0.0] * pieces, [0.0] * pieces
        for k, r in enumerate(self.values):
            for n, (a, b) in enumerate(zip(frames.lines(k, lines), r)):
                line, x = divmod(n // 3, width)
                piece = line * parts + x * parts // width
                top[piece] += (a - b) ** 2
                bottom[piece] += b * b
        t, b = sum(top), sum(bottom)
        without = [math.sqrt((t - top[k]) / (b - bottom[k])) for k in range(pieces) if b > bottom[k]]
        middle = sum(without) / len(without)
        return 1.96 * math.sqrt((pieces - 1) / pieces * sum((w - middle) ** 2 for w in without))


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else 0.0


def sheet(path, rows, count, exposure, shown=5):
    """A contact sheet: one row of evenly spaced frames for each of `rows`. Returns its size."""
    numbers = sorted({round(k * (count - 1) / (shown - 1)) for k in range(shown)})
    width, height, _ = rows[0][numbers[0]]
    out = bytearray()
    for frames in rows:
        pictures = [to_display(frames[k][2], exposure) for k in numbers]
        for y in range(height):
            for p in pictures:
                out += p[3 * width * y:3 * width * (y + 1)]
    write_png(path, width * len(numbers), height * len(rows), bytes(out))
    return width * len(numbers), height * len(rows)


def slice_of(get_line, count, width, exposure, times):
    """A scanline of all frames, one below the other, each `times` pixels high: (width, height, pixels)."""
    out = bytearray()
    for k in range(count):
        out += to_display(get_line(k), exposure) * times
    return width, count * times, bytes(out)


def video(path, rows, count, exposure, ffmpeg, rate=24):
    """The shots of `rows` side by side."""
    with tempfile.TemporaryDirectory() as folder:
        for k in range(count):
            width, height, _ = rows[0][k]
            pictures = [to_display(r[k][2], exposure) for r in rows]
            pixels = b"".join(p[3 * width * y:3 * width * (y + 1)] for y in range(height) for p in pictures)
            write_png(pathlib.Path(folder) / f"{k:04d}.png", width * len(rows), height, pixels)
        subprocess.run([ffmpeg, "-y", "-loglevel", "error", "-framerate", str(rate), "-i", f"{folder}/%04d.png", "-vf", "scale=iw*2:ih*2:flags=neighbor,pad=ceil(iw/2)*2:ceil(ih/2)*2",
                        "-c:v", "libx264", "-crf", "14", "-pix_fmt", "yuv420p", str(path)], check=True)


def clustering_picture(chunk, max_height=400):
    """Figure 3: lights down, frames across, each light-frame pair in the color of its rectangle. `chunk`: the frames, lights and rectangles of clusters_0000.json. Lights are
    sorted by their rectangles in the first frame, then in the next ones, so that clusters hang together; where there are too many, every so many-th is shown."""
    begin, end, lights = chunk["frames"][0], chunk["frames"][1], chunk["lights"]
    count = end - begin + 1
    cluster = [[-1] * lights for _ in range(count)]
    for number, r in enumerate(chunk["rectangles"]):
        for k in range(r["frames"][0] - begin, r["frames"][1] - begin + 1):
            row = cluster[k]
            for j in r["lights"]:
                row[j] = number
    middle = count // 2
    order = sorted((j for j in range(lights) if cluster[middle][j] >= 0), key=lambda j: [cluster[k][j] for k in (middle, 0, count - 1, *range(count))])
    step = max(1, len(order) // max_height)
    shown = order[::step]
    wide = max(1, 480 // count)
    pixels = bytearray()
    for j in shown:
        for k in range(count):
            # Neighboring numbers get colors far from each other.
            h = (cluster[k][j] * 2654435761) & 0xffffffff
            pixels += bytes((70 + (h >> 24) % 180, 70 + (h >> 13 & 0xff) % 180, 70 + (h >> 3 & 0xff) % 180)) * wide
    return count * wide, len(shown), bytes(pixels)
