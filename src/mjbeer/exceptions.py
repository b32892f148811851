"""The errors that mjbeer raises on purpose, and its warnings. Catching `MjbeerError` catches all errors."""

import warnings
from collections.abc import Callable
from contextvars import ContextVar


class MjbeerError(Exception):
    """The base class of all mjbeer errors."""


class ParameterError(MjbeerError, ValueError):
    """A parameter has a value that is not allowed, or not for what is asked; the message says what is."""


class NoEquilibriumError(MjbeerError):
    """The scene has no equilibrium: the incline is too steep, or nothing restores the load."""


class NoLibrationError(MjbeerError):
    """The motion asked for is no libration: its amplitude or start is at or beyond the separatrix."""


class UnsupportedError(MjbeerError):
    """MuJoCo, or another engine, cannot model this scene with the requested way of rolling."""


class DivergenceError(MjbeerError):
    """The state of a simulation stopped being finite; the message names the time and the cause."""


class ToleranceError(MjbeerError):
    """A run did not reach the requested tolerance; the message names how near it came."""


class RenderingError(MjbeerError):
    """Off-screen rendering or video writing could not start; the message names a remedy."""


class AngleWarning(UserWarning):
    """A start angle is so large that degrees may have been meant, where radians are taken."""


class UntrustedWarning(UserWarning):
    """A run is not to be relied on, as its steps show (`Trajectory.warnings`), or as a parent's options let expect."""


class LiquidWarning(UserWarning):
    """A liquid is no lump, slips at rates that its damping is not for, or sloshes higher than linear theory goes."""


class TemplateError(MjbeerError):
    """A file of MJCF is missing, lacks an element that mjbeer uses, or moves otherwise than theory says."""


class OutputError(MjbeerError):
    """An output file could not be written, or another command is writing to its folder."""


# Gives a `LiquidWarning` unless a sweep collects them: the filters of `warnings`, of all threads at once, would not do.
warn_of_liquid: ContextVar[Callable[..., None]] = ContextVar("warn_of_liquid", default=warnings.warn)
