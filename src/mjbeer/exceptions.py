"""Every error that mjbeer raises on purpose. Catch `MjbeerError` for all of them."""


class MjbeerError(Exception):
    """Base of all mjbeer errors."""


class ParameterError(MjbeerError, ValueError):
    """A parameter is outside what is allowed; the message says what came and what is."""


class NoEquilibriumError(MjbeerError):
    """The scene has no equilibrium: the incline is too steep, or nothing restores the load."""


class NoLibrationError(MjbeerError):
    """A period was asked for at an amplitude at or beyond the separatrix."""


class UnsupportedError(MjbeerError):
    """An engine, MuJoCo or another, has no model of this scene in the requested way of rolling."""


class DivergenceError(MjbeerError):
    """A simulation stopped being finite; the message says when and why."""


class ToleranceError(MjbeerError):
    """The requested tolerance was not met; the message says how far the run got."""


class RenderingError(MjbeerError):
    """Off-screen rendering or video writing could not start; the message names the remedy."""


class TemplateError(MjbeerError):
    """An MJCF template is missing, lacks a part that mjbeer uses, or has one that could act on the motion."""


class OutputError(MjbeerError):
    """An output file could not be written, or another command is at work in its folder."""
