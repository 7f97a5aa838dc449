"""Transmittance T and reflectance R of a rough dielectric boundary, as in Mitsuba's roughplastic.

Facets are weighted by their visible area, and light that meets another facet afterwards is lost, as there.
"""
import numpy as np

COSINES = 1 - np.linspace(0, 1, 24)**1.5   # denser towards the grazing end
GRID = (256, 32)                           # facets: slopes and azimuths


class RoughInterface:
    """By cosine: `transmittance`, and `coat_share`, R over the albedo of the same lobe without Fresnel; `inside` is the
    mean internal reflectance, from Mitsuba's 64 points with both ends; `mean_transmittance` is 2 int T(mu) mu dmu."""

    def __init__(self, eta, alpha, distribution):
        self.cosines = np.maximum(COSINES[::-1], 1e-3)
        values = [boundary(c, eta, alpha, distribution) for c in self.cosines]
        self.transmittance = np.array([t for _, _, t in values])
        self.coat_share = np.array([r / max(a, 1e-9) for r, a, _ in values])
        mu = np.maximum(np.linspace(0, 1, 64), 1e-3)
        self.inside = 2 * np.mean([boundary(c, 1 / eta, alpha, distribution)[0] * c for c in mu])
        middle = (np.arange(64) + 0.5) / 64
        self.mean_transmittance = 2 * np.mean([boundary(c, eta, alpha, distribution)[2] * c for c in middle])


def fresnel(cosine, eta):
    """Unpolarized, for the cosine on the near side; eta: index beyond over index here."""
    sine = 1 - (1 - cosine**2) / eta**2
    inner = np.sqrt(np.maximum(sine, 0.0))
    with np.errstate(invalid="ignore"):  # 0 / 0 for facets that are seen from their side
        s, p = (cosine - eta * inner) / (cosine + eta * inner), (eta * cosine - inner) / (eta * cosine + inner)
    return np.where(sine > 0, 0.5 * (s**2 + p**2), 1.0), inner


def boundary(cosine, eta, alpha, distribution):
    """(R, R without Fresnel, T) for light that comes in with this cosine."""
    if alpha <= 0:
        f = float(fresnel(np.array(cosine), eta)[0])
        return f, 1.0, 1.0 - f
    m, weight, view = visible_facets(cosine, alpha, distribution)
    along = m @ view
    f, inner = fresnel(np.clip(along, 1e-6, 1), eta)
    reflected = 2 * along[:, None] * m - view
    through = ((along / eta - inner)[:, None] * m) - view / eta
    up = np.where(reflected[:, 2] > 0, shadowing(reflected, m, alpha, distribution), 0.0)
    down = np.where(through[:, 2] < 0, shadowing(through, m, alpha, distribution), 0.0)
    total = weight.sum()
    return (weight * f * up).sum() / total, (weight * up).sum() / total, (weight * (1 - f) * down).sum() / total


def visible_facets(cosine, alpha, distribution):
    """Normals of facets sampled by D(m) cos(m), with the weights <view, m>+ / cos(m) of those that are seen."""
    u, v = np.meshgrid(*[(np.arange(n) + 0.5) / n for n in GRID])
    u, v = u.ravel(), v.ravel()
    tangent2 = alpha**2 * (u / (1 - u) if distribution == "ggx" else -np.log1p(-u))
    z = 1 / np.sqrt(1 + tangent2)
    side = np.sqrt(np.maximum(1 - z**2, 0.0))
    m = np.stack([side * np.cos(2 * np.pi * v), side * np.sin(2 * np.pi * v), z], axis=1)
    view = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])
    return m, np.maximum(m @ view, 0.0) / z, view


def shadowing(w, m, alpha, distribution):
    """Smith's G1; Beckmann's by the rational fit of Walter et al. 2007, Sec. 5.2."""
    tangent = np.sqrt(np.maximum(1 - w[:, 2]**2, 0.0)) / np.maximum(np.abs(w[:, 2]), 1e-9)
    if distribution == "ggx":
        g = 2 / (1 + np.sqrt(1 + (alpha * tangent)**2))
    else:
        a = 1 / np.maximum(alpha * tangent, 1e-9)
        g = np.where(a < 1.6, (3.535 * a + 2.181 * a**2) / (1 + 2.276 * a + 2.577 * a**2), 1.0)
    return np.where(np.einsum("ij,ij->i", w, m) * w[:, 2] > 0, g, 0.0)
