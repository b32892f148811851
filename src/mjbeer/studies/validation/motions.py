"""Rows of motions against exact theory: periods, rest, trajectories, tolerances, laws towards extremes, and drift."""

import math
from collections.abc import Callable, Iterator
from functools import cache, partial

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.model.setting import DOP853, Integrator, Rolling, Setting, supported
from mjbeer.paper.frozen import equilibrium_53, frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.predictions.semi_implicit_euler import energy_per_swing, euler_motion
from mjbeer.simulation.run import Prepared
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.convergence import observed_order
from mjbeer.studies.rows import Row
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact, phi_error
from mjbeer.theory.named import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene
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


def rows() -> Iterator[Row]:
    """Yield the rows of motions near an equilibrium or about a second long."""
    yield from _oscillations()
    for name, scene in (("eq. (53)", frozen()), ("eq. (53), metal can", frozen(can=_METAL))):
        for rolling, bound, reason in (
            ("reduced", 1e-12, "rounding of the torques, over 5 s of rest"),
            ("equality", 1e-12, "rounding of the torques, over 5 s of rest"),
            ("contact", 1e-6, "the can settles on its soft contact, rocks and creeps"),
        ):
            quantity, by = f"equilibrium, {name}, 5 s at rest", f"frozen, {rolling}, RK4, 1 ms"
            yield Row("rest", quantity, partial(_creep, scene, rolling), by, bound, "rad", reason)
    scenes = {
        "sliding": sliding(), "sliding, metal can": sliding(can=_METAL), "frozen": frozen(),
        "frozen, metal can": frozen(can=_METAL), "pendulum": pendulum(),
    }  # fmt: skip
    bounds: dict[Rolling, tuple[float, str]] = {
        "reduced": (1e-7, "RK4"), "equality": (1e-7, "RK4"), "contact": (1e-4, "softness, slip"),
    }  # fmt: skip
    for rolling, (bound, reason) in bounds.items():
        for name, scene in scenes.items():
            if supported(scene, rolling):
                by, measure = f"{name}, {rolling}, RK4, 1 ms", partial(_error, scene, rolling)
                yield Row("trajectories", "phi over 2 s from 1 rad", measure, by, bound, "rad", reason)
    for name, scene, phi0, phi_dot0 in (
        ("sliding", sliding(), 1.0, 0.0),
        ("sliding, metal can, looping", sliding(can=_METAL), 0.0, 45.0),
        ("frozen", frozen(), 1.0, 0.0),
        ("frozen, rolling down", frozen(), math.pi, 0.0),
        ("pendulum", pendulum(), 1.0, 0.0),
    ):
        by, measure = f"{name}, reduced, DOP853", partial(_error_to_tolerance, scene, 2.0, phi0, phi_dot0)
        yield Row("tolerances", "phi over 2 s, tolerance 1e-10", measure, by, 1e-10, "rad", "the tolerance")


def _oscillations() -> Iterator[Row]:
    beer, ice, small, usual = sliding(), frozen(), "amplitude 1e-3 rad", "reduced, RK4, 1 ms"
    relative = partial(Row, "oscillations", unit="relative")
    yield relative(
        f"frequency, eq. (10), {small}", lambda: _frequency(beer, 1e-3) / frequency_10(beer) - 1,
        by=f"sliding, {usual}", bound=3e-7, reason="the amplitude itself: 2e-7",
    )  # fmt: skip
    own_error = "RK4's own error, (omega h)^4/120 = 1.26e-9 for a small swing"
    for amplitude, integrator, timestep, bound, reason in (
        (0.1, "RK4", 1e-3, 1.3e-9, own_error),
        (1.0, "RK4", 1e-3, 1e-9, own_error),
        (3.0, "RK4", 1e-3, 2e-7, "RK4's own error, larger beside the separatrix"),
        (0.1, "RK4", 2.5e-4, 1e-9, "as above, 1/256 of it"),
        (3.0, "RK4", 2.5e-4, 1e-9, "as above, 1/256 of it"),
        (0.1, DOP853, 1e-3, 1e-12, "rounding"),
        (1.0, DOP853, 1e-3, 1e-12, "rounding"),
        (3.0, DOP853, 1e-3, 1e-12, "rounding"),
    ):
        yield relative(
            f"period, amplitude {amplitude:g} rad", partial(_period_error, beer, amplitude, integrator, timestep),
            by=f"sliding, reduced, {integrator}, {1e3 * timestep:g} ms", bound=bound, reason=reason,
        )  # fmt: skip
    yield relative(
        f"frequency, corrected eq. (55), {small}", lambda: _frequency(ice, 1e-3) / frequency_55(ice) - 1,
        by=f"frozen, {usual}", bound=1e-6, reason="the amplitude itself",
    )  # fmt: skip
    yield relative(
        "printed eq. (55) misses by 21 %: distance from that",
        lambda: 1 - frequency_55(ice, factor=1) / _frequency(ice, 1e-3) - 0.21,
        by=f"frozen, {usual}", bound=5e-3, reason="21 % is rounded to a whole per cent",
    )  # fmt: skip
    for name, scene in (("massless can, eq. (1)", beer), ("metal can, footnote 4", sliding(can=_METAL))):
        yield relative(
            f"steady acceleration, {name}",
            lambda scene=scene: mean_acceleration(simulate(scene, 2, scene.equilibrium())) / scene.acceleration() - 1,
            by=f"sliding at equilibrium, {usual}", bound=1e-10, reason="rounding: RK4 is exact for a constant force",
        )  # fmt: skip


def extremes() -> Iterator[Row]:
    """Yield the rows of laws that motions obey towards an extreme, and over very many swings."""
    yield Row(
        "extremes", "frequency over distance from the fold: exponent less 1/4", lambda: _fold_exponent() - 0.25,
        "frozen, reduced, DOP853", 1e-3, "", "the next term of the expansion: the root of the largest distance, 1e-6",
    )  # fmt: skip
    for name, scene in (
        ("sliding, metal can", sliding(can=_METAL)), ("frozen", frozen()), ("pendulum", pendulum()),
    ):  # fmt: skip
        yield Row(
            "extremes", "fall from beside the separatrix over the logarithm of the distance: slope",
            lambda scene=scene: _measured_fall_slope(scene) / fall_slope(scene) - 1,
            f"{name}, reduced, DOP853", 1e-5, "relative", "rounding by 4e-16 rad, against a distance of 1e-10 rad",
        )  # fmt: skip
    for integrator, duration in (("Euler", 8.0), ("implicit", 2.4)):
        yield Row(
            "extremes", f"rolling down for {duration} s, by how much the timestep falsifies the turn",
            partial(_timestep_error_ratio, integrator, duration),
            f"frozen, equality, {integrator}, 1 ms", 1e-3, "relative", "second order in the timestep",
        )  # fmt: skip
    for make, name in ((sliding, "sliding"), (frozen, "frozen")):
        yield Row(
            "extremes", "similarity: phi over t sqrt(g/a), cans of 0.2 mm to 25 m, 1e-3 to 1e3 m/s^2",
            partial(_unlike, make), f"{name}, metal can, reduced, DOP853", 1e-10, "rad",
            "rounding of the scaled scene's sizes and masses",
        )  # fmt: skip
        full = sliding(fill=1.0) if make is sliding else frozen(0.0, fill=1.0)
        yield Row(
            "extremes", "full can, let go at 1 rad: how far it comes in 10 s",
            lambda full=full: np.abs(simulate(full, 10.0, 1.0).phi - 1.0).max(),
            f"{name if make is sliding else 'frozen, on the level'}, reduced, RK4, 1 ms", 0.0, "rad",
            "b = 0, so that the torque is 0 as well",
        )  # fmt: skip
    free, light = sliding(0.0, can=Can.hoop(mass=1e5)), sliding(0.0)
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        yield Row(
            "drift", "growth of the energy's largest deviation within a swing, over 1000 swings",
            lambda integrator=integrator: (_drift(free, integrator, 32)[1] - 1).max(),
            f"can too heavy to move, {integrator}, T/32", 0.05, "relative",
            "samples fall differently: a period is not quite 32 steps; the method is symplectic",
        )  # fmt: skip
        yield Row(
            "drift", "energy that a swing of 1 rad gains", partial(_gain_error, light, integrator),
            f"massless can, {integrator}, T/20000", 5e-3, "relative", "samples that do not fall on whole swings",
        )  # fmt: skip
    for name, scene, integrator, steps in (
        ("can too heavy to move", free, "RK4", 32),
        ("massless can", light, "RK4", 32),
        ("can too heavy to move", free, DOP853, 10),
    ):
        yield Row(
            "drift", "energy lost over 1000 swings: exponent of their number, less 1",
            partial(_drift_exponent, scene, integrator, steps),
            f"{name}, {integrator}, T/{steps}", 0.02, "", "a swing that has lost a fourteenth is another one",
        )  # fmt: skip


def _frequency(scene: Scene, amplitude: float) -> float:
    """Return the frequency [rad/s] of a simulated swing about equilibrium, of an amplitude [rad]."""
    return simulate(scene, 4, scene.equilibrium() + amplitude).frequency()


def _period_error(scene: Scene, amplitude: float, integrator: Integrator, timestep: float) -> float:
    run = simulate(scene, 4, amplitude, integrator=integrator, timestep=timestep)
    return 2 * math.pi / run.frequency() / scene.period(amplitude) - 1


def _creep(scene: Scene, rolling: Rolling) -> float:
    """Return the largest distance from equilibrium [rad] over 5 s that start there, at rest."""
    rest = equilibrium_53(scene)
    return float(np.abs(simulate(scene, 5, rest, rolling=rolling).phi - rest).max())


def _error(scene: Scene, rolling: Rolling) -> float:
    """Return the largest error of phi [rad] over 2 s. In theory contact holds all that time in all of these scenes."""
    return phi_error(simulate(scene, 2, 1.0, rolling=rolling, friction=_FRICTION))


def _error_to_tolerance(scene: Scene, duration: float, phi0: float, phi_dot0: float = 0.0) -> float:
    return phi_error(simulate(scene, duration, phi0, phi_dot0, tolerance=1e-10), relative=True)


def fall_slope(scene: Scene) -> float:
    """Return dt/d(ln distance) [s] for the time t to fall from beside an unstable equilibrium.

    It is -1/lambda with lambda^2 = -V''/J, since the distance grows as cosh(lambda t). A period has four such times
    where both ends of the swing are unstable equilibria, as on level ground and for any sliding load, and two for a
    frozen load on an incline.
    """
    form = scene.oscillator
    return -math.sqrt(float(form.inertia(scene.separatrix()[1])) / form.crest.curvature)


def _fold_exponent() -> float:
    """Return the measured exponent of the frequency over the distance from the fold."""
    fold, frequencies = math.sin(frozen().largest_incline()), []
    for beside in _BESIDE_FOLD:
        scene, amplitude = frozen(math.asin(fold * (1 - beside))), 1e-3 * math.sqrt(beside)  # the well shrinks alike
        period = scene.period(amplitude)
        run = simulate(scene, 2.2 * period, scene.equilibrium() + amplitude, integrator=DOP853, timestep=period / 50)
        frequencies.append(run.frequency())
    return observed_order(_BESIDE_FOLD, np.array(frequencies))


def _measured_fall_slope(scene: Scene) -> float:
    """Return the measured dt/d(ln distance) [s] of a fall from beside the separatrix."""
    top, bottom, times = scene.separatrix()[1], scene.equilibrium(), []
    for beside in _BESIDE_SEPARATRIX:
        period = scene.period(top - beside - bottom)
        run = simulate(scene, period / 2, top - beside, integrator=DOP853, timestep=period / 1000)
        times.append(CubicHermiteSpline(run.time, run.phi, run.phi_dot).solve(bottom, extrapolate=False)[0])
    return float(np.polyfit(np.log(_BESIDE_SEPARATRIX), times, 1)[0])


def _timestep_error_ratio(integrator: Integrator, duration: float) -> float:
    """Return the error of the turn due to the timestep over the predicted one, less 1."""
    scene, times = frozen(), np.array([0.0, duration])
    truth = exact(scene, times, math.pi).phi[-1]
    run = simulate(scene, duration, math.pi, rolling="equality", integrator=integrator, times=times)
    return (run.phi[-1] - truth) / (euler_motion(scene, times, 1e-3, integrator, math.pi)[-1] - truth) - 1


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
    prepared = Prepared(scene, Setting(integrator=integrator, timestep=period / steps))
    times = period / steps * samples
    start = prepared.start(scene.equilibrium() + 1.0, 0.0)
    motion, form = prepared.coordinates(prepared.solve(start, times).states, times), scene.oscillator
    kinetic = form.inertia(motion.phi) * motion.phi_dot**2 / 2
    energy = (kinetic - form.drop(motion.phi, float(motion.phi[0]))) / form.drop(scene.equilibrium(), motion.phi[0])
    of_swings = np.array([energy[place : place + steps] for place in np.searchsorted(samples, steps * counts)])
    width = np.abs(of_swings).max(axis=1)
    return np.stack([counts, width / width[0], of_swings.mean(axis=1) - energy[:steps].mean()])


def _gain_error(scene: Scene, integrator: Integrator) -> float:
    """Return by how much the energy that a swing gains differs from the predicted one, relative."""
    counts, _, gained = _drift(scene, integrator, 20_000, swings=2)
    expected = energy_per_swing(scene, 1.0, scene.period(1.0) / 20_000, integrator)
    assert expected is not None
    return float(gained[0] / counts[0]) / expected - 1


def _drift_exponent(scene: Scene, integrator: Integrator, steps: int) -> float:
    """Return the exponent of the number of swings in the energy that is lost, less 1."""
    counts, _, lost = _drift(scene, integrator, steps)
    clear = np.abs(lost) > 1e-13  # rounding of the energy and of a hundred swings
    return observed_order(counts[clear], np.abs(lost[clear])) - 1
