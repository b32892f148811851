"""Which of the other tools are installed here."""

import importlib

from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.benchmark.peers.with_scipy import DOP853, LSODA, ODEINT


def installed() -> list[Peer]:
    """The peers of this environment; heyoka and EXUDYN are optional, `pip install mjbeer[peers]` has both.

    Raises:
      ImportError: if one of them is installed and broken.
    """
    peers = [DOP853, LSODA, ODEINT]
    for package in ("heyoka", "exudyn"):
        try:
            importlib.import_module(package)
        except ModuleNotFoundError as error:
            if error.name != package:
                raise
        else:
            peers.append(importlib.import_module(f"mjbeer.studies.benchmark.peers.with_{package}").PEER)
    return peers
