"""Draws what Gauss-Jackson gains.

`python docs/figures/gauss_jackson.py` writes gauss-jackson.svg.
"""

import pathlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

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
WHEEL = pendulum(wheel_mass=0.01)
"""The scene whose steps are drawn: in a light wheel a swing is fast at the bottom."""
SCENES = {"sliding beer": sliding(), "frozen beer": frozen(), "a wheel of 10 g": WHEEL}
TIMESTEPS = 0.08 / 2 ** (np.arange(28) / 4)
"""Timesteps of the runs of Gauss-Jackson [s]."""
LOCAL_TOLERANCES = 10.0 ** -np.arange(3, 16, 0.5)
"""Local tolerances of the runs of DOP853."""
COMPARED = 1e-7
"""Error at which the picture compares both [rad]."""
ERRORS = (1e-4, COMPARED, 1e-10)
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
    """Return how many times as many evaluations DOP853 needs for each of the `ERRORS`.

    There is a row of texts for each scene, which begins with the scene's name.
    """
    texts = []
    for name, scene in SCENES.items():
        runge_kutta, multistep = costs(scene)
        ratios = [runge_kutta.at(error) / multistep.at(error) for error in ERRORS]
        texts.append((name, *(f"{ratio:.2g}" for ratio in ratios)))
    return texts


def draw(path: pathlib.Path) -> None:
    """Draw the steps along half a swing of a light wheel, and the error against evaluations."""
    found = {name: costs(scene) for name, scene in SCENES.items()}
    ratios = [runge.at(COMPARED) / multistep.at(COMPARED) for runge, multistep in found.values()]
    title = (
        f"DOP853 needs {min(ratios):.2g} to {max(ratios):.2g} times as many evaluations "
        "as Gauss-Jackson"
    )
    subtitle = (
        f"loads that are let go at {PHI0:g} rad, on MuJoCo's reduced models; Gauss-Jackson takes "
        "even steps in s, a time that passes faster where the load swings faster"
    )
    with plots.chart(path, columns=2, width=9, height=4.6, title=title, subtitle=subtitle) as (
        left,
        right,
    ):
        _draw_steps(left)
        for colour, (name, of_scene) in zip(plots.COLOURS, found.items(), strict=False):
            runge_kutta, multistep = of_scene
            right.loglog(runge_kutta.evaluations, runge_kutta.errors, "--", color=colour)
            right.loglog(multistep.evaluations, multistep.errors, "-", color=colour, label=name)
        right.set(
            xlabel="evaluations of MuJoCo's accelerations",
            ylabel="largest error of φ in 2 s [rad]",
            title=f"Error against work, compared at $10^{{{np.log10(COMPARED):.0f}}}$ rad",
            ylim=(1e-15, 1e1),
            xlim=(40, 1e5),
        )
        right.set_yticks(10.0 ** np.arange(-14, 1, 2))
        right.axhline(COMPARED, **plots.REFERENCE)
        right.legend(loc="upper left", ncols=3, fontsize=9.5, columnspacing=1.0, handlelength=1.2)
        plots.note(right, "Gauss-\nJackson", (55, 1e-11), (0, 0), color="black")
        plots.note(right, "DOP853\n(dashed)", (1.6e4, 1e-8), (0, 0), color="black")


def _draw_steps(axes: Axes) -> None:
    """Draw the steps along half a swing of a load in a light wheel."""
    end = 0.5 * WHEEL.period(PHI0)
    ends = step_ends(WHEEL, 0.01, end)
    even = np.linspace(0, end, len(ends))
    shown = np.linspace(0, end, 500)
    blue, orange = plots.COLOURS[:2]
    axes.plot(shown, exact(WHEEL, shown, PHI0).phi, **plots.THEORY)
    axes.plot(even, exact(WHEEL, even, PHI0).phi, "o", color=orange)
    axes.plot(ends, exact(WHEEL, ends, PHI0).phi, "o", color=blue, markersize=4)
    plots.note(axes, "steps even in t", (0.045, 0.75), (0, 0), color=orange)
    plots.note(
        axes, "steps even in s: shorter\nwhere the swing is fast", (0.0, -0.3), (0, 0), color=blue
    )
    axes.set(xlabel="time t [s]", ylabel="φ [rad]", title="Half a swing in a wheel of 10 g")


if __name__ == "__main__":
    draw(pathlib.Path(__file__).with_name("gauss-jackson"))
