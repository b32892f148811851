"""Linear theory of integrators: at which timesteps a small motion stays bounded and accurate.

**Integrators** turn linear equations q'' = -k q - b q' into x_{n+1} = G x_n for x = (q, h q'), with
a matrix G of K = k h^2 and B = b h alone. A motion is bounded if no eigenvalue of G lies outside
the unit circle. For a Runge-Kutta method G = R(h L), where R is the polynomial of its tableau and L
the matrix of the equations as x' = L x (E. Hairer, G. Wanner, Solving Ordinary Differential
Equations II, section IV.2). MuJoCo's "Euler", "implicit", "implicitfast" and "discrete" are the
same semi-implicit Euler for forces like gravity.

**Soft constraints** have rows with a residual r, for instance u - a roll, and a reference
acceleration -b r' - k r, of which a share s is reached: r'' = s (-b r' - k r) + (1 - s) a_free,
where a_free is the acceleration without the constraint. With solref (tau, zeta) and a constant
impedance d (solimp's dmin = dmax)

    b = 2/(d tau),   k = d/(d tau zeta)^2,

so that s = d gives b s = 2/tau and k s = 1/(tau zeta)^2, and stability depends on h/tau and zeta
alone. By default MuJoCo overestimates the diagonal of the row. Then s < d, and the row is softer
than its solref suggests.

**Damping** is treated implicitly by all integrators but RK4 and DOP853. "Euler" does so only for
joints, and the damping of the reduced model is that of a tendon.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import DOP853
from scipy.linalg import expm
from scipy.optimize import brentq

from mjbeer.theory.scene import Scene

RUNGE_KUTTA = ("RK4", "DOP853")
"""The integrators that are Runge-Kutta methods; MuJoCo's others are semi-implicit Euler.

GaussJackson, a multistep method, is not treated here.
"""
IMPLICIT = ("implicit", "implicitfast", "discrete")
"""The integrators that step with M + h D in place of M."""
PERIODS = 200
"""Number of periods over which a stable swing must stay bounded."""
GROWTH = 100.0
"""Largest factor by which a bounded swing may grow over `PERIODS`.

With semi-implicit Euler, a swing grows tenfold if the timestep is 0.5 % below the limit, and by far
more than this factor if it is 0.5 % above.
"""
ACCURATE_PERIODS = 10
"""Number of periods over which an accurate swing must stay accurate."""
ACCURACY = 1e-2
"""Largest error of an accurate swing: a distance in the plane of phi and phi_dot/omega, divided by
the amplitude."""
MAX_IMPEDANCE = 0.9999
"""Impedance of the hardest row that MuJoCo accepts, mjMAXIMP."""


class _Tableau(NamedTuple):
    """The coefficients of a Runge-Kutta method."""

    stages: np.ndarray
    """The matrix A."""
    weights: np.ndarray
    """The vector b."""


_TABLEAUS = {
    "RK4": _Tableau(
        np.array([[0, 0, 0, 0], [1 / 2, 0, 0, 0], [0, 1 / 2, 0, 0], [0, 0, 1, 0]]),
        np.array([1, 2, 2, 1]) / 6,
    ),
    "DOP853": _Tableau(np.asarray(DOP853.A[:12, :12]), np.asarray(DOP853.B)),
}
_RATIO = 1.02
"""Ratio of two successive values that `first` tries."""


def polynomial(integrator: str) -> np.ndarray:
    """Return the coefficients of R(z) = 1 + sum_j z^j b A^(j-1) 1 of a Runge-Kutta method.

    The constant comes first.
    """
    stages, weights = _TABLEAUS[integrator]
    powers = np.ones(len(weights))
    coefficients = [1.0]
    for _ in weights:
        coefficients.append(float(weights @ powers))
        powers = stages @ powers
    return np.array(coefficients)


def amplification(integrator: str, stiffness: ArrayLike, damping: ArrayLike = 0.0) -> np.ndarray:
    """Return the matrix G of one step of q'' = -k q - b q'.

    `stiffness` is K = k h^2 and `damping` is B = b h: numbers for one coordinate, or matrices of
    shape (n, n) for n coordinates. G has shape (2n, 2n). Semi-implicit Euler, v += h a(q, v),
    q += h v, has G = ((1 - K, 1 - B), (-K, 1 - B)).
    """
    k = np.atleast_2d(np.asarray(stiffness, dtype=float))
    b = np.broadcast_to(np.asarray(damping, dtype=float), k.shape)
    one = np.eye(len(k))
    if integrator not in RUNGE_KUTTA:
        return np.block([[one - k, one - b], [-k, one - b]])
    rates = np.block([[np.zeros_like(k), one], [-k, -b]])
    matrix = np.zeros_like(rates)
    for coefficient in polynomial(integrator)[::-1]:  # Horner's scheme
        matrix = rates @ matrix + coefficient * np.eye(len(rates))
    return matrix


def spectral_radius(matrix: np.ndarray) -> float:
    """Return the largest magnitude of an eigenvalue."""
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def motion(matrix: np.ndarray, start: np.ndarray, steps: int) -> np.ndarray:
    """Return the states G^n `start` for n = 0 to `steps`, shape (steps + 1, len(start)).

    They are not finite after an overflow.
    """
    states = np.array([start], dtype=float)
    power = np.array(matrix)
    with np.errstate(over="ignore", invalid="ignore"):
        while len(states) <= steps:
            states = np.concatenate([states, states @ power.T])
            power = power @ power
    return states[: steps + 1]


def error(integrator: str, swing: float) -> float:
    """Return the largest error, as in `ACCURACY`, of a swing from rest over `ACCURATE_PERIODS`.

    `swing` is omega h. For small h the error is omega h/2 with semi-implicit Euler, whose ellipse
    in the phase plane leans. With RK4 it is (omega h)^4/120 for each radian of the swing.
    """
    steps = math.floor(ACCURATE_PERIODS * 2 * math.pi / swing)
    states = motion(amplification(integrator, swing**2), np.array([1.0, 0.0]), steps)
    angles = swing * np.arange(steps + 1)
    angle_errors = states[:, 0] - np.cos(angles)
    rate_errors = states[:, 1] / swing + np.sin(angles)
    return float(np.hypot(angle_errors, rate_errors).max())


def stable_limit(integrator: str) -> float:
    """Return the largest omega h with a bounded swing.

    The limits are 2 for semi-implicit Euler, 2 sqrt(2) for RK4, and 5.97 for DOP853. For RK4 the
    result is 0.15 % larger, as an instability needs time to grow.
    """

    def excess(swing: float) -> float:
        steps = PERIODS * 2 * math.pi / swing
        growth = spectral_radius(amplification(integrator, swing**2))  # in a step
        return steps * math.log(growth) - math.log(GROWTH)

    return first(excess, 0.05, 20.0)


def accurate_limit(integrator: str) -> float:
    """Return the largest omega h with an accurate swing."""

    def excess(swing: float) -> float:
        return error(integrator, swing) - ACCURACY

    return first(excess, 5e-3, stable_limit(integrator))


def first(excess: Callable[[float], float], low: float, high: float) -> float:
    """Return the smallest value above `low` at which `excess` turns positive, or `high`."""

    def sign(value: float) -> float:
        return math.copysign(1, excess(value))

    while low < high:
        above = low * _RATIO
        if excess(above) > 0:
            return float(brentq(sign, low, above, xtol=1e-9 * low, rtol=1e-12))
        low = above
    return high


def reached_share(impedance: float, excess: float) -> float:
    """Return the share s that a row reaches if MuJoCo overestimates its diagonal `excess` times.

    The regularizer R is (1 - d)/d times MuJoCo's diagonal; the share is A/(A + R) with the true
    diagonal A.
    """
    return 1 / (1 + (1 - impedance) / impedance * excess)


@dataclass(frozen=True)
class SoftRow:
    """One row of a soft constraint, with the reference acceleration -b r' - k r."""

    stiffness: float
    """k [1/s^2], MuJoCo's K times the impedance."""
    damping: float
    """b [1/s]."""
    impedance: float
    """d, the share of the reference acceleration that a row with the exact diagonal reaches."""

    def at_end_of_step(self, timestep: float) -> "SoftRow":
        """Return the row that MuJoCo's "discrete" solves in place of this one.

        "discrete" computes -b r' - k r with the residual r + h r' + h^2 r'' at the end of the step,
        and its rate r' + h r''. With S = 1 + h b + h^2 k, this is -((b + h k) r' + k r)/S with the
        residual at the start of the step. The softness (1 - d)/d is divided by S, but is never less
        than that of `MAX_IMPEDANCE`.
        """
        h = timestep
        scale = 1 + h * self.damping + h**2 * self.stiffness
        impedance = min(reached_share(self.impedance, 1 / scale), MAX_IMPEDANCE)
        damping = (self.damping + h * self.stiffness) / scale
        return SoftRow(self.stiffness / scale, damping, impedance)


def spring(timeconst: float, dampratio: float, impedance: float) -> SoftRow:
    """Return the row of solref = (timeconst [s], dampratio)."""
    damping = 2 / (impedance * timeconst)
    return SoftRow(damping**2 * impedance / (4 * dampratio**2), damping, impedance)


def direct(stiffness: float, damping: float, impedance: float) -> SoftRow:
    """Return the row of solref = (-stiffness [1/s^2], -damping [1/s])."""
    return SoftRow(stiffness / impedance, damping / impedance, impedance)


@dataclass(frozen=True, eq=False)
class SmallMotion:
    """Linear equations of the joints of a model, M q'' + D q' + K q = 0.

    They hold on level ground near phi = 0. D is 0 if an equality ties the joints.
    """

    mass: np.ndarray
    """Mass matrix M, shape (n, n)."""
    gravity: np.ndarray
    """Stiffness matrix K of gravity, shape (n, n)."""
    damping: np.ndarray | float = 0.0
    """Damping matrix D of a tendon, shape (n, n)."""
    jacobian: np.ndarray | None = None
    """The Jacobian J of an equality, shape (n,); None without an equality."""

    def exact(self, timestep: float) -> np.ndarray:
        """Return the matrix exp(h L) of (q, h q') over a `timestep` h [s], without the equality."""
        zeros = np.zeros_like(self.mass)
        identity = np.eye(len(self.mass))
        stiffness = np.linalg.solve(self.mass, self.gravity)
        damping = np.linalg.solve(self.mass, zeros + self.damping)  # a matrix, if it is 0 as well
        lower = [-stiffness * timestep**2, -damping * timestep]
        return expm(np.block([[zeros, identity], lower]))

    def step(self, integrator: str, timestep: float, row: SoftRow | None = None) -> np.ndarray:
        """Return the matrix of one step of (q, h q') with a `timestep` h [s].

        The equality, if there is one, is `row`.
        """
        zeros = np.zeros_like(self.mass)
        mass = self.mass
        if integrator in IMPLICIT:
            mass = self.mass + timestep * self.damping
        stiffness = np.linalg.solve(mass, self.gravity)
        damping = np.linalg.solve(mass, zeros + self.damping)  # a matrix, if it is 0 as well
        if row is not None and self.jacobian is not None:
            if integrator == "discrete":
                row = row.at_end_of_step(timestep)
            towards = np.linalg.solve(mass, self.jacobian)
            gain = towards / (self.jacobian @ towards) * reached_share(row.impedance, 1.0)
            missing = row.stiffness * self.jacobian - self.jacobian @ stiffness
            stiffness = stiffness + np.outer(gain, missing)
            damping = damping + np.outer(gain, row.damping * self.jacobian)
        return amplification(integrator, stiffness * timestep**2, damping * timestep)


def small_motion(scene: Scene, constrained: bool = False) -> SmallMotion:
    """Return the small motion of a scene on level ground.

    The coordinates are u and phi for a sliding load, and phi for a frozen one. If `constrained`,
    those of a frozen load are u and the can's roll, tied by the equality u = a roll.
    """
    moment = scene.load.moment
    radius = scene.can.radius
    inertia = scene.load.axis_inertia
    if scene.attachment == "frozen" and not constrained:
        mass = scene.oscillator.inertia(np.zeros((1, 1)))
        gravity = np.full((1, 1), moment * scene.gravity)
        return SmallMotion(mass, gravity)
    gravity = np.diag([0.0, moment * scene.gravity])
    if constrained:
        mass = np.array([[scene.mass, -moment], [-moment, scene.can.inertia + inertia]])
        return SmallMotion(mass, gravity, jacobian=np.array([1.0, -radius]))
    mass = np.array([[scene.effective_mass, -moment], [-moment, inertia]])
    ahead = np.array([-1 / radius, 1.0])
    damping = scene.damping_law.linear * np.outer(ahead, ahead)
    return SmallMotion(mass, gravity, damping)
