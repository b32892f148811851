"""Tables of tracks as people have them, and what is wrong with others: for `read_track` and for
docs/live.html."""

import re

import numpy as np

SINCE_THE_START = np.arange(20) / 60
TIME = 17 + SINCE_THE_START
PLACE = 0.1 + 0.5 * SINCE_THE_START**2


def table(heading: str, mark: str, *columns: np.ndarray, comma: bool = False) -> str:
    """The text of a table, with a mark between its columns and perhaps decimal commas."""
    lines = [mark.join(f"{value:.9f}" for value in row) for row in np.column_stack(columns)]
    return (
        "\n".join([heading, *(line.replace(".", ",") if comma else line for line in lines)]) + "\n"
    )


QUOTED = re.sub(r"(\d+,\d+)", r'"\1"', table("t;x", ";", TIME, PLACE, comma=True)).replace(";", ",")
TABLES = {
    "Tracker 5": table("multi:\t\t\nmass A\t\t\nt\tx\ty", "\t", TIME, PLACE, 0 * PLACE),
    "Tracker 6, commas": table('"multi:",,\nt,x', ",", TIME, PLACE),
    "decimal commas": table("t (s);x (cm)", ";", TIME, 100 * PLACE, comma=True),
    "decimal commas in quotes": QUOTED,
    "Logger Pro": table("Latest: Time (s)\tLatest: X (mm)", "\t", TIME, 1000 * PLACE),
    "Capstone": table('"Time (s) Run #1","Position (m) Run #1"', ",", TIME, PLACE),
    "phyphox": table('"Time (ms)","Distance (m)"', ",", 1000 * TIME, PLACE),
    "mjbeer": table("time [s],u [m]", ",", TIME, PLACE),
    "spaces": table("t x", " ", TIME, PLACE),
    "a comma in a name": table('"Run, no.",t,x', ",", 0 * TIME, TIME, PLACE),
    "points that were lost": table("t;x", ";", TIME, PLACE).replace(
        "\n17.2", "\n17.199;\n\n17.2", 1
    ),
    # To the left and down, as the picture has it; the way counts as the can went.
    "a tilted board": table("t x y", " ", TIME, -PLACE * np.cos(0.1), 0.3 - PLACE * np.sin(0.1)),
    "notes": table("t;x;note", ";", TIME, PLACE, 0 * TIME).replace("0.000000000\n", "\n"),
}


def numbers(mark: str, *cells: str) -> str:
    """A table of times of even thousandths, and of places in mm, of which the first are given."""
    places = [*cells, *map(str, range(3000, 3020))]
    return f"t (ms){mark}x (mm)\n" + "".join(
        f"{at}{mark}{place}\n" for at, place in enumerate(places)
    )


THOUSANDS = {
    "a point elsewhere": (numbers(",", '"1,000"', "1200.5"), [1.0, 1.2005]),
    "a point in the same": (numbers(";", "1,000.25"), [1.00025]),
    "two commas": (numbers("\t", "1,000", "1,000,500"), [1.0, 1000.5]),
    "a decimal comma elsewhere": (numbers(";", "1,000", "1,25"), [0.001, 0.00125]),
    "a zero before it": (numbers(";", "0,999", "1,000"), [0.000999, 0.001]),
}
"""Tables in which it is clear what a comma is, and their first places [m]."""
UNCLEAR = {
    "line 2, column 2: '1,000' may be 1.000 or 1000": numbers(",", '"1,000"'),
    "line 3, column 2: '2,000' may be 2.000 or 2000": numbers(";", "1000", "2,000"),
    "line 3, column 2: '1.000' is no number, as others here have decimal commas": numbers(
        ";", "0,5", "1.000"
    ),
    "line 2, column 2: '1,000.5' is no number, as others": numbers(";", "1,000.5", "1001,5"),
    "line 2, column 3: '000' has no heading": numbers(",", "1,000"),
}
"""What is said of tables in which it is not."""
