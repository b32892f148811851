"""The exact motion of a scene that rolls without slipping, from theory alone."""

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory import damped_motion, motion
from mjbeer.theory.equations import axis_motion
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, angle_distance


def exact(scene: Scene, time: ArrayLike, phi0: float, phi_dot0: float = 0.0) -> Trajectory:
    """Return the exact motion of a scene that starts with `phi0` [rad] and `phi_dot0` [rad/s] at time 0.

    `time` [s] has the times of the samples, in any order, none before 0. `Scene.start` has u and u_dot at time 0. A
    start beyond a whole turn gives an `AngleWarning`, as degrees may have been meant.

    Raises:
      ParameterError: if `scene` is no scene, a time is negative or not finite, the start is not between -1e4 and 1e4
        rad or -1e6 and 1e6 rad/s, the motion has more than 1e4 turns on an incline, or is beyond double precision.
      NoLibrationError: if the start is so near the separatrix that its rounding decides how the motion goes on.
      ToleranceError: with damping or drag, if the start is so near an unstable balance that its rounding changes phi by
        more than 1e-4 rad, or the motion takes too many steps; the message says until when it can be followed.
    """
    require.instance("scene", scene, Scene)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    require.warn_of_degrees(phi0)
    return exact_motion(scene, require.times("time", time), phi0, phi_dot0)


def exact_motion(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> Trajectory:
    """Return the motion of `exact`, without a warning about the start."""
    radius = scene.can.radius
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            if scene.dissipates:
                phi, phi_dot, u, u_dot = damped_motion.solve(scene, time, phi0, phi_dot0)
            else:
                phi, phi_dot = motion.solve(scene.oscillator, time, phi0, phi_dot0)
                u, u_dot = axis_motion(scene, time, phi, phi_dot, (phi0, phi_dot0, *scene.start(phi0, phi_dot0)))
            roll, roll_dot = u / radius, u_dot / radius
    except ParameterError:
        raise
    except (ArithmeticError, ValueError) as error:
        raise ParameterError(
            f"this motion is beyond double precision ({error}), got phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s "
            f"until {float(time.max())!r} s in {scene!r}"
        ) from error
    still = np.zeros_like(time)
    names = ("time", "u", "phi", "u_dot", "phi_dot", "roll", "roll_dot", "lift", "lift_dot")
    arrays = zip(names, (time, u, phi, u_dot, phi_dot, roll, roll_dot, still, still), strict=True)
    return Trajectory(scene=scene, phi0=phi0, phi_dot0=phi_dot0, **dict(arrays))


def phi_error(trajectory: Trajectory, relative: bool = False) -> float:
    """Return the largest distance of phi [rad] from the exact motion with the same start.

    If `relative`, the distance is divided by the angle that phi has turned, where that exceeds 1 rad: this is the
    error that a tolerance bounds.
    """
    truth = exact_motion(trajectory.scene, trajectory.time, trajectory.phi0, trajectory.phi_dot0)
    return angle_distance(trajectory.phi, truth.phi, trajectory.phi0 if relative else None)
