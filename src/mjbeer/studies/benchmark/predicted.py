"""The numerical errors that theory predicts, beside those that simulations have."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from mjbeer.model.build import compile_spec, compose
from mjbeer.model.setting import TUNED
from mjbeer.output.terminal import Table
from mjbeer.predictions import semi_implicit_euler, soft_constraint, soft_rolling
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.benchmark.curves import USUAL
from mjbeer.studies.benchmark.measure import effective_softness
from mjbeer.studies.cases import CASES, Case
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact, phi_error
from mjbeer.theory.named import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene


@dataclass(frozen=True)
class Prediction:
    """A numerical error, with a function that predicts it and one that measures it in a simulation."""

    what: str
    """The error, and how it is predicted."""
    of: str
    """The scene and the setting."""
    predict: Callable[[], float]
    measure: Callable[[], float]


def predictions() -> list[Prediction]:
    """Return every numerical error that theory gives in advance."""
    return [*_frequencies(), _distance(), *_euler_errors(), *_slips(), *_shares()]


def _frequencies() -> Iterator[Prediction]:
    """The map has eigenvalues exp(+-i nu h) with sin(nu h/2) = omega h/2."""
    for name, scene in (("sliding", sliding()), ("frozen", frozen()), ("pendulum", pendulum())):
        yield Prediction(
            what="frequency too high by (omega h)^2/24",
            of=f"{name}, Euler, 4 ms",
            predict=lambda scene=scene: (scene.frequency() * 4e-3) ** 2 / 24,
            measure=lambda scene=scene: _frequency_shift(scene, 4e-3),
        )


def _distance() -> Prediction:
    """From rest, after n = T/h steps the distance is a h^2 n (n + 1)/2 instead of a T^2/2."""
    return Prediction(
        what="distance too long by h/T",
        of="sliding at rest in its can, Euler, 1 ms",
        predict=lambda: 1e-3 / 2.0,
        measure=lambda: _distance_excess(1e-3, 2.0),
    )


def _euler_errors() -> Iterator[Prediction]:
    for name in ("sliding", "frozen", "pendulum"):
        case = CASES[name]
        yield Prediction(
            what="largest error of phi by backward error analysis [rad]",
            of=f"{name}, Euler, 0.0625 ms",
            predict=lambda case=case: _predicted_phi_error(case, 6.25e-5),
            measure=lambda case=case: _measured_phi_error(case, 6.25e-5),
        )


def _slips() -> Iterator[Prediction]:
    """The contact point lies midway between the surfaces, at a - delta/2, and the can rolls as with that radius."""
    scene = sliding(can=Can.sheet_metal())
    for name, tuned in (("defaults", False), ("tuned", True)):
        yield Prediction(
            what="slip over distance, -penetration/2a",
            of=f"sliding in a metal can, contact, {name}",
            predict=lambda tuned=tuned: -_penetration_and_slip(scene, tuned)[0] / (2 * scene.can.radius),
            measure=lambda tuned=tuned: _penetration_and_slip(scene, tuned)[1],
        )


def _shares() -> Iterator[Prediction]:
    metal = sliding(can=Can.sheet_metal())
    for name, scene in (("frozen", frozen()), ("sliding in a metal can", metal), ("pendulum", pendulum())):
        yield Prediction(
            what="share of the force of an equality of d = 0.9",
            of=f"{name}, slide first",
            predict=lambda scene=scene: soft_constraint.reached_share(0.9, soft_rolling.diagonal_excess(scene)),
            measure=lambda scene=scene: _share(scene),
        )


def table() -> Table:
    """Return the predicted errors beside the measured ones."""
    rows = []
    for prediction in predictions():
        predicted, measured = prediction.predict(), prediction.measure()
        difference = f"{measured / predicted - 1:+.1e}"
        rows.append((prediction.what, prediction.of, f"{predicted:.4g}", f"{measured:.4g}", difference))
    columns = ("numerical error", "where", "predicted", "measured", "apart")
    return Table("Numerical errors that theory gives in advance", columns, rows)


def _predicted_phi_error(case: Case, timestep: float) -> float:
    """Return the largest error of phi [rad] under semi-implicit Euler by backward error analysis."""
    return timestep * float(np.abs(semi_implicit_euler.euler_error(case.scene, case.times, case.phi0)).max())


def _measured_phi_error(case: Case, timestep: float) -> float:
    """Return the largest error of phi [rad] in a simulation with semi-implicit Euler."""
    run = simulate(case.scene, case.times[-1], case.phi0, integrator="Euler", timestep=timestep, times=case.times)
    return phi_error(run)


def _frequency_shift(scene: Scene, timestep: float) -> float:
    """Return the relative error of the frequency of a swing of 1e-4 rad; its finite amplitude adds 1e-9 only."""
    swing = simulate(scene, 20.0, scene.equilibrium() + 1e-4, integrator="Euler", timestep=timestep)
    return swing.frequency() / scene.frequency() - 1


def _distance_excess(timestep: float, duration: float) -> float:
    """Return the relative error of the distance rolled by a can whose beer does not swing."""
    run = simulate(sliding(), duration, 0.0, integrator="Euler", timestep=timestep)
    return float(run.u[-1] / exact(run.scene, run.time, 0.0).u[-1] - 1)


def _penetration_and_slip(scene: Scene, tuned: bool) -> tuple[float, float]:
    """Return penetration [m] and slip over distance of a can that rolls steadily, over the second half of 2 s."""
    rest = scene.equilibrium()
    softness = TUNED if tuned else USUAL["contact, defaults"].softness
    run = simulate(scene, 2.0, rest, rolling="contact", softness=softness)
    half = len(run.time) // 2
    return -float(run.lift[half:].mean()), float((run.slip[-1] - run.slip[half]) / (run.u[-1] - run.u[half]))


def _share(scene: Scene) -> float:
    """Return the share of a hard constraint's force that a usual joint equality has, at phi = 0."""
    model = compile_spec(compose(scene, USUAL["equality, slide first"]))
    soft = effective_softness(model, np.zeros(model.nq + model.nv))
    assert soft is not None
    return soft.effective_impedance
