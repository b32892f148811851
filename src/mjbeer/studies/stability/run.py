"""The stability study: runs its tasks one after the other and keeps each result as soon as it is measured."""

import pathlib
from dataclasses import dataclass, field
from typing import Any

from rich.console import Console

from mjbeer.output.terminal import progress_bar
from mjbeer.studies.stability import damped_maps, endurance, laws, limits, maps
from mjbeer.studies.stability.catalogue import cases
from mjbeer.studies.stability.crew import crew
from mjbeer.studies.stability.search import batches
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
                if not (result.get("as_expected", True) and result.get("agrees", True)) or result.get("never"):
                    names.append(f"{group}: {name}")
        return names


OPTIONS = {"quick": "quick", "usual": "", "long": "long", "maps": "maps"}
"""How much a study measures, and the option that asks for it: "long" runs everything, "maps" nothing but all maps, and
the other two differ in the number of random runs."""


def tasks(extent: str) -> list[Task]:
    """Return all tasks of a study of this extent, one of `OPTIONS`."""
    if extent == "maps":
        return [*maps.tasks(), *damped_maps.tasks()]
    sample = extent != "long"
    return [
        *laws.tasks(),
        *limits.tasks(sample),
        *maps.tasks(sample),
        *damped_maps.tasks(sample),
        *cases.tasks(sample),
        *batches.tasks(extent),
        *endurance.tasks(sample),
    ]


def conduct(folder: pathlib.Path, extent: str, console: Console) -> Stability:
    """Run the tasks whose results the study in `folder` lacks, and return the study.

    It is saved as stability.json after each task. The random runs are made on all cores, the other tasks one by one.
    The summary of an earlier study is removed first.

    Raises:
      OutputError: if the folder cannot be written to.
      OSError: if the system ends one of the processes that make the random runs.
      ParameterError: if stability.json is there but is not such a study.
    """
    path = folder / "stability.json"
    study = Stability.begin(path, {"extent": extent}, console)
    (folder / "summary.md").unlink(missing_ok=True)
    todo = tasks(extent)
    random = [
        task for task in todo if task.group == batches.GROUP and task.name not in study.results.get(task.group, {})
    ]
    with progress_bar(console, len(todo)) as begin, crew(random) as measure:
        for task in todo:
            begin(f"{task.group}: {task.name}")
            group = study.results.setdefault(task.group, {})
            if task.name not in group:
                group[task.name] = measure(task)
                study.save(path)
    return study
