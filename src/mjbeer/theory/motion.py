"""The motion phi(t) of one degree of freedom without damping, to rounding.

**The problem.** Energy is conserved,

    J(phi) phi_dot^2 / 2 + V(phi) = E,    and therefore    dt = sqrt(J / (2 (E - V))) dphi.

The time along a motion is an integral, and phi(t) is its inverse. `TravelTime` computes both, if
the integrand is smooth and positive. This module cuts each motion into legs on which it is, and
keeps the digits of E - V.

**Two kinds of path** are enough; `paths` has them.

- An `Arc` leads to a turning point and back. There E - V = 0, and the integrand is infinite; with
  another variable than phi it is not.
- `Turns` are whole turns in a row, each with a crest of V in its middle. There E - V is positive
  throughout.

**Three kinds of motion** are made of them. A swing is two arcs that meet at the equilibrium, again
and again. A rotation on level ground is one turn, again and again. On a slope a load climbs in
turns until its energy no longer suffices, turns round in an arc, and rolls down in turns for ever;
a load that starts downhill does only the last part of this. (`docs/physics.md` has a figure.)

**One reflection.** All of this is written for a ramp that makes phi grow, and on level ground for a
rotation with phi_dot > 0. Other motions are reflected when they start, in `launch`, and reflected
back at the end of `solve`.

**Digits.** Beside a separatrix the load hesitates near a crest, the longer the smaller |E - V| is
there: the time grows as its logarithm. This energy is a small difference of large numbers. It keeps
its digits because angles are measured from the nearest crest or rest, and `Potential` has the
differences of V from there. What remains is the rounding of the scene and of the start themselves.
A motion that this may change noticeably is refused.
"""

import math
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Literal, NamedTuple

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.launch import Launch, rounding_delay
from mjbeer.theory.oscillator import Oscillator, root
from mjbeer.theory.paths import Arc, Turns

UNCERTAIN = 1e-4
"""Largest effect of rounding on phi [rad], relative beyond 1 rad.

It is a hundredth of the error that a trusted run may have."""
MOST_TURNS = 10_000
"""Turns that are followed on a slope, where each takes another time."""


class SwingMotion(NamedTuple):
    """A motion at some times."""

    phi: np.ndarray
    """[rad]"""
    phi_dot: np.ndarray
    """[rad/s]"""


def solve(
    oscillator: Oscillator,
    time: np.ndarray,
    phi0: float,
    phi_dot0: float,
) -> SwingMotion:
    """Return the motion at the times `time` [s], none of them negative.

    Raises:
      NoLibrationError, ParameterError, ToleranceError: as `exact`.
    """
    launch = Launch.of(oscillator, phi0, phi_dot0)
    if launch.stays:
        return SwingMotion(np.full_like(time, phi0), np.zeros_like(time))
    latest = float(np.max(time, initial=0.0))
    try:
        # `TravelTime` refuses what is not finite.
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            course = _follow(launch, time)
            relative_rate = np.abs(course.phi_dot) / np.maximum(1, np.abs(course.delta_phi))
            fastest = float(np.max(relative_rate, initial=0.0))
            effect = rounding_delay(launch, course.margin, latest) * fastest
    except NoLibrationError:  # the motion comes to rest on a crest
        effect = math.inf
    if not effect <= UNCERTAIN:
        raise NoLibrationError(
            f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s is too near a separatrix, or the "
            f"motion too long: rounding may change phi by more than {UNCERTAIN:g} rad (relative "
            f"beyond 1 rad) until {latest:g} s"
        )
    return SwingMotion(
        phi=phi0 + launch.direction * course.delta_phi,
        phi_dot=launch.direction * course.phi_dot,
    )


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of a swing that is let go `amplitude` [rad] from the equilibrium.

    Raises:
      NoLibrationError, ToleranceError: as `Scene.period`.
    """
    rest = oscillator.equilibrium()
    lowest, highest = (angle - rest for angle in oscillator.separatrix())
    if lowest < amplitude < highest:
        launch = Launch.of(oscillator, rest + amplitude, 0.0)
        if launch.is_still:
            return math.tau / oscillator.frequency()
        margin = -launch.energy_above_next_crest
        if margin > 0:
            with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
                duration = sum(leg.path.duration for leg in _legs_of_swing(launch))
                delay = rounding_delay(launch, margin, duration)
            if delay <= UNCERTAIN * duration:
                return duration
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is not inside the separatrix, or too near it for doubles: "
        f"released from rest, the load swings about its equilibrium only for amplitudes between "
        f"{lowest:.6g} and {highest:.6g} rad"
    )


# The motion as a sequence of legs


class Leg(NamedTuple):
    """A part of a motion."""

    path: Arc | Turns
    turn: int
    """The number of its turn, or of its most uphill one; that of the start is 0."""
    margin: float
    """The least energy by which the motion passes, or misses, a crest there [J]."""


class Course(NamedTuple):
    """Where a motion is at some times."""

    delta_phi: np.ndarray
    """How far phi has turned since the start [rad]."""
    phi_dot: np.ndarray
    """[rad/s]"""
    margin: float
    """The least energy by which the motion passes, or misses, a crest [J]."""
    end: float
    """The end of the last leg, counted from the beginning of the first [s]."""


def _follow(launch: Launch, time: np.ndarray) -> Course:
    """Return the course of a motion at times [s] since its start."""
    if launch.swings:
        return _follow_periods(launch, _legs_of_swing(launch), 0.0, time)
    if launch.potential.ramp == 0:
        energy = launch.energy_above_crest
        turn = Leg(Turns(launch.oscillator, np.array([energy])), 0, energy)
        return _follow_periods(launch, [turn], math.tau, time)
    return _follow_slope(launch, time)


def _follow_periods(launch: Launch, legs: list[Leg], advance: float, time: np.ndarray) -> Course:
    """Return the course of a motion that repeats its `legs`, `advance` [rad] further each time."""
    since = time + _begin(legs[0], launch)
    periods, since = np.divmod(since, sum(leg.path.duration for leg in legs))
    course = _follow_legs(launch, legs, since)
    return course._replace(delta_phi=course.delta_phi + advance * periods)


def _follow_slope(launch: Launch, time: np.ndarray) -> Course:
    """Return the course of a motion on a slope that passes crests."""
    legs = _legs_on_slope(launch)
    first = next(legs)
    begin = _begin(first, launch)
    since = time + begin
    course = _follow_legs(launch, chain([first], legs), since)
    if not np.max(since, initial=0.0) < course.end:
        raise ParameterError(
            f"an exact motion on an incline has at most {MOST_TURNS} turns, which end at "
            f"{course.end - begin:.6g} s: time must be less, got {float(np.max(time)):g} s"
        )
    return course


def _begin(first: Leg, launch: Launch) -> float:
    """Return how long the first leg had lasted when the motion started on it [s]."""
    # At the edge of a turn rounding may make this negative, where there is no leg.
    return max(0.0, first.path.time_of(launch))


def _follow_legs(launch: Launch, legs: Iterable[Leg], since: np.ndarray) -> Course:
    """Return the course at times [s] since the first of the `legs` began, as far as they lead."""
    # In a swing the angles of legs are past the rest, otherwise past the crest of each turn.
    begin_angle = launch.past_rest if launch.swings else launch.past_crest
    latest = float(np.max(since, initial=0.0))
    # A time on no leg would stay NaN, and not go unnoticed.
    delta_phi = np.full_like(since, math.nan)
    phi_dot = np.full_like(since, math.nan)
    margin = math.inf
    end = 0.0
    for leg in legs:
        begin = end
        end = begin + leg.path.duration
        margin = min(margin, leg.margin)
        now = (begin <= since) & (since < end)
        if now.any():
            place = leg.path.place_at(since[now] - begin)
            delta_phi[now] = math.tau * (leg.turn + place.passage) + (place.angle - begin_angle)
            phi_dot[now] = place.phi_dot
        if latest < end:
            break
    return Course(delta_phi, phi_dot, margin, end)


def _legs_of_swing(launch: Launch) -> list[Leg]:
    """Return the two legs of a swing, that of the start first; their angles are past the rest."""
    margin = -launch.energy_above_next_crest
    if margin == 0:
        raise NoLibrationError("the motion comes to rest on a crest")
    side = 1 if launch.past_rest >= 0 else -1
    begin = Leg(_arc_of_swing(launch, side), 0, margin)
    return [begin, Leg(_arc_of_swing(launch, -side), 0, margin)]


def _arc_of_swing(launch: Launch, side: int) -> Arc:
    """Return the arc of a swing that begins and ends at the rest.

    Its turning point is downhill of the rest (`side` is 1) or uphill (-1).
    """
    well = launch.potential.well
    to_crest = well if side > 0 else math.tau - well  # from the rest
    turning_point = _turning_point_of_swing(launch, side, to_crest)
    distance = turning_point.distance
    if turning_point.landmark == "rest":
        return Arc(launch.oscillator, "rest", side * distance, end=0.0)
    crest = side * to_crest  # past the rest, which thus is at -crest past the crest
    return Arc(launch.oscillator, "crest", -side * distance, end=-crest, origin=crest)


class TurningPoint(NamedTuple):
    """Where a swing turns: between the rest and a crest, at a distance from the nearer of them."""

    landmark: Literal["rest", "crest"]
    distance: float
    """[rad]"""


def _turning_point_of_swing(launch: Launch, side: int, to_crest: float) -> TurningPoint:
    """Return the turning point on a side of the rest, with `to_crest` [rad] from rest to crest."""
    potential = launch.potential
    is_start = launch.kinetic == 0 and side * launch.past_rest > 0
    if is_start:
        from_rest = abs(launch.past_rest)
        from_crest = abs(launch.past_crest)
        if from_rest <= from_crest:
            return TurningPoint("rest", from_rest)
        return TurningPoint("crest", from_crest)
    halfway = to_crest / 2
    # E - V at the rest, which is V(turning point) - V(rest):
    above_rest = launch.kinetic + potential.rise(launch.past_rest)
    if potential.rise(side * halfway) >= above_rest:
        distance = root(lambda d: potential.rise(side * d) - above_rest, 0.0, halfway)
        return TurningPoint("rest", distance)
    # V - E at the crest, which is V(crest) - V(turning point):
    below_crest = -launch.energy_above_next_crest
    if side < 0:
        below_crest += potential.drop_per_turn
    distance = root(lambda d: potential.below(-side * d) - below_crest, 0.0, halfway)
    return TurningPoint("crest", distance)


def _legs_on_slope(launch: Launch) -> Iterator[Leg]:
    """Yield the legs of a motion that passes crests of a slope; angles are past a turn's crest.

    From a turn to the next one uphill, E - V at the crest falls by the `drop` of V in a turn.
    """
    potential = launch.potential
    drop = potential.drop_per_turn
    turn = 0
    energy = launch.energy_above_crest  # E - V at the crest of this turn
    energy_ahead = energy + drop  # the same of the next turn downhill
    if launch.past_crest > 0:
        energy_ahead = launch.energy_above_next_crest

    # Up, in turns. The uphill edge of a turn may be higher than its crest.
    climbed = np.array([])  # E - V at the crest of each turn that is climbed
    if launch.phi_dot < 0:
        climbed = energy - drop * np.arange(MOST_TURNS)
        climbed = climbed[climbed > potential.edge_above_crest]
    for energies in _in_batches(climbed):
        turn -= len(energies)
        uphill = Turns(launch.oscillator, energies[::-1], uphill=True)
        yield Leg(uphill, turn + 1, float(energies[-1]))
    if len(climbed) > 0:
        energy_ahead = float(climbed[-1])
        energy = energy_ahead - drop

    # Round, in an arc, unless the load is fast enough downhill from the start.
    if energy <= potential.edge_above_crest:
        yield Leg(_arc_on_slope(launch, energy), turn, min(abs(energy), energy_ahead))
        turn += 1
        energy = energy_ahead

    # Down, in turns.
    for energies in _in_batches(energy + drop * np.arange(MOST_TURNS - len(climbed))):
        yield Leg(Turns(launch.oscillator, energies), turn, float(energies[0]))
        turn += len(energies)


def _in_batches(energies: np.ndarray) -> Iterator[np.ndarray]:
    """Yield energies in batches of 8, 32, 128, and then 256.

    A short motion sets up few turns, and a long one takes no more memory for that.
    """
    begin = 0
    size = 8
    while begin < len(energies):
        yield energies[begin : begin + size]
        begin += size
        size = min(4 * size, 256)


def _arc_on_slope(launch: Launch, energy: float) -> Arc:
    """Return the arc round the highest point of a motion on a slope.

    At the crest of its turn E - V is `energy` [J].
    """
    potential = launch.potential
    if energy == 0 and potential.excess == 0:
        raise NoLibrationError("the motion comes to rest on a crest")
    if launch.kinetic == 0:  # the turning point is the start itself
        return Arc(launch.oscillator, "crest", launch.past_crest, end=math.pi)
    lowest = 0.0
    highest = math.pi
    if energy > 0:  # it turns on the uphill side of the crest, beyond the rest if there is one
        lowest = -math.pi
        highest = -potential.well
    turning_point = root(lambda x: potential.below(x) + energy, lowest, highest)
    return Arc(launch.oscillator, "crest", turning_point, end=math.pi)
