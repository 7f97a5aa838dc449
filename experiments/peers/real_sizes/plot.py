"""An SVG of errors against time, both in logarithms: a line for each method, whiskers of one standard error. One colour a
renderer; dashed: as the passes left it, without denoiser."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 720, 430, 64, 40, 190, 48
COLOURS = {"mote path tracer": "#1b6ca8", "mote layers": "#d1495b", "mote VPL": "#e08e0b", "Mitsuba": "#5b8c5a",
           "Cycles": "#7a4fa3", "Cycles, guided": "#333333"}


def ticks(low, high):
    """1, 2 and 5 times powers of ten."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [m * 10.0**p for p in powers for m in (1, 2, 5) if low <= m * 10.0**p <= high]


class Axes:
    def __init__(self, times, errors):
        self.t = (min(times) / 1.3, max(times) * 1.3)
        self.e = (min([*errors, 0.05]) / 1.3, max([*errors, 0.1]) * 1.3)

    def x(self, seconds):
        share = math.log(seconds / self.t[0]) / math.log(self.t[1] / self.t[0])
        return LEFT + share * (WIDTH - LEFT - RIGHT)

    def y(self, error):
        share = math.log(max(error, self.e[0]) / self.e[0]) / math.log(self.e[1] / self.e[0])
        return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)

    def marks(self):
        lines = []
        for t in ticks(*self.t):
            lines.append(line(self.x(t), TOP, self.x(t), HEIGHT - BOTTOM, "#e4e4e4"))
            lines.append(text(self.x(t), HEIGHT - BOTTOM + 16, f"{t:g}", "middle"))
        for e in ticks(*self.e):
            strong = any(abs(e - target) < 1e-9 for target in (0.05, 0.02, 0.01))
            lines.append(line(LEFT, self.y(e), WIDTH - RIGHT, self.y(e), "#999999" if strong else "#e4e4e4"))
            lines.append(text(LEFT - 6, self.y(e) + 4, f"{100 * e:g} %", "end"))
        lines.append(text(LEFT, TOP - 6, "relative RMSE"))
        lines.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, "seconds of rendering, two cores", "middle"))
        return lines


def line(x0, y0, x1, y1, colour, width=1):
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="{colour}" stroke-width="{width}"/>'


def text(x, y, words, anchor="start", size=12):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}">{escape(words)}</text>'


def series(axes, index, name, runs, raw):
    """A line through the pictures, and its name on the right."""
    colour = COLOURS[name.removesuffix(" + OIDN").removesuffix(", no filter")]
    points = [r for r in runs if r["error"] > 0]
    corners = " ".join(f"{axes.x(r['wall_s']):.1f},{axes.y(r['error']):.1f}" for r in points)
    style = ' stroke-dasharray="6 4"' if raw else ""
    marks = [f'<polyline points="{corners}" fill="none" stroke="{colour}" stroke-width="2"{style}/>']
    for r in points:
        x, low, high = axes.x(r["wall_s"]), r["error"] - r["error_se"], r["error"] + r["error_se"]
        marks.append(line(x, axes.y(max(low, 1e-9)), x, axes.y(high), colour))
        marks.append(f'<circle cx="{x:.1f}" cy="{axes.y(r["error"]):.1f}" r="3" fill="{colour}"/>')
    y = TOP + 14 + 20 * index
    marks.append(f'<line x1="{WIDTH - RIGHT + 12}" y1="{y - 4}" x2="{WIDTH - RIGHT + 36}" y2="{y - 4}" '
                 f'stroke="{colour}" stroke-width="2"{style}/>')
    return marks + [text(WIDTH - RIGHT + 42, y, name)]


def svg(title, methods):
    """methods: (name, runs, without denoiser)."""
    lit = [run for _, runs, _ in methods for run in runs if run["error"] > 0]
    if not lit:
        return ""
    axes = Axes([r["wall_s"] for r in lit], [r["error"] for r in lit])
    body = axes.marks() + [text(LEFT, 22, title, size=15)]
    for index, (name, runs, raw) in enumerate(methods):
        body += series(axes, index, name, runs, raw)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">\n'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(body) + "\n</svg>\n")
