"""The motion of a scene that rolls without slipping, from the Lagrangian in the two coordinates u and phi.

A load at the angle phi is at s = u - b sin(phi) along the incline and at -b cos(phi) across it. With
M = m + m_can + I_can/a^2, and g_s and g_c for gravity along and across the incline,

    T = 1/2 (M - m) u'^2 + 1/2 m ((u' - b cos(phi) phi')^2 + (b sin(phi) phi')^2) + 1/2 I phi'^2,
    V = -(m + m_can) g_s u - m b (g_c cos(phi) - g_s sin(phi)).

A sliding load has both coordinates free. Lagrange's equations are, the first integrated at once,

    (M u - m b sin(phi))'' = (m + m_can) g_s,
    (I + m b^2) phi'' = m b (cos(phi) u'' - g_c sin(phi) - g_s cos(phi)).

With u'' eliminated the second one has nothing left that cancels:

    (M I + m b^2 (M - m) + (m b sin(phi))^2) phi''
      = -m b (M g_c sin(phi) + I_can/a^2 g_s cos(phi)) - (m b)^2 sin(phi) cos(phi) phi'^2.

A frozen load has u = a phi. With h = phi/2, Lagrange's equation is

    (I + I_can + m_can a^2 + m (a - b)^2 + 4 m a b sin(h)^2) phi''
      = g_s (m_can a + m (a - b)) + 2 m b g_s sin(h)^2 - 2 m b (g_c + a phi'^2) sin(h) cos(h).
"""

import math

import numpy as np

from mjbeer.studies.stability.reference.taylor import integrate
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene, require_no_dissipation

MOST_STEPS = 400_000
"""Largest number of steps of a motion, which take some two seconds. A swing takes about twenty."""


class LongMotionError(Exception):
    """A motion takes more than `MOST_STEPS` steps; the message says so."""


def reference(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float = 0.0) -> Coordinates:
    """Return the motion at increasing `times` [s] that starts at `phi0` [rad] with `phi_dot0` [rad/s] at time 0.

    A sliding load starts at s = 0 with s' = 0, a frozen one at u = a phi. Units of mass, length and time are powers of
    two near the load's mass, the radius and the fastest time of the motion, so that no conversion is rounded.

    Raises:
      DissipationError: if the scene has damping or drag.
      LongMotionError: if the motion is too long.
    """
    require_no_dissipation(scene, "no reference")
    can, load = scene.can, scene.load
    mass, length = _unit(load.mass), _unit(can.radius)
    pace = abs(phi_dot0) + math.sqrt(scene.gravity / can.radius)
    unit = _unit(1 / pace) if pace > 0 else 1.0
    a, b, m, m_can = can.radius / length, load.offset / length, load.mass / mass, can.mass / mass
    inertia, can_inertia = load.inertia / (mass * length**2), can.inertia / (mass * length**2)
    gravity = scene.gravity * unit**2 / length
    along, across = gravity * math.sin(scene.incline), gravity * math.cos(scene.incline)
    moment, rim = m * b, can_inertia / a**2
    if scene.attachment == "sliding":
        total = m + m_can + rim
        form = (
            1.0,
            0.0,
            0.0,
            -moment * across,
            -moment * rim * along / total,
            0.0,
            moment**2 / total,
            inertia + moment * b * (m_can + rim) / total,
            moment**2 / total,
        )
    else:
        form = (
            0.5,
            along * (m_can * a + m * (a - b)),
            2 * moment * along,
            0.0,
            0.0,
            2 * moment * across,
            2 * moment * a,
            inertia + can_inertia + m_can * a**2 + m * (a - b) ** 2,
            4 * moment * a,
        )
    moments, samples = np.asarray(times, dtype=float), np.empty((len(times), 2))
    if integrate(form, phi0, phi_dot0 * unit, moments / unit, samples, MOST_STEPS) < 0:
        raise LongMotionError(f"the motion takes more than {MOST_STEPS} steps")
    phi, phi_dot = samples[:, 0], samples[:, 1] / unit
    if scene.attachment == "sliding":
        u, u_dot = _axis(scene, moments, phi, phi_dot, phi0, phi_dot0)
    else:
        u, u_dot = can.radius * phi, can.radius * phi_dot
    return Coordinates(
        time=moments,
        u=u,
        phi=phi,
        u_dot=u_dot,
        phi_dot=phi_dot,
        roll=u / can.radius,
        roll_dot=u_dot / can.radius,
        lift=np.zeros_like(phi),
        lift_dot=np.zeros_like(phi),
    )


def _axis(
    scene: Scene, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, phi0: float, phi_dot0: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return u [m] and u' [m/s] above a sliding load: M u - m b sin(phi) falls freely from its value at the start."""
    can, load = scene.can, scene.load
    rim = can.effective_mass
    total, moment = load.mass + rim, load.moment
    fall = (load.mass + can.mass) * scene.gravity * math.sin(scene.incline)
    place, speed = rim * load.offset * math.sin(phi0), rim * load.offset * math.cos(phi0) * phi_dot0
    u = (place + speed * time + fall * time**2 / 2 + moment * np.sin(phi)) / total
    return u, (speed + fall * time + moment * np.cos(phi) * phi_dot) / total


def _unit(size: float) -> float:
    """Return the power of two just above a positive size."""
    return 2.0 ** math.frexp(size)[1]
