"""The parts that a can and a wheel are drawn with, as meshes: for any radius and length.

Across the axis all measures are in radii. Along the axis they are in `_depth`, a radius or, in a can shorter than
that, its length, so that the parts of one end stay at that end.
"""

from collections.abc import Callable

import numpy as np

from mjbeer.model import mesh

WALL = 0.06
"""Thickness of the drawn wall of the can, in radii. It lies outside the radius, so that the beer fills the inside."""
_BODY, _LABEL, _STRIPE, _BEAD, _SPOT = 1.042, 1.048, 1.055, 1 + WALL, 1.066
"""Outer radii of the wall between its ends, of the label on it, of the stripe over both, of the beads at the ends, on
which the can lies, and of the mark on the near bead [radii]."""
SECTOR = np.radians(26)
"""Width of the mark on the near end's bead [rad]."""
_LEAN = np.radians(35)
"""Angle from the mark to the middle of the mouth [rad]."""


def wall(radius: float, length: float, edges: int = mesh.TURNED) -> mesh.Mesh:
    """Return the wall, open at its near end, with a bead at either end."""
    a, h, d = radius, length / 2, _depth(radius, length)
    near = [(1.0, 0.013), (1.014, 0.0), (1.043, 0.0), (_BEAD, 0.016), (_BEAD, 0.050), (_BODY, 0.085)]
    far = [(_BODY, 0.07), (_BEAD, 0.04), (1.04, 0.0)]
    bead, foot = [(a * r, -h + d * y) for r, y in near], [(a * r, h - d * y) for r, y in far]
    return mesh.turned([bead, [bead[-1], foot[0]], foot, [foot[-1], (a, h)], [(a, h), bead[0]]], edges=edges)


def label(radius: float, length: float, edges: int = mesh.TURNED) -> mesh.Mesh:
    """Return the printed band around the wall."""
    end, outer = length / 2 - 0.3 * _depth(radius, length), _LABEL * radius
    near, far, inside = (outer, -end), (outer, end), ((_BODY - 0.02) * radius, 0.0)
    return mesh.turned([[near, far], [far, inside, near]], edges=edges)


def lid(radius: float, length: float, edges: int = mesh.TURNED) -> mesh.Mesh:
    """Return the far end, whose panel lies deeper than the wall's edge, and has a raised ring."""
    h, d = length / 2, _depth(radius, length)
    profile = [
        [(0.0, 0.148), (0.30, 0.145), (0.56, 0.125)],
        [(0.56, 0.125), (0.59, 0.112), (0.75, 0.112)],
        [(0.75, 0.112), (0.78, 0.160), (0.82, 0.172), (0.86, 0.160), (0.89, 0.095)],
        [(0.89, 0.095), (1.0, 0.07)],
        [(1.0, 0.07), (0.0, 0.01)],
    ]  # fmt: skip
    return mesh.turned([[(radius * r, h - d * y) for r, y in piece] for piece in profile], edges=edges)


def tab(radius: float, length: float) -> mesh.Mesh:
    """Return the pull tab on the far end, with its rivet."""
    h, d = length / 2, _depth(radius, length)
    outside, finger = _stadium(radius, 0.17, -0.54, 0.10), _stadium(radius, 0.095, -0.50, -0.22)
    plate = mesh.hollow(outside, finger, h - 0.19 * d, h - 0.155 * d)
    rivet = mesh.prism(_stadium(radius, 0.07, -0.03, 0.03), h - 0.215 * d, h - 0.155 * d)
    return mesh.joined(plate, rivet)


def mouth(radius: float, length: float) -> mesh.Mesh:
    """Return the opening in the far end, as a dark plate on it."""
    h, d = length / 2, _depth(radius, length)
    return mesh.prism(_stadium(radius, 0.21, 0.30, 0.36), h - 0.165 * d, h - 0.1 * d)


def stripe(radius: float, length: float) -> mesh.Mesh:
    """Return the mark along the outside."""
    h, d = length / 2, _depth(radius, length)
    return _band((_BODY - 0.02) * radius, _STRIPE * radius, -h + 0.02 * d, h - 0.01 * d, np.radians(9), edges=4)


def spot(radius: float, length: float) -> mesh.Mesh:
    """Return the mark on the bead of the near end."""
    h, d = length / 2, _depth(radius, length)
    return _band(0.99 * radius, _SPOT * radius, -h - 0.012 * d, -h + 0.09 * d, SECTOR, edges=8)


def spokes(radius: float, length: float) -> mesh.Mesh:
    """Return the hub of a wheel, and six spokes from it to the wall."""
    h, d = length / 2, _depth(radius, length)
    near, far = h - 0.16 * d, h - 0.02 * d
    hub = _band(0.03 * radius, 0.16 * radius, near - 0.04 * d, far, edges=24)
    bar = radius * np.array([[-0.045, 0.1], [0.045, 0.1], [0.03, 1.02], [-0.03, 1.02]])
    return mesh.joined(hub, *(mesh.prism(_turn(bar, angle), near, far) for angle in np.pi / 3 * np.arange(6)))


PARTS: dict[str, Callable[[float, float], mesh.Mesh]] = {
    "can.obj": wall,
    "label.obj": label,
    "lid.obj": lid,
    "tab.obj": tab,
    "mouth.obj": mouth,
    "stripe.obj": stripe,
    "spot.obj": spot,
    "spokes.obj": spokes,
}
"""The parts by the files that the templates have of them, each a function of radius and length [m]."""


def _depth(radius: float, length: float) -> float:
    return min(radius, length)


def _band(
    inner: float, outer: float, near: float, far: float, span: float = 2 * np.pi, edges: int = mesh.TURNED
) -> mesh.Mesh:
    """Return a tube with sharp edges, or a `span` [rad] of it around the top."""
    corners = [(inner, near), (outer, near), (outer, far), (inner, far)]
    return mesh.turned([corners[i : i + 2] if i < 3 else [corners[3], corners[0]] for i in range(4)], span, edges)


def _stadium(radius: float, half: float, low: float, high: float, edges: int = 8) -> np.ndarray:
    """Return the points [m] around two half circles, of which `half`, `low` and `high` are radius and heights [radii].

    The figure leans to the side, so that half a can of beer leaves some of the tab and of the mouth to be seen.
    """
    angles = np.pi * np.arange(edges + 1) / edges
    upper = np.stack([half * np.cos(angles), high + half * np.sin(angles)], 1)
    return _turn(radius * np.concatenate([upper, [0, low + high] - upper]), _LEAN)


def _turn(outline: np.ndarray, angle: float) -> np.ndarray:
    """Return points (x, z) turned by an `angle` [rad] about the axis, from the top downhill."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return outline @ np.array([[cosine, -sine], [sine, cosine]])
