"""The tables: CSV with every picture, rows of times for one scene, and a page with all scenes."""
import csv
from html import escape

from times import TARGETS, noise_alone, time_to, variance_time

COLUMNS = ("scene", "method", "version", "settings", "passes", "seed", "wall_s", "cpu_s", "build_s", "error", "error_se",
           "bias", "bias_se", "mean", "mean_se", "non_finite", "samples_per_s")
SPEED_COLUMNS = ("scene", "method", "version", "settings", "passes", "wall_s", "million_samples_per_s", "variance_time_s",
                 "variance_time_se")
MARKS = {"measured": "", "below": "≤ ", "by slope": "≈ "}


def write_csv(path, facts, scene, methods):
    """Every picture a line, after lines with '# ' that say where it comes from."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        for key, value in facts.items():
            file.write(f"# {key}: {value}\n")
        table = csv.DictWriter(file, COLUMNS, extrasaction="ignore")
        table.writeheader()
        for m in methods:
            for run in m["runs"]:
                numbers = {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in run.items()}
                table.writerow({"build_s": f"{m['build_s']:.4g}", **numbers, "scene": scene, "method": m["name"],
                                "version": m["version"], "settings": m["settings"]})


def seconds_text(value, how):
    if value is None:
        return {"bias": "never: bias"}.get(how, "-")
    digits = f"{value:.2g}" if value < 100 else f"{value:.0f}"
    return MARKS[how] + digits


def variance_time_of(m):
    """Of unbiased methods, of peers without the difference of their model."""
    if not m["unbiased"]:
        return None
    return variance_time(m["runs"], m["model"])


def variance_time_text(m):
    found = variance_time_of(m)
    return "-" if found is None else f"{found[0]:.3g} ± {found[1]:.2g}"


def write_speed(folder, facts, scenes):
    """speed.csv and speed.md: samples a second, and variance times time, of the unbiased methods of all scenes."""
    lines = [["scene", "method", "M samples/s", "variance x time [s]"], ["---"] * 4]
    with open(folder / "speed.csv", "w", newline="", encoding="utf-8") as file:
        for key, value in facts.items():
            file.write(f"# {key}: {value}\n")
        table = csv.DictWriter(file, SPEED_COLUMNS)
        table.writeheader()
        for scene, methods in scenes:
            for m in (m for m in methods if m["unbiased"]):
                last, (value, error) = m["runs"][-1], variance_time_of(m)
                rate = f"{last['samples_per_s'] / 1e6:.3g}"
                table.writerow({"scene": scene, "method": m["name"], "version": m["version"], "settings": m["settings"],
                                "passes": last["passes"], "wall_s": f"{last['wall_s']:.4g}", "million_samples_per_s": rate,
                                "variance_time_s": f"{value:.4g}", "variance_time_se": f"{error:.2g}"})
                lines.append([scene, m["name"], rate, variance_time_text(m)])
    text = "\n".join("| " + " | ".join(cells) + " |" for cells in lines) + "\n"
    (folder / "speed.md").write_text(text, encoding="utf-8")
    return text


def row(m):
    """Row of the table: name, times to the targets (wall, and processor seconds in brackets), the last image, bias."""
    runs = noise_alone(m["runs"], m["model"])
    cells = [m["name"]]
    for target in TARGETS:
        wall, cpu = (time_to(target, runs, seconds, m["unbiased"]) for seconds in ("wall_s", "cpu_s"))
        cells.append(seconds_text(*wall) + (f" ({seconds_text(*cpu)})" if cpu[0] is not None else ""))
    last = m["runs"][-1]
    percent = lambda value, error, sign="": f"{100 * value:{sign}.2f} ± {100 * error:.2f} %"
    cells += [f"{last['samples_per_s'] / 1e6:.2f}", variance_time_text(m)]
    return cells + [f"{last['passes']} in {last['wall_s']:.1f} s: {percent(last['error'], last['error_se'])}",
                    percent(last["bias"], last["bias_se"], "+"), percent(*m["systematic"]) if len(runs) > 1 else "-", f"{m['build_s']:.1f} s"]


HEAD = ("method", *(f"s to {100 * t:g} %" for t in TARGETS), "M samples/s", "variance x time [s]", "last picture", "bias", "systematic", "loading")


def markdown(methods):
    lines = [HEAD, ["---"] * len(HEAD), *map(row, methods)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines) + "\n"


def html_table(methods):
    cells = lambda kind, words: "".join(f"<{kind}>{escape(w)}</{kind}>" for w in words)
    rows = "".join(f"<tr>{cells('td', row(m))}</tr>\n" for m in methods)
    return f"<table>\n<tr>{cells('th', HEAD)}</tr>\n{rows}</table>\n"


LEGEND = """Seconds of rendering on the wall of two cores, loading and compiling apart; processor seconds in brackets.
No mark: between two measured pictures; ≈: beyond the last one, by 1/sqrt(t) for unbiased methods, by the slope of the last two for
others; ≤: the first picture was better already.
The error is the relative RMSE of docs/testing.md, "Error and noise", Eq. 1 and 2, measured with two independent references
so that it is free of their noise. Bias: signed, of the last picture. Systematic: what two
independent pictures have in common, without noise; where it is below its
standard error it is 0. Variance x time: the square of the last picture's error times its seconds, for unbiased methods.
From other renderers' errors the systematic part of their picture without denoiser is taken off: a difference of models."""


def write_page(path, facts, scenes):
    """scenes: (title, svg text, methods, notes)."""
    parts = ["<!doctype html><meta charset='utf-8'><title>mote and its peers</title><style>body{font-family:sans-serif;"
             "max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;font-size:85%}"
             "td,th{border:1px solid #ccc;padding:.3em .5em;text-align:left}svg{max-width:46em;height:auto}</style>",
             "<h1>mote and its peers</h1>", f"<p>{escape(LEGEND)}</p>",
             "<p>" + "<br>".join(f"{escape(k)}: {escape(str(v))}" for k, v in facts.items()) + "</p>"]
    for title, drawing, methods, notes in scenes:
        parts += [f"<h2>{escape(title)}</h2>", drawing, html_table(methods)]
        parts += ["<ul>" + "".join(f"<li>{escape(n)}</li>" for n in notes) + "</ul>"] if notes else []
    path.write_text("\n".join(parts), encoding="utf-8")
