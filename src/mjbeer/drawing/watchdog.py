"""A bound on how long another process may keep this one waiting."""

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Self


class Watchdog:
    """A context manager, to be entered any number of times, that calls `stop` if a block takes too long.

    It counts seconds in which this process ran: one that was suspended has lost no patience.
    """

    def __init__(self, stop: Callable[[], object], patience: int) -> None:
        self._stop, self._patience = stop, patience
        self.lost = False
        """Whether it has called `stop`."""

    def __enter__(self) -> Self:
        self._over = threading.Event()
        threading.Thread(target=self._watch, args=(self._over,), daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()

    def _watch(self, over: threading.Event) -> None:
        if not any(over.wait(1) for _ in range(self._patience)):
            self.lost = True
            self._stop()
