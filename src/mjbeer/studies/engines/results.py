"""Motions of a can in physics engines, and their errors against exact theory.

`tools/engines.py` makes the motions, with the files of the folder `engines`; this package calls no
engine.
"""

import json
import math
import pathlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

import numpy as np

from mjbeer.checks.as_json import to_json
from mjbeer.studies import can_test
from mjbeer.studies.can_test import CASES, DURATION, Case, Errors
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.trajectory import Trajectory

_HERE = pathlib.Path(__file__).parent
_OF_WHEEL = _HERE / "results.json"
_OF_CHECKOUT = _HERE.parents[3] / "engines" / "results.json"
RESULTS = _OF_WHEEL if _OF_WHEEL.is_file() else _OF_CHECKOUT
"""Where the results are: in a wheel, or in a checkout."""
FRICTION = 1.0
"""The coefficient of friction: neither case needs more than 0.39."""
ASIDE = 1e-9
"""How far from the case's start a second motion begins [rad]."""
SENSITIVE = 0.05
"""A row whose error changes by more than this share from a start aside is marked."""
TIMESTEPS = (4e-3, 2e-3, 1e-3, 4e-4, 1e-4)
"""The timesteps [s] that every engine is tried with."""
EQUATION = "SciPy"
"""The tool that is no engine: it integrates the equation of the motion."""
ERROR_CONTROL = "error control"
"""Part of the name of a setting that chooses its own steps."""
_FITTED = 1e-3
"""The longest timestep [s] of the fit of an order."""
_LARGE = 1.0
"""Where an error is no small one any more [rad]."""
_HELPS = 0.25
"""The least share by which the last timestep lowers the error of what converges; with less, the
error has a floor."""


def question(case: Case) -> dict[str, float]:
    """Return a case as the engines' files read it: `Case` in engines/common.py."""
    scene = case.scene
    can = scene.can
    load = scene.load
    return {
        "radius": can.radius,
        "length": can.length,
        "mass": load.mass,
        "offset": load.offset,
        "inertia": load.inertia,
        "cross_inertia": load.mass * (3 * can.radius**2 + can.length**2) / 12,
        "gravity_x": scene.gravity * math.sin(scene.incline),
        "gravity_z": -scene.gravity * math.cos(scene.incline),
        "friction": FRICTION,
        "phi0": case.phi0,
        "phi_dot0": case.phi_dot0,
        "duration": DURATION,
    }


@dataclass
class Motion:
    """Samples of what an engine did, in the units of `engines/common.py`."""

    time: list[float]
    phi: list[float]
    u: list[float]
    phi_dot: list[float]
    u_dot: list[float]
    lateral: list[float]

    def rounded(self) -> "Motion":
        """Return the motion with the digits that are stored, which are those that are judged."""
        digits = {"time": 9, "phi": 12, "u": 14, "phi_dot": 9, "u_dot": 10, "lateral": 9}
        lists: dict[str, list[float]] = {}
        for name, values in asdict(self).items():
            lists[name] = [round(value, digits[name]) for value in values]
        return Motion(**lists)


class Judgement(NamedTuple):
    """How far an engine's motion is from exact theory, at worst over its samples."""

    position: Errors
    energy: float
    """Largest change of the energy, divided by the largest kinetic energy of the exact motion."""
    slip: float
    """Largest distance that the can has slid, u - a phi [m]."""
    lateral: float
    """Largest distance from its lane [m]."""


def judge(case: Case, motion: Motion, aside: float = 0.0) -> Judgement:
    """Return how far a motion is from exact theory; infinitely far if it is no motion.

    It began so far `aside` of the case's start [rad].
    """
    numbers = np.array([motion.phi, motion.u, motion.phi_dot, motion.u_dot, motion.lateral])
    if not np.isfinite(numbers).all():
        return Judgement(Errors(math.inf, math.inf), math.inf, math.inf, math.inf)
    time = np.array(motion.time)
    phi, u, phi_dot, u_dot, lateral = numbers
    truth = case.truth(time, aside)
    still = np.zeros_like(time)
    found = Trajectory(
        scene=case.scene,
        phi0=case.phi0,
        phi_dot0=case.phi_dot0,
        time=time,
        phi=phi,
        u=u,
        phi_dot=phi_dot,
        u_dot=u_dot,
        roll=phi,
        roll_dot=phi_dot,
        lift=still,
        lift_dot=still,
    )
    largest = kinetic_energy(case.scene, truth).max()
    return Judgement(
        position=can_test.errors(truth, phi, u),
        energy=float(np.abs(found.energy - found.energy[0]).max() / largest),
        slip=float(np.abs(found.slip).max()),
        lateral=float(np.abs(lateral).max()),
    )


class CurveKey(NamedTuple):
    """What the rows of a curve share."""

    case: str
    engine: str
    shape: str
    setting: str


@dataclass
class Row:
    """A can in an engine with one setting and one timestep, and what came of it."""

    case: str
    engine: str
    """The engine's name."""
    shape: str
    setting: str
    """"default", or what is tuned in a few words."""
    tuned: bool
    timestep: float  # [s]
    phi_error: float = math.inf  # [rad]
    u_error: float = math.inf
    """Error of u/a [rad]."""
    energy_error: float = math.inf
    """Of the exact motion's largest kinetic energy."""
    slip: float = math.inf  # [m]
    lateral: float = math.inf  # [m]
    aside_error: float = math.inf
    """Largest error of phi and u/a of the motion that began `ASIDE` of the case's start [rad]."""
    seconds: list[float] = field(default_factory=list)
    """Processor times of the steps alone, of several runs [s]."""
    failure: str | None = None
    """Why there is no motion."""
    motion: Motion | None = None
    """What was judged."""

    @property
    def key(self) -> CurveKey:
        """The curve that the row is on."""
        return CurveKey(self.case, self.engine, self.shape, self.setting)

    @property
    def has_timestep(self) -> bool:
        """Whether all steps are the timestep, and not what a tolerance asks for."""
        return self.engine != EQUATION and ERROR_CONTROL not in self.setting

    @property
    def error(self) -> float:
        """The larger error of phi and u/a [rad]."""
        return max(self.phi_error, self.u_error)

    @property
    def is_sensitive(self) -> bool:
        """Whether a start that is `ASIDE` changes the error by more than `SENSITIVE`."""
        if not math.isfinite(self.error):
            return False
        keeps_its_error = abs(self.aside_error - self.error) <= SENSITIVE * self.error
        return not keeps_its_error  # nor does one whose other motion has no error

    def judged(self, motion: Motion, aside: Motion) -> None:
        """Take a motion, and the errors of it and of the one that began aside."""
        case = CASES[self.case]
        judgement = judge(case, motion.rounded())
        if not math.isfinite(judgement.position.largest):
            self.failure = "the motion explodes"
            return
        self.motion = motion.rounded()
        self.phi_error = judgement.position.phi
        self.u_error = judgement.position.u
        self.energy_error = judgement.energy
        self.slip = judgement.slip
        self.lateral = judgement.lateral
        self.aside_error = judge(case, aside, ASIDE).position.largest


class Order(NamedTuple):
    """How the error of a curve falls with the timestep, from 1 ms down."""

    order: float
    """The exponent p of error = C h^p that fits best."""
    floor: float
    """The least error of the curve [rad]."""
    converges: bool
    """Whether the last timestep still helps."""


def order_of(rows: Sequence[Row]) -> Order | None:
    """Return how the error of a curve falls, longest timestep first; None if it cannot be told.

    That takes three motions, and, unless there is a floor, errors that are all below or all above
    `_LARGE`: the fall from an explosion is no order. What has a tolerance has no order in a
    timestep.
    """
    fitted = [row for row in rows if row.timestep <= _FITTED and 0 < row.error < math.inf]
    if len(fitted) < 3 or not fitted[0].has_timestep:
        return None
    *_, before, last = fitted
    converges = last.error <= (1 - _HELPS) * before.error
    if converges and min(row.error for row in fitted) < _LARGE < max(row.error for row in fitted):
        return None
    timesteps = np.log([row.timestep for row in fitted])
    errors = np.log([row.error for row in fitted])
    slope, _ = np.polyfit(timesteps, errors, 1)
    return Order(float(slope), min(row.error for row in rows), converges)


@dataclass
class Engine:
    """An engine whose file was run."""

    name: str
    file: str
    """Its file in the folder `engines`, without .py."""
    digest: str
    """A sum of its file and of common.py, by which rows of an older file are known."""
    machine: dict[str, Any]
    """The machine that its rows were measured on."""
    versions: dict[str, str]
    """The versions of its packages."""
    python: str
    settings: list[dict[str, Any]]
    """Shape, name and what differs from the defaults, of each setting: `Setting`."""


@dataclass
class Results:
    """All rows, with the engines that they belong to."""

    engines: list[Engine] = field(default_factory=list)
    absent: dict[str, str] = field(default_factory=dict)
    """Why an engine could not be had, by its file."""
    rows: list[Row] = field(default_factory=list)

    @classmethod
    def load(cls, path: pathlib.Path = RESULTS) -> "Results":
        """Return the results in a file that `json` is in."""
        content = json.loads(path.read_text(encoding="utf-8"))
        engines = [Engine(**engine) for engine in content["engines"]]
        rows = []
        for stored in content["rows"]:
            known = {name: value for name, value in stored.items() if value is not None}
            row = Row(**known)
            if row.motion is not None:
                row.motion = Motion(**known["motion"])
            rows.append(row)
        return cls(engines, content["absent"], rows)

    def json(self) -> str:
        """Return the results as JSON, with a line for each row."""
        engines = [asdict(engine) for engine in self.engines]
        about = {"absent": self.absent, "engines": engines}
        head = to_json(about).removesuffix("}\n")
        lines = [to_json(asdict(row)).strip() for row in self.rows]
        return f'{head}, "rows": [\n' + ",\n".join(lines) + "\n]}\n"

    def drop(self, file: str, unless: str = "") -> None:
        """Forget the engine of a file, and its rows unless it has the digest `unless`."""
        for engine in self.engines:
            if engine.file == file and engine.digest != unless:
                self.rows = [row for row in self.rows if row.engine != engine.name]
        self.engines = [engine for engine in self.engines if engine.file != file]

    def sort(self) -> None:
        """Bring engines and rows into the order of names, settings and timesteps."""
        self.engines.sort(key=lambda engine: engine.name.lower())
        places = {}
        for engine in self.engines:
            for setting in engine.settings:
                places[engine.name, setting["shape"], setting["name"]] = len(places)
        self.rows.sort(key=lambda row: (row.case, places[row.key[1:]], -row.timestep))

    def curves(self, case: str) -> dict[CurveKey, list[Row]]:
        """Return the rows of a case by their curves, longest timestep first."""
        found: dict[CurveKey, list[Row]] = {}
        for row in sorted(self.rows, key=lambda row: -row.timestep):
            if row.case == case:
                found.setdefault(row.key, []).append(row)
        return found
