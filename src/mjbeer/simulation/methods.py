"""The methods for a scene in a setting: one with a fixed timestep, or finer and finer ones.

mjbeer's own integrators are imported only where they are used, as numba is slow to import.
"""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjbeer.integrators import Method
from mjbeer.integrators.mujoco_steps import MuJoCoSteps
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import MJBEER_INTEGRATORS, Setting
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from mjbeer.integrators.gauss_jackson import SwingLaw

_GOLDEN_SECTION = (math.sqrt(5) - 1) / 2
"""The longer part of a timestep in an uneven run, as a share of it. No multiple of it is near a
whole number, so that no rotation has the same phase at the ends of both parts."""
_FINER = 1.4
"""Timestep of a run of Gauss-Jackson divided by that of the next, whose error is 1.4^13 = 79 times
smaller."""
_FINER_RUNS = 5
"""Largest number of runs of Gauss-Jackson: the error of the last is 1.4^(4 x 13) = 4e7 times
smaller than that of the first."""
_TIME_PRECISION = 1e-3
"""Precision of the durations of Gauss-Jackson's steps, divided by the tolerance."""
_FIRST_LOCAL = 1 / 200
"""Local tolerance of DOP853's first run divided by the tolerance: errors of steps add up."""
_COARSEST_LOCAL = 1e-7
"""Largest local tolerance of a first run: with larger steps two runs may agree by accident."""
_FINER_LOCAL = 64.0
"""Local tolerance of a run of DOP853 divided by that of the next, which takes 1.7 times as many
steps."""
_SMALLEST_LOCAL = 1e-16
"""Local tolerance below which the error of a step is rounding."""
_SHORTER = 1.25
"""Longest step of a run of DOP853 divided by that of the next, at least. A rotation may be so even
that steps of any length keep a local tolerance, and two runs with the same steps would have the
same error."""


def model_numbers(scene: Scene, setting: Setting, uneven: bool = False) -> ModelNumbers:
    """Return the numbers of the model that is stepped.

    In an `uneven` run its constraints are tuned to shorter timesteps. A rigid equality that is
    integrated to a tolerance only has to correct the slip that rounding causes. It is tuned to
    sqrt(a/g)/2, a twelfth of the period of a pendulum of length a, which is too slow to limit the
    steps.
    """
    timestep = setting.timestep
    if setting.tolerance is not None and setting.rolling == "equality" and scene.gravity > 0:
        timestep = math.sqrt(scene.can.radius / scene.gravity) / 2
    elif uneven:
        timestep *= _GOLDEN_SECTION
    return ModelNumbers(scene, setting, timestep=timestep)


def fixed_method(stepped: SteppedModel, setting: Setting, uneven: bool = False) -> Method:
    """Return the integrator of a setting with its fixed timestep.

    If `uneven`, MuJoCo's integrators take each timestep as two parts of unequal length, and
    mjbeer's own take shorter steps: an even and an uneven run have no timestep with which both
    could be wrong alike.
    """
    timestep = setting.timestep
    if setting.integrator not in MJBEER_INTEGRATORS:
        parts = (timestep,)
        if uneven:
            parts = (_GOLDEN_SECTION * timestep, (1 - _GOLDEN_SECTION) * timestep)
        return MuJoCoSteps(stepped.model, stepped.data, parts, setting.integrator)
    if uneven:
        timestep *= _GOLDEN_SECTION
    if setting.integrator == "DOP853":
        from mjbeer.integrators.dop853 import DOP853

        return DOP853(stepped.dynamics, timestep)
    from mjbeer.integrators.gauss_jackson import GaussJackson, sundman_time

    law = swing_law(stepped.scene)
    # With this unit no step is longer than a timestep.
    return GaussJackson(stepped.dynamics, timestep, sundman_time(law, law.largest_inertia()))


def swing_law(scene: Scene) -> "SwingLaw":
    """Return the numbers of a scene by which Gauss-Jackson chooses its steps."""
    from mjbeer.integrators.gauss_jackson import SwingLaw

    swing = scene.oscillator
    arm = scene.load.moment / scene.effective_mass
    return SwingLaw(
        base=swing.base,
        chord=swing.chord,
        coupling=swing.coupling,
        ramp=swing.ramp,
        depth=swing.depth,
        bottom=swing.bottom,
        arm=arm,
    )


def suits_gauss_jackson(scene: Scene, model: mujoco.MjModel) -> bool:
    """Return whether Gauss-Jackson can step a model: one without constraints and damping."""
    return not (model.neq or scene.dissipates)


def finer_gauss_jackson(
    stepped: SteppedModel, start: np.ndarray, duration: float, tolerance: float
) -> Iterator[Method]:
    """Yield Gauss-Jackson with shorter and shorter timesteps; the first may err by `tolerance`."""
    from mjbeer.integrators.gauss_jackson import GaussJackson, first_timestep, sundman_time

    law = swing_law(stepped.scene)
    phi0 = float(start[stepped.model.nq - 1])
    phi_dot0 = float(start[-1])
    first = first_timestep(law, phi0, phi_dot0, duration, tolerance)
    precision = _TIME_PRECISION * min(tolerance, 1.0)
    time = sundman_time(law, law.inertia(phi0), precision, first.largest_turn)
    timestep = first.timestep
    for _ in range(_FINER_RUNS):
        yield GaussJackson(stepped.dynamics, timestep, time)
        timestep /= _FINER


def finer_dop853(stepped: SteppedModel, tolerance: float, scale: np.ndarray) -> Iterator[Method]:
    """Yield DOP853 with smaller and smaller local tolerances, down to rounding.

    Run each method before you ask for the next one, whose steps are shorter than the longest that
    it has taken.
    """
    from mjbeer.integrators.dop853 import DOP853

    coarsest = _COARSEST_LOCAL
    finest = _FINER_LOCAL * _SMALLEST_LOCAL  # so that a finer run can follow
    local = max(finest, min(coarsest, _FIRST_LOCAL * tolerance))
    longest_step = math.inf
    while True:
        method = DOP853(
            stepped.dynamics, local_tolerance=local, scale=scale, longest_step=longest_step
        )
        yield method
        if local <= _SMALLEST_LOCAL:
            return
        longest_step = method.longest_step_taken / _SHORTER
        local = max(local / _FINER_LOCAL, _SMALLEST_LOCAL)
