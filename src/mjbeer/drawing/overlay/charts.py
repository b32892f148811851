"""The charts below a film of a trajectory: its quantities by name, with what exact theory says."""

from collections.abc import Sequence

import numpy as np

from mjbeer.drawing.overlay.quantity import QUANTITIES
from mjbeer.drawing.overlay.strip import MUJOCO, Chart, Line
from mjbeer.exceptions import MjbeerError
from mjbeer.theory.exact import solution
from mjbeer.theory.trajectory import Trajectory

_SMOOTH = 1500
"""Times at which theory's lines are computed."""


def charts(trajectory: Trajectory, names: Sequence[str]) -> list[Chart]:
    """Return the charts of some quantities of a trajectory, by their names in QUANTITIES."""
    theory, drawn = _theory(trajectory), []
    name = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
    for quantity in (QUANTITIES[name] for name in names):
        lines = [Line(name, trajectory.time, quantity.of(trajectory.scene, trajectory), MUJOCO)]
        if theory is not None:
            values = quantity.of(theory.scene, theory)
            lines.append(Line("theory", theory.time, values, possible=theory.rolls_until()))
        drawn.append(Chart(quantity.title, lines, low=quantity.low, high=quantity.high, least=quantity.least))
    return drawn


def _theory(trajectory: Trajectory) -> Trajectory | None:
    """Return what exact theory says of a simulated motion, if it says anything."""
    if trajectory.rolling == "exact" or trajectory.time[0] < 0:
        return None
    times = np.linspace(trajectory.time[0], trajectory.time[-1], _SMOOTH)
    try:
        return solution(trajectory.scene, times, trajectory.phi0, trajectory.phi_dot0)
    except MjbeerError:  # a start that rounding decides has no exact motion
        return None
