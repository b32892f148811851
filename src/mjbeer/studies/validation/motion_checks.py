"""Checks of undamped motions against exact theory, of models, of laws towards extremes, and of drift."""

import math
from collections.abc import Callable, Iterator
from functools import cache, partial

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.checks import Check, observed_order
from mjbeer.model.setting import DOP853, INTEGRATORS, Integrator, Rolling, Setting, supported
from mjbeer.paper.frozen import equilibrium_53, frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.paper.witness import TOP, fall_from_top
from mjbeer.simulation.run import Simulator
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact, phi_error
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.trajectory import mean_acceleration

_FRICTION = 10.0
"""Friction coefficient of the runs with contact. Rolling without slipping needs 1.2 at most in any of them."""
_METAL = Can.sheet_metal()
"""The 12-oz aluminium can of the paper's section 3."""
_BESIDE_FOLD = np.array([1e-6, 1e-7, 1e-8])
"""Relative distances of sin(alpha) from that of the steepest incline with an equilibrium, the fold."""
_BESIDE_SEPARATRIX = np.array([1e-4, 1e-6, 1e-8, 1e-10])
"""Distances [rad] of the start from the end of the largest swing, the separatrix."""
_ALIKE = ((2e-4, 9.81), (1e-3, 9.81), (25.0, 9.81), (0.033, 1e-3), (0.033, 1e3))
"""Radii [m] and gravities [m/s^2] at which the scaled motion must be the same."""
ORDERS: dict[Integrator, tuple[int, float]] = {"RK4": (4, 0.2), DOP853: (8, 0.5)}
"""Order of each integrator, and the largest difference of the observed order from it."""
ORDERS |= {name: (1, 0.1) for name in INTEGRATORS if name != "RK4"}
_NODES = 40
"""Nodes of the quadrature over a swing. The integrand is smooth: the error is 1e-15 at an amplitude of 1 rad."""
_GRIP = 1e6
"""Friction coefficient so large that the hoop never slips."""


def checks() -> Iterator[Check]:
    """Yield the checks of motions near an equilibrium or about a second long."""
    yield from _oscillations()
    torques = "rounding of the torques, over 5 s of rest"
    rests: dict[Rolling, tuple[float, str]] = {
        "reduced": (1e-12, torques),
        "equality": (1e-12, torques),
        "contact": (1e-6, "the can settles on its soft contact, rocks and creeps"),
    }
    for name, scene in (("eq. (53)", frozen()), ("eq. (53), metal can", frozen(can=_METAL))):
        for rolling, (bound, reason) in rests.items():
            quantity, by = f"equilibrium, {name}, 5 s at rest", f"frozen, {rolling}, RK4, 1 ms"
            yield Check("rest", quantity, partial(_creep, scene, rolling), by, bound, "rad", reason)
    scenes = {"sliding": sliding(), "sliding, metal can": sliding(can=_METAL), "frozen": frozen()}
    scenes |= {"frozen, metal can": frozen(can=_METAL), "pendulum": pendulum()}
    errors: tuple[tuple[Rolling, float, str], ...] = (("reduced", 1e-7, "RK4"), ("equality", 1e-7, "RK4"))
    for rolling, bound, reason in (*errors, ("contact", 1e-4, "softness, slip")):
        for name, scene in scenes.items():
            if supported(scene, rolling):
                by, measure = f"{name}, {rolling}, RK4, 1 ms", partial(_error, scene, rolling)
                yield Check("trajectories", "phi over 2 s from 1 rad", measure, by, bound, "rad", reason)
    for name, scene, phi0, phi_dot0 in (
        ("sliding", sliding(), 1.0, 0.0),
        ("sliding, metal can, looping", sliding(can=_METAL), 0.0, 45.0),
        ("frozen", frozen(), 1.0, 0.0),
        ("frozen, rolling down", frozen(), math.pi, 0.0),
        ("pendulum", pendulum(), 1.0, 0.0),
    ):
        by, run = f"{name}, reduced, DOP853", partial(simulate, scene, 2, phi0, phi_dot0, tolerance=1e-10)
        measure = lambda run=run: phi_error(run(), relative=True)  # noqa: E731
        yield Check("tolerances", "phi over 2 s, tolerance 1e-10", measure, by, 1e-10, "rad", "the tolerance")


def _oscillations() -> Iterator[Check]:
    relative = partial(Check, "oscillations", unit="relative")
    beer, ice, small, usual = sliding(), frozen(), "amplitude 1e-3 rad", "reduced, RK4, 1 ms"
    quantity, by, reason = f"frequency, eq. (10), {small}", f"sliding, {usual}", "the amplitude itself: 2e-7"
    yield relative(quantity, lambda: _frequency(beer) / frequency_10(beer) - 1, by, 3e-7, reason=reason)
    own, share = "RK4's own error, (omega h)^4/120 = 1.26e-9 for a small swing", "as above, 1/256 of it"
    for amplitude, integrator, timestep, bound, reason in (
        (0.1, "RK4", 1e-3, 1.3e-9, own),
        (1.0, "RK4", 1e-3, 1e-9, own),
        (3.0, "RK4", 1e-3, 2e-7, "RK4's own error, larger beside the separatrix"),
        (0.1, "RK4", 2.5e-4, 1e-9, share),
        (3.0, "RK4", 2.5e-4, 1e-9, share),
        *((amplitude, DOP853, 1e-3, 1e-12, "rounding") for amplitude in (0.1, 1.0, 3.0)),
    ):
        quantity, by = f"period, amplitude {amplitude:g} rad", f"sliding, reduced, {integrator}, {1e3 * timestep:g} ms"
        measure = partial(_period_error, beer, amplitude, integrator, timestep)
        yield relative(quantity, measure, by, bound, reason=reason)
    quantity, by, reason = f"frequency, corrected eq. (55), {small}", f"frozen, {usual}", "the amplitude itself"
    yield relative(quantity, lambda: _frequency(ice) / frequency_55(ice) - 1, by, 1e-6, reason=reason)
    quantity, reason = "printed eq. (55) misses by 21 %: distance from that", "21 % is rounded to a whole per cent"
    yield relative(quantity, lambda: 1 - frequency_55(ice, 1) / _frequency(ice) - 0.21, by, 5e-3, reason=reason)
    by, reason = f"sliding at equilibrium, {usual}", "rounding: RK4 is exact for a constant force"
    for name, scene in (("massless can, eq. (1)", beer), ("metal can, footnote 4", sliding(can=_METAL))):
        run = partial(simulate, scene, 2, scene.equilibrium())
        measure = lambda run=run, scene=scene: mean_acceleration(run()) / scene.acceleration() - 1  # noqa: E731
        yield relative(f"steady acceleration, {name}", measure, by, 1e-10, reason=reason)


def models() -> Iterator[Check]:
    """Yield the checks of models."""
    check = partial(Check, "models")
    for integrator, (expected, margin) in ORDERS.items():
        measure, by = partial(_order_error, frozen(), integrator), f"frozen, reduced, {integrator}"
        yield check(f"observed order less {expected}", measure, by, margin, "", "higher orders' terms")
    by, measure = "hoop, contact, RK4, 20 us", partial(_lift_off_error, hoop(hoop_mass=2e-4))
    quantity, reason = "lift-off angle at M/m = 1e-3 (Littlewood: 90 degrees)", "penetration of the contact"
    yield check(quantity, measure, by, 0.5, "degrees", f"{reason}, which unloads late")
    by, light, heavy = "hoop, contact, RK4, 0.1 ms", hoop(hoop_mass=0.2 / 20), hoop(hoop_mass=0.2 / 10)
    yield check(
        "hops missing at M/m = 1/20",
        lambda: fall_from_top(light, 1e-4, _GRIP).takeoff() is None,
        by,
        0,
        "",
        "it hops or not",
    )
    yield check(
        "hops too many at M/m = 1/10 (above 1/13)",
        lambda: fall_from_top(heavy, 1e-4, _GRIP).takeoff() is not None,
        by,
        0,
        "",
        "it hops or not",
    )


def extremes() -> Iterator[Check]:
    """Yield the checks of laws that motions obey towards an extreme, and over very many swings."""
    check = partial(Check, "extremes")
    quantity, by = "frequency over distance from the fold: exponent less 1/4", "frozen, reduced, DOP853"
    reason = "the next term of the expansion: the root of the largest distance, 1e-6"
    yield check(quantity, lambda: _fold_exponent() - 0.25, by, 1e-3, "", reason)
    quantity = "fall from beside the separatrix over the logarithm of the distance: slope"
    reason = "rounding by 4e-16 rad, against a distance of 1e-10 rad"
    for name, scene in (("sliding, metal can", sliding(can=_METAL)), ("frozen", frozen()), ("pendulum", pendulum())):
        yield check(quantity, partial(_slope_error, scene), f"{name}, reduced, DOP853", 1e-5, "relative", reason)
    alike = "similarity: phi over t sqrt(g/a), cans of 0.2 mm to 25 m, 1e-3 to 1e3 m/s^2"
    full, reason = "full can, let go at 1 rad: how far it comes in 10 s", "b = 0, so that the torque is 0 as well"
    sizes = "rounding of the scaled scene's sizes and masses"
    for make, name, scene, place in (
        (sliding, "sliding", sliding(fill=1.0), "sliding"),
        (frozen, "frozen", frozen(0.0, fill=1.0), "frozen, on the level"),
    ):
        yield check(alike, partial(_unlike, make), f"{name}, metal can, reduced, DOP853", 1e-10, "rad", sizes)
        yield check(
            full, partial(_creep, scene, "reduced", 10, 1.0), f"{place}, reduced, RK4, 1 ms", 0.0, "rad", reason
        )
    yield from _drifts()


def _drifts() -> Iterator[Check]:
    check, free, light = partial(Check, "drift"), sliding(0.0, can=Can.hoop(mass=1e5)), sliding(0.0)
    width = "growth of the energy's largest deviation within a swing, over 1000 swings"
    apart = "samples that do not fall on whole swings"
    falling = "samples fall differently: a period is not quite 32 steps; the method is symplectic"
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        by = f"can too heavy to move, {integrator}, T/32"
        measure = lambda of=integrator: (_drift(free, of, 32)[1] - 1).max()  # noqa: E731
        yield check(width, measure, by, 0.05, "relative", falling)
        quantity, by = "energy that a swing of 1 rad gains", f"massless can, {integrator}, T/20000"
        yield check(quantity, partial(_gain_error, light, integrator), by, 5e-3, "relative", apart)
    quantity = "energy lost over 1000 swings: exponent of their number, less 1"
    reason = "a swing that has lost a fourteenth is another one"
    heavy = "can too heavy to move"
    for name, scene, integrator, steps in (
        (heavy, free, "RK4", 32),
        ("massless can", light, "RK4", 32),
        (heavy, free, DOP853, 10),
    ):
        measure = partial(_drift_exponent, scene, integrator, steps)
        yield check(quantity, measure, f"{name}, {integrator}, T/{steps}", 0.02, "", reason)


def _frequency(scene: Scene) -> float:
    """Return the frequency [rad/s] of a simulated swing of 1e-3 rad about equilibrium."""
    return simulate(scene, 4, scene.equilibrium() + 1e-3).frequency()


def _period_error(scene: Scene, amplitude: float, integrator: Integrator, timestep: float) -> float:
    run = simulate(scene, 4, amplitude, integrator=integrator, timestep=timestep)
    return 2 * math.pi / run.frequency() / scene.period(amplitude) - 1


def _creep(scene: Scene, rolling: Rolling, duration: float = 5, phi0: float | None = None) -> float:
    """Return the largest distance [rad] from a start at rest, which is at the equilibrium if not at `phi0` [rad]."""
    rest = equilibrium_53(scene) if phi0 is None else phi0
    return float(np.abs(simulate(scene, duration, rest, rolling=rolling).phi - rest).max())


def _error(scene: Scene, rolling: Rolling) -> float:
    """Return the largest error of phi [rad] over 2 s. In theory contact holds all that time in all of these scenes."""
    return phi_error(simulate(scene, 2, 1.0, rolling=rolling, friction=_FRICTION))


def fall_slope(scene: Scene) -> float:
    """Return dt/d(ln distance) [s] for the time t to fall from beside an unstable equilibrium.

    It is -1/lambda with lambda^2 = -V''/J, since the distance grows as cosh(lambda t). A period has four such times
    where both ends of the swing are unstable equilibria, as on level ground and for any sliding load, and two for a
    frozen load on an incline.
    """
    form = scene.oscillator
    return -math.sqrt(float(form.inertia(scene.separatrix()[1])) / form.potential.curvature)


def _fold_exponent() -> float:
    """Return the measured exponent of the frequency over the distance from the fold."""
    fold, frequencies = math.sin(frozen().largest_incline()), []
    for beside in _BESIDE_FOLD:
        scene, amplitude = frozen(math.asin(fold * (1 - beside))), 1e-3 * math.sqrt(beside)  # the well shrinks alike
        period = scene.period(amplitude)
        run = simulate(scene, 2.2 * period, scene.equilibrium() + amplitude, integrator=DOP853, timestep=period / 50)
        frequencies.append(run.frequency())
    return observed_order(_BESIDE_FOLD, np.array(frequencies))


def _slope_error(scene: Scene) -> float:
    """Return the relative error of dt/d(ln distance), measured in falls from beside the separatrix."""
    top, bottom, times = scene.separatrix()[1], scene.equilibrium(), []
    for beside in _BESIDE_SEPARATRIX:
        period = scene.period(top - beside - bottom)
        run = simulate(scene, period / 2, top - beside, integrator=DOP853, timestep=period / 1000)
        times.append(CubicHermiteSpline(run.time, run.phi, run.phi_dot).solve(bottom, extrapolate=False)[0])
    return float(np.polyfit(np.log(_BESIDE_SEPARATRIX), times, 1)[0]) / fall_slope(scene) - 1


def _unlike(make: Callable[..., Scene]) -> float:
    """Return the largest difference of phi [rad] between cans of other sizes and gravities and the usual can."""

    def phi(radius: float, gravity: float) -> np.ndarray:
        # The proportions of the default can: radius 33 mm, length 120 mm, 0.1 mm of sheet metal.
        can = Can.sheet_metal(radius, radius * 0.12 / 0.033, radius * 1e-4 / 0.033)
        slow = math.sqrt(radius / gravity)
        return simulate(make(can=can, gravity=gravity), 40 * slow, 1.0, integrator=DOP853, timestep=slow / 8).phi

    return max(float(np.abs(phi(0.033, 9.81) - phi(*other)).max()) for other in _ALIKE)


@cache
def _drift(scene: Scene, integrator: Integrator, steps: int, swings: int = 1000) -> np.ndarray:
    """Return the number of each swing of 1 rad, and what its energy is then, shape (3, numbers of swings).

    The second row is the largest deviation from the start within that swing over that within the first one; the third
    is the change of the mean since the first one, as a share of the energy.
    """
    period, window = scene.period(1.0), np.arange(steps)
    counts = np.unique(np.rint(np.geomspace(1, swings, 1 + round(8 * math.log10(swings)))).astype(int))
    samples = np.unique(np.concatenate([window, *(steps * count + window for count in counts)]))
    prepared = Simulator(scene, Setting(integrator=integrator, timestep=period / steps))
    times = period / steps * samples
    start = prepared.start(scene.equilibrium() + 1.0, 0.0)
    motion, form = prepared.coordinates(prepared.solve(start, times).states, times), scene.oscillator
    kinetic = form.inertia(motion.phi) * motion.phi_dot**2 / 2
    energy = (kinetic - form.drop(motion.phi, float(motion.phi[0]))) / form.drop(scene.equilibrium(), motion.phi[0])
    of_swings = np.array([energy[place : place + steps] for place in np.searchsorted(samples, steps * counts)])
    width = np.abs(of_swings).max(axis=1)
    return np.stack([counts, width / width[0], of_swings.mean(axis=1) - energy[:steps].mean()])


def energy_per_swing(scene: Scene, amplitude: float, timestep: float, integrator: str) -> float:
    """Return the energy that a swing gains in each period over its energy, to first order in the timestep.

    By backward error analysis semi-implicit Euler, v += h a(q, v), q += h v, follows q' = v + h/2 a and
    v' = a - h/2 (a_q v + a_v a) (E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, chapter IX), so that
    dE/dt = -h J d(v a)/dt / 2. Over a period this leaves h/2 times the integral of J' v^2 dv, that of
    J' sqrt(w) w' / 2 over the swing with w = v^2: 0 where J is constant. "implicit" has the opposite sign: it differs
    in forces that grow with the square of the rate. The swing is symmetric about the equilibrium, with an `amplitude`
    [rad].
    """
    oscillator, rest = scene.oscillator, scene.equilibrium()
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    # phi = rest + amplitude sin(x) makes sqrt(w) smooth at its zeros, the turning points.
    x = np.pi / 2 * node
    phi, stretch = rest + amplitude * np.sin(x), amplitude * np.cos(x) * np.pi / 2 * weight
    inertia = oscillator.inertia(phi)
    inertia_slope = oscillator.chord * np.sin(phi) / 2 + oscillator.coupling * np.sin(2 * phi)
    w = 2 * oscillator.drop(phi, rest + amplitude) / inertia
    torque = -oscillator.depth * np.sin(phi - oscillator.bottom)
    w_slope = (2 * torque + 2 * oscillator.ramp - inertia_slope * w) / inertia
    gain = timestep / 2 * np.sum(inertia_slope * np.sqrt(np.maximum(w, 0)) * w_slope * stretch)
    return float((-1 if integrator == "implicit" else 1) * gain / oscillator.drop(rest, rest + amplitude))


def _gain_error(scene: Scene, integrator: Integrator) -> float:
    """Return by how much the energy that a swing gains differs from the predicted one, relative."""
    counts, _, gained = _drift(scene, integrator, 20_000, swings=2)
    return float(gained[0] / counts[0]) / energy_per_swing(scene, 1.0, scene.period(1.0) / 20_000, integrator) - 1


def _drift_exponent(scene: Scene, integrator: Integrator, steps: int) -> float:
    """Return the exponent of the number of swings in the energy that is lost, less 1."""
    counts, _, lost = _drift(scene, integrator, steps)
    clear = np.abs(lost) > 1e-13  # rounding of the energy and of a hundred swings
    return observed_order(counts[clear], np.abs(lost[clear])) - 1


def _order_error(scene: Scene, integrator: Integrator) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, over six halvings, less the expected one.

    At order 8 the error falls by 14 digits over six halvings, more than a double has. For DOP853 each halving is
    therefore two rungs, and only rungs with an error between 1e-3 rad and 1e-13 rad are fitted.
    """
    if integrator == DOP853:
        steps, duration, between = 0.2 / np.sqrt(2) ** np.arange(13), 20.0, (1e-13, 1e-3)
    else:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        duration, between = 2.0, (0.0, math.inf)
    runs = (simulate(scene, duration, 0.3, integrator=integrator, timestep=float(h)) for h in steps)
    errors = np.array([phi_error(run) for run in runs])
    fitted = (errors > between[0]) & (errors < between[1])
    return observed_order(steps[fitted], errors[fitted]) - ORDERS[integrator][0]


def _lift_off_error(scene: Scene) -> float:
    """Return the simulated less the exact angle of lift-off from the top [degrees], or NaN if the hoop stays down.

    It is where N = 0 in a fall from the top: 90 degrees as M/m -> 0.
    """
    fall = exact(scene, np.linspace(0, 1, 100_001), TOP)
    expected = math.pi - float(np.interp(fall.rolls_until(), fall.time, fall.phi))
    simulated = fall_from_top(scene, 2e-5, _GRIP).takeoff()
    return math.degrees(simulated - expected) if simulated is not None else math.nan
