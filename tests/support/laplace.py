"""The slosh of a standing can by polynomials: Laplace's equation in the liquid's volume, pressures
on its walls.

The potential is a sum of r P(r^2) Q(z) cos(angle) with polynomials P and Q, which knows no Bessel
function and no hyperbolic one. Ritz's method makes K the integral of grad . grad over the volume,
and S that of the product over the surface, over g: K a = omega^2 S a for the modes, and (K -
omega^2 S) a = b in a shaken can, where b is the integral of the potential times the wall's normal
velocity. So b is also the pressure's share of force and moment.
"""

import math

import numpy as np
from scipy import linalg
from scipy.special import eval_jacobi, roots_legendre

RADIAL = 13
VERTICAL = 22
"""Numbers of polynomials across and along the can: with two more of each nothing changes by
1e-11."""


class Volume:
    """A liquid of radius 1, `depth` and density 1, under gravity 1; z is above its centroid."""

    def __init__(self, depth: float) -> None:
        nodes, weights = roots_legendre(40)
        self.r = (nodes + 1) / 2
        self.wr = weights / 2
        self.z = depth / 2 * nodes
        self.wz = depth / 2 * weights
        self.top = np.array([depth / 2])

        def across(r: np.ndarray) -> np.ndarray:
            return np.stack([r * eval_jacobi(k, 0, 1, 2 * r**2 - 1) for k in range(RADIAL)])

        def slope(
            r: np.ndarray,
        ) -> np.ndarray:  # the derivative of Jacobi's polynomial is one as well
            inner = [
                (k + 2) / 2 * eval_jacobi(k - 1, 1, 2, 2 * r**2 - 1) if k else 0 * r
                for k in range(RADIAL)
            ]
            return np.stack(
                [eval_jacobi(k, 0, 1, 2 * r**2 - 1) + 4 * r**2 * inner[k] for k in range(RADIAL)]
            )

        legendre = [
            np.polynomial.Legendre.basis(j, [-depth / 2, depth / 2]) for j in range(VERTICAL)
        ]

        def along(z: np.ndarray) -> np.ndarray:
            return np.stack([polynomial(z) for polynomial in legendre])

        def rise(z: np.ndarray) -> np.ndarray:
            return np.stack([polynomial.deriv()(z) for polynomial in legendre])

        self.across = across
        self.slope = slope
        self.along = along
        self.rise = rise
        r = self.r
        z = self.z
        ring = self.wr * r

        def product(values: np.ndarray, weight: np.ndarray) -> np.ndarray:
            return values * weight @ values.T

        radial = product(slope(r), ring) + product(across(r) / r, ring)
        volume = np.kron(radial, product(along(z), self.wz)) + np.kron(
            product(across(r), ring), product(rise(z), self.wz)
        )
        self.stiffness = math.pi * volume
        upper = along(self.top)[:, 0]
        self.surface = math.pi * np.kron(product(across(r), ring), np.outer(upper, upper))
        wall = across(np.ones(1))[:, 0]
        lower = along(-self.top)[:, 0]
        self.sideways = math.pi * np.kron(wall, along(z) @ self.wz)
        # On the bottom the normal velocity is x, on a lid -x.
        tilted = math.pi * across(r) @ (ring * r)
        self.tilting = math.pi * np.kron(wall, along(z) @ (self.wz * z)) + np.kron(tilted, lower)
        self.lid = -np.kron(tilted, upper)
        self.metacentre = math.pi / 4

    def modes(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, shape (count,), and potentials in columns, with a^T S a = 1; sideways forces
        are positive."""
        # 1/omega^2 is largest for the slowest, and 0 for what does not reach the surface.
        values, vectors = linalg.eigh(self.surface, self.stiffness)
        omega = values[::-1][:count] ** -0.5
        vectors = vectors[:, ::-1][:, :count]
        return omega, vectors * omega * np.sign(self.sideways @ vectors)

    def slosh(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Frequencies, masses and bobs' heights, from the poles of force and moment: rho (b . a)^2
        = m_n omega_n^2."""
        omega, vectors = self.modes(count)
        force = self.sideways @ vectors
        moment = self.tilting @ vectors
        return omega, (force / omega) ** 2, moment / force - omega**-2

    def reaction(self, omega: float) -> tuple[float, float, float]:
        """Force, coupling and moment per acceleration; the last with the weight of the tilted
        liquid."""
        both = np.stack([self.sideways, self.tilting], axis=1)
        response = both.T @ linalg.solve(self.stiffness - omega**2 * self.surface, both)
        return response[0, 0], response[0, 1], response[1, 1] + self.metacentre / omega**2

    def held_inertia(self) -> float:
        """Moment of inertia under a lid."""
        walls = self.tilting + self.lid
        return float(walls @ linalg.solve(self.stiffness, walls))

    def damping(self, count: int) -> np.ndarray:
        """Damping ratios over sqrt(nu): the layers' dissipation over twice omega times the energy
        of the mode."""
        omega, vectors = self.modes(count)
        z = self.z
        r = self.r
        ratios = []
        for frequency, vector in zip(omega, vectors.T, strict=True):
            shape = vector.reshape(RADIAL, VERTICAL)
            wall = shape.T @ self.across(np.ones(1))[:, 0]
            bottom = shape @ self.along(-self.top)[:, 0]
            on_wall = (self.rise(z).T @ wall) ** 2 + (self.along(z).T @ wall) ** 2
            on_bottom = (self.slope(r).T @ bottom) ** 2 + (self.across(r).T @ bottom / r) ** 2
            squares = math.pi * (on_wall @ self.wz + on_bottom @ (self.wr * r))
            ratios.append(squares / (vector @ self.stiffness @ vector) / math.sqrt(8 * frequency))
        return np.array(ratios)
