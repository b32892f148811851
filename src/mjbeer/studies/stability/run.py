"""The stability study: its tasks, run one after the other and kept as they are done."""

import pathlib
from dataclasses import dataclass, field
from typing import Any

from rich.console import Console

from mjbeer.output.terminal import progress_bar
from mjbeer.studies.stability import endurance, laws, limits, maps, search
from mjbeer.studies.stability.catalogue import cases
from mjbeer.studies.study import Study, Task


@dataclass
class Stability(Study):
    """A study of stability: results by group and name of the task."""

    command = "mjbeer stability"
    results: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)

    def of(self, group: str) -> list[dict[str, Any]]:
        """Return the results of a group, in the order in which they were measured."""
        return list(self.results.get(group, {}).values())

    @property
    def unexpected(self) -> list[str]:
        """What did not come out as theory expects: names of tasks, with the setting where they have several."""
        found = []
        for group, tasks in self.results.items():
            for name, result in tasks.items():
                runs = result.get("runs", [])
                found += [f"{group}: {name}: {each['setting']}" for each in runs if not each["as_expected"]]
                if not (result.get("as_expected", True) and result.get("agrees", True)) or result.get("silent"):
                    found.append(f"{group}: {name}")
        return found


def tasks(quick: bool) -> list[Task]:
    """Return all tasks, or a sample of them that takes two minutes."""
    return [
        *laws.tasks(),
        *limits.tasks(quick),
        *maps.tasks(quick),
        *cases.tasks(quick),
        *search.tasks(quick),
        *endurance.tasks(quick),
    ]


def conduct(folder: pathlib.Path, quick: bool, console: Console) -> Stability:
    """Do what the study in `folder` lacks, and return it; it is kept as stability.json after each task.

    A summary of an earlier one goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      ParameterError: if there is a stability.json that is something else.
    """
    path = folder / "stability.json"
    found = Stability.begin(path, {"quick": quick}, console)
    (folder / "summary.md").unlink(missing_ok=True)
    todo = tasks(quick)
    with progress_bar(console, len(todo)) as begin:
        for task in todo:
            begin(f"{task.group}: {task.name}")
            group = found.results.setdefault(task.group, {})
            if task.name not in group:
                group[task.name] = task.measure()
                found.save(path)
    return found
