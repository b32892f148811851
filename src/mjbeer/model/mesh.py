"""Meshes for drawing: the beer and its foam as prisms, and what a lathe and a saw can make.

A mesh is a pair (vertices, faces) of shapes (n, 3) [m] and (k, 3); it is closed, and its faces are oriented
outwards. The can's axis is the y axis, and the beer's flat surface is horizontal, with the beer below it. Where two
surfaces meet at an edge that is to look sharp, each has vertices of its own.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from mjbeer.theory.load import segment

Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices and faces."""
RESOLUTION = 256
"""Number of edges around the arc of the beer. The error of the polygon falls as 1/RESOLUTION^2; with 256 edges mass,
centroid and inertia are within 6e-4 for every fill up to 0.95."""
TURNED = 64
"""Number of edges around what is turned on a lathe. It is only looked at: the polygon is within 0.0012 of its radius,
0.2 pixels where the radius is 160 pixels."""


def beer(fill: float, radius: float, length: float, resolution: int = RESOLUTION) -> Mesh:
    """Return the beer of a given `fill`, eq. (32), in a can of `radius` and `length` [m]."""
    beta = segment(fill).half_angle
    # The arc of a full can closes on itself, so that its last vertex would repeat the first.
    angles = np.linspace(-beta, beta, resolution + 1)[: None if fill < 1 else -1]
    arc = radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    return prism(arc, -length / 2, length / 2)


def layer(fill: float, thickness: float, radius: float, length: float) -> Mesh:
    """Return a layer of a `thickness` [radii] on the beer's flat surface, as wide as the can at its two heights."""
    heights = 2 * fill - 1 + thickness * np.array([0, 0, 1, 1])
    across = np.sqrt((1 - heights) * (1 + heights)) * [-1, 1, 1, -1]
    return prism(radius * np.stack([across, heights], axis=1), -length / 2, length / 2)


def prism(outline: np.ndarray, near: float, far: float) -> Mesh:
    """Return the prism from y = `near` to y = `far` [m] on a convex outline in (x, z), counter-clockwise seen from -y.

    The near face and the side from the last point to the first, which is the beer's surface, look flat.
    """
    n = len(outline)
    front, back, last = _place(outline, near), _place(outline, far), [n - 1, 0]
    vertices = np.concatenate([front, front, back, front[last], back[last]])
    round_front, round_back = n + np.arange(n), 2 * n + np.arange(n)
    top = _strip(3 * n + 2 + np.arange(2), 3 * n + np.arange(2))
    return vertices, np.concatenate([_fan(n), 2 * n + _fan(n)[:, ::-1], _strip(round_back, round_front), top])


def hollow(outer: np.ndarray, inner: np.ndarray, near: float, far: float) -> Mesh:
    """Return the prism on the area between two outlines as in `prism`, which have the same number of points."""
    n = len(outer)
    rings = [_place(outline, y) for outline, y in ((outer, near), (outer, far), (inner, far), (inner, near))]
    around = np.arange(n + 1) % n
    vertices, faces = [], []
    for first, ring in enumerate(rings):  # each surface has vertices of its own, so that its edges look sharp
        vertices += [ring, rings[(first + 1) % 4]]
        faces.append(_strip((2 * first + 1) * n + around, 2 * first * n + around))
    return np.concatenate(vertices), np.concatenate(faces)


def turned(pieces: Sequence[Sequence[tuple[float, float]]], span: float = 2 * np.pi, edges: int = TURNED) -> Mesh:
    """Return what a closed outline of distances from the axis and places along it, (r, y) [m], sweeps about the axis.

    The outline is given in pieces, each of which begins where the one before ends; between them is a sharp edge. With r
    to the right and y upwards it runs counter-clockwise. It is swept through a `span` [rad] around the top; in less
    than a whole turn the outline must be convex.
    """
    whole = span >= 2 * np.pi
    count = edges if whole else edges + 1
    angles = span * (np.arange(count) / edges - 0.5)
    around = np.arange(edges + 1) % count
    vertices, faces = [_sweep(point, angles) for piece in pieces for point in piece], []
    first = 0
    for piece in pieces:
        for (r, _), (next_r, _) in pairwise(piece):
            strip = _strip(first + around, first + count + around)
            # A triangle with two corners on the axis has no area.
            faces += [strip[:edges]] * (r > 0) + [strip[edges:]] * (next_r > 0)
            first += count
        first += count
    if not whole:
        outline = [point for piece in pieces for point in piece[:-1]]
        for angle, order in ((angles[0], 1), (angles[-1], -1)):
            vertices.append(np.concatenate([_sweep(point, np.array([angle])) for point in outline]))
            faces.append(first + _fan(len(outline))[:, ::order])
            first += len(outline)
    return np.concatenate(vertices), np.concatenate(faces)


def joined(*meshes: Mesh) -> Mesh:
    """Return several meshes as one."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts[:-1], strict=True)]),
    )


def texture(vertices: np.ndarray, radius: float) -> np.ndarray:
    """Return where the vertices are in a texture that covers the can's cross-section once, shape (n, 2).

    They are multiples of 1/512, which are written with few digits.
    """
    return np.round(512 * (vertices[:, [0, 2]] / (2 * radius) + 0.5)) / 512


def volume(shape: Mesh) -> float:
    """Return the volume of a mesh [m^3]."""
    vertices, faces = shape
    corners = vertices[faces]
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)


def _place(outline: np.ndarray, y: float) -> np.ndarray:
    """Return the points (x, z) of an outline as points (x, y, z)."""
    return np.stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]], axis=1)


def _sweep(point: tuple[float, float], angles: np.ndarray) -> np.ndarray:
    """Return where a point (r, y) of an outline is at some angles [rad] from the top."""
    r, y = point
    return np.stack([r * np.sin(angles), np.full(len(angles), y), r * np.cos(angles)], axis=1)


def _fan(corners: int) -> np.ndarray:
    """Return the faces of a convex polygon."""
    return np.stack([np.zeros(corners - 2, int), np.arange(1, corners - 1), np.arange(2, corners)], 1)


def _strip(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the faces between two lines of as many vertices: first those with two corners on `one`, then the rest."""
    return np.concatenate([
        np.stack([one[:-1], one[1:], other[1:]], 1),
        np.stack([one[:-1], other[1:], other[:-1]], 1),
    ])  # fmt: skip
