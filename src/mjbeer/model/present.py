"""A scene made ready for MuJoCo's viewer, as it is exported and viewed.

It has everything drawn, sensors to plot, a board for ten seconds of rolling, a camera that goes along with the can, and
its start as a keyframe.
"""

import math

import mujoco

from mjbeer.model import appearance, sensors, state
from mjbeer.model.build import compile_spec, compose
from mjbeer.model.setting import Setting
from mjbeer.theory.scene import Scene

CAMERA = "side"
"""The camera with which the viewer opens. It goes along with the can."""
START = "start"
"""The name of the keyframe."""
_DURATION = 10.0
"""How long the can may roll before the board ends [s]."""
_LONGEST = 1e5
"""Largest length of the board to either side, in radii: graphics compute in single precision, so that further away the
can would be drawn a percent of its radius beside its place."""


def present(scene: Scene, setting: Setting, phi0: float, phi_dot0: float) -> mujoco.MjSpec:
    """Return the specification of a scene to be shown, which starts at `phi0` [rad] with `phi_dot0` [rad/s].

    Raises:
      ParameterError: if the start is not finite.
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if a template is missing, lacks a part, or has a part that is not allowed.
    """
    spec = compose(scene, setting, visuals=True)
    sensors.add(spec, scene)
    u = scene.start(phi0, phi_dot0)[0]
    way = min(farthest(scene, phi0, phi_dot0, _DURATION), _LONGEST * scene.can.radius)
    appearance.lengthen(spec, scene, u - way, u + way)
    model = compile_spec(spec)
    start = state.start(model, scene, phi0=phi0, phi_dot0=phi_dot0)
    spec.add_key(name=START, qpos=start[: model.nq], qvel=start[model.nq :])
    spec.visual.global_.cameraid = model.camera(CAMERA).id
    return spec


def farthest(scene: Scene, phi0: float, phi_dot0: float, duration: float) -> float:
    """Return a distance that the axis does not exceed within a `duration` [s], from its start uphill or downhill [m].

    The axis of a can with a sliding load moves with constant acceleration, but for a swing of at most m b/M_e to either
    side (the integral of eq. 46). For a frozen load, the energy bounds the angle s that the can has turned:
    J_min s_dot^2/2 <= K + 2 depth + |slope| s, so that s <= w t + |slope| t^2/(2 J_min) with
    w^2 = 2 (K + 2 depth)/J_min, where K is the kinetic energy at the start. Damping and drag only take energy, and with
    them the same holds of a sliding load: s is then the way of the axis, and J_min the smallest mass that it can have.
    """
    can, load, oscillator = scene.can, scene.load, scene.oscillator
    u_dot = abs(scene.start(phi0, phi_dot0)[1])
    effective_mass = load.mass + can.mass + can.inertia / can.radius**2
    if scene.dissipates:
        moment = load.mass * load.offset
        least = effective_mass * oscillator.base / (load.inertia + moment * load.offset)
        kinetic = (effective_mass * u_dot**2 + float(load.inertia + moment * load.offset) * phi_dot0**2) / 2
        kinetic -= moment * math.cos(phi0) * scene.start(phi0, phi_dot0)[1] * phi_dot0
        force = scene.mass * scene.gravity * abs(math.sin(scene.incline))
        return _reach(kinetic + 2 * moment * scene.gravity, least, force, duration)
    if scene.attachment == "sliding":
        swing = 2 * load.mass * load.offset / effective_mass
        return u_dot * duration + abs(scene.acceleration()) * duration**2 / 2 + swing
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    slope = abs(oscillator.slope)
    return can.radius * _reach(kinetic + 2 * oscillator.depth, oscillator.base, slope, duration)


def _reach(energy: float, inertia: float, force: float, duration: float) -> float:
    """Return how far an `energy` [J] and a constant force bring an inertia at most within a `duration` [s]."""
    return math.sqrt(2 * energy / inertia) * duration + force / inertia * duration**2 / 2
