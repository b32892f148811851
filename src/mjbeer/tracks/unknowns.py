"""The unknowns of a fit: their guesses, their bounds, and their variables in the solver."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.scene import Scene
from mjbeer.tracks.track import Track

FITTABLE = ("incline", "fill", "damping", "drag")
"""The parameters of a scene that can be fitted; "damping" is a factor on its own law."""
OF_MOTION = (*FITTABLE, "phi0")
"""The unknowns of the motion; the others say where, when and how the camera saw it."""
_MIDDLE = 1e3
"""The solver's variable at the guess.

The solver takes derivatives with steps that are 1e-6 of its variables. All steps are thus about
1e-3 of a large change.
"""
_LOG_RANGE = 100.0
"""The largest factor between a logarithmic unknown and its guess, up or down."""


class _Kind(NamedTuple):
    """What is known of an unknown before a track is seen: a large change of it, and its bounds."""

    scale: float
    low: float = -math.inf
    high: float = math.inf


_KINDS = {
    "incline": _Kind(math.radians(1), *require.INCLINE),  # [rad]
    "fill": _Kind(0.1, 0.01, 0.99),
    "damping": _Kind(1.0),
    "drag": _Kind(1e-3, 0.0, 1.0),  # [kg/m]
    "phi0": _Kind(0.2),  # [rad]
    "place": _Kind(0.02),  # [m]
    "released": _Kind(0.1),  # [s]
    "bend": _Kind(5e-3),  # [m]
    "scale": _Kind(0.02, 0.5, 2.0),
    "turned": _Kind(0.2),  # [rad]
}
"""All unknowns, in their order in the solver: those of the motion come first."""
NAMES = tuple(_KINDS)


class Measurement(NamedTuple):
    """A value that was measured besides the track, and its standard error."""

    value: float
    error: float


@dataclass(frozen=True)
class Unknown:
    """A value that a fit looks for.

    The solver's variable of it changes by 1 where the value changes by `scale`, which is a large
    change. Where the unknown is logarithmic, the value changes by the factor
    exp(scale / abs(guess)).
    """

    name: str
    guess: float
    scale: float
    low: float
    high: float
    log: bool = False
    measured: Measurement | None = None

    def to_variable(self, value: float) -> float:
        """Return the solver's variable at a value."""
        change = value - self.guess
        if self.log:
            change = abs(self.guess) * math.log(value / self.guess)
        return _MIDDLE + change / self.scale

    def to_value(self, variable: float) -> float:
        """Return the value at a variable of the solver."""
        change = self.scale * (variable - _MIDDLE)
        if self.log:
            return self.guess * math.exp(change / abs(self.guess))
        return self.guess + change

    def to_error(self, value: float, deviation: float) -> float:
        """Return the standard error of a value whose variable has this standard deviation."""
        error = self.scale * deviation
        return error * value / self.guess if self.log else error


def make_unknowns(
    names: Collection[str], track: Track, scene: Scene, measured: Mapping[str, Measurement]
) -> tuple[Unknown, ...]:
    """Return the unknowns of these names, with guesses from the measurements and the scene.

    Raises:
      ParameterError: if the can of the track rolls up the scene's incline, or the measured damping
        is not positive.
    """
    guesses = {
        "incline": scene.incline,
        "fill": scene.load.fill or 0.0,
        "damping": 1.0,
        "drag": scene.drag,
        "scale": 1.0,
        "turned": 0.0 if track.roll is None else float(track.roll[0]),
    }
    for name, measurement in measured.items():
        guesses[name] = measurement.value
    if "damping" in names:
        require.positive("known damping", guesses["damping"])
    unknowns = []
    for name, kind in _KINDS.items():
        if name not in names:
            continue
        guess = guesses.get(name, 0.0)
        low = kind.low
        high = kind.high
        # A terminal speed depends on a ratio of powers of incline and damping.
        log = name == "damping" or (name == "incline" and scene.attachment == "sliding")
        if log:
            low = guess / _LOG_RANGE
            high = guess * _LOG_RANGE
        if log and name == "incline":
            _require_downhill(track, guess)
        if name == "released":
            low, high = _releases(track)
        unknown = Unknown(name, guess, kind.scale, low, high, log, measured.get(name))
        unknowns.append(unknown)
    return tuple(unknowns)


def _require_downhill(track: Track, incline: float) -> None:
    """Raise an error if the can of a track rolled up this incline."""
    distance = track.along[-1] - track.along[0]
    if incline * distance <= 0:
        uphill = "the can of this track does not roll down the scene's incline"
        raise ParameterError(f"{uphill}: turn the sign of one")


def _releases(track: Track) -> tuple[float, float]:
    """Return the earliest and the latest release [s]: the can moves at least in the last tenth."""
    end = float(track.time[-1])
    duration = float(np.ptp(track.time))
    return end - 4 * duration, end - 0.1 * duration


def to_variables(unknowns: Sequence[Unknown], values: Mapping[str, float]) -> np.ndarray:
    """Return the solver's variables at values of the unknowns."""
    return np.array([unknown.to_variable(values[unknown.name]) for unknown in unknowns])


def to_values(unknowns: Sequence[Unknown], variables: np.ndarray) -> dict[str, float]:
    """Return the values of the unknowns at variables of the solver."""
    pairs = zip(unknowns, variables.tolist(), strict=True)
    return {unknown.name: unknown.to_value(variable) for unknown, variable in pairs}


def in_words(name: str, value: float) -> str:
    """Return the value of an unknown with its unit, angles in degrees and lengths in mm."""
    if name in ("incline", "phi0", "turned"):
        return f"{math.degrees(value):.3g}°"
    if name in ("place", "bend"):
        return f"{1e3 * value:.2g} mm"
    return f"{value:.3g}"


def motion_slice(unknowns: Sequence[Unknown]) -> slice:
    """Return the slice of the unknowns of the motion, which come first."""
    return slice(sum(unknown.name in OF_MOTION for unknown in unknowns))


def distance_from_guess(unknowns: Sequence[Unknown], variables: np.ndarray) -> float:
    """Return the distance of the motion from its guess: a sum of changes, 1 for each large one."""
    changes = np.abs(variables - _MIDDLE)
    return float(changes[motion_slice(unknowns)].sum())
