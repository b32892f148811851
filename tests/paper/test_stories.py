"""The paper's stories: their plots, films and text, as `mjbeer paper` writes them."""

import math
import os
import pathlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from mjbeer import exact
from mjbeer.cli.app import main
from mjbeer.drawing import opengl
from mjbeer.paper import stories
from mjbeer.paper.story_plots import footnote_8_as_printed
from mjbeer.paper.witness import footnote_scene
from tests.support import stubs

pytestmark = pytest.mark.slow

STORIES = {story.name: story for story in stories.STORIES}


@pytest.mark.costly
@pytest.mark.parametrize("name", STORIES)
def test_a_plot_is_drawn_and_small(name: str, tmp_path: pathlib.Path) -> None:
    STORIES[name].plot(tmp_path / name)

    assert os.listdir(tmp_path) == [f"{name}.svg"]
    assert (tmp_path / f"{name}.svg").stat().st_size < 150_000


def test_footnote_8_as_printed_is_another_motion() -> None:
    times = np.linspace(0, 3, 301)
    truth = exact(footnote_scene(), times, 0.0).phi

    printed = footnote_8_as_printed(footnote_scene(), times, 0.0)

    assert np.abs(printed - truth).max() > math.radians(4)


class Written(NamedTuple):
    """What `mjbeer paper` wrote."""

    names: set[str]
    """Of the files."""
    text: str
    """Of stories.md."""
    messages: str


@pytest.fixture
def write(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> Callable[..., Written]:
    """Return the command `mjbeer paper`, which here has one story and draws no film."""
    stubs.draw(monkeypatch)

    def written(*options: str) -> Written:
        assert main(["paper", *options, "--output", str(tmp_path)]) == 0
        names = {name for name in os.listdir(tmp_path) if not name.startswith(".")}
        text = (tmp_path / "stories.md").read_text()
        messages = capsys.readouterr().err
        assert f"the stories are in {tmp_path / 'stories.md'}\n" in messages
        for line in ("## told", "![told](told.svg)", "A stub's story."):
            assert line in text
        return Written(names, text, messages)

    return written


PLOTS_AND_TEXT = {"letters.svg", "told.svg", "stories.md"}
FILM_LINK = "[Film](told.mp4)"
NO_FILM = opengl.missing_films_message(["told.mp4"])


def test_the_command_writes_plots_and_text(write: Callable[..., Written]) -> None:
    written = write()

    assert written.names == PLOTS_AND_TEXT
    assert FILM_LINK not in written.text
    assert f"Films: {NO_FILM}\n" not in written.text
    assert NO_FILM not in written.messages


def test_the_command_writes_films_if_it_is_asked_to(write: Callable[..., Written]) -> None:
    written = write("--films")

    assert written.names == PLOTS_AND_TEXT | {"told.mp4"}
    assert FILM_LINK in written.text
    assert f"Films: {NO_FILM}\n" not in written.text
    assert NO_FILM not in written.messages


def test_the_command_names_the_films_that_cannot_be_drawn(
    write: Callable[..., Written], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(opengl, "problem", lambda: "no OpenGL")

    written = write("--films")

    assert written.names == PLOTS_AND_TEXT
    assert FILM_LINK not in written.text
    assert f"Films: {NO_FILM}\n" in written.text
    assert NO_FILM in written.messages
