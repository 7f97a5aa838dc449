"""OpenImageDenoise (pyoidn) over a picture with albedo and normals, both prefiltered."""
import numpy as np
import pyoidn


def filtered(device, images, quality=pyoidn.OIDN_QUALITY_DEFAULT, **flags):
    """The output of the RT filter over named images [height, width, 3]."""
    output = np.empty_like(images["color" if "color" in images else next(iter(images))])
    with pyoidn.Filter(device, pyoidn.OIDN_FILTER_TYPE_RT) as one:
        for name, image in {**images, "output": output}.items():
            one.set_image(name, image, pyoidn.OIDN_FORMAT_FLOAT3)
        for name, value in flags.items():
            one.set_bool(name, value)
        one.set_quality(quality)
        one.commit()
        one.execute()
    if device.get_error() is not None:
        raise RuntimeError(f"OpenImageDenoise: {device.get_error()}")
    return output


def denoised(image):
    """`image`: radiance, albedo, normals [height, width, 9]."""
    colour, albedo, normal = (np.ascontiguousarray(image[..., i:i + 3], np.float32) for i in (0, 3, 6))
    with pyoidn.Device() as device:
        device.commit()
        features = {"albedo": filtered(device, {"albedo": np.clip(albedo, 0, 1)}),
                    "normal": filtered(device, {"normal": normal})}
        return filtered(device, {"color": colour, **features}, hdr=True, cleanAux=True)
