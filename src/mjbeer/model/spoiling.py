"""What the options of a world spoil for a can in it."""

import math

import mujoco
import numpy as np

from mjbeer.model.free_numbers import BREAKING, bob_shares
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

_LARGEST_TURN = 0.5
"""Largest angle [rad] of a mode's oscillation in a timestep: semi-implicit integrators then have it
1 % too fast."""
RK4_STABLE = 2.785
"""Largest product of a timestep and a rate of decay with which RK4 is stable."""


def option_reasons(option: mujoco.MjOption, can: Standing | Scene) -> list[str]:
    """Return in which ways a world's options spoil a can."""
    reasons = []
    runge_kutta = option.integrator == mujoco.mjtIntegrator.mjINT_RK4
    if isinstance(can, Scene):
        if not runge_kutta:
            reasons.append(
                "with another integrator than RK4 "
                "the error of rolling is of the order of the timestep"
            )
    else:
        turn = option.timestep * max(can.frequencies(), default=0.0)
        if turn > _LARGEST_TURN:
            reasons.append(
                f"the timestep of {option.timestep:g} s is coarse: "
                f"the fastest mode turns by {turn:.3g} rad in it, "
                f"not {_LARGEST_TURN:g} or less"
            )
    decay = fastest_decay(can)
    if runge_kutta and option.timestep * decay > RK4_STABLE:
        limit = f"{RK4_STABLE / decay:.2g} s or less"
        reasons.append(
            f"with RK4 its damping may diverge at a timestep of {option.timestep:g} s: give {limit}"
        )
    gravity = float(np.linalg.norm(option.gravity))
    if not math.isclose(gravity, can.gravity, rel_tol=1e-6):
        reasons.append(f"gravity is {gravity:.6g} m/s^2, and the can is made for {can.gravity:.6g}")
    if decay > 0 and option.disableflags & int(mujoco.mjtDisableBit.mjDSBL_DAMPER):
        reasons.append("with the flag damper disabled it has no damping")
    return reasons


def mass_reasons(compiler: mujoco.MjsCompiler, child: mujoco.MjSpec) -> list[str]:
    """Return in which ways the compiler settings of a world change the masses of a can."""
    reasons = []
    if compiler.settotalmass > 0:
        reasons.append("settotalmass scales its masses")
    moving = [body for body in child.bodies if body.mass > 0]
    least = {
        "boundmass": min(body.mass for body in moving),
        "boundinertia": min(min(body.inertia) for body in moving),
    }
    for name, value in least.items():
        if getattr(compiler, name) > value:
            reasons.append(
                f"{name} raises what is less, from {value:.2g} on, "
                "once the world is saved and read again"
            )
    return reasons


def fastest_decay(can: Standing | Scene) -> float:
    """Return the largest rate [1/s] at which damping slows the spin of a bob or of a can.

    Linear damping has exactly this rate. Damping that grows with the rate is taken at the frequency
    of the first mode, or at sqrt(g/a), which is an estimate.
    """
    if isinstance(can, Scene):
        if not can.damping_law:
            return 0.0
        slope = can.damping_law.derivative(math.sqrt(can.gravity / can.can.radius))
        about_axis = can.load.inertia + can.load.moment * can.load.offset
        return float(slope * (1 / can.can.inertia + 1 / about_axis))
    omega = can.frequencies()
    breaking = BREAKING * omega[:1] ** 2 / omega
    rates = 2 * (can.damping_ratios() * omega + breaking) / bob_shares(can)
    return float(np.max(rates, initial=0.0))
