"""Standard output: tables to be read by eye or by a program."""

import io

import pytest
from rich.console import Console

from mjbeer.output import terminal
from mjbeer.output.terminal import Table

ONE = Table("One", ("name", "value"), [("phi", "1.5"), ("u", "2")])
OTHER = Table("Other", ("name",), [("F",)])


def test_a_program_reads_tabs(capsys: pytest.CaptureFixture[str]) -> None:
    terminal.show(ONE)
    assert capsys.readouterr().out == "name\tvalue\nphi\t1.5\nu\t2\n"


def test_several_tables_have_their_titles(capsys: pytest.CaptureFixture[str]) -> None:
    terminal.show(ONE, OTHER)
    assert capsys.readouterr().out == "# One\nname\tvalue\nphi\t1.5\nu\t2\n\n# Other\nname\nF\n"


def test_an_eye_reads_lines_and_columns(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(terminal, "is_read_by_eye", lambda: True)
    terminal.show(ONE)
    out = capsys.readouterr().out
    assert "│ phi  │   1.5 │" in out
    assert "\t" not in out


@pytest.mark.parametrize("width", [40, 80, 120])
def test_a_progress_bar_has_room_for_its_count(width: int) -> None:
    text = io.StringIO()
    console = Console(file=text, width=width, force_terminal=True)
    with terminal.progress_bar(console, 123456) as begin:
        begin("appendix B m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M")
    assert " 1/123456 " in text.getvalue()
    assert "…" not in text.getvalue()
