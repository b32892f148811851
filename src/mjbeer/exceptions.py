"""The errors that mjbeer raises on purpose, all of them `MjbeerError`, and its warnings."""

import warnings
from collections.abc import Callable
from contextvars import ContextVar


class MjbeerError(Exception):
    """The base class of all mjbeer errors."""


class ParameterError(MjbeerError, ValueError):
    """A parameter is invalid, or invalid for this call; the message says what is allowed."""


class NoEquilibriumError(MjbeerError):
    """The scene has no equilibrium: the incline is too steep, or nothing restores the load."""


class NoLibrationError(MjbeerError):
    """The motion is no swing: its amplitude or its start is at or beyond the separatrix."""


class UnsupportedError(MjbeerError):
    """MuJoCo, or another engine, cannot model this scene with the requested way of rolling."""


class DivergenceError(MjbeerError):
    """The state of a simulation stopped being finite; the message names the time and the cause."""


class ToleranceError(MjbeerError):
    """A run did not reach the requested tolerance; the message says how near it came."""


class RenderingError(MjbeerError):
    """Off-screen rendering or video writing could not start; the message names a remedy."""


class AngleWarning(UserWarning):
    """An initial angle is so large that degrees may have been meant; radians are taken."""


class UntrustedWarning(UserWarning):
    """A run is unreliable, as its steps show (`Trajectory.warnings`).

    Of an attached can: its runs would be, with the options of the model around it.
    """


class LiquidWarning(UserWarning):
    """A model of a liquid is beyond its range.

    The liquid is no lump, slips at rates for which its damping is not valid, or sloshes higher than
    linear theory allows.
    """


class TemplateError(MjbeerError):
    """A file of MJCF is missing or lacks an element, or its accelerations differ from theory."""


class OutputError(MjbeerError):
    """An output file could not be written, or another command is writing to its folder."""


Warn = Callable[..., None]
warn_of_liquid: ContextVar[Warn] = ContextVar("warn_of_liquid", default=warnings.warn)
"""The function that gives a `LiquidWarning`: `warnings.warn`, unless a sweep collects them.

The filters of `warnings` cannot do that, since all threads share them.
"""
