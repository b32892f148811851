"""A scene in a setting as MuJoCo's numbers: which mechanics file a model is read from, and what is written into it.

Models of one `structure` have the same elements and differ in numbers alone, which `Mechanics.parameters` has by
element and attribute of MJCF, as `mjcf/README.md` lists them.
"""

import math
import pathlib
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import mjcf_file
from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.setting import OWN, Setting
from mjbeer.theory.scene import Scene

Structure: TypeAlias = tuple[Hashable, ...]
"""What decides which elements and flags a model has."""

_TOLERANCE = 1e-14
"""The solver's tolerance over the square of gravity: it ends once an iteration gains less. MuJoCo's own 1e-8 m^2/s^4
takes the weight of a light load for nothing. 1e-14 costs no time in the four scenes; 1e-18 costs a third of it."""


class Inertial(NamedTuple):
    """The mass [kg] of a body, its distance below the axis [m], and its moment of inertia about itself [kg m^2]."""

    mass: float
    offset: float
    inertia: float


@dataclass(frozen=True)
class Mechanics:
    """The numbers of a scene in a setting."""

    scene: Scene
    setting: Setting
    visuals: bool = False
    """Whether the incline is tilted, as it is seen, or gravity instead."""
    timestep: float | None = None
    """Timestep of MuJoCo, to which constraints are fitted [s], if it is not the setting's."""

    @cached_property
    def bodies(self) -> Mapping[str, Inertial]:
        """Return the bodies that have mass, by name."""
        scene = self.scene
        if self.setting.rolling != "reduced":
            return _constrained(scene)
        # Of a sliding load the can's mass is on the same body, as a point on the axis: eqs. (39) and (44).
        return {"can": _load_with(scene, scene.can.mass) if scene.attachment == "sliding" else _frozen(scene)}

    @property
    def path(self) -> pathlib.Path:
        """Return the path of the mechanics file."""
        return self.setting.folder / "mechanics" / f"{self.scene.attachment}_{self.setting.rolling}.xml"

    @property
    def acting(self) -> tuple[str, ...]:
        """Return the names of the tendons and the actuators that exert a force, which reduced models alone have."""
        oscillator = self.scene.oscillator
        acting = {"weight": oscillator.ramp, "chord": oscillator.chord, "damper": self.scene.damping_law}
        return tuple(name for name, acts in acting.items() if acts) if self.setting.rolling == "reduced" else ()

    @cached_property
    def structure(self) -> Structure:
        """Return what decides which elements and flags the model has: the text of its file, above all.

        Raises:
          TemplateError: if the file is missing or not readable.
        """
        scene, setting = self.scene, self.setting
        return mjcf_file.content(self.path), setting.rolling, scene.attachment, self.acting, scene.dissipates

    @cached_property
    def parameters(self) -> Parameters:
        """Return what is written into the mechanics file, by element and attribute."""
        scene, setting, radius = self.scene, self.setting, self.scene.can.radius
        alpha, g, contact = scene.incline, scene.gravity, setting.rolling == "contact"
        timestep, integrator = self.timestep or setting.timestep, setting.integrator
        if integrator in OWN:
            integrator = "RK4"  # which is not used: they step by themselves
        elif integrator == "discrete" and setting.rolling == "reduced" and scene.damping_law:
            # It takes the same steps, but solves for them by iteration, to which forces below 3e-8 [N, N m] are none: a
            # load let go 1e-6 rad beside the top would stay there for ever.
            integrator = "implicitfast"
        # With the axis at the origin, an offset far smaller than the radius keeps its digits. Only a can that is seen,
        # or in contact, must lie on the incline.
        height = radius if contact or self.visuals else 0.0
        found: Parameters = {
            ("option", "timestep"): (timestep,),
            ("option", "integrator"): integrator,
            ("option", "gravity"): (0, 0, -g) if self.visuals else (g * math.sin(alpha), 0, -g * math.cos(alpha)),
            ("body incline", "euler"): (0, math.degrees(alpha) if self.visuals else 0, 0),
            ("body can", "pos"): (0, 0, height),
        }
        for name, body in self.bodies.items():
            found[f"inertial {name}", "mass"] = (body.mass,)
            found[f"inertial {name}", "pos"] = 0, 0, -body.offset
            found[f"inertial {name}", "diaginertia"] = (body.inertia,) * 3
        if scene.attachment == "sliding":
            found["joint slide", "damping"] = 0, scene.drag, 0
            damper = "fixed damper" if setting.rolling == "reduced" else "joint swing"
            found[damper, "damping"] = tuple(scene.damping_law.coefficients)
        if setting.rolling == "reduced":
            if scene.attachment == "sliding":
                found["joint slide", "armature"] = (scene.can.inertia / radius**2,)
                found["fixed damper/slide", "coef"] = (-1 / radius,)
            else:
                found["general weight", "biasprm"] = (scene.oscillator.ramp,)
                found["spatial chord", "armature"] = (scene.oscillator.chord,)
                found["site chord_top", "pos"] = 0, 0, height + 1.0
                found["fixed u/phi", "coef"] = (radius,)
            return found
        found["fixed slip/roll", "coef"] = (-radius,)
        rolling = "pair rolling" if contact else "joint rolling"
        found[rolling, "solref"] = stiffest(setting.integrator, timestep, contact), 1
        if contact:
            found[rolling, "friction"] = setting.friction, setting.friction, 0.005, 1e-4, 1e-4
            found["geom can", "size"] = radius, scene.can.length / 2
            # What the weight of the load gains, over what that of all masses gains: a force squared over an inertia. At
            # a tolerance of 0 the solver would spend all its iterations on rounding.
            light = scene.load.moment**2 / (scene.mass * float(scene.oscillator.inertia(math.pi / 2)))
            found["option", "tolerance"] = (_TOLERANCE * max(light, 1e-10) * max(g, 1e-5) ** 2,)
        else:
            found[rolling, "polycoef"] = 0, radius, 0, 0, 0
        return found


def stiffest(integrator: str, timestep: float, contact: bool = False) -> float:
    """Return the time constant [s] of the stiffest critically damped constraint to use with an integrator.

    Semi-implicit Euler, and what is like it, is stable for timesteps up to 0.83 time constants (4 - 4x - x^2 > 0 for
    x = h/tau), and is given 0.5. RK4 is stable up to 2.7 and is given 2, which is stable with DOP853 too; "discrete"
    has no limit. A `contact` opens and closes: with less than a timestep RK4 chatters.
    """
    if integrator not in ("RK4", "discrete", "DOP853"):
        return 2 * timestep
    return timestep if contact else timestep / 2


def _frozen(scene: Scene) -> Inertial:
    """Return can and load as one body on a hinge, phi, whose inertia base + chord sin^2(phi/2) is that of rolling.

    The file says how. The arms of the chord are 1 m long; any length gives the same inertia.
    """
    base, moment = scene.oscillator.base, scene.load.moment
    # Any mass with the moment m b is right: the scene's at its centre of mass (38), or, where that has more than half
    # of the inertia, a larger mass on a shorter arm that has half.
    mass = max(scene.mass, 2 * moment**2 / base)
    return Inertial(mass, moment / mass, base - moment**2 / mass)


def _constrained(scene: Scene) -> dict[str, Inertial]:
    """Return can and load as they are, which a constraint makes roll."""
    can, load = scene.can, scene.load
    if scene.attachment == "frozen":
        inertia = load.inertia + can.inertia + load.mass * can.mass / scene.mass * load.offset**2
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo needs; "
                'use rolling="reduced", or give the can mass'
            )
        return {"can": Inertial(scene.mass, load.moment / scene.mass, inertia)}
    if can.inertia == 0:
        raise UnsupportedError(
            f"a {'massless can' if can.mass == 0 else 'can without inertia'} with a sliding load exists only in "
            'rolling="reduced": MuJoCo moves no body without mass and inertia; give the can some, as '
            "can=Can.sheet_metal() or, on the command line, --can metal"
        )
    # MuJoCo moves no point load. A mass on the axis moves with it exactly as with the can, and gives it an inertia.
    moved = min(can.mass / 2, load.mass) if load.inertia < 1e-6 * load.mass * load.offset**2 else 0.0
    return {"can": Inertial(can.mass - moved, 0.0, can.inertia), "load": _load_with(scene, moved)}


def _load_with(scene: Scene, moved: float) -> Inertial:
    """Return the load with the mass `moved` [kg] from the can to it, as a point on the axis."""
    load = scene.load
    mass = load.mass + moved
    return Inertial(mass, load.moment / mass, load.inertia + load.moment * load.offset * moved / mass)
