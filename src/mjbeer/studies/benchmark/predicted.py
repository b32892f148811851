"""Numerical errors as theory predicts them, beside those of simulations."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mjbeer.model.build import compile_model
from mjbeer.model.setting import TUNED, USUAL
from mjbeer.model.softness import softness
from mjbeer.output.table import Table
from mjbeer.predictions import semi_implicit_euler, soft_constraint
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.cases import CASES
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact, phi_error
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding


@dataclass(frozen=True)
class Prediction:
    """A numerical error as theory predicts it, and as simulations have it."""

    what: str
    of: str
    predict: Callable[[], float]
    measure: Callable[[], float]


def predictions() -> list[Prediction]:
    """Return every numerical error that theory gives in advance, with functions that predict and measure it."""
    found = [
        Prediction(
            "frequency too high by (omega h)^2/24", f"{name}, Euler, 4 ms",
            lambda scene=scene: semi_implicit_euler.frequency_shift(scene.frequency(), 4e-3),
            lambda scene=scene: _frequency_shift(scene, 4e-3),
        )
        for name, scene in (("sliding", sliding()), ("frozen", frozen()), ("pendulum", pendulum()))
    ]  # fmt: skip
    found.append(
        Prediction(
            "distance too long by h/T", "sliding at rest in its can, Euler, 1 ms",
            lambda: semi_implicit_euler.distance_excess(1e-3, 2.0), lambda: _distance_excess(1e-3, 2.0),
        )
    )  # fmt: skip
    for name in ("sliding", "frozen", "pendulum"):
        case = CASES[name]
        found.append(
            Prediction(
                "largest error of phi by backward error analysis [rad]", f"{name}, Euler, 0.0625 ms",
                lambda case=case: (
                    6.25e-5 * _largest(semi_implicit_euler.euler_error(case.scene, case.times, case.phi0))
                ),
                lambda case=case: phi_error(
                    simulate(case.scene, case.times[-1], case.phi0, integrator="Euler", timestep=6.25e-5,
                             times=case.times)
                ),
            )
        )  # fmt: skip
    metal = sliding(can=Can.sheet_metal())
    for name, tuned in (("defaults", False), ("tuned", True)):
        found.append(
            Prediction(
                "slip over distance, -penetration/2a", f"sliding in a metal can, contact, {name}",
                lambda tuned=tuned: soft_constraint.residual_slip(_sunk(metal, tuned)[0], metal.can.radius),
                lambda tuned=tuned: _sunk(metal, tuned)[1],
            )
        )  # fmt: skip
    for name, scene in (("frozen", frozen()), ("sliding in a metal can", metal), ("pendulum", pendulum())):
        found.append(
            Prediction(
                "share of the force of an equality of d = 0.9", f"{name}, slide first",
                lambda scene=scene: soft_constraint.reached_share(0.9, soft_constraint.diagonal_excess(scene)),
                lambda scene=scene: _share(scene),
            )
        )  # fmt: skip
    return found


def table() -> Table:
    """Return the predicted errors beside the measured ones."""
    rows = []
    for prediction in predictions():
        predicted, measured = prediction.predict(), prediction.measure()
        apart = f"{measured / predicted - 1:+.1e}"
        rows.append((prediction.what, prediction.of, f"{predicted:.4g}", f"{measured:.4g}", apart))
    columns = ("numerical error", "where", "predicted", "measured", "apart")
    return Table("Numerical errors that theory gives in advance", columns, rows)


def _largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def _frequency_shift(scene: Scene, timestep: float) -> float:
    """Of a swing of 1e-4 rad, whose own amplitude shifts it by 1e-9."""
    swing = simulate(scene, 20.0, scene.equilibrium() + 1e-4, integrator="Euler", timestep=timestep)
    return swing.frequency() / scene.frequency() - 1


def _distance_excess(timestep: float, duration: float) -> float:
    run = simulate(sliding(), duration, 0.0, integrator="Euler", timestep=timestep)
    return float(run.u[-1] / exact(run.scene, run.time, 0.0).u[-1] - 1)


def _sunk(scene: Scene, tuned: bool) -> tuple[float, float]:
    """Penetration [m], and slip over distance, of a can that rolls steadily, in the second half of 2 s."""
    rest = scene.equilibrium()
    softness = TUNED if tuned else USUAL["contact, defaults"].softness
    run = simulate(scene, 2.0, rest, rolling="contact", softness=softness)
    half = len(run.time) // 2
    return -float(run.lift[half:].mean()), float((run.slip[-1] - run.slip[half]) / (run.u[-1] - run.u[half]))


def _share(scene: Scene) -> float:
    """Of the force of the joint equality as usually written, in the position phi = 0."""
    model = compile_model(scene, USUAL["equality, slide first"])
    soft = softness(model, np.zeros(model.nq + model.nv))
    assert soft is not None
    return soft.effective_impedance
