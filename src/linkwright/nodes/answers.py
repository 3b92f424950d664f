"""Waiting for services and for their answers, on the clock of the graph."""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.graph import Client, Clock, ClockType, Node
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup


async def answered(node: Node, future: Any, seconds: float | None) -> bool:
    """Wait for a future, and return whether it was done in time.

    Args:
        node: the node; its timers run in real time even if its time is simulated.
        future: one of the graph's, or of asyncio.
        seconds: how long to wait; None for ever.
    """
    over: asyncio.Future[bool] = asyncio.get_running_loop().create_future()

    def resolve(came: bool) -> None:
        if not over.done():
            over.set_result(came)

    clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
    group = ReentrantCallbackGroup()  # the waiting callback may hold the group of the node
    timer = None
    if seconds is not None:
        timer = node.create_timer(seconds, lambda: resolve(False), callback_group=group, clock=clock)
    future.add_done_callback(lambda _: resolve(True))
    try:
        return await over
    finally:
        if timer is not None:
            node.destroy_timer(timer)


async def is_served(node: Node, client: Client[Any, Any], seconds: float | None, *, wanted: bool = True) -> bool:
    """Wait until a service is available, or until it is gone. Return whether that happened in time.

    Args:
        node: the node that asks.
        client: the client of the service.
        seconds: the timeout; None to wait for ever.
        wanted: whether to wait for the service to appear or to disappear.
    """
    loop = asyncio.get_running_loop()
    come: asyncio.Future[None] = loop.create_future()

    def look() -> None:
        if not client.destroyed and not come.done() and client.service_is_ready() is wanted:
            come.set_result(None)

    def changed() -> None:
        loop.call_soon_threadsafe(look)

    node.graph.watch(changed)
    try:
        return client.service_is_ready() is wanted or await answered(node, come, seconds)
    finally:
        node.graph.unwatch(changed)
        come.cancel()  # callbacks that are already scheduled then do nothing
