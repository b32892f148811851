"""Checks of models: orders of integrators, hopping hoops, repeatability of runs, and the mesh of the beer."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import mujoco
import numpy as np

from mjbeer.model import looks
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, INTEGRATORS, Integrator
from mjbeer.model.state import start
from mjbeer.paper.witness import TOP, fall_from_top
from mjbeer.simulation.simulate import simulate
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.check import Check
from mjbeer.studies.convergence import order
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.exact import exact
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.scene import Scene, frozen, hoop, pendulum, sliding

ORDERS: dict[Integrator, tuple[int, float]] = {
    "RK4": (4, 0.2),
    DOP853: (8, 0.5),
    **{name: (1, 0.1) for name in INTEGRATORS if name != "RK4"},
}
"""Order of each integrator, and the largest difference of the observed order from it."""
FILLS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
"""Fills at which the mesh of the beer is checked."""
_GRIP = 1e6
"""Friction coefficient so large that the hoop never slips."""


def checks() -> Iterator[Check]:
    """Yield the checks of models."""
    yield from _orders()
    yield from _hops()
    yield from _others()


def _orders() -> Iterator[Check]:
    for integrator, (expected, margin) in ORDERS.items():
        yield Check(
            quantity=f"observed order less {expected}",
            by=f"frozen, reduced, {integrator}",
            bound=margin,
            unit="",
            reason="higher orders' terms",
            deviation=lambda integrator=integrator, expected=expected: order(frozen(), integrator) - expected,
        )


def _hops() -> Iterator[Check]:
    light, hops, rolls = hoop(hoop_mass=2e-4), hoop(hoop_mass=0.2 / 20), hoop(hoop_mass=0.2 / 10)
    yield Check(
        quantity="lift-off angle at M/m = 1e-3 (Littlewood: 90 degrees)",
        by="hoop, contact, RK4, 20 us",
        bound=0.5,
        unit="degrees",
        reason="penetration of the contact, which unloads late",
        deviation=lambda: _lift_off_error(light),
    )
    yield Check(
        quantity="hops missing at M/m = 1/20",
        by="hoop, contact, RK4, 0.1 ms",
        bound=0,
        unit="",
        reason="it hops or not",
        deviation=lambda: float(fall_from_top(hops, 1e-4, _GRIP).takeoff() is None),
    )
    yield Check(
        quantity="hops too many at M/m = 1/10 (above 1/13)",
        by="hoop, contact, RK4, 0.1 ms",
        bound=0,
        unit="",
        reason="it hops or not",
        deviation=lambda: float(fall_from_top(rolls, 1e-4, _GRIP).takeoff() is not None),
    )


def _others() -> Iterator[Check]:
    yield Check(
        quantity="values that differ between two runs",
        by="every scene, rolling and integrator",
        bound=0,
        unit="",
        reason="bit for bit",
        deviation=_count_differences,
    )
    for name, index in (("mass", 0), ("centre of mass", 1), ("inertia", 2)):
        yield Check(
            quantity=f"{name} of the beer's mesh, eqs. (33)-(37)",
            by="fills 0.05 to 0.95",
            bound=1e-3,
            unit="relative",
            reason="the polygon: falls as 1/resolution^2",
            deviation=lambda index=index: max(mesh_errors(fill)[index] for fill in FILLS),
        )


def _lift_off_error(scene: Scene) -> float:
    """Return the simulated less the exact angle of lift-off [degrees], or NaN if the hoop stays on the ground."""
    simulated = fall_from_top(scene, 2e-5, _GRIP).takeoff()
    return math.degrees(simulated) - math.degrees(_exact_lift_off(scene)) if simulated is not None else math.nan


def _exact_lift_off(scene: Scene) -> float:
    """Return the angle from the top [rad] at which N = 0 in a fall from the top: 90 degrees as M/m -> 0."""
    fall = exact(scene, np.linspace(0, 1, 100_001), TOP)
    return math.pi - float(np.interp(fall.rolls_until(), fall.time, fall.phi))


def _count_differences() -> int:
    """Return how many numbers differ when a run is repeated, in one thread and in two."""
    count = 0
    for scene in (sliding(), sliding(can=Can.sheet_metal()), frozen(), pendulum(), hoop()):
        for rolling in ("reduced", "equality", "contact"):
            if rolling != "reduced" and scene.attachment == "sliding" and scene.can.mass == 0:
                continue
            for integrator in INTEGRATORS:
                model = build(scene, rolling, integrator=integrator)
                state, steps = start(model, scene, 0.5, 0.0), np.arange(201)
                alone = Stepper(model).run(state, steps)
                with ThreadPoolExecutor(2) as pool:
                    together = [pool.submit(Stepper(model).run, state, steps) for _ in range(2)]
                count += sum(int(np.count_nonzero(run.result() != alone)) for run in together)
            once, again = (simulate(scene, 0.2, 1.0, rolling=rolling, integrator=DOP853).phi for _ in range(2))
            count += int(np.count_nonzero(once != again))
    once, again = (simulate(frozen(), 2, math.pi, tolerance=1e-9).phi for _ in range(2))
    return count + int(np.count_nonzero(once != again))


def mesh_errors(fill: float, resolution: int = looks.EDGES) -> tuple[float, float, float]:
    """Return the relative errors of mass, centre of mass and axial inertia of the beer's mesh as MuJoCo compiles it."""
    vertices, faces = looks.beer(fill, RADIUS, LENGTH, resolution)
    spec = mujoco.MjSpec()
    method = mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT
    spec.add_mesh(name="beer", uservert=vertices.ravel(), userface=faces.ravel(), inertia=method)
    spec.worldbody.add_body(name="beer").add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="beer", density=BEER)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    load, body = Load.segment(fill=fill), model.body("beer")
    axes = data.body("beer").ximat.reshape(3, 3)
    inertia = (axes @ np.diag(body.inertia) @ axes.T)[1, 1]
    depth = -data.body("beer").xipos[2]
    pairs = (body.mass[0], load.mass), (depth, load.offset), (inertia, load.inertia)
    return tuple(abs(compiled / exact_value - 1) for compiled, exact_value in pairs)
