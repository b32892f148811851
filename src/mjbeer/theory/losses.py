"""What damping and drag take from a motion between its samples, so that what is left can be compared with theory.

A motion with damping conserves neither its energy nor its momentum, but it loses known amounts of them. They are
integrals over time, and a motion is known at its samples alone. Between two of them the amounts are those along the
motion of theory from the first one. It is computed by the eighth-order Runge-Kutta method of Dormand and Prince, whose
error is below that of any run which takes the same steps.
"""

import functools
import math
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.equations import Coordinates, accelerations, dissipation, slip_rate
from mjbeer.theory.scene import Scene

_RELAXED = 3.0
"""Largest step over the time in which damping brings can and load together. The method is unstable from 6.4 on."""
_TURNED = 0.5
"""Largest step over the time in which the load swings, or turns, by a radian."""
_LARGEST = 1e10
"""Largest rate that MuJoCo does not call diverged [rad/s]."""
_MOST = 16
"""Largest number of steps of theory between two samples."""


@dataclass(frozen=True, eq=False)
class Losses:
    """What a motion loses between each sample and the next one; every array has shape (samples - 1,)."""

    work: np.ndarray
    """Energy that damping and drag take [J]."""
    speed: np.ndarray
    """What they take from u_dot - (m b / M) cos(phi) phi_dot, whose rate is else constant: eq. (46) [m/s]."""
    way: np.ndarray
    """What they take from its integral, u - (m b / M) sin(phi) [m]."""
    swing: np.ndarray | None
    """Energy that they take from the swing, J phi_dot^2 / 2 + V [J]; negative where they drive it. None if the samples
    do not follow how can and load come together."""


def losses(scene: Scene, motion: Coordinates) -> Losses:
    """Return what damping and drag take between the samples of a motion, which are in the order of time."""
    step, count = np.diff(motion.time), parts(scene, motion)
    state = np.stack([motion.phi[:-1], motion.phi_dot[:-1], motion.u_dot[:-1]])
    if count > _MOST:
        with np.errstate(all="ignore"):  # what is not finite makes the motion untrusted
            return _of_stiff(scene, motion, step)
    totals, way, step = np.zeros((3, len(step))), np.zeros(len(step)), step / count
    for _ in range(count):
        state, gained, further = _step(scene, state, step)
        way += step * totals[1] + further
        totals += gained
    work, speed, swing = totals
    return Losses(work=work, speed=speed, way=way, swing=swing)


def _of_stiff(scene: Scene, motion: Coordinates, step: np.ndarray) -> Losses:
    """Return the losses of a motion whose steps are longer than can and load need to come together.

    What the slip rate is beside that of the motion which follows falls exponentially, and the latter changes slowly.
    """
    state, effective_mass = (motion.phi, motion.phi_dot, motion.u_dot), _effective_mass(scene)
    u_ddot, phi_ddot = accelerations(scene, *state)
    rate, slip = np.maximum(stiffness(scene, *state), np.finfo(float).tiny), slip_rate(scene, *state[1:])
    beside = -slip_rate(scene, phi_ddot, u_ddot) / rate
    lasting, slope = slip - beside, np.asarray(scene.damping_law.slope(slip))
    torque, drag = np.asarray(scene.damping_law.torque(lasting)), scene.drag * motion.u_dot * np.abs(motion.u_dot)
    work, force = lasting * torque + drag * motion.u_dot, torque / scene.can.radius + drag
    rate, beside, first = rate[:-1], beside[:-1], slope[:-1] * beside[:-1]
    short, shorter = -np.expm1(-rate * step) / rate, -np.expm1(-2 * rate * step) / (2 * rate)
    done = step * (work[:-1] + work[1:]) / 2
    done += short * (lasting[:-1] * first + torque[:-1] * beside) + shorter * first * beside
    further = first / scene.can.radius
    impulse = step * (force[:-1] + force[1:]) / 2 + short * further
    way = step**2 * (2 * force[:-1] + force[1:]) / 6 + (step - short) / rate * further
    return Losses(work=done, speed=impulse / effective_mass, way=way / effective_mass, swing=None)


def _effective_mass(scene: Scene) -> float:
    return scene.mass + scene.can.inertia / scene.can.radius**2


def followed(scene: Scene, motion: Coordinates) -> bool:
    """Return whether samples are near enough to one another to tell what the motion loses between them."""
    return parts(scene, motion) <= _MOST


def parts(scene: Scene, motion: Coordinates) -> int:
    """Return how many steps of theory go between samples of a motion that are the farthest apart for its rates."""
    step = np.diff(motion.time)
    if not len(step):
        return 1
    relaxing, turning = stiffness(scene, motion.phi, motion.phi_dot, motion.u_dot), np.abs(motion.phi_dot)
    turning = turning + math.sqrt(scene.oscillator.depth / scene.oscillator.base)
    rate = np.maximum(relaxing / _RELAXED, turning / _TURNED)
    most = float((step * np.maximum(rate[:-1], rate[1:])).max())
    return max(1, math.ceil(most)) if most <= _MOST else _MOST + 1


def stiffness(scene: Scene, phi: np.ndarray, phi_dot: np.ndarray, u_dot: np.ndarray) -> np.ndarray:
    """Return the rate at which damping brings can and load together [1/s]: the torque's slope times J_f/(a^2 M J).

    J_f is the inertia against which can and load turn as one.
    """
    radius, moment, mass = scene.can.radius, scene.load.mass * scene.load.offset, _effective_mass(scene)
    frozen = mass * radius**2 + scene.load.inertia + moment * (scene.load.offset - 2 * radius * np.cos(phi))
    slope = scene.damping_law.slope(slip_rate(scene, phi_dot, u_dot))
    drag = 2 * scene.drag * np.abs(u_dot) / mass
    return slope * frozen / (radius**2 * mass * scene.oscillator.inertia(phi)) + drag


def stiffest(scene: Scene) -> float:
    """Return the largest rate at which damping brings can and load together [1/s], at the slip rates that may last.

    The weight of can and load, pulling at the rim, drives them apart at most at these.
    """
    slip = min(scene.damping_law.rate(scene.mass * scene.gravity * scene.can.radius), _LARGEST)
    angles = np.linspace(0, math.pi, 91)
    return float(stiffness(scene, angles, np.full_like(angles, slip), np.zeros_like(angles)).max())


def forgetting(scene: Scene, phi_dot: np.ndarray, u_dot: np.ndarray) -> np.ndarray:
    """Return the rate at which damping and drag make up for a speed that is too large or too small [1/s]."""
    slope = scene.damping_law.slope(slip_rate(scene, phi_dot, u_dot))
    return (slope / scene.can.radius**2 + 2 * scene.drag * np.abs(u_dot)) / _effective_mass(scene)


def _rates(scene: Scene, phi: np.ndarray, phi_dot: np.ndarray, u_dot: np.ndarray) -> np.ndarray:
    """Return the rates of work, of what the speed loses, and of what the swing loses, shape (3, samples)."""
    torque, along = dissipation(scene, phi_dot, u_dot)
    arm = scene.load.mass * scene.load.offset * np.cos(phi) / _effective_mass(scene)
    # In all, the force acts on the axis, and the torque on the load. What they do not take from the swing they take
    # from the motion at the speed u_dot - arm phi_dot.
    return np.stack(
        [-along * u_dot - torque * phi_dot, -along / _effective_mass(scene), -(torque + arm * along) * phi_dot]
    )


@functools.cache
def _method() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the coefficients of a step: those of the stages, the weights, and the times of the stages."""
    from scipy.integrate import DOP853  # only here, as most scenes have no losses

    return DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]


def _step(scene: Scene, state: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states phi, phi_dot, u_dot after a step [s] of theory, the losses in it, and that of the way."""
    stages, weights, times = _method()
    slopes, rates = np.zeros((len(weights), *state.shape)), np.zeros((len(weights), *state.shape))
    for stage in range(len(weights)):
        at = state + step * np.tensordot(stages[stage, :stage], slopes[:stage], 1) if stage else state
        u_ddot, phi_ddot = accelerations(scene, *at)
        slopes[stage], rates[stage] = (at[1], phi_ddot, u_ddot), _rates(scene, *at)
    end, gained = state + step * np.tensordot(weights, slopes, 1), step * np.tensordot(weights, rates, 1)
    return end, gained, step**2 * np.tensordot(weights * (1 - times), rates[:, 1], 1)
