"""Sliding beer in many massless cans by heyoka's ensemble: one compiled integrator, whose parameters are the scenes'.

The equations are derived by hand, (46) and (47) with the letters of `Oscillator`: that is what makes it fast, and what
a general engine does without.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.theory.scene import Scene

Propagate = Callable[[], tuple[np.ndarray, np.ndarray]]
"""A function that integrates all motions, and returns phi [rad] and u [m] at their ends."""


def installed() -> bool:
    """Return whether heyoka can be imported."""
    try:
        import heyoka  # noqa: F401
    except ImportError:
        return False
    return True


def ensemble(scenes: Sequence[Scene], phi0: float, duration: float, tolerance: float) -> Propagate:
    """Compile the integrator for a `tolerance` per step, and return what integrates all scenes from rest at `phi0`.

    All scenes have a sliding load and neither damping nor drag.
    """
    import heyoka

    u, phi, u_dot, phi_dot = heyoka.make_vars("u", "phi", "u_dot", "phi_dot")
    base, swing, along, normal, steady, arm = (heyoka.par[place] for place in range(6))
    sin, cos = heyoka.sin(phi), heyoka.cos(phi)
    phi_ddot = (along * cos - (normal + swing * phi_dot**2.0 * cos) * sin) / (base + swing * sin**2.0)
    rates = [u_dot, phi_dot, steady + arm * (cos * phi_ddot - sin * phi_dot**2.0), phi_ddot]
    equations = list(zip((u, phi, u_dot, phi_dot), rates, strict=True))
    integrator = heyoka.taylor_adaptive(equations, [0.0] * len(equations), tol=tolerance)
    parameters = np.array([_parameters(scene) for scene in scenes])
    starts = np.array([[scene.start(phi0, 0.0)[0], phi0, 0.0, 0.0] for scene in scenes])

    def begin(integrator: Any, index: int) -> Any:
        integrator.time = 0.0
        integrator.state[:], integrator.pars[:] = starts[index], parameters[index]
        return integrator

    def propagate() -> tuple[np.ndarray, np.ndarray]:
        ended = heyoka.ensemble_propagate_until(integrator, duration, len(scenes), begin)
        if any(outcome[0] != heyoka.taylor_outcome.time_limit for _, *outcome in ended):
            raise DivergenceError("heyoka: a motion did not reach its end")
        states = np.array([each.state for each, *_ in ended])
        return states[:, 1], states[:, 0]

    return propagate


def _parameters(scene: Scene) -> list[float]:
    form, moment = scene.oscillator, scene.load.moment
    arm = moment / scene.effective_mass
    along, normal = form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)
    return [form.base, form.swing, along, normal, scene.acceleration(), arm]
