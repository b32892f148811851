"""The summary of a trajectory: one table, from which its text and its JSON are written."""

import json
import math
from collections.abc import Generator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mjbeer.checks import json_values
from mjbeer.drawing.words import damping_in_words
from mjbeer.exceptions import MjbeerError
from mjbeer.model.setting import FRICTION
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_EQUATIONS = {  # which equations a motion solves, by how the can rolls
    "exact": "rolling, by theory",
    "reduced": "rolling, in reduced coordinates",
    "equality": "rolling, by a joint equality",
    "contact": "a soft contact with friction",
}
KeyFigure = tuple[str, Any, str, str]
"""A name, a value, its unit, and how text shows it: as a format, or in words where it is none."""


@dataclass(frozen=True, eq=False)
class Summary:
    """The key figures of a trajectory, and until when a can would roll with some coefficients of friction."""

    trajectory: Trajectory
    friction: float = FRICTION  # the coefficient of friction that was asked for; besides it, the summary has that of 1

    @cached_property
    def rolls_until(self) -> Mapping[float, float]:
        """Return until when [s] rolling is possible at each coefficient of friction; infinity is to the end."""
        needed = self.trajectory.record.needed_friction
        # Where rolling needs no more than there is, this saves the run that looks for the first time at which it does.
        return {
            friction: math.inf if needed <= friction else self.trajectory.rolls_until(friction)
            for friction in sorted({FRICTION, self.friction})
        }

    @property
    def notes(self) -> tuple[str, ...]:
        """Return what a real can would do otherwise although the run is right: a sentence, or none.

        In contact the can simply slips, and the run's own warnings say so.
        """
        slips = {friction: until for friction, until in self.rolls_until.items() if math.isfinite(until)}
        if self.trajectory.rolling == "contact" or not slips:
            return ()
        times = [f"from t = {until:.6g} s with a friction coefficient of {each:g}" for each, until in slips.items()]
        return (f"a real can would slip {', '.join(times)}",)

    @cached_property
    def key_figures(self) -> tuple[KeyFigure, ...]:
        """The figures in the order of the text."""
        run, radius = self.trajectory, self.trajectory.scene.can.radius
        slip, lift, normal = run.slip / radius, run.lift / radius, run.forces.normal
        solved = not run.solver_warnings
        rolls = run.rolling == "contact" or math.isinf(self.rolls_until[self.friction])
        holds = rolls and not (run.rolling_warnings or run.liquid_warnings)
        scale = "the swing's largest kinetic energy" if run.scene.load.offset else "the largest kinetic energy"
        until = self.rolls_until.items()
        frictions = [{"friction coefficient": of, "to the end": math.isinf(end), "until [s]": end} for of, end in until]
        ends = [f"until t = {end:.6g} s with friction {of:g}" for of, end in until]
        in_words = f"\n{'':<32}".join(ends).replace("until t = inf s", "to the end")
        return (
            ("rolling", run.rolling, "", "{}"),
            ("integrator", run.integrator, "", "{}"),
            ("timestep", run.timestep, "s", "{:.6g}"),
            ("samples", len(run.time), "", "{}"),
            ("end", run.time[-1], "s", "{:.6g}"),
            ("phi at the end", math.degrees(run.phi[-1]), "degrees", "{:.9g}"),
            ("u at the end", run.u[-1], "m", "{:.9g}"),
            ("energy drift", run.energy_drift, "", f"{{:.2e}} of {scale}"),
            ("largest slip", np.abs(slip).max(), "radii", "{:.2e}"),
            ("final slip", slip[-1], "radii", "{:.2e}"),
            ("lowest lift", lift.min(), "radii", "{:.2e}"),
            ("highest lift", lift.max(), "radii", "{:.2e}"),
            ("least normal force needed", normal.min(), "N", "{:.4g}"),
            ("largest normal force needed", normal.max(), "N", "{:.4g}"),
            ("friction coefficient needed", run.record.needed_friction, "", _needed(run)),
            ("can roll without slipping", frictions, "", in_words),
            *_steady(run.scene),
            ("estimated error of phi and u/a", run.error_estimate, "rad", "{:.2e}"),
            ("equations solved", solved, "", f"{'yes' if solved else 'no'}: those of {_EQUATIONS[run.rolling]}"),
            ("model holds", holds, "", "yes" if holds else "no"),
        )

    def text(self) -> str:
        """Return the figures as lines of text, without those that have no number to show."""
        lines = [
            f"{name:<31} {shown.format(value)} {unit}".rstrip() if "{" in shown else f"{name:<31} {shown}"
            for name, value, unit, shown in self.key_figures
            if "{" not in shown or json_values(value) is not None
        ]
        return "\n".join(lines) + "\n"

    def json(self) -> str:
        """Return the figures as a JSON object, with units in the names; what is not finite becomes null."""
        content = {f"{name} [{unit}]" if unit else name: value for name, value, unit, _ in self.key_figures}
        content |= {"warnings": self.trajectory.warnings, "notes": self.notes}
        return json.dumps(json_values(content), indent=2, allow_nan=False) + "\n"


def _needed(run: Trajectory) -> str:
    if math.isfinite(run.record.needed_friction):
        return "{:.4g} to roll to the end without slipping"
    ends = f"N < 0 from t = {run.record.rolling_ends_at:.6g} s"
    return f"none is enough: {ends if math.isfinite(run.record.rolling_ends_at) else 'nothing presses (N = 0)'}"


def _steady(scene: Scene) -> Generator[KeyFigure]:
    """Yield what takes energy from a motion, and the steady rolling to which it may come."""
    if not scene.dissipates:
        return
    yield "damping torque over slip rate", damping_in_words(scene), "", "{}"
    yield "drag of the air", scene.drag, "kg/m", "{:.4g}"
    try:
        speed, tilt, roots = scene.terminal_speed(), math.degrees(scene.terminal_tilt()), scene.modes().tolist()
        reason = ""
    except MjbeerError as error:
        speed = tilt = roots = None
        reason, *_ = str(error).split(":")  # the first clause says what there is not
    yield "terminal speed", speed, "m/s", reason or "{:.6g}"
    yield "terminal tilt", tilt, "degrees", "{:.6g}"
    creep = [f"{root.real:.4g}" for root in roots or () if root.imag == 0]
    swing = [f"{root.real:.4g} +- {root.imag:.4g}i" for root in roots or () if root.imag > 0]
    pairs = [[root.real, root.imag] for root in roots] if roots else None
    yield "modes, real and imaginary parts", pairs, "1/s", f"{', '.join([*creep, *swing])} 1/s" if roots else "{}"
