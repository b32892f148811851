"""The sensors of a model that is shown: what MuJoCo's viewer plots, by the letters of the paper.

A model that is stepped to measure a motion has none, as MuJoCo would compute them in every step. The templates in
`mjcf/` have the same sensors as the models here.
"""

import mujoco

from mjbeer.model.inertia import mass_unit
from mjbeer.theory.scene import Scene

NAMES = ("u", "phi", "u_dot", "phi_dot", "slip", "lift", "potential_energy", "kinetic_energy")
"""The names that a sensor can have. A tendon that measures a sum of joints has the name of the sum."""


def add(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Add the sensors to a model that has its joints.

    They are u [m] and phi [rad] with their rates; slip, u - a roll [m], where rolling is a constraint; lift [m], where
    the can may leave the incline; and the potential and the kinetic energy [J].
    """
    sums = _sums({joint.name for joint in spec.joints}, scene.can.radius)
    for name, coefficients in sums.items():
        _add_position(spec, name, coefficients)
    for name in ("u", "phi"):
        _add_rate(spec, name, sums[name])
    if _has_its_energy(spec, scene):
        spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)  # the viewer then shows the sum as well
        spec.add_sensor(name="potential_energy", type=mujoco.mjtSensor.mjSENS_E_POTENTIAL)
        spec.add_sensor(name="kinetic_energy", type=mujoco.mjtSensor.mjSENS_E_KINETIC)


def _sums(joints: set[str], radius: float) -> dict[str, dict[str, float]]:
    """Return what is measured as a sum over joints: the coefficient of each joint."""
    if "roll" not in joints:  # a reduced model, in which u is a coordinate or follows from phi
        return {"u": {"slide": 1.0} if "slide" in joints else {"phi": radius}, "phi": {"phi": 1.0}}
    phi = {"roll": 1.0, "swing": 1.0} if "swing" in joints else {"roll": 1.0}
    sums = {"u": {"slide": 1.0}, "phi": phi, "slip": {"slide": 1.0, "roll": -radius}}
    return {**sums, "lift": {"lift": 1.0}} if "lift" in joints else sums


def _add_position(spec: mujoco.MjSpec, name: str, coefficients: dict[str, float]) -> None:
    """Add a sensor of a sum over joints. A tendon without stiffness measures a sum, and exerts no force."""
    if (joint := _single(coefficients)) is not None:
        _add_sensor(spec, name, mujoco.mjtSensor.mjSENS_JOINTPOS, mujoco.mjtObj.mjOBJ_JOINT, joint)
        return
    tendon = spec.add_tendon(name=name)
    for each, coefficient in coefficients.items():
        tendon.wrap_joint(each, coefficient)
    _add_sensor(spec, name, mujoco.mjtSensor.mjSENS_TENDONPOS, mujoco.mjtObj.mjOBJ_TENDON, name)


def _add_rate(spec: mujoco.MjSpec, name: str, coefficients: dict[str, float]) -> None:
    """Add a sensor of the rate of a sum over joints that has a sensor already."""
    if (joint := _single(coefficients)) is not None:
        _add_sensor(spec, f"{name}_dot", mujoco.mjtSensor.mjSENS_JOINTVEL, mujoco.mjtObj.mjOBJ_JOINT, joint)
    else:
        _add_sensor(spec, f"{name}_dot", mujoco.mjtSensor.mjSENS_TENDONVEL, mujoco.mjtObj.mjOBJ_TENDON, name)


def _single(coefficients: dict[str, float]) -> str | None:
    """Return the joint that a sum consists of, or None if it has more terms or another coefficient than 1."""
    (joint, coefficient), *more = coefficients.items()
    return joint if coefficient == 1 and not more else None


def _add_sensor(spec: mujoco.MjSpec, name: str, kind: mujoco.mjtSensor, measured: mujoco.mjtObj, of: str) -> None:
    spec.add_sensor(name=name, type=kind, objtype=measured, objname=of)


def _has_its_energy(spec: mujoco.MjSpec, scene: Scene) -> bool:
    """Return whether MuJoCo's energy of the model is that of the scene.

    It is not where a constant force stands for a weight, which MuJoCo does not count as potential energy, and not where
    all masses are multiplied.
    """
    return not spec.actuators and mass_unit(scene) == 1
