"""The stability study: runs its tasks one after the other and keeps each result as soon as it is measured."""

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
    """A study of stability: the results of its tasks, by group and name."""

    command = "mjbeer stability"
    results: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)

    def of(self, group: str) -> list[dict[str, Any]]:
        """Return the results of a group, in the order in which they were measured."""
        return list(self.results.get(group, {}).values())

    @property
    def unexpected(self) -> list[str]:
        """Names of the tasks whose results are not what theory expects, with the setting where a task has several."""
        names = []
        for group, tasks in self.results.items():
            for name, result in tasks.items():
                runs = result.get("runs", [])
                names += [f"{group}: {name}: {run['setting']}" for run in runs if not run["as_expected"]]
                if not (result.get("as_expected", True) and result.get("agrees", True)) or result.get("silent"):
                    names.append(f"{group}: {name}")
        return names


def tasks(quick: bool) -> list[Task]:
    """Return all tasks, or a sample of them."""
    return [
        *laws.tasks(),
        *limits.tasks(quick),
        *maps.tasks(quick),
        *cases.tasks(quick),
        *search.tasks(quick),
        *endurance.tasks(quick),
    ]


def conduct(folder: pathlib.Path, quick: bool, console: Console) -> Stability:
    """Run the tasks whose results the study in `folder` lacks, and return the study.

    It is saved as stability.json after each task. The summary of an earlier study is removed first.

    Raises:
      OutputError: if the folder cannot be written to.
      ParameterError: if stability.json is there but is not such a study.
    """
    path = folder / "stability.json"
    study = Stability.begin(path, {"quick": quick}, console)
    (folder / "summary.md").unlink(missing_ok=True)
    todo = tasks(quick)
    with progress_bar(console, len(todo)) as begin:
        for task in todo:
            begin(f"{task.group}: {task.name}")
            group = study.results.setdefault(task.group, {})
            if task.name not in group:
                group[task.name] = task.measure()
                study.save(path)
    return study
