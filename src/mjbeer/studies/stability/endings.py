"""How the runs of the stability search ended, and what the file of a study has of them."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from mjbeer.studies.stability.judge import Outcome


@dataclass(frozen=True)
class KnownRun:
    """How a variant of a known case ended."""

    setting: str
    """The setting of the variant, in words."""
    as_it_must: bool
    """Whether it ended as it must."""
    outcome: Outcome

    def as_json(self) -> dict[str, Any]:
        """Return the run as a study's file has it."""
        head = {"setting": self.setting, "as it must": self.as_it_must}
        return head | asdict(self.outcome)

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Self:
        """Return the run of which a study's file has this."""
        return cls(row["setting"], row["as it must"], _outcome(row))


@dataclass(frozen=True)
class KnownEndings:
    """How the variants of a known case ended."""

    why: str
    """The reason why it is a case."""
    runs: list[KnownRun]

    @property
    def wrong(self) -> int:
        """How many variants did not end as they must."""
        return sum(not run.as_it_must for run in self.runs)

    def as_json(self) -> dict[str, Any]:
        """Return the case as a study's file has it."""
        return {"why": self.why, "runs": [run.as_json() for run in self.runs]}

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Self:
        """Return the case of which a study's file has this."""
        return cls(row["why"], [KnownRun.from_json(run) for run in row["runs"]])


@dataclass(frozen=True)
class SilentRun:
    """A random run that was trusted and wrong."""

    number: int
    """The number from which its trial follows."""
    region: str
    """The name of the region that its trial is of."""
    outcome: Outcome
    trial: str
    """The trial as Python writes it."""

    def as_json(self) -> dict[str, Any]:
        """Return the run as a study's file has it."""
        head = {"number": self.number, "region": self.region}
        return head | asdict(self.outcome) | {"trial": self.trial}

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Self:
        """Return the run of which a study's file has this."""
        return cls(row["number"], row["region"], _outcome(row), row["trial"])


@dataclass(frozen=True)
class BatchEndings:
    """How a batch of random runs ended."""

    kinds: dict[str, dict[str, int]]
    """The counts of verdicts and judges by kind of model."""
    silent: list[SilentRun]
    """The silent runs, one by one."""

    def as_json(self) -> dict[str, Any]:
        """Return the batch as a study's file has it."""
        return {"kinds": self.kinds, "silent": [run.as_json() for run in self.silent]}

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Self:
        """Return the batch of which a study's file has this."""
        return cls(row["kinds"], [SilentRun.from_json(run) for run in row["silent"]])


def _outcome(row: Mapping[str, Any]) -> Outcome:
    """Return the outcome of which a study's file has this; JSON has no infinity."""
    return Outcome(
        verdict=row["verdict"],
        judged_by=row["judged_by"],
        error=math.inf if row["error"] is None else row["error"],
        admitted=math.inf if row["admitted"] is None else row["admitted"],
        says=row["says"],
    )
