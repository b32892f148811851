"""The sensors of a model that is shown have the values of the paper's letters; a model that is stepped has none."""

import math

import mujoco
import numpy as np
import pytest

from mjbeer import Scene, build, frozen, hoop, pendulum, sliding
from mjbeer.drawing.world.display import Display
from mjbeer.model import sensors, templates
from mjbeer.model.present import present
from mjbeer.model.setting import ROLLINGS, Setting
from mjbeer.model.state import start
from tests.support.scenes import METAL, SCENES

# Sums of a few products of positions and rates.
ROUNDING = 1e-12
TEMPLATES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
CASES = [(name, rolling) for name in SCENES for rolling in ROLLINGS if name != "sliding" or rolling == "reduced"]
BOTH = ["u", "phi", "u_dot", "phi_dot"]
ENERGIES = ["potential_energy", "kinetic_energy"]


def readings(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, float]:
    mujoco.mj_forward(model, data)
    return {model.sensor(i).name: float(data.sensor(i).data[0]) for i in range(model.nsensor)}


def shown(scene: Scene, rolling: str) -> mujoco.MjModel:
    return present(scene, Setting(rolling), 0.0, 0.0).compile()


def at(model: mujoco.MjModel, scene: Scene, phi: float, phi_dot: float) -> dict[str, float]:
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = np.split(start(model, scene, phi, phi_dot), 2)
    return readings(model, data)


@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_sensors_have_the_values_of_the_letters(name: str, rolling: str) -> None:
    scene = SCENES[name]
    found = at(shown(scene, rolling), scene, 1.1, -7.0)
    u, u_dot = scene.start(1.1, -7.0)
    assert [found[each] for each in BOTH] == pytest.approx([u, 1.1, u_dot, -7.0], rel=ROUNDING)
    further = {"reduced": set(), "equality": {"slip"}, "contact": {"slip", "lift"}}
    assert set(found) - {*BOTH, *ENERGIES} == further[rolling]


@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_slip_and_lift_are_what_is_missing_from_rolling(name: str, rolling: str) -> None:
    if rolling == "reduced":
        return
    scene = SCENES[name]
    model = shown(scene, rolling)
    data = mujoco.MjData(model)
    data.joint("slide").qpos, data.joint("roll").qpos = 0.7, 3.0
    if rolling == "contact":
        data.joint("lift").qpos = 0.2
    found = readings(model, data)
    assert found["slip"] == pytest.approx(0.7 - scene.can.radius * 3.0, rel=ROUNDING)
    assert found.get("lift", 0.2) == 0.2


@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_energies_are_the_scene_s_or_there_are_none(name: str, rolling: str) -> None:
    """Potential energy up to a constant, from the height of the load and of the can."""
    scene = SCENES[name]
    model = shown(scene, rolling)
    if model.nu:  # a constant force stands for a weight
        assert not {*ENERGIES} & {model.sensor(i).name for i in range(model.nsensor)}
        assert not model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY
        return
    assert model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY
    can, load = scene.can, scene.load

    def energies(phi: float, phi_dot: float) -> tuple[float, float]:
        u, u_dot = scene.start(phi, phi_dot)
        along = u_dot - load.offset * math.cos(phi) * phi_dot
        across = load.offset * math.sin(phi) * phi_dot
        kinetic = can.mass * u_dot**2 + can.inertia * (u_dot / can.radius) ** 2
        kinetic += load.mass * (along**2 + across**2) + load.inertia * phi_dot**2
        height = -u * math.sin(scene.incline)
        fall = load.offset * math.cos(phi + scene.incline)
        return scene.gravity * (scene.mass * height - load.mass * fall), kinetic / 2

    for phi, phi_dot in ((0.4, 3.0), (2.0, -9.0)):
        found, level = at(model, scene, phi, phi_dot), at(model, scene, 0.0, 0.0)
        wanted, rest = energies(phi, phi_dot), energies(0.0, 0.0)
        scale = max(abs(each) for each in (*wanted, *rest, *level.values()))
        assert found["potential_energy"] - level["potential_energy"] == pytest.approx(
            wanted[0] - rest[0], abs=1e-8 * scale if rolling == "contact" else ROUNDING * scale
        )
        assert found["kinetic_energy"] == pytest.approx(wanted[1], rel=ROUNDING)


def test_a_scene_with_other_masses_shows_no_energy() -> None:
    """Masses that are multiplied for MuJoCo's sake would show an energy that is multiplied too."""
    light = pendulum(wheel_mass=1e-12, load_mass=1e-12)
    assert not {*ENERGIES} & {each.name for each in present(light, Setting("equality"), 0.0, 0.0).sensors}


@pytest.mark.parametrize(("name", "rolling"), CASES)
@pytest.mark.parametrize("visuals", [False, True])
def test_what_is_stepped_has_none(name: str, rolling: str, visuals: bool) -> None:
    for model in (build(SCENES[name], rolling, visuals), Display.of([SCENES[name]], 0, 1).model):
        names = {model.tendon(i).name for i in range(model.ntendon)}
        assert model.nsensor == 0
        assert names <= {"chord"}
        assert not model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY


@pytest.mark.parametrize("name", TEMPLATES)
def test_templates_have_the_sensors_of_the_models(name: str) -> None:
    written = mujoco.MjModel.from_xml_path(str(templates.folder() / f"{name}.xml"))
    made = shown(TEMPLATES[name], "contact" if name == "hoop" else "equality")
    data, other = mujoco.MjData(written), mujoco.MjData(made)
    for each in (data, other):
        each.qpos[:] = np.linspace(0.3, 0.4, written.nq)
        each.qvel[:] = np.linspace(1, 3, written.nv)
    found, wanted = readings(written, data), readings(made, other)
    assert set(found) == set(wanted)
    assert set(found) <= set(sensors.NAMES)
    # Numbers in the templates have 13 digits, and a point load has an inertia of 1e-12 kg m^2 there.
    assert found == pytest.approx(wanted, rel=1e-7 if TEMPLATES[name].load.fill is None else 1e-11, abs=1e-15)
