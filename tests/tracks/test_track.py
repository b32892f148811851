"""Tables of tracks are read as people have them, and what cannot be read is refused by line and column."""

import pathlib
import re

import numpy as np
import pytest

from mjbeer import read_track
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
def test_a_comma_is_what_the_other_numbers_say(text: str, places: list[float], tmp_path: pathlib.Path) -> None:
    assert read_track(written(tmp_path, text)).along[: len(places)] == pytest.approx(places, rel=1e-12)


@pytest.mark.parametrize("column", ["A (cm) raw", 2, "2"])
def test_frames_with_a_rate_and_columns_by_name(column: str | int, tmp_path: pathlib.Path) -> None:
    text = table("frame,A (cm) raw,roll (deg)", ",", np.arange(20) + 3, 100 * PLACE, np.degrees(PLACE / 0.033))
    track = read_track(written(tmp_path, text), {"x": column}, rate=60)
    assert track.time == pytest.approx((np.arange(20) + 3) / 60)
    assert track.along == pytest.approx(PLACE)
    assert track.roll == pytest.approx(PLACE / 0.033)


GOOD = TABLES["spaces"].replace(" ", ",")
WRONG = {
    **UNCLEAR,
    "line 1: 2 columns may be x; say which": table("t,x,X", ",", TIME, PLACE, PLACE),
    "line 1: time and x are needed": table("t,z", ",", TIME, PLACE),
    "line 1, column 2: the unit of x is one of m, cm, mm, got 'x (px)'": GOOD.replace("t,x", "t,x (px)"),
    "line 3, column 2: 'lost' is no number": re.sub(r"(?m)^(17.0166\d*),.*$", r"\1,lost", GOOD),
    "line 4, column 1: this time is not later": re.sub(r"(?m)^17.033\d*", "17.01", GOOD),
    "line 1: no columns may be x": GOOD,
    "is no table": "nothing here\n",
    "rate of the frames must be": table("frame,x", ",", TIME, PLACE),
    "12 points or more": "\n".join(GOOD.splitlines()[:8]),
    "x and y are 6.8 mm off a straight line": table("t,x,y", ",", TIME, PLACE, 0.03 * np.sin(60 * PLACE)),
}


@pytest.mark.parametrize(("message", "text"), WRONG.items(), ids=WRONG)
def test_what_cannot_be_read_is_refused(message: str, text: str, tmp_path: pathlib.Path) -> None:
    columns = {"x": "place"} if "no columns" in message else None
    with pytest.raises(ParameterError, match=re.escape(message)):
        read_track(written(tmp_path, text), columns)
