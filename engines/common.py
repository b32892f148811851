"""What the engines' files share: the can, how it is sampled, and how a file is called.

It needs Python alone. A file of an engine has `SETTINGS` and `roll`, and ends with `answer`, which
reads a question as JSON from the standard input and prints the motion as JSON.
"""

import importlib.metadata
import json
import math
import platform
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from typing import Any, NamedTuple

INTERVAL = 0.04
"""Time between two samples [s]: a whole number of timesteps of 4, 2, 1, 0.4 and 0.1 ms."""
ROLLS = 5
"""The number of rolls that are timed, unless they take longer than `LONG`."""
LONG = 6.0
"""Processor time [s] after which no other roll is timed."""


@dataclass(frozen=True)
class Case:
    """A can on an incline: x points downhill, y along the can, z away from the incline.

    The can begins with its axis at x = radius * phi0 and z = radius, and rolls without slip. Its
    centre of mass is `offset` away from the axis, nearest to the incline at phi = 0. phi turns
    about y and grows downhill.
    """

    radius: float  # [m]
    length: float  # [m]
    mass: float  # [kg]
    offset: float  # [m]
    inertia: float
    """Moment of inertia about the centre of mass, around y [kg m^2]."""
    cross_inertia: float
    """The same around the other two axes [kg m^2]; it does not matter as long as the can rolls."""
    gravity_x: float  # [m/s^2]
    gravity_z: float  # [m/s^2]
    friction: float
    phi0: float  # [rad]
    phi_dot0: float  # [rad/s]
    duration: float  # [s]
    scale: float = 1.0
    """The number of length units in a metre; `scaled` changes it."""

    def scaled(self, scale: float) -> "Case":
        """Return the case in another unit of length: some engines are made for things of size 1."""
        return replace(
            self,
            scale=scale,
            radius=scale * self.radius,
            length=scale * self.length,
            offset=scale * self.offset,
            inertia=scale**2 * self.inertia,
            cross_inertia=scale**2 * self.cross_inertia,
            gravity_x=scale * self.gravity_x,
            gravity_z=scale * self.gravity_z,
        )

    @property
    def u0(self) -> float:
        """Return the place of the axis at the start, x [m]."""
        return self.radius * self.phi0

    @property
    def u_dot0(self) -> float:
        """Return the speed of the axis at the start [m/s]."""
        return self.radius * self.phi_dot0

    @property
    def centre(self) -> tuple[float, float]:
        """Return x and z of the centre of mass at the start [m]."""
        x = self.u0 - self.offset * math.sin(self.phi0)
        z = self.radius - self.offset * math.cos(self.phi0)
        return x, z

    @property
    def centre_velocity(self) -> tuple[float, float]:
        """Return the velocity of the centre of mass at the start along x and z [m/s]."""
        along = (self.radius - self.offset * math.cos(self.phi0)) * self.phi_dot0
        away = self.offset * math.sin(self.phi0) * self.phi_dot0
        return along, away


@dataclass(frozen=True)
class Setting:
    """A way to use an engine."""

    shape: str
    name: str
    """"default", or what is tuned in a few words."""
    about: str = ""
    """What differs from the engine's defaults, and why."""
    values: dict[str, Any] = field(default_factory=dict)
    """What `roll` reads."""

    @property
    def tuned(self) -> bool:
        """Return whether anything differs from the engine's defaults."""
        return self.name != "default"


class State(NamedTuple):
    """What is read from an engine at a sample, in the case's unit of length."""

    phi: float
    """Angle [rad]; a whole number of turns may lack."""
    u: float
    """Place of the axis, x [m]."""
    phi_dot: float  # [rad/s]
    u_dot: float  # [m/s]
    lateral: float = 0.0
    """Place of the axis along the can, y [m], which should be 0."""


@dataclass
class Motion:
    """Samples of a motion in metres, each `INTERVAL` after the one before, and how long it took."""

    time: list[float] = field(default_factory=list)
    phi: list[float] = field(default_factory=list)
    u: list[float] = field(default_factory=list)
    phi_dot: list[float] = field(default_factory=list)
    u_dot: list[float] = field(default_factory=list)
    lateral: list[float] = field(default_factory=list)
    seconds: float = 0.0
    """Processor time of the steps alone [s]: nothing that is built, compiled or read."""

    def add(self, state: State, scale: float = 1.0) -> None:
        """Add a sample. Its whole turns are those that the rates before and now lead to."""
        phi = state.phi
        if self.phi:
            turned = INTERVAL * (self.phi_dot[-1] + state.phi_dot) / 2
            phi += math.tau * round((self.phi[-1] + turned - phi) / math.tau)
        self.time.append(len(self.time) * INTERVAL)
        self.phi.append(float(phi))
        self.u.append(float(state.u) / scale)
        self.phi_dot.append(float(state.phi_dot))
        self.u_dot.append(float(state.u_dot) / scale)
        self.lateral.append(float(state.lateral) / scale)


def sampled(
    case: Case, timestep: float, advance: Callable[[int], Any], read: Callable[[], State]
) -> Motion:
    """Return the motion of an engine that `advance` steps so many times, and `read` samples."""
    steps = round(INTERVAL / timestep)
    motion = Motion()
    motion.add(read(), case.scale)
    for _ in range(round(case.duration / INTERVAL)):
        begin = time.process_time()
        advance(steps)
        motion.seconds += time.process_time() - begin
        motion.add(read(), case.scale)
    return motion


def repeated(step: Callable[[], Any]) -> Callable[[int], None]:
    """Return a function that calls `step` so many times."""

    def advance(steps: int) -> None:
        for _ in range(steps):
            step()

    return advance


def about_y(x_axis: tuple[float, float]) -> float:
    """Return the angle about y [rad] of a body whose own x axis has these x and z in the world."""
    x, z = x_axis
    return math.atan2(-z, x)


def _samples(motion: Motion) -> dict[str, list[float]]:
    return {name: values for name, values in asdict(motion).items() if name != "seconds"}


def answer(
    name: str,
    settings: list[Setting],
    roll: Callable[[Case, float, Setting], Motion],
    packages: tuple[str, ...],
) -> None:
    """Answer the question on standard input.

    An empty question is about the settings. Any other one has a case, a timestep [s], the index of
    a setting, and how far aside of the case's start [rad] a second motion begins. The first roll,
    in which an engine may compile, is not timed.
    """
    question = json.loads(sys.stdin.read() or "{}")
    if not question:
        told: dict[str, Any] = {
            "name": name,
            "settings": [asdict(setting) | {"tuned": setting.tuned} for setting in settings],
            "versions": {word: importlib.metadata.version(word) for word in packages},
            "python": platform.python_version(),
        }
    else:
        case = Case(**question["case"])
        timestep = question["timestep"]
        setting = settings[question["setting"]]
        motion = roll(case, timestep, setting)
        aside = roll(replace(case, phi0=case.phi0 + question["aside"]), timestep, setting)
        seconds = [aside.seconds]
        while len(seconds) < ROLLS and sum(seconds) < LONG:
            seconds.append(roll(case, timestep, setting).seconds)
        told = {"motion": _samples(motion), "aside": _samples(aside), "seconds": seconds}
    print("\n" + json.dumps(told))
