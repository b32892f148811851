"""The liquid of a standing can as films draw it: the cut of the can by the surface, in every attitude."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import standing
from mjbeer.drawing.carried import CarriedCans, cut

RADIUS, LENGTH = 0.033, 0.12
# The level is found to 1e-9 of the length; across the can, the surface is at most 4 radii long.
LEVEL = 1e-8
# Qhull merges facets that lie within some 1e-15 of the largest coordinate.
ROUNDING = 1e-12
PRISM = 32 * RADIUS**2 * np.sin(2 * np.pi / 64) * LENGTH


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.floats(0.02, 0.98), st.floats(0, np.pi), st.floats(-np.pi, np.pi))
def test_the_liquid_is_the_cut_of_the_can_by_its_surface(fill: float, tilt: float, turn: float) -> None:
    """All of it is in the can and below one plane, on which it ends; its volume is of the fill, upside down too."""
    up = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    triangles, normals = cut(RADIUS, LENGTH, fill, up)
    points = triangles.reshape(-1, 3)
    assert np.hypot(points[:, 0], points[:, 1]).max() <= RADIUS * (1 + ROUNDING)
    assert points[:, 2].min() >= -ROUNDING
    assert points[:, 2].max() <= LENGTH + ROUNDING
    # By Gauss: a third of the sum of the places times the areas, which point outwards.
    areas = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2
    volume = np.einsum("ij,ij->", triangles.mean(axis=1), areas) / 3
    assert volume == pytest.approx(fill * PRISM, rel=LEVEL / min(fill, 1 - fill))
    level = (points @ up).max()
    surface = (triangles @ up).min(axis=1) > level - ROUNDING
    assert surface.any()
    assert areas[surface].sum(axis=0) @ up > 0
    # Nothing else is missing: what is not the surface is wall, bottom or top.
    middle = triangles[~surface].mean(axis=1)
    on_wall = np.hypot(middle[:, 0], middle[:, 1]) > 0.99 * RADIUS
    assert (on_wall | (np.abs(middle[:, 2] * (LENGTH - middle[:, 2])) < ROUNDING)).all()
    assert (np.einsum("ijk,ik->ij", normals, areas) > 0).all()


def test_a_tilted_surface_is_drawn_where_it_is() -> None:
    """What MuJoCo's model of the picture has: each can in its lane, and the highest point of its liquid at the wall."""
    can = standing()
    cans = CarriedCans.held(can, [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)], 0.3)
    cans.pose(np.array([[0.1, 0.2], [0.3, -0.1]]))
    for number, (prefix, x, rise) in enumerate((("", 0.1, 0.2), ("1-", 0.3, -0.1))):
        geom = next(each for each in range(cans.model.ngeom) if cans.model.geom_dataid[each] == cans.changing[number])
        mesh = cans.model.mesh(f"{prefix}liquid")
        local = cans.model.mesh_vert[mesh.vertadr[0] :][: mesh.vertnum[0]]
        points = local @ cans.data.geom_xmat[geom].reshape(3, 3).T + cans.data.geom_xpos[geom]
        top, bottom = points[points[:, 2].argmax()], points[:, 2].min()
        assert bottom == pytest.approx(cans.wall(number, x, 0.0)[0, 2] - can.height, abs=1e-6)  # single precision
        assert top[2] - bottom == pytest.approx(can.height + abs(rise) * can.can.radius, abs=1e-6)
        assert top[0] == pytest.approx(x + np.sign(rise) * can.can.radius, abs=1e-6)
        assert np.abs(points[:, 1] - cans.lanes[number]).max() == pytest.approx(can.can.radius, abs=1e-6)
