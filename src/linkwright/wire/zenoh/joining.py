"""Join a graph to others over Zenoh, if Zenoh is installed.

Whether Zenoh is installed is checked without importing it.
"""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, install_hint, phrase
from linkwright.wire.background import JoinOptions, join_with
from linkwright.wire.switch import is_switched_off, switched_off_reason
from linkwright.wire.zenoh.settings import read_settings
from linkwright.wire.zenoh.transport import ZenohTransport

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from linkwright.graph.node import Graph


def is_installed() -> bool:
    """Return whether the packages that Zenoh needs are installed."""
    return find_spec("zenoh") is not None and find_spec("xxhash") is not None


def unavailable_reason(environment: Mapping[str, str] | None = None) -> Phrase:
    """Return the reason why this process does not use Zenoh, or an empty phrase if it does.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    if is_switched_off(environment):
        return switched_off_reason()
    if not is_installed():
        return phrase(
            "the package 'eclipse-zenoh' is not installed: {hint} (this is {system} {machine} with Python {version})",
            hint=install_hint("zenoh"),
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return Phrase("")


def join(graph: Graph, **options: Unpack[JoinOptions]) -> ZenohTransport | None:
    """Connect a graph to other processes over Zenoh.

    Returns the transport; None if Zenoh is not available, or its settings are wrong.
    """
    return join_with(graph, "zenoh", read_settings, ZenohTransport, unavailable_reason, options)
