"""A bridge between two networks, which mirrors the nodes of each network in the other one.

The mirrored nodes have the same topics and services. Two bridges between the same networks do not carry the same
traffic: nodes of a bridge are recognised by their enclave, and traffic that both could carry is carried by the bridge
whose ID sorts first (decision 0066).
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable

from linkwright.bridge.direction import Direction
from linkwright.bridge.filters import NameFilter
from linkwright.bridge.networks import Network
from linkwright.bridge.side import Side
from linkwright.graph.log.logger import LogLevel, LogRecord, LogSink

_TOGETHER = 0.02
"""Seconds for which news are collected before they are looked at."""

_SOON = 0.02
"""Seconds after which waiting work is checked again."""

_SELDOM = 0.25
"""The same when nothing waits."""

_UNSETTLED = 3.0
"""Seconds after news for which the bridge checks as if something waited: listeners are known a moment later."""

_OF_THE_BRIDGE = ("wire", "dds", "zenoh", "bridge")


def new_bridge_id() -> str:
    """Return a new, unique bridge id."""
    return f"b{secrets.token_hex(4)}"


async def run_bridge(
    networks: tuple[Network, Network], names: NameFilter, bridge_id: str, log: LogSink, ready: Callable[[], object]
) -> None:
    """Carry the traffic with permitted names between two networks, in both directions, until cancelled.

    Args:
        networks: the networks.
        names: selects the topics and services to carry.
        bridge_id: the ID of the bridge.
        log: receives log records.
        ready: called once both networks are joined.

    Raises:
        LinkwrightError: a network cannot be joined.
    """
    sink = _without_mirrored_nodes(log)
    first = await networks[0].join(bridge_id, sink)
    try:
        second = await networks[1].join(bridge_id, sink)
        try:
            logger = first.graph.get_logger("bridge")
            ready()
            directions = (Direction(first, second, names, logger), Direction(second, first, names, logger))
            try:
                await _carry(first, second, directions)
            finally:
                for direction in directions:
                    direction.close()
        finally:
            await second.graph.close()
    finally:
        await first.graph.close()


async def _carry(first: Side, second: Side, directions: tuple[Direction, Direction]) -> None:
    loop = asyncio.get_running_loop()
    news = asyncio.Event()

    def changed() -> None:
        loop.call_soon_threadsafe(news.set)

    first.watch(changed)
    second.watch(changed)
    news.set()
    unsettled_until = 0.0
    while True:
        if news.is_set():
            await asyncio.sleep(_TOGETHER)
            news.clear()
            first.update()
            second.update()
            # Withdraw first in both directions: a service that both sides offer must not be carried in either
            # direction, so that no
            # request travels in a circle.
            for direction in directions:
                direction.withdraw()
            for direction in directions:
                direction.add()
            unsettled_until = loop.time() + _UNSETTLED
        settled = [direction.settle() for direction in directions]
        settled += [directions[0].show(directions[1]), directions[1].show(directions[0])]
        pause = _SELDOM if all(settled) and loop.time() > unsettled_until else _SOON
        waiting = asyncio.ensure_future(news.wait())
        try:
            await asyncio.wait((waiting,), timeout=pause)  # `wait_for` may miss Ctrl-C before Python 3.12
        finally:
            waiting.cancel()


def _without_mirrored_nodes(log: LogSink) -> LogSink:
    """Return a log sink that drops the records of mirrored nodes, except errors.

    Mirrored nodes warn about a quality of service that they did not choose.
    """

    def take(record: LogRecord) -> None:
        if record.node in _OF_THE_BRIDGE or record.level >= LogLevel.ERROR:
            log(record)

    return take
