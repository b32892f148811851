"""The motion of a damped sliding scene to rounding, step by step: no first integral makes it a quadrature."""

import numpy as np

from mjbeer.theory.place import Place
from mjbeer.theory.scene import Scene
from mjbeer.theory.viscous_equations import ViscousEquations
from mjbeer.theory.viscous_walk import Walk


def solve(
    scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at the times `time` [s], none of them negative.

    Raises:
      ToleranceError: if rounding of start and scene changes phi or u/a by more than 1e-4 rad, relative beyond 1 rad, or
        if the motion takes too many steps.
    """
    radius, (u0, u_dot0) = scene.can.radius, scene.start(phi0, phi_dot0)
    if scene.incline == 0 and phi_dot0 == 0 and Place.of(scene.oscillator.crest, phi0).on_top(phi0):
        still = np.zeros_like(time)
        return phi0 + still, still, u0 + still, still
    order = np.argsort(time)
    walk = Walk(ViscousEquations.of(scene), time[order], phi0, phi_dot0, u_dot0 / radius - phi_dot0)
    walk.run()
    turned, rolled, phi_dot, slip = np.empty((4, len(time)))
    turned[order], rolled[order], phi_dot[order], slip[order] = walk.samples.T
    return phi0 + turned, phi_dot, u0 + radius * rolled, radius * (phi_dot + slip)
