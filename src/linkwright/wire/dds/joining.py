"""Joins a graph to a DDS domain, if DDS is installed: that is found out without the import, which takes 0.15 s."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, phrase
from linkwright.wire.background import join_with
from linkwright.wire.dds.settings import read_settings
from linkwright.wire.dds.transport import DdsTransport
from linkwright.wire.switch import is_switched_off, switched_off

if TYPE_CHECKING:
    from linkwright.graph.computation_graph import Graph


def why_not(environment: Mapping[str, str] | None = None) -> Phrase:
    """Why this process does not use DDS; empty when it does.

    Args:
        environment: the environment variables; those of the process when left out.
    """
    if is_switched_off(environment):
        return switched_off()
    if find_spec("cyclonedds") is None:
        return phrase(
            "the package 'cyclonedds' is not installed: run pip install 'linkwright[dds]' (there are wheels of it for"
            " Linux x86_64, Windows and macOS arm64, up to Python 3.13; this is {system} {machine} with Python"
            " {version})",
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return Phrase("")


def available(environment: Mapping[str, str] | None = None) -> bool:
    """Whether DDS can be joined."""
    return not why_not(environment)


def join(
    graph: Graph,
    *,
    domain_id: int | None = None,
    environment: Mapping[str, str] | None = None,
    only_looks: bool = False,
) -> DdsTransport | None:
    """Have a graph seen by other processes, and see theirs. It happens in the background; nothing waits for it.

    Problems are logged, and the graph goes on without the network.

    Args:
        graph: the graph; the transport attaches itself to it.
        domain_id: takes the place of ROS_DOMAIN_ID.
        environment: the environment variables; those of the process when left out.
        only_looks: whether the graph sees other processes and is not seen by them.

    Returns:
        The transport; None where DDS is not installed, switched off, or wrongly set.
    """
    logger = graph.get_logger("dds")

    def make() -> DdsTransport:
        settings = read_settings(environment, domain_id=domain_id)
        for warning in settings.warnings:
            logger.warning(warning)
        return DdsTransport(settings, logger, only_looks=only_looks)

    return join_with(graph, make, logger, why_not(environment), told=not is_switched_off(environment))
