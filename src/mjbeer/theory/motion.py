"""phi(t) of one degree of freedom, exactly: a swing, or a motion that passes crests of V.

Two kinds of path are enough. An arc begins or ends at a turning point, phi = turn +- s^2; a turn leads past a crest:

    dt/ds = sqrt(2 J / |mean torque from the turning point on|),    dt/dx = sqrt(J / 2 (level + below(x))),

both smooth and positive, with `level` = E - V at the crest and x the distance past it. A swing is two arcs that meet at
the equilibrium, forth and back; a load that passes crests goes up in turns, each with a level one step lower, until it
cannot pass the next crest, swings round in an arc, and goes down in turns for ever. The slope is never negative here:
what goes the other way is watched in a mirror.

Beside a separatrix rounding decides. There the motion is computed for a start and a scene that are changed by their
rounding as well, both ways, and refused where that matters.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.oscillator import TURN, Oscillator, root
from mjbeer.theory.quadrature import Clock

EPS = 2.0**-52
ROUNDINGS = 4 * EPS
"""Relative rounding of J, and of slope over depth: up to nine roundings of half an eps each, never all of one sign."""
UNCERTAIN = 1e-4
"""Largest effect of rounding on phi [rad], relative beyond 1 rad: a hundredth of the error of a run that is trusted."""
_SUSPECT = 0.01 * UNCERTAIN
"""Largest rough estimate of that effect at which no motion is computed again."""
_LARGEST_TOP = 2000 * math.pi
"""Largest angle [rad] an eps of which puts a start at rest on the top. Farther out no double is meant as the top."""
_HARMONIC = 1e-12
"""Amplitude [rad] up to which a swing is harmonic to rounding."""
_BESIDE = 0.1
"""Distance from a turning point below which the energy tells more of it than the angle, over the angle."""
MOST_TURNS = 10_000
"""Most turns of a motion that passes crests."""
MOST_PERIODS = 1_000_000
"""Most periods of a swing: after more of them rounding of the period alone is 1e-9 rad and more."""
_TURNS, _PERIODS = f"{MOST_TURNS} turns", f"{MOST_PERIODS} periods"
_FEW, _BATCH = 8, 256
"""Turns on the first clock, on each next one four times as many, up to so many that memory does not grow with them."""
_ON_SEPARATRIX = "lies exactly on the separatrix: the motion takes for ever to reach the unstable equilibrium"

State = tuple[np.ndarray, np.ndarray, np.ndarray]
"""At some times: in which turn, less the path's first one; how far past the crest there [rad]; and phi_dot [rad/s]."""


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and phi_dot [rad/s] at the times `time` [s], none of them negative.

    Raises:
      ParameterError: if the motion makes more turns or swings until then than are followed.
      NoLibrationError: if the start is so near a separatrix that its rounding decides how the motion goes on.
      ToleranceError: if sizes, masses, gravity or speeds are of too many different orders of magnitude.
    """
    sign = -1 if oscillator.slope < 0 or (oscillator.slope == 0 and phi_dot0 < 0) else 1
    start = Start.at(oscillator if sign > 0 else oscillator.mirror(), sign * phi0, sign * phi_dot0)
    if start.stays(phi0):
        return np.full_like(time, phi0), np.zeros_like(time)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):  # what is not finite becomes an error
        try:
            turned, phi_dot = _certain(start, time)
        except NoLibrationError as error:
            raise NoLibrationError(f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s {error}") from None
    return phi0 + sign * turned, sign * phi_dot


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of the swing released from rest `amplitude` [rad] from the equilibrium.

    Raises:
      NoLibrationError: if `amplitude` is at or beyond the separatrix, or so near it that its rounding changes the
        period.
      ToleranceError: if sizes, masses and gravity are of too many different orders of magnitude.
    """
    oscillator.require_libration(oscillator.equilibrium() + amplitude)
    seen, from_rest = (oscillator.mirror(), -amplitude) if oscillator.slope < 0 else (oscillator, amplitude)
    start = Start(seen, *seen.crest.place_by_rest(from_rest), phi_dot=0.0, kinetic=0.0)
    if start.level_ahead < 0:
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            found = TURN / seen.frequency() if start.tiny else Swing(start).period
            if start.doubt(-start.level_ahead, found) <= _SUSPECT * found:
                return found
            nudged = [start.nudged(sign) for sign in (1, -1)]
            if all(each.swings and abs(Swing(each).period - found) <= UNCERTAIN * found for each in nudged):
                return found
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is too near the separatrix: rounding of the scene changes the period "
        f"by more than {UNCERTAIN:g} of itself"
    )


def energy_to_barrier(oscillator: Oscillator, phi: float, phi_dot: float) -> float:
    """Return how far the energy of a motion is from that of the next barrier downhill [J]; infinite without one."""
    sign, seen = (-1, oscillator.mirror()) if oscillator.slope < 0 else (1, oscillator)
    return abs(Start.at(seen, sign * phi, sign * phi_dot).level_ahead) if seen.crest.well > 0 else math.inf


@dataclass(frozen=True)
class Start:
    """Where a motion starts, in distances that keep their digits beside the crest and beside the equilibrium."""

    form: Oscillator
    past: float
    """Distance past the crest of its turn [rad]."""
    from_rest: float
    """Distance past the equilibrium of its well [rad]."""
    phi_dot: float
    kinetic: float
    """Kinetic energy [J]."""

    @classmethod
    def at(cls, form: Oscillator, phi: float, phi_dot: float) -> "Start":
        # The kinetic energy is that at phi itself: where J has a narrow minimum, rounding of the place would change it.
        return cls(form, *form.crest.place(phi), phi_dot, float(form.inertia(phi)) * phi_dot**2 / 2)

    @property
    def level(self) -> float:
        """Return E - V at the crest of the turn [J]."""
        return self.kinetic - float(self.form.crest.below(self.past))

    @property
    def level_ahead(self) -> float:
        """Return E - V at the next crest downhill [J]."""
        return self.kinetic - self.form.crest.below_ahead(self.past, self.from_rest)

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a crest."""
        return self.form.crest.well > 0 and self.level_ahead <= 0

    @property
    def tiny(self) -> bool:
        """Return whether the motion is a swing that is harmonic to rounding."""
        width = math.sqrt(self.kinetic / self.form.crest.curvature) if self.swings else math.inf
        return max(abs(self.from_rest), width) <= _HARMONIC

    def stays(self, phi: float) -> bool:
        """Return whether no torque acts at a start at rest, as far as doubles tell: on a barrier, or without any.

        Whoever writes an odd multiple of pi means the top of level ground; it is up to 0.64 eps of itself off. The top
        of a slope is pi less an angle, and in doubles up to an eps of pi off.
        """
        if self.kinetic > 0 or self.form.crest.excess > 0:
            return False
        nearest = min(abs(self.past), abs(TURN - self.past))
        return self.form.depth == 0 or nearest <= EPS * min(max(abs(phi), math.pi), _LARGEST_TOP)

    @property
    def rounding(self) -> float:
        """Return by how much rounding of the scene may put the crest elsewhere, and so falsify the place [rad].

        On level ground the crest is at an odd multiple of pi, and how far a double is from that is known to an eps.
        """
        crest = self.form.crest
        steep = crest.ramp / crest.curvature if crest.curvature > 0 else 0.0
        return ROUNDINGS * (abs(self.form.bottom) + crest.lean + steep) + EPS * abs(self.past)

    def nudged(self, sign: int) -> "Start":
        """Return this start, changed by rounding: nearer to passing the crest if `sign` is 1, farther from it if -1."""
        crest, depth = self.form.crest, self.form.depth
        slope = self.form.slope * (1 + sign * ROUNDINGS)
        slope = min(slope, math.nextafter(depth, 0)) if crest.well > 0 else max(slope, depth)
        by = -sign * math.copysign(self.rounding, self.past)
        by_rest = abs(self.from_rest) < abs(self.past)
        place = crest.place_by_rest(self.from_rest + by) if by_rest else crest.place_by_crest(self.past + by)
        form, kinetic = replace(self.form, slope=slope), self.kinetic * (1 + sign * ROUNDINGS)
        return Start(form, *place, self.phi_dot, kinetic)

    def move(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Return how far phi has turned [rad] and phi_dot [rad/s] at the times [s], and the `margin` [J].

        The margin is the energy by which the motion passes or misses a crest, the least of all.

        Raises:
          NoLibrationError: if the motion comes to rest on a crest, for ever.
        """
        if not self.swings:
            return _roll(self, time)
        if self.level_ahead == 0:
            raise NoLibrationError(_ON_SEPARATRIX)
        latest = float(np.max(time, initial=0.0))
        if self.tiny:
            omega = self.form.frequency()
            _require_until(latest, MOST_PERIODS * TURN / omega, _PERIODS)
            cos, sin = np.cos(omega * time), np.sin(omega * time)
            turned = self.from_rest * (cos - 1) + self.phi_dot / omega * sin
            return turned, self.phi_dot * cos - self.from_rest * omega * sin, -self.level_ahead
        swing = Swing(self)
        _require_until(latest, MOST_PERIODS * swing.period, _PERIODS)
        return *swing.move(time), -self.level_ahead

    def doubt(self, margin: float, latest: float) -> float:
        """Return a rough bound on the time [s] by which rounding delays a motion until `latest` [s]."""
        crest, shift = self.form.crest, self.rounding
        if crest.curvature == 0:  # the torque at the crest is a difference of slope and depth
            share = ROUNDINGS * (crest.ramp / crest.excess) ** 2 if crest.excess > 0 else math.inf
            return share * latest
        rounding = ROUNDINGS * (self.kinetic + abs(float(crest.below(self.past))))
        rounding += abs(float(crest.torque(self.past))) * shift + crest.curvature * shift**2
        share = ROUNDINGS * (crest.ramp / crest.curvature) ** 2 + (rounding / margin if margin > 0 else math.inf)
        # Each time that the motion passes or nears a crest, it is early or late by that share of 1/lambda.
        return share * (math.sqrt(float(self.form.inertia_past_crest(0.0)) / crest.curvature) + latest)


def _certain(start: Start, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far phi has turned [rad] and phi_dot [rad/s], if rounding leaves that certain."""
    latest = float(np.max(time, initial=0.0))
    try:
        turned, phi_dot, margin = start.move(time)
    except NoLibrationError:  # exactly on the separatrix: until the motion nears the crest, both sides are alike
        turned, phi_dot, margin = *start.nudged(1).move(time)[:2], 0.0
    angle = np.maximum(1, np.abs(turned))
    if not start.doubt(margin, latest) * float(np.max(np.abs(phi_dot) / angle, initial=0.0)) <= _SUSPECT:
        effect = 0.0
        for sign in (1, -1):
            try:
                other = start.nudged(sign).move(time)[0]
                effect = max(effect, float(np.max(np.abs(other - turned) / angle, initial=0.0)))
            except NoLibrationError:
                effect = math.inf
        if not effect <= UNCERTAIN:
            raise NoLibrationError(
                f"is too near a separatrix: rounding of start and scene changes phi by {effect:.2g} rad (relative "
                f"beyond 1 rad) until {latest:g} s, where at most {UNCERTAIN:g} is allowed"
            )
    return turned, phi_dot


class Arc:
    """A path from a turning point on: so far past a crest [rad], or upside down, where phi falls, past a rest."""

    def __init__(self, form: Oscillator, turn: float, end: float, upside_down: bool = False) -> None:
        self._form, self._crest, self._turn, self._upside_down = form, form.crest, turn, upside_down
        self._sign = 1 if end > turn else -1
        self.clock = Clock(self._rate, 0.0, math.sqrt(abs(end - turn)))

    def _rate(self, s: np.ndarray) -> np.ndarray:
        length = self._sign * s**2
        z = self._turn + length
        inertia = self._form.inertia(self._crest.rest - z) if self._upside_down else self._form.inertia_past_crest(z)
        return np.sqrt(2 * inertia / np.abs(self._crest.mean_torque(self._turn, length)))

    def time(self, start: Start) -> float:
        """Return the time [s] from the turning point to a start on the path."""
        z = -start.from_rest if self._upside_down else start.past + (TURN if start.past < 0 < self._turn else 0.0)
        length = abs(z - self._turn)
        if length < _BESIDE * abs(self._turn):  # the difference has lost digits, and the energy has not
            length = start.kinetic / abs(float(self._crest.mean_torque(self._turn, z - self._turn)))
        return self.clock.time(math.sqrt(length))

    def state(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the distance from the turning point [rad] and |phi_dot| [rad/s] at times [s] since then."""
        s, _ = self.clock.phase(time)
        return s**2, 2 * s / self._rate(s)


class Swing:
    """A swing through a start: an arc on each side of the equilibrium, from which angles are counted here."""

    def __init__(self, start: Start) -> None:
        self._start = start
        (self._high, self._up), (self._low, self._down) = self._arc(1), self._arc(-1)
        self.period = 2 * (self._high.clock.duration + self._low.clock.duration)
        side = 1 if start.from_rest >= 0 else -1
        since = (self._high if side > 0 else self._low).time(start)
        since = since if side > 0 else self.period / 2 - since
        self._begin = -since if start.phi_dot > 0 else since

    def _arc(self, side: int) -> tuple[Arc, float]:
        """Return the arc on the downhill side (1) or uphill (-1), and where its turning point is."""
        start, crest = self._start, self._start.form.crest
        well = crest.well if side > 0 else TURN - crest.well

        def height(distance: float) -> float:
            """Return how far V at a distance from the rest is above that, or from the crest below that."""
            return float(crest.below(-side * distance))

        if start.kinetic == 0 and side * start.from_rest > 0:
            by_rest = abs(start.from_rest) <= abs(start.past)
            distance = abs(start.from_rest if by_rest else start.past)
        else:
            energy = start.kinetic + float(crest.below(-start.from_rest))
            by_rest = height(well / 2) >= energy
            wanted = energy if by_rest else -start.level_ahead + (0.0 if side > 0 else crest.step)
            distance = root(lambda each: height(each) - wanted, 0.0, well / 2)
        arc = Arc(start.form, -side * distance, 0.0 if by_rest else -side * well, by_rest)
        return arc, side * (distance if by_rest else well - distance)

    def move(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how far phi has turned since the start [rad], and phi_dot [rad/s]."""
        half = self.period / 2
        since = np.remainder(time + self._begin, self.period)  # since the turning point downhill
        back = since > half
        since = np.where(back, self.period - since, since)
        upper = since <= self._high.clock.duration
        y, speed = np.empty_like(since), np.empty_like(since)
        away, speed[upper] = self._high.state(since[upper])
        y[upper] = self._up - away
        away, speed[~upper] = self._low.state(half - since[~upper])
        y[~upper] = self._down + away
        return y - self._start.from_rest, np.where(back, speed, -speed)


class Bounce:
    """The turn in which a motion uphill turns, up an arc and down again."""

    def __init__(self, start: Start, level: float) -> None:
        """Set up the turn whose crest is at `level` [J]; a start at rest is in it.

        Raises:
          NoLibrationError: if the motion comes to rest on the crest.
        """
        form, crest = start.form, start.form.crest
        end = crest.begins + TURN
        if level == 0 and crest.excess == 0:
            raise NoLibrationError(_ON_SEPARATRIX)
        # A load that passes the crest uphill turns behind it: the well there is shallow, or there is none.
        lower, upper = (-math.pi, -crest.well) if level > 0 else (0.0, end)
        at_rest = start.kinetic == 0
        self._turn = start.past if at_rest else root(lambda x: float(crest.below(x)) + level, lower, upper)
        self._arc = Arc(form, self._turn, end)
        self.duration = 2 * self._arc.clock.duration

    def begin(self, start: Start) -> float:
        """Return the time at the start [s], since the motion came into the turn."""
        since = self._arc.time(start)
        return self.duration / 2 + math.copysign(since, start.phi_dot)

    def state(self, time: np.ndarray) -> State:
        """Return the state at times [s] since the motion came into the turn."""
        since = time - self.duration / 2
        away, speed = self._arc.state(np.abs(since))
        return np.zeros_like(away), self._turn + away, np.copysign(speed, since)


class Turns:
    """Whole turns, one after the other, whose crests are at the given `levels` [J], which rise; uphill backwards."""

    def __init__(self, form: Oscillator, levels: np.ndarray, uphill: bool = False) -> None:
        self._form, self._levels, self._uphill = form, levels, uphill
        begins = form.crest.begins
        # At the crest, 0, doubles are dense: a load that hardly passes it spends its time there.
        self._clock = Clock(lambda x: 1 / self._speed(x, levels[0]), begins, 0.0, begins + TURN)
        if len(levels) > 1:
            self._clock.repeat(lambda x: 1 / self._speed(x, levels[:, None, None]), len(levels))
        self.duration = self._clock.duration

    def _speed(self, x: np.ndarray, level: np.ndarray | float) -> np.ndarray:
        return np.sqrt(2 * (level + self._form.crest.below(x)) / self._form.inertia_past_crest(x))

    def begin(self, start: Start) -> float:
        """Return the time at the start [s], since the motion came into the first turn."""
        since = self._clock.time(start.past, len(self._levels) - 1 if self._uphill else 0)
        return self.duration - since if self._uphill else since

    def state(self, time: np.ndarray) -> State:
        """Return the state at times [s] since the motion came into the first turn."""
        x, turn = self._clock.phase(self.duration - time if self._uphill else time)
        speed = self._speed(x, self._levels[turn])
        return (turn - len(self._levels) + 1, x, -speed) if self._uphill else (turn, x, speed)


def _paths(start: Start) -> Iterator[tuple[int, Bounce | Turns, float]]:
    """Yield the paths of a motion that passes crests, with the number of their first turn, and their margin [J].

    The turn of the start has the number 0.
    """
    form, step, rise = start.form, start.form.crest.step, start.form.crest.rise
    level, turn, left, batch = start.level, 0, MOST_TURNS, _FEW
    ahead = start.level_ahead if start.past > 0 else level + step  # at the crest after this turn's, to all digits
    while start.phi_dot < 0 and level > rise and left:
        levels = level - step * np.arange(min(batch, left))
        levels, batch = levels[levels > rise], min(4 * batch, _BATCH)
        yield turn, Turns(form, levels[::-1], uphill=True), levels[-1]
        level, ahead, turn, left = levels[-1] - step, levels[-1], turn - len(levels), left - len(levels)
    if level <= rise:
        yield turn, Bounce(start, level), min(abs(level), ahead)
        level, turn = ahead, turn + 1
    while left:
        levels, batch = level + step * np.arange(min(batch, left)), min(4 * batch, _BATCH)
        yield turn, Turns(form, levels), level
        level, turn, left = levels[-1] + step, turn + len(levels), left - len(levels)


def _roll(start: Start, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the motion of a load that passes crests, and its margin, like `Start.move`."""
    latest, margin = float(np.max(time, initial=0.0)), math.inf
    if start.form.slope == 0:  # all turns are alike
        path = Turns(start.form, np.array([start.level]))
        turn, since = np.divmod(time + path.begin(start), path.duration)
        _require_until(latest, MOST_TURNS * path.duration, _TURNS)
        _, x, phi_dot = path.state(since)
        return TURN * turn + (x - start.past), phi_dot, start.level
    turned, phi_dot, begun, ended = np.empty_like(time), np.empty_like(time), None, -math.inf
    for first, path, level in _paths(start):
        begun = -path.begin(start) if begun is None else ended
        now, ended = time >= ended, begun + path.duration
        now &= time < ended
        if now.any():
            turn, x, phi_dot[now] = path.state(time[now] - begun)
            turned[now] = TURN * (first + turn) + (x - start.past)
        margin = min(margin, level)
        if ended > latest:
            break
    _require_until(latest, ended, _TURNS)
    return turned, phi_dot, margin


def _require_until(latest: float, end: float, most: str) -> None:
    if not latest <= end:
        raise ParameterError(
            f"an exact motion has at most {most}, which end at {end:.6g} s: time must be at most that, got {latest:g} s"
        )
