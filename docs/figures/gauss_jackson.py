"""Draws what Gauss-Jackson gains: `python docs/figures/gauss_jackson.py` writes gauss-jackson.svg."""

import pathlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from mjbeer import exact, frozen, pendulum, sliding
from mjbeer.exceptions import DivergenceError
from mjbeer.integrators import Method
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.gauss_jackson import GaussJackson, SundmanTime, sundman_time
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state
from mjbeer.output import plots
from mjbeer.simulation.methods import swing_law
from mjbeer.theory.scene import Scene

PHI0 = 1.0
"""Angle at which the load is let go [rad]."""
END = 2.0
"""End of the runs that are judged [s]."""
SCENES = {
    "sliding beer": sliding(),
    "frozen beer": frozen(),
    "a wheel of 10 g": pendulum(wheel_mass=0.01),
}
LIGHTEST = 0.001
"""Mass of the wheel whose steps are drawn [kg]."""
TIMESTEPS = 0.08 / 2 ** (np.arange(28) / 4)
"""Timesteps of the runs of Gauss-Jackson [s]."""
LOCAL_TOLERANCES = 10.0 ** -np.arange(3, 16, 0.5)
"""Local tolerances of the runs of DOP853."""
ERRORS = (1e-4, 1e-7, 1e-10)
"""Errors at which the table compares both [rad]."""


class Cost(NamedTuple):
    """What a method's runs have taken, and how far off they were."""

    evaluations: np.ndarray
    errors: np.ndarray  # the largest of phi [rad]

    def at(self, error: float) -> float:
        """Return the evaluations for an error [rad], between those of two runs."""
        falling = np.minimum.accumulate(self.errors)[::-1]
        evaluations = np.log(self.evaluations[::-1])
        return float(np.exp(np.interp(np.log(error), np.log(falling), evaluations)))


def sundman_time_of(scene: Scene) -> SundmanTime:
    """Return the Sundman time that passes as fast as t where the load is let go."""
    law = swing_law(scene)
    return sundman_time(law, law.inertia(PHI0))


def cost(scene: Scene, methods: list[Callable[[Dynamics], Method]]) -> Cost:
    """Return what runs of a scene take with methods that are finer and finer."""
    times = np.linspace(0, END, 101)[1:]
    truth = exact(scene, times, PHI0).phi
    model = build(scene)
    start = initial_state(model, scene, PHI0, 0.0)
    evaluations = []
    errors = []
    for method in methods:
        dynamics = Dynamics(model)
        try:
            states = method(dynamics).run(start, times)
        except DivergenceError:  # the timestep is too long
            continue
        evaluations.append(dynamics.evaluations)
        errors.append(float(np.abs(states[:, model.nq - 1] - truth).max()))
    return Cost(np.array(evaluations), np.array(errors))


def costs(scene: Scene) -> tuple[Cost, Cost]:
    """Return the costs of DOP853 and of Gauss-Jackson."""
    time = sundman_time_of(scene)
    runge_kutta = [
        lambda dynamics, local=local: DOP853(dynamics, local_tolerance=float(local))
        for local in LOCAL_TOLERANCES
    ]
    multistep = [lambda dynamics, h=h: GaussJackson(dynamics, float(h), time) for h in TIMESTEPS]
    return cost(scene, runge_kutta), cost(scene, multistep)


def step_ends(scene: Scene, timestep: float, end: float) -> np.ndarray:
    """Return the times at which the steps of Gauss-Jackson end [s]."""
    model = build(scene)
    pieces: list[np.ndarray] = []

    def note(times: np.ndarray, _: np.ndarray) -> None:
        pieces.append(times.copy())

    method = GaussJackson(Dynamics(model), timestep, sundman_time_of(scene))
    method.run(initial_state(model, scene, PHI0, 0.0), np.array([end]), note)
    return np.concatenate(pieces)


def rows() -> list[tuple[str, ...]]:
    """Return by how many times DOP853 needs more evaluations for each of the `ERRORS`, scene by scene, as texts."""
    texts = []
    for name, scene in SCENES.items():
        runge_kutta, multistep = costs(scene)
        ratios = [runge_kutta.at(error) / multistep.at(error) for error in ERRORS]
        texts.append((name, *(f"{ratio:.2g}" for ratio in ratios)))
    return texts


def draw(path: pathlib.Path) -> None:
    """Draw the steps along half a swing of a light wheel, and the error against evaluations."""
    title = "What Gauss-Jackson gains"
    subtitle = f"loads that are let go at {PHI0:g} rad, on MuJoCo's reduced models"
    with plots.chart(path, columns=2, width=10, height=4.4, title=title, subtitle=subtitle) as (
        left,
        right,
    ):
        wheel = pendulum(wheel_mass=LIGHTEST)
        end = 0.5 * wheel.period(PHI0)
        ends = step_ends(wheel, 0.01, end)
        even = np.linspace(0, end, len(ends))
        shown = np.linspace(0, end, 500)
        left.plot(shown, exact(wheel, shown, PHI0).phi, **plots.THEORY)
        left.plot(
            even, exact(wheel, even, PHI0).phi, "o", color=plots.COLOURS[1], label="steps even in t"
        )
        left.plot(
            ends,
            exact(wheel, ends, PHI0).phi,
            "o",
            color=plots.COLOURS[0],
            label="steps even in s",
            markersize=4,
        )
        left.set(xlabel="time t [s]", ylabel="φ [rad]", title="half a swing in a wheel of 1 g")
        left.legend()
        for colour, (name, scene) in zip(plots.COLOURS, SCENES.items(), strict=False):
            runge_kutta, multistep = costs(scene)
            right.loglog(runge_kutta.evaluations, runge_kutta.errors, "--", color=colour)
            right.loglog(multistep.evaluations, multistep.errors, "-", color=colour, label=name)
        right.set(
            xlabel="evaluations of MuJoCo's accelerations", ylabel="largest error of φ in 2 s [rad]"
        )
        right.set(title="error against work", ylim=(1e-15, 1e-1), xlim=(50, 3e5))
        right.plot([], [], "--", color=plots.GREY, label="with DOP853")
        right.legend(loc="upper right", bbox_to_anchor=(1.02, 1.0))


if __name__ == "__main__":
    draw(pathlib.Path(__file__).with_name("gauss-jackson"))
