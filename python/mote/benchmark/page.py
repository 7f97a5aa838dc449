"""The page: one HTML file with ranks, a table for each scene, its pictures, and what was refused or left out."""
from __future__ import annotations

import base64
from html import escape
from pathlib import Path
from typing import Any, Dict, List, Sequence

import numpy as np

from .._picture import Picture
from .references import References
from .report import RANK_HEAD, SCENE_HEAD, Judged, models, rank_rows, ranks, scene_rows, scenes_of
from .suite import Scene, Suite

WIDTH = 200  # pixels of a small picture
TINTS = {"edges": (1.0, 0.3, 0.1), "media": (0.2, 0.5, 1.0), "shadows": (0.5, 0.2, 0.6), "rest": (0.8, 0.8, 0.8)}
STYLE = """body{font-family:sans-serif;max-width:80em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;font-size:85%}
td,th{border:1px solid #ccc;padding:.3em .5em;text-align:left}figure{display:inline-block;margin:.3em;font-size:75%}
.refused{color:#a00}figcaption{max-width:15em}"""
LEGEND = """Error: relative RMSE of one picture, without the noise of either reference; bias: signed; in brackets the ends of intervals of
95 %. Systematic: what all seeds share. Regions do not overlap: edges, media, shadows (less than a tenth of the light direct), rest. Seconds:
≤ the first budget suffices, ≈ extrapolated by 1/sqrt(t) for unbiased methods. Ranks are those at the largest budget; their intervals come
from scenes and seeds resampled; a mean rank hides a failure, so the worst scene stands beside it."""


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    cells = lambda kind, words: "".join(f"<{kind}>{escape(w)}</{kind}>" for w in words)  # noqa: E731
    return f"<table>\n<tr>{cells('th', head)}</tr>\n" + "".join(f"<tr>{cells('td', row)}</tr>\n" for row in rows) + "</table>\n"


def _figure(pixels: np.ndarray, exposure: float, caption: str) -> str:
    png = base64.b64encode(Picture({"beauty": pixels.astype(np.float32)}).png(exposure=exposure)).decode()
    return (f'<figure><img width="{WIDTH}" alt="{escape(caption)}" src="data:image/png;base64,{png}">'
            f"<figcaption>{escape(caption)}</figcaption></figure>\n")


def exposure_of(pixels: np.ndarray) -> float:
    """Stops by which all pictures of a scene are shown: 97 % of the reference are below 1."""
    bright = float(np.percentile(np.abs(pixels).mean(axis=2), 97))
    return float(-np.log2(bright)) if bright > 0 else 0.0


def _regions(references: References) -> np.ndarray:
    picture = np.zeros_like(references.first, dtype=np.float32)
    for name, mask in references.regions.items():
        if name in TINTS:
            picture[mask] = TINTS[name]
    return picture


def _figures(judged: Sequence[Judged], scene: Scene, references: References) -> str:
    exposure = exposure_of(references.mean())
    shown = [_figure(references.mean(), exposure, "mean of both references"),
             _figure(_regions(references), 0.0, "regions: " + ", ".join(n for n in references.regions if n in TINTS))]
    for j in judged:
        entries = j.submission.at(scene.name, scene.budgets[-1])
        if entries:
            shown.append(_figure(j.submission.picture(entries[0]), exposure, f"{j.submission.method}, {entries[0].wall_s:.2f} s"))
    return "".join(shown)


def _scene(judged: Sequence[Judged], scene: Scene, suite: Suite, references: References, noise: Dict[str, float]) -> List[str]:
    said = "; ".join(f"{name} {100 * value:.2f} %" for name, value in noise.items())
    notes = [f"Licence: {scene.licence}." + f" {scene.origin}" * bool(scene.origin), f"{scene.width} x {scene.height} pixels.",
             f"Noise of each reference: {said}." if said else ""]
    return [f"<h2>{escape(scene.title)}</h2><p>{escape(scene.tests)} {escape(' '.join(notes))}</p>",
            _figures(judged, scene, references), _table(SCENE_HEAD, [row for j in judged for row in scene_rows(j, scene.name, suite)]),
            *(f"<p>{escape(line)}.</p>" for line in models(judged, scene.name))]


def _submission(j: Judged) -> str:
    s = j.submission
    settings = " ".join(f"{k}={v}" for k, v in s.settings.items())
    words = [f"{s.version} {settings}, {s.kind}, noise {s.noise}, {s.machine['threads']} threads of {s.machine['processor']}"]
    words += [f"left out: {o['scene']}{' at ' + format(o['budget_s'], 'g') + ' s' if 'budget_s' in o else ''}: {o['reason']}"
              for o in s.left_out] + list(s.notes)
    found = [f'<span class="refused">refused: {escape(f.scene)} {escape(f.check)}: {escape(f.text)}</span>' for f in j.findings]
    return f"<li><b>{escape(s.method)}</b>: " + "; ".join([escape(w) for w in words] + found) + "</li>\n"


def write_page(path: Path, judged: Sequence[Judged], suite: Suite, references: Dict[str, References], noise: Dict[str, Dict[str, float]],
               facts: Dict[str, Any]) -> None:
    """noise: of each reference by scene and region."""
    title = f"Benchmark {suite.label()}"
    parts = [f"<!doctype html><meta charset='utf-8'><title>{escape(title)}</title><style>{STYLE}</style>", f"<h1>{escape(title)}</h1>",
             f"<p>{escape(LEGEND)}</p>"]
    for name, of in ranks(judged, suite).items():
        parts += [f"<h2>Ranks, {name}</h2>", _table(RANK_HEAD, rank_rows(of))]
    for scene in scenes_of(judged, suite):
        parts += _scene(judged, suite.scene(scene), suite, references[scene], noise.get(scene, {}))
    parts += ["<h2>Submissions</h2><ul>", *(_submission(j) for j in judged), "</ul>"]
    parts += ["<p>" + escape("; ".join(f"{k}: {v}" for k, v in facts.items())) + "</p>"]
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")
