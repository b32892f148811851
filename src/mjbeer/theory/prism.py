"""A wheel with facets: a rigid prism that rolls down an incline on its edges.

Many engines roll a mesh where a cylinder was asked for. A prism is slower than a cylinder, however
many facets it has and however small the timestep, because each edge that lands is an impact.

**On an edge** the prism swings like an inverted pendulum. Its centre of mass is c from the edge,
and its energy is kept.

**An edge that lands** stays where it lands: the impact is plastic, and friction holds. Only the
impulse at the edge acts, so that the angular momentum about it is kept,

    (I + m c^2) omega' = I omega + m (c_z v_x - c_x v_z).

A prism that swings from one edge to the next one has v = omega x c_old, and its rate becomes
(I + m c c_old)/(I + m c^2) times what it was. For n facets about an axis through the centre of
mass, this is 1 - (1 - cos(2 pi/n)) m a^2/(I + m a^2). There are n impacts in a turn, and each
takes 1/n^2: what a turn costs goes as 1/n.

**In flight.** An edge that were let go would itself turn about the centre of mass. If the weight is
too small to bring it back, c omega^2 cos(psi) > g cos(alpha) at an angle psi to the upright,
roughly above 17 rad/s for a drinks can, the prism leaves the incline, and flies until some edge
lands. It then loses less than a prism that keeps its edges on the ground. (Shortly before, an edge
may slip, as little presses it down. This is left out.)

A prism that lies on a facet is not treated, nor one that falls back.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.theory.scene import Scene

_STAGES, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_STAGES = (_STAGES + 1) / 2
_WEIGHTS = _WEIGHTS / 2
"""Gauss's quadrature from 0 to 1: of a swing over one facet, rounding is all that is left."""
_SAMPLES = 64
"""Samples of a swing, and of a flight over one facet, between which a change of sign is sought.

What dips into the incline between two of them does so by less than 1/64^2 of a facet's height."""
_ALL = slice(None)
_TOUCHES = 1e-12
"""Depth that counts as an edge that lands, divided by the radius: rounding is 1e-16."""


class PrismMotion(NamedTuple):
    """A motion at its impacts and lift-offs, at the start and at the end."""

    time: np.ndarray
    """[s]"""
    phi: np.ndarray
    """[rad]"""
    u: np.ndarray
    """Position of the axis along the incline [m]."""
    impacts: int
    """Number of edges that landed."""
    flights: int
    """Number of times that the prism left the incline."""
    steep: int
    """Number of impacts that would need a coefficient of friction of more than 1."""


def regular(facets: int) -> np.ndarray:
    """Return the angles of the edges of a regular prism [rad]; one points down."""
    count = require.within("facets", facets, 3, 10_000)
    if count != round(count):
        raise ParameterError(f"facets must be a whole number, got {facets!r}")
    return np.arange(round(count)) * math.tau / round(count)


def roll(
    scene: Scene,
    edges: Sequence[float] | np.ndarray,
    duration: float,
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    flies: bool = True,
) -> PrismMotion:
    """Return how a frozen can that is a prism rolls downhill for a `duration` [s].

    `edges` are the angles of its edges from the direction of the load's offset, towards +x [rad].
    All are as far from the axis as the can's radius. It starts on its lowest edge, with u = a phi.
    Unless it `flies`, an edge holds the prism to the incline until the next one lands.

    Raises:
      UnsupportedError: if the load is not frozen, or the prism does not roll on but falls back.
      ParameterError: if an argument makes no sense.
    """
    if scene.attachment != "frozen":
        raise UnsupportedError(f"only a frozen load rolls here, got {scene.attachment!r}")
    angles = np.sort(require.samples("edges", edges, "rad") % math.tau)
    if len(angles) < 3 or np.ptp(np.diff(angles, append=angles[0] + math.tau)) > math.pi:
        raise ParameterError(f"edges must surround the axis, got {len(angles)} of them")
    duration = require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    rolling = _Rolling(scene, angles, phi0, phi_dot0, flies)
    while rolling.time < duration:
        if rolling.on_edge:
            rolling.swing(duration)
        else:
            rolling.fly(duration)
    time, phi, u = np.array(rolling.track).T
    return PrismMotion(time, phi, u, rolling.impacts, rolling.flights, rolling.steep)


class _Rolling:
    """A prism on its way: positions and velocities are those of its centre of mass."""

    def __init__(
        self, scene: Scene, angles: np.ndarray, phi: float, omega: float, flies: bool
    ) -> None:
        self.mass = scene.mass
        self.gravity = scene.gravity
        self.incline = scene.incline
        self.radius = scene.can.radius
        self.flies = flies
        self.offset = scene.load.moment / self.mass
        axis_inertia = scene.load.axis_inertia + scene.can.inertia
        self.inertia = axis_inertia - self.mass * self.offset**2

        x = self.radius * np.sin(angles)
        z = self.offset - self.radius * np.cos(angles)
        self.reach = np.hypot(x, z)
        """Distance of each edge from the centre of mass [m]."""
        self.bearing = np.unwrap(np.arctan2(x, -z))
        """Angle of each edge from the downward direction, seen from the centre of mass [rad]."""
        slope = np.arctan2(np.roll(z, -1) - z, np.roll(x, -1) - x)
        self.lands_at = np.unwrap(slope)
        """phi at which the facet behind each edge lies on the incline [rad]."""

        self.time = 0.0
        self.phi = phi
        self.omega = omega
        self.edge = int(np.argmax(self.reach * np.cos(self.bearing - phi)))
        self.edge_x = 0.0
        self.edge_x = self.radius * phi - self._axis_x(phi)
        self.on_edge = True
        self.position = np.zeros(2)
        self.velocity = np.zeros(2)
        self.impacts = 0
        self.flights = 0
        self.steep = 0
        self.track: list[tuple[float, float, float]] = []
        self._note(self.radius * phi)

    def swing(self, duration: float) -> None:
        """Swing on the edge until the next edge lands, the prism lifts off, or time is up."""
        start = self.phi
        turn = (self.lands_at[self.edge] - start + math.pi) % math.tau - math.pi
        end = start + max(turn, 0.0)
        lands = True
        angles = np.linspace(start, end, _SAMPLES)
        self._require_progress(angles)
        if self.flies:
            rises = np.flatnonzero(self._return(angles) < 0)
            if len(rises) and rises[0] == 0:
                self._lift_off()
                return
            if len(rises):
                before, after = angles[rises[0] - 1], angles[rises[0]]
                end = float(brentq(self._return, before, after, xtol=1e-14))
                lands = False
        since = self._swing_time(end)
        if self.time + since >= duration:
            left = duration - self.time
            end = float(brentq(lambda phi: self._swing_time(phi) - left, start, end, xtol=1e-14))
            self._move_on_edge(end)
            self.time = duration
            self._note(self._axis_x(end))
            return
        self._move_on_edge(end)
        self.time += since
        if lands:
            old_x = self._edge_place(self.edge, end)[0]
            self._leave_edge()
            self.edge = (self.edge + 1) % len(self.reach)
            self.edge_x += self._edge_place(self.edge, end)[0] - old_x
            self._land()
        else:
            self._lift_off()

    def fly(self, duration: float) -> None:
        """Fly until an edge lands, or time is up."""
        spell = math.tau / len(self.reach) / self.omega
        began = 0.0
        while True:
            times = began + np.linspace(0, spell, _SAMPLES + 1)
            heights = self._heights(times)
            below = np.flatnonzero(heights.min(axis=0) < -_TOUCHES * self.radius)
            if len(below) or self.time + began > duration:
                break
            began += spell
        landing = math.inf
        edge = self.edge
        if len(below):
            after = int(below[0])
            edge = int(np.argmin(heights[:, after]))
            landing = self._touch(edge, times[max(after - 1, 0)], times[after])
        since = min(landing, duration - self.time)
        fall = np.array([math.sin(self.incline), -math.cos(self.incline)]) * self.gravity
        self.position = self.position + self.velocity * since + fall * since**2 / 2
        self.velocity = self.velocity + fall * since
        self.phi += self.omega * since
        if landing > duration - self.time:
            self.time = duration
            self._note(self.position[0] + self.offset * math.sin(self.phi))
            return
        self.time += since
        self.edge = edge
        self.edge_x = self.position[0] + self._edge_place(edge, self.phi)[0]
        self.on_edge = True
        self._land()

    def _land(self) -> None:
        """Keep the angular momentum about the edge that lands, and nothing else."""
        x, z = -self._edge_place(self.edge, self.phi)
        momentum = z * self.velocity[0] - x * self.velocity[1]
        about_edge = self.inertia + self.mass * (x**2 + z**2)
        self.omega = (self.inertia * self.omega + self.mass * momentum) / about_edge
        if self.omega <= 0:
            raise self._falls_back()
        impulse = self.omega * np.array([z, -x]) - self.velocity
        self.impacts += 1
        self.steep += bool(abs(impulse[0]) > impulse[1])
        self._note(self._axis_x(self.phi))

    def _leave_edge(self) -> None:
        """Give the centre of mass the velocity that it has on its edge."""
        x, z = -self._edge_place(self.edge, self.phi)
        self.position = np.array([self.edge_x + x, z])
        self.velocity = self.omega * np.array([z, -x])

    def _lift_off(self) -> None:
        """Let go of the edge."""
        self._leave_edge()
        self.on_edge = False
        self.flights += 1
        self._note(self._axis_x(self.phi))

    def _move_on_edge(self, phi: float) -> None:
        """Swing to `phi`."""
        self.omega = float(np.sqrt(self._square_rate(phi)))
        self.phi = phi

    def _edge_place(self, edge: int, phi: float) -> np.ndarray:
        """Return where an edge is, seen from the centre of mass [m]."""
        angle = self.bearing[edge] - phi
        return self.reach[edge] * np.array([math.sin(angle), -math.cos(angle)])

    def _axis_x(self, phi: float) -> float:
        """Return where the axis is while the prism swings on its edge [m]."""
        centre = self.edge_x - self._edge_place(self.edge, phi)[0]
        return centre + self.offset * math.sin(phi)

    def _square_rate(self, phi: np.ndarray | float) -> np.ndarray:
        """Return omega^2 while the prism swings on its edge: its energy is kept."""
        reach = self.reach[self.edge]
        bearing = self.bearing[self.edge] - self.incline
        dropped = reach * (np.cos(bearing - self.phi) - np.cos(bearing - phi))
        about_edge = self.inertia + self.mass * reach**2
        return self.omega**2 + 2 * self.mass * self.gravity * dropped / about_edge

    def _return(self, phi: np.ndarray | float) -> np.ndarray:
        """Return the acceleration into the incline that the edge would have if let go [m/s^2]."""
        upward = self.reach[self.edge] * np.cos(self.bearing[self.edge] - phi)
        return self.gravity * math.cos(self.incline) - upward * self._square_rate(phi)

    def _swing_time(self, phi: float) -> float:
        """Return the time in which the prism swings to `phi` [s].

        With phi = start + way x^2 the integrand has no pole at rest.
        """
        way = phi - self.phi
        rates = np.sqrt(self._square_rate(self.phi + way * _STAGES**2))
        return float(np.sum(_WEIGHTS * 2 * _STAGES * way / np.where(rates > 0, rates, np.inf)))

    def _heights(self, since: np.ndarray, edges: slice | list[int] = _ALL) -> np.ndarray:
        """Return how high edges fly at times `since` the lift-off [m], shape (edges, times)."""
        fall = self.gravity * math.cos(self.incline) * since**2 / 2
        centre = self.position[1] + self.velocity[1] * since - fall
        angles = self.bearing[edges, None] - self.phi - self.omega * since
        return centre - self.reach[edges, None] * np.cos(angles)

    def _touch(self, edge: int, before: float, after: float) -> float:
        """Return the time since the lift-off at which an edge touches the incline [s]."""

        def height(since: float) -> float:
            return self._heights(np.array([since]), [edge]).item()

        if height(before) <= 0:  # It has just left, and comes down at once.
            return after
        return float(brentq(height, before, after, xtol=1e-15))

    def _require_progress(self, angles: np.ndarray) -> None:
        """Refuse a prism that does not reach the next edge."""
        if np.any(self._square_rate(angles[1:]) <= 0):
            raise self._falls_back()

    def _falls_back(self) -> UnsupportedError:
        return UnsupportedError(
            f"the prism falls back at phi = {self.phi:.4g} rad: only one that rolls on is computed"
        )

    def _note(self, u: float) -> None:
        self.track.append((self.time, self.phi, u))
