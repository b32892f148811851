"""Slosh: how a liquid with a free surface swings in a lying can, in the exact linear theory.

The liquid has no viscosity, and its surface tilts by small angles. In a cross-section, x is level,
y points upwards, and the surface reaches from x = -c to x = c. The can has the radius a and the
length l, the liquid the density rho and the mass m; b is the distance of its centre of mass from
the axis. The modes in which the surface is even in x move no mass sideways, and are left out.

**The surface.** The wall is a circle, so that the pressure on any part of it acts along a line
through the axis. It does not matter how the can turns, only how far its axis has moved: by u. In
the frame that moves with the axis and does not turn, the liquid has the velocity potential phi, and
its surface rises by eta. On the surface, with subscripts t for derivatives by time,

    eta_t = N phi,    phi_t = -g eta - u_tt x.

The first equation says that the surface moves with the liquid, whose velocity is d phi/dy upwards.
No liquid passes the wall, so that the values of phi on the surface determine phi everywhere; the
operator N turns them into d phi/dy on the surface. The second equation is Bernoulli's where the
pressure is 0, in a frame that accelerates.

**The axis.** The mass of the liquid times the position of its centre of mass along the ground is
m u + rho l integral(x eta). The pressures have no moment about the axis, so that a can that rolls
on level ground resists as if it had the mass m_can + I_can/a^2. With M_e = m + m_can + I_can/a^2 of
eq. (46), and with no weight along the ground,

    M_e u_tt = -rho l integral(x eta_tt).

**Both together.** Let e_0, e_1, ... be the odd polynomials of x that are orthonormal on the
surface, and let eta now be the vector of the coefficients of the elevation. The integral of x^2
over the surface is 2 c^3/3, so that x = sqrt(2 c^3/3) e_0: a flat surface that is tilted is e_0
alone. By eq. (35), 2 c^3/3 is also b times the area of the cross-section, m b/(rho l). Without u
and phi the equations then are

    (N^-1 - k e_0 e_0^T) eta_tt = -g eta,    k = m b/M_e.

The eigenvalues of the matrix in brackets are L_n = g/omega_n^2: the lengths of the simple pendulums
that swing as fast as the modes. In a can that is held, k = 0. The energy of a surface at rest is
proportional to the square of the vector eta. So if a flat tilt is let go, the mode with the unit
eigenvector v has the share (e_0 . v)^2 of the energy.

**Pendulums.** Let v_n be the eigenvectors of a can that is held, and L_n its lengths. On a can
whose axis moves along the ground in any way, the liquid acts like pendulums on the axis, one for
each n, with the lengths L_n and the masses m_n = m b (e_0 . v_n)^2/L_n, and like a mass on the axis
that does not turn, which is the rest of m. The shares add up to 1, and so the m_n L_n add up to
m b: a liquid that tilts has its centre of mass where the rigid load has it.

**The equivalent load.** A rigid load with the same m and b, which slides in the can without
friction, swings like a simple pendulum of length I_axis/(m b) - k, eq. (10). If it is to swing as
fast as the slowest mode of the rolling can, with the length L_1, its moment of inertia about the
axis must be

    I_axis = m b (L_1 + k).

**The operator N.** Let beta be half of the angle that the surface subtends at the axis, and let y
be 0 on the surface. Then x + i y = c tanh((tau + i sigma)/2) maps the liquid to the endless strip
between the surface, sigma = 0, and the wall, sigma = -beta. There

    sin(kappa tau) cosh(kappa (sigma + beta))/cosh(kappa beta)

is a potential without flux through the wall. On the surface it is sin(kappa tau), and its
derivative by sigma is kappa tanh(kappa beta) times that. Odd functions on the surface are Fourier
integrals of such sines. With e_j as a function of tau this gives

    D_j(kappa) = integral of cos(kappa tau) (d e_j/d tau) d tau             over all tau,
    N_ij = (1/pi) integral of tanh(kappa beta)/kappa D_i D_j d kappa        from 0 to infinity.

With finitely many polynomials this is Ritz's method: the lengths grow towards the exact ones as
polynomials are added.

In the code, every length is divided by a and every mass by m, unless a unit is given.

References:
  D. V. Evans and C. M. Linton, "Sloshing frequencies", Q. J. Mech. Appl. Math. 46, 71 (1993): the
    modes of a half-full can.
  P. McIver, "Sloshing frequencies for cylindrical and spherical containers filled to an arbitrary
    depth", J. Fluid Mech. 201, 243 (1989): the same map, at any fill.
  B. Budiansky, "Sloshing of liquids in circular canals and spherical tanks", J. Aerosp. Sci. 27,
    161 (1960): canals at any fill, and the forces on them.
  O. M. Faltinsen and A. N. Timokha, "Sloshing", Cambridge University Press, 2009.
"""

import functools
import math
from dataclasses import dataclass

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.segment import segment

FILLS = (0.01, 0.99)
"""The lowest and the highest fill.

There the liquid, or the air, ends at the wall in a wedge of 0.2 rad, and linear theory is for tilts
that are small against this angle."""
POLYNOMIALS = 48
"""Number of polynomials, and of modes.

Up to a fill of a half, the lengths of the first ten modes have relative errors below 1e-12. In a
fuller can the corner of the liquid at the wall is obtuse, and the velocity there is not smooth: at
0.95 the first length errs by 3e-10 and the tenth by 1e-8, at 0.99 by 1.3e-9 and 3e-8."""
STEP = 1 / 12
"""Distance between the kappa of the sum that stands for the integral.

The integrand is even and smooth, and its nearest singularity is at least 1/2 off the real axis. So
a sum without end errs by exp(-pi/STEP), which is 4e-17."""
HIGHEST = 70.0
"""Largest kappa of the sum: beyond it the integrand of so many polynomials is below 1e-22."""


@dataclass(frozen=True, eq=False)
class Modes:
    """The antisymmetric modes of a liquid, the slowest first; each array has a number per mode."""

    offset: float
    """Distance of the liquid's centre of mass from the axis [a], b of eq. (35)."""
    lengths: np.ndarray
    """Lengths L_n of the simple pendulums that swing as fast [a], shape (POLYNOMIALS,)."""
    energy_shares: np.ndarray
    """Shares that the modes have of the energy of a flat tilt, shape (POLYNOMIALS,).

    They add up to 1."""

    def frequencies(self, radius: float, gravity: float) -> np.ndarray:
        """Return the natural frequencies [rad/s], shape (POLYNOMIALS,).

        The can has the `radius` [m]; `gravity` [m/s^2] is that in the frame of the can, to which
        the surface at rest is normal.

        Raises:
          ParameterError: if one of them is outside the domain. Without gravity nothing sloshes.
        """
        radius = require.within("can radius", radius, *require.SIZE, "m")
        if require.number("gravity", gravity, "m/s^2") == 0:
            raise ParameterError("without gravity a liquid does not slosh, got a gravity of 0")
        gravity = require.within("gravity", gravity, *require.GRAVITY, "m/s^2")
        return np.sqrt(gravity / (radius * self.lengths))


@dataclass(frozen=True, eq=False)
class HeldModes(Modes):
    """The modes in a can that is held; they give the pendulums for any motion of the can."""

    @property
    def masses(self) -> np.ndarray:
        """Return the masses of the pendulums that stand for the modes [m], shape (POLYNOMIALS,)."""
        return self.offset * self.energy_shares / self.lengths


@dataclass(frozen=True, eq=False)
class RollingModes(Modes):
    """The modes in a can that rolls on level ground."""

    arm: float
    """k = m b/M_e [a]: how far the axis moves if a flat surface tilts by 1 rad; 0 if M_e is
    infinite."""

    @property
    def axis_inertia(self) -> float:
        """Return I_axis of the rigid load that swings as fast as the slowest mode [m a^2]."""
        return self.offset * (float(self.lengths[0]) + self.arm)


def held(fill: float) -> HeldModes:
    """Return the modes of a liquid in a can that is held.

    `fill` is the depth divided by the diameter.

    Raises:
      ParameterError: if the fill is not within `FILLS`.
    """
    fill = require.number("fill", fill)
    lowest, highest = FILLS
    if not lowest <= fill <= highest:
        allowed = f"fill of a liquid that sloshes must be between {lowest:g} and {highest:g}"
        raise ParameterError(f"{allowed}: a full can has no free surface, got {fill!r}")
    return _held(fill)


def rolling(fill: float, mass_ratio: float) -> RollingModes:
    """Return the modes of a liquid in a can that rolls on level ground.

    `fill` is the depth divided by the diameter. `mass_ratio` is M_e/m, the effective mass of can
    and liquid, m + m_can + I_can/a^2, divided by the mass of the liquid: 1 for a can without mass,
    and infinite for a can that is held. On an incline the liquid rests at an angle phi to the
    normal of the ground. Only the part of the axis's motion along the surface then drives it, and
    the ratio is M_e/(m cos^2 phi).

    Raises:
      ParameterError: if the fill is not within `FILLS`, or the ratio is less than 1.
    """
    ratio = require.non_negative("mass_ratio", mass_ratio, finite=False)
    if ratio < 1:
        got = require.format_value(mass_ratio)
        raise ParameterError(f"mass_ratio must be 1 or greater (infinity is allowed), got {got}")
    modes = held(fill)
    arm = modes.offset / ratio
    # In the basis of the eigenvectors of the can that is held. Their signs are free, and here such
    # that e_0 has no negative component.
    flat = np.sqrt(modes.energy_shares)
    lengths, vectors = np.linalg.eigh(np.diag(modes.lengths) - arm * np.outer(flat, flat))
    shares = (flat @ vectors) ** 2
    # The eigenvalues increase; the slowest mode has the largest.
    return RollingModes(
        modes.offset,
        lengths=_constant(lengths[::-1]),
        energy_shares=_constant(shares[::-1]),
        arm=arm,
    )


@functools.lru_cache(maxsize=1024)
def _held(fill: float) -> HeldModes:
    shape = segment(fill)
    half_chord = math.sin(shape.half_angle)
    kappa, transforms = _transforms()
    weights = STEP / math.pi * np.tanh(kappa * shape.half_angle) / kappa
    # Polynomials of x/c that are orthonormal by x/c are so by x once divided by sqrt(c).
    weights /= half_chord
    flux = (transforms * weights) @ transforms.T
    inverse_lengths, vectors = np.linalg.eigh(flux)
    return HeldModes(
        shape.offset,
        lengths=_constant(1 / inverse_lengths),
        energy_shares=_constant(vectors[0] ** 2),
    )


@functools.cache
def _transforms() -> tuple[np.ndarray, np.ndarray]:
    """Return the kappa, shape (kappas,), and the D_j there, shape (POLYNOMIALS, kappas).

    They are those of a half chord of 1. With Legendre's polynomials P, e_j is then
    (-1)^j sqrt((4 j + 3)/2) P_(2j+1)(x), where the signs are free. With s = tanh(tau/2) and

        F_l(kappa) = integral of exp(i kappa tau) dP_l(s)/d tau d tau

    F_0 is 0, F_1 is 2 pi kappa/sinh(pi kappa), and since dP_l/d tau = (1 - s^2)/2 dP_l/ds is
    l (l + 1)/(4 l + 2) (P_(l-1) - P_(l+1)), integration by parts gives

        F_(l+1) = F_(l-1) + 2 i kappa (2 l + 1)/(l (l + 1)) F_l.

    F_l is i^(l-1) H_l with a real H_l, and so D_j is sqrt((4 j + 3)/2) H_(2j+1).
    """
    # In the middle between multiples of the step: kappa = 0 needs no limit.
    kappa = (np.arange(round(HIGHEST / STEP)) + 0.5) * STEP
    before = np.zeros_like(kappa)
    now = 2 * math.pi * kappa / np.sinh(math.pi * kappa)
    transforms = []
    for degree in range(1, 2 * POLYNOMIALS):
        if degree % 2:
            transforms.append(math.sqrt(degree + 0.5) * now)
        factor = 2 * kappa * (2 * degree + 1) / (degree * (degree + 1))
        following = factor * now - before
        before = now
        now = following
    return _constant(kappa), _constant(np.array(transforms))


def _constant(array: np.ndarray) -> np.ndarray:
    """Return an array that nobody can write to, since many calls share it."""
    array.setflags(write=False)
    return array
