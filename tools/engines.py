"""Rolls a can in other physics engines, each in a virtual environment and a process of its own.

`python -m tools.engines` writes engines/results.json within half an hour. If it was interrupted, it
goes on. `--only mujoco` measures the engine of engines/mujoco_can.py anew, and keeps the other
rows. The environments are in build/engines, and stay there: the first run downloads about 1 GB.
"""

import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from contextlib import closing
from functools import partial
from typing import Any, NamedTuple

from mjbeer.output import files
from mjbeer.output.jobs import Job, finished_jobs
from mjbeer.output.terminal import STDERR, say
from mjbeer.studies.can_test import CASES
from mjbeer.studies.engines.results import (
    ASIDE,
    RESULTS,
    TIMESTEPS,
    Engine,
    Motion,
    Results,
    Row,
    question,
)
from mjbeer.studies.study import machine
from tools.environments import CHECKOUT, AbsentError, python_with

FOLDER = CHECKOUT / "engines"
ENVIRONMENTS = CHECKOUT / "build" / "engines"
LIMIT = 300.0
"""The longest time of a process, which rolls the can several times, and may compile first [s]."""
_ENDING = "_can"
"""The end of the name of an engine's file."""
_HEAD = re.compile(r"^# /// script\n(?P<lines>(?:#.*\n)*?)# ///$", re.MULTILINE)
"""The head of a file that says what it needs: PEP 723."""
_SINGLE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


class Program(NamedTuple):
    """A file of an engine, and the Python that runs it."""

    path: pathlib.Path
    python: str

    def ask(self, question: dict[str, Any]) -> dict[str, Any]:
        """Return the answer to a question, as engines/common.py has both.

        Raises:
          FailedError: if there is none.
        """
        try:
            ran = subprocess.run(
                [self.python, self.path],
                input=json.dumps(question),
                capture_output=True,
                text=True,
                check=False,
                timeout=LIMIT,
                env={**os.environ, **_SINGLE_THREAD},
            )
        except subprocess.TimeoutExpired:
            raise FailedError(f"it takes longer than {LIMIT:g} s") from None
        if ran.returncode:
            last = (ran.stderr.strip() or f"exit status {ran.returncode}").splitlines()[-1]
            raise FailedError(f"it ends with {last[-200:]}")
        return json.loads(ran.stdout.splitlines()[-1])


class FailedError(Exception):
    """An engine gave no answer."""


def requirements(path: pathlib.Path) -> list[str]:
    """Return the packages in the head of an engine's file.

    Raises:
      ValueError: if it has no head.
    """
    head = _HEAD.search(path.read_text(encoding="utf-8"))
    if head is None:
        raise ValueError(f"{path} has no head that names its packages, as PEP 723 has it")
    lines = [line.removeprefix("#") for line in head["lines"].splitlines()]
    return tomllib.loads("\n".join(line.strip() for line in lines))["dependencies"]


def program(path: pathlib.Path) -> Program:
    """Return the program of an engine, after installing what it needs.

    Raises:
      AbsentError: if that cannot be had.
    """
    return Program(path, python_with(ENVIRONMENTS / path.stem, path.stem, requirements(path)))


def engine(found: Program) -> Engine:
    """Return what an engine's file says of itself.

    Raises:
      FailedError: if it cannot be run.
    """
    told = found.ask({})
    about = machine()
    return Engine(
        name=told["name"],
        file=found.path.stem,
        digest=digest(found.path),
        machine={name: about[name] for name in ("processor", "cores", "system")},
        versions=told["versions"],
        python=told["python"],
        settings=told["settings"],
    )


def digest(path: pathlib.Path) -> str:
    """Return a sum of an engine's file and of what all files share."""
    content = path.read_bytes() + path.with_name("common.py").read_bytes()
    return hashlib.sha256(content).hexdigest()[:16]


def rolled(found: Program, row: Row, setting: int) -> Row:
    """Return a row with its motion, judged, or with the reason why there is none."""
    asked = {
        "case": question(CASES[row.case]),
        "timestep": row.timestep,
        "setting": setting,
        "aside": ASIDE,
    }
    try:
        told = found.ask(asked)
    except FailedError as error:
        row.failure = str(error)
        return row
    row.judged(Motion(**told["motion"]), Motion(**told["aside"]))
    row.seconds = [float(f"{value:.4g}") for value in told["seconds"]]
    return row


def empty_rows(of: Engine, timesteps: Sequence[float] = TIMESTEPS) -> dict[int, list[Row]]:
    """Return the rows of an engine before they are measured, by the index of their setting."""
    found = {}
    for index, setting in enumerate(of.settings):
        words = (setting["shape"], setting["name"], setting["tuned"])
        found[index] = [
            Row(case, of.name, *words, timestep) for case in CASES for timestep in timesteps
        ]
    return found


def measure(paths: Sequence[pathlib.Path], results: Results, saved: pathlib.Path) -> None:
    """Measure the rows of engines that `results` lacks, and save every one at once."""
    jobs = []
    for path in paths:
        try:
            say(f"preparing {path.stem}")
            found = program(path)
            about = engine(found)
        except (AbsentError, FailedError) as error:
            results.absent[path.stem] = str(error)
            say(str(error))
            continue
        results.drop(path.stem, unless=about.digest)
        results.absent.pop(path.stem, None)
        results.engines.append(about)
        done = {(row.key, row.timestep) for row in results.rows}
        for index, rows in empty_rows(about).items():
            for row in rows:
                if (row.key, row.timestep) not in done:
                    name = f"{', '.join(row.key)}, {1e3 * row.timestep:g} ms"
                    jobs.append(Job(name, partial(rolled, found, row, index)))
    with closing(finished_jobs(jobs, STDERR)) as finished:
        for job, row in finished:
            results.rows.append(row)
            files.write(saved, results.json())
            say(f"{job.name}: {row.failure or format(row.error, '.2g') + ' rad'}")


def main() -> None:
    """Measure all engines, or the one that is named, and write engines/results.json."""
    parser = argparse.ArgumentParser(description="Roll a can in physics engines.")
    parser.add_argument("--only", metavar="NAME", help="the engine of engines/NAME_can.py alone")
    only = parser.parse_args().only
    paths = sorted(FOLDER.glob(f"*{_ENDING}.py"))
    results = Results()
    if only is not None:
        names = [path.stem.removesuffix(_ENDING) for path in paths]
        if only not in names:
            parser.error(f"there is no engine {only!r}; allowed are {', '.join(names)}")
        paths = [FOLDER / f"{only}{_ENDING}.py"]
        if RESULTS.exists():
            results = Results.load(RESULTS)
            results.drop(paths[0].stem)
    unfinished = ENVIRONMENTS / f"unfinished-{only or 'all'}.json"
    if unfinished.exists():
        results = Results.load(unfinished)
        say(f"going on from {unfinished}")
    measure(paths, results, unfinished)
    if only and paths[0].stem in results.absent:
        sys.exit(f"nothing was measured, and {RESULTS.name} stays as it is")
    results.sort()
    files.write(RESULTS, results.json())
    unfinished.unlink(missing_ok=True)
    for file, reason in results.absent.items():
        say(f"left out: {file}: {reason}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        say("interrupted: the same command goes on from here")
        sys.exit(130)
