"""foxglove_bridge with clients that speak its protocol byte by byte."""

from __future__ import annotations

import asyncio
import json
import socket
import struct
from contextlib import asynccontextmanager

import aiohttp
import pytest

from linkwright.bridge.foxglove import FoxgloveBridge
from linkwright.bridge.websockets.origins import is_allowed_origin
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DESCRIPTION_QOS, Graph
from linkwright.messages import String, deserialize, get_message, get_service, serialize
from linkwright.nodes.options import EXECUTABLES, NodeOptions
from tests.leaving import UPGRADE, request_and_reset
from tests.waiting import TIMEOUT_S, eventually

V1 = ("foxglove.websocket.v1",)


class Foxglove:
    """A client."""

    def __init__(self, socket_) -> None:
        self.socket = socket_

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

    async def frame(self, code: int) -> bytes:
        while True:
            message = await self.next()
            if isinstance(message, bytes) and message[0] == code:
                return message

    async def channel(self, topic: str) -> dict:
        while True:
            for channel in (await self.until("advertise"))["channels"]:
                if channel["topic"] == topic:
                    return channel

    async def send(self, op: str, **fields) -> None:
        await self.socket.send_json({"op": op, **fields})


class Setup:
    def __init__(self, **parameters) -> None:
        self.log = []
        self.graph = Graph(on_log=self.log.append)
        self.node = self.graph.create_node("robot")
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        self.bridge = FoxgloveBridge(self.graph, NodeOptions(parameters={"port": self.port, **parameters}))

    async def wait_until_offered(self, topic: str) -> None:
        """Wait until the bridge has seen a topic."""
        channels = self.bridge._resources.channels
        await eventually(lambda: topic in [channel.advertisement()["topic"] for channel in channels.all()])

    @asynccontextmanager
    async def client(self, protocols=V1, **options):
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f"ws://127.0.0.1:{self.port}/", protocols=protocols, **options) as connection,
        ):
            yield Foxglove(connection)


@asynccontextmanager
async def bridge_setup(**parameters):
    setup = Setup(**parameters)
    await eventually(lambda: any("connect to" in record.text for record in setup.log))
    try:
        yield setup
    finally:
        setup.bridge.close()
        await setup.bridge._cleanup_task
        await setup.graph.close()


@pytest.mark.parametrize("steps", range(8))
async def test_server_socket_is_closed_when_startup_is_interrupted(steps):
    setup = Setup()
    for _ in range(steps):
        await asyncio.sleep(0)
    setup.bridge.close()
    assert setup.bridge._listener.fileno() == -1  # closed at once, because the loop may end here
    await asyncio.wait([setup.bridge._server_task])
    await setup.graph.close()


def test_executable_is_registered_for_launch_files():
    assert ("foxglove_bridge", "foxglove_bridge") in EXECUTABLES


async def test_new_client_receives_server_info_and_channels():
    async with bridge_setup() as setup:
        setup.node.create_publisher(String, "/chatter", 10)
        await setup.wait_until_offered("/chatter")
        for protocol in ("foxglove.websocket.v1", "foxglove.sdk.v1"):
            async with setup.client((protocol,)) as client:
                assert client.socket.protocol == protocol
                server_info = await client.next()
                assert server_info["op"] == "serverInfo"
                assert server_info["supportedEncodings"] == ["cdr"]
                assert {"clientPublish", "parameters", "services", "connectionGraph", "assets"} <= set(
                    server_info["capabilities"]
                )
                chatter = await client.channel("/chatter")
                assert chatter["encoding"] == "cdr"
                assert (chatter["schemaName"], chatter["schemaEncoding"]) == ("std_msgs/msg/String", "ros2msg")
                assert "string data" in chatter["schema"]


async def test_messages_are_sent_as_cdr_until_unsubscribed():
    async with bridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        channel = await client.channel("/chatter")
        await client.send("subscribe", subscriptions=[{"id": 42, "channelId": channel["id"]}])
        await eventually(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(String(data="hello"))
        frame = await client.frame(1)
        code, subscription, stamp = struct.unpack_from("<BIQ", frame)
        assert (code, subscription) == (1, 42)
        assert stamp > 1_600_000_000_000_000_000
        assert deserialize(frame[13:], String).data == "hello"
        await client.send("unsubscribe", subscriptionIds=[42])
        await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_late_client_receives_latched_message():
    async with bridge_setup() as setup:
        setup.node.create_publisher(String, "/robot_description", DESCRIPTION_QOS).publish(String(data="<robot/>"))
        async with setup.client() as client:
            channel = await client.channel("/robot_description")
            await client.send("subscribe", subscriptions=[{"id": 1, "channelId": channel["id"]}])
            assert deserialize((await client.frame(1))[13:], String).data == "<robot/>"


async def test_channels_are_advertised_and_unadvertised():
    async with bridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/brief", 10)
        channel = await client.channel("/brief")
        setup.node.destroy_publisher(publisher)
        assert channel["id"] in (await client.until("unadvertise"))["channelIds"]
        await client.send("subscribe", subscriptions=[{"id": 1, "channelId": channel["id"]}])
        assert (await client.until("status"))["level"] == 2


async def test_client_publishes_to_ros_topic():
    messages = []
    async with bridge_setup() as setup, setup.client() as client:
        twist = get_message("geometry_msgs/msg/Twist")
        setup.node.create_subscription(twist, "/cmd_vel", messages.append, 10)
        channel = {"id": 9, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/Twist"}
        await client.send("advertise", channels=[channel])
        message = twist()
        message.linear.x = 0.5
        await client.socket.send_bytes(struct.pack("<BI", 1, 9) + serialize(message))
        await eventually(lambda: messages)
        assert messages[0].linear.x == 0.5
        await client.send("unadvertise", channelIds=[9])
        await client.socket.send_bytes(struct.pack("<BI", 1, 9) + serialize(message))
        assert "was not advertised" in (await client.until("status"))["message"]


async def test_client_calls_service():
    set_bool = get_service("std_srvs/srv/SetBool")

    def on_request(request, response):
        response.success, response.message = True, f"set to {request.data}"
        return response

    async with bridge_setup() as setup, setup.client() as client:
        setup.node.create_service(set_bool, "/light", on_request)
        light = None
        while light is None:
            services = (await client.until("advertiseServices"))["services"]
            light = next((service for service in services if service["name"] == "/light"), None)
        assert light["request"]["schema"] == light["requestSchema"] == "bool data\n"
        head = struct.pack("<BIII", 2, light["id"], 77, 3) + b"cdr"
        await client.socket.send_bytes(head + serialize(set_bool.Request(data=True)))
        frame = await client.frame(3)
        _, service, call, length = struct.unpack_from("<BIII", frame)
        assert (service, call, frame[13 : 13 + length]) == (light["id"], 77, b"cdr")
        assert deserialize(frame[13 + length :], set_bool.Response).message == "set to True"
        await client.socket.send_bytes(struct.pack("<BIII", 2, 9999, 78, 3) + b"cdr")
        failure = await client.until("serviceCallFailure")
        assert (failure["callId"], failure["serviceId"]) == (78, 9999)


async def test_parameters_are_read_set_and_subscribed():
    async with bridge_setup() as setup, setup.client() as client:
        setup.node.declare_parameter("speed", 1.5)
        await client.send("getParameters", parameterNames=["/robot.speed"], id="one")
        message = await client.until("parameterValues")
        assert message == {
            "op": "parameterValues",
            "id": "one",
            "parameters": [{"name": "/robot.speed", "value": 1.5, "type": "float64"}],
        }
        await client.send("subscribeParameterUpdates", parameterNames=["/robot.speed"])
        change = {"name": "/robot.speed", "value": 2, "type": "float64"}
        await client.send("setParameters", parameters=[change], id="two")
        responses = [await client.until("parameterValues") for _ in range(2)]
        assert [response["parameters"][0]["value"] for response in responses] == [2.0, 2.0]
        assert setup.node.get_parameter("speed").value == 2.0
        await client.send("getParameters", parameterNames=[], id="all")
        names = {parameter["name"] for parameter in (await client.until("parameterValues"))["parameters"]}
        assert {"/robot.speed", "/robot.use_sim_time"} <= names


async def test_subscription_to_all_parameters_keeps_the_others_when_one_name_is_added_or_removed():
    async with bridge_setup() as setup, setup.client() as client:
        setup.node.declare_parameter("speed", 1.5)
        setup.node.declare_parameter("height", 1.5)

        async def changed_parameter(**fields) -> str:
            for name in ("speed", "height"):
                await client.send("setParameters", parameters=[{"name": f"/robot.{name}", "type": "float64", **fields}])
            return (await client.until("parameterValues"))["parameters"][0]["name"]

        await client.send("subscribeParameterUpdates", parameterNames=[])
        await client.send("subscribeParameterUpdates", parameterNames=["/robot.height"])
        assert await changed_parameter(value=2) == "/robot.speed"
        assert (await client.until("parameterValues"))["parameters"][0]["name"] == "/robot.height"
        await client.send("unsubscribeParameterUpdates", parameterNames=["/robot.speed"])
        assert await changed_parameter(value=3) == "/robot.height"


async def test_connection_graph_is_sent_and_updated():
    async with bridge_setup() as setup, setup.client() as client:
        setup.node.create_publisher(String, "/chatter", 10)
        await setup.wait_until_offered("/chatter")
        await client.send("subscribeConnectionGraph")
        first = await client.until("connectionGraphUpdate")
        assert {"name": "/chatter", "publisherIds": ["/robot"]} in first["publishedTopics"]
        setup.node.create_subscription(String, "/chatter", print, 10)
        update_after = await client.until("connectionGraphUpdate")
        assert update_after["subscribedTopics"] == [{"name": "/chatter", "subscriberIds": ["/robot"]}]
        assert update_after["publishedTopics"] == []


async def test_simulated_time_is_sent_to_clients():
    async with bridge_setup(use_sim_time=True) as setup, setup.client() as client:
        assert "time" in (await client.next())["capabilities"]
        clock = get_message("rosgraph_msgs/msg/Clock")
        publisher = setup.node.create_publisher(clock, "/clock", 10)
        message = clock()
        message.clock.sec = 12
        publisher.publish(message)
        assert struct.unpack("<BQ", await client.frame(2)) == (2, 12_000_000_000)


# --- access control ------------------------------------------------------------------------------------------------


async def fetched(client: Foxglove, uri: str) -> tuple[int, bytes]:
    await client.send("fetchAsset", uri=uri, requestId=3)
    frame = await client.frame(4)
    _, request, failed, length = struct.unpack_from("<BIBI", frame)
    assert request == 3
    return failed, frame[10 + length :] if not failed else frame[10 : 10 + length]


async def test_only_meshes_of_packages_in_robot_description_are_served(tmp_path, monkeypatch):
    share = tmp_path / "robot"
    (share / "meshes").mkdir(parents=True)
    (share / "package.xml").write_text("<package format='3'><name>arm_pkg</name><version>1.0.0</version></package>")
    (share / "meshes" / "a.stl").write_bytes(b"solid a")
    (share / "secret.py").write_text("secret")
    (tmp_path / "secret.png").write_bytes(b"secret")
    (share / "meshes" / "link.png").symlink_to(tmp_path / "secret.png")
    source = tmp_path / "src" / "robot"  # the layout of colcon build --symlink-install
    source.mkdir(parents=True)
    (source / "package.xml").write_text((share / "package.xml").read_text())
    (source / "b.stl").write_bytes(b"solid b")
    (share / "meshes" / "b.stl").symlink_to(source / "b.stl")
    monkeypatch.chdir(share)
    async with bridge_setup() as setup, setup.client() as client:
        assert (await fetched(client, "package://arm_pkg/meshes/a.stl"))[0] == 1
        setup.node.create_publisher(String, "/robot_description", DESCRIPTION_QOS).publish(
            String(data='<robot><mesh filename="package://arm_pkg/meshes/a.stl"/></robot>')
        )
        await setup.graph.settle()
        assert await fetched(client, "package://arm_pkg/meshes/a.stl") == (0, b"solid a")
        assert await fetched(client, "package://arm_pkg/meshes/b.stl") == (0, b"solid b")
        for request in (
            "package://arm_pkg/secret.py",
            "package://arm_pkg/../secret.png",
            "package://arm_pkg/meshes/../../secret.png",
            "package://arm_pkg/meshes/%2e%2e/secret.png",
            "package://arm_pkg/meshes/link.png",
            "package://arm_pkg//etc/passwd.png",
            "package://other/meshes/a.stl",
            "file:///etc/passwd",
            "/etc/passwd",
            "http://example.com/a.stl",
        ):
            status, reason = await fetched(client, request)
            assert status == 1, request
            assert b"secret" not in reason


@pytest.mark.parametrize(
    ("origin", "welcome"),
    [
        (None, True),
        ("https://app.foxglove.dev", True),
        ("https://lichtblick-suite.github.io", True),
        ("http://localhost:8080", True),
        ("http://127.0.0.1:3000", True),
        ("file://", True),
        ("null", False),
        ("https://evil.example", False),
        ("http://app.foxglove.dev", False),
        ("https://app.foxglove.dev.evil.example", False),
        ("https://evilfoxglove.dev", False),
        ("http://[", False),
    ],
)
def test_origin_is_allowed_only_if_listed_or_local(origin, welcome):
    assert is_allowed_origin(origin) is welcome


@pytest.mark.parametrize(
    ("origin", "host", "welcome"),
    [
        ("http://192.168.1.5:8000", "192.168.1.5:9090", True),
        ("http://[fe80::1]:8000", "[fe80::1]:9090", True),
        ("http://192.168.1.6:8000", "192.168.1.5:9090", False),
        ("http://robot.local", "robot.local:9090", False),  # the name may have been made to refer to this machine
        ("http://192.168.1.5", "[", False),
    ],
)
def test_page_is_allowed_that_was_opened_by_the_ip_address_of_this_machine(origin, host, welcome):
    assert is_allowed_origin(origin, host=host) is welcome


async def test_connection_from_other_origin_is_rejected():
    async with bridge_setup() as setup:
        with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
            async with setup.client(origin="https://evil.example"):
                pass
        assert caught.value.status == 403
    async with (
        bridge_setup(allowed_origins=["https://evil.example"]) as setup,
        setup.client(origin="https://evil.example") as client,
    ):
        assert (await client.next())["op"] == "serverInfo"


async def test_connection_without_foxglove_subprotocol_is_closed():
    async with bridge_setup() as setup, setup.client(()) as client:
        message = await client.socket.receive(timeout=TIMEOUT_S)
        assert message.type is aiohttp.WSMsgType.CLOSE
        assert client.socket.close_code == 1002


async def test_malformed_client_messages_are_reported_and_bridge_survives():
    async with bridge_setup() as setup, setup.client() as client:
        empty = '{"op": "advertise", "channels": [{}]}'
        for text in ("nonsense", "[]", "{}", '{"op": "fly"}', '{"op": "subscribe"}', empty, "[" * 100_000):
            await client.socket.send_str(text)
            assert (await client.until("status"))["level"] == 2
        for frame in (
            b"",
            b"\x01",
            b"\xff1234",
            struct.pack("<BIII", 2, 1, 1, 4_000_000_000),
            struct.pack("<BI", 1, 5),
        ):
            await client.socket.send_bytes(frame)
            assert (await client.until("status"))["level"] == 2
        await client.send("subscribeConnectionGraph")
        assert (await client.until("connectionGraphUpdate"))["publishedTopics"]


async def test_whitelists_hide_other_topics_and_services():
    lists = {"topic_whitelist": ["/seen.*"], "client_topic_whitelist": ["/cmd_vel"], "service_whitelist": ["/none"]}
    async with bridge_setup(**lists) as setup:
        setup.node.create_publisher(String, "/seen_one", 10)
        setup.node.create_publisher(String, "/hidden", 10)
        await setup.wait_until_offered("/seen_one")
        async with setup.client() as client:
            assert [channel["topic"] for channel in (await client.until("advertise"))["channels"]] == ["/seen_one"]
            assert (await client.until("advertiseServices"))["services"] == []
            channel = {"id": 1, "topic": "/other", "encoding": "cdr", "schemaName": "std_msgs/msg/String"}
            await client.send("advertise", channels=[channel])
            assert "may not publish" in (await client.until("status"))["message"]


async def test_slow_whitelist_pattern_does_not_block_bridge():
    async with bridge_setup(topic_whitelist=["/(s|ss)+", "/seen"]) as setup:
        setup.node.create_publisher(String, "/seen", 10)
        setup.node.create_publisher(String, f"/{'s' * 60}_", 10)
        await setup.wait_until_offered("/seen")
        async with setup.client() as client:
            assert [channel["topic"] for channel in (await client.until("advertise"))["channels"]] == ["/seen"]


async def test_disconnecting_client_logs_nothing(caplog):
    async with bridge_setup() as setup:
        for headers in ("", f"{UPGRADE}Sec-WebSocket-Protocol: {V1[0]}\r\n"):
            await request_and_reset(setup.port, "/", headers)
        async with setup.client() as client:
            await client.until("serverInfo")
    assert [record.getMessage() for record in caplog.records] == []


async def test_startup_fails_if_port_is_in_use_or_whitelist_is_invalid():
    graph = Graph(on_log=lambda _: None)
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with pytest.raises(LinkwrightError) as caught:
            FoxgloveBridge(graph, NodeOptions(parameters={"port": port}))
        assert caught.value.diagnostics[0].code == "NODE702"
    with pytest.raises(LinkwrightError) as caught:
        FoxgloveBridge(graph, NodeOptions(parameters={"topic_whitelist": ["("]}))
    assert caught.value.diagnostics[0].code == "NODE701"
    await graph.close()
