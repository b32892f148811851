"""Folders of results: those of others are refused, and what is there stays until what replaces it
is whole."""

import os
import pathlib
import signal

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import OutputError
from mjbeer.output import folders
from tests.support.processes import hear, interrupt, start

COMMANDS = ("benchmark", "stability", "paper", "report")
HOLD = """
import contextlib, pathlib, sys, time
from mjbeer.output.folders import owned
with contextlib.ExitStack() as held:
    for command in sys.argv[2:]:
        held.enter_context(owned(pathlib.Path(sys.argv[1], command), f"mjbeer {command}"))
    print("locked", flush=True)
    time.sleep(3600)
"""
"""A process that holds a folder for each of these commands."""


def write(folder: pathlib.Path, text: str, error: BaseException | None = None) -> None:
    """Write two files as a command does, and fail in between if there is an error."""
    with folders.owned(folder, "mjbeer test"), folders.replaced(folder) as new:
        (new / "first.md").write_text(text)
        if error is not None:
            raise error
        (new / "second.md").write_text(text)


def contents(folder: pathlib.Path) -> dict[str, str]:
    """The files of a folder that are seen, by their names."""
    return {
        path.name: path.read_text() for path in folder.iterdir() if not path.name.startswith(".")
    }


@pytest.mark.parametrize("exists", [True, False])
def test_a_command_writes_again_and_again_to_its_folder(
    exists: bool, tmp_path: pathlib.Path
) -> None:
    """What is in it besides stays."""
    folder = tmp_path / "results"
    if exists:
        folder.mkdir()
    for text in ("old", "new"):
        write(folder, text)
        assert contents(folder) == {"first.md": text, "second.md": text}
    (folder / "notes.txt").write_text("mine")
    write(folder, "newer")
    assert contents(folder) == {"first.md": "newer", "second.md": "newer", "notes.txt": "mine"}
    assert set(os.listdir(folder)) - {".lock"} == {".mjbeer", "first.md", "second.md", "notes.txt"}


@pytest.mark.parametrize("error", [RuntimeError("no more"), KeyboardInterrupt()])
def test_old_results_stay_until_the_new_ones_are_whole(
    error: BaseException, tmp_path: pathlib.Path
) -> None:
    write(tmp_path, "old")
    before = os.listdir(tmp_path)
    with pytest.raises(type(error)) as caught:
        write(tmp_path, "new", error)
    assert caught.value is error
    assert contents(tmp_path) == {"first.md": "old", "second.md": "old"}
    assert sorted(os.listdir(tmp_path)) == sorted(before)


def test_what_a_command_left_that_was_killed_is_not_taken_for_a_result(
    tmp_path: pathlib.Path,
) -> None:
    write(tmp_path, "old")
    (tmp_path / folders.UNFINISHED).mkdir()
    (tmp_path / folders.UNFINISHED / "half.mp4").write_text("ha")
    write(tmp_path, "new")
    assert contents(tmp_path) == {"first.md": "new", "second.md": "new"}
    assert not (tmp_path / folders.UNFINISHED).exists()


def test_a_result_keeps_the_permissions_of_the_file_that_it_replaces(
    tmp_path: pathlib.Path,
) -> None:
    write(tmp_path, "old")
    (tmp_path / "first.md").chmod(0o600)
    write(tmp_path, "new")
    assert (tmp_path / "first.md").stat().st_mode & 0o777 == 0o600


def test_a_folder_with_files_of_others_is_refused_and_stays(tmp_path: pathlib.Path) -> None:
    names = [f"{letter}.html" for letter in "abcde"]
    for name in names:
        (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError) as caught:
        write(tmp_path, "new")
    told = (
        f"cannot write to {tmp_path}: `mjbeer test` did not write what is there "
        "(a.html, b.html, c.html and 2 more)"
    )
    assert str(caught.value) == f"{told}: name a new or an empty folder"
    assert sorted(os.listdir(tmp_path)) == names


def test_a_folder_of_another_command_is_refused(tmp_path: pathlib.Path) -> None:
    with folders.owned(tmp_path, "mjbeer else"):
        pass
    with pytest.raises(OutputError) as caught:
        write(tmp_path, "new")
    advice = "name another folder, or remove this one"
    assert str(caught.value) == f"cannot write to {tmp_path}: it belongs to `mjbeer else`: {advice}"


def test_a_folder_that_is_a_file_is_refused(tmp_path: pathlib.Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(OutputError, match="file: File exists"):
        write(tmp_path / "file", "new")
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.slow
def test_a_second_command_in_a_folder_is_refused_until_the_first_is_gone(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Killed, the first cannot tidy up; what it leaves keeps nobody out."""
    for work in (
        "paper.stories.write",
        "report.page.write",
        "studies.benchmark.timing.run",
        "studies.stability.stability_study.run",
    ):
        monkeypatch.setattr(f"mjbeer.{work}", lambda *_: pytest.fail("it was begun"))
    with start([str(tmp_path), *COMMANDS], HOLD) as holder:
        hear(holder, "locked")
        for command in COMMANDS:
            folder = tmp_path / command

            assert main([command, "--output", str(folder)]) == 2

            refused = f"mjbeer: cannot write to {folder}: another command is at work there\n"
            assert capsys.readouterr().err == refused
            assert sorted(os.listdir(folder)) == [".lock", ".mjbeer"]
        interrupt(holder, signal.SIGKILL)
    for command in 2 * COMMANDS:
        with folders.owned(tmp_path / command, f"mjbeer {command}"):
            pass
