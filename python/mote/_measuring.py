"""What is measured of pictures and done to them: `mote compare`, `mote ssbc` and `mote denoise` on arrays."""
from __future__ import annotations

from typing import Any, Dict, Iterable, Iterator, Mapping, Optional, Sequence, Union

import numpy as np

from . import _mote
from ._paths import oidn_package
from ._picture import Picture

Image = Union[Picture, np.ndarray]


def _pixels(image: Optional[Image], layer: str) -> Optional[np.ndarray]:
    if image is None:
        return None
    array = np.ascontiguousarray(image[layer] if isinstance(image, Picture) else image, dtype=np.float32)
    if array.ndim == 2:
        array = np.repeat(array[:, :, np.newaxis], 3, axis=2)
    if array.ndim != 3 or array.shape[2] != 3:
        raise ValueError(f"a picture has the shape (height, width, 3), not {array.shape}")
    return array


def _variance(image: Optional[Image], given: Optional[np.ndarray], layer: str) -> Optional[np.ndarray]:
    if given is not None or not isinstance(image, Picture):
        return _pixels(given, layer)
    name = "Variance" if layer == "beauty" else f"Variance.{layer}"
    if name not in image:
        return None
    # Passes are Sobol points: the mean varies less than independent ones would (docs/testing.md).
    gain = float(image.metadata.get("varianceGain", 1.0)) if layer == "beauty" else 1.0
    return np.ascontiguousarray(image[name] * np.float32(gain))


def _measure(reference: Image, second: Optional[Image], layer: str, reference_variance: Optional[np.ndarray],
             second_variance: Optional[np.ndarray], mask: Optional[np.ndarray]) -> Any:
    counted = None if mask is None else np.ascontiguousarray(mask, dtype=bool).view(np.uint8)
    return _mote.error_measure(_pixels(reference, layer), _variance(reference, reference_variance, layer),
                               _pixels(second, layer), _variance(second, second_variance, layer), counted)


def series_error(images: Sequence[Image], reference: Image, second: Optional[Image] = None, *, layer: str = "beauty",
                 mask: Optional[np.ndarray] = None, reference_variance: Optional[np.ndarray] = None,
                 second_variance: Optional[np.ndarray] = None) -> Dict[str, float]:
    """The error of one method from pictures that differ in their seeds, in the measure of compare().

    "error": relative RMSE of one picture, the root of "squared_error", which noise may turn negative; "bias"; both with
    their "..._standard_error" from the spread of pictures (the error of one picture: from that of pixels). "systematic":
    the relative RMSE that any two pictures share, with its standard error; "noise": the rest, of one picture; NaN for one.
    With `second`, a reference of another seed, all are free of the noise of both. mask: which pixels count (height,
    width). Pictures, references and variances are as in compare().
    """
    return _mote.series_error([_pixels(image, layer) for image in images],
                              _measure(reference, second, layer, reference_variance, second_variance, mask))


def pixel_errors(image: Image, reference: Image, second: Optional[Image] = None, *, layer: str = "beauty",
                 mask: Optional[np.ndarray] = None, reference_variance: Optional[np.ndarray] = None,
                 second_variance: Optional[np.ndarray] = None) -> np.ndarray:
    """The squared error pixel by pixel (height, width): the mean of the pixels that count is "squared_error" of
    series_error(), so single pixels, and with two references also means, may be negative."""
    return _mote.pixel_errors(_pixels(image, layer),
                              _measure(reference, second, layer, reference_variance, second_variance, mask))


def compare(image: Image, reference: Image, second: Optional[Image] = None, *, layer: str = "beauty",
            variance: Optional[np.ndarray] = None, reference_variance: Optional[np.ndarray] = None,
            second_variance: Optional[np.ndarray] = None) -> Dict[str, float]:
    """The error of a picture against a reference: "error", "bias", "noise", "mse", "relmse", "ssim", ..., as `mote
    compare` has them; metric_definitions() says what each is.

    Pictures, of which `layer` is compared, or arrays (height, width, 3) of linear radiance. second: a reference of
    another seed; error and bias then hold none of the noise of either. The variances are those of the means, pixel by
    pixel, in the square of the pictures' unit; a Picture brings its own. What depends on one that is not known, or on a
    pixel that is not finite, is NaN.
    """
    return _mote.compare(_pixels(image, layer), _pixels(reference, layer), _variance(image, variance, layer),
                         _variance(reference, reference_variance, layer), _pixels(second, layer),
                         _variance(second, second_variance, layer))


def metric_definitions() -> Dict[str, str]:
    """What each number of compare() is, in a line. d is image - reference, r the reference."""
    return _mote.metric_definitions()


def ssbc(picture: Image, *, bound: float = 0.0, steps: int = 2, position: Optional[np.ndarray] = None,
         normal: Optional[np.ndarray] = None, albedo: Optional[np.ndarray] = None,
         world_to_camera: Optional[Any] = None, flat: bool = False, half_resolution: bool = False, blur: float = 0.0,
         replace: bool = False) -> Picture:
    """Screen-space bias compensation: a copy of the picture with the light that a bound on the geometry term took,
    found in the picture itself (docs/methods/compensation.md), in its beauty and as the layer "compensation_surface".

    A Picture that was rendered with auxiliary=True holds all that is needed. For an array of reflected radiance
    (height, width, 3), of whatever renderer, give `position` [m], `normal` and diffuse `albedo` in [0, 1], each
    (height, width, 3) at the centres of the pixels, and unless positions are in camera space `world_to_camera`: 16
    numbers for row vectors, z forward or backward, as OpenEXR has them. bound [1/m^2]: 0 is the picture's own. steps: how often light is
    carried on. flat: exact, and slow. half_resolution: gather at one pixel of four. blur: standard deviation of an
    edge-preserving blur [pixels]. replace: take out the compensation that is there. Raises mote.Error.
    """
    result = picture.copy() if isinstance(picture, Picture) else Picture({"beauty": _pixels(picture, "beauty")})
    for name, values in (("Center.P", position), ("Center.N", normal), ("Center.DiffuseAlbedo", albedo)):
        if values is not None:
            result[name] = values
    if world_to_camera is not None:
        result._picture.set_metadata("worldToCamera", " ".join(f"{x:.9g}" for x in np.ravel(world_to_camera)))
    result._picture.compensate(bound, steps, flat, half_resolution, blur, replace)
    return result


def denoise(picture: Image, method: str = "bmfr", *, features: Optional[Mapping[str, np.ndarray]] = None,
            threads: int = 0) -> Picture:
    """A copy of the picture with the layer "denoised": by regression on features ("bmfr"), or by OpenImageDenoise
    ("oidn") where it is installed.

    A Picture brings its features (render with auxiliary=True or denoise=...). For an array of radiance give them by
    name: "Albedo" (height, width, 3), "Ns" (unit normals), "P" [m], "Depth" (height, width) [m], "Variance" of the mean.
    Raises mote.Error.
    """
    result = _with_features(picture, features)
    result._picture.denoise(method, threads, oidn_package(method))
    return result


def _with_features(picture: Image, features: Optional[Mapping[str, np.ndarray]]) -> Picture:
    result = picture.copy() if isinstance(picture, Picture) else Picture({"beauty": _pixels(picture, "beauty")})
    for name, values in (features or {}).items():
        result[name] = values
    return result


def denoise_sequence(frames: Iterable[Image], features: Optional[Iterable[Mapping[str, np.ndarray]]] = None) -> Iterator[Picture]:
    """Copies of the frames of a sequence, in their order and one by one as they are requested, each with the layer
    "denoised": by regression on features, and by what earlier frames show of the same places (docs/methods/denoising.md).

    Frames have one size and the same layers. For arrays of radiance give the features of each frame by name, as denoise()
    takes them. What moved is known from "MotionVector" (height, width, 3) [pixels; x and y, to the place in the frame
    before], else from "P" and the metadata "worldToCamera" of pictures; without either no frame takes anything from those
    before. Raises mote.Error.
    """
    sequence = _mote.Sequence()
    of_frame = iter(features) if features is not None else None
    for frame in frames:
        given = next(of_frame, None) if of_frame else None
        if of_frame and given is None:
            raise ValueError("there are fewer features than frames")
        result = _with_features(frame, given)
        sequence.denoise(result._picture)
        yield result
