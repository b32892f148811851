"""What `attach` makes of a can in another world, what it says of that world, how a can slides, and
another fill."""

import math
import warnings

import mujoco
import numpy as np
import pytest

from mjbeer import (
    Can,
    Load,
    Scene,
    UntrustedWarning,
    attach,
    build,
    frozen,
    liquid,
    pendulum,
    refill,
    sliding,
    specify,
    standing,
)
from mjbeer.exceptions import MjbeerError, ParameterError, UnsupportedError
from mjbeer.model.mujoco_library import quiet
from mjbeer.theory.standing import Standing
from tests.support.scenes import METAL

RK4 = mujoco.mjtIntegrator.mjINT_RK4
HONEY = liquid("honey", incline=0.0, can=METAL)
PLANE = mujoco.mjtGeom.mjGEOM_PLANE
BOX = Can.sheet_metal(0.1, 0.3, 1e-3)


def world(**options: object) -> mujoco.MjSpec:
    """A level floor."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_geom(name="floor", type=PLANE, size=[0, 0, 1])
    for name, value in options.items():
        setattr(spec.option, name, value)
    return spec


def settled(spec: mujoco.MjSpec, duration: float = 1.0) -> mujoco.MjData:
    """The state after a while."""
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, round(duration / model.opt.timestep))
    assert not any(warning.number for warning in data.warning)
    return data


def test_cans_are_attached_and_stand_and_lie() -> None:
    """On a plane and on a box, with nothing to be said about the parent, and under names of their
    own."""
    spec = world()
    spec.worldbody.add_geom(
        name="table", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.1], pos=[1, 0, 0.1]
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert attach(spec, standing(modes=2)).name == "can-can"
        attach(spec, standing("honey", damping_ratio=0.3), [1, 0, 0.2], prefix="honey-")
        attach(spec, sliding(can=METAL), [-0.5, 0, METAL.radius], prefix="lying-")
        data = settled(spec)
    # MuJoCo's default contact lets a can sink by some 0.4 mm, and a hard one by nothing.
    for name, place, depth in (
        ("can", [0, 0, 0], 1e-3),
        ("honey", [1, 0, 0.2], 1e-3),
        ("lying", [-0.5, 0, 0.033], 1e-6),
    ):
        assert data.body(f"{name}-can").xpos == pytest.approx(place, abs=depth)
        assert abs(data.body(f"{name}-can").xmat[8] - 1) < 1e-6
    assert data.sensor("can-slosh2_up").data == pytest.approx([0, 0, 1], abs=1e-6)


def test_a_second_can_needs_a_prefix_of_its_own() -> None:
    spec = world()
    attach(spec, standing())
    with pytest.raises(ParameterError, match="has a can of this prefix already"):
        attach(spec, standing())


def test_a_can_may_be_fixed_to_a_body() -> None:
    spec = world()
    spec.worldbody.add_body(name="gripper", pos=[0, 0, 1]).add_geom(size=[0.01] * 3)
    attach(spec, standing(), [0, 0, -0.5], prefix="held-", free=False, body="gripper")
    model = spec.compile()
    assert [model.joint(place).name for place in range(model.njnt)] == ["held-slosh1"]
    assert build(standing(), free=False).njnt == 1
    assert specify(standing(modes=0), visuals=True).body("slosh1") is None


@pytest.mark.parametrize(
    ("can", "options", "reason"),
    [
        (
            standing(modes=3),
            {"timestep": 5e-3, "integrator": RK4},
            r"with RK4 its damping may diverge at .* 0\.005 s",
        ),
        (HONEY, {}, r"with RK4 its damping may diverge at .* 0\.002 s: give 0\.0016 s or less$"),
        (
            standing(),
            {"disableflags": int(mujoco.mjtDisableBit.mjDSBL_DAMPER)},
            "damper disabled it has no damping",
        ),
        (
            standing(),
            {"timestep": 0.05},
            r"the timestep of 0\.05 s is coarse: the fastest mode turns by 1\.17 rad",
        ),
        (
            standing(),
            {"gravity": [0, 0, -1.62]},
            r"gravity is 1\.62 m/s\^2, and the can is made for 9\.81",
        ),
        (
            frozen(can=METAL),
            {"integrator": mujoco.mjtIntegrator.mjINT_IMPLICITFAST},
            "another integrator than RK4",
        ),
    ],
)
def test_what_the_parent_spoils_is_said(
    can: Scene, options: dict[str, object], reason: str
) -> None:
    spec = world(**options)
    with pytest.warns(UntrustedWarning, match=f"the parent's options spoil the can: .*{reason}"):
        attach(spec, can)
    for name, value in options.items():  # and left as it is
        assert np.array_equal(getattr(spec.option, name), value)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("settotalmass", 5.0, "settotalmass scales its masses"),
        (
            "boundinertia",
            1e-6,
            r"boundinertia raises what is less, from 1\.7e-14 on, once the world is saved",
        ),
    ],
)
def test_what_the_parent_s_compiler_spoils_is_said(name: str, value: float, reason: str) -> None:
    spec = world()
    setattr(spec.compiler, name, value)
    with pytest.warns(UntrustedWarning, match=f"^the parent's options spoil the can: {reason}"):
        attach(spec, standing())
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "compiler attribute 'settotalmass'")
        model = mujoco.MjModel.from_xml_string(spec.to_xml())
    of_the_can = build(standing())
    same_masses = np.allclose(model.body_mass, of_the_can.body_mass)
    same_inertias = np.allclose(model.body_inertia, of_the_can.body_inertia)
    assert not (same_masses and same_inertias)


def test_what_spoils_nothing_is_not_warned_of() -> None:
    """A load without damping needs no damper; level ground is no incline on which a liquid would
    get fast."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        attach(world(disableflags=int(mujoco.mjtDisableBit.mjDSBL_DAMPER)), sliding(can=METAL))
        attach(world(integrator=RK4), standing("water", modes=5))
        attach(world(), liquid("water", incline=0.0, can=METAL))


# Where the polynomial 1 - x + x^2/2 - x^3/6 + x^4/24 of a step of RK4 is 1: timestep times rate.
RK4_STABLE = 2.7853


@pytest.mark.parametrize(
    ("can", "joint"), [(standing(modes=3, damping_ratio=0.3), "slosh3"), (HONEY, "swing")]
)
def test_the_timestep_that_rk4_is_given_is_the_limit(can: Standing | Scene, joint: str) -> None:
    """Damping in proportion to the rate has a sharp limit, in the air."""

    def in_the_air(timestep: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
        spec = mujoco.MjSpec()
        spec.option.timestep = timestep
        spec.option.integrator = RK4
        attach(spec, can)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.joint(f"can-{joint}").qvel = 1e-6
        return model, data

    def diverges(model: mujoco.MjModel, data: mujoco.MjData) -> bool:
        with quiet():
            for _ in range(2000):
                mujoco.mj_step(model, data)
        return any(warning.number for warning in data.warning)

    model, data = in_the_air(1e-5)
    mujoco.mj_forward(model, data)
    spinning = data.joint(f"can-{joint}")
    limit = RK4_STABLE / np.max(-spinning.qacc / spinning.qvel)

    assert not diverges(*in_the_air(0.97 * limit))
    with pytest.warns(UntrustedWarning, match="its damping may diverge at"):
        model, data = in_the_air(1.03 * limit)
    assert diverges(model, data)


@pytest.mark.parametrize("modes", [0, 1])
def test_a_can_slides_as_coulomb_says(modes: int) -> None:
    """For two seconds, once it has begun; with MuJoCo's friction of 1 it stays, as the larger
    coefficient counts."""
    angle = math.radians(17)
    friction = 0.2
    velocities = []
    down = np.array([math.cos(angle), 0, -math.sin(angle)])
    turn = [math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0]
    for own in (friction, None):
        spec = mujoco.MjSpec()
        spec.option.timestep = 5e-4
        spec.worldbody.add_geom(
            type=PLANE, size=[0, 0, 1], quat=turn, friction=[friction, 0.005, 1e-4]
        )
        attach(spec, standing(modes=modes), quat=turn, friction=own)
        model = spec.compile()
        data = mujoco.MjData(model)
        for steps in (400, 4000):
            mujoco.mj_step(model, data, steps)
            mujoco.mj_forward(model, data)
            mujoco.mj_subtreeVel(model, data)
            velocities.append(float(data.subtree_linvel[model.body("can-can").id] @ down))
    expected = 9.81 * (math.sin(angle) - friction * math.cos(angle))
    # Exact but for the hops of a can that slides: of 60 starts that differ by 1e-6 m/s none is more
    # than 1.2 % off.
    assert velocities[1] - velocities[0] == pytest.approx(2 * expected, rel=0.03)
    assert abs(velocities[3]) < 0.05 * expected


@pytest.mark.parametrize(
    ("friction", "expected"),
    [(0.3, [0.3, 0.3, 0.02, 1e-4, 1e-4]), ([0.01, 0.03], [0.05, 0.05, 0.03, 1e-4, 1e-4])],
)
@pytest.mark.parametrize(
    ("can", "height", "solref", "solimp"),
    [
        (standing(modes=0), 0.0, [0.02, 1], [0.9, 0.95]),  # MuJoCo's own
        (sliding(can=METAL), METAL.radius, [2e-3, 1], [0.9999, 0.9999]),
    ],
)
def test_a_contact_takes_friction_as_between_any_geoms_and_a_lying_can_s_softness(
    can: Standing | Scene,
    height: float,
    solref: list[float],
    solimp: list[float],
    friction: float | list[float],
    expected: list[float],
) -> None:
    spec = world()
    spec.geom("floor").friction = [0.05, 0.02, 1e-4]
    spec.geom("floor").condim = 4
    attach(spec, can, [0, 0, height], friction=friction)
    contact = settled(spec, 0.1).contact
    assert len(contact) > 0
    assert np.allclose(contact.friction, expected)
    assert np.all(contact.dim == 4)
    # The numbers are those that are written, with some digits.
    assert np.allclose(contact.solref, solref, rtol=1e-7)
    assert np.allclose(contact.solimp[:, :2], solimp, rtol=1e-9)


# Another fill

OLD = standing(modes=3)
NEW = standing("water", 0.8, modes=3, damping_ratio=0.05)


def shared(can: Standing | Scene) -> mujoco.MjModel:
    """A can in a world with something else, before and behind."""
    spec = world()
    arm = spec.worldbody.add_body(name="arm")
    arm.add_joint(name="arm", axis=[0, 1, 0])
    arm.add_geom(size=[0.1] * 3)
    attach(spec, can, [1, 2, 3], prefix="own-")
    attach(spec, frozen(can=METAL), [2, 0, 3])
    return spec.compile()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (OLD, NEW),
        (standing(modes=0), standing(fill=0.2, modes=0)),
        (sliding(fill=1.0, can=METAL), sliding(fill=0.3, can=METAL, damping=1e-5)),
        (frozen(fill=0.3, can=METAL), frozen(fill=1.0, can=METAL)),
    ],
)
def test_a_can_is_filled_anew_as_if_it_were_compiled(
    old: Standing | Scene, new: Standing | Scene
) -> None:
    """Masses, and accelerations at a random state; of a standing can all arrays that there are."""
    filled = shared(old)
    compiled = shared(new)
    refill(filled, new, prefix="own-")
    names = (
        "body_mass",
        "body_inertia",
        "body_ipos",
        "body_subtreemass",
        "dof_damping",
        "dof_invweight0",
        "dof_M0",
    )
    if isinstance(new, Standing):
        names = tuple(
            name for name in dir(compiled) if isinstance(getattr(compiled, name), np.ndarray)
        )
    for name in names:
        assert np.array_equal(getattr(filled, name), getattr(compiled, name)), name
    random = np.random.default_rng(1)
    found = []
    qpos = compiled.qpos0.copy()
    qvel = random.normal(size=compiled.nv)
    mujoco.mj_integratePos(compiled, qpos, random.normal(size=compiled.nv), 1.0)
    for model in (filled, compiled):
        data = mujoco.MjData(model)
        data.qpos = qpos
        data.qvel = qvel
        mujoco.mj_forward(model, data)
        found.append(data.qacc.copy())
    # The same sums of the same numbers.
    assert np.array_equal(*found)


def test_what_cannot_be_filled_anew_is_refused() -> None:
    model = shared(OLD)
    boxed = standing(modes=3, can=BOX)
    for can, prefix in (
        (OLD, "other-"),
        (standing(modes=2), "own-"),
        (boxed, "own-"),
        (sliding(can=METAL), "can-"),
    ):
        with pytest.raises(
            ParameterError,
            match=f"the model must have a can under the prefix '{prefix}' with radius",
        ):
            refill(model, can, prefix)
    with pytest.raises(ParameterError, match="it has can, load, swing, slide"):
        refill(build(sliding(can=METAL), "equality"), sliding(can=METAL), "")
    small = {"can": Can.sheet_metal(0.008, 0.03), "modes": 5}
    with pytest.raises(UnsupportedError, match="moves no pendulum of less than 1e-15 kg m"):
        refill(build(standing(**small, damping_ratio=0.5)), standing(**small), "")
    model.opt.timestep = 0.05
    with pytest.warns(
        UntrustedWarning,
        match=r"the model's options spoil the can: the timestep of 0\.05 s is coarse",
    ):
        refill(model, NEW, "own-")


@pytest.mark.parametrize(
    ("can", "arguments", "error", "message"),
    [
        (
            standing(),
            {"body": "hand", "free": False},
            ParameterError,
            "body must be one of 'world'; got 'hand'",
        ),
        (standing(), {"pos": [0, 0]}, ParameterError, "pos must have 3 numbers, got"),
        (
            standing(),
            {"quat": [0, 0, 0, 0]},
            ParameterError,
            "quat must have 4 numbers, not all 0, got",
        ),
        (sliding(), {}, UnsupportedError, "no can without inertia around a sliding load"),
        (pendulum(), {}, UnsupportedError, "has beer in it, got a load without a fill"),
        (sliding(can=METAL, drag=0.1), {}, UnsupportedError, "no drag of the air"),
        ("beer", {}, ParameterError, "can must be a Standing or a Scene, got 'beer'"),
        (
            standing(),
            {"friction": [1, 0, 0, 0]},
            ParameterError,
            "friction must be 1, 2 or 3 numbers of 0 or more",
        ),
        (
            standing(),
            {"friction": -0.1},
            ParameterError,
            "friction must be 1, 2 or 3 numbers of 0 or more, got -0.1",
        ),
        (
            standing(),
            {"friction": "steel"},
            ParameterError,
            "friction must be a list .* of one or more numbers, got",
        ),
    ],
)
def test_what_cannot_be_attached_is_refused(
    can: object, arguments: dict[str, object], error: type[MjbeerError], message: str
) -> None:
    with pytest.raises(error, match=message):
        attach(world(), can, **arguments)


@pytest.mark.parametrize("free", [True, False])
def test_what_mujoco_cannot_move_is_refused_as_by_build(free: bool) -> None:
    """A pendulum of a small can, whose inertia is below MuJoCo's least; the parent stays as it
    was."""
    can = standing(can=Can.sheet_metal(0.004, 0.01), modes=5)
    spec = world()
    with pytest.raises(
        UnsupportedError, match=r"^MuJoCo cannot represent this scene: .*than mjMINVAL"
    ) as built:
        build(can, free=free)
    before = spec.to_xml()
    with pytest.raises(UnsupportedError) as attached:
        attach(spec, can, free=free)
    assert str(attached.value).partition("Element")[0] == str(built.value).partition("Element")[0]
    assert spec.to_xml() == before
    assert spec.compile().nbody == 1


def test_a_massless_frozen_can_and_other_sizes_move_too() -> None:
    light = Scene(Can(), Load.segment(), 0.0, "frozen")
    spec = world()
    attach(spec, light, [0, 0, Can().radius])
    attach(spec, standing(can=BOX, fill=0.3, modes=5), [1, 0, 0], prefix="large-")
    data = settled(spec, 0.3)
    assert data.body("can-can").xpos[2] == pytest.approx(Can().radius, abs=1e-6)
