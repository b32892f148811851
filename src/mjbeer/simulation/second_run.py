"""What takes a second run: the error of a fixed timestep, and rolling with some friction."""

import math

from mjbeer.exceptions import DivergenceError
from mjbeer.model.joints import joint_addresses, to_coordinates
from mjbeer.simulation.methods import fixed_method, model_numbers
from mjbeer.simulation.run import Run, turns_rounding
from mjbeer.simulation.solve import NUDGE, solve
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.theory.oscillator import reduced
from mjbeer.theory.record import Record
from mjbeer.theory.trajectory import largest_error

_OVER_DISTANCE = 3.2
"""Error estimate divided by the distance to an uneven run. A contact is 0.62 times as soft in that
run, so that its distance is 1/2.6 of the error; 3.2 allows for an order that has not settled."""
_DEPTH = 0.5
"""Depth at which a can in contact starts in the uneven run, divided by that in the run. The errors
by softness in the two parts of a step fall to 0.62 and 0.38 of themselves; half the depth lies
between, so that they cannot cancel."""


def compare_uneven(run: Run) -> float:
    """Return the error of phi and u/a [rad] that an uneven run shows, relative beyond 1 rad.

    It is infinite if that run diverges. Constraints that are tuned to the timestep are harder in
    the uneven run, so that its distance from the first one includes the effect of their softness.
    It begins a little aside, which adds the effect of rounding and of a contact's depth.
    """
    scene = run.scene
    motion = run.checkpoints
    phi0 = reduced(run.phi0)
    u0, _ = scene.initial_axis(phi0, run.phi_dot0)
    # The kept model may have another scene.
    stepped = SteppedModel(model_numbers(scene, run.setting, uneven=True))
    start = stepped.initial_state(phi0 + NUDGE, run.phi_dot0)
    if run.rolling == "contact":
        start[joint_addresses(stepped.model)["lift"]] *= _DEPTH
    try:
        states = fixed_method(stepped, run.setting, uneven=True).run(start, motion.time)
    except DivergenceError:
        return math.inf
    uneven = to_coordinates(stepped.model, scene, states, motion.time)
    return _OVER_DISTANCE * largest_error(motion, uneven, scene.can.radius, (phi0, u0))


def record_with_friction(run: Run, friction: float) -> Record:
    """Return the record of the same run for a can with a coefficient of `friction`."""
    stepped = SteppedModel(model_numbers(run.scene, run.setting))
    start = stepped.initial_state(reduced(run.phi0), run.phi_dot0)
    rounding = turns_rounding(run.phi0)
    times = run.checkpoints.time
    return solve(stepped, run.setting, start, times, friction=friction, rounding=rounding).record
