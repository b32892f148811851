"""The linear theory of MuJoCo's soft constraints: which solref is stable at which timestep.

In the solver a constraint is one row or several. A row has a residual r, for instance u - a roll, and a reference
acceleration -b r' - k r. Because it is soft, only a share s of that is reached:

    r'' = s (-b r' - k r) + (1 - s) a_free,

where a_free is the acceleration without the constraint. With solref (tau, zeta) and a constant impedance d (solimp's
dmin = dmax),

    b = 2/(d tau),   k = d/(d tau zeta)^2,

so that a share s = d leaves b s = 2/tau and k s = 1/(tau zeta)^2: the impedance drops out, and stability depends on
h/tau and zeta alone. It does not drop out where MuJoCo overestimates the row's diagonal, as it does by default: then
s < d, and the row is softer, and stable for longer timesteps, than its solref suggests.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.predictions.linear_stability import RUNGE_KUTTA, amplification, first, polynomial, spectral_radius

MAX_IMPEDANCE = 0.9999
"""Impedance of the hardest row that MuJoCo accepts, mjMAXIMP."""
_BOUNDED = 1 + 1e-9
"""Largest spectral radius that counts as bounded."""


def residual_slip(penetration: float, radius: float) -> float:
    """Return the slip over the distance rolled of a can that sinks by `penetration` [m] into the incline: -delta/2a.

    MuJoCo's contact point lies midway between the two surfaces, at a - delta/2 from the axis, and the can rolls as if
    that were its radius.
    """
    return -penetration / (2 * radius)


def reached_share(impedance: float, excess: float) -> float:
    """Return the share s of a row whose diagonal MuJoCo overestimates by a factor `excess`.

    The regularizer R is (1 - d)/d times MuJoCo's diagonal; the share is A/(A + R) with the true diagonal A.
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

        Its reference acceleration is that of the residual at the end of the step: r' + h r'' and r + h r' + h^2 r''
        in -b r' - k r. With S = 1 + h b + h^2 k that is -((b + h k) r' + k r)/S at the start of the step. The
        softness (1 - d)/d is divided by S, but stays at least that of `MAX_IMPEDANCE`.
        """
        h = timestep
        scale = 1 + h * self.damping + h**2 * self.stiffness
        impedance = min(reached_share(self.impedance, 1 / scale), MAX_IMPEDANCE)
        return SoftRow(self.stiffness / scale, (self.damping + h * self.stiffness) / scale, impedance)


def spring(timeconst: float, dampratio: float, impedance: float) -> SoftRow:
    """Return the row of solref = (timeconst [s], dampratio)."""
    damping = 2 / (impedance * timeconst)
    return SoftRow(damping**2 * impedance / (4 * dampratio**2), damping, impedance)


def direct(stiffness: float, damping: float, impedance: float) -> SoftRow:
    """Return the row of solref = (-stiffness [1/s^2], -damping [1/s])."""
    return SoftRow(stiffness / impedance, damping / impedance, impedance)


def refsafe_timeconst(timeconst: float, timestep: float) -> float:
    """Return the time constant [s] that MuJoCo's refsafe uses instead of `timeconst` [s]: at least two timesteps.

    Under semi-implicit Euler a damping ratio below 0.354 is unstable even so. A direct solref is not changed.
    """
    return max(timeconst, 2 * timestep)


def discrete_refsafe_timeconst(timeconst: float, dampratio: float, impedance: float, timestep: float) -> float:
    """Return the time constant [s] that refsafe uses for a contact under "discrete": at least h/(zeta sqrt(d)).

    At that limit k h^2 = 1: one step corrects all of the residual. MuJoCo's manual leaves out the impedance.
    """
    return max(timeconst, timestep / (dampratio * math.sqrt(impedance)))


def radius(integrator: str, row: SoftRow, timestep: float, excess: float = 1.0) -> float:
    """Return the spectral radius of one step of a single row, whose diagonal MuJoCo overestimates by `excess`."""
    if integrator == "discrete":
        row = row.at_end_of_step(timestep)
    share = reached_share(row.impedance, excess)
    scaled = share * row.stiffness * timestep**2, share * row.damping * timestep
    return spectral_radius(amplification(integrator, *scaled))


def stable_timestep(integrator: str, row: SoftRow, excess: float = 1.0) -> float:
    """Return the largest timestep [s] with a bounded row; infinite under "discrete", whatever the row.

    Under semi-implicit Euler it is the largest h with 4 > 2 h s b + h^2 s k (Jury's criterion, with h s b < 2).
    """
    scale = 1 / max(row.damping, math.sqrt(row.stiffness))
    limit = first(lambda h: radius(integrator, row, timestep=h, excess=excess) - _BOUNDED, 1e-2 * scale, 1e6 * scale)
    return math.inf if limit == 1e6 * scale else limit


def stable_ratio(integrator: str, dampratio: float = 1.0) -> float:
    """Return the largest h/timeconst with a bounded row.

    Under semi-implicit Euler it is 2 zeta (sqrt(zeta^2 + 1) - zeta). At zeta = 1 that is 0.828; RK4 has 2.785 there and
    DOP853 6.39.
    """
    return stable_timestep(integrator, spring(1.0, dampratio, 1.0))


def stable_slip(integrator: str) -> float:
    """Return the largest h/timeconst with a bounded friction row, which has a damping and no stiffness.

    It is 1 under semi-implicit Euler, and half of the stability limit on the negative real axis under a Runge-Kutta
    method, 1.393 for RK4, for an impedance d of 1; for a row that `impratio` makes much harder it is d times as much.
    """
    if integrator == "discrete":
        return math.inf
    if integrator not in RUNGE_KUTTA:
        return 1.0
    coefficients = polynomial(integrator)[::-1]
    return first(lambda rate: abs(float(np.polyval(coefficients, -rate))) - 1, 0.1, 50.0) / 2
