"""The numbers of a scene in a setting: its mechanics file, and what is written into it.

Models of one `structure` have the same elements and differ in numbers only.
`ModelNumbers.parameters` has these by element and attribute of MJCF, as `mjcf/README.md` lists
them.
"""

import functools
import math
import pathlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import mjcf_file
from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.setting import MJBEER_FOLDER, MJBEER_INTEGRATORS, Rolling, Setting
from mjbeer.theory.scene import Attachment, Scene

_SOLVER_TOLERANCE = 1e-14
"""The tolerance of MuJoCo's solver divided by the square of gravity, unless the load is light. With
MuJoCo's own 1e-8 m^2/s^4 the solver treats the weight of a light load as zero. 1e-14 takes no more
time in the four scenes, 1e-18 a third more."""


class Inertial(NamedTuple):
    """A body's mass [kg], distance below the axis [m], and inertia about itself [kg m^2]."""

    mass: float
    offset: float
    inertia: float


class Structure(NamedTuple):
    """What decides which elements and flags the model of a scene has."""

    content: tuple[bytes, ...]
    """The bytes of its mechanics file and of all files that this includes."""
    rolling: Rolling
    attachment: Attachment
    acting: tuple[str, ...]
    """The names of the tendons and the actuators that exert a force."""
    dissipates: bool


@dataclass(frozen=True)
class ModelNumbers:
    """The numbers of the MuJoCo model of a scene in a setting."""

    scene: Scene
    setting: Setting
    visuals: bool = False
    """Whether the incline is tilted, as it is drawn. If not, gravity is tilted instead."""
    timestep: float | None = None
    """Timestep of MuJoCo, to which constraints are fitted [s]. None for that of the setting."""

    @cached_property
    def bodies(self) -> Mapping[str, Inertial]:
        """Return the bodies that have mass, by name."""
        scene = self.scene
        if self.setting.rolling != "reduced":
            return _constrained(scene)
        if scene.attachment == "frozen":
            return {"can": _frozen(scene)}
        # The can's mass is on the load's body too, as a point on the axis: eqs. (39) and (44).
        return {"can": _load_with(scene, scene.can.mass)}

    @property
    def path(self) -> pathlib.Path:
        """Return the path of the mechanics file."""
        name = f"{self.scene.attachment}_{self.setting.rolling}.xml"
        return self.setting.folder / "mechanics" / name

    @property
    def acting(self) -> tuple[str, ...]:
        """Return the tendons and the actuators that exert a force; only reduced models have any."""
        if self.setting.rolling != "reduced":
            return ()
        names = []
        if self.scene.oscillator.ramp:
            names.append("weight")
        if self.scene.oscillator.chord:
            names.append("chord")
        if self.scene.damping_law:
            names.append("damper")
        return tuple(names)

    @cached_property
    def structure(self) -> Structure:
        """Return what decides which elements and flags the model has.

        Raises:
          TemplateError: if the mechanics file is missing or not readable.
        """
        if self.setting.folder == MJBEER_FOLDER:
            content = _own_content(self.scene.attachment, self.setting.rolling)
        else:
            content = mjcf_file.content(self.path)
        return Structure(
            content=content,
            rolling=self.setting.rolling,
            attachment=self.scene.attachment,
            acting=self.acting,
            dissipates=self.scene.dissipates,
        )

    @cached_property
    def parameters(self) -> Parameters:
        """Return what is written into the mechanics file, by element and attribute."""
        parameters = self._options() | self._inertials()
        if self.scene.attachment == "sliding":
            parameters |= self._damping()
        if self.setting.rolling != "reduced":
            return parameters | self._constraint()
        if self.scene.attachment == "sliding":
            return parameters | self._reduced_sliding()
        return parameters | self._reduced_frozen()

    @property
    def _height(self) -> float:
        """Return the height of the axis above the origin [m].

        With the axis at the origin, an offset far smaller than the radius keeps its digits. Only a
        can that is drawn, or in contact, must lie on the incline.
        """
        return self.scene.can.radius if self.setting.rolling == "contact" or self.visuals else 0.0

    @property
    def _timestep(self) -> float:
        return self.timestep or self.setting.timestep

    def _options(self) -> Parameters:
        """Return the options of MuJoCo, the slope of the incline and the height of the can."""
        incline = self.scene.incline
        gravity = self.scene.gravity
        if self.visuals:
            tilt = math.degrees(incline)
            pull = (0, 0, -gravity)
        else:
            tilt = 0
            pull = (gravity * math.sin(incline), 0, -gravity * math.cos(incline))
        return {
            ("option", "timestep"): (self._timestep,),
            ("option", "integrator"): self._integrator(),
            ("option", "gravity"): pull,
            ("body incline", "euler"): (0, tilt, 0),
            ("body can", "pos"): (0, 0, self._height),
        }

    def _integrator(self) -> str:
        """Return the name of MuJoCo's integrator."""
        integrator = self.setting.integrator
        if integrator in MJBEER_INTEGRATORS:
            return "RK4"  # It is not used, as they step by themselves.
        damped = self.setting.rolling == "reduced" and bool(self.scene.damping_law)
        if integrator == "discrete" and damped:
            # "discrete" takes the same steps, but finds them by an iteration that treats forces
            # below 3e-8 [N, N m] as zero: a load let go 1e-6 rad beside the top would stay there.
            return "implicitfast"
        return integrator

    def _inertials(self) -> Parameters:
        """Return mass, centre of mass and inertia of each body."""
        parameters: Parameters = {}
        for name, body in self.bodies.items():
            parameters[f"inertial {name}", "mass"] = (body.mass,)
            parameters[f"inertial {name}", "pos"] = (0, 0, -body.offset)
            parameters[f"inertial {name}", "diaginertia"] = (body.inertia,) * 3
        return parameters

    def _damping(self) -> Parameters:
        """Return the drag of the air and the damping of a sliding load."""
        damper = "fixed damper" if self.setting.rolling == "reduced" else "joint swing"
        return {
            ("joint slide", "damping"): (0, self.scene.drag, 0),
            (damper, "damping"): tuple(self.scene.damping_law.coefficients),
        }

    def _reduced_sliding(self) -> Parameters:
        """Return the can's inertia, and how far the load turns in the can as that slides."""
        radius = self.scene.can.radius
        return {
            ("joint slide", "armature"): (self.scene.can.inertia / radius**2,),
            ("fixed damper/slide", "coef"): (-1 / radius,),
        }

    def _reduced_frozen(self) -> Parameters:
        """Return the torque of the weight, and the chord; its arms are 1 m long."""
        return {
            ("general weight", "biasprm"): (self.scene.oscillator.ramp,),
            ("spatial chord", "armature"): (self.scene.oscillator.chord,),
            ("site chord_top", "pos"): (0, 0, self._height + 1.0),
            ("fixed u/phi", "coef"): (self.scene.can.radius,),
        }

    def _constraint(self) -> Parameters:
        """Return what makes the can roll in an equality or a contact."""
        radius = self.scene.can.radius
        contact = self.setting.rolling == "contact"
        parameters: Parameters = {("fixed slip/roll", "coef"): (-radius,)}
        integrator = self.setting.integrator
        time_constant = shortest_time_constant(integrator, self._timestep, contact)
        if not contact:
            parameters["joint rolling", "solref"] = (time_constant, 1)
            parameters["joint rolling", "polycoef"] = (0, 1 / radius, 0, 0, 0)
            return parameters
        friction = self.setting.friction
        parameters["pair rolling", "solref"] = (time_constant, 1)
        parameters["pair rolling", "friction"] = (friction, friction, 0.005, 1e-4, 1e-4)
        parameters["geom can", "size"] = (radius, self.scene.can.length / 2)
        parameters["option", "tolerance"] = (self._solver_tolerance(),)
        return parameters

    def _solver_tolerance(self) -> float:
        """Return the tolerance of the solver of a contact [m^2/s^4].

        The solver minimizes a cost, and ends once an iteration lowers it by less than the
        tolerance. A force F on an inertia M adds F^2/M to the cost. The weight of all masses adds
        m g^2, and the torque of the load's weight (m b g)^2/J, which is far less if the load is
        light. The tolerance is lowered by the ratio of the two, so that the load counts. With a
        tolerance of 0 the solver would spend all its iterations on rounding.
        """
        scene = self.scene
        inertia = float(scene.oscillator.inertia(math.pi / 2))
        ratio = scene.load.moment**2 / (scene.mass * inertia)
        return _SOLVER_TOLERANCE * max(ratio, 1e-10) * max(scene.gravity, 1e-5) ** 2


@functools.cache
def _own_content(attachment: Attachment, rolling: Rolling) -> tuple[bytes, ...]:
    """Return the content of a mechanics file of mjbeer's own, which is read once a process.

    A file of a user's own is read at every call, because it may be edited between two of them.
    """
    return mjcf_file.content(MJBEER_FOLDER / "mechanics" / f"{attachment}_{rolling}.xml")


def shortest_time_constant(integrator: str, timestep: float, contact: bool = False) -> float:
    """Return the time constant [s] of the hardest constraint that an integrator steps stably.

    The constraint is critically damped. With x, the timestep divided by the time constant, the
    semi-implicit integrators are stable up to x = 0.83, where 4 - 4x - x^2 = 0, and are given 0.5.
    RK4 is stable up to 2.7 and is given 2, which is stable with DOP853 too. "discrete" has no
    limit, and is given 2. A `contact` opens and closes, and beyond 1 RK4 chatters.
    """
    if integrator not in ("RK4", "discrete", "DOP853"):
        return 2 * timestep
    return timestep if contact else timestep / 2


def _frozen(scene: Scene) -> Inertial:
    """Return can and load as one body on a hinge, whose inertia about the hinge is J(0).

    The chord tendon adds the rest of J(phi); frozen_reduced.xml says how.
    """
    base = scene.oscillator.base
    moment = scene.load.moment
    # The motion depends on the mass only through its moment m b, and on the inertia about the
    # hinge. So the mass is that of the scene, in its centre of mass (38), unless that has more than
    # half of J(0) about the hinge. Then it is a larger mass on a shorter arm, which has just half.
    mass = max(scene.mass, 2 * moment**2 / base)
    return Inertial(mass, moment / mass, base - moment**2 / mass)


def _constrained(scene: Scene) -> dict[str, Inertial]:
    """Return can and load as they are: a constraint makes them roll."""
    can = scene.can
    load = scene.load
    if scene.attachment == "frozen":
        reduced_mass = load.mass * can.mass / scene.mass
        inertia = load.inertia + can.inertia + reduced_mass * load.offset**2
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, "
                'which MuJoCo needs; use rolling="reduced", or give the can mass'
            )
        return {"can": Inertial(scene.mass, load.moment / scene.mass, inertia)}
    if can.inertia == 0:
        lacking = "massless can" if can.mass == 0 else "can without inertia"
        raise UnsupportedError(
            f'a {lacking} with a sliding load exists only in rolling="reduced": MuJoCo moves no '
            "body without mass and inertia; give the can some, as can=Can.sheet_metal() or, on the "
            "command line, --can metal"
        )
    # MuJoCo moves no body without inertia, as a point load is. A mass on the axis has the same
    # motion in the load as in the can. So some of the can's is put into the load, which then has an
    # inertia.
    is_point = load.inertia < 1e-6 * load.mass * load.offset**2
    moved = min(can.mass / 2, load.mass) if is_point else 0.0
    return {
        "can": Inertial(can.mass - moved, 0.0, can.inertia),
        "load": _load_with(scene, moved),
    }


def _load_with(scene: Scene, moved: float) -> Inertial:
    """Return the load with a mass `moved` [kg] on the axis, which is taken from the can."""
    load = scene.load
    mass = load.mass + moved
    inertia = load.inertia + load.moment * load.offset * moved / mass
    return Inertial(mass, load.moment / mass, inertia)
