"""Waits of nodes for services of other nodes."""

from __future__ import annotations

import asyncio

from linkwright.graph import Graph
from linkwright.messages import get_service
from linkwright.nodes.service_waits import wait_for_service

TRIGGER = "std_srvs/srv/Trigger"


async def test_canceled_wait_for_service_survives_graph_changes() -> None:
    faults: list[str] = []
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(lambda _, context: faults.append(str(context.get("exception"))))
    graph = Graph()
    node = graph.create_node("waiting")
    client = node.create_client(get_service(TRIGGER), "answer")
    waiting = loop.create_task(wait_for_service(node, client, None))
    await asyncio.sleep(0)
    graph.create_node("another").create_service(get_service(TRIGGER), "other", lambda _, response: response)
    waiting.cancel()
    node.destroy_node()
    await asyncio.gather(waiting, return_exceptions=True)
    await asyncio.sleep(0)
    loop.set_exception_handler(None)
    assert not faults
    await graph.close()
