"""What MuJoCo's contact needs for a wheel: from the default to a stiff contact, step by step.

`python -m mjbeer.studies.contact_creep` runs the can test with each of `SETTINGS` and writes two
tables into `STORED`, in half a minute: the errors and the cost of each setting, and what
`mjbeer.theory.soft_contact` predicts of the soft ones.
"""

import math
import pathlib
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.output.numbers import number
from mjbeer.output.terminal import Table
from mjbeer.studies import mujoco_bodies, stored_tables
from mjbeer.studies.can_test import CASES, ROLL, Case, Errors
from mjbeer.studies.mujoco_bodies import Positions
from mjbeer.theory import soft_contact
from mjbeer.theory.paper_scenes import frozen
from mjbeer.theory.scene import Scene
from mjbeer.theory.soft_contact import Cone, SoftContact

STORED = pathlib.Path(__file__).with_name("contact_creep.json")
"""The tables "errors" and "law"."""
TIMESTEPS = (1e-3, 1e-4)
"""Timesteps of the table [s]."""
HARDEST = 0.9999
"""The largest impedance that MuJoCo accepts, mjMAXIMP."""
ROUNDS = 60
"""Rounds in which the steps of all settings are timed in turn; the shortest time counts."""
STEPS_A_ROUND = 500
PLANAR = 2 / 3
"""Inverse mass that MuJoCo gives a body on two slides and a hinge, times its mass: the mean of its
three directions, in one of which it cannot move."""
REST_DURATION = 5.0
"""How long a can is left at its equilibrium [s]."""


@dataclass(frozen=True)
class Setting:
    """Attributes of a contact that are not MuJoCo's defaults."""

    name: str
    cone: Cone = "pyramidal"
    impratio: float = 1.0
    stiff_solref: bool = False
    """Whether the time constant is twice the timestep, the shortest that MuJoCo allows."""
    stiff_solimp: bool = False
    """Whether the impedance is `HARDEST` at all depths."""
    integrator: str = "RK4"
    noslip: int = 0
    """Passes of MuJoCo's solver NoSlip."""
    wheel: str | None = None
    """More attributes of the wheel, if it alone has the contact's; the floor is then MuJoCo's
    default."""

    def contact(self, timestep: float) -> SoftContact:
        """Return the contact at a `timestep` [s], for theory."""
        default = SoftContact()
        return SoftContact(
            time_constant=2 * timestep if self.stiff_solref else default.time_constant,
            impedance_at_surface=HARDEST if self.stiff_solimp else default.impedance_at_surface,
            impedance_at_width=HARDEST if self.stiff_solimp else default.impedance_at_width,
            cone=self.cone,
            impratio=self.impratio,
        )

    def model(self, case: Case, timestep: float) -> mujoco.MjModel:
        """Return MuJoCo's model of a case with this contact."""
        contact = self.contact(timestep)
        surface = contact.impedance_at_surface
        option = f'integrator="{self.integrator}" cone="{self.cone}" impratio="{self.impratio}"'
        if self.noslip:
            option += f' noslip_iterations="{self.noslip}"'
        attributes = (
            f'solref="{contact.time_constant!r} {contact.damping_ratio!r}" '
            f'solimp="{surface!r} {contact.impedance_at_width!r} {contact.width!r}"'
        )
        if self.wheel is None:
            return mujoco_bodies.free_body(case, timestep, option, attributes)
        return mujoco_bodies.free_body(
            case, timestep, option, f"{attributes} {self.wheel}", floor=""
        )


DEFAULT = Setting("MuJoCo's default")
ELLIPTIC = Setting("`cone` elliptic", cone="elliptic")
HARD_PYRAMID = Setting("`impratio` 100", impratio=100)
GRIP = Setting("`cone` and `impratio`", "elliptic", 100)
"""What the manual recommends against slow slip."""
RECIPE = Setting("`solref` and `solimp`", stiff_solref=True, stiff_solimp=True)
STIFF = replace(RECIPE, name="all four", cone="elliptic", impratio=100)
WHEEL = replace(RECIPE, name="these two on the wheel alone", wheel="")
PRIORITY = replace(RECIPE, name="the same with `priority` 1", wheel='priority="1"')
SETTINGS = (
    DEFAULT,
    ELLIPTIC,
    HARD_PYRAMID,
    Setting("`solref` 2h", stiff_solref=True),
    Setting("`solimp` 0.9999", stiff_solimp=True),
    GRIP,
    Setting("NoSlip, 3 passes", noslip=3),
    RECIPE,
    WHEEL,
    PRIORITY,
    replace(RECIPE, name="`solref`, `solimp`, `cone`", cone="elliptic"),
    STIFF,
    replace(STIFF, name="all four, Euler", integrator="Euler"),
)
SOFT = (DEFAULT, ELLIPTIC)
"""The settings whose error is the contact's at every timestep."""


class Row(NamedTuple):
    """What a setting does to both cases."""

    setting: Setting
    rock: list[Errors]
    """At each of `TIMESTEPS`."""
    roll: list[Errors]
    cost: float
    """Processor time of a step, divided by that of the default."""


def measure(settings: Sequence[Setting] = SETTINGS) -> list[Row]:
    """Run both cases with each setting, and time their steps."""
    costs = _costs(settings)
    rows = []
    for setting, cost in zip(settings, costs, strict=True):
        errors: dict[str, list[Errors]] = {}
        for case in CASES.values():
            errors[case.name] = [_errors(setting, case, timestep) for timestep in TIMESTEPS]
        rows.append(Row(setting, errors["rock"], errors["roll"], cost))
    return rows


def _errors(setting: Setting, case: Case, timestep: float) -> Errors:
    """Return the errors of MuJoCo's motion."""
    motion = mujoco_bodies.run(case, setting.model(case, timestep))
    return mujoco_bodies.errors(case, motion)


def _costs(settings: Sequence[Setting]) -> list[float]:
    """Return the processor times of a step at the first timestep, divided by the first setting's.

    Rounds take turns, so that what else the machine does meets all settings alike.
    """
    models = [setting.model(ROLL, TIMESTEPS[0]) for setting in settings]
    shortest = [math.inf] * len(models)
    for _ in range(ROUNDS):
        for place, model in enumerate(models):
            data = mujoco_bodies.start(ROLL, model)
            began = time.process_time()
            mujoco.mj_step(model, data, STEPS_A_ROUND)
            shortest[place] = min(shortest[place], time.process_time() - began)
    return [seconds / shortest[0] for seconds in shortest]


def predicted(setting: Setting, case: Case, time: np.ndarray) -> Positions:
    """Return the motion that theory predicts of a soft contact; no run has a part in it."""
    contact = setting.contact(TIMESTEPS[0])
    motion = soft_contact.roll(case.scene, contact, time, case.phi0, case.phi_dot0)
    return Positions(time, motion.phi, motion.u)


class Rest(NamedTuple):
    """What becomes of a can that starts at its equilibrium, after `REST_DURATION`."""

    tilt: float
    """By how much phi has changed [rad]."""
    slid: float
    """How far the can has slid, without what it has rolled [m]."""


def rest_by_mujoco(scene: Scene) -> Rest:
    """Return what becomes of mjbeer's frozen can on an elliptic contact with MuJoCo's defaults."""
    phi0 = scene.equilibrium()
    model = build(scene, rolling="contact", timestep=TIMESTEPS[0], phi0=phi0)
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.impratio = 1.0
    contact = SoftContact()
    model.pair("rolling").solref = (contact.time_constant, contact.damping_ratio)
    model.pair("rolling").solimp = (
        contact.impedance_at_surface,
        contact.impedance_at_width,
        contact.width,
        contact.midpoint,
        contact.power,
    )
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_step(model, data, round(REST_DURATION / TIMESTEPS[0]))
    u, lift, phi = data.qpos
    tilt = phi - phi0
    radius = scene.can.radius
    return Rest(tilt, u - radius * phi0 - (radius + lift / 2) * tilt)


def rest_by_theory(scene: Scene) -> Rest:
    """Return the same, predicted: the slide is that of the law of the creep alone."""
    contact = SoftContact(cone="elliptic")
    inverse_mass = PLANAR / scene.mass
    time = np.array([0.0, REST_DURATION])
    motion = soft_contact.roll(scene, contact, time, scene.equilibrium(), 0.0, inverse_mass)
    across = scene.mass * scene.gravity * math.cos(scene.incline)
    depth = contact.sink(across, inverse_mass)
    speed = contact.creep_speed(scene.downhill_weight, depth, inverse_mass)
    return Rest(float(motion.phi[-1] - motion.phi[0]), speed * REST_DURATION)


def error_table(rows: Sequence[Row]) -> Table:
    """Return the errors and the cost of each setting."""
    columns = ("contact", "rock, 1 ms", "0.1 ms", "roll, 1 ms", "0.1 ms", "a step costs")
    lines = []
    for row in rows:
        of_cases = [number(error.largest) for error in (*row.rock, *row.roll)]
        lines.append((row.setting.name, *of_cases, f"{row.cost:.2f}"))
    return Table("", columns, lines)


def law_table() -> Table:
    """Return what theory predicts beside what MuJoCo does."""
    columns = ("motion, contact", "what", "predicted", "MuJoCo")
    lines = []
    for case in CASES.values():
        for setting in SOFT:
            motion = mujoco_bodies.run(case, setting.model(case, TIMESTEPS[1]))
            measured = mujoco_bodies.errors(case, motion)
            theory = mujoco_bodies.errors(case, predicted(setting, case, motion.time))
            name = f"{case.name}, {setting.cone}"
            lines.append((name, "error of u/a [rad]", f"{theory.u:.4f}", f"{measured.u:.4f}"))
            lines.append((name, "error of φ [rad]", f"{theory.phi:.4f}", f"{measured.phi:.4f}"))
    scene = frozen()
    rests = (rest_by_theory(scene), rest_by_mujoco(scene))
    name = "at rest for 5 s, elliptic"
    tilts = [f"{math.degrees(rest.tilt):.3f}" for rest in rests]
    ways = [f"{rest.slid * 1e3:.3f}" for rest in rests]
    lines.append((name, "turn of φ [degrees]", *tilts))
    lines.append((name, "slide [mm]", *ways))
    return Table("", columns, lines, left=(0, 1))


if __name__ == "__main__":
    stored_tables.save(STORED, {"errors": error_table(measure()), "law": law_table()})
