"""Meshes that are drawn: the beer as a circular segment, the can as a tube that one can look into.

A mesh is (vertices, faces), shapes (n, 3) [m] and (k, 3), closed and oriented outwards. The
axis is y through the origin; the beer's flat surface is up (+z) and level.
"""

import numpy as np

from mjbeer.theory.segment import segment

Mesh = tuple[np.ndarray, np.ndarray]
RESOLUTION = 256
"""Edges of a mesh around its arc. What the polygon misses falls as 1/RESOLUTION^2; at 256 mass, centroid
and inertia are within 6e-4 for every fill up to 0.95."""


def beer(fill: float, radius: float, length: float, resolution: int = RESOLUTION) -> Mesh:
    """The circular segment of a given `fill`, eq. (32), in a can of `radius` and `length` [m]."""
    beta = segment(fill).half_angle
    # A full can's arc closes on itself: leave the last vertex out.
    angles = np.linspace(-beta, beta, resolution + 1)[: None if fill < 1 else -1]
    arc = radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    return _extrude(arc, length)


def tube(inner: float, outer: float, length: float, resolution: int = RESOLUTION) -> Mesh:
    """A tube of two radii and a `length` [m], open at both ends."""
    angles = 2 * np.pi * np.arange(resolution) / resolution
    circle = np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    corners = [(outer, -1), (outer, 1), (inner, 1), (inner, -1)]
    rings = [_at(radius * circle, side * length / 2) for radius, side in corners]
    vertices = np.concatenate(rings)
    here, there = np.arange(resolution), np.roll(np.arange(resolution), -1)
    faces = []
    for ring in range(4):
        a, b = ring * resolution, (ring + 1) % 4 * resolution
        faces += [np.stack([a + here, b + there, a + there], 1), np.stack([a + here, b + here, b + there], 1)]
    return vertices, np.concatenate(faces)


def _extrude(outline: np.ndarray, length: float) -> Mesh:
    """A convex outline in (x, z), counter-clockwise seen from -y, drawn out along y."""
    n = len(outline)
    vertices = np.concatenate([_at(outline, -length / 2), _at(outline, length / 2)])
    here, there = np.arange(n), np.roll(np.arange(n), -1)
    fan = np.stack([np.zeros(n - 2, int), np.arange(1, n - 1), np.arange(2, n)], 1)
    sides = [np.stack([here, n + there, there], 1), np.stack([here, n + here, n + there], 1)]
    return vertices, np.concatenate([fan, n + fan[:, ::-1], *sides])


def _at(outline: np.ndarray, y: float) -> np.ndarray:
    return np.stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]], axis=1)
