"""Checks of the modes of damped scenes: small motions of MuJoCo's own, and the accelerations that it computes."""

import math
from collections.abc import Iterator, Mapping

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.model.setting import Rolling
from mjbeer.model.state import read, write
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.check import Check
from mjbeer.theory.can import Can
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.named import sliding
from mjbeer.theory.scene import Scene

SIX_DECADES = tuple(float(c) for c in np.geomspace(1e-5, 10, 7))
"""Damping from nearly free to stiff [N m s]: the fast mode decays with 9e4 1/s at the end."""
_ASIDE = 1e-4
"""Half the width of the central differences, relative. Their next term is its square over about 3, 4e-9; rounding over
it is as large where steady rolling is fastest."""


def checks(cans: Mapping[str, Can]) -> Iterator[Check]:
    """Yield the checks of modes of scenes with these cans."""
    for name, can in cans.items():
        yield Check(
            quantity="decay and frequency of a swing of 3e-4 rad: root of the cubic",
            by=f"sliding on level ground, {name}, 1e-5 to 10 N m s, reduced, tolerance 1e-10",
            bound=1e-7,
            unit="relative",
            reason="the amplitude itself: 2e-8",
            deviation=lambda can=can: max(_root_error(sliding(0.0, can=can, damping=c)) for c in SIX_DECADES),
        )
    differences = "the width of the differences, 4e-9, and as much rounding at the terminal speed, 37 m/s at most"
    settings: tuple[tuple[str, Rolling, float, str], ...] = (
        ("massless can", "reduced", 3e-8, differences),
        ("metal can", "reduced", 3e-8, differences),
        ("metal can", "equality", 1e-7, "rounding of the constraint's force at the terminal speed, 34 m/s at most"),
    )
    for name, rolling, bound, reason in settings:
        yield Check(
            quantity="each decay and frequency of the linearized model: roots of the cubic",
            by=f"sliding, {name}, 1e-5 to 10 N m s, {rolling}",
            bound=bound,
            unit="relative",
            reason=reason,
            deviation=lambda can=cans[name], rolling=rolling: max(
                _spectrum_error(sliding(can=can, damping=c), rolling) for c in SIX_DECADES
            ),
        )


def _root_error(scene: Scene) -> float:
    """Return the distance of a simulated swing's complex root from the cubic's, relative to its size.

    The samples are states, each of which is the same matrix times the one before. Directions that the samples hardly
    have are left out: rounding fills those of a mode that has decayed.
    """
    unit = math.sqrt(scene.gravity / scene.can.radius)
    run = simulate(scene, 2, 3e-4, tolerance=1e-10, times=np.linspace(0, 2, 201))
    states = np.stack([run.phi, run.phi_dot / unit, run.u_dot / (unit * scene.can.radius)])
    left, sizes, right = np.linalg.svd(states[:, :-1], full_matrices=False)
    kept = sizes > 1e-7 * sizes[0]
    matrix = left[:, kept].T @ states[:, 1:] @ right[kept].T / sizes[kept]
    factors, roots = np.linalg.eigvals(matrix), scene.modes()
    swing, expected = factors[np.argmax(factors.imag)], roots[np.argmax(roots.imag)]
    return float(abs(np.log(swing) / run.time[1] / expected - 1))


def _spectrum_error(scene: Scene, rolling: Rolling) -> float:
    """Return the largest error of a decay or a frequency among all eigenvalues of a linearized model, relative."""
    found, roots = np.sort_complex(np.linalg.eigvals(_linearization(scene, rolling))), scene.modes()
    pairs = [(found.real, roots.real), (found.imag[roots.imag != 0], roots.imag[roots.imag != 0])]
    return max(float(np.abs(value / expected - 1).max()) for value, expected in pairs)


def _linearization(scene: Scene, rolling: Rolling) -> np.ndarray:
    """Return the matrix [1/s] of small motions of phi, phi_dot and u_dot about the steady rolling of a damped scene.

    Rates are in units of sqrt(g/a), which leaves the eigenvalues as they are. No timestep takes part.
    """
    model, unit = build(scene, rolling), math.sqrt(scene.gravity / scene.can.radius)
    data, units = mujoco.MjData(model), np.array([1.0, unit, scene.can.radius * unit])

    def slope(state: np.ndarray) -> np.ndarray:
        now = write(model, _rolling(scene, *state))[0]
        data.qpos[:], data.qvel[:], data.qacc_warmstart[:] = now[: model.nq], now[model.nq :], 0.0
        mujoco.mj_forward(model, data)
        rates = read(model, scene, np.concatenate([data.qvel, data.qacc])[np.newaxis], np.zeros(1))
        return np.array([state[1], rates.phi_dot[0], rates.u_dot[0]])

    steady = np.array([scene.terminal_tilt(), 0.0, scene.terminal_speed()])
    columns = [(slope(steady + aside) - slope(steady - aside)) / (2 * _ASIDE) for aside in np.diag(_ASIDE * units)]
    return np.stack(columns, axis=1) / units[:, np.newaxis]


def _rolling(scene: Scene, phi: float, phi_dot: float, u_dot: float) -> Coordinates:
    """Return a sample of a can that rolls past u = 0 without slip."""
    values = {"phi": phi, "phi_dot": phi_dot, "u_dot": u_dot, "roll_dot": u_dot / scene.can.radius}
    return Coordinates(**{name: np.array([values.get(name, 0.0)]) for name in Coordinates.__dataclass_fields__})
