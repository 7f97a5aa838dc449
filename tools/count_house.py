#!/usr/bin/env python3
"""Measures of how plain the source is: lines, parameters, structure of the methods, repeated declarations, twins, comments, words,
error measures.

Usage: count_house.py [--where] [ROOT]
Counts the committed files of the checkout ROOT (default: the one that holds this script). The goal stands beside each
number that has one. --where lists every place that is counted, as file:line.
"""
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(HERE / "tests/floors"), str(HERE / "tests/pages")]
import check_floors  # noqa: E402
import check_words  # noqa: E402

PRODUCT = ["core", "media", "lights", "compensation", "screenspace", "gathering", "integrators", "session", "apps", "trade", "viewer",
           "python", "plugins"]
CPP = {".h", ".cpp", ".c"}
GOAL_LINES, GOAL_PARAMETERS, GOAL_ESTIMATOR = 76000, 12, 150
NESTED = {"compensation", "visibility", "selection", "integrator"}  # types of rows that hold a type with rows of its own

GETTER = re.compile(r"(?:\.|->)(?:get|require)_(?:bool|int|int_in|float|float_in|string|rgb|rgb_in|vec3|transform|choice|file)\(")
# A row of a manual page with its default written out as text: a second statement of what a getter holds. Behind name, type
# and default stands a sentence or an expression; a list of names ends there or has another type.
TYPE = (r'"(?:boolean|integer|float|string|rgb|point|vector|transform|texture|volume|bsdf|shape|emitter|medium|phase|rfilter|'
        r'sampler|film|integrator|compensation|visibility|selection)"')
ROW = re.compile(rf'\{{\s*"[a-z_0-9]+",\s*{TYPE},\s*(?:"[^"\n]*"|[^",{{}}]+),(?!\s*{TYPE})')
COMMENT = re.compile(r"(?P<code>.*?)(?P<mark>//[/!]?<?)\s*(?P<text>.*)")
OPENING = re.compile(r"(?:Of|Whether|The same|What|Who|Whose|Whoever)\b")

# Structure of the methods, in integrators/ and lights/selection/.
ESTIMATOR = re.compile(r"\bclass \w+ final : public (?:core::)?Estimator \{")
STRUCTURE = {  # name: (pattern, goal)
    "packets of eye paths": (r"\bstd::optional<EyePath<\w+>> \w+;", 1),
    "image loops": (r"\bfor \(int x = x0; x < x1;", 1),
    "enums of selection": (r"\benum class \w*(?:Selection|SelectedBy)\w*\b", 0),
}

# Files that hold the words that are searched for.
HOLD_WORDS = {"tests/pages/check_words.py", "tests/pages/self_check.py", "tools/count_house.py", "tests/floors/count_house_check.py",
              "tests/floors/self_check.py"}

# name: (pattern over product code without comments, occurrences that are not twins)
TWINS = {
    "the cut by largest expected light": (r"\bstd::pop_heap\(cut_", 1),
    "the box of differences of positions": (r"max_of\(max_of\(x0, -x1\), 0\.0f\)", 1),
    "helpers for sixteen lanes": (r"struct alignas\(\d+\) Lane(?:s|Floats|Values|Light)\b|using Lanes = std::array<float", 2),
    "classes named LightTree": (r"\b(?:class|struct) LightTree(?: final)?(?: : [^;{]+)? \{", 1),
    "types named SurfacePoints": (r"\b(?:class|struct) SurfacePoints(?: final)?(?: : [^;{]+)? \{", 1),
    "classes named TracedVisibility": (r"\b(?:class|struct) TracedVisibility(?: final)?(?: : [^;{]+)? \{", 1),
    "samplers of all surfaces": (r"\bSurfaceSamples sample_surfaces\([^;{]*\{|\bSurfacePoints::SurfacePoints\(|"
                                 r"\bSurfels stratified_surfels\([^;{]*\)\s*\{", 1),
    "places that set a lane's shadow ray": (r"\borigin_x\[\w+\] = ", 1),
}

# Errors of pictures computed outside core/metrics: the squared difference from one reference or two, and the weights of
# squares.
ERROR_FOLDERS = ["experiments", "benchmark", "tests", "tools", "scenes", "docs", "python"]
NAME = r"[A-Za-z_][\w.\[\]\"']*"
ERROR = re.compile("|".join([
    rf"\({NAME} - {NAME}(?:\(axis=0\))?\)\s*\*\*\s*2",       # (x - r)^2, (x - mean r)^2
    rf"\({NAME} - {NAME}\)\s*\*\s*\({NAME} - {NAME}\)",      # (x - a) (x - b)
    rf"\w*difference\w*\)?\s*\*\*\s*2",                    # difference^2
    rf"\*\*\s*2\s*\+\s*(?:0\.01|1e-\d)\b",                 # the weights 1 / (r^2 + 0.01), ...
    rf"0\.01 \* np\.median\(",
    rf"np\.median\([^\n]*\)\s*/\s*10\)\s*\*\*\s*2",           # (m / 10)^2
    rf"\({NAME} / \({NAME} \+ {NAME}\(\)\)\)\s*\*\*\s*2",   # (d / (r + m))^2
]))

CPP_ERROR = re.compile(r"\b(\w+) \* \1 / \((?!\1\b)(\w+) \* \2 \+|\bsqr\(\w+\) / \((?:core::)?sqr\(\w+\) \+")  # d^2 / (r^2 + ...)


class House:
    def __init__(self, root):
        self.root = root
        self.files = check_floors.committed_files(root)
        self.places = {}  # what: ["file:line: text"]

    def name(self, path):
        return path.relative_to(self.root).as_posix()

    def cpp(self, folders):
        return [p for p in self.files if p.suffix in CPP and p.relative_to(self.root).parts[0] in folders]

    def lines_by_folder(self):
        counted = {}
        for path in self.cpp(PRODUCT):
            folder = path.relative_to(self.root).parts[0]
            counted[folder] = counted.get(folder, 0) + path.read_bytes().count(b"\n")
        return counted

    def find(self, what, pattern, paths):
        """Places of the pattern in code without comments."""
        places = self.places.setdefault(what, [])
        for path in paths:
            text = without_comments(path.read_text("utf-8", "replace"))
            places += [f"{self.name(path)}:{text.count(chr(10), 0, m.start()) + 1}" for m in re.finditer(pattern, text)]
        return len(places)

    def getters(self):
        return self.find("getters", GETTER, [p for p in self.cpp(PRODUCT) if not self.name(p).startswith("core/objects/")])

    def rows(self):
        return self.find("rows", ROW, self.cpp(PRODUCT))

    def twins(self):
        """By name: how many there are above what is needed."""
        counts = {}
        for name, (pattern, needed) in TWINS.items():
            counts[name] = max(0, self.find(name, pattern, self.cpp(PRODUCT)) - needed)
        return counts

    def parameters(self):
        """By integrator, (parameters, nested types): rows of its own table in docs/scene-format.md; what nested types hold is theirs."""
        page = self.root / "docs/scene-format.md"
        text = page.read_text("utf-8") if page.is_file() else ""
        section = re.search(r"^## Integrators\n(.*?)(?=^## |\Z)", text, re.M | re.S)
        types = lambda body: re.findall(r"^\| `\w+` \| (\w+)", body, re.M)
        return {name: (sum(t not in NESTED for t in types(body)), sum(t in NESTED for t in types(body)))
                for name, body in re.findall(r"^### `(\w+)`\n(.*?)(?=^### |\Z)", section.group(1) if section else "", re.M | re.S)}

    def structure(self):
        """By name: how often it stands in the methods."""
        paths = [p for p in self.cpp(PRODUCT) if self.name(p).startswith(("integrators/", "lights/selection/"))]
        return {name: self.find(name, pattern, paths) for name, (pattern, _) in STRUCTURE.items()}

    def estimators(self):
        """By file that holds an estimator's passes: its lines."""
        texts = {self.name(p): p.read_text("utf-8", "replace") for p in self.cpp(["integrators"])}
        return {name: text.count("\n") for name, text in texts.items() if ESTIMATOR.search(text)}

    def circles(self):
        places = self.places["circles of subfolders"] = list(check_floors.circles(self.root, self.files))
        return len(places)

    def openings(self, product):
        """Comments that begin with a listed word: in the product, or in all other C++."""
        what = "comments" if product else "comments elsewhere"
        places = self.places.setdefault(what, [])
        for path in self.files:
            if path.suffix in CPP and (path.relative_to(self.root).parts[0] in PRODUCT) == product:
                places += [f"{self.name(path)}:{number}: {text}" for number, text in beginnings(path.read_text("utf-8", "replace"))
                           if OPENING.match(text)]
        return len(places)

    def words(self):
        """Lines of C++ and Python with a word that the field has a better one for (tests/pages/check_words.py)."""
        places = self.places.setdefault("words", [])
        for path in self.files:
            if path.suffix in CPP | {".py"} and self.name(path) not in HOLD_WORDS:
                for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
                    found = check_words.first_word(line, check_words.CODE_WORDS)
                    if found:
                        places.append(f"{self.name(path)}:{number}: '{found[0]}': {found[1]}")
        return len(places)

    def error_measures(self):
        """The files that hold one: core/metrics together, every Python file and every other C++ file."""
        places = self.places.setdefault("error implementations", [])
        own = any(self.name(p).startswith("core/metrics/") for p in self.files)
        if own:
            places.append("core/metrics")
        for path in self.files:
            name, pattern = self.name(path), CPP_ERROR if path.suffix in CPP else ERROR
            if (path.suffix not in CPP | {".py"} or name.startswith(("core/metrics/", "tests/floors/", "tools/count_house.py"))
                    or path.suffix == ".py" and path.relative_to(self.root).parts[0] not in ERROR_FOLDERS):
                continue
            comment = "//" if path.suffix in CPP else "#"
            found = next((number for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1)
                          if pattern.search(line.split(comment)[0])), None)
            if found:
                places.append(f"{name}:{found}")
        return len(places)


def without_comments(text):
    """The text with its comments as blanks; lines stay where they are."""
    blank = lambda m: re.sub(r"[^\n]", " ", m.group(0)) if m.group(0)[0] == "/" else m.group(0)
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def beginnings(text):
    """(line, first line of a comment) of every comment: those that continue from the line before are one."""
    continued = False
    for number, line in enumerate(text.splitlines(), 1):
        found = COMMENT.match(re.sub(r'"(?:\\.|[^"\\])*"', '""', line))
        if found and not (continued and not found["code"].strip()):
            yield number, found["text"]
        # A comment behind code continues in the lines below it.
        continued = found is not None


def report(root, where=False):
    """The page as text."""
    house = House(root)
    lines, parameters, twins = house.lines_by_folder(), house.parameters(), house.twins()
    estimators, structure = house.estimators(), house.structure()
    rows = [("product C++ [lines]", sum(lines.values()), f"at most {GOAL_LINES}")]
    rows += [(f"  {folder}", count, "") for folder, count in lines.items()]
    rows += [("most parameters of an integrator", max((own for own, _ in parameters.values()), default=0), f"at most {GOAL_PARAMETERS}")]
    rows += [(f"  {name}", own, f"and {nested} nested types" if nested else "") for name, (own, nested) in parameters.items()]
    rows += [("longest file of an estimator [lines]", max(estimators.values(), default=0), f"at most {GOAL_ESTIMATOR}")]
    rows += [(f"  {name.removeprefix('integrators/')}", count, "") for name, count in estimators.items()]
    rows += [(name, count, str(STRUCTURE[name][1])) for name, count in structure.items()]
    rows += [("getters and rows stated apart", house.getters() + house.rows(), "0")]
    rows += [(f"  {what}", len(house.places[what]), "") for what in ("getters", "rows")]
    rows += [("circles of subfolders", house.circles(), "0")]
    rows += [("comments that begin with a listed word", house.openings(True), "0"),
             ("  elsewhere: tests, tools, experiments, examples", house.openings(False), "0")]
    rows += [("words that the field has better ones for", house.words(), "0")]
    rows += [("twins", sum(twins.values()), "0")] + [(f"  {name}", count, "") for name, count in twins.items()]
    rows += [("error implementations", house.error_measures(), "1")]
    page = [f"{name:<52}{count:>8}  {goal}".rstrip() for name, count, goal in rows]
    if where:
        page += [f"{what}: {place}" for what, places in house.places.items() for place in places]
    return "\n".join(page)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--where"]
    if len(arguments) > 1 or any(a.startswith("-") for a in arguments):
        print(__doc__, file=sys.stderr)
        return 2
    print(report(Path(arguments[0]).resolve() if arguments else HERE, "--where" in sys.argv))
    return 0


if __name__ == "__main__":
    sys.exit(main())
