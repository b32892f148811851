"""Says so where the loops are compiled, which happens once for an installation and takes seconds without a sign."""

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

from numba.core import event

_TEXT = "mjbeer: compiling this integrator for this machine, once: up to 4 s"


class _Teller(event.Listener):
    """Prints a line when numba begins to compile for the first time; code that is read from its cache is none."""

    said = False

    def on_start(self, _: Any) -> None:
        from mjbeer.output import terminal

        if not _Teller.said and terminal.is_seen():
            _Teller.said = True
            terminal.say(_TEXT)

    def on_end(self, _: Any) -> None:
        """Nothing is said at the end."""


@contextmanager
def told(function: Any) -> Generator[None]:
    """Say in the block, once a process, that a `function` of numba is compiled, if it is and somebody may see it."""
    if function.overloads:  # it is compiled already; `signatures` would make a list of hashed types
        yield
        return
    with event.install_listener("numba:compile", _Teller()):
        yield
