"""The linear theory of MuJoCo's soft constraints: which solref is stable at which timestep.

Along a row with the residual r, MuJoCo asks for the reference acceleration r'' = -b r' - k r and gets a share of it,
r'' = s (-b r' - k r) + (1 - s) a_free. With solref (tau, zeta) and a constant impedance d (solimp's dmin = dmax),

    b = 2/(d tau),   k = d/(d tau zeta)^2,

so that a share s = d leaves b s = 2/tau and k s = 1/(tau zeta)^2: the impedance drops out, and stability is a matter
of h/tau and zeta alone. It does not drop out where MuJoCo overestimates the row's diagonal by a factor, which is the
default: then s < d, and the row is softer and stable for longer timesteps than it looks.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.predictions.linear_stability import RUNGE_KUTTA, amplification, first, polynomial, spectral_radius
from mjbeer.theory.scene import Scene


def residual_slip(penetration: float, radius: float) -> float:
    """Slip over distance rolled of a can that sinks into the incline by `penetration` [m]: -delta/2a.

    MuJoCo's contact point lies midway between the two surfaces, at a - delta/2 from the axis: the can rolls as one
    with that radius.
    """
    return -penetration / (2 * radius)


def diagonal_excess(scene: Scene) -> float:
    """By what MuJoCo overestimates the diagonal of the equality u = a roll.

    It adds the joints' inverse inertias as they are, metres and radians alike: (1/m_u + 1/I)/(1/m_u + a^2/I) where
    the two are not coupled, with m_u and I the inverses of the diagonal of M^-1. A frozen load couples them, in the
    position phi = 0 by -m b, and the true diagonal is J M^-1 J^T with J = (1, -a).
    """
    can, load, moment = scene.can, scene.load, scene.load.mass * scene.load.offset
    if scene.attachment == "frozen":
        inertia = can.inertia + load.inertia + moment * load.offset
        mass_matrix = np.array([[scene.mass, -moment], [-moment, inertia]])
    else:
        swing = load.inertia + moment * load.offset
        mass_matrix = np.array(
            [[scene.mass, -moment, -moment], [-moment, can.inertia + swing, swing], [-moment, swing, swing]]
        )
    inverse = np.linalg.inv(mass_matrix)[:2, :2]
    row = np.array([1.0, -can.radius])
    return float(np.trace(inverse) / (row @ inverse @ row))


def softened(impedance: float, excess: float) -> float:
    """Share of a constraint's force that is let through where its diagonal is overestimated by a factor `excess`.

    The regularizer is R = (1 - d)/d times MuJoCo's diagonal, the share A/(A + R) with the true one A.
    """
    return 1 / (1 + (1 - impedance) / impedance * excess)


MAX_IMPEDANCE = 0.9999
"""mjMAXIMP: the hardest row that MuJoCo takes."""
_BOUNDED = 1 + 1e-9
"""Spectral radius of what counts as bounded; the double eigenvalue of a critically damped row is known to 1e-8."""


@dataclass(frozen=True)
class SoftRow:
    """A row's reference acceleration -b r' - k r, and its impedance."""

    stiffness: float
    """k [1/s^2], MuJoCo's K times the impedance."""
    damping: float
    """b [1/s]."""
    impedance: float
    """d, the share of the reference that an exact row gets."""

    def at_end_of_step(self, timestep: float) -> "SoftRow":
        """What "discrete" makes of it: the reference of the end of the step, as a row of its start.

        Put r' + h r'' and r + h r' + h^2 r'' into -b r' - k r: with S = 1 + h b + h^2 k the row is
        -((b + h k) r' + k r)/S, and its softness (1 - d)/d is divided by S, down to that of `MAX_IMPEDANCE`.
        """
        h = timestep
        scale = 1 + h * self.damping + h**2 * self.stiffness
        impedance = min(softened(self.impedance, 1 / scale), MAX_IMPEDANCE)
        return SoftRow(self.stiffness / scale, (self.damping + h * self.stiffness) / scale, impedance)


def spring(timeconst: float, dampratio: float, impedance: float) -> SoftRow:
    """The row of solref = (timeconst [s], dampratio)."""
    damping = 2 / (impedance * timeconst)
    return SoftRow(damping**2 * impedance / (4 * dampratio**2), damping, impedance)


def direct(stiffness: float, damping: float, impedance: float) -> SoftRow:
    """The row of solref = (-stiffness [1/s^2], -damping [1/s])."""
    return SoftRow(stiffness / impedance, damping / impedance, impedance)


def safe(timeconst: float, timestep: float) -> float:
    """The time constant [s] that refsafe makes of one: at least two timesteps.

    It asks for solref's first number alone: a damping ratio under 0.354 is still unstable at a time constant of two
    timesteps under semi-implicit Euler, and a direct (negative) solref is left as it is.
    """
    return max(timeconst, 2 * timestep)


def resolved(timeconst: float, dampratio: float, impedance: float, timestep: float) -> float:
    """The time constant [s] that refsafe makes of a contact's under "discrete": at least h/(zeta sqrt(d)).

    That is the row whose k h^2 is 1: it takes back all of its residual in one step. MuJoCo's manual puts the threshold
    at tau zeta = h, without the impedance; what it solves is this.
    """
    return max(timeconst, timestep / (dampratio * math.sqrt(impedance)))


def radius(integrator: str, row: SoftRow, timestep: float, excess: float = 1.0) -> float:
    """Spectral radius of a step of a row that is alone, with its diagonal overestimated by a factor `excess`."""
    if integrator == "discrete":
        row = row.at_end_of_step(timestep)
    share = softened(row.impedance, excess)
    scaled = share * row.stiffness * timestep**2, share * row.damping * timestep
    return spectral_radius(amplification(integrator, *scaled))


def stable_timestep(integrator: str, row: SoftRow, excess: float = 1.0) -> float:
    """Largest timestep [s] with a bounded row; infinite under "discrete", whatever the row.

    Under semi-implicit Euler 4 > 2 h b + h^2 k with the shares of b and k (Jury's criterion, with h b < 2).
    """
    scale = 1 / max(row.damping, math.sqrt(row.stiffness))
    limit = first(lambda h: radius(integrator, row, h, excess) - _BOUNDED, 1e-2 * scale, 1e6 * scale)
    return math.inf if limit == 1e6 * scale else limit


def stable_ratio(integrator: str, dampratio: float = 1.0) -> float:
    """Largest h/timeconst with a bounded row.

    Under semi-implicit Euler 2 zeta (sqrt(zeta^2 + 1) - zeta), 0.828 at zeta = 1; 2.785 under RK4, 6.39 under DOP853.
    """
    return stable_timestep(integrator, spring(1.0, dampratio, 1.0))


def stable_slip(integrator: str) -> float:
    """Largest h/timeconst of a friction row, which has the damping b = 2/timeconst and no stiffness.

    1 under semi-implicit Euler, and under a Runge-Kutta method half of its limit on the negative real axis, 1.393 for
    RK4: a contact bears half of the timestep that an equality does. That is for an impedance of 1. A friction row that
    `impratio` makes much harder than its contact gets all of its reference, b = 2/(d tau), and bears d times as much.
    """
    if integrator == "discrete":
        return math.inf
    if integrator not in RUNGE_KUTTA:
        return 1.0
    coefficients = polynomial(integrator)[::-1]
    return first(lambda rate: abs(float(np.polyval(coefficients, -rate))) - 1, 0.1, 50.0) / 2
