"""A trajectory judges itself: an exact one is trusted, and one that was tampered with is not, for
the right reason."""

import math
import pathlib
from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.optimize import brentq

from mjbeer import MjbeerError, Scene, Trajectory, exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.exceptions import OutputError
from mjbeer.theory.equations import Coordinates, select_samples
from mjbeer.theory.record import (
    ERROR,
    LIFT,
    SLIP,
    Record,
    RecordMaker,
    failed_checks,
    rolling_failures,
)
from mjbeer.theory.trajectory import csv, largest_angle_error
from tests.support.scenes import METAL, SCENES

# After 2 s the can as a whole has some thousand times the energy of the swing, to which a drift is
# compared.
DRIFT = 1e-11
ROUNDING = 1e-14
TIME = np.linspace(0, 2, 401)


@pytest.mark.parametrize("scene", [sliding(can=METAL), frozen(-0.2), pendulum(), hoop(0.1)])
def test_energy_of_any_state(scene: Scene) -> None:
    """Of two bodies whose positions and speeds are written down in the upright frame, not in the
    incline's."""
    can = scene.can
    load = scene.load
    alpha = scene.incline
    downhill = np.array([math.cos(alpha), -math.sin(alpha)])
    off = np.array([math.sin(alpha), math.cos(alpha)])
    axis = 0.3 * downhill + 0.01 * off
    axis_dot = 1.1 * downhill + 0.4 * off
    # theta = alpha + phi is the load's angle to the plumb line, positive uphill (Fig. 3)
    theta = alpha + 0.7
    position = axis - load.offset * np.array([math.sin(theta), math.cos(theta)])
    speed = axis_dot - load.offset * -3.0 * np.array([math.cos(theta), -math.sin(theta)])
    kinetic = (
        can.mass * axis_dot @ axis_dot
        + load.mass * speed @ speed
        + can.inertia * 5.0**2
        + load.inertia * 3.0**2
    )
    potential = scene.gravity * (can.mass * axis[1] + load.mass * position[1])
    state = replace(
        exact(scene, [0.0], 0.7, -3.0),
        u=np.array([0.3]),
        u_dot=np.array([1.1]),
        phi_dot=np.array([-3.0]),
        roll_dot=np.array([5.0]),
        lift=np.array([0.01]),
        lift_dot=np.array([0.4]),
    )
    assert state.energy == pytest.approx([kinetic / 2 + potential], rel=ROUNDING)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize(("phi0", "phi_dot0"), [(0.8, 0.0), (-0.5, 3.0)])
def test_exact_motion_is_trusted(scene: Scene, phi0: float, phi_dot0: float) -> None:
    motion = exact(scene, TIME, phi0, phi_dot0)
    assert motion.energy_drift < DRIFT
    assert np.abs(motion.slip).max() <= 2 * ROUNDING * np.abs(motion.u).max()
    assert motion.warnings == ()
    assert motion.trusted
    assert motion.rolls_until() == math.inf


def moved(motion: Trajectory, along: np.ndarray, up: np.ndarray | float = 0.0) -> Trajectory:
    """Down the incline by rolling, and away from it."""
    rolled = along / motion.scene.can.radius
    return replace(motion, u=motion.u + along, roll=motion.roll + rolled, lift=motion.lift + up)


def gaining(motion: Trajectory, error: float) -> Trajectory:
    """Swinging ever faster or slower, by as much as takes phi off by an error over its way.

    The energy grows in proportion to the time. Its integral over the angle that the load covers is
    `error` times the largest kinetic energy, relative beyond 1 rad turned: so a record measures it.
    """
    inertia = motion.scene.oscillator.inertia(motion.phi)
    kinetic = inertia * motion.phi_dot**2 / 2
    turned = np.abs(motion.phi - motion.phi[0]).max()
    covered = np.append(0.0, np.abs(np.diff(motion.phi)))  # in each interval [rad]
    share = TIME / TIME[-1]
    gained_at_end = error * kinetic.max() * max(1, turned) / (covered @ share)
    rate = np.sqrt(2 * np.maximum(kinetic + gained_at_end * share, 0) / inertia)
    return replace(motion, phi_dot=np.copysign(rate, motion.phi_dot))


def lifted(motion: Trajectory, radii: float) -> Trajectory:
    """Along the horizontal, so that no energy is gained."""
    up = radii * motion.scene.can.radius * TIME / TIME[-1]
    return moved(motion, up / math.tan(motion.scene.incline), up)


def slipped(motion: Trajectory, radii: float) -> Trajectory:
    return replace(motion, roll=motion.roll + radii * TIME / TIME[-1])


@pytest.mark.parametrize("scene", [sliding(can=METAL), frozen()])
@pytest.mark.parametrize(
    ("tamper", "trusted", "warning"),
    [
        (
            gaining,
            ERROR,
            "energy or momentum drifts as with an error of 0.012 rad of phi or u/a "
            "(trusted up to 0.01)",
        ),
        (slipped, SLIP, "the can slips by 0.0012 radii (trusted up to 0.001)"),
        (
            lifted,
            LIFT,
            "the can parts from the incline, or sinks in, by 0.0012 radii (trusted up to 0.001)",
        ),
    ],
)
def test_tampering_is_noticed(scene: Scene, tamper: Callable, trusted: float, warning: str) -> None:
    """Just beyond what is trusted there is one warning, just within it there is none, and so for
    the other sign."""
    motion = exact(scene, TIME, 0.8)
    for sign in (1, -1):
        noticed = tamper(motion, sign * 1.2 * trusted)
        (noticed_warning,) = noticed.warnings
        assert warning in noticed_warning
        assert not noticed.trusted
        assert tamper(motion, sign * 0.8 * trusted).trusted


@pytest.mark.parametrize("scene", [sliding(), pendulum()])
def test_a_lost_momentum_is_noticed(scene: Scene) -> None:
    """An axis that runs ahead steadily breaks no energy of the swing, and does not slip."""
    motion = exact(scene, TIME, 0.8)
    distance = np.abs(motion.u - motion.u[0]).max()
    for share, trusted in [(1.2, False), (-1.2, False), (0.8, True)]:
        ahead = moved(motion, share * ERROR * distance * (TIME / TIME[-1]) ** 2)
        assert ahead.record.swing_error == motion.record.swing_error
        assert ahead.trusted == trusted
        # The motion itself drifts by rounding only, a trillionth of what is added.
        drift = abs(share) * ERROR * distance
        assert ahead.record.axis_drift == pytest.approx(drift, rel=1e-12)


SAME_HOWEVER_CUT = [
    "slip",
    "lift",
    "largest_turn",
    "largest_distance",
    "largest_rate",
    "needed_friction",
    "rolling_ends_at",
    "energy_drift",
    "axis_drift",
]


def test_a_record_does_not_depend_on_how_a_motion_is_cut() -> None:
    """Not even where rolling stops being possible between two pieces."""
    motion = gaining(exact(frozen(), TIME, math.pi), 1e-2)
    whole = Record.of(motion, motion.scene)
    maker = RecordMaker(motion.scene)
    fails = int(np.searchsorted(TIME, whole.rolling_ends_at))
    for samples in np.split(np.arange(len(TIME)), [1, 7, fails, 300]):
        maker.add(select_samples(motion, samples))
    pieces = maker.record
    for name in SAME_HOWEVER_CUT:
        assert getattr(pieces, name) == getattr(whole, name)
    # Energies are rounded, and summed in another order.
    assert pieces.swing_drift == pytest.approx(whole.swing_drift, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("name", ["phi", "u", "phi_dot", "roll", "lift"])
def test_a_number_that_is_not_finite_is_never_trusted(name: str) -> None:
    motion = exact(sliding(can=METAL), TIME, 0.8)
    arrays = {field.name: getattr(motion, field.name).copy() for field in fields(Coordinates)}
    arrays[name][200] = np.nan
    with np.errstate(invalid="ignore"):
        assert failed_checks(Record.of(Coordinates(**arrays), motion.scene), "reduced")


def test_frozen_can_from_the_top_leaves_the_incline() -> None:
    motion = exact(frozen(), TIME, math.pi)
    (warning,) = motion.warnings
    until = motion.rolls_until()
    assert warning.startswith(
        f"from t = {until:.6g} s the incline would have to pull at the can (N < 0)"
    )

    # N crosses zero there; the straight line between two samples is off by their distance squared
    # times N''/8N'.
    def normal_at(time: float) -> float:
        return exact(frozen(), [time], math.pi).forces.normal[0]

    crossing = brentq(normal_at, until - 0.01, until + 0.01)
    late = abs(until - crossing)
    assert late < TIME[1] / 10
    fine = exact(frozen(), np.linspace(0, 2, 4001), math.pi)
    assert abs(fine.rolls_until() - crossing) < late / 50  # 100, but for where in between N is 0
    assert rolling_failures(motion.record, "contact", 1.0) == (
        "rolling needs a friction coefficient of inf, and the contact has 1: it slides",
    )


def test_friction_that_holds() -> None:
    """At the frozen equilibrium tan(alpha) is needed from the start (footnote 7), elsewhere from
    when it runs out."""
    scene = frozen(-0.1)
    rest = exact(scene, TIME, scene.equilibrium())
    assert rest.rolls_until(1.001 * abs(math.tan(scene.incline))) == math.inf
    assert rest.rolls_until(0.999 * abs(math.tan(scene.incline))) == 0

    motion = exact(scene, TIME, 0.0)
    needed = motion.forces.needed_friction
    most = float(needed.max())
    until = motion.rolls_until(0.9 * most)
    assert 0 < until < 2
    first = np.flatnonzero(needed > 0.9 * most)[0]
    assert TIME[first - 1] <= until <= TIME[first]
    assert motion.rolls_until(1.01 * most) == math.inf


@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum(), frozen(-0.2, can=METAL)])
def test_frequency_is_that_of_the_period(scene: Scene) -> None:
    """Of fourth order in the sampling: the cubic between two samples has an error of h^4 phi_ddddot
    / 384. Three samples a period are enough, and an awkward number of them, so that turning points
    do not fall on samples."""
    period = scene.period(0.5)
    for samples in (3.37, 24.37, 96.37):
        time = np.arange(0, 20.3 * period, period / samples)
        measured = exact(scene, time, scene.equilibrium() + 0.5).frequency()
        assert (
            abs(measured * period / (2 * math.pi) - 1)
            < (2 * math.pi / samples) ** 4 / 384 + ROUNDING
        )


@pytest.mark.parametrize("beside", [1e-13, 1e-6])
@pytest.mark.parametrize("rolling", ["reduced", "contact"])
def test_a_load_at_rest_has_no_frequency(rolling: str, beside: float) -> None:
    """Rounding moves it, and the ringing of a contact: 2.81, 13.76 and 13.07 rad/s were measured
    for 12.26."""
    scene = frozen(can=METAL)
    run = simulate(scene, 4.0, scene.equilibrium() + beside, rolling=rolling)
    with pytest.raises(MjbeerError, match="no frequency: "):
        run.frequency()


def test_a_table_has_what_a_motion_has(tmp_path: pathlib.Path) -> None:
    motion = exact(frozen(), [0.0, 0.1], 1.0)
    assert motion.to_dataframe()["u [m]"].tolist() == motion.u.tolist()
    motion.to_csv(tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_text() == csv(motion)
    with pytest.raises(OutputError, match="it is a folder"):
        motion.to_csv(tmp_path)


def test_an_error_is_relative_to_the_way_so_far() -> None:
    """Turned by 0.5, 4 and 1 rad: the second and the third error are divided by 4. And what is no
    number is far off."""
    true_angles = np.array([[0.5], [4.0], [1.0]])
    angles = true_angles + np.array([[0.1], [0.6], [0.8]])
    assert largest_angle_error(angles, true_angles) == pytest.approx(0.8, rel=1e-15)
    assert largest_angle_error(angles, true_angles, np.zeros(1)) == pytest.approx(0.2, rel=1e-15)
    angles[1] = np.nan
    assert largest_angle_error(angles, true_angles) == math.inf
