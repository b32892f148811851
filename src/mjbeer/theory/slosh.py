"""Slosh: how a liquid with a free surface swings in a lying can, in the exact linear theory.

The liquid has no viscosity, but for its damping, and its surface tilts by small angles. In a
cross-section, x is level, y points upwards, and the surface reaches from x = -c to x = c. The can
has the radius a and the length l, the liquid the density rho and the mass m; b is the distance of
its centre of mass from the axis. The modes in which the surface is even in x move no mass sideways,
and are left out.

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

**Damping.** A little viscosity leaves the modes as they are, and takes energy from them. Let a be
1, and let the slowest mode have the elevation v sin(omega t), with the unit eigenvector v. By the
equations above, liquid and axis then have the velocities omega grad phi cos(omega t) and
omega U cos(omega t) with

    phi = N^-1 v,    U = -k (e_0 . v)/sqrt(2 c^3/3).

The can rolls, so that in the frame of the axis its wall turns backwards at the bottom, with -U. At
an angle theta from the bottom, liquid slips along the wall by d phi/d theta + U, and along the ends
by grad phi + U (-y, x). Their squares, summed up over the wall of the cross-section and over the
area of one end, are

    W = integral of (d phi/d theta)^2 d theta + 4 U phi(c) + 2 beta U^2,
    E = L_1 + k s (1 - 2 (L_1 + k) + k I/b),

where s is the mode's share of the energy and I = I_axis/m that of ice. E follows from Gauss's
theorem, since (-y, x) has no flux through the wall, and the flux x through the surface. Stokes's
layers, which are thin against a, take energy in proportion to W and E. They also lower the
frequency, by the share zeta_layers of itself:

    zeta_layers = sqrt(nu/(8 omega)) (W + 2 (a/l) E)/(a L_1).

The flow between the layers strains the liquid: by its viscosity this takes energy in proportion to
B, the integral of phi_xx^2 + phi_xy^2 over the cross-section. With Gauss's theorem and the velocity
of the surface, psi = (phi + U x)/L_1,

    2 B = 2/L_1 integral of (phi_x^2 + U phi_x) dx - 2 psi(c)^2 cot(beta)
          - integral of (d phi/d theta)^2 d theta,
    zeta_bulk = 2 nu B/(omega a^2 L_1).

For waves on deep water L_1 B is 1. Where the can rolls with the liquid, as it does if it is half
full, the layers are weak and the bulk is not: in olive oil it takes more than they do. What the
layers change in the bulk is left out. It is of the same order in the viscosity, and at most 5 % of
zeta_bulk in a can without mass that is at least 0.35 full. A film on the surface, which may be as
stiff as a wall, is left out as well.

The integrals are taken along the strip. On the surface dx/d tau is c/(1 + cosh(tau)), and on the
wall d theta/d tau is c/(cosh(tau) + cos(beta)), while the transform of d phi/d tau there is that of
the surface divided by cosh(kappa beta).

In the code, every length is divided by a and every mass by m, unless a unit is given.

References:
  D. V. Evans and C. M. Linton, "Sloshing frequencies", Q. J. Mech. Appl. Math. 46, 71 (1993): the
    modes of a half-full can.
  P. McIver, "Sloshing frequencies for cylindrical and spherical containers filled to an arbitrary
    depth", J. Fluid Mech. 201, 243 (1989): the same map, at any fill.
  B. Budiansky, "Sloshing of liquids in circular canals and spherical tanks", J. Aerosp. Sci. 27,
    161 (1960): canals at any fill, and the forces on them.
  K. M. Case and W. C. Parkinson, "Damping of surface waves in an incompressible liquid", J. Fluid
    Mech. 2, 172 (1957): the layers on walls.
  O. M. Faltinsen and A. N. Timokha, "Sloshing", Cambridge University Press, 2009.
"""

import functools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.segment import segment

FILLS = (0.01, 0.99)
"""The lowest and the highest fill.

There the liquid, or the air, ends at the wall in a wedge of 0.2 rad, and linear theory is for tilts
that are small against this angle."""
LARGEST_TILT = 0.2
"""Largest tilt of the surface against its rest [rad] for which linear theory is quantitative.

A wave on deep water with such a slope is 2 % faster than a low one (Stokes, 1847)."""
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
_TAU_STEP = 1 / 4
"""Distance between the tau of the sums for the damping."""
_FARTHEST_TAU = 40.0
"""Largest tau of these sums: beyond it the integrands, which go as exp(-tau), are below 1e-17."""


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

    vectors: np.ndarray
    """The unit eigenvectors, a column for each mode, in the basis e_0, e_1, ... up to signs."""

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
    fill: float
    """Depth divided by the diameter."""
    slowest: np.ndarray
    """The unit eigenvector of the slowest mode, by the modes of a can that is held.

    Its component of e_0 is not negative."""

    @property
    def axis_inertia(self) -> float:
        """Return I_axis of the rigid load that swings as fast as the slowest mode [m a^2]."""
        return self.offset * (float(self.lengths[0]) + self.arm)

    def damping_ratios(
        self,
        radius: float,
        length: float,
        gravity: float,
        viscosity: float,
    ) -> "DampingRatios":
        """Return the damping of the slowest mode, divided by the critical one.

        The can has the `radius` and `length` [m], `gravity` is that of `frequencies`, and the
        kinematic `viscosity` is in [m^2/s]. The layers must be thin.

        Raises:
          ParameterError: as `frequencies`.
        """
        omega = float(self.frequencies(radius, gravity)[0])
        losses = self._losses
        slips = losses.wall + 2 * radius / length * losses.end
        slowest_length = radius * float(self.lengths[0])
        bulk = 2 * viscosity / (omega * radius * slowest_length) * losses.bulk
        return DampingRatios(
            layers=math.sqrt(viscosity / (8 * omega)) / slowest_length * slips,
            bulk=bulk,
        )

    @functools.cached_property
    def _losses(self) -> "_Losses":
        """Return the integrals by which the slowest mode loses energy."""
        modes = _held(self.fill)
        shape = segment(self.fill)
        beta = shape.half_angle
        half_chord = math.sin(beta)
        kappa, transforms = _transforms()
        length = float(self.lengths[0])
        flat = math.sqrt(float(self.energy_shares[0]))
        U = -self.arm * flat / math.sqrt(2 * half_chord**3 / 3)

        # d phi/d tau on the surface and on the wall.
        phi = modes.vectors @ (modes.lengths * self.slowest)
        density = STEP / math.pi * (phi @ transforms) / math.sqrt(half_chord)
        tau, waves = _waves()
        at_surface = waves @ density
        at_wall = waves @ (density / np.cosh(kappa * beta))
        stretch = np.cosh(tau) + math.cos(beta)
        wall_square = 2 * _TAU_STEP * (at_wall**2 @ stretch) / half_chord
        surface_square = 2 * _TAU_STEP * (at_surface**2 @ (1 + np.cosh(tau))) / half_chord
        corner = _TAU_STEP * at_surface.sum()  # phi(c)

        rise = (corner + U * half_chord) / length
        of_surface = 2 / length * (surface_square + 2 * U * corner)
        of_surface -= 2 * rise**2 / math.tan(beta)
        ice = (shape.inertia + shape.offset**2) / shape.offset
        turning = 1 - 2 * (length + self.arm) + self.arm * ice
        return _Losses(
            wall=float(wall_square + 4 * U * corner + 2 * beta * U**2),
            end=float(length + self.arm * flat**2 * turning),
            bulk=float(of_surface - wall_square) / 2,
        )


class DampingRatios(NamedTuple):
    """What damps a mode, each part divided by the critical damping; the parts add up."""

    layers: float
    """By Stokes's layers on the wall and the ends.

    They lower the frequency by the same share of itself."""
    bulk: float
    """By the flow between the layers."""


class _Losses(NamedTuple):
    """Integrals over the flow of the slowest mode: W, E and B above."""

    wall: float
    end: float
    bulk: float


def held(fill: float) -> HeldModes:
    """Return the modes of a liquid in a can that is held.

    `fill` is the depth divided by the diameter.

    Raises:
      ParameterError: if the fill is not within `FILLS`.
    """
    return _held(_require_fill(fill))


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
    return _rolling(_require_fill(fill), ratio)


def _require_fill(fill: float) -> float:
    """Return a fill with which a liquid sloshes."""
    fill = require.number("fill", fill)
    lowest, highest = FILLS
    if not lowest <= fill <= highest:
        allowed = f"fill of a liquid that sloshes must be between {lowest:g} and {highest:g}"
        raise ParameterError(f"{allowed}: a full can has no free surface, got {fill!r}")
    return fill


@functools.lru_cache(maxsize=1024)
def _rolling(fill: float, mass_ratio: float) -> RollingModes:
    modes = _held(fill)
    arm = modes.offset / mass_ratio
    # In the basis of the eigenvectors of the can that is held.
    flat = np.sqrt(modes.energy_shares)
    # The eigenvalues increase; the slowest mode has the largest.
    lengths, vectors = np.linalg.eigh(np.diag(modes.lengths) - arm * np.outer(flat, flat))
    flatness = flat @ vectors
    slowest = vectors[:, -1] * math.copysign(1.0, flatness[-1])
    return RollingModes(
        modes.offset,
        lengths=_constant(lengths[::-1]),
        energy_shares=_constant(flatness[::-1] ** 2),
        arm=arm,
        fill=fill,
        slowest=_constant(slowest),
    )


@functools.lru_cache(maxsize=1024)
def _held(fill: float) -> HeldModes:
    shape = segment(fill)
    half_chord = math.sin(shape.half_angle)
    kappa, transforms = _transforms()
    weights = STEP / math.pi * np.tanh(kappa * shape.half_angle) / kappa
    # Polynomials of x/c that are orthonormal by x/c are so by x once divided by sqrt(c).
    weighted = transforms * np.sqrt(weights / half_chord)
    inverse_lengths, vectors = np.linalg.eigh(weighted @ weighted.T)
    # The signs are free, and here such that no mode has a negative component of e_0.
    vectors = np.where(vectors[0] < 0, -vectors, vectors)
    return HeldModes(
        shape.offset,
        lengths=_constant(1 / inverse_lengths),
        energy_shares=_constant(vectors[0] ** 2),
        vectors=_constant(vectors),
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


@functools.cache
def _waves() -> tuple[np.ndarray, np.ndarray]:
    """Return the tau of the sums for the damping, shape (taus,), and cos(kappa tau) there."""
    tau = (np.arange(round(_FARTHEST_TAU / _TAU_STEP)) + 0.5) * _TAU_STEP
    kappa, _ = _transforms()
    return _constant(tau), _constant(np.cos(np.outer(tau, kappa)))


def _constant(array: np.ndarray) -> np.ndarray:
    """Return an array that nobody can write to, since many calls share it."""
    array.setflags(write=False)
    return array
