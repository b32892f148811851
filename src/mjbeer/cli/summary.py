"""The key figures of a trajectory: one table, from which its text and its JSON are written."""

import json
import math
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
    """The key figures of a trajectory, and until when a can would roll with a coefficient of friction."""

    trajectory: Trajectory
    friction: float = FRICTION

    @cached_property
    def rolls_until(self) -> float:
        """Until when [s] rolling is possible with that friction; infinity is to the end."""
        # Where rolling needs no more than there is, this saves the run that looks for the first time at which it does.
        enough = self.trajectory.record.needed_friction <= self.friction
        return math.inf if enough else self.trajectory.rolls_until(self.friction)

    @property
    def notes(self) -> tuple[str, ...]:
        """What a real can would do otherwise although the run is right: a sentence, or none.

        In contact the can simply slips, and the run's own warnings say so.
        """
        until = self.rolls_until
        slips = f"a real can would slip from t = {until:.6g} s with a friction coefficient of {self.friction:g}"
        return () if self.trajectory.rolling == "contact" or math.isinf(until) else (slips,)

    @cached_property
    def key_figures(self) -> tuple[KeyFigure, ...]:
        """The figures in the order of the text."""
        run, radius, until = self.trajectory, self.trajectory.scene.can.radius, self.rolls_until
        slip, lift, normal = run.slip / radius, run.lift / radius, run.forces.normal
        solved = not run.solver_warnings
        holds = not (run.rolling_warnings or run.liquid_warnings or self.notes)
        scale = "the swing's largest kinetic energy" if run.scene.load.offset else "the largest kinetic energy"
        end = "the end" if math.isinf(until) else f"t = {until:.6g} s"
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
            ("can roll without slipping until", until, "s", f"{end} with friction {self.friction:g}"),
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


def _steady(scene: Scene) -> list[KeyFigure]:
    """Return what takes energy from a motion, and the steady rolling to which it may come."""
    if not scene.dissipates:
        return []
    figures: list[KeyFigure] = [("damping torque over slip rate", damping_in_words(scene), "", "{}")]
    figures += [("drag of the air", scene.drag, "kg/m", "{:.4g}")]
    try:
        speed, tilt, roots = scene.terminal_speed(), math.degrees(scene.terminal_tilt()), scene.modes().tolist()
    except MjbeerError as error:  # its first clause says what there is not
        return [*figures, ("terminal speed", None, "m/s", str(error).partition(":")[0])]
    figures += [("terminal speed", speed, "m/s", "{:.6g}"), ("terminal tilt", tilt, "degrees", "{:.6g}")]
    pairs = [[root.real, root.imag] for root in roots]
    shown = ", ".join(f"{root:.4g}" if root.imag else f"{root.real:.4g}" for root in roots)
    return [*figures, ("modes, real and imaginary parts", pairs, "1/s", f"{shown} 1/s")]
