"""Functions that wait for services and their responses, with timeouts in real time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from linkwright.graph import Client, Clock, ClockType, Node
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup


async def wait_for_future(node: Node, future: Any, seconds: float | None) -> bool:
    """Wait for a future, and return whether it was done before the timeout.

    Args:
        node: the node that waits.
        future: a future of the graph, or of asyncio.
        seconds: the timeout in real time, even if the node uses simulated time; None for no limit.
    """
    outcome: asyncio.Future[bool] = asyncio.get_running_loop().create_future()

    def resolve(is_done: bool) -> None:
        if not outcome.done():
            outcome.set_result(is_done)

    clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
    group = ReentrantCallbackGroup()  # The node's default group may be occupied by the callback that waits.
    timer = None
    if seconds is not None:
        timer = node.create_timer(seconds, lambda: resolve(False), callback_group=group, clock=clock)
    future.add_done_callback(lambda _: resolve(True))
    try:
        return await outcome
    finally:
        if timer is not None:
            node.destroy_timer(timer)


async def wait_for_service(
    node: Node, client: Client[Any, Any], seconds: float | None, *, should_exist: bool = True
) -> bool:
    """Wait until a service appears or disappears.

    Return False if the timeout expires first.

    Args:
        node: the node that waits.
        client: the client of the service.
        seconds: the timeout in real time; None for no limit.
        should_exist: True to wait until the service appears, False to wait until it disappears.
    """
    client.check_alive()
    return await wait_for_graph(
        node, lambda: not client.destroyed and client.service_is_ready() is should_exist, seconds
    )


async def wait_for_graph(node: Node, condition: Callable[[], bool], seconds: float | None) -> bool:
    """Wait until a condition holds, which changes of the graph can fulfill.

    Return False if the timeout expires first.

    Args:
        node: the node that waits.
        condition: returns whether the wait ends.
        seconds: the timeout in real time; None for no limit.
    """
    loop = asyncio.get_running_loop()
    state_reached: asyncio.Future[None] = loop.create_future()

    def check_state() -> None:
        if not state_reached.done() and condition():
            state_reached.set_result(None)

    def on_graph_change() -> None:
        loop.call_soon_threadsafe(check_state)

    node.graph.watch(on_graph_change)
    try:
        return condition() or await wait_for_future(node, state_reached, seconds)
    finally:
        node.graph.unwatch(on_graph_change)
        state_reached.cancel()  # callbacks that are already scheduled then have no effect
