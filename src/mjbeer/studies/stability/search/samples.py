"""Random samples: how many timesteps apart, or after which numbers of timesteps."""

from mjbeer.studies.stability.search.pick import Pick

Samples = tuple[int, tuple[float, ...] | None]
_MANY = 200
"""Largest number of regular samples after the start, so that repeating a run takes few of them."""


def regular(pick: Pick, steps: int, anywhere: bool) -> Samples:
    """Return samples at every timestep, or at every so many."""
    return max(1, -(-steps // pick.one(_MANY, 10 * _MANY))), None


def sparse(pick: Pick, steps: int, anywhere: bool) -> Samples:
    """Return two to six samples; `anywhere` says whether they may lie between timesteps."""
    count = pick.one(2, 3, 4, 5, 6)
    moments = {pick.between(0, steps) for _ in range(count)}
    if not anywhere:
        moments = {float(round(moment)) for moment in moments}
    return 1, tuple(sorted(moments))


def late(pick: Pick, steps: int, anywhere: bool) -> Samples:
    """Return the last sample alone, or with the one before."""
    return 1, tuple(sorted({float(max(0, steps - pick.one(0, 0, 1))), float(steps)}))


def anything(pick: Pick, steps: int, anywhere: bool) -> Samples:
    """Return any of these samples."""
    return pick.one(regular, sparse, late)(pick, steps, anywhere)
