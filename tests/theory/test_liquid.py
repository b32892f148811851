"""Damping of real liquids: the coefficients of the laws by their boundary value problems, the fit,
and the scenes."""

import math
import re
import warnings
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import brentq

from mjbeer import Can, LiquidWarning, Load, Scene, exact, liquid, sliding
from mjbeer.exceptions import NoEquilibriumError, ParameterError
from mjbeer.theory import slosh
from mjbeer.theory.equations import accelerations, resting_tilt, slip_rate_of
from mjbeer.theory.liquid import liquid_in, lump_warning
from mjbeer.theory.liquid_damping import ENDS, FILM_LOAD, WALL
from mjbeer.theory.liquid_properties import LIQUIDS
from mjbeer.theory.segment import segment
from tests.support.scenes import METAL

# The coefficients are rounded to four and five digits.
DIGITS = 1e-4
# Products and roots of a few numbers.
ROUNDING = 1e-14
# Of the polynomial, over a decade of slip rates.
FIT_ERROR = 0.0785


def test_wall_is_sakiadis_layer() -> None:
    """f''' + f f''/2 = 0 with f = 0, f' = 1 at the wall and f' = 0 far away: the drag is -2
    f''(0)."""
    x = np.linspace(0, 20, 200)
    found = solve_bvp(
        lambda _, y: np.array([y[1], y[2], -y[0] * y[2] / 2]),
        lambda wall, far: np.array([wall[0], wall[1] - 1, far[1]]),
        x,
        np.array([1 - np.exp(-x), np.exp(-x), -np.exp(-x)]),
        tol=1e-8,
        max_nodes=10_000,
    )
    assert found.success
    assert -2 * found.y[2, 0] == pytest.approx(WALL, rel=DIGITS)


def test_ends_are_von_karman_s_layers() -> None:
    """On one face of a whole disc the torque is pi/2 times -G'(0), over rho sqrt(nu) W^1.5 a^4."""

    def slope(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        radial, radial_slope, turning, turning_slope, axial = y
        return np.array(
            [
                radial_slope,
                radial**2 - turning**2 + axial * radial_slope,
                turning_slope,
                2 * radial * turning + axial * turning_slope,
                -2 * radial,
            ]
        )

    def excess(wall: np.ndarray, far: np.ndarray) -> np.ndarray:
        return np.array([wall[0], wall[2] - 1, wall[4], far[0], far[2]])

    x = np.linspace(0, 20, 400)
    decay = np.exp(-x)
    guess = np.array([0.5 * x * decay, 0.5 * decay, decay, -decay, -0.88 * (1 - decay)])
    found = solve_bvp(slope, excess, x, guess, tol=1e-7, max_nodes=10_000)
    assert found.success
    assert -2 * found.y[3, 0] == pytest.approx(ENDS, rel=DIGITS)


def test_the_wall_carries_round_what_moffatt_says() -> None:
    """A film of thickness h on a turning wall carries h - h^3 cos(theta)/3, in units of the film
    and of U. It reaches all round up to 2/3, where h = 1 at the side that rises; then the volume is
    the integral of h."""

    def excess(thickness: float, cosine: float) -> float:
        return thickness - cosine * thickness**3 / 3 - 2 / 3

    angles = np.linspace(0, math.pi, 2001)
    film = [1.0]
    for cosine in np.cos(angles[1:]):
        film.append(brentq(excess, 0, 1, args=(cosine,)))
    assert 2 * np.trapezoid(film, angles) == pytest.approx(FILM_LOAD, rel=DIGITS)

    used = liquid_in("olive oil", fill=0.25)
    thickness = math.sqrt(used.viscosity * 0.033 * used.slip_rate / 9.81)
    carried = FILM_LOAD * thickness * 0.033
    area = segment(0.25).area * 0.033**2
    assert used.carried == pytest.approx(carried / area, rel=ROUNDING)


def test_the_fit_is_as_near_as_it_says() -> None:
    used = liquid_in("water")
    exact_torque = used.damping.torque(used.slip_rate)
    assert exact_torque == pytest.approx(
        sliding(density=used.density).mass * 9.81 * 0.033 * math.sin(math.radians(10))
    )
    assert used.damping.valid_rates == pytest.approx(
        (0.139 * used.slip_rate, 1.39 * used.slip_rate)
    )
    x = np.geomspace(0.139, 1.39, 2001)
    ratio = used.damping.torque(used.slip_rate * x) / (exact_torque * x**1.5)
    # The ends are rounded to three digits, where the ratio is steep; inside it is level.
    assert abs(ratio - 1).max() == pytest.approx(FIT_ERROR, rel=0.02)
    assert ratio.min() == pytest.approx(1 - FIT_ERROR, rel=DIGITS)


ESTIMATES = [("water", 4.2), ("beer", 3.6), ("olive oil", 0.95), ("honey", 0.04)]
"""Terminal speeds [m/s] half full, 33 x 120 mm, at 10 degrees, as estimated once."""
# The estimates are rounded, and were made with slightly other viscosities.
OTHER_VISCOSITIES = 0.15


@pytest.mark.parametrize(("name", "speed"), ESTIMATES)
def test_liquids_roll_as_estimated(name: str, speed: float) -> None:
    scene = liquid(name)
    used = liquid_in(name)
    assert scene.terminal_speed() == pytest.approx(used.slip_rate * 0.033, rel=ROUNDING)
    assert scene.terminal_speed() == pytest.approx(speed, rel=OTHER_VISCOSITIES)
    assert used.law == ("creep" if name == "honey" else "thin layers")


def test_a_thick_liquid_swings_with_stokes_layers() -> None:
    used = liquid_in("glycerol", incline=0.0, viscosity=1e-3, density=1000.0)
    omega = sliding(0.0).frequency()
    wall = math.pi * 0.033**3 * 0.12
    ends = math.pi * 0.033**4 / 2
    expected = 1000 * math.sqrt(1e-3 * omega / 2) * (wall + ends)
    assert used.damping.linear == pytest.approx(expected, rel=ROUNDING)


def swing_among(rates: np.ndarray) -> complex:
    """The rate [1/s] of the swing among those of small motions."""
    return max(rates, key=lambda rate: rate.imag)


@pytest.mark.parametrize("can", [None, METAL], ids=["massless", "metal"])
@pytest.mark.parametrize("name", ["water", "olive oil"])
@pytest.mark.parametrize("fill", [0.5, 0.75, 0.9])
def test_a_thin_liquid_swings_and_decays_as_the_slowest_mode(
    fill: float,
    name: str,
    can: Can | None,
) -> None:
    """The mode's frequency has no damping; the load's, like its decay, errs by zeta squared."""
    scene = liquid(name, 0.0, fill, can)
    modes = slosh.rolling(fill, scene.effective_mass / scene.load.mass)
    nu = LIQUIDS[name].viscosity
    zeta = sum(modes.damping_ratios(scene.can.radius, scene.can.length, scene.gravity, nu))
    omega = modes.frequencies(scene.can.radius, scene.gravity)[0]
    swing = swing_among(scene.modes())
    assert abs(swing) == pytest.approx(omega, rel=5 * zeta**2)
    assert -swing.real == pytest.approx(zeta * omega, rel=5 * zeta**2)


SLOSHES = [
    {"name": "water"},
    {"name": "beer"},
    {"name": "olive oil"},
    {"fill": 0.25, "can": METAL},
    {"fill": 0.75, "incline": 0.0},
]
TURNS = [
    ({"name": "glycerol"}, r"its layers are 0\.19 radii thick, and slosh has 0\.1 at most"),
    ({"name": "honey"}, r"its layers are 0\.46 radii"),
    ({"fill": 0.995, "incline": 0.0}, r"its fill is not within 0\.01 to 0\.99"),
    ({"fill": 0.75}, "the incline is too steep to hold it"),
    (
        {"fill": 0.2},
        "ice swings faster than the slowest mode of its slosh, which has only 15 % of the energy",
    ),
]


@pytest.mark.filterwarnings("ignore::mjbeer.LiquidWarning")
def test_thin_liquids_slosh_and_the_others_turn_as_ice() -> None:
    """The mass and its place are the same."""
    for given in SLOSHES:
        used = liquid_in(**given)
        load = liquid(**given).load
        assert not used.swing.as_ice
        assert load == used.swing.load
        assert load == Load.liquid(given.get("can", Can()), given.get("fill", 0.5), used.density)
    for given, reason in TURNS:
        used = liquid_in(**given)
        load = liquid(**given).load
        assert re.match(reason, used.swing.as_ice)
        assert load == used.swing.load
        assert load == Load.segment(fill=given.get("fill", 0.5), density=used.density)


def test_slosh_ends_at_one_viscosity() -> None:
    """Half full at 3.2e-4 m^2/s, where no liquid of ours is: what the step changes."""
    omega = liquid("water", 0.0).frequency()
    limit = (0.1 * 0.033) ** 2 * 29.904
    assert limit == pytest.approx(3.2e-4, rel=0.02)
    below = liquid_in("water", 0.0, viscosity=0.999 * limit).swing
    above = liquid_in("water", 0.0, viscosity=1.001 * limit).swing
    assert not below.as_ice
    assert above.as_ice
    assert below.frequency == pytest.approx(omega, rel=1e-3)
    assert below.frequency / above.frequency == pytest.approx(1.51, abs=0.005)
    swing = swing_among(liquid("water", 0.0, viscosity=0.999 * limit).modes())
    # Half of the amplitude is lost in less than a period.
    assert math.log(2) / -swing.real == pytest.approx(0.9 * math.tau / swing.imag, rel=0.1)


def test_a_liquid_with_several_modes_is_told() -> None:
    """Below 0.8 of the energy, whether the load sloshes or has the inertia of ice."""
    for fill, share, inertia in ((0.4, "72 %", "of that mode"), (0.2, "15 %", "of ice")):
        message = f"the slowest mode has {share} of the energy .* has the inertia {inertia}$"
        with pytest.warns(LiquidWarning, match=message) as given:
            liquid("water", 0.0, fill)
        assert [warning.filename for warning in given] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        liquid("water", 0.0, 0.5)
        liquid("water", 0.0, 0.25, METAL)
        liquid("glycerol", 0.0, 0.4)


@pytest.mark.parametrize("fill", [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4])
@pytest.mark.parametrize("can_ratio", [0.0, 0.02])
def test_a_puddle_has_the_better_of_two_loads(fill: float, can_ratio: float) -> None:
    """A flat tilt that is let go, in two swings of the mode with most of the energy.

    Where the two loads change places, at a fill of 0.22 or so, they are equally good.
    """
    can = Can(mass=can_ratio * Load.segment(fill=fill).mass)
    load = liquid_in("water", 0.0, fill, can).swing.load
    modes = slosh.rolling(fill, 1 + can_ratio)
    frequencies = modes.frequencies(can.radius, 9.81)
    most = frequencies[modes.energy_shares.argmax()]
    times = np.linspace(0, 2 * math.tau / most, 2001)
    tilt = np.cos(np.outer(times, frequencies)) @ modes.energy_shares

    def left_out(frequency: float) -> float:
        return float(np.sqrt(np.mean((np.cos(frequency * times) - tilt) ** 2)))

    ice = Scene(can, Load.segment(fill=fill), 0.0).frequency()
    sloshes = load.sloshes_in is not None
    chosen, other = (frequencies[0], ice) if sloshes else (ice, frequencies[0])
    assert left_out(chosen) < left_out(other)


def test_both_loads_are_one_where_they_change_places() -> None:
    """In a can without mass at a fill of 0.2265."""
    puddle = liquid_in("water", 0.0, 0.2265).swing
    above = liquid_in("water", 0.0, 0.2266).swing
    assert puddle.as_ice
    assert not above.as_ice
    assert puddle.load.inertia == pytest.approx(above.load.inertia, rel=5e-3)
    assert puddle.frequency == pytest.approx(above.frequency, rel=1e-3)


@pytest.mark.slow
def test_damping_is_continuous_towards_level_ground() -> None:
    """How far water in a metal can still swings in the second second. The rest of W_steady, which
    goes with the incline to 2/3, is 1e-6 of the swing's at 1e-9 rad."""

    def kept(incline: float) -> float:
        scene = liquid("water", incline, can=METAL)
        motion = exact(scene, np.linspace(1, 2, 501), 1.0)
        return float(np.abs(motion.phi - scene.terminal_tilt()).max())

    level = kept(0.0)
    assert level == pytest.approx(0.957, abs=1e-3)  # three digits
    for incline, apart in ((1e-9, 1e-6), (1e-6, 5e-3), (1e-4, 0.1)):
        assert abs(kept(incline) / level - 1) < apart


def test_the_law_says_where_it_holds() -> None:
    """Creep holds down to 0, and so does a swing, up to where layers of rolling have its torque."""
    assert liquid_in("honey").damping.valid_rates == pytest.approx((0.0, 217), rel=0.01)
    assert liquid_in("water", incline=0.0).damping.valid_rates == pytest.approx(
        (0.0, 1.39 * 56.5), rel=0.01
    )


WARNED = {
    "water": "terminal speed of 4.2 m/s the wall's centrifugal acceleration is more than g",
    "olive oil": "terminal speed of 0.94 m/s the wall's centrifugal acceleration is more than g",
    "glycerol": "it coats the can: at .* rad/s the film on the wall can hold 45 % of it",
}


@pytest.mark.parametrize("name", WARNED)
def test_a_liquid_that_is_no_lump_at_its_terminal_speed_warns_once(name: str) -> None:
    with pytest.warns(
        LiquidWarning, match=f"{name} as one lump is an order of magnitude.*{WARNED[name]}"
    ) as given:
        liquid(name)
    assert [warning.filename for warning in given] == [__file__]
    with pytest.warns(LiquidWarning, match="water as one lump .* can hold all of it"):
        liquid(fill=0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        liquid(name, incline=0.0)


@pytest.mark.parametrize(("fill", "degrees"), [(0.5, 60), (0.75, 10), (0.995, 10)])
def test_an_incline_too_steep_to_hold_a_liquid_is_told(fill: float, degrees: float) -> None:
    """There is no terminal speed then, at which the other reasons are looked for."""
    reason = "the incline is too steep to hold it, and the can carries it round"
    message = f"^water as one lump is an order of magnitude only: {reason}$"
    with pytest.warns(LiquidWarning, match=message):
        scene = liquid("water", math.radians(degrees), fill)
    with pytest.raises(NoEquilibriumError):
        scene.terminal_speed()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"fill": 1.0}, r"a full can has no free surface: fill must be less than 1, got 1\.0$"),
        (
            {"gravity": 0},
            r"without gravity a liquid does not slosh.* must be more than 0 \[m/s\^2\], got 0$",
        ),
        (
            {"viscosity": 1e-9},
            r"turbulent, with a Reynolds number of 4\.4e\+09 where 1e\+06 is the limit: .* 1e-09 m",
        ),
    ],
)
def test_what_is_no_liquid_of_ours_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        liquid("water", **given)


def test_a_liquid_says_what_damps_it() -> None:
    rolls = "damped by thin layers at a slip rate of 128 rad/s"
    assert str(liquid_in("water")) == f"water: 998.2 kg/m^3, 1e-06 m^2/s, sloshes, {rolls}"
    on_level_ground = str(liquid_in("honey", 0.0))
    assert on_level_ground.endswith("swings as ice, damped by creep")
    assert str(liquid_in("water", 0.0)).endswith("sloshes, damped by swinging")


def test_a_run_says_when_its_liquid_is_no_lump_any_more() -> None:
    """At sqrt(g a cos(alpha)) = 0.565 m/s; and where the slip rates are not those of the law."""
    scene = liquid("water", incline=math.radians(10))
    run = exact(scene, np.linspace(0, 1, 1001), 0.0)
    time = run.record.no_lump_at
    speed = float(np.interp(time, run.time, run.u_dot))
    limit = math.sqrt(9.81 * math.cos(scene.incline) * 0.033)
    assert speed == pytest.approx(limit, abs=2e-3)  # a sample later, at 1.7 m/s^2
    assert run.record.largest_slip_rate == np.abs(slip_rate_of(scene, run.phi_dot, run.u_dot)).max()
    (told,) = run.liquid_warnings
    assert (
        f"the liquid as one lump is an order of magnitude only: from t = {time:.6g} s on the wall's"
        in told
    )
    assert told in run.warnings
    assert not run.trusted
    assert exact(scene, run.time[:10], 0.0).record.no_lump_at == math.inf
    assert lump_warning("water", scene, 50.0, "", 0.0) is None
    about = lump_warning("water", scene, 200.0, "", 0.0)
    assert "17.8 to 178 rad/s between can and liquid, which slips by 200" in str(about)


@pytest.mark.parametrize(
    ("degrees", "seconds", "share"), [(10, 1, None), (10, 8, "57 %"), (2, 8, None)]
)
def test_a_film_is_a_reason_once_the_wall_has_carried_it_up(
    degrees: float, seconds: float, share: str | None
) -> None:
    """Honey creeps at 1.2 rad/s on 10 degrees, where its film can hold 45 %; it is let go faster
    than that.

    A turn takes it 5 s. On 2 degrees its film holds a fifth.
    """
    scene = liquid("honey", math.radians(degrees))
    run = exact(scene, np.linspace(0, seconds, 801), -scene.incline)
    film = math.sqrt(7e-3 * 0.033 * run.record.largest_slip_rate / 9.81)
    carried = FILM_LOAD * film * 0.033 / (math.pi / 2 * 0.033**2)
    assert run.trusted == (share is None)
    if share:
        assert f"{100 * carried:.0f} %" == share
        assert f"the film on the wall can hold {share} of it" in run.warnings[0]


def test_the_rest_of_the_surface_is_that_of_the_present_rates() -> None:
    """Where the load does not accelerate: at the terminal speed, and without friction."""
    scene = liquid("water", math.radians(1), can=METAL, drag=0.01)
    speed = scene.terminal_speed()
    rest = resting_tilt(scene, np.zeros(1), np.array([speed]))
    assert rest == pytest.approx(scene.terminal_tilt(), rel=1e-12)
    free = Scene(METAL, Load.liquid(METAL), math.radians(5))
    assert resting_tilt(free, np.zeros(1), np.ones(1)) == pytest.approx(free.equilibrium())
    for u_dot in (0.0, 0.1, 0.3):
        rest = float(resting_tilt(scene, np.zeros(1), np.array([u_dot]))[0])
        assert abs(accelerations(scene, rest, 0.0, u_dot).phi_ddot) < 1e-10


@pytest.mark.parametrize("turns", [0, 1])
def test_a_surface_that_tilts_beyond_linear_theory_is_told(turns: int) -> None:
    """Damped or not, and also after a whole turn; 0.2 rad is allowed."""
    free = Scene(METAL, Load.liquid(METAL), 0.0)
    times = np.linspace(0, 0.3, 301)
    start = math.tau * turns
    for scene in (free, liquid("water", 0.0, can=METAL)):
        assert exact(scene, times, start + 0.199).liquid_warnings == ()
        run = exact(scene, times, start + 0.3)
        assert run.record.largest_tilt == pytest.approx(0.3, rel=1e-6)
        assert run.liquid_warnings == (
            "the surface tilts by up to 0.3 rad against its rest: "
            "linear theory of slosh holds up to 0.2 rad",
        )
        assert not run.trusted


def test_a_load_that_loops_is_no_liquid() -> None:
    damped = Scene(METAL, Load.liquid(METAL), 0.0, damping=1e-7)
    run = exact(damped, np.linspace(0, 0.5, 501), 0.0, 150.0)
    assert run.phi[-1] > math.tau
    assert run.liquid_warnings == (
        "the load stands for a liquid that sloshes, and turns round, as no liquid does",
    )
