"""Cases in which the regions of the random search found errors: a late sample, a resonance, a bottom passed fast."""

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.model.setting import DOP853
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.catalogue.case import Attempt, CatalogueCase
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen
from mjbeer.theory.scene import Scene


def cases() -> Iterator[CatalogueCase]:
    """Yield the cases of this module."""
    step = 1.9e-4
    slipping = partial(
        simulate, frozen(math.radians(9.4), can=Can.sheet_metal()), 90 * step, -1.13, 0.0, "contact", DOP853, step
    )
    yield CatalogueCase(
        "found",
        "a can that slips before its only sample",
        "slip was counted from the first sample, and both of the runs that were compared had slipped alike",
        "slip, drifts and the distance of two runs are those of all steps, whatever samples are asked for",
        (
            Attempt(
                "contact, DOP853, 0.19 ms",
                partial(slipping, times=np.array([90 * step]), friction=0.0147),
                (INACCURATE,),
            ),
        ),
    )
    rate = 1298.0
    step = 8 * math.pi / rate
    heavy = Scene(Can(0.033, 0.1, 61.0, 0.0332), Load(0.1, 0.0039, 1.09e-5), 0.0)
    yield CatalogueCase(
        "found",
        "four whole turns in a timestep",
        "RK4 sees the same angle at every half of its step, and a run at half the timestep as well: the error was 0.16 "
        "rad, and the estimate 0.001",
        "a second run with uneven timesteps sees other angles",
        (
            Attempt(
                "reduced, RK4, 19 ms",
                partial(simulate, heavy, 12 * step, -1.356, rate, timestep=step, times=np.array([12 * step])),
                (INACCURATE,),
            ),
        ),
    )
    yield CatalogueCase(
        "found",
        "a load without inertia in a can with next to none, to a tolerance",
        "the load passes the bottom in no time, and two runs may miss it alike: the error was 1.5e-4 rad, and the "
        "estimate 4.9e-5",
        "the energy drifts where a step misses the bottom, and bounds the tolerance too",
        (
            Attempt(
                "reduced, to a tolerance of 8.8e-05",
                partial(simulate, _light(), 13.5, 0.1741755317767891, 47.46025974037111, tolerance=8.8e-5),
                (ACCURATE,),
                8.8e-5,
            ),
        ),
    )


def _light() -> Scene:
    """Return the scene of the load without inertia."""
    can = Can(0.033, 0.099, 0.20528761908358859, 3.284134444100273e-11)
    return Scene(can, Load(0.1, 0.023717555437268875, 4.4992031467605796e-24), 0.1530378281024036)
