"""One command at a time writes to a folder; who comes second is told who was first, and never waits."""

import errno
import os
import pathlib
import signal
import time

import pytest
from filelock import FileLock

from mjbeer.cli.app import main
from mjbeer.exceptions import OutputError
from mjbeer.output.exclusive import claimed
from tests.support.processes import interrupt, start

HOLD = """
import pathlib, sys, time
from mjbeer.output.exclusive import claimed
sys.argv[0] = "/somewhere/mjbeer"
with claimed(pathlib.Path(sys.argv[2])):
    print("claimed", flush=True)
    time.sleep(60)
"""
COMMANDS = ("report", "benchmark", "paper")


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGKILL])
def test_the_second_command_is_refused_at_once_until_the_first_is_gone(
    end: int, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Killed, it cannot tidy up; what it leaves keeps nobody out and goes with the next claim."""
    holder = start(["report", str(tmp_path)], HOLD)
    assert holder.stdout is not None
    holder.stdout.readline()
    begin = time.monotonic()
    for command in COMMANDS:
        assert main([command, "--output", str(tmp_path)]) == 2
        said = capsys.readouterr().err
        assert said == (
            f"mjbeer: cannot write to {tmp_path}: process {holder.pid} on {os.uname().nodename} (`mjbeer report "
            f"{tmp_path}`) is writing there; wait for its end, or write elsewhere\n"
        )
    assert time.monotonic() - begin < 30
    assert len(os.listdir(tmp_path)) == 1
    interrupt(holder, lambda: True, end)
    with claimed(tmp_path):
        pass
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_that_writes_a_folder_claims_it(
    command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = []

    def work(*_: object) -> None:
        for folder in (tmp_path, tmp_path / "paper"):
            try:
                with claimed(folder):
                    seen.append(False)
            except OutputError:
                seen.append(True)
        raise OutputError("enough")

    for name in ("report.write", "studies.benchmark.run.conduct", "paper.stories.report.write"):
        monkeypatch.setattr(f"mjbeer.{name}", work)
    assert main([command, "--output", str(tmp_path)]) == 2
    assert seen == [True, command == "report"]
    assert not os.listdir(tmp_path)


def test_the_stories_of_a_report_are_the_report_s(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    with claimed(tmp_path / "paper"):
        assert main(["report", "--output", str(tmp_path)]) == 2
    assert f"cannot write to {tmp_path / 'paper'}" in capsys.readouterr().err
    assert not os.listdir(tmp_path)


def test_a_folder_is_made_and_goes_again_if_nothing_came_into_it(tmp_path: pathlib.Path) -> None:
    with claimed(tmp_path / "a" / "new"):
        pass
    assert os.listdir(tmp_path / "a") == []
    with claimed(tmp_path / "a" / "new"):
        (tmp_path / "a" / "new" / "file").touch()
    assert os.listdir(tmp_path / "a" / "new") == ["file"]
    (tmp_path / "mine").mkdir()
    with claimed(tmp_path / "mine"):
        pass
    assert (tmp_path / "mine").is_dir()


def fail_to_lock(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    def fail(_: FileLock) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(FileLock, "_acquire", fail)


def test_a_file_system_without_locks_is_written_to_even_so(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fail_to_lock(monkeypatch, errno.ENOLCK)
    with claimed(tmp_path):
        (tmp_path / "file").touch()
    assert os.listdir(tmp_path) == ["file"]


def test_a_file_system_that_fails_is_an_output_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fail_to_lock(monkeypatch, errno.EIO)
    with pytest.raises(OutputError) as caught, claimed(tmp_path):
        pytest.fail("it was claimed")
    assert str(caught.value) == f"cannot write to {tmp_path}: Input/output error"


def test_an_error_within_is_its_own(tmp_path: pathlib.Path) -> None:
    with pytest.raises(OSError, match="mine"), claimed(tmp_path):
        raise OSError("mine")
    assert not os.listdir(tmp_path)
