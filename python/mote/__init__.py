"""mote: many-light rendering and participating media.

    import mote
    scene = mote.load("scene.xml", paths=256)            # a file, with its $parameters; or mote.Scene({...})
    picture = mote.render(scene, passes=16, seed=1)
    picture["beauty"]                                    # float32 array (height, width, 3), radiance in W/(m^2 sr)

A render has the same bits as that of the command `mote render` with the same scene, seed and passes.
"""
try:
    from . import _mote
except ImportError as problem:  # `python -m mote.cluster` needs the command alone
    _problem = problem

    def __getattr__(name):
        raise AttributeError(f"mote.{name} needs the compiled module mote._mote, which 'pip install .' builds: {_problem}")
else:
    from ._algorithms import HostLight, LightTree, bundle_links, count_visible, epipolar, micro_irradiance, upsample
    from ._errors import Error
    from ._mote import version as __version__
    from ._manual import Manual, manual
    from ._picture import Picture
    from ._rendering import render
    from ._scene import Scene, load, load_string
    from ._measuring import compare, denoise, denoise_sequence, metric_definitions, pixel_errors, series_error, ssbc
    from ._trade import trade
    from ._transform import ScalarTransform4f, Transform
    from ._view import view

    __all__ = ["Error", "HostLight", "LightTree", "Manual", "Picture", "ScalarTransform4f", "Scene", "Transform", "bundle_links",
               "compare", "count_visible", "denoise", "denoise_sequence", "epipolar", "load", "load_string", "manual", "metric_definitions",
               "micro_irradiance", "pixel_errors", "render", "series_error", "ssbc", "trade", "upsample", "view"]
