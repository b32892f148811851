"""Which of the other tools can be imported here, and why the others cannot."""

import importlib

from mjbeer.studies.benchmark.peers import whole_call, with_heyoka, with_scipy
from mjbeer.studies.benchmark.peers.peer import Peer

PEERS = (with_scipy.DOP853, with_scipy.LSODA, with_scipy.ODEINT, with_heyoka.PEER, whole_call.PEER)
"""All peers, whether they can be imported here or not."""
_OPTIONAL = {with_heyoka.PEER.name: "heyoka"}
"""The packages of the peers that are optional; in a checkout `pip install ".[peers]"` installs them."""


def installed() -> list[Peer]:
    """Return the peers that can be imported here."""
    missing = absent()
    return [peer for peer in PEERS if peer.name not in missing]


def absent() -> dict[str, str]:
    """Return the names of the peers that cannot be imported here, each with the reason, on one line."""
    reasons = {}
    for name, package in _OPTIONAL.items():
        try:
            importlib.import_module(package)
        except Exception as error:  # a package that lacks a library of the system may raise anything
            reasons[name] = " ".join(str(error).split()) or type(error).__name__
    return reasons
