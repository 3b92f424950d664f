"""Joins a graph to a DDS domain."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError
from linkwright.wire.dds.availability import SWITCH, why_not
from linkwright.wire.dds.settings import read_settings
from linkwright.wire.dds.transport import DdsTransport, log_join_failure

if TYPE_CHECKING:
    from linkwright.graph.computation_graph import Graph


def join(
    graph: Graph, *, domain_id: int | None = None, environment: Mapping[str, str] | None = None
) -> DdsTransport | None:
    """Have a graph seen by other processes, and see theirs. It happens in the background; nothing waits for it.

    Problems are logged, and the graph goes on without the network.

    Args:
        graph: the graph; the transport attaches itself to it.
        domain_id: takes the place of ROS_DOMAIN_ID.
        environment: the environment variables; those of the process when left out.

    Returns:
        The transport; None where DDS is not installed, switched off, or wrongly set.
    """
    logger = graph.get_logger("dds")
    reason = why_not(environment)
    if reason:
        if SWITCH not in reason:
            logger.warning(f"This process speaks to no other one: {reason}. Everything inside of it works.")
        return None
    try:
        settings = read_settings(environment, domain_id=domain_id)
    except LinkwrightError as error:
        log_join_failure(logger, error)
        return None
    for warning in settings.warnings:
        logger.warning(warning)
    transport = DdsTransport(settings, logger)
    graph.attach(transport)
    return transport
