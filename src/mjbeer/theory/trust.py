"""How much error, slip and lift of a motion is trusted, and what its record says against it."""

import math

from mjbeer.theory.record import Record

ERROR = 1e-2
"""Largest estimated error of phi and u/a [rad], relative beyond 1 rad, that is trusted: half a degree."""
SLIP = 1e-3
"""Largest slip, in radii, that is trusted: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline, in radii, that is trusted."""


def doubts(record: Record, can_part: bool) -> list[str]:
    """Return the reasons in its record not to trust a motion, one sentence for each.

    `can_part` says whether the can could leave the incline, as in contact. Where it could not, a normal force below 0
    is a reason, as a real can would have left.
    """
    reasons, radius = [], record.scene.can.radius
    if not record.implied_error <= ERROR:
        reasons.append(
            f"energy or momentum drift like an error of {record.implied_error:.2g} rad of phi or u/a (trusted up to "
            f"{ERROR:g}): take a smaller timestep or a better integrator"
        )
    if not record.slip <= SLIP * radius:
        reasons.append(f"the can slips by {record.slip / radius:.2g} radii (trusted up to {SLIP:g})")
    if not record.lift <= LIFT * radius:
        reasons.append(
            f"the can parts from the incline, or sinks in, by {record.lift / radius:.2g} radii (trusted up to {LIFT:g})"
        )
    if not can_part and math.isfinite(record.fails_at):
        reasons.append(
            f"from t = {record.fails_at:.6g} s the incline would have to pull at the can (N < 0): a real one leaves "
            "it there"
        )
    return reasons
