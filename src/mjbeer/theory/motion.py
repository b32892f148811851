"""The motion phi(t) of one degree of freedom without damping, to rounding.

**The problem.** Energy is conserved,

    J(phi) phi_dot^2 / 2 + V(phi) = E,    and therefore    dt = sqrt(J / (2 (E - V))) dphi.

The time along a motion is an integral, and phi(t) is its inverse. `TravelTime` computes both, if
the integrand is smooth and positive. This module cuts each motion into legs on which it is, and
keeps the digits of E - V.

**Two kinds of path** are enough.

- An `Arc` leads to a turning point phi_t and back. There E - V = 0, and the integrand is infinite.
  With phi = phi_t + s^2, or phi_t - s^2, |dphi| is 2 s ds, and E - V = V(phi_t) - V(phi) is
  s^2 |torque|, where `torque` is the mean of -V' between phi_t and phi. The factor s cancels:

      dt/ds = 2 s sqrt(J / (2 s^2 |torque|)) = sqrt(2 J / |torque|).

- `Turns` are whole turns in a row, each with a crest of V in its middle. There E - V is positive
  throughout. If it is `energy` at the crest, then at the angle x past the crest

      dt/dx = sqrt(J / (2 (energy + V(crest) - V(crest + x)))).

**Three kinds of motion** are made of them. A swing is two arcs that meet at the equilibrium, again
and again. A rotation on level ground is one turn, again and again. On a slope a load climbs in
turns until its energy no longer suffices, turns round in an arc, and rolls down in turns for ever;
a load that starts downhill does only the last part of this. (`docs/physics.md` has a figure.)

**One reflection.** All of this is written for a ramp that makes phi grow, and on level ground for a
rotation with phi_dot > 0. Other motions are reflected when they start, in `Launch.of`, and
reflected back at the end of `solve`.

**Digits.** Beside a separatrix the load hesitates near a crest, the longer the smaller |E - V| is
there: the time grows as its logarithm. This energy is a small difference of large numbers. It keeps
its digits because angles are measured from the nearest crest or rest, and `Potential` has the
differences of V from there. What remains is the rounding of the scene and of the start themselves.
A motion that this may change noticeably is refused.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Literal, NamedTuple

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.oscillator import Oscillator, Potential, root
from mjbeer.theory.travel_time import EPS, TravelTime

ROUNDINGS = 4 * EPS
"""Relative error of J and of ramp / depth: up to nine roundings, but never all of one sign."""
UNCERTAIN = 1e-4
"""Largest effect of rounding on phi [rad], relative beyond 1 rad.

It is a hundredth of the error that a trusted run may have."""
_STILL = 1e-30
"""Largest distance from the equilibrium, and amplitude of a swing about it [rad], that are taken for rest.

It is far below the rounding of any angle, and far above where the squares of angles underflow."""
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
            effect = _rounding_delay(launch, course.margin, latest) * fastest
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
    """Return the period [s] of a swing.

    It is released from rest `amplitude` [rad] away from the equilibrium.

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
                delay = _rounding_delay(launch, margin, duration)
            if delay <= UNCERTAIN * duration:
                return duration
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is not inside the separatrix, or too near it for doubles: "
        f"released from rest, the load swings about its equilibrium only for amplitudes between "
        f"{lowest:.6g} and {highest:.6g} rad"
    )


# The start of a motion


@dataclass(frozen=True)
class Launch:
    """The start of a motion, after the reflection.

    A turn has a crest in its middle. A well lies between two crests and has a rest, the
    equilibrium; where the ramp exceeds the depth, there is none. The angles past crest and rest
    keep their digits beside them.
    """

    oscillator: Oscillator
    """The reflected one where `direction` is -1."""
    direction: int
    """1, or -1 if phi and phi_dot have the opposite sign here."""
    phi: float
    """[rad]"""
    phi_dot: float
    """[rad/s]"""
    kinetic: float
    """Kinetic energy [J]."""
    past_crest: float
    """How far phi is past the crest of its turn [rad]."""
    past_rest: float
    """How far phi is past the rest of its well [rad]."""

    @classmethod
    def of(cls, oscillator: Oscillator, phi: float, phi_dot: float) -> "Launch":
        """Return the start at `phi` [rad] with `phi_dot` [rad/s], reflected if need be."""
        direction = 1
        if oscillator.ramp < 0 or (oscillator.ramp == 0 and phi_dot < 0):
            oscillator = oscillator.mirrored
            direction = -1
        phi *= direction
        phi_dot *= direction
        # J is taken at phi itself: where it has a narrow minimum, rounding of the other two angles
        # would change it.
        kinetic = float(oscillator.kinetic_energy(phi, phi_dot))
        distances = oscillator.potential.distances(phi)
        return cls(oscillator, direction, phi, phi_dot, kinetic, *distances)

    @property
    def potential(self) -> Potential:
        """Return the shape of V."""
        return self.oscillator.potential

    @cached_property
    def energy_above_crest(self) -> float:
        """Return E - V at the crest of the turn [J]."""
        return self.kinetic - float(self.potential.below(self.past_crest))

    @cached_property
    def energy_above_next_crest(self) -> float:
        """Return E - V at the next crest downhill [J]; this may be the crest of the turn."""
        if self.past_crest < 0:
            return self.energy_above_crest
        past_next_crest = self.past_rest - self.potential.well
        if abs(past_next_crest) <= self.past_crest:
            return self.kinetic - float(self.potential.below(past_next_crest))
        return self.energy_above_crest + self.potential.drop_per_turn

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a crest."""
        return self.potential.well > 0 and self.energy_above_next_crest <= 0

    @property
    def is_still(self) -> bool:
        """Return whether the load rests in the equilibrium, or swings by less than doubles show."""
        if not self.swings:
            return False
        amplitude = math.sqrt(self.kinetic / self.potential.curvature)
        return max(abs(self.past_rest), amplitude) <= _STILL

    @property
    def stays(self) -> bool:
        """Return whether the load does not move, as far as doubles tell.

        It stays in the equilibrium, on a crest, or anywhere if nothing pulls it.
        """
        if self.is_still:
            return True
        if self.kinetic > 0 or self.potential.excess > 0:
            return False
        # The double of an odd multiple of pi is up to 0.64 eps off, that of a slope's top up to an
        # eps of pi.
        is_on_crest = abs(self.past_crest) <= EPS * max(abs(self.phi), math.pi)
        return is_on_crest or self.potential.depth == 0


# The motion as a sequence of legs


class Leg(NamedTuple):
    """A part of a motion."""

    path: "Arc | Turns"
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
    # The angles of legs are past the rest in a swing, and else past the crest of each turn.
    begin_angle = launch.past_rest if launch.swings else launch.past_crest
    latest = float(np.max(since, initial=0.0))
    delta_phi = np.full_like(since, math.nan)  # a time on no leg would not go unnoticed
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
    """Return the two legs of a swing, first that of the start; their angles are past the rest."""
    margin = -launch.energy_above_next_crest
    if margin == 0:
        raise NoLibrationError("the motion comes to rest on a crest")
    first = 1 if launch.past_rest >= 0 else -1
    return [Leg(_arc_of_swing(launch, side), 0, margin) for side in (first, -first)]


def _arc_of_swing(launch: Launch, side: int) -> "Arc":
    """Return the arc of a swing downhill (`side` is 1) or uphill (-1) of the rest.

    Its turning point is measured from the rest or from the crest of that side, whichever is nearer.
    """
    potential = launch.potential
    to_crest = potential.well if side > 0 else math.tau - potential.well  # from the rest
    # V looks the same upside down:
    # V(rest + side d) - V(rest) = V(crest) - V(crest - side d) = below(-side d).
    if launch.kinetic == 0 and side * launch.past_rest > 0:  # the turning point is the start itself
        is_near_rest = abs(launch.past_rest) <= abs(launch.past_crest)
        distance = abs(launch.past_rest if is_near_rest else launch.past_crest)
    else:
        above_rest = launch.kinetic + potential.below(-launch.past_rest)
        below_crest = -launch.energy_above_next_crest
        if side < 0:
            below_crest += potential.drop_per_turn
        is_near_rest = potential.below(-side * to_crest / 2) >= above_rest
        height = above_rest if is_near_rest else below_crest
        distance = root(lambda d: potential.below(-side * d) - height, 0.0, to_crest / 2)
    if is_near_rest:
        return Arc(launch.oscillator, "rest", side * distance, end=0.0)
    origin = side * to_crest
    return Arc(launch.oscillator, "crest", -side * distance, end=-origin, origin=origin)


def _legs_on_slope(launch: Launch) -> Iterator[Leg]:
    """Yield the legs of a motion that passes crests of a slope; angles are past a turn's crest."""
    potential = launch.potential
    drop = potential.drop_per_turn
    turn = 0
    # E - V at the crest of this turn, and at that of the next one downhill:
    energy = launch.energy_above_crest
    energy_ahead = launch.energy_above_next_crest if launch.past_crest > 0 else energy + drop

    # Up, in turns. The uphill edge of a turn may be higher than its crest.
    climbed = np.array([])  # E - V at the crest of each turn that is climbed
    if launch.phi_dot < 0:
        climbed = energy - drop * np.arange(MOST_TURNS)
        climbed = climbed[climbed > potential.edge_above_crest]
    for energies in _in_batches(climbed):
        turn -= len(energies)
        energy_ahead = float(energies[-1])
        energy = energy_ahead - drop
        yield Leg(Turns(launch.oscillator, energies[::-1], uphill=True), turn + 1, energy_ahead)

    # Round, in an arc.
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


def _arc_on_slope(launch: Launch, energy: float) -> "Arc":
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
    if energy > 0:  # it passes the crest uphill, and the well behind it, if there is one
        lowest = -math.pi
        highest = -potential.well
    turning_point = root(lambda x: potential.below(x) + energy, lowest, highest)
    return Arc(launch.oscillator, "crest", turning_point, end=math.pi)


# The two kinds of path


class Place(NamedTuple):
    """Where on a path a motion is at some times."""

    passage: np.ndarray
    """The turn of the path in which it is; the most uphill one is 0."""
    angle: np.ndarray
    """How far it is past the crest of that turn, or past the rest in a swing [rad]."""
    phi_dot: np.ndarray
    """[rad/s]"""


class Arc:
    """The path from an angle `end` to the turning point and back.

    Both are measured past a landmark, the crest or the rest [rad]. The angle of this landmark, as
    the angles of legs are counted, is `origin` [rad].
    """

    def __init__(
        self,
        oscillator: Oscillator,
        landmark: Literal["crest", "rest"],
        turning_point: float,
        end: float,
        origin: float = 0.0,
    ) -> None:
        self._oscillator = oscillator
        self._landmark = landmark
        self._turning_point = turning_point
        self._origin = origin
        self._side = 1 if end > turning_point else -1  # phi = turning point + side s^2
        length = abs(end - turning_point)
        self._travel_time = TravelTime(self._dt_ds, 0.0, math.sqrt(length))  # of the way back
        self.duration = 2 * self._travel_time.duration

    def _dt_ds(self, s: np.ndarray) -> np.ndarray:
        """Return sqrt(2 J / |mean torque|) [s]."""
        length = self._side * s**2
        past = self._turning_point + length
        potential = self._oscillator.potential
        phi = potential.rest + past
        if self._landmark == "crest":
            phi = potential.phi_at(past)
        return np.sqrt(2 * self._oscillator.inertia(phi) / self._mean_torque(length))

    def _mean_torque(self, length: np.ndarray | float) -> np.ndarray:
        """Return the size of the mean -V' [N m] along a `length` [rad] from the turning point."""
        turning_point = self._turning_point
        if self._landmark == "rest":  # V looks the same upside down
            turning_point = -turning_point
            length = -length
        return np.abs(self._oscillator.potential.mean_torque(turning_point, length))

    def time_of(self, launch: Launch) -> float:
        """Return how long this path had lasted when the motion started on it [s]."""
        past = launch.past_rest
        if self._landmark == "crest":
            past = launch.past_crest
            # The start may be counted from the crest ahead, and the path from the one behind: `Launch`
            # measures from the nearest crest; one turn further back is that of this arc.
            if past < 0 < self._turning_point:
                past += math.tau
        # The kinetic energy is E - V = s^2 |mean torque|.
        s = math.sqrt(launch.kinetic / float(self._mean_torque(past - self._turning_point)))
        since_turning = math.copysign(self._travel_time.time_at(s), self._side * launch.phi_dot)
        return self.duration / 2 + since_turning

    def place_at(self, time: np.ndarray) -> Place:
        """Return where the motion is at times [s] since the path began."""
        since_turning = time - self.duration / 2
        s, passage = self._travel_time.psi_at(np.abs(since_turning))
        angle = self._origin + (self._turning_point + self._side * s**2)
        # phi_dot = side 2 s ds/dt, and s falls before the turning point.
        phi_dot = self._side * np.copysign(2 * s / self._dt_ds(s), since_turning)
        return Place(passage, angle, phi_dot)


class Turns:
    """The path through whole turns in a row, downhill, or uphill with the time reversed.

    The `energies` are E - V at their crests [J]. They rise, as the ramp gives the load more in each
    turn downhill.
    """

    def __init__(self, oscillator: Oscillator, energies: np.ndarray, uphill: bool = False) -> None:
        self._oscillator = oscillator
        self._energies = energies
        self._uphill = uphill
        # A load that hardly passes the crest spends its time there. x = 0 is an edge of panels, as
        # doubles are dense beside it.
        self._travel_time = TravelTime(self._dt_dx, -math.pi, 0.0, math.pi)
        self.duration = self._travel_time.duration

    def _dt_dx(self, x: np.ndarray) -> np.ndarray:
        """Return 1 / speed [s] at angles `x` past the crests, of shape (turns, *x.shape)."""
        return 1 / self._speed(x, self._energies[:, None, None])

    def _speed(self, x: np.ndarray, energy: np.ndarray) -> np.ndarray:
        """Return |phi_dot| [rad/s] at angles `x` past a crest that is passed with `energy` [J]."""
        potential = self._oscillator.potential
        inertia = self._oscillator.inertia(potential.phi_at(x))
        return np.sqrt(2 * (energy + potential.below(x)) / inertia)

    def time_of(self, launch: Launch) -> float:
        """Return how long this path had lasted when the motion started on it [s]."""
        if self._uphill:
            lowest_turn = len(self._energies) - 1
            return self.duration - self._travel_time.time_at(launch.past_crest, lowest_turn)
        return self._travel_time.time_at(launch.past_crest)

    def place_at(self, time: np.ndarray) -> Place:
        """Return where the motion is at times [s] since the path began."""
        x, passage = self._travel_time.psi_at(self.duration - time if self._uphill else time)
        speed = self._speed(x, self._energies[passage])
        return Place(passage, x, -speed if self._uphill else speed)


# What rounding does to a motion


def _rounding_delay(launch: Launch, margin: float, latest: float) -> float:
    """Return a rough bound on the time [s] by which rounding delays a motion until `latest` [s].

    The motion passes, or misses, crests by an energy of at least `margin` [J].
    """
    potential = launch.potential
    if potential.depth == 0:  # V is a plane, which has no crest
        return ROUNDINGS * latest
    if potential.curvature == 0:
        # There is no barrier. The torque at the crest is the difference of ramp and depth, which
        # magnifies their rounding by depth / excess. Squared, this is on the safe side.
        ratio = potential.held_torque / potential.excess if potential.excess > 0 else math.inf
        return ROUNDINGS * ratio**2 * latest

    # If ramp / depth has a relative error, that of the curvature, sqrt(depth^2 - ramp^2), is
    # steep^2 times as large, and the lean of the crest, asin(ramp / depth), is off by steep times
    # the error.
    steep = potential.held_torque / potential.curvature
    curvature_error = ROUNDINGS * steep**2  # relative

    # The crest may be so far from where it is taken to be. On level ground it is at an odd multiple
    # of pi, from which `past_crest` is known to an eps.
    shift = ROUNDINGS * (abs(potential.bottom) + potential.lean + steep)
    shift += EPS * abs(launch.past_crest)
    torque = abs(float(potential.mean_torque(launch.past_crest, 0.0)))
    energy_error = ROUNDINGS * (launch.kinetic + abs(float(potential.below(launch.past_crest))))
    energy_error += torque * shift + potential.curvature * shift**2
    margin_error = energy_error / margin if margin > 0 else math.inf  # relative

    # Near a crest x grows as exp(lambda t), with lambda^2 = curvature / J. The load spends a time
    # of about log(1 / margin) / lambda there, which a relative error of the margin changes by that
    # error / lambda. Until `latest` it comes to some 1 + lambda latest crests at most.
    inertia = float(launch.oscillator.inertia(potential.phi_at(0.0)))
    crest_time = math.sqrt(inertia / potential.curvature)  # 1 / lambda [s]
    return (curvature_error + margin_error) * (crest_time + latest)
