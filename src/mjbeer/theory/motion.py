"""phi(t) of one degree of freedom, exactly: a swing, or a motion that passes crests of V.

Two kinds of path are enough. An arc begins or ends at a turning point, phi = turn +- s^2; a turn leads past a crest:

    dt/ds = sqrt(2 J / |mean torque from the turning point on|),    dt/dx = sqrt(J / 2 (energy + below(x))),

both smooth and positive, with `energy` = E - V at the crest and x the distance past it. A swing is two arcs that meet
at the equilibrium. A load that passes crests goes up in turns until it cannot pass the next one, round in an arc, and
down in turns for ever. What goes the other way is watched in a mirror. A motion that rounding may change noticeably, as
beside a separatrix, is refused.

With psi = s or x, a path is cut into panels on which a Chebyshev series of fixed degree is dt/dpsi to rounding; they
are integrated exactly, and inverted by Newton's method. (L. N. Trefethen, Approximation Theory and Approximation
Practice, chapters 3 and 19.)
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, cycle

import numpy as np
from numpy.polynomial import chebyshev

from mjbeer.exceptions import NoLibrationError, ParameterError, ToleranceError
from mjbeer.theory.oscillator import Oscillator, Potential, root

EPS = 2.0**-52
ROUNDINGS = 4 * EPS  # of J, and of ramp over depth, relative: up to nine of half an eps each, never all of one sign
UNCERTAIN = 1e-4  # largest effect of rounding on phi [rad], relative beyond 1 rad: a hundredth of a trusted run's error
MOST_TURNS = 10_000  # of a motion on an incline, where each takes another time
_NODES = chebyshev.chebpts1(25)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, 24)).T
_TO_INTEGRAL = chebyshev.chebint(np.eye(25), lbnd=-1).T


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and phi_dot [rad/s] at the times `time` [s], none of them negative; the errors are `exact`'s."""
    start, latest = Start.at(oscillator, phi0, phi_dot0), float(np.max(time, initial=0.0))
    if start.stays(phi0):
        return np.full_like(time, phi0), np.zeros_like(time)
    try:
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):  # what is not finite becomes an error
            delta_phi, phi_dot, margin = start.move(time)
            fastest = float(np.max(np.abs(phi_dot) / np.maximum(1, np.abs(delta_phi)), initial=0.0))
            effect = start.rounding_delay(margin, latest) * fastest
    except NoLibrationError:  # exactly on the separatrix
        effect = math.inf
    if not effect <= UNCERTAIN:
        raise NoLibrationError(
            f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s is too near a separatrix, or the motion too long: "
            f"rounding may change phi by more than {UNCERTAIN:g} rad (relative beyond 1 rad) until {latest:g} s"
        )
    return phi0 + start.sign * delta_phi, start.sign * phi_dot


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of a swing of an `amplitude` [rad], with the errors of `Scene.period`."""
    rest = oscillator.equilibrium()
    low, high = (end - rest for end in oscillator.separatrix())
    if low < amplitude < high:
        start = Start.at(oscillator, rest + amplitude, 0.0)
        if start.still:
            return math.tau / oscillator.frequency()
        if start.energy_above_next_crest < 0:
            with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
                found = sum(arc.duration for arc, *_ in _arcs_of_swing(start))
                if start.rounding_delay(-start.energy_above_next_crest, found) <= UNCERTAIN * found:
                    return found
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is not inside the separatrix, or too near it for doubles: released from rest, "
        f"the load swings about its equilibrium only for amplitudes between {low:.6g} and {high:.6g} rad"
    )


@dataclass(frozen=True)
class Start:
    """The start of a motion, in angles that keep their digits beside the crest and beside the equilibrium."""

    oscillator: Oscillator
    potential: Potential
    sign: int  # -1 if the motion is watched in a mirror: phi, its rate and the ramp have the other sign here
    angle_past_crest: float  # of its turn [rad]
    angle_past_rest: float  # of its well [rad]
    phi_dot: float
    kinetic: float  # kinetic energy [J]

    @classmethod
    def at(cls, oscillator: Oscillator, phi: float, phi_dot: float) -> "Start":
        sign, potential = oscillator.sign, oscillator.potential
        if oscillator.ramp == 0 and phi_dot < 0:
            sign, potential = -1, Potential(0.0, oscillator.depth, -oscillator.bottom)
        # The kinetic energy is that at phi itself: where J has a narrow minimum, rounding of the angle would change it.
        kinetic = float(oscillator.kinetic_energy(phi, phi_dot))
        return cls(oscillator, potential, sign, *potential.distances(sign * phi), sign * phi_dot, kinetic)

    @cached_property
    def energy_above_crest(self) -> float:
        """Return E - V at the crest of the turn [J]."""
        return self.kinetic - float(self.potential.below(self.angle_past_crest))

    @cached_property
    def energy_above_next_crest(self) -> float:
        """Return E - V at the next crest downhill [J]."""
        if self.angle_past_crest < 0:
            return self.energy_above_crest
        past_next = self.angle_past_rest - self.potential.well
        if abs(past_next) <= self.angle_past_crest:
            return self.kinetic - float(self.potential.below(past_next))
        return self.energy_above_crest + self.potential.drop_per_turn

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a crest."""
        return self.potential.well > 0 and self.energy_above_next_crest <= 0

    @property
    def still(self) -> bool:
        """Return whether the motion is rest in the equilibrium, or a swing of less than any double would show."""
        width = math.sqrt(self.kinetic / self.potential.curvature) if self.swings else math.inf
        return max(abs(self.angle_past_rest), width) <= 1e-30

    def stays(self, phi: float) -> bool:
        """Return whether a start does not move, as far as doubles tell: at rest, on a barrier, or without any torque.

        The double of an odd multiple of pi is up to 0.64 eps off; that of a slope's top is up to an eps of pi off.
        """
        if self.kinetic > 0 or self.potential.excess > 0:
            return self.still
        on_top = abs(self.angle_past_crest) <= EPS * max(abs(phi), math.pi)
        return on_top or self.potential.depth == 0 or self.still

    def rounding_delay(self, margin: float, latest: float) -> float:
        """Return a rough bound on the time [s] by which rounding delays a motion until `latest` [s].

        The motion passes or misses a crest by the energy `margin` [J].
        """
        potential = self.potential
        if potential.depth == 0:
            return ROUNDINGS * latest
        if potential.curvature == 0:  # the torque at the crest is a difference of ramp and depth
            ratio = potential.balanced / potential.excess if potential.excess > 0 else math.inf
            return ROUNDINGS * ratio**2 * latest
        steep = potential.balanced / potential.curvature
        # Rounding of the scene puts the crest elsewhere. On level ground it is at an odd multiple of pi, and how far a
        # double is from that is known to an eps.
        shift = ROUNDINGS * (abs(potential.bottom) + potential.lean + steep) + EPS * abs(self.angle_past_crest)
        torque = abs(float(potential.mean_torque(self.angle_past_crest, 0.0)))
        rounding = ROUNDINGS * (self.kinetic + abs(float(potential.below(self.angle_past_crest))))
        rounding += torque * shift + potential.curvature * shift**2
        share = ROUNDINGS * steep**2 + (rounding / margin if margin > 0 else math.inf)
        # Each time that the motion passes or nears a crest, it is early or late by that share of 1/lambda.
        lingering = math.sqrt(float(self.oscillator.inertia(math.pi + potential.crest_past_pi)) / potential.curvature)
        return share * (lingering + latest)

    def move(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Return how far phi has turned [rad] and phi_dot [rad/s] at the times [s], and the `margin` [J].

        The margin is the least energy by which the motion passes or misses a crest.
        """
        swing = _arcs_of_swing(self) if self.swings else None
        legs = cycle(swing) if swing else _paths_over_crests(self)
        first = next(legs)
        begin = first[0].time(self)
        since, cycles = time + begin, 0
        if swing or self.potential.ramp == 0:  # all periods, or turns, are alike
            cycles, since = np.divmod(since, sum(arc.duration for arc, *_ in swing or [first]))
        last, angle = float(np.max(since, initial=0.0)), self.angle_past_rest if swing else self.angle_past_crest
        delta_phi, phi_dot, margin, ended = np.empty_like(time), np.empty_like(time), math.inf, 0.0
        for path, turn, energy in chain([first], legs):
            begun, ended, margin = ended, ended + path.duration, min(margin, energy)
            now = (begun <= since) & (since < ended)
            if now.any():
                passage, z, phi_dot[now] = path.state(since[now] - begun)
                delta_phi[now] = math.tau * (turn + passage) + (z - angle)
            if ended > last:
                break
        else:
            raise ParameterError(
                f"an exact motion on an incline has at most {MOST_TURNS} turns, which end at {ended - begin:.6g} s: "
                f"time must be less, got {float(np.max(time)):g} s"
            )
        return (delta_phi if swing else delta_phi + math.tau * cycles), phi_dot, margin


class Arc:
    """A path to a turning point and back: z = turn +- s^2 is the angle past a crest, or upside down, where phi falls,
    past a rest. Angles are +-z past the `origin`."""

    def __init__(self, start: Start, turn: float, end: float, origin: float = 0.0, upside_down: bool = False) -> None:
        self._oscillator, self._potential, self._turn, self._origin = start.oscillator, start.potential, turn, origin
        self._flip, self._side = -1 if upside_down else 1, 1 if end > turn else -1
        self._travel_time = TravelTime(self._dt_ds, 0.0, math.sqrt(abs(end - turn)))
        self.duration = 2 * self._travel_time.duration

    def _dt_ds(self, s: np.ndarray) -> np.ndarray:
        length, potential = self._side * s**2, self._potential
        z = self._turn + length
        phi = potential.rest - z if self._flip < 0 else math.pi + (potential.crest_past_pi + z)
        return np.sqrt(2 * self._oscillator.inertia(phi) / np.abs(potential.mean_torque(self._turn, length)))

    def time(self, start: Start) -> float:
        """Return the time [s] at a start, whose energy tells how far it is from the turning point."""
        z = -start.angle_past_rest
        if self._flip > 0:
            z = start.angle_past_crest + (math.tau if start.angle_past_crest < 0 < self._turn else 0.0)
        length = start.kinetic / abs(float(self._potential.mean_torque(self._turn, z - self._turn)))
        since = self._travel_time.time(math.sqrt(length))
        return self.duration / 2 + math.copysign(since, self._flip * self._side * start.phi_dot)

    def state(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return in which turn of the path the motion is at times [s] since it began, its angle there, and phi_dot."""
        since = time - self.duration / 2
        s, passage = self._travel_time.phase(np.abs(since))
        angle = self._origin + self._flip * (self._turn + self._side * s**2)
        return passage, angle, self._flip * self._side * np.copysign(2 * s / self._dt_ds(s), since)


class Turns:
    """Whole turns in a row, whose crests are passed with the given `energies` [J], which rise; uphill backwards."""

    def __init__(self, start: Start, energies: np.ndarray, uphill: bool = False) -> None:
        self._oscillator, self._potential, self._energies = start.oscillator, start.potential, energies
        self._uphill = uphill
        # At the crest, 0, doubles are dense: a load that hardly passes it spends its time there.
        edges = -math.pi, 0.0, math.pi
        self._travel_time = TravelTime(lambda x: 1 / self._speed(x, energies[:, None, None]), *edges)
        self.duration = self._travel_time.duration

    def _speed(self, x: np.ndarray, energy: np.ndarray) -> np.ndarray:
        inertia = self._oscillator.inertia(math.pi + (self._potential.crest_past_pi + x))
        return np.sqrt(2 * (energy + self._potential.below(x)) / inertia)

    def time(self, start: Start) -> float:
        """Return the time [s] at a start in the turn that comes first."""
        since = self._travel_time.time(start.angle_past_crest, len(self._energies) - 1 if self._uphill else 0)
        return self.duration - since if self._uphill else since

    def state(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return turn, angle and phi_dot, as `Arc.state`."""
        x, passage = self._travel_time.phase(self.duration - time if self._uphill else time)
        speed = self._speed(x, self._energies[passage])
        return passage, x, -speed if self._uphill else speed


def _arcs_of_swing(start: Start) -> list[tuple[Arc, int, float]]:
    """Return the paths of a swing, that on the side of the start first; angles are past rest."""
    if start.energy_above_next_crest == 0:
        raise NoLibrationError("the motion comes to rest on a crest")
    side = 1 if start.angle_past_rest >= 0 else -1
    return [(_arc_to(start, each), 0, -start.energy_above_next_crest) for each in (side, -side)]


def _arc_to(start: Start, side: int) -> Arc:
    """Return the arc of a swing downhill (1) or uphill (-1) of the rest: from there, or the crest if that is nearer."""
    potential = start.potential
    well = potential.well if side > 0 else math.tau - potential.well
    if start.kinetic == 0 and side * start.angle_past_rest > 0:
        distance = min(abs(start.angle_past_rest), abs(start.angle_past_crest))
        by_rest = distance == abs(start.angle_past_rest)
    else:
        energy = start.kinetic + potential.below(-start.angle_past_rest)
        by_rest = potential.below(-side * well / 2) >= energy
        missing = -start.energy_above_next_crest + (0.0 if side > 0 else potential.drop_per_turn)
        wanted = energy if by_rest else missing
        distance = root(lambda each: potential.below(-side * each) - wanted, 0.0, well / 2)
    if by_rest:
        return Arc(start, -side * distance, 0.0, upside_down=True)
    return Arc(start, -side * distance, -side * well, origin=side * well)


def _paths_over_crests(start: Start) -> Iterator[tuple[Arc | Turns, int, float]]:
    """Yield the paths of a motion that passes crests, with angles past the crest of each turn.

    With each come its most uphill turn, counted from the start, and the energy [J] by which it passes or misses a
    crest. A path has 256 turns at most, so that memory does not grow with their number.
    """
    potential, drop, highest = start.potential, start.potential.drop_per_turn, start.potential.highest
    energy, turn, left, batch = start.energy_above_crest, 0, MOST_TURNS, 8 if drop > 0 else 1
    # At the crest after this turn's, to all digits:
    ahead = start.energy_above_next_crest if start.angle_past_crest > 0 else energy + drop
    while start.phi_dot < 0 and energy > highest and left:
        energies = energy - drop * np.arange(min(batch, left))
        energies, batch = energies[energies > highest][::-1], min(4 * batch, 256)
        turn, left = turn - len(energies), left - len(energies)
        yield Turns(start, energies, uphill=True), turn + 1, float(energies[0])
        energy, ahead = float(energies[0]) - drop, float(energies[0])
    if energy <= highest:
        if energy == 0 and potential.excess == 0:
            raise NoLibrationError("the motion comes to rest on a crest")
        # A load that passes the crest uphill turns behind it: the well there is shallow, or there is none.
        lower, upper = (-math.pi, -potential.well) if energy > 0 else (0.0, math.pi)
        at_rest = start.kinetic == 0
        stop = start.angle_past_crest if at_rest else root(lambda x: potential.below(x) + energy, lower, upper)
        yield Arc(start, stop, math.pi), turn, min(abs(energy), ahead)
        energy, turn = ahead, turn + 1
    while left:
        energies, batch = energy + drop * np.arange(min(batch, left)), min(4 * batch, 256)
        yield Turns(start, energies), turn, energy
        energy, turn, left = float(energies[-1]) + drop, turn + len(energies), left - len(energies)


class TravelTime:
    """The time t(psi) along a path from its beginning, and its inverse psi(t)."""

    def __init__(self, rate: Callable[[np.ndarray], np.ndarray], *edges: float) -> None:
        """Set up a path with dt/dpsi = `rate` [s] from the first to the last of the `edges`.

        For psi of shape (panels, nodes) `rate` returns (panels, nodes), or (passages, panels, nodes) if the path is
        passed so often in a row, the first time with the roughest rate. A `ToleranceError` says that it is too rough.
        """
        lows, ends = np.array(edges[:-1]), np.array(edges[1:])
        panels: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        tried = 0
        while len(lows):
            halves = (ends - lows) / 2
            middles, rates = lows + halves, rate(lows[:, None] + halves[:, None] * (1 + _NODES))
            rates = rates.reshape(-1, *rates.shape[-2:]).swapaxes(0, 1)  # (panels, passages, nodes)
            tried += len(lows)  # an ordinary path takes 10 panels, and one that hardly passes a barrier 100
            if tried > 5000 or not np.isfinite(rates).all() or not ((lows < middles) & (middles < ends)).all():
                raise ToleranceError(
                    "the time along this motion is beyond doubles: sizes, masses, gravity or speeds are of too many "
                    "different orders of magnitude"
                )
            done = _are_resolved(rates[:, 0], lows, halves)
            panels.append((lows[done], halves[done], rates[done]))
            lows, middles, ends = lows[~done], middles[~done], ends[~done]
            lows, ends = np.concatenate([lows, middles]), np.concatenate([middles, ends])
        starts, halves, rates = (np.concatenate(parts) for parts in zip(*panels, strict=True))
        order = np.argsort(starts)
        self._size, passages = len(order), rates.shape[1]
        self._series = rates[order].swapaxes(0, 1).reshape(-1, len(_NODES)) @ _TO_SERIES
        self._lows, self._halves = np.tile(starts[order], passages), np.tile(halves[order], passages)
        self._times = np.concatenate([[0.0], np.cumsum(self._series @ _TO_INTEGRAL.sum(axis=1) * self._halves)])
        self.duration = float(self._times[-1])  # of all passages together [s]

    def time(self, psi: float, passage: int = 0) -> float:
        """Return the time [s] at which the motion is at `psi` in a `passage`, of which the first one is 0."""
        panel = max(0, int(np.searchsorted(self._lows[: self._size], psi, side="right")) - 1) + passage * self._size
        half = self._halves[panel]
        x = (psi - self._lows[panel]) / half - 1
        return float(self._times[panel] + half * chebyshev.chebval(x, self._series[panel] @ _TO_INTEGRAL))

    def phase(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return psi at the times `time` [s], and in which passage that is; beyond both ends the motion stays there."""
        panel = np.clip(np.searchsorted(self._times, time, side="right") - 1, 0, len(self._series) - 1)
        half, since = self._halves[panel], time - self._times[panel]
        target, guess = since / half, 2 * since / (self._times[panel + 1] - self._times[panel]) - 1
        values, integral = self._series[panel].T, (self._series[panel] @ _TO_INTEGRAL).T
        low, high = -np.ones_like(time), np.ones_like(time)
        x = np.clip(guess, -1, 1)
        for _ in range(60):  # if only bisection helps, 53 use up the digits of a double
            excess = chebyshev.chebval(x, integral, tensor=False) - target
            low, high = np.where(excess <= 0, x, low), np.where(excess >= 0, x, high)
            newton = x - excess / chebyshev.chebval(x, values, tensor=False)
            # Newton's method leaves the bracket by rounding, or where dt/dpsi is steep: bisect there. A step of 1e-10
            # leaves an error of its square.
            converged = np.abs(newton - x) <= 1e-10
            x = np.where(converged | ((newton >= low) & (newton <= high)), newton, (low + high) / 2)
            if converged.all():
                break
        return self._lows[panel] + half * np.clip(1 + x, 0, 2), panel // self._size


def _are_resolved(rates: np.ndarray, lows: np.ndarray, halves: np.ndarray) -> np.ndarray:
    """Return which of the panels reproduce `rates` by a series, as far as the rounding of psi lets them."""
    coefficients = np.abs(rates @ _TO_SERIES)
    size, tail = coefficients.max(axis=1), coefficients[:, -3:].max(axis=1)
    # Noise shows as small coefficients that have stopped falling. Rounding of psi changes dt/dpsi by some eps as often
    # as the panel is narrower than psi, for panels are as wide as dt/dpsi takes to change by itself.
    stalled = tail >= 0.1 * coefficients[:, -12:-3].max(axis=1)
    noise = 16 * EPS * (1 + (np.abs(lows) + halves) / halves)
    return (tail <= 3e-15 * size) | (stalled & (tail <= noise * size))
