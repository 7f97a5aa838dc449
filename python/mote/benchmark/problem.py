"""Errors of the benchmark's inputs, one line for each file and reason, with the nearest right word."""
from __future__ import annotations

import difflib
import json
from pathlib import Path
from typing import Any, Iterable, List, Mapping, Tuple


class BenchmarkError(Exception):
    """Inputs that are refused. `lines`: "FILE: REASON" each."""

    def __init__(self, *lines: str) -> None:
        super().__init__("\n".join(lines))
        self.lines = list(lines)


def hint(word: object, known: Iterable[object]) -> str:
    """" (did you mean 'x'?)", or all known words where none is near."""
    words = [str(k) for k in known]
    near = difflib.get_close_matches(str(word), words, 1)
    return f" (did you mean '{near[0]}'?)" if near else f" (known: {', '.join(words)})"


def read_json(path: Path) -> Any:
    """Raises BenchmarkError with line and column of what is no JSON."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as problem:
        raise BenchmarkError(f"{path}: cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise BenchmarkError(f"{path}: no text in UTF-8") from None
    except json.JSONDecodeError as problem:
        raise BenchmarkError(f"{path}:{problem.lineno}:{problem.colno}: no JSON: {problem.msg}") from None


def key_problems(where: str, given: Any, needed: Mapping[str, Tuple[type, ...]], optional: Mapping[str, Tuple[type, ...]]) -> List[str]:
    """Lines about keys that are unknown, missing or of another type than `needed` and `optional` have."""
    if not isinstance(given, dict):
        return [f"{where}: an object in braces is expected"]
    known = {**needed, **optional}
    lines = [f"{where}: unknown '{key}'{hint(key, known)}" for key in given if key not in known]
    lines += [f"{where}: '{key}' is missing" for key in needed if key not in given]
    for key, types in known.items():
        value = given.get(key)
        if key in given and (not isinstance(value, types) or isinstance(value, bool) and bool not in types):
            lines.append(f"{where}: '{key}' is {json.dumps(value)[:40]}, and must be {' or '.join(NAMES[t] for t in types)}")
    return lines


NAMES = {str: "a text", int: "a whole number", float: "a number", bool: "true or false", list: "a list", dict: "an object"}
