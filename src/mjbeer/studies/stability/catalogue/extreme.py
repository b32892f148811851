"""The catalogue's extreme cases: fills, inclines, sizes, gravities, spins, and starts where motions end."""

import math
from collections.abc import Iterator

from mjbeer.studies.stability.catalogue.case import SWINGS, CatalogueCase, attempts, natural_period
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE, REFUSED, UNSTABLE
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.scene import Scene, frozen, hoop, pendulum, sliding

_FILLS = (1e-6, 1e-3, 1 - 1e-3, 1 - 1e-6, 1.0)
_INCLINES = (0.0, 1e-8, 89.9)
_FOLD = (-1e-2, -1e-6, 1e-6, 1e-2)
_RADII = (1e-6, 1e-3, 100.0)
_GRAVITIES = (0.0, 1e-6, 1e6)
_BESIDE_SEPARATRIX = (1e-2, 1e-6, 1e-10)
_SPINS = (1e2, 1e4)


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases."""
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
            "extreme", f"{name}, let go at pi", "exactly on top, where a sliding load balances and a frozen one rolls",
            "at pi to the last bit of a double a balanced load stays, but for what rounding adds", attempts(
                scene, math.pi, expected={"reduced": (), "equality": (), "tolerance": (ACCURATE, REFUSED)}
            ),
        )  # fmt: skip


def _everywhere() -> tuple[tuple[str, Scene], ...]:
    metal = Can.sheet_metal()
    return ("sliding", sliding(can=metal)), ("frozen", frozen()), ("pendulum", pendulum())


def _fill(fill: float) -> Iterator[CatalogueCase]:
    near = f"{fill:g}" if fill < 0.5 or fill == 1 else f"1 - {1 - fill:.0e}"
    for name, make in (("sliding", sliding), ("frozen", frozen)):
        for metal in (False, True):
            scene = make(fill=fill, can=Can.sheet_metal() if metal else None)
            theory, swings = "an oscillation like any other", SWINGS
            expected: dict[str, tuple[str, ...]] = {}
            if fill == 1:
                theory = "b = 0: nothing restores the load, and it stays as it is"
            elif fill > 0.5 and make is sliding:
                # Half a swing, or what rounding makes of it takes minutes.
                way, swings = scene.acceleration() / 2 * (natural_period(scene) / 2) ** 2, 0.5
                lost = (ACCURATE, INACCURATE, REFUSED)
                theory = (
                    f"a slow swing, while the can rolls {way:.0e} m: rounding of that is a share of "
                    f"{2**-53 * way / scene.load.offset:.0e} of b"
                )
                expected = {"reduced": lost, "equality": (*lost, UNSTABLE), "tolerance": lost}
            yield CatalogueCase(
                "extreme",
                f"{name}, {'metal' if metal else 'massless'} can, fill {near}",
                "a film of beer" if fill < 0.5 else "hardly any offset, or none",
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
                "level, or hardly tilted" if incline < 1 else "nearly a wall: the can is hardly pressed on it",
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
            "sin(alpha) = m b/((m + m_can) a), where the equilibrium of eq. (53) ends",
            "below, a slow swing in a shallow well; above, a can that lingers and then rolls down",
            attempts(scene, start),
        )


def _sizes() -> Iterator[CatalogueCase]:
    for radius in _RADII:
        for name, make in (("sliding", sliding), ("frozen", frozen)):
            can = Can.sheet_metal(radius, 3.6 * radius, thickness=radius / 330)
            yield CatalogueCase(
                "extreme",
                f"{name}, can of {radius:g} m",
                "masses go with the cube of the size, inertias with the fifth power" if radius < 1 else "a gasometer",
                "the same motion, in units of sqrt(a/g)",
                attempts(make(can=can), 1.0),
            )


def _gravity(gravity: float) -> Iterator[CatalogueCase]:
    for name, make in (("sliding", sliding), ("frozen", frozen)):
        scene = make(gravity=gravity, can=Can.sheet_metal())
        yield CatalogueCase(
            "extreme",
            f"{name}, g = {gravity:g} m/s^2",
            "nothing presses the can on the incline" if gravity == 0 else "time runs as the root of g",
            "a load that turns for ever" if gravity == 0 else "the same motion, in units of sqrt(a/g)",
            attempts(scene, 1.0, 3.0 if gravity == 0 else 0.0),
        )


def _separatrix() -> Iterator[CatalogueCase]:
    for name, scene in _everywhere():
        for beside in _BESIDE_SEPARATRIX:
            start = scene.separatrix()[1] - beside
            lost = beside < 1e-3
            yield CatalogueCase(
                "extreme",
                f"{name}, {beside:.0e} rad inside the separatrix",
                "the period grows as the logarithm of the distance, and with it what rounding does",
                "a rounding of the start grows by exp(lambda t) at the top",
                attempts(
                    scene,
                    start,
                    expected={"reduced": (), "equality": (), "tolerance": (ACCURATE, REFUSED) if lost else (ACCURATE,)},
                ),
            )


def _spins() -> Iterator[CatalogueCase]:
    for name, scene in _everywhere():
        for spin in _SPINS:
            yield CatalogueCase(
                "extreme",
                f"{name}, spun at {spin:.0e} rad/s",
                "the energy of the swing drowns in that of the spin",
                "turns of 2 pi / Omega; the load would lift the can",
                attempts(scene, 0.5, spin),
            )


def _points() -> Iterator[CatalogueCase]:
    rim = Load.point(0.2, 0.033)
    yield CatalogueCase(
        "extreme",
        "point on the rim of a hoop, let go a quarter turn from the bottom",
        "I_cm = 0: MuJoCo wants inertia of every body that moves",
        "at the bottom the load rests on the incline, and J is what the hoop has",
        attempts(hoop(), math.pi / 2),
    )
    yield CatalogueCase(
        "extreme",
        "point on the rim of a hoop of 1e-9 of its mass",
        "J at the bottom is 1e-9 of that at the top",
        "a bounce at the bottom that is as good as instantaneous",
        attempts(
            Scene(Can.hoop(mass=0.2e-9), rim, 0.0, "frozen"),
            math.pi / 2,
            expected={"reduced": (), "equality": (), "tolerance": ()},
        ),
    )
    yield CatalogueCase(
        "extreme",
        "can with next to no inertia around a sliding load",
        "1e-20 kg m^2, far below MuJoCo's smallest (mjMINVAL, 1e-15)",
        "reduced, masses are rescaled, and the motion is that of a massless can; with a joint of its own, the can's "
        "1e-20 is lost beside the load's 1e-5",
        attempts(
            Scene(Can(mass=1e-3, inertia=1e-20), Load.segment()),
            1.0,
            expected={"equality": (UNSTABLE, REFUSED), "tolerance": (ACCURATE, REFUSED)},
        ),
    )
