"""The catalogue's stiff cases: hard constraints, unequal masses, and the chord that vanishes."""

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.model.setting import DOP853, INTEGRATORS, Softness
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.catalogue.case import Attempt, CatalogueCase, attempts
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.load import Load
from mjbeer.theory.scene import frozen, pendulum, sliding

_TIMESTEP = 1e-3
_TIMECONSTS = (20e-3, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4)
_STIFFNESSES = tuple(10.0**k for k in range(2, 11, 2))
_IMPEDANCES = (0.9, 0.99, 0.999, 0.9999)
_IMPRATIOS = (1.0, 10.0, 1e2, 1e3, 1e4)
_FRICTIONS = (1e-3, 1e-2, 0.1, 0.2, 1.0, 1e3)
_RATIOS = tuple(10.0**k for k in range(-6, 7, 2))
_BESIDE_TOP = (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3)
_QUICK = ("Euler", "RK4")


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases."""
    yield from _timeconsts()
    yield from _stiffnesses()
    yield from _impedances()
    yield from _frictions()
    yield from _mass_ratios()
    yield from _beside_top()


def _rocking(label: str, softness: Softness, quick: bool = True) -> Iterator[Attempt]:
    """A second of a frozen load's rocking from phi = 0, by equality and in contact, with every integrator."""
    for rolling in ("equality", "contact"):
        for integrator in (*INTEGRATORS, DOP853):
            run = partial(
                simulate,
                frozen(),
                duration=1.0,
                phi0=0.0,
                rolling=rolling,
                integrator=integrator,
                timestep=_TIMESTEP,
                softness=softness,
            )
            yield Attempt(f"{rolling}, {integrator}, 1 ms{label}", run, sample=quick and integrator in _QUICK)


def _timeconsts() -> Iterator[CatalogueCase]:
    for timeconst in _TIMECONSTS:
        ratio = _TIMESTEP / timeconst
        runs = []
        for refsafe in (False, True):
            label = ", refsafe " + ("on" if refsafe else "off")
            runs += _rocking(label, Softness(solref=(timeconst, 1.0), refsafe=refsafe), quick=not refsafe)
        stable = "inside" if 4 - 4 * ratio - ratio**2 > 0 else "outside"
        yield CatalogueCase(
            "stiff",
            f"solref time constant {1e3 * timeconst:g} ms at 1 ms",
            f"the constraint's own time is {1 / ratio:g} timesteps",
            f"semi-implicit Euler bears h/tau < 0.828, RK4 < 2.785: h/tau = {ratio:g} is {stable} the former; refsafe "
            "raises tau to 2 ms; a soft row lets the can slip",
            tuple(runs),
        )


def _stiffnesses() -> Iterator[CatalogueCase]:
    for stiffness in _STIFFNESSES:
        damping = 2 * math.sqrt(stiffness)
        yield CatalogueCase(
            "stiff",
            f"direct solref, stiffness {stiffness:.0e} /s^2 at 1 ms",
            "negative solref is taken as it is: refsafe does not look at it",
            f"as a time constant of {1e3 / math.sqrt(stiffness):.2g} ms, critically damped",
            tuple(_rocking("", Softness(solref=(-stiffness, -damping)))),
        )


def _impedances() -> Iterator[CatalogueCase]:
    for impedance in _IMPEDANCES:
        yield CatalogueCase(
            "stiff",
            f"solimp {impedance:g}",
            "the share of a force that a constraint does not pass on; MuJoCo's hardest is 0.9999",
            f"the can slips by {1 - impedance:.1g} of what it would without a constraint",
            tuple(_rocking("", Softness(impedance=(impedance, impedance)))),
        )
    for impratio in _IMPRATIOS:
        runs = [each for each in _rocking("", Softness(impratio=impratio)) if each.setting.startswith("contact")]
        yield CatalogueCase(
            "stiff",
            f"impratio {impratio:g}",
            "friction so much harder than the normal force",
            "the less slip the more of it, until the solver cannot balance the two (1e6)",
            tuple(runs),
        )


def _frictions() -> Iterator[CatalogueCase]:
    scene = frozen()
    needed = float(exact(scene, np.linspace(0, 1, 2001), 0.0).forces.needed.max())
    for friction in _FRICTIONS:
        runs = []
        for integrator in (*INTEGRATORS, DOP853):
            go = partial(simulate, scene, 1.0, 0.0, 0.0, "contact", integrator, _TIMESTEP, friction=friction)
            good = (ACCURATE,) if integrator in ("RK4", DOP853) else ()
            expected = good if friction > needed else (INACCURATE,)
            runs.append(Attempt(f"contact, {integrator}, 1 ms", go, expected, sample=integrator in _QUICK))
        yield CatalogueCase(
            "stiff",
            f"friction {friction:g}",
            "a can needs friction to roll" if friction < needed else "friction that does not give way",
            f"rocking from phi = 0 needs a coefficient of {needed:.3f}; with less the can slips, unlike the paper's",
            tuple(runs),
        )


def _mass_ratios() -> Iterator[CatalogueCase]:
    for ratio in _RATIOS:
        for name, make in (("sliding", sliding), ("frozen", frozen)):
            beer = Load.segment().mass
            can = Can.hoop(mass=ratio * beer)
            yield CatalogueCase(
                "stiff",
                f"{name}, can {ratio:.0e} times the load",
                "the mass matrix is as ill-conditioned as the masses are unequal",
                "only ratios of masses enter, and none of them does harm: J is a sum of positive parts",
                attempts(make(can=can), 1.0),
            )
    yield CatalogueCase(
        "stiff",
        "pendulum on a wheel of 0.1 g",
        "a point load of 100 g has hardly any inertia about the axis but what the wheel gives it",
        "J falls to a thousandth at phi = 0: the load swings through there in a thousandth of the period",
        attempts(pendulum(wheel_mass=1e-4), 1.0, expected={"reduced": (), "equality": (), "tolerance": (ACCURATE,)}),
    )


def _beside_top() -> Iterator[CatalogueCase]:
    for beside in _BESIDE_TOP:
        yield CatalogueCase(
            "stiff",
            f"frozen, let go {beside:g} rad beside pi",
            "the chord tendon that makes J has no length at pi, and no direction",
            "J is smooth there, and the can rolls down; from 0.83 s on a real one leaves the incline",
            attempts(frozen(), math.pi - beside),
        )
