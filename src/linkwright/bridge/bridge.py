"""A bridge that mirrors the nodes of each of two networks in the other one.

The mirrored nodes have the same topics and services. Two bridges between the same networks do not carry the same
traffic: nodes of a bridge are recognized by their enclave, and traffic that both could carry is carried by the bridge
whose ID sorts first (decision 0066).
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable

from linkwright.bridge.bridged_network import BridgedNetwork
from linkwright.bridge.direction import Direction
from linkwright.bridge.filters import NameFilter
from linkwright.bridge.networks import Network
from linkwright.graph.log.logger import LogLevel, LogRecord, LogSink

_COLLECTION_S = 0.02
"""Seconds for which changes are collected before they are processed."""

_BUSY_INTERVAL_S = 0.02
"""Seconds between two checks while work is pending."""

_IDLE_INTERVAL_S = 0.25
"""The same, if no work is pending."""

_UNSETTLED_S = 3.0
"""Seconds after a change for which the bridge uses the short interval, because matching takes time."""

_BRIDGE_LOGGERS = ("wire", "dds", "zenoh", "bridge")


def create_bridge_id() -> str:
    """Return a new, unique bridge id."""
    return f"b{secrets.token_hex(4)}"


async def run_bridge(
    networks: tuple[Network, Network], names: NameFilter, bridge_id: str, log: LogSink, on_ready: Callable[[], object]
) -> None:
    """Forward traffic with permitted names between two networks, both ways, until cancelled.

    Args:
        networks: the networks.
        names: selects the topics and services to carry.
        bridge_id: the ID of the bridge.
        log: receives log records.
        on_ready: called once both networks are joined.

    Raises:
        LinkwrightError: a network cannot be joined.
    """
    sink = _drop_mirrored_nodes(log)
    first = await networks[0].join(bridge_id, sink)
    try:
        second = await networks[1].join(bridge_id, sink)
        try:
            logger = first.graph.get_logger("bridge")
            on_ready()
            directions = (Direction(first, second, names, logger), Direction(second, first, names, logger))
            try:
                await _forward_traffic(first, second, directions)
            finally:
                for direction in directions:
                    direction.close()
        finally:
            await second.graph.close()
    finally:
        await first.graph.close()


async def _forward_traffic(
    first: BridgedNetwork, second: BridgedNetwork, directions: tuple[Direction, Direction]
) -> None:
    loop = asyncio.get_running_loop()
    change_event = asyncio.Event()

    def on_change() -> None:
        loop.call_soon_threadsafe(change_event.set)

    first.watch(on_change)
    second.watch(on_change)
    change_event.set()
    unsettled_until = 0.0
    while True:
        if change_event.is_set():
            await asyncio.sleep(_COLLECTION_S)
            change_event.clear()
            first.update()
            second.update()
            # Withdraw first in both directions: a service that both sides offer must not be carried in either
            # direction, so that no request travels in a circle.
            for direction in directions:
                direction.remove_mirrors()
            for direction in directions:
                direction.add_mirrors()
            unsettled_until = loop.time() + _UNSETTLED_S
        settled = [direction.process_pending() for direction in directions]
        settled += [directions[0].announce(directions[1]), directions[1].announce(directions[0])]
        pause_s = _IDLE_INTERVAL_S if all(settled) and loop.time() > unsettled_until else _BUSY_INTERVAL_S
        wait_task = asyncio.ensure_future(change_event.wait())
        try:
            await asyncio.wait((wait_task,), timeout=pause_s)  # `wait_for` may miss Ctrl-C before Python 3.12
        finally:
            wait_task.cancel()


def _drop_mirrored_nodes(log: LogSink) -> LogSink:
    """Return a log sink that drops the records of mirrored nodes, except errors.

    Mirrored nodes warn about a quality of service that they did not choose.
    """

    def log_unless_mirrored(record: LogRecord) -> None:
        if record.node in _BRIDGE_LOGGERS or record.level >= LogLevel.ERROR:
            log(record)

    return log_unless_mirrored
