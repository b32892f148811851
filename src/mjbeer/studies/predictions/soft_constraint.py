"""The linear theory of MuJoCo's soft constraints: what their numbers, solref and solimp, do in a step.

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

from dataclasses import dataclass

MAX_IMPEDANCE = 0.9999
"""Impedance of the hardest row that MuJoCo accepts, mjMAXIMP."""


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
