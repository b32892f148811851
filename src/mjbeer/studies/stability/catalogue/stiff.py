"""The catalogue's stiff cases: hard constraints, unequal masses, and starts near the top, where a tendon vanishes."""

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
from mjbeer.theory.named import frozen, pendulum, sliding

_TIMESTEP = 1e-3
"""Timestep of the runs with a constraint [s]."""
_TIMECONSTS = (20e-3, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4)
"""Time constants of solref [s]."""
_STIFFNESSES = tuple(10.0**k for k in range(2, 11, 2))
"""Direct stiffnesses of solref [1/s^2]."""
_IMPEDANCES = (0.9, 0.99, 0.999, 0.9999)
"""Impedances, dmin and dmax of solimp."""
_IMPRATIOS = (1.0, 10.0, 1e2, 1e3, 1e4)
"""Ratios of the impedance of friction to that of the normal force."""
_FRICTIONS = (1e-3, 1e-2, 0.1, 0.2, 1.0, 1e3)
"""Friction coefficients."""
_RATIOS = tuple(10.0**k for k in range(-6, 7, 2))
"""Masses of the can over that of the load."""
_BESIDE_TOP = (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3)
"""Distances of the start from the top [rad]."""
_QUICK = ("Euler", "RK4")
"""Integrators of a quick study."""


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases of this module."""
    yield from _timeconsts()
    yield from _stiffnesses()
    yield from _impedances()
    yield from _frictions()
    yield from _mass_ratios()
    yield from _beside_top()


def _rocking(label: str, softness: Softness, quick: bool = True) -> Iterator[Attempt]:
    """Yield attempts at a second of a frozen load that rocks from phi = 0, by equality and in contact."""
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
            f"the constraint's time constant is {1 / ratio:g} timesteps",
            f"semi-implicit Euler is stable for h/tau < 0.828, RK4 for h/tau < 2.785: h/tau = {ratio:g} is {stable} "
            "the former limit; refsafe raises tau to at least 2 ms; a soft constraint lets the can slip",
            tuple(runs),
        )


def _stiffnesses() -> Iterator[CatalogueCase]:
    for stiffness in _STIFFNESSES:
        damping = 2 * math.sqrt(stiffness)
        yield CatalogueCase(
            "stiff",
            f"direct solref, stiffness {stiffness:.0e} /s^2 at 1 ms",
            "refsafe does not apply to a negative solref",
            f"the same as a time constant of {1e3 / math.sqrt(stiffness):.2g} ms, critically damped",
            tuple(_rocking("", Softness(solref=(-stiffness, -damping)))),
        )


def _impedances() -> Iterator[CatalogueCase]:
    for impedance in _IMPEDANCES:
        yield CatalogueCase(
            "stiff",
            f"solimp {impedance:g}",
            "a constraint leaves 1 - impedance of the unconstrained acceleration; MuJoCo's largest is 0.9999",
            f"the can slips by {1 - impedance:.1g} of what it would without a constraint",
            tuple(_rocking("", Softness(impedance=(impedance, impedance)))),
        )
    for impratio in _IMPRATIOS:
        runs = [
            attempt for attempt in _rocking("", Softness(impratio=impratio)) if attempt.setting.startswith("contact")
        ]
        yield CatalogueCase(
            "stiff",
            f"impratio {impratio:g}",
            "friction is harder than the normal force by this factor",
            "the larger it is, the less the can slips, until the solver cannot balance the two forces (at 1e6)",
            tuple(runs),
        )


def _frictions() -> Iterator[CatalogueCase]:
    scene = frozen()
    needed = float(exact(scene, np.linspace(0, 1, 2001), 0.0).forces.needed.max())
    for friction in _FRICTIONS:
        runs = []
        for integrator in (*INTEGRATORS, DOP853):
            run = partial(simulate, scene, 1.0, 0.0, 0.0, "contact", integrator, _TIMESTEP, friction=friction)
            rolling = (ACCURATE,) if integrator in ("RK4", DOP853) else ()
            expected = rolling if friction > needed else (INACCURATE,)
            runs.append(Attempt(f"contact, {integrator}, 1 ms", run, expected, sample=integrator in _QUICK))
        yield CatalogueCase(
            "stiff",
            f"friction {friction:g}",
            "too little friction for the can to roll" if friction < needed else "friction that holds the can",
            f"rocking from phi = 0 needs a coefficient of {needed:.3f}; with less the can slips, unlike in the paper",
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
                "the more unequal the masses, the worse the condition of the mass matrix",
                "only the ratio of the masses matters, and none does harm, because J is a sum of positive parts",
                attempts(make(can=can), 1.0),
            )
    yield CatalogueCase(
        "stiff",
        "pendulum on a wheel of 0.1 g",
        "at phi = 0 the wheel of 0.1 g moves, and the point load of 100 g hardly does",
        "J falls to a thousandth at phi = 0, where the load swings through in a thousandth of the period",
        attempts(pendulum(wheel_mass=1e-4), 1.0, expected={"reduced": (), "equality": (), "tolerance": (ACCURATE,)}),
    )


def _beside_top() -> Iterator[CatalogueCase]:
    for beside in _BESIDE_TOP:
        yield CatalogueCase(
            "stiff",
            f"frozen, let go {beside:g} rad beside pi",
            "at pi the tendon that gives the model its J has no length and no direction",
            "J is smooth there, and the can rolls down; a real one leaves the incline after 0.83 s",
            attempts(frozen(), math.pi - beside),
        )
