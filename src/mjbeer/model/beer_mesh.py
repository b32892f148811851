"""The meshes of beer and foam in a can that lies: prisms along its axis.

Places are in the frame of the load: y is the axis of the can, and the beer lies towards -z.
"""

from typing import NamedTuple

import numpy as np

from mjbeer.theory.segment import segment

EDGES = 256
"""Number of edges around the arc of the beer. The error of the polygon falls as its square; with
256 edges mass, centroid and inertia are within 6e-4 for every fill up to 0.95."""


class Mesh(NamedTuple):
    """A closed surface whose faces are oriented outwards.

    Where two faces meet at an edge that is to look sharp, each has vertices of its own.
    """

    vertices: np.ndarray
    """Places [m], shape (vertices, 3)."""
    faces: np.ndarray
    """Indices of vertices, shape (faces, 3)."""


def beer(fill: float, radius: float, length: float, edges: int = EDGES) -> Mesh:
    """Return the beer of a `fill`, eq. (32), in a can of `radius` and `length` [m]: a prism."""
    beta = segment(fill).half_angle
    angles = np.linspace(-beta, beta, edges + 1)
    if fill == 1:
        # The arc of a full can closes on itself, and its last vertex would repeat the first.
        angles = angles[:-1]
    return _prism(radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1), length)


def foam(fill: float, thickness: float, radius: float, length: float) -> Mesh:
    """Return the foam on beer of a given `fill`; its `thickness` is in radii."""
    bottom = 2 * fill - 1
    heights = bottom + thickness * np.array([0, 0, 1, 1])
    across = np.sqrt((1 - heights) * (1 + heights)) * [-1, 1, 1, -1]
    return _prism(radius * np.stack([across, heights], axis=1), length)


def _prism(outline: np.ndarray, length: float) -> Mesh:
    """Return the prism of a `length` [m] on a convex outline in (x, z).

    The outline is counter-clockwise seen from -y. The near face and the side from the last point to
    the first, which is the beer's surface, look flat.
    """
    front = np.insert(outline, 1, -length / 2, axis=1)
    back = np.insert(outline, 1, length / 2, axis=1)
    ends = [len(outline) - 1, 0]
    vertices = np.concatenate([front, front, back, front[ends], back[ends]])
    # The indices of these five groups of vertices. The far face has no vertices of its own.
    count = len(outline)
    near_face = np.arange(count)
    near_edge = count + near_face
    far_edge = 2 * count + near_face
    near_end_of_surface = 3 * count + np.arange(2)
    far_end_of_surface = 3 * count + 2 + np.arange(2)
    faces = np.concatenate(
        [
            _fan(near_face),
            _fan(far_edge)[:, ::-1],
            _strip(far_edge, near_edge),
            _strip(far_end_of_surface, near_end_of_surface),
        ]
    )
    return Mesh(vertices, faces)


def _fan(polygon: np.ndarray) -> np.ndarray:
    """Return the faces of a convex polygon, all of which have its first vertex."""
    first = np.full(len(polygon) - 2, polygon[0])
    return np.stack([first, polygon[1:-1], polygon[2:]], 1)


def _strip(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the faces between two lines with equal numbers of vertices."""
    first = np.stack([one[:-1], one[1:], other[1:]], 1)
    rest = np.stack([one[:-1], other[1:], other[:-1]], 1)
    return np.concatenate([first, rest])
