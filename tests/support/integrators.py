"""What the integrators are told about a scene."""

from mjbeer.integrators.gauss_jackson import SwingLaw
from mjbeer.theory.scene import Scene


def swing_law(scene: Scene) -> SwingLaw:
    """The law of a scene's load as plain numbers."""
    shape = scene.oscillator
    return SwingLaw(
        base=shape.base,
        chord=shape.chord,
        coupling=shape.coupling,
        ramp=shape.ramp,
        depth=shape.depth,
        bottom=shape.bottom,
        arm=scene.load.moment / scene.effective_mass,
    )
