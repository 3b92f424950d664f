"""A running rosbridge_websocket, and clients that speak its protocol."""

from __future__ import annotations

import json
from contextlib import asynccontextmanager

import aiohttp

from linkwright.bridge.rosapi import RosapiNode
from linkwright.bridge.rosbridge import RosbridgeWebsocket
from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions
from tests.waiting import TIMEOUT_S, eventually


class RosbridgeClient:
    """A client."""

    def __init__(self, socket_) -> None:
        self.socket = socket_

    async def send(self, op: str, **fields) -> None:
        await self.socket.send_json({"op": op, **fields})

    async def next(self):
        message = await self.socket.receive(timeout=TIMEOUT_S)
        if message.type is aiohttp.WSMsgType.TEXT:
            return json.loads(message.data)
        assert message.type is aiohttp.WSMsgType.BINARY, message
        return message.data

    async def until(self, op: str) -> dict:
        while True:
            message = await self.next()
            if isinstance(message, dict) and message["op"] == op:
                return message

    async def call(self, service: str, args=None, **fields) -> dict:
        await self.send("call_service", service=service, args=args or {}, **fields)
        return await self.until("service_response")


class RosbridgeSetup:
    """The node with a graph, and a node of a robot."""

    def __init__(self, **parameters) -> None:
        self.log = []
        self.graph = Graph(on_log=self.log.append)
        self.node = self.graph.create_node("robot")
        self.bridge = RosbridgeWebsocket(self.graph, NodeOptions(parameters={"port": 0, **parameters}))

    @property
    def texts(self) -> list[str]:
        return [record.text for record in self.log]

    @asynccontextmanager
    async def client(self, **options):
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(self.bridge.address, **options) as connection,
        ):
            yield RosbridgeClient(connection)


@asynccontextmanager
async def rosbridge_setup(*, rosapi: bool = False, **parameters):
    setup = RosbridgeSetup(**parameters)
    api = RosapiNode(setup.graph, NodeOptions()) if rosapi else None
    await eventually(lambda: any("server started" in text for text in setup.texts))
    try:
        yield setup
    finally:
        setup.bridge.close()
        if api is not None:
            api.close()
        await setup.bridge._closing
        await setup.graph.close()


def add_set_bool(setup: RosbridgeSetup):
    """Offer a service that the clients call."""

    def answer(request, response):
        response.success, response.message = request.data, "done"
        return response

    return setup.node.create_service("std_srvs/srv/SetBool", "/switch", answer)
