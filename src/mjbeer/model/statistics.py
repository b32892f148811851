"""The statistics of a model, which MuJoCo's compiler derives from masses and sizes, and `mj_setConst` does not."""

import math

import mujoco

_LEAST = 1e-5
"""Smallest size of a body [m]."""


def derive(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Write the mean inertia, mass and size of a model, after `mj_setConst` has been called with the same `data`.

    A body's size is the largest distance of its centre of mass from the joints of the body and of its children, or
    from the farthest points of its geoms. To the bit these are the compiler's numbers: the same sums in the same order.
    """
    inertia = 0.0
    for diagonal in model.dof_M0.tolist():
        inertia += diagonal
    model.stat.meaninertia = inertia / max(1, model.nv)
    masses, sizes = model.body_mass.tolist(), _sizes(model, data)
    mass = size = 0.0
    for body in range(1, model.nbody):
        mass += masses[body]
        size += max(sizes[body], _LEAST) / max(1, model.nbody - 1)
    model.stat.meanmass, model.stat.meansize = mass / max(1, model.nbody - 1), size


def _sizes(model: mujoco.MjModel, data: mujoco.MjData) -> list[float]:
    """Return the size of each body [m], 0 where it has none."""
    sizes, centres, parents = [0.0] * model.nbody, data.xipos.tolist(), model.body_parentid.tolist()
    for body, anchor in zip(model.jnt_bodyid.tolist(), data.xanchor.tolist(), strict=True):
        for near in (body, parents[body]):
            sizes[near] = max(sizes[near], _distance(centres[near], anchor))
    if model.ngeom:
        places, bounds = data.geom_xpos.tolist(), model.geom_rbound.tolist()
        for geom, body in enumerate(model.geom_bodyid.tolist()):
            if bounds[geom] > 0:
                sizes[body] = max(sizes[body], bounds[geom] + _distance(centres[body], places[geom]))
    return sizes


def _distance(one: list[float], other: list[float]) -> float:
    x, y, z = (a - b for a, b in zip(one, other, strict=True))
    return math.sqrt(x * x + y * y + z * z)
