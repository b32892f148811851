"""Cases in which the random search found errors, each with the cause and with what detects or avoids it now."""

import math
from collections.abc import Iterator
from functools import partial

from mjbeer.model.setting import DOP853
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.catalogue.case import Attempt, CatalogueCase
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE, REFUSED
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases of this module."""
    slow = math.sqrt(0.033 / 1e-3)
    yield CatalogueCase(
        "found",
        "contact in a gravity of 1e-3 m/s^2",
        "MuJoCo's solver stops as soon as its cost falls by less than 1e-8 m^2/s^4: in weak gravity, before it begins. "
        "Nothing rolled, and neither slip nor lift showed it",
        "the same motion, in units of sqrt(a/g); the solver's tolerance has to scale with the square of gravity",
        tuple(
            Attempt(
                f"contact, RK4, {name}",
                partial(simulate, make(gravity=1e-3), 30 * slow, 1.0, 0.0, "contact", "RK4", slow / 100),
                (ACCURATE,),
            )
            for name, make in (("pendulum", pendulum), ("frozen", frozen))
        ),
    )
    yield CatalogueCase(
        "found",
        "a swing through 2 rad, to a loose tolerance",
        "two runs with large steps had nearly the same error: they were 1.4e-4 rad apart, but 1.1e-3 rad off",
        "steps so large do not show the method's order, so that smaller ones are taken",
        (
            Attempt(
                "reduced, to a tolerance of 0.001",
                partial(simulate, _heavy_can(), 5.04, 1.762099488321489, -10.949445992431022, tolerance=1e-3),
                (ACCURATE,),
            ),
        ),
    )
    nearly_full = partial(simulate, sliding(fill=1 - 1e-6), 2e4, 1.0)
    yield CatalogueCase(
        "found",
        "sliding, fill 1 - 1e-6, twenty thousand seconds",
        "rounding of a distance of 3e8 m exceeds the lever arm b, in both of the runs that a tolerance compares",
        "a swing of 4000 s; only its energy shows that it is lost, unless forces are evaluated near the origin",
        (
            Attempt("reduced, RK4, 1 s", partial(nearly_full, timestep=1.0), (INACCURATE,)),
            Attempt(
                "reduced, to a tolerance of 1e-06",
                partial(nearly_full, timestep=10.0, tolerance=1e-6),
                (ACCURATE,),
                1e-6,
            ),
        ),
    )
    yield from _beside_a_separatrix()


def _beside_a_separatrix() -> Iterator[CatalogueCase]:
    scene, beside = pendulum(), 1.9179754510771998e-4
    inside = partial(simulate, scene, 1.8888099925141655, scene.separatrix()[1] - beside, timestep=9.52342486122195e-4)
    yield CatalogueCase(
        "found",
        "pendulum, 1.9e-4 rad inside the separatrix, to a tolerance",
        "rounding grows a millionfold: two runs were by chance only 3e-9 rad apart, and 7e-7 rad off",
        "earlier pairs of runs were farther apart; and a start shifted by 4e-14 rad bounds the effect of rounding",
        (Attempt("reduced, to a tolerance of 1e-08", partial(inside, tolerance=1e-8), (ACCURATE, REFUSED), 1e-8),),
    )
    can = Can(2.232597258875798, 6.697791776627394, 394.26174331092784, 1965.1939220659342)
    level = Scene(
        can, Load(144122.9903690899, 0.9475437058226647, 229790.58734976512), 1.7453292519943295e-10, "frozen"
    )
    start, timestep = 3.1415926530014993, 0.006320380984655366
    beside_top = partial(
        simulate, level, 4187 * timestep, start, 0.0, "contact", DOP853, timestep, friction=479.9389762024384
    )
    yield CatalogueCase(
        "found",
        "frozen, 6e-10 rad beside the top, in contact",
        "settling into the contact moves the can as far as its start is from the top, and alike at half the timestep: "
        "the run was 0.011 rad off, and 0.0016 rad by its own estimate",
        "a soft contact cannot resolve such a start; a second run that starts 1e-9 rad beside it shows that",
        (Attempt("contact, DOP853, 6 ms", beside_top, (INACCURATE,)),),
    )


def _heavy_can() -> Scene:
    """Return the scene of the swing through 2 rad."""
    can = Can(0.025006609705965473, 0.075, 79385.39201711072, 49.64210918385945)
    return Scene(can, Load(41429.27842882292, 0.01647772919452516), 0.1789453673759448, "sliding")
