"""Rows of models: orders of integrators, hopping hoops, repeatability of runs, and the mesh of the beer."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import mujoco
import numpy as np

from mjbeer.model import looks
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, supported
from mjbeer.model.state import start
from mjbeer.paper.witness import TOP, fall_from_top
from mjbeer.simulation.simulate import simulate
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.rows import Row
from mjbeer.studies.validation.motions import observed_order
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.exact import exact, phi_error
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene

ORDERS: dict[Integrator, tuple[int, float]] = {"RK4": (4, 0.2), DOP853: (8, 0.5)}
"""Order of each integrator, and the largest difference of the observed order from it."""
ORDERS |= {name: (1, 0.1) for name in INTEGRATORS if name != "RK4"}
FILLS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
"""Fills at which the mesh of the beer is checked."""
_GRIP = 1e6
"""Friction coefficient so large that the hoop never slips."""


def rows() -> Iterator[Row]:
    """Yield the rows of models."""
    row = partial(Row, "models")
    for integrator, (expected, margin) in ORDERS.items():
        measure, by = partial(_order_error, frozen(), integrator), f"frozen, reduced, {integrator}"
        yield row(f"observed order less {expected}", measure, by, margin, "", "higher orders' terms")
    by, measure = "hoop, contact, RK4, 20 us", partial(_lift_off_error, hoop(hoop_mass=2e-4))
    quantity, reason = "lift-off angle at M/m = 1e-3 (Littlewood: 90 degrees)", "penetration of the contact"
    yield row(quantity, measure, by, 0.5, "degrees", f"{reason}, which unloads late")
    by, light, heavy = "hoop, contact, RK4, 0.1 ms", hoop(hoop_mass=0.2 / 20), hoop(hoop_mass=0.2 / 10)
    yield row("hops missing at M/m = 1/20", lambda: not _hops(light), by, 0, "", "it hops or not")
    yield row("hops too many at M/m = 1/10 (above 1/13)", lambda: _hops(heavy), by, 0, "", "it hops or not")
    quantity, by = "values that differ between two runs", "every scene, rolling and integrator"
    yield row(quantity, _count_differences, by, 0, "", "bit for bit")
    reason = "the polygon: falls as 1/resolution^2"
    for index, name in enumerate(("mass", "centre of mass", "inertia")):
        quantity, by = f"{name} of the beer's mesh, eqs. (33)-(37)", "fills 0.05 to 0.95"
        yield row(quantity, partial(_mesh_error, index), by, 1e-3, "relative", reason)


def _order_error(scene: Scene, integrator: Integrator) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, over six halvings, less the expected one.

    At order 8 the error falls by 14 digits over six halvings, more than a double has. For DOP853 each halving is
    therefore two rungs, and only rungs with an error between 1e-3 rad and 1e-13 rad are fitted.
    """
    if integrator == DOP853:
        steps, duration, between = 0.2 / np.sqrt(2) ** np.arange(13), 20.0, (1e-13, 1e-3)
    else:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        duration, between = 2.0, (0.0, math.inf)
    runs = (simulate(scene, duration, 0.3, integrator=integrator, timestep=float(h)) for h in steps)
    errors = np.array([phi_error(run) for run in runs])
    fitted = (errors > between[0]) & (errors < between[1])
    return observed_order(steps[fitted], errors[fitted]) - ORDERS[integrator][0]


def _hops(scene: Scene) -> bool:
    return fall_from_top(scene, 1e-4, _GRIP).takeoff() is not None


def _lift_off_error(scene: Scene) -> float:
    """Return the simulated less the exact angle of lift-off from the top [degrees], or NaN if the hoop stays down.

    It is where N = 0 in a fall from the top: 90 degrees as M/m -> 0.
    """
    fall = exact(scene, np.linspace(0, 1, 100_001), TOP)
    expected = math.pi - float(np.interp(fall.rolls_until(), fall.time, fall.phi))
    simulated = fall_from_top(scene, 2e-5, _GRIP).takeoff()
    return math.degrees(simulated - expected) if simulated is not None else math.nan


def _count_differences() -> int:
    """Return how many numbers differ when a run is repeated, in one thread and in two."""
    count = 0
    for scene in (sliding(), sliding(can=Can.sheet_metal()), frozen(), pendulum(), hoop()):
        for rolling in (way for way in ROLLINGS if supported(scene, way)):
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


def _mesh_error(index: int) -> float:
    return max(mesh_errors(fill)[index] for fill in FILLS)


def mesh_errors(fill: float, resolution: int = looks.EDGES) -> tuple[float, ...]:
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
    pairs = (body.mass[0], load.mass), (-data.body("beer").xipos[2], load.offset), (inertia, load.inertia)
    return tuple(abs(compiled / exact_value - 1) for compiled, exact_value in pairs)
