"""The catalogue's extreme cases: fills, inclines, sizes, gravities, spins, and starts where motions end."""

import math
from collections.abc import Iterator

from mjbeer.studies.stability.catalogue.case import SWINGS, CatalogueCase, attempts, natural_period
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE, REFUSED, UNSTABLE
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene

_FILLS = (1e-5, 1e-3, 1 - 1e-3, 1 - 1e-6, 1.0)
"""Heights of the beer over the can's diameter."""
_INCLINES = (0.0, 1e-8, 89.9)
"""Inclines [degrees]."""
_FOLD = (-1e-2, -1e-6, 1e-6, 1e-2)
"""Relative differences of sin(alpha) from that of the steepest incline with an equilibrium, the fold."""
_RADII = (1e-4, 1e-3, 50.0)
"""Radii of cans [m]."""
_GRAVITIES = (0.0, 1e-3, 1e3)
"""Gravities [m/s^2]."""
_BESIDE_SEPARATRIX = (1e-2, 1e-6, 1e-10)
"""Distances of the start from the end of the largest swing [rad]."""
_SPINS = (1e2, 1e4)
"""Initial rates phi_dot [rad/s]."""


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases of this module."""
    for fill in _FILLS:
        yield from _fill(fill)
    yield from _inclines()
    yield from _sizes()
    for gravity in _GRAVITIES:
        yield from _gravity(gravity)
    yield from _separatrix()
    yield from _spins()
    yield from _points()
    for name, scene in _everywhere():
        yield CatalogueCase(
            "extreme",
            f"{name}, let go at pi",
            "it starts exactly on top, where a sliding load balances and a frozen one rolls down",
            "a load that balances stays at the double nearest to pi, unless rounding pushes it off",
            attempts(scene, math.pi, expected={"reduced": (), "equality": (), "tolerance": (ACCURATE, REFUSED)}),
        )


def _everywhere() -> tuple[tuple[str, Scene], ...]:
    """Return one scene of each kind, by name."""
    metal = Can.sheet_metal()
    return ("sliding", sliding(can=metal)), ("frozen", frozen()), ("pendulum", pendulum())


def _fill(fill: float) -> Iterator[CatalogueCase]:
    amount = f"{fill:g}" if fill < 0.5 or fill == 1 else f"1 - {1 - fill:.0e}"
    for name, make in (("sliding", sliding), ("frozen", frozen)):
        for metal in (False, True):
            scene = make(fill=fill, can=Can.sheet_metal() if metal else None)
            theory, swings = "an oscillation like any other", SWINGS
            expected: dict[str, tuple[str, ...]] = {}
            if fill == 1:
                theory = "b = 0: no torque acts on the load, and it stays where it is"
            elif fill > 0.5 and make is sliding:
                # Only half a swing: where rounding disturbs the motion, a whole one would take minutes.
                distance, swings = scene.acceleration() / 2 * (natural_period(scene) / 2) ** 2, 0.5
                lost = (ACCURATE, INACCURATE, REFUSED)
                theory = (
                    f"a slow swing, while the can rolls {distance:.0e} m: rounding of that distance is "
                    f"{2**-53 * distance / scene.load.offset:.0e} of b"
                )
                expected = {"reduced": lost, "equality": (*lost, UNSTABLE), "tolerance": lost}
            yield CatalogueCase(
                "extreme",
                f"{name}, {'metal' if metal else 'massless'} can, fill {amount}",
                "a thin film of beer" if fill < 0.5 else "the centre of mass is next to the axis, or on it",
                theory,
                attempts(scene, 1.0, expected=expected, swings=swings),
            )


def _inclines() -> Iterator[CatalogueCase]:
    for incline in _INCLINES:
        for name, make in (("sliding, metal can", sliding), ("frozen", frozen)):
            scene = make(math.radians(incline), can=Can.sheet_metal() if make is sliding else None)
            yield CatalogueCase(
                "extreme",
                f"{name}, incline {incline:g} degrees",
                "level, or hardly tilted" if incline < 1 else "nearly a wall: hardly anything presses the can on it",
                "an oscillation" if incline < 1 or make is sliding else "no equilibrium; the can rolls down",
                attempts(scene, 0.5, expected={"tolerance": (ACCURATE,) if incline < 1 else (ACCURATE, REFUSED)}),
            )
    fold = math.sin(frozen().largest_incline())
    for beside in _FOLD:
        scene = frozen(math.asin(fold * (1 + beside)))
        start = scene.equilibrium() - 1e-3 * abs(beside) ** 0.5 if beside < 0 else math.pi / 2 - scene.incline
        side = "below" if beside < 0 else "above"
        yield CatalogueCase(
            "extreme",
            f"frozen, {abs(beside):.0e} {side} the fold",
            "near sin(alpha) = m b/((m + m_can) a), above which eq. (53) has no equilibrium",
            "below, a slow swing in a shallow well; above, a can that lingers and then rolls down",
            attempts(scene, start),
        )


def _sizes() -> Iterator[CatalogueCase]:
    for radius in _RADII:
        for name, make in (("sliding", sliding), ("frozen", frozen)):
            can = Can.sheet_metal(radius, min(3.6 * radius, 100.0), thickness=radius / 60)
            yield CatalogueCase(
                "extreme",
                f"{name}, can of {radius:g} m",
                "masses go with the cube of the size, inertias with the fifth power"
                if radius < 1
                else "the size of a gasometer",
                "the same motion, in units of sqrt(a/g)",
                attempts(make(can=can), 1.0),
            )


def _gravity(gravity: float) -> Iterator[CatalogueCase]:
    for name, make in (("sliding", sliding), ("frozen", frozen)):
        scene = make(gravity=gravity, can=Can.sheet_metal())
        yield CatalogueCase(
            "extreme",
            f"{name}, g = {gravity:g} m/s^2",
            "nothing presses the can on the incline" if gravity == 0 else "times are proportional to 1/sqrt(g)",
            "a load that turns for ever" if gravity == 0 else "the same motion, in units of sqrt(a/g)",
            attempts(scene, 1.0, 3.0 if gravity == 0 else 0.0),
        )


def _separatrix() -> Iterator[CatalogueCase]:
    for name, scene in _everywhere():
        for beside in _BESIDE_SEPARATRIX:
            start = scene.separatrix()[1] - beside
            sensitive = beside < 1e-3
            yield CatalogueCase(
                "extreme",
                f"{name}, {beside:.0e} rad inside the separatrix",
                "the period grows as the logarithm of 1/distance, and so does the effect of rounding",
                "rounding of the start grows as exp(lambda t) near the top",
                attempts(
                    scene,
                    start,
                    expected={
                        "reduced": (),
                        "equality": (),
                        "tolerance": (ACCURATE, REFUSED) if sensitive else (ACCURATE,),
                    },
                ),
            )


def _spins() -> Iterator[CatalogueCase]:
    for name, scene in _everywhere():
        for spin in _SPINS:
            yield CatalogueCase(
                "extreme",
                f"{name}, spun at {spin:.0e} rad/s",
                "the energy of a swing is tiny beside that of the spin",
                "turns of 2 pi/Omega; a real can would be lifted off by its load",
                attempts(scene, 0.5, spin),
            )


def _points() -> Iterator[CatalogueCase]:
    rim = Load.point(0.2, 0.033)
    yield CatalogueCase(
        "extreme",
        "point on the rim of a hoop, let go a quarter turn from the bottom",
        "I_cm = 0, but in MuJoCo every moving body needs inertia",
        "at the bottom the point touches the incline and stands still, and J is the hoop's alone",
        attempts(hoop(), math.pi / 2),
    )
    yield CatalogueCase(
        "extreme",
        "point on the rim of a hoop of 1e-6 of its mass",
        "J at the bottom is 1e-6 of that at the top",
        "a bounce at the bottom that takes next to no time",
        attempts(
            Scene(Can.hoop(mass=0.2e-6), rim, 0.0, "frozen"),
            math.pi / 2,
            expected={"reduced": (), "equality": (), "tolerance": ()},
        ),
    )
    yield CatalogueCase(
        "extreme",
        "can with next to no inertia around a sliding load",
        "1e-20 kg m^2, far below MuJoCo's smallest (mjMINVAL, 1e-15)",
        "the reduced model rescales masses, and moves like a massless can; as a body with a joint of its own, the can "
        "has an inertia of 1e-20 kg m^2 that rounding loses beside the load's 1e-5",
        attempts(
            Scene(Can(mass=1e-3, inertia=1e-20), Load.segment()),
            1.0,
            expected={"equality": (UNSTABLE, REFUSED), "tolerance": (ACCURATE, REFUSED)},
        ),
    )
