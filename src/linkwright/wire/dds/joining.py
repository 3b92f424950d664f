"""Join a graph to a DDS domain if DDS is installed.

Whether DDS is installed is checked without importing it, because the import takes 0.15 s.
"""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, install_hint, phrase
from linkwright.wire.background import JoinOptions, join_with
from linkwright.wire.dds.settings import read_settings
from linkwright.wire.dds.transport import DdsTransport
from linkwright.wire.switch import is_switched_off, switched_off_reason

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from linkwright.graph.node import Graph


def unavailable_reason(environment: Mapping[str, str] | None = None) -> Phrase:
    """Return the reason why this process does not use DDS, or an empty phrase if it uses DDS.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    if is_switched_off(environment):
        return switched_off_reason()
    if find_spec("cyclonedds") is None:
        return phrase(
            "the package 'cyclonedds' is not installed: {hint} (it has wheels for Linux x86_64, Windows "
            "and macOS arm64, up to Python 3.13; this is {system} {machine} with Python {version})",
            hint=install_hint("dds"),
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return Phrase("")


def is_available(environment: Mapping[str, str] | None = None) -> bool:
    """Return whether this process can use DDS."""
    return not unavailable_reason(environment)


def join(graph: Graph, **options: Unpack[JoinOptions]) -> DdsTransport | None:
    """Connect a graph to other processes over DDS.

    Returns the transport; None if DDS is not available, or its settings are wrong.
    """
    return join_with(graph, "dds", read_settings, DdsTransport, unavailable_reason, options)
