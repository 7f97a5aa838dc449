"""mote: many-light rendering and participating media.

    import mote
    scene = mote.load("scene.xml", paths=256)            # a file, with its $parameters; or mote.Scene({...})
    picture = mote.render(scene, passes=16, seed=1)
    picture["beauty"]                                    # float32 array (height, width, 3), radiance in W/(m^2 sr)

A render has the same bits as that of the command `mote render` with the same scene, seed and passes.

`import mote` loads neither the compiled module nor NumPy; the first use of a name does (PEP 562). `python -m mote.cluster` and
`python -m mote.benchmark` need neither.
"""
from importlib import import_module

TYPE_CHECKING = False  # type checkers take it for true; `typing` is not loaded for it
if TYPE_CHECKING:  # for type checkers and editors; the same names as in _MODULES, as tests/python/module_test.py checks
    from ._algorithms import HostLight, LightTree, bundle_links, count_visible, epipolar, micro_irradiance, upsample
    from ._errors import Error
    from ._manual import Manual, manual
    from ._measuring import compare, denoise, denoise_sequence, metric_definitions, pixel_errors, series_error, ssbc
    from ._mote import version as __version__
    from ._picture import Picture
    from ._rendering import render
    from ._scene import Scene, load, load_string
    from ._trade import trade
    from ._transform import ScalarTransform4f, Transform
    from ._view import view

_MODULES = {
    "_algorithms": ["HostLight", "LightTree", "bundle_links", "count_visible", "epipolar", "micro_irradiance", "upsample"],
    "_errors": ["Error"],
    "_manual": ["Manual", "manual"],
    "_measuring": ["compare", "denoise", "denoise_sequence", "metric_definitions", "pixel_errors", "series_error", "ssbc"],
    "_picture": ["Picture"],
    "_rendering": ["render"],
    "_scene": ["Scene", "load", "load_string"],
    "_trade": ["trade"],
    "_transform": ["ScalarTransform4f", "Transform"],
    "_view": ["view"],
}
_HOME = {name: module for module, names in _MODULES.items() for name in names}
__all__ = ["Error", "HostLight", "LightTree", "Manual", "Picture", "ScalarTransform4f", "Scene", "Transform", "bundle_links",
           "compare", "count_visible", "denoise", "denoise_sequence", "epipolar", "load", "load_string", "manual", "metric_definitions",
           "micro_irradiance", "pixel_errors", "render", "series_error", "ssbc", "trade", "upsample", "view"]


def __getattr__(name):
    """A public name at its first use, kept from then on."""
    if name not in _HOME and name != "__version__":
        raise AttributeError(f"module 'mote' has no attribute '{name}'")
    try:
        import_module("._errors", __name__)  # registers mote.Error with the compiled module
    except ImportError as problem:
        raise AttributeError(f"mote.{name} needs the compiled module mote._mote, which 'pip install .' builds: {problem}") from problem
    module, attribute = ("_mote", "version") if name == "__version__" else (_HOME[name], name)
    globals()[name] = found = getattr(import_module(f".{module}", __name__), attribute)
    return found


def __dir__():
    return sorted({*globals(), *__all__, "__version__"})
