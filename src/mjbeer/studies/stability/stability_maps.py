"""Maps of timestep and stiffness: how runs of stiff models end, measured and by linear theory.

Frozen beer in a can on level ground becomes stiffer with a harder constraint or with stronger
gravity. Beer that slides in a can of sheet metal becomes stiffer with stronger damping. MuJoCo's
motion and theory's begin with the same small swing, and are judged by the same rule.
"""

import json
import math
import pathlib
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, NamedTuple

import mujoco
import numpy as np

from mjbeer.checks.check import Check, Measured, Result
from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.mujoco_steps import MuJoCoSteps
from mjbeer.model.build import build, specify
from mjbeer.model.joints import joint_addresses
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Integrator
from mjbeer.output.plots import COLOURS
from mjbeer.output.terminal import Table
from mjbeer.studies import predictions
from mjbeer.studies.predictions import ACCURACY, GROWTH, SoftRow, spring
from mjbeer.studies.study import FAILED
from mjbeer.theory.can import Can
from mjbeer.theory.paper_scenes import frozen, sliding
from mjbeer.theory.scene import Scene

MAPS = "maps"
"""The group of the maps in the study."""
SHIPPED = pathlib.Path(__file__).with_name("maps.json")
"""The maps that come with mjbeer; `mjbeer stability` wrote them."""
CELLS = 20
"""Number of timesteps in a map, and of values."""
FEW_CELLS = 8
"""The same in a quick study."""
_AGREEMENT = 0.05
"""Largest relative difference between a measured border and the predicted one."""
RESOLUTION = 1.01
"""Bisection ends when the timesteps on both sides of a border have this ratio."""
EXPLODED = 0
INACCURATE = 1
ACCURATE = 2
"""Outcomes of a run, as digits for the cells of a map."""
_IMPEDANCE = 0.9
"""Impedance of the constraints, dmin and dmax of solimp: MuJoCo's default of dmin."""
_SWING = 1e-4
"""Angle from which the can is let go [rad]."""
_VIOLATION = 1e-7
"""Initial violation of the constraint, relative to `_SWING`.

It must be tiny, as a stiff constraint corrects it within one time constant: at tau = 1 ms, a
violation of 1e-4 would disturb the swing by 1 %.
"""
_STEPS = 1000
"""Least number of steps of a run: a violation that grows by 2 % a step is visible at its end."""
_ALL: tuple[Integrator, ...] = (*MUJOCO_INTEGRATORS, "DOP853")
PLANS: tuple[tuple[str, Integrator], ...] = (
    *(("solref", name) for name in _ALL),
    *(("direct", name) for name in _ALL if name not in ("implicit", "DOP853")),
    *(("gravity", name) for name in _ALL),
    *(("damping", name) for name in _ALL),
)
"""All maps, each by its family and its integrator.

The family is the cause of stiffness: an equality whose solref has a time constant ("solref") or a
stiffness ("direct"), "gravity" without a constraint, or "damping" between can and load.
"""
SHADES = {
    "explodes": "#E8A27C",
    f"stable, off by more than {100 * ACCURACY:g} %": "#A9D3EC",
    f"stable, off by less than {100 * ACCURACY:g} %": COLOURS[0],
}
"""The colours of the outcomes, which differ in hue and in brightness."""


class Border(NamedTuple):
    """The least timestep [s] at which runs explode; None if no run does."""

    measured: float | None
    predicted: float | None

    @property
    def difference(self) -> float:
        """Relative difference of the two: 0 if neither exists, 1 if only one of them does."""
        if self.measured is None and self.predicted is None:
            return 0.0
        if self.measured is None or self.predicted is None:
            return 1.0
        return abs(self.measured / self.predicted - 1)


@dataclass(frozen=True)
class StabilityMap:
    """How the runs of one family and one integrator ended, by timestep and value."""

    name: str
    """Family and integrator."""
    worst: float
    """Largest relative difference of a measured and a predicted border."""
    family: str
    integrator: str
    same: float
    """Share of the cells whose outcome was predicted."""
    timesteps: list[float]
    """[s]"""
    values: list[float]
    """The values of the family's quantity."""
    measured: list[str]
    """A string for each value, with a digit for each timestep: the outcome."""
    boundaries: list[Border]
    """The border for each value."""


@dataclass(frozen=True)
class StoredMaps:
    """Maps, with the study that they belong to."""

    command: str
    settings: dict[str, Any]
    machine: dict[str, Any]
    date: str
    maps: list[StabilityMap]


class Family(NamedTuple):
    """Maps that one figure shows side by side."""

    timesteps: tuple[float, float]
    """The least and the largest timestep [s]."""
    values: tuple[float, float]
    label: str
    """The quantity that varies, with its unit."""
    power: float
    """The limit of stability is a timestep times the value to this power, where it is a law."""
    law: str
    """That limit in letters, with {} for its number."""
    title: str
    caption: str


FAMILIES = {
    "solref": Family(
        (1e-4, 1.0),
        (1e-4, 1e-1),
        "time constant of solref [s]",
        -1.0,
        "{} τ",
        "A stiffer constraint needs a shorter timestep, except under discrete",
        "A joint equality with refsafe off: time constant τ of solref against timestep h.",
    ),
    "direct": Family(
        (1e-5, 1.0),
        (1e2, 1e10),
        "stiffness K of solref [1/s²]",
        0.5,
        "{}/√K",
        "A stiffer direct solref needs a shorter timestep, except under discrete",
        "K of solref = (−K, −2√K), which refsafe does not touch, against timestep h.",
    ),
    "gravity": Family(
        (1e-3, 10.0),
        (1e-3, 1e3),
        "gravity [m/s²]",
        0.5,
        "{} √(1 m/g)",
        "Gravity limits the timestep of every integrator, the implicit ones as well",
        "A can that swings without a constraint: gravity g against timestep h.",
    ),
    "damping": Family(
        (2.5e-4, 1.6e-2),
        (1e-4, 1e1),
        "damping [N m s]",
        1.0,
        "{} N m s²/c",
        "Damping limits the timestep of explicit integrators alone",
        "No constraint: damping c against timestep h, for half a metal can of beer. "
        "Real liquids have at most 0.02 N m s.",
    ),
}


class Swings:
    """Swings of one family with one integrator and one value of the family's quantity.

    A swing that grows beyond `GROWTH` times its start has exploded, and one whose error exceeds
    `ACCURACY` in the first half period is inaccurate.
    """

    def __init__(self, family: str, integrator: Integrator, value: float) -> None:
        self._integrator = integrator
        self._row = None
        if family in ("solref", "direct"):
            scene = frozen(0.0)
            self._row = _soft_row(family, value)
            self._model = _model_with_equality(scene, integrator, family, value)
        elif family == "damping":
            scene = sliding(0.0, can=Can.sheet_metal(), damping=value)
            self._model = build(scene, "reduced", integrator=integrator)
        else:
            scene = frozen(0.0, gravity=value)
            self._model = build(scene, "reduced", integrator=integrator)
        self._frequency = scene.frequency()
        self._exact = predictions.small_motion(scene)
        constrained = self._row is not None
        self._theory = predictions.small_motion(scene, constrained=constrained)
        self._start = np.zeros(self._model.nq + self._model.nv)
        for name, place in joint_addresses(self._model).items():
            distance = scene.can.radius * (1 + _VIOLATION)
            self._start[place] = _SWING * (distance if name == "slide" else 1.0)

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome."""
        self._model.opt.timestep = timestep
        times = timestep * np.arange(self._steps(timestep) + 1)
        data = mujoco.MjData(self._model)
        if self._integrator == "DOP853":
            method = DOP853(Dynamics(self._model, data), timestep)
        else:
            method = MuJoCoSteps(self._model, data, [timestep], self._integrator)
        try:
            states = method.run(self._start, times)
        except DivergenceError:
            return EXPLODED
        return self._judge(states, timestep)

    def predict(self, timestep: float) -> int:
        """Return the outcome by linear theory: the start times the powers of one step's matrix."""
        matrix = self._theory.step(self._integrator, timestep, self._row)
        unit = np.repeat([1.0, timestep], self._model.nq)
        states = predictions.motion(matrix, self._start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, timestep)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(math.pi / (self._frequency * timestep)))

    def _judge(self, states: np.ndarray, timestep: float) -> int:
        """Return the outcome of a run with these states at its timesteps."""
        count = self._model.nq
        with np.errstate(invalid="ignore"):
            bounded = np.abs(states[:, :count]) < GROWTH * self._start[:count]
        if not bounded.all():
            return EXPLODED
        phase = self._frequency * timestep  # advance of the swing in a timestep [rad]
        half_period = max(1, math.floor(math.pi / phase))  # in timesteps
        simulated = states[: half_period + 1] / _SWING
        # In the model as in theory, phi is the last of the coordinates.
        phi = len(self._exact.mass) - 1
        unit_start = np.eye(2 * phi + 2)[phi]
        exact = predictions.motion(self._exact.exact(timestep), unit_start, half_period)
        phi_error = simulated[:, count - 1] - exact[:, phi]
        rate_error = simulated[:, -1] / self._frequency - exact[:, -1] / phase
        if np.hypot(phi_error, rate_error).max() < ACCURACY:
            return ACCURATE
        return INACCURATE


def _soft_row(family: str, value: float) -> SoftRow:
    """Return the row for theory, of a time constant [s] or a direct stiffness [1/s^2]."""
    if family == "direct":
        return predictions.direct(value, _critical(value), _IMPEDANCE)
    return spring(value, 1.0, _IMPEDANCE)


def _model_with_equality(
    scene: Scene, integrator: Integrator, family: str, value: float
) -> mujoco.MjModel:
    """Return MuJoCo's model with an equality that has the same row."""
    spec = specify(scene, "equality", integrator=integrator)
    for constraint in spec.equalities:
        constraint.solref = (-value, -_critical(value)) if family == "direct" else (value, 1.0)
        constraint.solimp[:2] = _IMPEDANCE
    return spec.compile()


def _critical(stiffness: float) -> float:
    """Return the damping [1/s] that is critical for a direct stiffness [1/s^2]."""
    return 2 * math.sqrt(stiffness)


def checks(cells: int = CELLS) -> list[Check]:
    """Return a check for each map, which has so many timesteps and as many values."""
    reason = "bisection to 1 %, and an instability has to grow before it is seen"
    listed = []
    for family, integrator in PLANS:
        measured = partial(measured_map, family, integrator, cells)
        name = _name(family, integrator)
        listed.append(Check(MAPS, name, measured, "", _AGREEMENT, "relative", reason))
    return listed


def _name(family: str, integrator: str) -> str:
    """Return the name of a map."""
    return f"{family}, {integrator}"


def measured_map(family: str, integrator: Integrator, cells: int) -> Measured:
    """Return a map as a check measures it: its worst border, and the rest as values."""
    found = measure(family, integrator, cells)
    values = asdict(found)
    del values["worst"]
    del values["name"]
    return Measured(found.worst, values)


def measure(family: str, integrator: Integrator, cells: int) -> StabilityMap:
    """Return how runs end at so many timesteps and as many values."""
    ranges = FAMILIES[family]
    timesteps = np.geomspace(*ranges.timesteps, cells).tolist()
    values = np.geomspace(*ranges.values, cells).tolist()
    measured = []
    borders = []
    as_predicted = []
    for value in values:
        swings = Swings(family, integrator, value)
        outcomes = [swings.measure(timestep) for timestep in timesteps]
        predicted = [swings.predict(timestep) for timestep in timesteps]
        measured.append("".join(str(outcome) for outcome in outcomes))
        as_predicted.append(np.equal(outcomes, predicted))
        borders.append(
            Border(
                _first_explosion(swings.measure, timesteps, outcomes),
                _first_explosion(swings.predict, timesteps, predicted),
            )
        )
    return StabilityMap(
        name=_name(family, integrator),
        worst=max(border.difference for border in borders),
        family=family,
        integrator=integrator,
        same=float(np.mean(as_predicted)),
        timesteps=timesteps,
        values=values,
        measured=measured,
        boundaries=borders,
    )


def _first_explosion(
    outcome: Callable[[float], int], timesteps: list[float], outcomes: list[int]
) -> float | None:
    """Return the least timestep [s] that explodes, by bisection below the first that did."""
    if EXPLODED not in outcomes:
        return None
    place = outcomes.index(EXPLODED)
    if place == 0:
        return timesteps[0]
    low = timesteps[place - 1]
    high = timesteps[place]
    while high / low > RESOLUTION:
        middle = math.sqrt(low * high)
        if outcome(middle) == EXPLODED:
            high = middle
        else:
            low = middle
    return math.sqrt(low * high)


def table(results: Sequence[Result]) -> Table:
    """Return a table of how the runs of each map ended, and how well theory predicted it."""
    lines = []
    for result in results:
        cells = "".join(result.values["measured"])
        counts = [str(cells.count(str(outcome))) for outcome in range(len(SHADES))]
        error = "-" if result.error is None else f"{result.error:.1%}"
        same = f"{result.values['same']:.1%}"
        lines.append((result.name, *counts, same, error + FAILED[result.passed]))
    columns = ("map", *SHADES, "cells as predicted", "border off by")
    return Table("Maps of timestep", columns, lines)


def from_result(result: Result) -> StabilityMap:
    """Return the map that a check has measured."""
    assert result.error is not None, "every map has a worst border"
    return _from_json({"name": result.name, "worst": result.error, **result.values})


def _from_json(row: dict[str, Any]) -> StabilityMap:
    """Return a map from its row in a document."""
    return StabilityMap(
        name=row["name"],
        worst=row["worst"],
        family=row["family"],
        integrator=row["integrator"],
        same=row["same"],
        timesteps=row["timesteps"],
        values=row["values"],
        measured=row["measured"],
        boundaries=[Border(*pair) for pair in row["boundaries"]],
    )


def load(path: pathlib.Path = SHIPPED) -> StoredMaps:
    """Return the maps in the file that a study wrote."""
    content = json.loads(path.read_text(encoding="utf-8"))
    maps = [_from_json(row) for row in content[MAPS]]
    return StoredMaps(
        command=content["command"],
        settings=content["settings"],
        machine=content["machine"],
        date=content["date"],
        maps=maps,
    )


def summary(maps: Sequence[StabilityMap]) -> tuple[int, float]:
    """Return the number of runs in maps, and the largest relative error of a border."""
    runs = sum(len(row) for one_map in maps for row in one_map.measured)
    return runs, max(one_map.worst for one_map in maps)
