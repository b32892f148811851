"""The slosh of a lying can by harmonic functions, without conformal maps or Legendre's polynomials.

With W = y + i x, the imaginary parts of real polynomials of W are harmonic, and odd in x. In the
corners at the wall, the velocity is not smooth. Simple poles outside the liquid, ever closer to a
corner, make up for that (Gopal and Trefethen, SIAM J. Numer. Anal. 57, 2074, 2019). Ritz's method
takes the potential in the frame of the ground, and so needs no pendulums and no added mass. With
the velocity U of the can and any test function chi,

    integral of grad phi . grad chi over the liquid
        = omega^2/g (integral of phi chi over the surface) + U (integral of n_x chi over the wall),
    (m_can + I_can/a^2) U = -rho l (integral of n_x phi over the wall).

The radius, the density, the can's length and gravity are 1.
"""

from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import linalg
from scipy.special import roots_legendre

POLYNOMIALS = 40
POLES = 14
"""With ten more of either, the slowest mode changes by less than 2e-12, even at a fill of 0.99."""
PANELS = 14
NODES = 80
"""Number of Gauss's nodes on each panel of the boundary."""
FINER = 0.3
"""Length of a panel divided by that of the one before it, which is farther from the corner."""
RAYS = 16
"""Number of rays from the middle of the surface to a panel of the wall, and of nodes on a ray."""
APART = 1e-5
"""Distance of points whose slopes give the second derivatives."""


class Motion(NamedTuple):
    """The modes, the slowest first; every array has shape (modes,)."""

    squares: np.ndarray
    """omega^2 a/g."""
    masses: np.ndarray
    """Force on a held can, as the mass of a pendulum divided by that of the liquid."""
    energy_shares: np.ndarray
    """Shares that the modes have of the energy of a surface that is flat and tilted."""


class Losses(NamedTuple):
    """Integrals over the flow of the slowest mode; the square of its elevation has the integral 1.

    Velocities are divided by omega.
    """

    wall: float
    """Of the square of the slip along the wall."""
    end: float
    """Of the square of the slip along an end."""
    bulk: float
    """Of the squares of phi_xx and phi_xy."""


class Section:
    """Half of the cross-section of a liquid with a `fill`."""

    def __init__(self, fill: float) -> None:
        beta = np.arccos(1 - 2 * fill)
        half_chord = np.sin(beta)
        self.area = (beta - np.sin(beta) * np.cos(beta)) / 2
        distance, weights = _towards_a_corner()
        # From the bottom up the wall, and along the surface; the corner is at a distance of 0.
        wall = -np.exp(-1j * beta * (1 - distance))
        corner = -np.exp(-1j * beta)
        surface = corner - 1j * half_chord * distance
        points = np.concatenate([wall, surface])
        weights = np.concatenate([beta * weights, half_chord * weights])
        on_wall = len(wall)
        normal = np.concatenate([wall, np.ones(len(surface))])
        values, slopes = _harmonic(points, weights, corner)
        potential = values.imag
        flux = slopes.real * normal.imag + slopes.imag * normal.real
        # By einsum: OpenBLAS 0.3.34 may crash in long products (its issue 6021).
        stiffness = np.einsum("ip,jp", potential * weights, flux)
        sloping = (potential * weights)[:, on_wall:]
        self.corner = corner
        self.boundary = points
        self.weights = weights
        self.on_wall = on_wall
        # Coordinates in which the stiffness is 1.
        factor = linalg.cholesky((stiffness + stiffness.T) / 2, lower=True)
        surfaces = np.einsum("ip,jp", sloping, potential[:, on_wall:])
        half_way = linalg.solve_triangular(factor, surfaces, lower=True)
        self.factor = factor
        self.surface = linalg.solve_triangular(factor, half_way.T, lower=True)
        pressure = (potential * weights)[:, :on_wall] @ wall.imag
        self.pressure = linalg.solve_triangular(factor, pressure, lower=True)
        self.tilt = linalg.solve_triangular(factor, sloping @ surface.imag, lower=True)
        self.tilt_energy = half_chord**3 / 3

    def modes(self, can_ratio: float) -> Motion:
        """Modes in a can whose m_can + I_can/a^2 is `can_ratio` times the liquid's mass."""
        values, potentials = self._potentials(can_ratio)
        masses = (self.pressure @ potentials) ** 2 / self.area
        shares = (self.tilt @ potentials) ** 2 / (values * self.tilt_energy)
        return Motion(1 / values, masses, shares)

    def _potentials(self, can_ratio: float) -> tuple[np.ndarray, np.ndarray]:
        """The g/(omega^2 a) of the modes, and a column for the potential of each."""
        added = self.pressure @ self.pressure
        can = can_ratio * self.area
        # The stiffness is 1 + p p^T/can; this is the inverse of its root.
        share = 1.0 if np.isinf(can) else np.sqrt(can / (can + added))
        projector = np.outer(self.pressure, self.pressure) / added
        root = np.eye(len(projector)) - (1 - share) * projector
        values, vectors = np.linalg.eigh(root @ self.surface @ root)
        # What does not reach the surface has no frequency.
        moves = values > 1e-3 * values[-1]
        values = values[moves][::-1]
        potentials = root @ vectors[:, moves][:, ::-1]
        return values, potentials

    def losses(self, can_ratio: float) -> Losses:
        """What the slowest mode loses in a can as of `modes`, which must have mass.

        By nodes on the wall and all over the cross-section, in the frame of the ground.
        """
        _, potentials = self._potentials(can_ratio)
        slowest = potentials[:, 0]
        axis = -(self.pressure @ slowest) / (can_ratio * self.area)
        wall = self.boundary[: self.on_wall]
        along_wall = self.weights[: self.on_wall]
        inside, areas = self._inside
        slopes = self._slopes
        slope = linalg.solve_triangular(self.factor, slowest, lower=True, trans="T") @ slopes
        surface = slice(self.on_wall, len(self.boundary))
        within, above, below = np.split(slope[len(self.boundary) :], 3)
        curvature = (above - below) / (2 * APART)

        def slip(slope: np.ndarray, points: np.ndarray) -> np.ndarray:
            """Square of the velocity relative to a can that rolls, which rests at the bottom."""
            along = slope.real - axis * (1 + points.real)
            upwards = slope.imag + axis * points.imag
            return along**2 + upwards**2

        scale = self.weights[surface] @ slope[surface].imag ** 2
        return Losses(
            wall=along_wall @ slip(slope[: self.on_wall], wall) / scale,
            end=areas @ slip(within, inside) / scale,
            bulk=areas @ abs(curvature) ** 2 / scale,
        )

    @cached_property
    def _slopes(self) -> np.ndarray:
        """Slopes of the functions on the boundary, at the nodes inside, and `APART` from these."""
        inside, _ = self._inside
        points = np.concatenate([self.boundary, inside, inside + APART, inside - APART])
        weights = np.append(self.weights, np.zeros(3 * len(inside)))
        _, slopes = _harmonic(points, weights, self.corner)
        return slopes

    @cached_property
    def _inside(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes all over half of the cross-section, and their areas."""
        distance, weights = _towards_a_corner(RAYS)
        beta = abs(np.angle(-self.corner))
        wall = -np.exp(-1j * beta * (1 - distance))
        middle = self.corner.real
        rays = wall - middle
        across = (rays * wall.conj()).real * beta * weights
        nodes, shares = roots_legendre(RAYS)
        along = (nodes + 1) / 2
        areas = np.outer(shares / 2 * along, across)
        return (middle + np.outer(along, rays)).ravel(), areas.ravel()


def _towards_a_corner(count: int = NODES) -> tuple[np.ndarray, np.ndarray]:
    """Nodes between 0 and 1, finer towards 0, and their weights."""
    nodes, weights = roots_legendre(count)
    ends = np.append(FINER ** np.arange(PANELS), 0.0)
    middles = (ends[:-1] + ends[1:]) / 2
    halves = (ends[:-1] - ends[1:]) / 2
    distances = middles[:, None] + np.outer(halves, nodes)
    return distances.ravel(), np.outer(halves, weights).ravel()


def _harmonic(
    points: np.ndarray,
    weights: np.ndarray,
    corner: complex,
) -> tuple[np.ndarray, np.ndarray]:
    """Analytic functions, real where x = 0 and orthonormal on the boundary, and their slopes."""
    most = 1 + POLYNOMIALS + 2 * POLES
    values = np.zeros((most, len(points)), complex)
    slopes = np.zeros_like(values)
    values[0] = 1 / np.sqrt(weights.sum())
    count = 1

    def size(value: np.ndarray) -> float:
        return np.sqrt(np.sum(weights * np.abs(value) ** 2))

    def add(value: np.ndarray, slope: np.ndarray) -> None:
        nonlocal count
        whole = size(value)
        for _ in range(2):  # once leaves rounding
            parts = (values[:count].conj() @ (weights * value)).real
            value = value - parts @ values[:count]
            slope = slope - parts @ slopes[:count]
        rest = size(value)
        if rest < 1e-8 * whole:  # what is left of a pole that adds nothing is rounding
            return
        values[count] = value / rest
        slopes[count] = slope / rest
        count += 1

    for degree in range(POLYNOMIALS):
        add(points * values[degree], values[degree] + points * slopes[degree])
    along_wall = 1j * corner  # from the corner downwards: the wall is -exp(-i angle)
    inwards = -1j + along_wall
    root = np.sqrt(np.arange(1, POLES + 1))
    for distance in corner.imag * np.exp(-4 * (root[-1] - root)):
        pole = corner - distance * inwards / abs(inwards)
        right = distance / (points - pole)
        left = distance / (points - pole.conjugate())
        add(right + left, -(right**2 + left**2) / distance)
        add(1j * (right - left), -1j * (right**2 - left**2) / distance)
    return values[1:count], slopes[1:count]
