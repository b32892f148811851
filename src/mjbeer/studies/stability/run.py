"""The stability study: its tasks, run one after the other and kept as they are done."""

import json
import pathlib
from dataclasses import dataclass, field
from typing import Any

from rich.console import Console

from mjbeer.exceptions import ParameterError
from mjbeer.output import files
from mjbeer.output.terminal import progress_bar
from mjbeer.studies import study
from mjbeer.studies.stability import endurance, laws, limits, maps, search
from mjbeer.studies.stability.catalogue import cases
from mjbeer.studies.study import Task

_FILE = "stability.json"


@dataclass
class Stability:
    """What was measured: by group and name of the task."""

    settings: dict[str, Any]
    machine: dict[str, Any]
    results: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)

    def of(self, group: str) -> list[dict[str, Any]]:
        """The results of a group, in the order in which they were measured."""
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

    def save(self, folder: pathlib.Path) -> None:
        """Write stability.json, whole or not at all.

        Raises:
          OutputError: if it cannot be written.
        """
        files.write(folder / _FILE, self.json())

    def json(self) -> str:
        """All of it."""
        return json.dumps(vars(self), indent=1, allow_nan=False) + "\n"


def load(path: pathlib.Path) -> Stability:
    """Read a stored study.

    Raises:
      ParameterError: if the file is missing, or no study of this version.
    """
    try:
        return Stability(**json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError) as error:
        raise ParameterError(f"{path} is no study that `mjbeer stability` wrote: {error}") from error


def tasks(quick: bool) -> list[Task]:
    """All tasks, or a sample of them that takes two minutes."""
    return [
        *laws.tasks(),
        *limits.tasks(quick),
        *maps.tasks(quick),
        *cases.tasks(quick),
        *search.tasks(quick),
        *endurance.tasks(quick),
    ]


def run(folder: pathlib.Path, quick: bool, console: Console) -> Stability:
    """Run what a study in `folder` lacks; it is kept there after each task, so that what was interrupted goes on.

    A summary of an earlier one goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      ParameterError: if there is a file of that name which is no study.
    """
    found = Stability({"quick": quick}, study.machine())
    if (folder / _FILE).exists():
        before = load(folder / _FILE)
        if (before.settings, before.machine) == (found.settings, found.machine):
            console.print(f"going on from {folder / _FILE}", highlight=False, markup=False, soft_wrap=True)
            found = before
    (folder / "summary.md").unlink(missing_ok=True)
    todo = tasks(quick)
    with progress_bar(console, len(todo)) as begin:
        for task in todo:
            begin(f"{task.group}: {task.name}")
            group = found.results.setdefault(task.group, {})
            if task.name not in group:
                group[task.name] = task.measure()
                found.save(folder)
    return found
