"""What the experiments' scripts share: images, errors against two independent references, plots, one HTML page, resumable runs. Only the standard library."""
import array
import html
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import time
import zlib


def read_pfm(path):
    """(width, height, floats row by row from the top, three to a pixel)."""
    data = pathlib.Path(path).read_bytes()
    kind, size, scale, body = data.split(b"\n", 3)
    width, height = map(int, size.split())
    if kind != b"PF" or float(scale) > 0:
        raise ValueError(f"{path}: not a little-endian color PFM")
    values = array.array("f", body[:12 * width * height])
    if sys.byteorder == "big":
        values.byteswap()
    rows = [values[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]
    return width, height, array.array("f", b"".join(r.tobytes() for r in rows))


def write_png(path, width, height, pixels):
    """pixels: bytes, three to a pixel."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    lines = b"".join(b"\0" + pixels[3 * width * y:3 * width * (y + 1)] for y in range(height))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


CODES = bytes(round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)) for v in (k / 4095 for k in range(4096)))


def to_display(values, exposure):
    return bytes(CODES[min(4095, max(0, int(4095 * exposure * v)))] for v in values)


def false_color(x):
    """Black, blue, magenta, orange, white for 0 … 1."""
    stops = ((0, 0, 0), (40, 20, 140), (190, 40, 120), (250, 150, 30), (255, 255, 230))
    x = min(max(x, 0.0), 1.0) * 4
    k = min(int(x), 3)
    return bytes(round(a + (b - a) * (x - k)) for a, b in zip(stops[k], stops[k + 1]))


FALSE_COLORS = [false_color(k / 255) for k in range(256)]
# Blue, white, red for -1 … 1.
SIGNED_COLORS = [bytes(round(255 + (c - 255) * abs(t)) for c in ((190, 30, 40) if t > 0 else (30, 70, 180))) for t in (k / 127.5 - 1 for k in range(256))]
NOTHING = bytes((112, 112, 112))


def colors_of(values, low, high, colors, nothing=math.isnan):
    """The first of every three numbers, painted by the colors from low to high; gray where there is nothing."""
    scale = len(colors) / (high - low)
    return b"".join(NOTHING if nothing(v) else colors[min(len(colors) - 1, max(0, int((v - low) * scale)))] for v in values[::3])


class Truth:
    """Two independent references A and B of one picture.

    ⟨I − A, I − B⟩ / ⟨A, B⟩ is the squared relative L2 error of I without the references' own noise, which is independent in the two and cancels
    in the mean. Its 95 % interval comes from leaving out one of 48 blocks of the image at a time.
    """

    def __init__(self, a, b):
        self.width, self.height, self.a = a
        if b[:2] != a[:2]:
            raise ValueError("the two references differ in size")
        self.b = b[2]
        self.mean = array.array("f", ((x + y) / 2 for x, y in zip(self.a, self.b)))
        self.level = sum(self.mean) / len(self.mean)
        # A quarter of the range for the mean leaves room for highlights.
        self.exposure = 0.25 / self.level if self.level > 0 else 1.0

    def error(self, image):
        width, height, values = image
        if (width, height) != (self.width, self.height):
            raise ValueError(f"a picture of {width}x{height} against references of {self.width}x{self.height}")
        across, down = 8, 6
        top, bottom = [0.0] * (across * down), [0.0] * (across * down)
        difference = absolute = 0.0
        for y in range(height):
            row = (y * down // height) * across
            for x in range(width):
                block = row + x * across // width
                at = 3 * (y * width + x)
                for k in (at, at + 1, at + 2):
                    i, a, b = values[k], self.a[k], self.b[k]
                    top[block] += (i - a) * (i - b)
                    bottom[block] += a * b
                    difference += i - 0.5 * (a + b)
                    absolute += abs(i - 0.5 * (a + b))
        def l2(t, b):
            return math.sqrt(max(0.0, t / b)) if b > 0 else 0.0
        t, b, n = sum(top), sum(bottom), across * down
        parts = [l2(t - top[k], b - bottom[k]) for k in range(n)]
        middle = sum(parts) / n
        spread = math.sqrt((n - 1) / n * sum((p - middle) ** 2 for p in parts))
        total = self.level * len(self.mean)
        return {"l2": l2(t, b), "l2_width": 1.96 * spread, "l1": absolute / total, "bias": difference / total}

    def difference_png(self, path, image, full=2.0):
        """|I − R| per pixel, white at `full` times the mean of the reference."""
        values, scale = image[2], 1 / (full * self.level * 3)
        pixels = b"".join(false_color(scale * sum(abs(values[k + c] - self.mean[k + c]) for c in range(3))) for k in range(0, len(values), 3))
        write_png(path, self.width, self.height, pixels)


class Runs:
    """Runs of the program, each kept under a name: what is finished with the same arguments is not run again."""

    def __init__(self, program, folder, threads):
        self.program, self.folder, self.threads = program, folder, threads
        (folder / "parts").mkdir(parents=True, exist_ok=True)

    def run(self, name, command, scene, arguments):
        """Returns (picture, report); the report has "wall", seconds of the whole process."""
        if command == "render":
            arguments = ["--rest", "skip", "--film-samples", "0", *arguments]  # experiments are about columns, and sums of rows
        base = self.folder / "parts" / name
        record = base.with_name(base.name + ".run.json")
        asked = [command, str(pathlib.Path(scene).name), pathlib.Path(scene).parent.name, *map(str, arguments)]
        picture, report = base.with_name(base.name + ".pfm"), base.with_name(base.name + ".json")
        if record.exists():
            known = json.loads(record.read_text())
            if known["asked"] == asked and picture.exists() and report.exists():
                return read_pfm(picture), json.loads(report.read_text()) | {"wall": known["wall"]}
        line = [str(self.program), command, str(scene), "-o", str(picture), "--report", str(report), "--quiet", "--threads", str(self.threads), *map(str, arguments)]
        print("$", " ".join(line), flush=True)
        start = time.monotonic()
        subprocess.run(line, check=True)
        wall = time.monotonic() - start
        record.write_text(json.dumps({"asked": asked, "wall": wall}))
        return read_pfm(picture), json.loads(report.read_text()) | {"wall": wall}


def best(curve, x, y):
    """The points (x, y) of the runs that none beats in both, by x."""
    points = []
    for point in sorted((r[x], r[y]) for r in curve if r[y] > 0 and r[x] > 0):
        if not points or point[1] < points[-1][1]:
            points.append(point)
    return points


def at_level(curve, level, x, y):
    """Where a curve of runs, the best of them, reaches y = level: x there, by straight lines in logarithms; None outside of what was measured."""
    points = sorted((b, a) for a, b in best(curve, x, y))
    for (y0, x0), (y1, x1) in zip(points, points[1:]):
        if y0 <= level <= y1 and y1 > y0:
            t = math.log(level / y0) / math.log(y1 / y0)
            return math.exp(math.log(x0) + t * math.log(x1 / x0))
    return None


def percent(x):
    return f"{100 * x:.1f} %"


def plot(title, x_label, y_label, curves, log_x=True, log_y=True, width=600, height=340):
    """An SVG of {name: [(x, y), …]}; a point alone becomes a dashed level line."""
    points = [p for c in curves.values() for p in c if p[1] > 0 and (p[0] > 0 or not log_x)]
    if not points:
        return ""
    fx = math.log10 if log_x else float
    fy = math.log10 if log_y else float
    xs, ys = [fx(p[0]) for p in points], [fy(p[1]) for p in points]
    x0, x1, y0, y1 = min(xs), max(xs), min(ys), max(ys)
    if not log_y:
        y0 = 0.0
    x0, x1 = (x0 - 0.5, x1 + 0.5) if x0 == x1 else (x0 - 0.03 * (x1 - x0), x1 + 0.03 * (x1 - x0))
    y0, y1 = (y0 - 0.5, y1 + 0.5) if y0 == y1 else (y0 - 0.06 * (y1 - y0) * log_y, y1 + 0.06 * (y1 - y0))
    left, right, top, bottom = 62, max(170, 44 + 7 * max(map(len, curves))), 34, 46  # names stand on the right
    width += right - 170

    def px(x):
        return left + (fx(x) - x0) / (x1 - x0) * (width - left - right)

    def py(y):
        return height - bottom - (fy(y) - y0) / (y1 - y0) * (height - top - bottom)

    def ticks(low, high, log):
        if log:
            found = [m * 10.0 ** e for e in range(math.floor(low), math.ceil(high) + 1) for m in (1, 2, 5)]
            return [t for t in found if low <= math.log10(t) <= high]
        step = 10 ** math.floor(math.log10(max(high - low, 1e-9)))
        step *= 0.2 if (high - low) / step < 2 else (0.5 if (high - low) / step < 5 else 1)
        return [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
    out = [f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="{html.escape(title)}">',
           f'<text x="{left}" y="18" class="t">{html.escape(title)}</text>']
    for t in ticks(x0, x1, log_x):
        out.append(f'<line x1="{px(t):.1f}" y1="{top}" x2="{px(t):.1f}" y2="{height - bottom}" class="g"/><text x="{px(t):.1f}" y="{height - bottom + 15}" text-anchor="middle">{t:g}</text>')
    for t in ticks(y0, y1, log_y):
        out.append(f'<line x1="{left}" y1="{py(t):.1f}" x2="{width - right}" y2="{py(t):.1f}" class="g"/><text x="{left - 6}" y="{py(t) + 4:.1f}" text-anchor="end">{t:g}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 10}" text-anchor="middle">{html.escape(x_label)}</text>'
               f'<text transform="translate(14 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">{html.escape(y_label)}</text>')
    colors = ("#1b6ca8", "#c8502a", "#3a8f4d", "#8a4fa3", "#b08a1e", "#4b4b4b", "#d0679c", "#3aa6a6", "#7a5230", "#8fae3c")
    for k, (name, curve) in enumerate(curves.items()):
        color = colors[k % len(colors)]
        good = [p for p in curve if p[1] > 0]
        if len(good) == 1 and good[0][0] == 0:
            y = py(good[0][1])
            out.append(f'<line x1="{left}" y1="{y:.1f}" x2="{width - right}" y2="{y:.1f}" stroke="{color}" stroke-dasharray="6 4" stroke-width="2"/>')
        else:
            path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in good)
            out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"/>' +
                       ("".join(f'<circle cx="{px(x):.1f}" cy="{py(y):.1f}" r="3" fill="{color}"/>' for x, y in good) if len(good) < 30 else ""))
        y, dash = top + 12 + 18 * k, ' stroke-dasharray="6 4"' if len(good) == 1 and good[0][0] == 0 else ""
        out.append(f'<line x1="{width - right + 8}" y1="{y}" x2="{width - right + 28}" y2="{y}" stroke="{color}" stroke-width="2"{dash}/>'
                   f'<text x="{width - right + 33}" y="{y + 4}">{html.escape(name)}</text>')
    return "\n".join(out + ["</svg>"])


def bars(title, x_label, y_label, heights, curves, width=600, height=340):
    """An SVG of bars, {name: [heights of 0, 1, 2 …]} side by side, over which lie curves {name: [(x, y)]} with an axis of their own on the right, from 0."""
    left, right, top, bottom = 62, 210, 34, 46
    columns = max(len(h) for h in heights.values())
    max_height = max(max(h) for h in heights.values()) or 1
    upper = max((y for c in curves.values() for _, y in c), default=1) * 1.05 or 1
    across, down = width - left - right, height - top - bottom
    slot = across / columns
    out = [f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="{html.escape(title)}">',
           f'<text x="{left}" y="18" class="t">{html.escape(title)}</text>']
    for k in range(5):
        y = height - bottom - down * k / 4
        out.append(f'<line x1="{left}" y1="{y:.1f}" x2="{width - right}" y2="{y:.1f}" class="g"/><text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{max_height * k / 4:.3g}</text>')
        if curves:
            out.append(f'<text x="{width - right + 5}" y="{y + 4:.1f}">{upper * k / 4:.2g}</text>')
    for k in range(0, columns, max(1, columns // 10)):
        out.append(f'<text x="{left + (k + 0.5) * slot:.1f}" y="{height - bottom + 15}" text-anchor="middle">{k}</text>')
    out.append(f'<text x="{left + across / 2}" y="{height - 10}" text-anchor="middle">{html.escape(x_label)}</text>'
               f'<text transform="translate(14 {top + down / 2}) rotate(-90)" text-anchor="middle">{html.escape(y_label)}</text>')
    names = 0

    def legend(name, color):
        nonlocal names
        y = top + 12 + 18 * names
        names += 1
        out.append(f'<rect x="{width - right + 48}" y="{y - 6}" width="12" height="10" fill="{color}"/><text x="{width - right + 64}" y="{y + 3}">{html.escape(name)}</text>')
    bar = 0.8 * slot / len(heights)
    for n, ((name, values), color) in enumerate(zip(heights.items(), ("#7aa6c8", "#c9b27c", "#9cc09c"))):
        for k, v in enumerate(values):
            h = down * v / max_height
            out.append(f'<rect x="{left + k * slot + 0.1 * slot + n * bar:.1f}" y="{height - bottom - h:.1f}" width="{bar:.1f}" height="{h:.1f}" fill="{color}"/>')
        legend(name, color)
    for (name, curve), color in zip(curves.items(), ("#c8502a", "#8a6d1e", "#8a4fa3", "#3a8f4d")):
        path = " ".join(f"{left + (x + 0.5) * slot:.1f},{height - bottom - down * y / upper:.1f}" for x, y in curve)
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
        legend(name, color)
    return "\n".join(out + ["</svg>"])


STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1180px;margin:2em auto;padding:0 1em;color:#222;background:#fff}
table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .8em;border-bottom:1px solid #ddd;text-align:right}td:first-child,th:first-child{text-align:left}
figure{display:inline-block;margin:.3em;vertical-align:top}figure img,figure video{display:block;image-rendering:auto;max-width:100%}figcaption{font-size:13px;max-width:380px}
.bar{display:flex;flex-wrap:wrap;gap:.5em;align-items:center;font-size:12px;margin:.2em 0}.bar i{flex:1;min-width:3em;height:.9em;border:1px solid #888}
svg text{font:12px system-ui,sans-serif;fill:#333}svg .t{font-weight:600}svg .g{stroke:#e4e4e4}svg{max-width:100%;margin:.4em}
@media(prefers-color-scheme:dark){body{background:#181818;color:#ddd}td,th{border-color:#444}svg text{fill:#ccc}svg .g{stroke:#333}}"""


class Page:
    def __init__(self, title, folder):
        self.title, self.folder, self.body, self.text = title, folder, [f"<h1>{html.escape(title)}</h1>"], [f"# {title}\n"]
        (folder / "images").mkdir(parents=True, exist_ok=True)

    def heading(self, words):
        self.body.append(f"<h2>{html.escape(words)}</h2>")
        self.text.append(f"\n## {words}\n")

    def say(self, words):
        self.body.append(f"<p>{html.escape(words)}</p>")
        self.text.append(f"\n{words}\n")

    def table(self, head, rows):
        cells = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in r) + "</tr>" for r in rows)
        self.body.append("<table><tr>" + "".join(f"<th>{html.escape(h)}</th>" for h in head) + f"</tr>{cells}</table>")
        self.text.append("\n| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n" + "".join("| " + " | ".join(map(str, r)) + " |\n" for r in rows))

    def picture(self, name, image, exposure, caption):
        width, height, values = image
        write_png(self.folder / "images" / f"{name}.png", width, height, to_display(values, exposure))
        self.figure(name, width, caption)

    def difference(self, name, truth, image, caption):
        truth.difference_png(self.folder / "images" / f"{name}.png", image)
        self.figure(name, truth.width, caption)

    def scaled(self, name, image, low, high, caption, signed=False, nothing=math.isnan, label="{:g}".format, shown=None):
        """The first channel in false color, with a bar that says what the colors stand for."""
        width, height, values = image
        colors = SIGNED_COLORS if signed else FALSE_COLORS
        write_png(self.folder / "images" / f"{name}.png", width, height, colors_of(values, low, high, colors, nothing))
        stops = ",".join(f"rgb({c[0]},{c[1]},{c[2]})" for c in (colors[k] for k in (0, 64, 128, 191, 255)))
        self.figure(name, width, caption, f'<div class="bar"><span>{label(low)}</span><i style="background:linear-gradient(90deg,{stops})"></i><span>{label(high)}</span></div>', shown)

    def codes(self, name, image, kinds, caption, shown=None):
        """The first channel holds 0, 1, 2 …; kinds: (name, color) of each."""
        width, height, values = image
        write_png(self.folder / "images" / f"{name}.png", width, height, colors_of(values, 0, len(kinds), [bytes(c) for _, c in kinds]))
        legend = "".join(f'<i style="background:rgb({c[0]},{c[1]},{c[2]});flex:0 0 1.2em;min-width:0"></i><span>{html.escape(n)}</span>' for n, c in kinds)
        self.figure(name, width, caption, f'<div class="bar">{legend}</div>', shown)

    def raw(self, name, width, height, pixels, caption):
        """pixels: bytes, three to a pixel."""
        write_png(self.folder / "images" / f"{name}.png", width, height, pixels)
        self.figure(name, width, caption)

    def figure(self, name, width, caption, below="", shown=None):
        shown = shown or max(256, min(width, 400))
        self.body.append(f'<figure style="max-width:{shown}px"><img src="images/{name}.png" width="{shown}" alt="{html.escape(caption)}">{below}<figcaption>{html.escape(caption)}</figcaption></figure>')

    def video(self, file, caption):
        """`file`: its name in images/."""
        self.body.append(f'<figure><video src="images/{file}" controls loop muted></video><figcaption>{html.escape(caption)}</figcaption></figure>')

    def svg(self, drawing):
        self.body.append(drawing)

    def write(self):
        """Whole after every part, so that a run that is cut short leaves a page."""
        page = (f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{html.escape(self.title)}</title>'
                f"<style>{STYLE}</style>" + "\n".join(self.body) + "</html>\n")
        for name, content in (("index.html", page), ("tables.md", "".join(self.text))):
            temporary = self.folder / (name + ".part")
            temporary.write_text(content)
            os.replace(temporary, self.folder / name)


def run_parts(parser, args, parts, make):
    """Runs the parts that args.parts names, in that order, on make(args), which has a page; the page is whole after each."""
    args.out.mkdir(parents=True, exist_ok=True)
    wanted = args.parts.split(",")
    for part in wanted:
        if part not in parts:
            parser.error(f"there is no part {part}; the parts are {', '.join(parts)}")
    experiments = make(args)
    for part in wanted:
        parts[part](experiments)
        experiments.page.write()
    print(f"wrote {args.out / 'index.html'}")
