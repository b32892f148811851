"""phi(t) of one degree of freedom, exactly: a swing, or a motion that passes crests of V.

Two kinds of path are enough. An arc begins or ends at a turning point, phi = turn +- s^2; a turn leads past a crest:

    dt/ds = sqrt(2 J / |mean torque from the turning point on|),    dt/dx = sqrt(J / 2 (level + below(x))),

both smooth and positive, with `level` = E - V at the crest and x the distance past it. A swing is two arcs that meet at
the equilibrium; a load that passes crests goes up in turns, each with a level one step lower, until it cannot pass the
next potential, swings round in an arc, and goes down in turns for ever. What goes the other way is watched in a mirror.

Beside a separatrix rounding decides. There the motion is computed for a start and a scene that are changed by their
rounding as well, both ways, and refused where that matters.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, cycle

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.oscillator import TURN, Oscillator, Potential, root
from mjbeer.theory.quadrature import TravelTime

EPS = 2.0**-52
ROUNDINGS = 4 * EPS
"""Relative rounding of J, and of slope over depth: up to nine roundings of half an eps each, never all of one sign."""
UNCERTAIN = 1e-4
"""Largest effect of rounding on phi [rad], relative beyond 1 rad: a hundredth of the error of a run that is trusted."""
_SUSPECT = 0.01 * UNCERTAIN
"""Largest rough estimate of that effect at which no motion is computed again."""
_STILL = 1e-30
"""Amplitude [rad] up to which a swing is rest."""
MOST_TURNS = 10_000
"""Most turns of a motion that passes crests."""
MOST_PERIODS = 1_000_000
"""Most periods of a swing: after more of them rounding of the period alone is 1e-9 rad and more."""
_FEW, _BATCH = 8, 256
"""Turns on the first clock, on each next one four times as many, up to so many that memory does not grow with them."""


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and phi_dot [rad/s] at the times `time` [s], none of them negative; the errors are `exact`'s."""
    start, latest = Start.at(oscillator, phi0, phi_dot0), float(np.max(time, initial=0.0))
    if start.stays(phi0):
        return np.full_like(time, phi0), np.zeros_like(time)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):  # what is not finite becomes an error
        try:
            turned, phi_dot, margin = start.move(time)
        except NoLibrationError:  # exactly on the separatrix: until the motion nears the crest, both sides are alike
            turned, phi_dot, margin = *start.perturbed(1).move(time)[:2], 0.0
        angle = np.maximum(1, np.abs(turned))
        doubt = start.rounding_delay(margin, latest) * float(np.max(np.abs(phi_dot) / angle, initial=0.0))
        effect = _effect(
            start, doubt, lambda other: float(np.max(np.abs(other.move(time)[0] - turned) / angle, initial=0.0))
        )
    if not effect <= UNCERTAIN:
        raise NoLibrationError(
            f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s is too near a separatrix: rounding of start and scene "
            f"changes phi by {effect:.2g} rad (relative beyond 1 rad) until {latest:g} s, where at most {UNCERTAIN:g} "
            "is allowed"
        )
    return phi0 + start.sign * turned, start.sign * phi_dot


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of a swing of an `amplitude` [rad], with the errors of `Scene.period`."""
    rest = oscillator.equilibrium()
    low, high = (end - rest for end in oscillator.separatrix())
    if not low < amplitude < high:
        raise NoLibrationError(
            f"amplitude {amplitude:.6g} rad is not inside the separatrix: released from rest, the load swings about "
            f"its equilibrium only for amplitudes between {low:.6g} and {high:.6g} rad"
        )
    sign, potential = oscillator.sign, oscillator.potential
    start = Start(oscillator, potential, sign, *potential.place_by_rest(sign * amplitude), phi_dot=0.0, kinetic=0.0)
    if start.still:
        return TURN / oscillator.frequency()
    if start.energy_above_next_crest < 0:
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            found = _period(_swing(start))
            doubt = start.rounding_delay(-start.energy_above_next_crest, found) / found
            if _effect(start, doubt, lambda other: abs(_period(_swing(other)) - found) / found) <= UNCERTAIN:
                return found
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is too near the separatrix: rounding of the scene changes the period "
        f"by more than {UNCERTAIN:g} of itself"
    )


def _effect(start: "Start", doubt: float, distance: Callable[["Start"], float]) -> float:
    """Return the `distance` of motions from starts that rounding may change into this one, 0 if in no `doubt`."""
    if doubt <= _SUSPECT:
        return 0.0
    try:
        return max(distance(start.perturbed(sign)) for sign in (1, -1))
    except NoLibrationError:
        return math.inf


@dataclass(frozen=True)
class Start:
    """Where a motion starts, in distances that keep their digits beside the crest and beside the equilibrium."""

    oscillator: Oscillator
    potential: Potential
    sign: int  # -1 if the motion is watched in a mirror: phi, its rate and the slope have the other sign here
    angle_past_crest: float  # distance past the crest of its turn [rad]
    angle_past_rest: float  # distance past the equilibrium of its well [rad]
    phi_dot: float
    kinetic: float  # kinetic energy [J]

    @classmethod
    def at(cls, oscillator: Oscillator, phi: float, phi_dot: float) -> "Start":
        sign, potential = oscillator.sign, oscillator.potential
        if oscillator.ramp == 0 and phi_dot < 0:
            sign, potential = -1, Potential(0.0, oscillator.depth, -oscillator.bottom)
        # The kinetic energy is that at phi itself: where J has a narrow minimum, rounding of the place would change it.
        kinetic = float(oscillator.inertia(phi)) * phi_dot**2 / 2
        return cls(oscillator, potential, sign, *potential.place(sign * phi), sign * phi_dot, kinetic)

    @cached_property
    def energy_above_crest(self) -> float:
        """Return E - V at the crest of the turn [J]."""
        return self.kinetic - float(self.potential.below(self.angle_past_crest))

    @cached_property
    def energy_above_next_crest(self) -> float:
        """Return E - V at the next crest downhill [J]."""
        return self.kinetic - self.potential.below_ahead(self.angle_past_crest, self.angle_past_rest)

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a potential."""
        return self.potential.well > 0 and self.energy_above_next_crest <= 0

    @property
    def still(self) -> bool:
        """Return whether the motion is rest in the equilibrium."""
        width = math.sqrt(self.kinetic / self.potential.curvature) if self.swings else math.inf
        return max(abs(self.angle_past_rest), width) <= _STILL

    def stays(self, phi: float) -> bool:
        """Return whether a start does not move, as far as doubles tell: at rest, on a barrier, or without any torque.

        Whoever writes an odd multiple of pi means the top of level ground; it is up to 0.64 eps of itself off. The top
        of a slope is pi less an angle, and in doubles up to an eps of pi off.
        """
        if self.kinetic > 0 or self.potential.excess > 0:
            return self.still
        nearest = min(abs(self.angle_past_crest), abs(TURN - self.angle_past_crest))
        return nearest <= EPS * max(abs(phi), math.pi) or self.potential.depth == 0 or self.still

    @property
    def rounding(self) -> float:
        """Return by how much rounding of the scene may put the crest elsewhere, and so falsify the place [rad].

        On level ground the crest is at an odd multiple of pi, and how far a double is from that is known to an eps.
        """
        potential = self.potential
        steep = potential.balanced / potential.curvature if potential.curvature > 0 else 0.0
        return ROUNDINGS * (abs(potential.bottom) + potential.lean + steep) + EPS * abs(self.angle_past_crest)

    def perturbed(self, sign: int) -> "Start":
        """Return this start, changed by rounding: nearer to passing the crest if `sign` is 1, farther from it if -1."""
        depth, ramp = self.potential.depth, self.potential.ramp * (1 + sign * ROUNDINGS)
        ramp = min(ramp, math.nextafter(depth, 0)) if self.potential.well > 0 else max(ramp, depth)
        by, potential = -sign * math.copysign(self.rounding, self.angle_past_crest), self.potential
        by_rest = abs(self.angle_past_rest) < abs(self.angle_past_crest)
        past, from_rest = (
            potential.place_by_rest(self.angle_past_rest + by)
            if by_rest
            else potential.place_by_crest(self.angle_past_crest + by)
        )
        potential, kinetic = Potential(ramp, depth, potential.bottom), self.kinetic * (1 + sign * ROUNDINGS)
        return replace(self, potential=potential, angle_past_crest=past, angle_past_rest=from_rest, kinetic=kinetic)

    def rounding_delay(self, margin: float, latest: float) -> float:
        """Return a rough bound on the time [s] by which rounding delays a motion until `latest` [s]."""
        potential, shift = self.potential, self.rounding
        if potential.curvature == 0:  # the torque at the crest is a difference of ramp and depth
            share = ROUNDINGS * (potential.balanced / potential.excess) ** 2 if potential.excess > 0 else math.inf
            return share * latest
        rounding = ROUNDINGS * (self.kinetic + abs(float(potential.below(self.angle_past_crest))))
        rounding += abs(float(potential.torque(self.angle_past_crest))) * shift + potential.curvature * shift**2
        share = ROUNDINGS * (potential.balanced / potential.curvature) ** 2 + (
            rounding / margin if margin > 0 else math.inf
        )
        # Each time that the motion passes or nears a crest, it is early or late by that share of 1/lambda.
        return share * (
            math.sqrt(float(self.oscillator.inertia_past_pi(potential.offset)) / potential.curvature) + latest
        )

    def move(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Return how far phi has turned [rad] and phi_dot [rad/s] at the times [s], and the `margin` [J].

        The margin is the least energy by which the motion passes or misses a crest. A motion that comes to rest on one
        for ever is a NoLibrationError.
        """
        swing = _swing(self) if self.swings else None
        latest, legs = float(np.max(time, initial=0.0)), cycle(swing) if swing else _roll(self)
        first = next(legs)
        begin = first[0].time(self)
        since, cycles = time + begin, 0
        if swing or self.potential.ramp == 0:  # all periods, or turns, are alike
            most, lasts = (MOST_PERIODS, _period(swing)) if swing else (MOST_TURNS, first[0].duration)
            _require_until(latest, most * lasts, f"{most} {'periods' if swing else 'turns'}")
            cycles, since = np.divmod(since, lasts)
        last, place = float(np.max(since, initial=0.0)), self.angle_past_rest if swing else self.angle_past_crest
        turned, phi_dot, margin, ended = np.empty_like(time), np.empty_like(time), math.inf, 0.0
        for path, turn, energy in chain([first], legs):
            begun, ended, margin = ended, ended + path.duration, min(margin, energy)
            now = (begun <= since) & (since < ended)
            if now.any():
                passage, z, phi_dot[now] = path.state(since[now] - begun)
                turned[now] = TURN * (turn + passage) + (z - place)
            if ended > last:
                break
        else:
            _require_until(latest, ended - begin, f"{MOST_TURNS} turns")
        return (turned if swing else turned + TURN * cycles), phi_dot, margin


def _require_until(latest: float, end: float, most: str) -> None:
    if not latest < end:
        raise ParameterError(
            f"an exact motion has at most {most}, which end at {end:.6g} s: time must be less, got {latest:g} s"
        )


State = tuple[np.ndarray, np.ndarray, np.ndarray]
"""In which turn of a path a motion is, its place there [rad], and phi_dot [rad/s]."""


class Arc:
    """A path to a turning point and back: z = turn +- s^2 is the distance past a potential, or upside down, where phi
    falls, past a rest. Places are +-z past the `origin`."""

    def __init__(self, start: Start, turn: float, end: float, origin: float = 0.0, upside_down: bool = False) -> None:
        self._oscillator, self._potential, self._turn, self._origin = start.oscillator, start.potential, turn, origin
        self._flip, self._side = -1 if upside_down else 1, 1 if end > turn else -1
        self._travel_time = TravelTime(self._rate, 0.0, math.sqrt(abs(end - turn)))
        self.duration = 2 * self._travel_time.duration

    def _rate(self, s: np.ndarray) -> np.ndarray:
        length, potential, oscillator = self._side * s**2, self._potential, self._oscillator
        z = self._turn + length
        inertia = (
            oscillator.inertia(potential.rest - z)
            if self._flip < 0
            else oscillator.inertia_past_pi(potential.offset + z)
        )
        return np.sqrt(2 * inertia / np.abs(potential.mean_torque(self._turn, length)))

    def time(self, start: Start) -> float:
        """Return the time [s] at a start, whose energy tells how far it is from the turning point."""
        z = (
            -start.angle_past_rest
            if self._flip < 0
            else start.angle_past_crest + (TURN if start.angle_past_crest < 0 < self._turn else 0.0)
        )
        length = start.kinetic / abs(float(self._potential.mean_torque(self._turn, z - self._turn)))
        since = self._travel_time.time(math.sqrt(length))
        return self.duration / 2 + math.copysign(since, self._flip * self._side * start.phi_dot)

    def state(self, time: np.ndarray) -> State:
        """Return the state at times [s] since the path began."""
        since = time - self.duration / 2
        s, passage = self._travel_time.phase(np.abs(since))
        place = self._origin + self._flip * (self._turn + self._side * s**2)
        return passage, place, self._flip * self._side * np.copysign(2 * s / self._rate(s), since)


class Turns:
    """Whole turns, one after the other, whose crests are at the given `levels` [J], which rise; uphill backwards."""

    def __init__(self, start: Start, levels: np.ndarray, uphill: bool = False) -> None:
        self._oscillator, self._potential, self._levels, self._uphill = (
            start.oscillator,
            start.potential,
            levels,
            uphill,
        )
        begins = start.potential.begins
        # At the crest, 0, doubles are dense: a load that hardly passes it spends its time there.
        self._travel_time = TravelTime(lambda x: 1 / self._speed(x, levels[:, None, None]), begins, 0.0, begins + TURN)
        self.duration = self._travel_time.duration

    def _speed(self, x: np.ndarray, level: np.ndarray) -> np.ndarray:
        inertia = self._oscillator.inertia_past_pi(self._potential.offset + x)
        return np.sqrt(2 * (level + self._potential.below(x)) / inertia)

    def time(self, start: Start) -> float:
        """Return the time [s] at a start in the turn that comes first."""
        since = self._travel_time.time(start.angle_past_crest, len(self._levels) - 1 if self._uphill else 0)
        return self.duration - since if self._uphill else since

    def state(self, time: np.ndarray) -> State:
        """Return the state at times [s] since the path began."""
        x, passage = self._travel_time.phase(self.duration - time if self._uphill else time)
        speed = self._speed(x, self._levels[passage])
        return passage, x, -speed if self._uphill else speed


Leg = tuple[Arc | Turns, int, float]
"""A path, the number of its most uphill turn from that of the start, and by how much it passes or misses a crest."""


def _period(swing: list[Leg]) -> float:
    return sum(path.duration for path, _, _ in swing)


def _swing(start: Start) -> list[Leg]:
    """Return the legs of a swing, with places past the rest: an arc on the side of the start, and the other one."""
    if not start.swings or start.energy_above_next_crest == 0:
        raise NoLibrationError("it ends on the crest")
    side = 1 if start.angle_past_rest >= 0 else -1
    return [(_arc(start, each), 0, -start.energy_above_next_crest) for each in (side, -side)]


def _arc(start: Start, side: int) -> Arc:
    """Return the arc of a swing downhill (1) or uphill (-1) of the rest: from the rest, or the crest if that is nearer.

    In either case V rises or falls from there by 2 `height` to the turning point.
    """
    potential = start.potential
    well = potential.well if side > 0 else TURN - potential.well

    def height(distance: float) -> float:
        return float(potential.below(-side * distance))

    if start.kinetic == 0 and side * start.angle_past_rest > 0:
        distance = min(abs(start.angle_past_rest), abs(start.angle_past_crest))
        by_rest = distance == abs(start.angle_past_rest)
    else:
        energy = start.kinetic + height(side * start.angle_past_rest)
        by_rest = height(well / 2) >= energy
        wanted = energy if by_rest else -start.energy_above_next_crest + (0.0 if side > 0 else potential.step)
        distance = root(lambda each: height(each) - wanted, 0.0, well / 2)
    if by_rest:
        return Arc(start, -side * distance, 0.0, upside_down=True)
    return Arc(start, -side * distance, -side * well, origin=side * well)


def _roll(start: Start) -> Iterator[Leg]:
    """Yield the legs of a motion that passes crests, with places past the crest of each turn."""
    potential, step, rise = start.potential, start.potential.step, start.potential.rise
    level, turn, left, batch = start.energy_above_crest, 0, MOST_TURNS, _FEW if step > 0 else 1
    ahead = (
        start.energy_above_next_crest if start.angle_past_crest > 0 else level + step
    )  # at the crest after this turn's, to all digits
    while start.phi_dot < 0 and level > rise and left:
        levels = level - step * np.arange(min(batch, left))
        levels, batch = levels[levels > rise][::-1], min(4 * batch, _BATCH)
        turn, left = turn - len(levels), left - len(levels)
        yield Turns(start, levels, uphill=True), turn + 1, float(levels[0])
        level, ahead = float(levels[0]) - step, float(levels[0])
    if level <= rise:
        if level == 0 and potential.excess == 0:
            raise NoLibrationError("it ends on the crest")
        # A load that passes the crest uphill turns behind it: the well there is shallow, or there is none.
        end = potential.begins + TURN
        lower, upper = (-math.pi, -potential.well) if level > 0 else (0.0, end)
        at_rest = start.kinetic == 0
        place = start.angle_past_crest if at_rest else root(lambda x: float(potential.below(x)) + level, lower, upper)
        yield Arc(start, place, end), turn, min(abs(level), ahead)
        level, turn = ahead, turn + 1
    while left:
        levels, batch = level + step * np.arange(min(batch, left)), min(4 * batch, _BATCH)
        yield Turns(start, levels), turn, level
        level, turn, left = float(levels[-1]) + step, turn + len(levels), left - len(levels)
