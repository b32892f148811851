"""Meshes for drawing: the beer as a circular segment, the can as an open tube.

A mesh is a pair (vertices, faces) of shapes (n, 3) [m] and (k, 3); it is closed, and its faces are oriented
outwards. The can's axis is the y axis, and the beer's flat surface is horizontal, with the beer below it.
"""

import numpy as np

from mjbeer.theory.segment import segment

Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices and faces."""
RESOLUTION = 256
"""Number of edges around the arc of a mesh. The error of the polygon falls as 1/RESOLUTION^2; with 256 edges mass,
centroid and inertia are within 6e-4 for every fill up to 0.95."""


def beer(fill: float, radius: float, length: float, resolution: int = RESOLUTION) -> Mesh:
    """Return the beer of a given `fill`, eq. (32), in a can of `radius` and `length` [m]."""
    beta = segment(fill).half_angle
    # The arc of a full can closes on itself, so that its last vertex would repeat the first.
    angles = np.linspace(-beta, beta, resolution + 1)[: None if fill < 1 else -1]
    arc = radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    return _extrude(arc, length)


def tube(inner: float, outer: float, length: float, resolution: int = RESOLUTION) -> Mesh:
    """Return a tube of an `inner` and an `outer` radius and a `length` [m], open at both ends."""
    angles = 2 * np.pi * np.arange(resolution) / resolution
    circle = np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    corners = [(outer, -1), (outer, 1), (inner, 1), (inner, -1)]
    rings = [_place(radius * circle, side * length / 2) for radius, side in corners]
    vertices = np.concatenate(rings)
    here, there = np.arange(resolution), np.roll(np.arange(resolution), -1)
    faces = []
    for ring in range(4):
        a, b = ring * resolution, (ring + 1) % 4 * resolution
        faces += [np.stack([a + here, b + there, a + there], 1), np.stack([a + here, b + here, b + there], 1)]
    return vertices, np.concatenate(faces)


def _extrude(outline: np.ndarray, length: float) -> Mesh:
    """Return the prism of a `length` [m] along y on a convex outline in (x, z), counter-clockwise seen from -y."""
    n = len(outline)
    vertices = np.concatenate([_place(outline, -length / 2), _place(outline, length / 2)])
    here, there = np.arange(n), np.roll(np.arange(n), -1)
    fan = np.stack([np.zeros(n - 2, int), np.arange(1, n - 1), np.arange(2, n)], 1)
    sides = [np.stack([here, n + there, there], 1), np.stack([here, n + here, n + there], 1)]
    return vertices, np.concatenate([fan, n + fan[:, ::-1], *sides])


def _place(outline: np.ndarray, y: float) -> np.ndarray:
    """Return the points (x, z) of an outline as points (x, y, z)."""
    return np.stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]], axis=1)
