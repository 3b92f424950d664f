"""Joins a graph to others over Zenoh, if it is installed: that is found out without the import."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, phrase
from linkwright.wire.background import join_with
from linkwright.wire.switch import is_switched_off, switched_off
from linkwright.wire.zenoh.settings import read_settings
from linkwright.wire.zenoh.transport import ZenohTransport

if TYPE_CHECKING:
    from linkwright.graph.computation_graph import Graph


def is_installed() -> bool:
    """Whether the packages are there."""
    return find_spec("zenoh") is not None and find_spec("xxhash") is not None


def why_not(environment: Mapping[str, str] | None = None) -> Phrase:
    """Why this process does not use Zenoh; empty when it does.

    Args:
        environment: the environment variables; those of the process when left out.
    """
    if is_switched_off(environment):
        return switched_off()
    if not is_installed():
        return phrase(
            "the package 'eclipse-zenoh' is not installed: run pip install 'linkwright[zenoh]' (this is {system}"
            " {machine} with Python {version})",
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return Phrase("")


def join(
    graph: Graph,
    *,
    domain_id: int | None = None,
    environment: Mapping[str, str] | None = None,
    only_looks: bool = False,
) -> ZenohTransport | None:
    """Have a graph seen by other processes, and see theirs. It happens in the background; nothing waits for it.

    Problems are logged, and the graph goes on without the network.

    Args:
        graph: the graph; the transport attaches itself to it.
        domain_id: takes the place of ROS_DOMAIN_ID.
        environment: the environment variables; those of the process when left out.
        only_looks: whether the graph sees other processes and is not seen by them.

    Returns:
        The transport; None where Zenoh is not installed, switched off, or wrongly set.
    """
    logger = graph.get_logger("zenoh")

    def make() -> ZenohTransport:
        return ZenohTransport(read_settings(environment, domain_id=domain_id), logger, only_looks=only_looks)

    return join_with(graph, make, logger, why_not(environment), told=not is_switched_off(environment))
