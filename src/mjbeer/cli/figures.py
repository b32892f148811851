"""The key figures of a trajectory: as lines of text, as JSON, and what they say of a real can."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mjbeer.exceptions import MjbeerError
from mjbeer.model.setting import FRICTION
from mjbeer.theory.named import damping_in_words
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Figures:
    """The key figures of a trajectory, and until when a can would roll with some coefficients of friction."""

    trajectory: Trajectory
    friction: float = FRICTION
    """The coefficient of friction that was asked for; besides it, the figures have that of 1."""

    @cached_property
    def rolls_until(self) -> Mapping[float, float]:
        """Return until when [s] rolling is possible at each coefficient of friction; infinity is to the end."""
        needed = self.trajectory.record.needed
        # Where rolling needs no more than there is, this saves the run that looks for the first time at which it does.
        return {
            friction: math.inf if needed <= friction else self.trajectory.rolls_until(friction)
            for friction in sorted({FRICTION, self.friction})
        }

    @property
    def notes(self) -> tuple[str, ...]:
        """Return what a real can would do otherwise although the run is right: a sentence, or none.

        A contact slips of itself, and the run's own warnings say so.
        """
        slips = {friction: until for friction, until in self.rolls_until.items() if math.isfinite(until)}
        if self.trajectory.rolling == "contact" or not slips:
            return ()
        times = ", ".join(
            f"from t = {until:.6g} s with a friction coefficient of {friction:g}" for friction, until in slips.items()
        )
        return (f"a real can would slip {times}",)

    def text(self) -> str:
        """Return the figures as lines of text."""
        trajectory, radius = self.trajectory, self.trajectory.scene.can.radius
        slip, lift, normal = trajectory.slip / radius, trajectory.lift / radius, trajectory.forces.normal
        facts = {
            "rolling, integrator": f"{trajectory.rolling}, {trajectory.integrator}",
            "samples": f"{len(trajectory.time)} to t = {trajectory.time[-1]:.6g} s",
            "phi at the end": f"{math.degrees(trajectory.phi[-1]):.9g} degrees",
            "u at the end": f"{trajectory.u[-1]:.9g} m",
            "energy drift": f"{trajectory.energy_drift:.2e} of {_scale(trajectory.scene)}",
            "slip, largest and final": f"{np.abs(slip).max():.2e}, {slip[-1]:.2e} radii",
            "lift, lowest and highest": f"{lift.min():.2e}, {lift.max():.2e} radii",
            "normal force needed": f"{normal.min():.4g} to {normal.max():.4g} N",
            "friction coefficient needed": _needed(trajectory.record),
        }
        for friction, until in self.rolls_until.items():
            end = "to the end" if math.isinf(until) else f"until t = {until:.6g} s"
            facts[f"with a coefficient of {friction:g}"] = f"can roll {end}"
        if trajectory.scene.dissipates:
            facts |= _in_the_end(trajectory.scene)
        if trajectory.error_estimate is not None:
            facts["estimated error of phi and u/a"] = f"{trajectory.error_estimate:.2e} rad"
        facts["trusted"] = "yes" if trajectory.trusted else "no"
        return "".join(f"{name:<30}  {value}\n" for name, value in facts.items())

    def json(self) -> str:
        """Return the figures as a JSON object, with units in the names; what is not finite becomes null."""
        trajectory, radius = self.trajectory, self.trajectory.scene.can.radius
        slip, lift, normal = trajectory.slip / radius, trajectory.lift / radius, trajectory.forces.normal
        figures = {
            "timestep [s]": trajectory.timestep,
            "samples": len(trajectory.time),
            "end [s]": trajectory.time[-1],
            "phi at the end [degrees]": math.degrees(trajectory.phi[-1]),
            "u at the end [m]": trajectory.u[-1],
            "energy drift": trajectory.energy_drift,
            "largest slip [radii]": np.abs(slip).max(),
            "final slip [radii]": slip[-1],
            "lowest lift [radii]": lift.min(),
            "highest lift [radii]": lift.max(),
            "least normal force needed [N]": normal.min(),
            "largest normal force needed [N]": normal.max(),
            "friction coefficient needed": trajectory.record.needed,
            "estimated error of phi and u/a [rad]": trajectory.error_estimate,
        }
        content = {
            "rolling": trajectory.rolling,
            "integrator": trajectory.integrator,
            **{name: _finite(value) for name, value in figures.items()},
            "can roll without slipping": [
                {"friction coefficient": friction, "to the end": math.isinf(until), "until [s]": _finite(until)}
                for friction, until in self.rolls_until.items()
            ],
            **_steady(trajectory.scene),
            "trusted": trajectory.trusted,
            "warnings": trajectory.warnings,
            "notes": self.notes,
        }
        return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _scale(scene: Scene) -> str:
    """Return the energy with which `energy_drift` is compared."""
    return "the swing's largest kinetic energy" if scene.load.offset else "the largest kinetic energy"


def _in_the_end(scene: Scene) -> dict[str, str]:
    """Return by name what takes energy from a motion, and the steady rolling to which it may come."""
    facts = {"damping torque over slip rate": damping_in_words(scene)}
    if scene.drag:
        facts["drag of the air"] = f"{scene.drag:.4g} kg/m"
    try:
        speed, tilt = scene.terminal_speed(), math.degrees(scene.terminal_tilt())
        facts["steady rolling"] = f"{speed:.6g} m/s, the load at phi = {tilt:.6g} degrees"
        swing = [f"{root.real:.4g} +- {root.imag:.4g}i" for root in scene.modes() if root.imag > 0]
        creep = [f"{root.real:.4g}" for root in scene.modes() if root.imag == 0]
        facts["its modes exp(s t), s"] = f"{', '.join([*creep, *swing])} 1/s"
    except MjbeerError as error:
        facts.setdefault("steady rolling", _reason(error))
    return facts


def _steady(scene: Scene) -> dict[str, Any]:
    """Return the steady rolling of a damped scene for JSON, with null for what it does not have."""
    if not scene.dissipates:
        return {}
    names = ("terminal speed [m/s]", "terminal tilt [degrees]", "modes, real and imaginary parts [1/s]")
    try:
        roots = [[root.real, root.imag] for root in scene.modes().tolist()]
        return dict(zip(names, (scene.terminal_speed(), math.degrees(scene.terminal_tilt()), roots), strict=True))
    except MjbeerError:
        return dict.fromkeys(names)


def _reason(error: MjbeerError) -> str:
    """Return the first clause of an error, which says what there is not."""
    return str(error).split(":")[0]


def _needed(record: Record) -> str:
    if math.isfinite(record.needed):
        return f"{record.needed:.4g} to roll to the end without slipping"
    if math.isfinite(record.fails_at):
        return f"none is enough: N < 0 from t = {record.fails_at:.6g} s"
    return "none is enough: nothing presses the can on the incline (N = 0)"


def _finite(value: float | None) -> float | None:
    """Return a number for JSON, which has no infinity and no NaN: those become None."""
    return value if value is not None and math.isfinite(value) else None
