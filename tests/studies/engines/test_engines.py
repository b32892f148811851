"""`make engines` survives what an engine may do, and the engines that are at hand roll as the
results say."""

import json
import os
import pathlib
import re
import sys

import pytest

from mjbeer.studies.engines import results as stored
from mjbeer.studies.engines.results import TIMESTEPS, Results, Row
from tools import engines
from tools.engines import FOLDER, FailedError, Program
from tools.environments import AbsentError

FILES = sorted(FOLDER.glob("*_can.py"))
ENGINE = """
import json, sys
question = json.loads(sys.stdin.read() or "{}")
if not question:
    setting = {"shape": "disc", "name": "default", "about": "", "tuned": False}
    told = {"name": "Fake", "settings": [setting], "versions": {}, "python": "3"}
else:
    with open("CALLS", "a") as calls:
        calls.write("called\\n")
    case = question["case"]
    times = [0.04 * number for number in range(51)]
    motion = {"time": times} | {
        name: [0.0] * 51 for name in ("phi", "u", "phi_dot", "u_dot", "lateral")
    }
    told = {"motion": motion, "aside": motion, "seconds": [0.1, 0.2]}
print("what an engine has to say")
print(json.dumps(told))
"""
# The engine's own rounding, and that of another processor's.
CLOSE = 0.05


def fake(folder: pathlib.Path, code: str) -> Program:
    path = folder / "fake_can.py"
    path.write_text(code.replace("CALLS", str(folder / "calls")))
    path.with_name("common.py").touch()
    return Program(path, sys.executable)


def a_row() -> Row:
    return Row("roll", "Fake", "disc", "default", False, 1e-3)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_file_pins_its_packages_and_does_without_mjbeer(path: pathlib.Path) -> None:
    needed = engines.requirements(path)
    assert all(re.search(r"==\d|<\d", package) for package in needed)
    assert not re.search(r"^\s*(import|from) mjbeer", path.read_text(), re.MULTILINE)


def test_the_results_are_those_of_the_files_as_they_are() -> None:
    """A file that was changed since has to be measured anew."""
    known = {engine.file: engine.digest for engine in Results.load().engines}
    assert known == {path.stem: engines.digest(path) for path in FILES}


def test_a_file_without_a_head_is_refused(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "bare_can.py"
    path.write_text("import pymunk\n")
    with pytest.raises(ValueError, match=r"bare_can\.py has no head"):
        engines.requirements(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "limit", "reason"),
    [
        ("raise SystemError('no display')", 60.0, "it ends with SystemError: no display"),
        ("import os; os.abort()", 60.0, "it ends with exit status -6"),
        ("import time; time.sleep(60)", 0.2, "it takes longer than 0.2 s"),
    ],
)
def test_an_engine_that_fails_leaves_the_reason(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    code: str,
    limit: float,
    reason: str,
) -> None:
    monkeypatch.setattr(engines, "LIMIT", limit)
    program = fake(tmp_path, code)
    found = engines.rolled(program, a_row(), 0)
    assert found.failure == reason
    assert found.motion is None
    with pytest.raises(FailedError, match=re.escape(reason)):
        program.ask({})


@pytest.mark.slow
def test_an_interrupted_run_goes_on_and_an_absent_engine_is_named(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = fake(tmp_path, ENGINE)
    missing = tmp_path / "missing_can.py"
    saved = tmp_path / "unfinished.json"

    def of(path: pathlib.Path) -> Program:
        if path == missing:
            raise AbsentError("pip cannot install missing_can: no wheel")
        return program

    def one_after_another(jobs: list, _: object):
        for job in jobs:
            yield job, job.work()

    monkeypatch.setattr(engines, "program", of)
    monkeypatch.setattr(engines, "finished_jobs", one_after_another)
    calls = tmp_path / "calls"
    engines.measure([missing, program.path], Results(), saved)
    whole = Results.load(saved)
    assert len(whole.rows) == 2 * len(TIMESTEPS) == len(calls.read_text().splitlines())
    assert whole.absent == {"missing_can": "pip cannot install missing_can: no wheel"}
    # Interrupted after three rows, it measures the other ones alone.
    whole.rows = whole.rows[:3]
    calls.unlink()
    engines.measure([program.path], whole, saved)
    assert len(calls.read_text().splitlines()) == 2 * len(TIMESTEPS) - 3
    assert len(Results.load(saved).rows) == 2 * len(TIMESTEPS)
    # Another file is another engine.
    fake(tmp_path, f"{ENGINE}\n# changed")
    calls.unlink()
    engines.measure([program.path], Results.load(saved), saved)
    assert len(calls.read_text().splitlines()) == 2 * len(TIMESTEPS)


def test_one_engine_is_measured_alone_and_the_others_stay(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "results.json"
    monkeypatch.setattr(engines, "RESULTS", path)
    monkeypatch.setattr(engines, "ENVIRONMENTS", tmp_path)
    monkeypatch.setattr(sys, "argv", ["engines", "--only", "mujoco"])
    kept = []

    def measure(paths: list[pathlib.Path], results: Results, saved: pathlib.Path) -> None:
        assert [path.stem for path in paths] == ["mujoco_can"]
        kept.extend(results.rows)

    monkeypatch.setattr(engines, "measure", measure)
    path.write_text(stored.RESULTS.read_text())
    engines.main()
    names = {row.engine for row in Results.load(stored.RESULTS).rows}
    assert {row.engine for row in kept} == names - {"MuJoCo"}
    assert json.loads(path.read_text())["engines"]


def test_an_engine_that_cannot_be_had_does_not_lose_its_rows(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "results.json"
    path.write_text(stored.RESULTS.read_text())

    def absent(_: pathlib.Path) -> Program:
        raise AbsentError("pip cannot install pymunk_can: no wheel")

    monkeypatch.setattr(engines, "RESULTS", path)
    monkeypatch.setattr(engines, "ENVIRONMENTS", tmp_path)
    monkeypatch.setattr(engines, "program", absent)
    monkeypatch.setattr(sys, "argv", ["engines", "--only", "pymunk"])
    with pytest.raises(SystemExit, match="nothing was measured"):
        engines.main()
    assert "pip cannot install pymunk_can: no wheel" in capsys.readouterr().err
    assert path.read_text() == stored.RESULTS.read_text()


@pytest.mark.parametrize("only", ["rolls", "mujoco_can", ""])
def test_an_engine_that_has_no_file_is_refused(
    only: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["engines", "--only", only])
    with pytest.raises(SystemExit):
        engines.main()
    message = f"there is no engine {only!r}; allowed are box2d, dart, drake"
    assert message in capsys.readouterr().err


@pytest.mark.costly
@pytest.mark.parametrize("name", ["mujoco", "pymunk"])
def test_an_engine_rolls_as_the_results_say(name: str) -> None:
    """MuJoCo is mjbeer's own. pip puts Pymunk, which has 1 MB, into build/engines."""
    path = FOLDER / f"{name}_can.py"
    try:
        program = Program(path, sys.executable) if name == "mujoco" else engines.program(path)
    except AbsentError as error:
        if os.environ.get("MJBEER_EVERYTHING"):
            raise
        pytest.skip(str(error))
    about = engines.engine(program)
    compared = 0
    for index, rows in engines.empty_rows(about, [1e-3]).items():
        for row in rows:
            (known,) = [
                stored_row
                for stored_row in Results.load().rows
                if stored_row.key == row.key and stored_row.timestep == row.timestep
            ]
            found = engines.rolled(program, row, index)
            if not known.is_sensitive:
                assert found.error == pytest.approx(known.error, rel=CLOSE), row.key
                compared += 1
    assert compared >= 2
