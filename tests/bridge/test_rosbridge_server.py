"""rosbridge_websocket with mistaken and hostile clients, and its parameters."""

from __future__ import annotations

import asyncio
import shutil
import socket
import ssl
import subprocess

import aiohttp
import pytest

from linkwright.bridge.rosbridge import RosbridgeWebsocket
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LATCHED_QOS, Graph
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions
from tests.bridge.rosbridge_client import add_set_bool, rosbridge_setup
from tests.leaving import UPGRADE, request_and_reset
from tests.waiting import eventually

TWIST = "geometry_msgs/msg/Twist"
TRIGGER = "std_srvs/srv/Trigger"


# --- mistaken and hostile clients ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{{{", "the message is not JSON"),
        ("[" * 100_000, "the message is not JSON"),
        ("3", "the message is not a JSON object"),
        ("{}", "without an op"),
        ('{"op": 3}', "Unknown operation: 3"),
        ('{"op": "subscribe", "topic": "/chatter", "id": {}}', "Expected field id"),
        ('{"op": "dance", "id": 1e999}', "Expected field id"),
        ('{"op": "dance"}', "Unknown operation: dance"),
        ('{"op": ["publish"]}', "Unknown operation"),
        ('{"op": "subscribe"}', "Expected a topic field"),
        ('{"op": "subscribe", "topic": 3}', "Expected field topic to be str"),
        ('{"op": "subscribe", "topic": "/nothing"}', "Cannot infer topic type"),
        ('{"op": "subscribe", "topic": "/no such", "type": "std_msgs/String"}', "subscribe"),
        ('{"op": "subscribe", "topic": "/a", "type": "no_msgs/Nothing"}', "no_msgs/msg/Nothing"),
        ('{"op": "subscribe", "topic": "/chatter", "type": "std_msgs/Int32"}', "already established"),
        ('{"op": "subscribe", "topic": "/chatter", "compression": "zip"}', "compression 'zip' is not supported"),
        ('{"op": "subscribe", "topic": "/chatter", "throttle_rate": -1}', "throttle_rate"),
        ('{"op": "subscribe", "topic": "/chatter", "queue_length": "3"}', "queue_length"),
        ('{"op": "advertise", "topic": "/chatter", "type": "std_msgs/Int32"}', "already established"),
        ('{"op": "publish", "topic": "/chatter", "msg": {"date": "a"}}', "does not have a field date"),
        ('{"op": "publish", "topic": "/chatter", "msg": 3}', "requires a JSON object"),
        ('{"op": "publish", "topic": "/nothing", "msg": {}}', "Cannot infer topic type"),
        ('{"op": "call_service", "service": "/a", "timeout": "soon"}', "Expected field timeout"),
        ('{"op": "advertise_service", "service": "/a", "type": "no_srvs/Nothing"}', "no_srvs/srv/Nothing"),
        ('{"op": "service_response", "service": "/a", "result": true}', "has not been advertised"),
        ('{"op": "send_action_goal", "action": "/a", "action_type": "nonsense"}', "nonsense"),
        ('{"op": "action_result", "action": "/a", "id": "b", "result": true}', "has not been advertised"),
        ('{"op": "cancel_action_goal", "action": "/a"}', "no goal"),
        ('{"op": "set_level", "level": "loud"}', "one of info, warning, error, none"),
        ('{"op": "fragment", "id": "a"}', "Expected a total field"),
        ('{"op": "publish", "topic": "/chatter", "id": "p", "msg": {"data": "' + "x" * 3000 + '"}}', "longer than"),
    ],
)
async def test_mistake_is_answered_with_a_status(text, reason):
    async with rosbridge_setup(max_message_size=2000 if "xxx" in text else 10**6) as setup, setup.client() as client:
        setup.node.create_publisher(String, "/chatter", 10)
        await client.socket.send_str(text)
        status = await client.until("status")
        assert status["level"] == "error"
        assert reason in status["msg"]
        add_set_bool(setup)
        assert (await client.call("/switch"))["result"] is True  # the node goes on


async def test_huge_message_ends_only_the_connection():
    async with rosbridge_setup(max_message_size=1000) as setup:
        async with setup.client() as client:
            await client.socket.send_str("x" * 5000)
            message = await client.socket.receive(timeout=60)
            assert message.type is aiohttp.WSMsgType.CLOSE
        async with setup.client() as client:
            add_set_bool(setup)
            assert (await client.call("/switch"))["result"] is True


async def test_binary_frames_may_contain_json_and_nothing_else():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.socket.send_bytes(b'{"op": "dance"}')
        assert "dance" in (await client.until("status"))["msg"]
        await client.socket.send_bytes(b"\xff\x00")
        assert "not JSON" in (await client.until("status"))["msg"]


async def test_client_chooses_the_level_of_statuses():
    async with rosbridge_setup() as setup, setup.client() as client:
        setup.node.create_publisher(String, "/chatter", 10)
        await client.send("set_level", level="info")
        await client.send("subscribe", topic="/chatter", id="s")
        assert await client.next() == {"op": "status", "level": "info", "msg": "Subscribed to /chatter", "id": "s"}
        await client.send("set_level", level="warning")
        await client.send("unsubscribe", topic="/chatter")
        await client.send("unsubscribe", topic="/chatter")
        assert (await client.next())["level"] == "warning"
        await client.send("set_level", level="none")
        await client.send("dance")
        await client.send("set_level", level="error")
        await client.send("dance", id="d")
        assert (await client.next())["id"] == "d"


async def test_pending_calls_are_limited():
    async with rosbridge_setup() as setup, setup.client() as client:
        setup.node.create_service(TRIGGER, "/silent", lambda request, reply: None, replying=True)
        for _ in range(65):
            await client.send("call_service", service="/silent")
        assert "too many calls" in (await client.until("status"))["msg"]


async def test_errors_of_a_client_are_logged_until_there_are_many():
    async with rosbridge_setup() as setup, setup.client() as client:
        for _ in range(30):
            await client.send("dance")
            await client.until("status")
        assert sum("dance" in text for text in setup.texts) == 20


# --- parameters of the node ------------------------------------------------------------------------------------------


async def test_patterns_limit_topics_and_services():
    async with rosbridge_setup(topics_glob="[/chatter, /camera/*]", services_glob=["/switch"]) as setup:
        add_set_bool(setup)
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        async with setup.client() as client:
            for op in ("subscribe", "advertise", "publish"):
                await client.send(op, topic="/cmd_vel", type=TWIST)
                assert "not allowed by topics_glob" in (await client.until("status"))["msg"]
            for op in ("call_service", "advertise_service"):
                await client.send(op, service="/reset", type="std_srvs/Trigger")
                assert "not allowed by services_glob" in (await client.until("status"))["msg"]
            await client.send("subscribe", topic="/chatter")
            await eventually(lambda: publisher.get_subscription_count() == 1)
            assert (await client.call("/switch"))["result"] is True


async def test_clients_are_counted():
    async with rosbridge_setup() as setup:
        counts, clients = [], []
        setup.node.create_subscription("std_msgs/msg/Int32", "/client_count", counts.append, LATCHED_QOS)
        setup.node.create_subscription(
            "rosbridge_msgs/msg/ConnectedClients", "/connected_clients", clients.append, LATCHED_QOS
        )
        await eventually(lambda: counts and counts[-1].data == 0)
        async with setup.client():
            await eventually(lambda: counts[-1].data == 1)
            await eventually(lambda: [client.ip_address for client in clients[-1].clients] == ["127.0.0.1"])
        await eventually(lambda: counts[-1].data == 0)


@pytest.mark.parametrize("steps", range(8))
async def test_server_socket_is_closed_when_startup_is_interrupted(steps):
    graph = Graph(on_log=lambda _: None)
    bridge = RosbridgeWebsocket(graph, NodeOptions(parameters={"port": 0}))
    for _ in range(steps):
        await asyncio.sleep(0)
    bridge.close()
    assert bridge._listener.fileno() == -1  # closed at once, because the loop may end here
    await asyncio.wait([bridge._server_task])
    await graph.close()


async def test_server_waits_for_a_port_in_use():
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        graph = Graph(on_log=(log := []).append)
        bridge = RosbridgeWebsocket(graph, NodeOptions(parameters={"port": port, "retry_startup_delay": 0.1}))
        await eventually(lambda: any("Retrying in 0.1 s" in record.text for record in log))
        assert bridge.address == ""
    await eventually(lambda: bridge.address == f"ws://127.0.0.1:{port}")
    assert bridge.node.get_parameter("actual_port").value == port
    bridge.close()
    await graph.close()


async def test_address_that_does_not_exist_is_an_error():
    graph = Graph(on_log=lambda _: None)
    with pytest.raises(LinkwrightError, match="rosbridge_websocket cannot listen on port 9090"):
        RosbridgeWebsocket(graph, NodeOptions(parameters={"address": "192.0.2.1"}))
    await graph.close()


async def test_client_that_does_not_answer_pings_is_disconnected():
    parameters = {"websocket_ping_interval": 0.05, "websocket_ping_timeout": 0.3}
    async with rosbridge_setup(**parameters) as setup, setup.client(autoping=False) as client:
        kinds = [(await client.socket.receive(timeout=60)).type]
        while kinds[-1] is aiohttp.WSMsgType.PING:
            kinds.append((await client.socket.receive(timeout=60)).type)
        assert kinds[0] is aiohttp.WSMsgType.PING
        assert kinds[-1] is aiohttp.WSMsgType.CLOSE


async def test_client_that_answers_pings_late_stays_connected():
    parameters = {"websocket_ping_interval": 0.05, "websocket_ping_timeout": 60.0}
    async with rosbridge_setup(**parameters) as setup, setup.client(autoping=False) as client:
        for _ in range(20):
            message = await client.socket.receive(timeout=60)
            assert message.type is aiohttp.WSMsgType.PING
        await client.socket.pong(message.data)
        add_set_bool(setup)
        await client.send("call_service", service="/switch", args={"data": True})
        while (message := await client.socket.receive(timeout=60)).type is aiohttp.WSMsgType.PING:
            pass
        assert "service_response" in message.data


@pytest.mark.parametrize("interval_s", [0.0, 30.0])
async def test_server_answers_pings(interval_s):
    async with rosbridge_setup(websocket_ping_interval=interval_s) as setup, setup.client(autoping=False) as client:
        await client.socket.ping(b"x")
        message = await client.socket.receive(timeout=60)
        assert (message.type, bytes(message.data)) == (aiohttp.WSMsgType.PONG, b"x")


@pytest.mark.parametrize(
    ("parameters", "arguments", "reason"),
    [
        ({"certfile": "/none.pem", "keyfile": "/none.key"}, [], "cannot use the certificate"),
        ({}, ["--port"], "unexpected argument '--port'"),
        ({}, ["--volume", "3"], "unexpected argument '--volume'"),
        ({}, ["--port", "x"], "'x' is not a valid value"),
    ],
)
async def test_what_is_not_supported_is_an_error(parameters, arguments, reason):
    graph = Graph(on_log=lambda _: None)
    with pytest.raises(LinkwrightError, match=reason):
        RosbridgeWebsocket(graph, NodeOptions(parameters=parameters, arguments=arguments))
    await graph.close()


async def test_arguments_set_parameters():
    graph = Graph(on_log=lambda _: None)
    arguments = ["--port", "0", "--address", "127.0.0.1", "--unregister_timeout", "3"]
    bridge = RosbridgeWebsocket(graph, NodeOptions(arguments=arguments))
    assert bridge.node.get_parameter("unregister_timeout").value == 3.0
    await eventually(lambda: bridge.address)
    bridge.close()
    await graph.close()


async def test_parameters_that_the_node_does_not_have_are_named():
    async with rosbridge_setup(authenticate=False) as setup:
        assert any("authenticate" in text for text in setup.texts)


async def test_log_says_how_other_machines_can_connect():
    async with rosbridge_setup(address="") as setup:
        await eventually(lambda: any("'address' is '0.0.0.0'" in text for text in setup.texts))
    async with rosbridge_setup(address="0.0.0.0") as setup:
        assert not any("0.0.0.0'" in text for text in setup.texts)


async def test_path_of_the_address_can_be_chosen():
    async with rosbridge_setup(url_path="/robot") as setup:
        assert setup.bridge.address.endswith("/robot")
        async with setup.client() as client:
            await client.send("dance")
            assert await client.until("status")


@pytest.mark.parametrize(
    ("origin", "is_accepted"),
    [("http://localhost:8000", True), ("https://example.com", False), ("https://robots.example.com", True)],
)
async def test_pages_of_other_sites_are_refused(origin, is_accepted):
    async with rosbridge_setup(allowed_origins=["https://robots.example.com"]) as setup:
        if is_accepted:
            async with setup.client(origin=origin):
                pass
        else:
            with pytest.raises(aiohttp.WSServerHandshakeError):
                async with setup.client(origin=origin):
                    pass
            assert any(f"allowed_origins:=['{origin}']" in text for text in setup.texts)


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl")
async def test_connections_can_be_encrypted(tmp_path):
    certificate, key = tmp_path / "a.pem", tmp_path / "a.key"
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost"]
    process = await asyncio.create_subprocess_exec(
        *command, "-keyout", key, "-out", certificate, stderr=subprocess.DEVNULL
    )
    assert await process.wait() == 0
    async with rosbridge_setup(certfile=str(certificate), keyfile=str(key)) as setup:
        assert setup.bridge.address.startswith("wss://")
        context = ssl.create_default_context(cafile=str(certificate))
        context.check_hostname = False
        async with setup.client(ssl=context) as client:
            await client.send("dance")
            assert await client.until("status")


async def test_clients_that_leave_early_cause_no_error():
    async with rosbridge_setup() as setup:
        await request_and_reset(int(setup.bridge.address.rpartition(":")[2]), "/", UPGRADE)
        async with setup.client() as client:
            await client.send("dance")
            await client.until("status")
        assert not any("Traceback" in text for text in setup.texts)
