"""Pictures side by side in the pages that the site runs: linear radiance by one exposure, and signed differences in blue and red."""
import matplotlib.pyplot as plt
import numpy as np

LUMINANCE = (0.2126, 0.7152, 0.0722)
WIDTH, DPI = 960, 110  # of a figure [pixels]; letters of 10 points keep more than 9 where it is shown so wide


def filmic(radiance):
    """Radiance relative to white, for the screen: linear in the dark, highlights compressed so that they keep their shape (the curve
    of Hable 2010), and the transfer curve of sRGB."""
    curve = lambda x: (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3
    mapped = np.clip(curve(2.0 * np.maximum(radiance, 0.0)) / curve(11.2), 0.0, 1.0)
    return np.where(mapped <= 0.0031308, 12.92 * mapped, 1.055 * mapped ** (1 / 2.4) - 0.055)


def panels(*pictures, layer="beauty", difference=None, scale=None):
    """Pictures, each (title, picture), and behind them the difference of two of them, given by their indices: the first minus the
    second, of luminance, relative to the mean of the second. Blue is too dark, red too bright; scale: full colour."""
    arrays = [(title, np.asarray(p if isinstance(p, np.ndarray) else p[layer], float)) for title, p in pictures]
    count = len(arrays) + (difference is not None)
    columns = count if count <= 3 else (count + 1) // 2
    rows = -(-count // columns)
    height, width = arrays[0][1].shape[:2]
    panel = WIDTH / DPI / max(columns, 2)
    figure, grid = plt.subplots(rows, columns, figsize=(panel * columns, rows * (panel * height / width + 0.35) + 0.55 * (difference is not None)), dpi=DPI, layout="constrained",
                                squeeze=False)
    axes = grid.flat
    luminance = arrays[difference[1] if difference else -1][1] @ LUMINANCE
    key = np.minimum(luminance, np.percentile(luminance, 98)).mean()  # lamps do not darken the rest
    for ax, (title, array) in zip(axes, arrays):
        ax.imshow(filmic(0.18 * array / key), interpolation="nearest")
        ax.set_title(title, fontsize=10)
    if difference is not None:
        first, second = (arrays[i][1] @ LUMINANCE for i in difference)
        relative = 100 * (first - second) / second.mean()
        full = scale or np.percentile(np.abs(relative), 98)
        last = axes[count - 1]
        shown = last.imshow(relative, cmap="RdBu_r", vmin=-full, vmax=full, interpolation="nearest")
        last.set_title(f"{arrays[difference[0]][0]} - {arrays[difference[1]][0]}", fontsize=10)
        figure.colorbar(shown, ax=last, location="bottom", aspect=30, pad=0.03).set_label("difference [% of the mean]")
    for ax in axes:
        ax.set_axis_off()
    plt.show()
