"""Stiff and extreme cases, and those in which the search found errors, each with why it is one and how it may end."""

import math
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import DOP853, INTEGRATORS, Integrator, supported
from mjbeer.studies.stability.judge import ACCURATE, INACCURATE, REFUSED, UNSTABLE, Trial, steps_of
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene

TOLERANCE = 1e-9
"""Tolerance of the runs that are made to a tolerance [rad]."""
_SWINGS = 5.0
"""Length of a run, in natural periods."""
_STEPS, _LARGE_STEPS = 300, 100
"""Timesteps a natural period; the second number is for DOP853."""
_DESK = (0.1, 30.0)
"""Shortest and longest run with the default settings [s], chosen as for a can on a desk, whatever the scene."""
_QUICK = ("Euler", "RK4")
"""Integrators with which a quick study makes a frozen load rock."""
_ALL: tuple[Integrator, ...] = (*INTEGRATORS, DOP853)
_METAL = Can.sheet_metal()
_EITHER = (("sliding", sliding), ("frozen", frozen))
_EVERYWHERE = (("sliding", sliding(can=_METAL)), ("frozen", frozen()), ("pendulum", pendulum()))

Expected = Mapping[str, tuple[str, ...]]
"""Outcomes that theory allows, by way of rolling or for "tolerance"."""
_ANY: Expected = MappingProxyType({"reduced": (), "equality": ()})
_USUAL: Expected = MappingProxyType({})


class Try(NamedTuple):
    """One way to simulate a case."""

    setting: str
    """Name of the way: of rolling, integrator, and timestep or tolerance."""
    trial: Trial
    expected: tuple[str, ...] = ()
    """Outcomes that theory allows. If empty, every outcome is allowed that is not in `judge.NEVER`."""
    within: float = math.inf
    """Largest error that a run may have to be as expected [rad]."""
    sample: bool = True
    """Whether a quick study includes it."""


class Case(NamedTuple):
    """A case: its kind ("stiff", "extreme" or "found"), its name, why it is one, and the ways in which it is tried."""

    kind: str
    name: str
    why: str
    tries: tuple[Try, ...]


def cases() -> list[Case]:
    """Return all cases."""
    motions = [
        Case(kind, name, why, tries(scene, phi0, *rest))
        for kind, listed in (("stiff", _stiff()), ("extreme", _extreme()))
        for name, why, scene, phi0, *rest in listed
    ]
    return [*(Case("stiff", *each) for each in _constraints()), *motions, *(Case("found", *each) for each in _found())]


def natural_period(scene: Scene, phi_dot0: float = 0.0) -> float:
    """Return the time scale of a motion [s]: a small swing or a turn, or else a fall through the radius."""
    turn = 2 * math.pi / abs(phi_dot0) if phi_dot0 else math.inf
    try:
        frequency = scene.frequency()
    except NoEquilibriumError:
        frequency = 0.0
    if frequency > 0:
        return min(turn, 2 * math.pi / frequency)
    fall = 2 * math.pi * math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else math.inf
    return min(turn, fall) if math.isfinite(min(turn, fall)) else 1.0


def tries(
    scene: Scene, phi0: float, phi_dot0: float = 0.0, expected: Expected = _USUAL, swings: float = _SWINGS
) -> tuple[Try, ...]:
    """Return tries of a motion in every way of rolling, with every integrator, at timesteps that suit the scene.

    Where `expected` does not say otherwise, a reduced model must be accurate with RK4, with DOP853 and to a tolerance,
    and an equality with RK4 and to a tolerance. A model that MuJoCo cannot have must be refused. A contact, which may
    part, and methods of first order may end in any way that is not in `judge.NEVER`.
    """
    period, made = natural_period(scene, phi_dot0), []

    def lasting(duration: float, timestep: float, **setting: Any) -> Trial:
        return Trial(scene, phi0, phi_dot0, timestep=timestep, steps=steps_of(duration, timestep), **setting)

    for rolling in ("reduced", "equality", "contact"):
        possible = supported(scene, rolling)
        usual = expected.get(rolling, (ACCURATE,) if rolling != "contact" else ()) if possible else (REFUSED,)
        for integrator in _ALL:
            steps = _LARGE_STEPS if integrator == DOP853 else _STEPS
            first_order = integrator not in ("RK4", DOP853)
            wanted = () if possible and (first_order or (rolling != "reduced" and integrator == DOP853)) else usual
            trial = lasting(swings * period, period / steps, rolling=rolling, integrator=integrator)
            made.append(Try(f"{rolling}, {integrator}, T/{steps}", trial, wanted, sample=integrator == "RK4"))
        if rolling != "contact":
            trial = lasting(swings * period, period / _STEPS, rolling=rolling, tolerance=TOLERANCE)
            wanted = expected.get("tolerance", usual) if possible else usual
            within = TOLERANCE if wanted == (ACCURATE,) else math.inf
            made.append(Try(f"{rolling}, to a tolerance of {TOLERANCE:g}", trial, wanted, within))
    made.append(Try("reduced, RK4, 1 ms", lasting(min(max(swings * period, _DESK[0]), _DESK[1]), 1e-3)))
    return tuple(made)


def _rocking(friction: float) -> list[Try]:
    """Return tries of a second of a frozen load that rocks from phi = 0 in contact."""
    return [
        Try(
            f"contact, {integrator}, 1 ms",
            Trial(frozen(), 0.0, rolling="contact", integrator=integrator, friction=friction),
            sample=integrator in _QUICK,
        )
        for integrator in _ALL
    ]


def _constraints() -> Iterator[tuple[str, str, tuple[Try, ...]]]:
    """Yield name, reason and tries of cases with more or less friction than rolling needs."""
    needed = float(exact(frozen(), np.linspace(0, 1, 2001), 0.0).forces.needed.max())
    for friction in (1e-3, 1e-2, 0.1, 0.2, 1.0, 1e3):
        runs = []
        for each in _rocking(friction):
            rolls = (ACCURATE,) if each.trial.integrator in ("RK4", DOP853) else ()
            slips = (INACCURATE, UNSTABLE) if each.trial.integrator == DOP853 else (INACCURATE,)
            runs.append(each._replace(expected=rolls if friction > needed else slips))
        why = f"rocking from phi = 0 needs a coefficient of {needed:.3f}; a can that slips hops under DOP853"
        yield f"friction {friction:g}", why, tuple(runs)


def _stiff() -> Iterator[tuple]:
    """Yield name, reason, scene, start and, where it matters, rate, expected outcomes and length of stiff motions."""
    for ratio in (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6):
        for name, make in _EITHER:
            scene, why = make(can=Can.hoop(mass=ratio * Load.segment().mass)), "the mass matrix is badly conditioned"
            yield f"{name}, can {ratio:.0e} times the load", why, scene, 1.0
    why = "J falls to a thousandth at phi = 0, where the load swings through in a thousandth of the period"
    bottom = {**_ANY, "tolerance": (ACCURATE,)}
    yield "pendulum on a wheel of 0.1 g", why, pendulum(wheel_mass=1e-4), 1.0, 0.0, bottom
    for beside in (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3):
        why = "at pi the tendon that gives the model its J has no length and no direction"
        yield f"frozen, let go {beside:g} rad beside pi", why, frozen(), math.pi - beside


def _extreme() -> Iterator[tuple]:  # noqa: PLR0912 - a list, most of it loops over few values
    """Yield the same of extreme motions."""
    for fill in (1e-5, 1e-3, 1 - 1e-3, 1 - 1e-6, 1.0):
        amount = f"{fill:g}" if fill < 0.5 or fill == 1 else f"1 - {1 - fill:.0e}"
        for name, make in _EITHER:
            for can in (None, _METAL):
                scene, expected, swings = make(fill=fill, can=can), _USUAL, _SWINGS
                why = "a thin film of beer" if fill < 0.5 else "b = 0, or nearly: hardly any torque acts on the load"
                if 0.5 < fill < 1 and make is sliding:
                    # Only half a swing: where rounding disturbs the motion, a whole one would take minutes.
                    swings, lost = 0.5, (ACCURATE, INACCURATE, REFUSED)
                    expected = {"reduced": lost, "equality": (*lost, UNSTABLE), "tolerance": lost}
                    distance = scene.acceleration() / 2 * (natural_period(scene) / 2) ** 2
                    why = f"rounding of the {distance:.0e} m that it rolls is not small beside b"
                title = f"{name}, {'massless' if can is None else 'metal'} can, fill {amount}"
                yield title, why, scene, 1.0, 0.0, expected, swings
    for incline in (0.0, 1e-8, 89.9):
        expected = {"tolerance": (ACCURATE,) if incline < 1 else (ACCURATE, REFUSED)}
        why = "level, or hardly tilted" if incline < 1 else "nearly a wall: hardly anything presses the can on it"
        for name, make, can in (("sliding, metal can", sliding, _METAL), ("frozen", frozen, None)):
            scene = make(math.radians(incline), can=can)
            yield f"{name}, incline {incline:g} degrees", why, scene, 0.5, 0.0, expected
    fold = math.sin(frozen().largest_incline())
    for beside in (-1e-2, -1e-6, 1e-6, 1e-2):
        scene = frozen(math.asin(fold * (1 + beside)))
        start = scene.equilibrium() - 1e-3 * abs(beside) ** 0.5 if beside < 0 else math.pi / 2 - scene.incline
        why = "near the steepest incline with an equilibrium, eq. (53): a shallow well below, and a long rest above"
        yield f"frozen, {abs(beside):.0e} {'below' if beside < 0 else 'above'} the fold", why, scene, start
    for radius in (1e-4, 1e-3, 50.0):
        can = Can.sheet_metal(radius, min(3.6 * radius, 100.0), thickness=radius / 60)
        for name, make in _EITHER:
            yield f"{name}, can of {radius:g} m", "the same motion in units of sqrt(a/g)", make(can=can), 1.0
    for gravity in (0.0, 1e-3, 1e3):
        why = "times are proportional to 1/sqrt(g)" if gravity else "nothing presses the can on the incline"
        for name, make in _EITHER:
            scene = make(gravity=gravity, can=_METAL)
            yield f"{name}, g = {gravity:g} m/s^2", why, scene, 1.0, 0.0 if gravity else 3.0
    for name, scene in _EVERYWHERE:
        for beside in (1e-2, 1e-6, 1e-10):
            expected = {**_ANY, "tolerance": (ACCURATE, REFUSED) if beside < 1e-3 else (ACCURATE,)}
            why, start = "rounding of the start grows as exp(lambda t) near the top", scene.separatrix()[1] - beside
            yield f"{name}, {beside:.0e} rad inside the separatrix", why, scene, start, 0.0, expected
    for name, scene in _EVERYWHERE:
        for spin in (1e2, 1e4):
            why = "the energy of a swing is tiny beside that of the spin"
            yield f"{name}, spun at {spin:.0e} rad/s", why, scene, 0.5, spin
    point, why = "point on the rim of a hoop", "at the bottom the point stands still, and J is the hoop's alone"
    yield f"{point}, let go a quarter turn from the bottom", why, hoop(), math.pi / 2
    light = Scene(Can.hoop(mass=0.2e-6), Load.point(0.2, 0.033), 0.0, "frozen")
    yield f"{point} of 1e-6 of its mass", why, light, math.pi / 2, 0.0, {**_ANY, "tolerance": ()}
    why = "1e-20 kg m^2 are far below MuJoCo's smallest (mjMINVAL, 1e-15), and lost beside the load's 1e-5"
    scene = Scene(Can(mass=1e-3, inertia=1e-20), Load.segment())
    lost = {"equality": (UNSTABLE, REFUSED), "tolerance": (ACCURATE, REFUSED)}
    yield "can with next to no inertia around a sliding load", why, scene, 1.0, 0.0, lost
    for name, scene in _EVERYWHERE:
        why = "exactly on top a sliding load balances, unless rounding pushes it off, and a frozen one rolls down"
        yield f"{name}, let go at pi", why, scene, math.pi, 0.0, {**_ANY, "tolerance": (ACCURATE, REFUSED)}


def _found() -> Iterator[tuple[str, str, tuple[Try, ...]]]:
    """Yield name, cause and tries of the cases in which the random search found errors."""
    fall = math.sqrt(0.033 / 1e-3)
    why = "MuJoCo's solver stops once its cost falls by less than 1e-8 m^2/s^4: its tolerance has to scale with g^2"
    runs = [
        Try(f"contact, RK4, {name}", Trial(scene, 1.0, 0.0, "contact", "RK4", fall / 100, steps=3000), (ACCURATE,))
        for name, scene in (("pendulum", pendulum(gravity=1e-3)), ("frozen", frozen(gravity=1e-3)))
    ]
    yield "contact in a gravity of 1e-3 m/s^2", why, tuple(runs)
    full = sliding(fill=1 - 1e-6)
    stepped = Trial(full, 1.0, timestep=1.0, steps=20_000)
    to_tolerance = Trial(full, 1.0, timestep=10.0, tolerance=1e-6, steps=2000)
    why = "rounding of a distance of 3e8 m exceeds the lever arm b, unless forces are evaluated near the origin"
    runs = [Try("reduced, RK4, 1 s", stepped, (INACCURATE,))]
    runs += [Try("reduced, to a tolerance of 1e-06", to_tolerance, (ACCURATE,), 1e-6)]
    yield "sliding, fill 1 - 1e-6, twenty thousand seconds", why, tuple(runs)

    can = Can(0.025006609705965473, 0.075, 79385.39201711072, 49.64210918385945)
    scene = Scene(can, Load(41429.27842882292, 0.01647772919452516), 0.1789453673759448)
    trial = Trial(scene, 1.762099488321489, -10.949445992431022, tolerance=1e-3, steps=5040)
    why = "two runs were 1.4e-4 rad apart, but 1.1e-3 rad off: steps so large do not show the method's order"
    runs = [Try("reduced, to a tolerance of 0.001", trial, (ACCURATE,))]
    yield "a swing through 2 rad, to a loose tolerance", why, tuple(runs)

    start, step = pendulum().separatrix()[1] - 1.9179754510771998e-4, 9.52342486122195e-4
    trial = Trial(pendulum(), start, timestep=step, tolerance=1e-8, steps=steps_of(1.8888099925141655, step))
    why = "rounding grows a millionfold: two runs were by chance 3e-9 rad apart, and 7e-7 rad off"
    runs = [Try("reduced, to a tolerance of 1e-08", trial, (ACCURATE, REFUSED), 1e-8)]
    yield "pendulum, 1.9e-4 rad inside the separatrix, to a tolerance", why, tuple(runs)

    can = Can(2.232597258875798, 6.697791776627394, 394.26174331092784, 1965.1939220659342)
    load = Load(144122.9903690899, 0.9475437058226647, 229790.58734976512)
    contact: dict[str, Any] = {"rolling": "contact", "integrator": DOP853}
    start, contact["timestep"], contact["friction"] = 3.1415926530014993, 0.006320380984655366, 479.9389762024384
    trial = Trial(Scene(can, load, 1.7453292519943295e-10, "frozen"), start, steps=4187, **contact)
    why = "the solver of the contact took what moves the can for nothing, alike at half the timestep"
    runs = [Try("contact, DOP853, 6 ms", trial, (ACCURATE,))]
    yield "frozen, 6e-10 rad beside the top, in contact", why, tuple(runs)

    contact |= {"timestep": 1.9e-4, "friction": 0.0147}
    trial = Trial(frozen(math.radians(9.4), can=_METAL), -1.13, steps=90, moments=(90.0,), **contact)
    why = "slip has to be counted over all steps, whatever samples are asked for"
    runs = [Try("contact, DOP853, 0.19 ms", trial, (INACCURATE,))]
    yield "a can that slips before its only sample", why, tuple(runs)

    scene, rate = Scene(Can(0.033, 0.1, 61.0, 0.0332), Load(0.1, 0.0039, 1.09e-5), 0.0), 1298.0
    trial = Trial(scene, -1.356, rate, timestep=8 * math.pi / rate, steps=12, moments=(12.0,))
    why = "RK4 sees the same angle at every half of its step, and at half the timestep too; uneven timesteps do not"
    yield "four whole turns in a timestep", why, (Try("reduced, RK4, 19 ms", trial, (INACCURATE,)),)

    can = Can(0.033, 0.099, 0.20528761908358859, 3.284134444100273e-11)
    scene = Scene(can, Load(0.1, 0.023717555437268875, 4.4992031467605796e-24), 0.1530378281024036)
    trial = Trial(scene, 0.1741755317767891, 47.46025974037111, tolerance=8.8e-5, steps=13_500)
    why = "two runs may miss the bottom alike; the energy drifts where a step does, and bounds the tolerance too"
    runs = [Try("reduced, to a tolerance of 8.8e-05", trial, (ACCURATE,), 8.8e-5)]
    yield "a load without inertia in a can with next to none, to a tolerance", why, tuple(runs)
