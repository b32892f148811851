"""Tables of tracks are read as people have them, or refused by line and column."""

import pathlib
import re
from typing import Any

import numpy as np
import pytest

from mjbeer import Track, read_track
from mjbeer.exceptions import ParameterError
from tests.support.tables import PLACE, TABLES, THOUSANDS, TIME, UNCLEAR, table


def written(folder: pathlib.Path, text: str, encoding: str = "utf-8") -> pathlib.Path:
    path = folder / "can.txt"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])  # the latter two are Excel's
def test_tables_as_people_have_them(text: str, encoding: str, tmp_path: pathlib.Path) -> None:
    track = read_track(written(tmp_path, text, encoding))
    assert track.time == pytest.approx(TIME)
    assert track.along - track.along[0] == pytest.approx(PLACE - PLACE[0], abs=1e-8)


@pytest.mark.parametrize(("text", "places"), THOUSANDS.values(), ids=THOUSANDS)
def test_a_comma_is_what_the_other_numbers_say(
    text: str, places: list[float], tmp_path: pathlib.Path
) -> None:
    track = read_track(written(tmp_path, text))
    first = track.along[: len(places)]
    assert first == pytest.approx(places, rel=1e-12)


@pytest.mark.parametrize("column", ["A (cm) raw", 2, "2"])
def test_frames_with_a_rate_and_columns_by_name(column: str | int, tmp_path: pathlib.Path) -> None:
    frames = np.arange(20) + 3
    roll = PLACE / 0.033
    text = table("frame,A (cm) raw,roll (deg)", ",", frames, 100 * PLACE, np.degrees(roll))
    track = read_track(written(tmp_path, text), {"x": column}, rate=60)
    assert track.time == pytest.approx(frames / 60)
    assert track.along == pytest.approx(PLACE)
    assert track.roll == pytest.approx(roll)


def test_a_time_in_the_table_counts_before_frames(tmp_path: pathlib.Path) -> None:
    text = table("frame,t,x", ",", np.arange(20), TIME, PLACE)
    assert read_track(written(tmp_path, text)).time == pytest.approx(TIME)


GOOD = TABLES["spaces"].replace(" ", ",")
PIXELS = GOOD.replace("t,x", "t,x (px)")
LOST = re.sub(r"(?m)^(17.0166\d*),.*$", r"\1,lost", GOOD)
BACKWARDS = re.sub(r"(?m)^17.033\d*", "17.01", GOOD)
SHORT = "\n".join(GOOD.splitlines()[:8])
ON_THE_RIM = table("t,x,y", ",", TIME, PLACE, 0.03 * np.sin(60 * PLACE))
WRONG = {
    **UNCLEAR,
    "line 1: 2 columns may be x; say which": table("t,x,X", ",", TIME, PLACE, PLACE),
    "line 1: time and x are needed": table("t,z", ",", TIME, PLACE),
    "line 1, column 2: the unit of x is one of m, cm, mm, or pixels with a scale or marks": PIXELS,
    "line 3, column 2: 'lost' is no number": LOST,
    "line 4, column 1: this time is not later": BACKWARDS,
    "is no table": "nothing here\n",
    "there must be a heading": GOOD.partition("\n")[2],
    "rate of the frames must be": table("frame,x", ",", TIME, PLACE),
    "12 points or more": SHORT,
    "x and y are 13 % of their length off a straight line": ON_THE_RIM,
}
"""What is said, and of which table."""


@pytest.mark.parametrize(("message", "text"), WRONG.items(), ids=WRONG)
def test_what_cannot_be_read_is_refused(message: str, text: str, tmp_path: pathlib.Path) -> None:
    path = written(tmp_path, text)
    with pytest.raises(ParameterError, match=re.escape(message)):
        read_track(path)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"x": "place"}, "line 1: no columns may be x"),
        ({"x": 3}, "line 1: no columns may be x"),
        ({"place": "x"}, "columns are those of time, frame, x"),
    ],
)
def test_columns_that_are_not_there_are_refused(
    columns: dict[str, str | int], message: str, tmp_path: pathlib.Path
) -> None:
    path = written(tmp_path, GOOD)
    with pytest.raises(ParameterError, match=message):
        read_track(path, columns)


def test_a_file_that_is_not_there_is_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(ParameterError, match=r"cannot read '.*nowhere.csv': No such file"):
        read_track(tmp_path / "nowhere.csv")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"time": TIME[::-1]}, "a track has 12 points or more, ever later"),
        ({"along": 0 * PLACE}, "not all in one place"),
        ({"along": None}, "along must be a list or a one-dimensional array"),
        ({"roll": PLACE[1:]}, "roll must have as many entries as time, 20, got 19"),
        ({"phi": np.full(20, np.nan)}, r"phi\[0\] must be a finite number"),
    ],
)
def test_what_is_no_track_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Track(**{"time": TIME, "along": PLACE, **changes})
