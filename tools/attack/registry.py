"""Types and their parameters, as the program declares them: a type takes part in the attack by being registered."""
import importlib
import math
import random

BUDGET = 4096  # integers of integrators beyond this are amounts of work: their upper end takes hours


BEYOND = 0.2  # probability of a value outside of the range, which every integrator must refuse


class Registry:
    def __init__(self):
        self.pages = importlib.import_module("mote._manual").manuals()

    def names(self, category):
        return [page["type"] for page in self.pages if page["category"] == category]

    def examples(self, category, only=None):
        """Examples of the manual pages that need no file: of all types, or of those in `only`."""
        return [page["example"] for page in self.pages
                if page["category"] == category and page["example"] and "filename" not in page["example"]
                and page["type"] not in ("null",) and (only is None or page["type"] in only)]

    def page(self, category, name):
        return next(page for page in self.pages if page["category"] == category and page["type"] == name)

    def has_parameter(self, integrator, name):
        return any(p["name"] == name for p in self.page("integrator", integrator)["parameters"])


def ends(parameter, is_integrator, rng):
    """A value at or just beyond an end of the declared range, as text; None where there is no such value."""
    if parameter["choices"]:
        return rng.choice(parameter["choices"])
    if parameter["type"] == "boolean":
        return rng.choice(("true", "false"))
    lower, upper = bound(parameter["lower"], -math.inf), bound(parameter["upper"], math.inf)
    if parameter["type"] == "integer":
        inside = (lower, lower, lower + 1, upper, upper, upper - 1)
        chosen = (lower - 1, upper + 1) if rng.random() < BEYOND else inside
        values = [v for v in chosen if math.isfinite(v)]
        values = [str(int(v)) for v in values if not is_integrator or v <= BUDGET]
        return rng.choice(values or ["-2147483648", "2147483647"][:1 if is_integrator else 2])
    if parameter["type"] not in ("float", "rgb", "texture"):
        return None
    low = [lower, math.nextafter(lower, math.inf)] if math.isfinite(lower) else [-1e30, -3e38]
    high = [upper, math.nextafter(upper, -math.inf)] if math.isfinite(upper) else [1e30, 3e38]
    beyond = [v for v in (lower - 1.0, 2.0 * upper) if math.isfinite(v)] if rng.random() < BEYOND else []
    return f"{rng.choice(beyond or low + high + [max(lower, 1e-30)]):.9g}"


def bound(value, otherwise):
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else otherwise


CATEGORIES = ("bsdf", "bsdf", "phase", "emitter", "integrator", "integrator", "selection", "compensation", "visibility", "rfilter",
              "sampler", "medium")


def parameter_at_end(registry, rng):
    """(category, type, element): a random parameter at an end of its range; None where the type has none."""
    category = rng.choice(CATEGORIES)
    page = rng.choice([p for p in registry.pages if p["category"] == category])
    chosen = random.Random(rng.random())  # a new parameter changes nothing after it
    rows = [(p, ends(p, category == "integrator", chosen)) for p in page["parameters"]]
    rows = [(p, value) for p, value in rows if value is not None]
    if not rows:
        return None
    parameter, value = chosen.choice(rows)
    tag = "rgb" if parameter["type"] in ("rgb", "texture") else parameter["type"]
    return category, page["type"], f'<{tag} name="{parameter["name"]}" value="{value}"/>'
