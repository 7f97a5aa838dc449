"""Errors of pictures, all by the one measure of `mote compare` (docs/testing.md, Error and noise).

Pictures are arrays: height * width * 3, or height * width for one channel. `references`: a list of one, or of two seeds,
whose noise is then in no error. Needs the Python module (tools/python_packages.sh, then tools/build_release.sh mote_python).
"""
import functools
import importlib
import sys
from pathlib import Path

import numpy as np

LABEL = "relative RMSE"  # of axes and columns: docs/testing.md, Eq. 1 and 2
_folder = Path(__file__).resolve().parents[2] / "build" / "release" / "python"


def use(bin_folder):
    """From now on the module of the build whose programs are in this folder."""
    global _folder
    _folder = Path(bin_folder).resolve().parent / "python"


@functools.lru_cache(maxsize=None)
def module():
    """The module of the build, else an installed one."""
    sys.path.insert(0, str(_folder))
    return importlib.import_module("mote")


def _arrays(pictures):
    return [np.asarray(picture) for picture in pictures]


def _options(mask, variances):
    names = ("reference_variance", "second_variance")
    return {"mask": mask, **dict(zip(names, _arrays(variances or ())))}


def counted_work(statistics):
    """Work of a render [closest hits], by the weights of core/render/counted_work.cpp."""
    rays, lookups = statistics["rays"], statistics["lookups"]
    return (rays.get("closest", 0) + 0.5 * rays.get("occlusion", 0) + 0.5 * rays.get("boundary", 0)
            + (lookups.get("density", 0) + 2 * lookups.get("shadow_maps", 0)
               + statistics["values"].get("march_steps", 0)) / 32)


def series_error(pictures, references, mask=None, variances=None):
    """For pictures by one method: "error" of one of them, "squared_error", "bias", "systematic", "noise", ... as
    mote.series_error() has them. mask: pixels that count. variances: those of the references' means."""
    return module().series_error(_arrays(pictures), *_arrays(references), **_options(mask, variances))


def error(picture, references, mask=None, variances=None):
    """The relative RMSE of one picture."""
    return series_error([picture], references, mask, variances)["error"]


def pixel_errors(picture, references, mask=None, variances=None):
    """Squared errors by pixel, whose mean is the square of error()."""
    return module().pixel_errors(np.asarray(picture), *_arrays(references), **_options(mask, variances))
