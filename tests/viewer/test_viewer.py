"""A complete viewer, from topics to a page and back."""

from __future__ import annotations

import asyncio
import gzip
import math
from functools import partial
from urllib.parse import urlsplit

import aiohttp
import pytest

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, SourceText
from linkwright.graph import CLOCK_QOS, Graph
from linkwright.messages import Time, get_message
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.packages import PackageFinder
from linkwright.page import page_server, server
from linkwright.page.page_server import listen
from linkwright.page.protocol.message import PROTOCOL_VERSION
from linkwright.panels.joints import JointsFeature
from linkwright.rviz import RvizConfig
from linkwright.viewer import Viewer
from tests.places import TUTORIAL_PACKAGES, without_meshes
from tests.skipping import graph_clock, skipping
from tests.viewer.scene import ARM, World, open_page, open_world

Clock = get_message("rosgraph_msgs/msg/Clock")


async def test_opened_page_receives_messages_in_order():
    async with open_world(title="arm") as world:
        world.describe(ARM)
        world.move_arm(1.0)
        await world.settle()
        async with open_page(world.viewer) as client:
            transforms = await client.transforms()
            kinds = [message["type"] for message in client.messages[:-1]]
            first, table = client.messages[0], client.messages[-2]
    whatever_is_shown = [
        "diagnostics",
        "joints",
        "modeling_state",
        "recording_state",
        "simulation_status",
        "view_classes",
    ]
    of_the_configuration = ["configuration", "description_changed", "panels", "time_state", "tools", "view_state"]
    assert kinds == [
        *("hello", "tree", "robot_scene"),
        *whatever_is_shown,  # sorted by the names of the features
        *of_the_configuration,
        *("saved_views", "frame_table"),  # the table is the last opening message
    ]
    assert (first["protocol"], first["title"]) == (PROTOCOL_VERSION, "arm")
    assert transforms.revision == table["revision"]
    assert transforms.poses[table["names"].index("tip")].tolist() == [1, 0, 0, 0, 0, 0, 1]


async def test_transforms_are_relative_to_fixed_frame():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        world.move_arm(1.0)
        names = (await client.until("frame_table"))["names"]
        world.move_arm(2.0)
        while (await client.transforms()).poses[names.index("tip")][0] != 2.0:
            pass
        await client.set("global/Fixed Frame", "/tip")
        await client.until("property_changed", id="global/Fixed Frame", value="tip")
        assert (await client.transforms()).poses[names.index("base")][0] == -2.0


async def test_fixed_frame_status_matches_rviz():
    async with open_world(RvizConfig.for_model("map")) as world, open_page(world.viewer) as client:
        opening = await client.opened()
        assert opening["tree"]["global_status"] == [
            {
                "name": "Fixed Frame",
                "level": "warn",
                "text": "No tf data.  Actual error: Frame [map] does not exist",
            }
        ]
        world.move_arm()
        status = await client.until("display_status", display="global")
        assert (status["level"], status["status"][0]["text"]) == ("error", "Frame [map] does not exist")
        await client.set("global/Fixed Frame", "base")
        status = await client.until("display_status", display="global")
        assert (status["level"], status["status"][0]["text"]) == ("ok", "OK")


async def test_known_frames_are_offered_as_options():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        world.move_arm()
        options_message = await client.until("property_changed", id="global/Fixed Frame")
        assert options_message["options"] == ["base", "mark", "tip"]
        options_message = await client.until("property_changed", id="display-1/Reference Frame")
        assert options_message["options"] == ["<Fixed Frame>", "base", "mark", "tip"]
    options = world.viewer.config.options.rows()[0].options
    assert options == ["base", "mark", "tip"]


async def test_property_change_is_sent_to_all_pages():
    async with open_world() as world, open_page(world.viewer) as first, open_page(world.viewer) as second:
        await first.opened()
        await second.opened()
        await first.set("display-2/Alpha", 0.5)
        await first.set("global/Background Color", "#FFFFFF")
        for client in (first, second):
            assert (await client.until("property_changed", id="display-2/Alpha"))["value"] == 0.5
            assert (await client.until("property_changed", id="global/Background Color"))["value"] == "#ffffff"
        assert "Background Color: 255; 255; 255" in world.viewer.config.text()


async def test_rejected_value_is_answered_with_current_value():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        for identity, value, standing in (
            ("display-2/Alpha", "much", 1.0),
            ("global/Background Color", "red", "#303030"),
            ("display-1/Enabled", 3, True),
            ("global/Fixed Frame", "", "base"),
        ):
            await client.set(identity, value)
            assert (await client.until("property_changed", id=identity))["value"] == standing
        await client.set("display-9/Alpha", 1)
        await client.set("display-2/Nothing", 1)
        await client.set("nothing", 1)
        assert await client.drain() == []


async def test_pages_open_with_view_of_file():
    config = RvizConfig.for_model("base")
    async with open_world(config) as world:
        async with open_page(world.viewer) as client:
            state = (await client.opened())["view_state"]
            view = state["view"]
            assert (view["values"]["Distance"], state["whole_robot"]) == (3.0, True)
            await client.send("view_changed", view=view | {"values": view["values"] | {"Distance": 7.0}})
            await client.send("view_changed", view=view | {"values": {"Focal Point": 1.0}})
            await client.set("display-1/Alpha", 1.0)
            await client.until("property_changed")
        async with open_page(world.viewer) as client:
            state = (await client.opened())["view_state"]
            assert (state["view"]["values"]["Distance"], state["whole_robot"]) == (3.0, True)
    assert RvizConfig.parse(config.text()).views.current.values["Distance"] == 7.0
    assert "an invalid view" in world.logged()


async def test_measured_robot_sets_size_of_grid_and_axes():
    async with open_world(RvizConfig.for_model("base")) as world, open_page(world.viewer) as client:
        await client.opened()
        await client.send("robot_measured", diagonal=100.0, ground=-2.5)
        cells = await client.until("property_changed", id="display-1/Cell Size")
        axes = await client.until("property_changed", id="display-3/Marker Scale")
        below = await client.until("property_changed", id="display-1/Offset/Z")
        assert (cells["value"], axes["value"], below["value"]) == (100.0, 50.0, -2.5)
        await client.send("robot_measured", diagonal=1.0, ground=0.0)
        await client.set("display-1/Alpha", 0.3)
        assert (await client.until("property_changed"))["id"] == "display-1/Alpha"


async def test_diagnostics_are_shown_with_line_and_cleared():
    source = SourceText("/some/r.xacro", "<robot>\n  <xacro:whel/>\n</robot>\n")
    span = source.span(10, 21)
    diagnostic = Diagnostic("XAC101", "unknown macro", span, notes=(Note("called", span),), hint="did", source=source)
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        world.viewer.show_diagnostics([diagnostic, Diagnostic("X1", "no place")])
        items = (await client.until("diagnostics"))["items"]
        assert items[0] == {
            "code": "XAC101",
            "severity": "error",
            "message": "unknown macro",
            "file": "/some/r.xacro",
            "line": 2,
            "column": 3,
            "end_line": 2,
            "end_column": 14,
            "excerpt": "  <xacro:whel/>",
            "notes": [{"message": "called", "file": "/some/r.xacro", "line": 2, "column": 3}],
            "hints": ["did"],
        }
        assert items[1]["file"] is None
        async with open_page(world.viewer) as late_client:
            assert len((await late_client.opened())["diagnostics"]["items"]) == 2
        world.viewer.show_diagnostics([])
        assert (await client.until("diagnostics"))["items"] == []


async def test_configuration_errors_are_logged():
    text = "Visualization Manager:\n  Global Options: {Frame Rate: often}\n  Displays:\n    - {Name: x}\n"
    async with open_world(RvizConfig.parse(text, "a.rviz")) as world:
        world.viewer.config.options.rows()
    assert "a.rviz:2:32: 'Frame Rate': an integer is expected, not 'often'; 30 is used instead" in world.logged()
    assert "a.rviz:4:7: a display without a 'Class' is ignored" in world.logged()


@skipping
async def test_joint_slider_moves_joint_in_page():
    graph = Graph(clock=graph_clock(), on_log=lambda _: None)
    library = DescriptionLibrary()
    viewer = Viewer(graph, library=library, finder=PackageFinder(), config=RvizConfig.for_model("base"), port=0)
    await viewer.start()
    panel = JointStatePublisherGui(graph, NodeOptions(library=library)).panel
    viewer.attach_joint_panel(panel)
    RobotStatePublisher(graph, NodeOptions(parameters={"robot_description": ARM}, library=library))
    async with open_page(viewer) as client:
        while not (controls := (await client.until("joints"))["controls"]):
            pass
        assert [(control["name"], control["kind"]) for control in controls] == [("turn", "continuous")]
        while "tip" not in (names := (await client.until("frame_table"))["names"]):
            pass
        await client.drain(0.3)
        delays, now = [], asyncio.get_running_loop().time
        for angle in (0.5, 1.0, 1.5, 2.0, 2.5):
            await asyncio.sleep(0.1)
            start = now()
            await client.send("set_joint", name="turn", position=angle)
            transforms = await client.transforms()
            delays.append(now() - start)
            assert transforms.poses[names.index("tip")][5] == pytest.approx(math.sin(angle / 2))
        assert sorted(delays)[2] < 0.02
        assert await client.until("joint_positions", positions={"turn": 2.5})
        await client.send("center_joints")
        while (await client.until("joint_positions"))["positions"]["turn"] != 0.0:
            pass
    await viewer.close()
    await graph.close()


async def test_close_notifies_page_and_leaves_graph():
    async with open_world() as world:
        async with open_page(world.viewer) as client:
            await client.opened()
            closing = asyncio.ensure_future(world.viewer.close())
            with pytest.raises(ConnectionError):
                await client.until("nothing")
            await closing
            assert client.socket.close_code == 1001
        assert world.graph.node_names() == ["/publishers"]
        with pytest.raises(aiohttp.ClientError):
            async with aiohttp.ClientSession() as session:
                await session.get(world.viewer.url)


async def test_viewer_can_be_closed_repeatedly_after_graph():
    async with open_world() as world:
        await world.graph.close()
        await world.viewer.close()
        await world.viewer.close()


@skipping
async def test_unresponsive_page_does_not_delay_close():
    async with open_world() as world:
        address = urlsplit(world.viewer.url)
        reader, writer = await asyncio.open_connection(address.hostname, address.port)
        head = (
            f"GET /ws?{address.query} HTTP/1.1",
            f"Host: {address.netloc}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
        )
        writer.write(("\r\n".join(head) + "\r\n\r\n").encode())
        await reader.readuntil(b"\r\n\r\n")
        now = asyncio.get_running_loop().time
        start = now()
        await world.viewer.close()
        assert now() - start < 1.5
        writer.close()


async def test_listening_on_all_interfaces_is_logged():
    async with open_world(host="0.0.0.0") as world:
        assert "anyone who can reach it" in world.logged()
        assert world.viewer.url.startswith("http://127.0.0.1:")
    async with open_world() as world:
        assert world.logged() == ""


async def test_port_in_use_leaves_no_node():
    async with open_world() as world:
        port = urlsplit(world.viewer.url).port
        second = Viewer(
            world.graph,
            library=world.library,
            finder=PackageFinder(),
            config=RvizConfig.default(),
            port=port,
            options=NodeOptions(name="second"),
        )
        with pytest.raises(LinkwrightError) as caught:
            await second.start()
        assert caught.value.diagnostics[0].code == "VIEW101"
        assert "/second" not in world.graph.node_names()


@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("steps", range(1, 6))
async def test_canceled_start_leaves_no_node_or_socket(steps, times, monkeypatch):
    listeners = []
    monkeypatch.setattr(page_server, "listen", lambda host, port: listeners.append(listen(host, port)) or listeners[0])
    world = World()
    start = asyncio.ensure_future(world.viewer.start())
    for _ in range(steps):
        await asyncio.sleep(0)
    broken_off = start.cancel()
    if times == 2:  # cancel during the cleanup
        await asyncio.sleep(0)
        start.cancel()
    await asyncio.wait([start])
    if not broken_off:  # the viewer had started, so it is closed normally
        await world.viewer.close()
    assert listeners[0].fileno() == -1
    assert world.graph.node_names() == ["/publishers"]
    await world.graph.close()


async def test_failed_feature_start_closes_socket(monkeypatch):
    def fail(feature):
        raise OSError("the disk is full")

    listeners = []
    monkeypatch.setattr(page_server, "listen", lambda host, port: listeners.append(listen(host, port)) or listeners[0])
    monkeypatch.setattr(JointsFeature, "start", fail)
    world = World()
    with pytest.raises(OSError, match="the disk is full"):
        await world.viewer.start()
    assert listeners[0].fileno() == -1
    assert world.graph.node_names() == ["/publishers"]
    await world.graph.close()


async def test_failed_feature_close_closes_socket(monkeypatch):
    def fail(feature):
        raise OSError("the disk is full")

    monkeypatch.setattr(JointsFeature, "close", fail)
    world = World()
    await world.viewer.start()
    address = urlsplit(world.viewer.url)
    with pytest.raises(OSError, match="the disk is full"):
        await world.viewer.close()
    with pytest.raises(ConnectionRefusedError):
        await asyncio.open_connection(address.hostname, address.port)
    assert world.graph.node_names() == ["/publishers"]
    await world.graph.close()


async def test_missing_page_build_is_explained(tmp_path, monkeypatch):
    monkeypatch.setattr(server, "WebServer", partial(server.WebServer, page_folder=tmp_path))
    async with open_world() as world, aiohttp.ClientSession() as session, session.get(world.viewer.url) as response:
        assert response.status == 503
        assert "make page" in await response.text()


async def test_page_and_hashed_assets_are_served(tmp_path, monkeypatch):
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>x</title>", encoding="utf-8")
    (tmp_path / "assets" / "index-abc.js").write_text("export {}", encoding="utf-8")
    monkeypatch.setattr(server, "WebServer", partial(server.WebServer, page_folder=tmp_path))
    async with open_world() as world, aiohttp.ClientSession() as session:
        base = world.viewer.url.partition("?")[0]
        async with session.get(world.viewer.url) as response:
            assert response.status == 200
            assert response.headers["Cache-Control"] == "no-cache"
            assert await response.text() == "<!doctype html><title>x</title>"
        async with session.head(base) as response:
            assert (response.status, response.headers["Content-Length"]) == (200, "31")
        async with session.get(f"{base}assets/index-abc.js") as response:
            assert response.status == 200
            assert response.content_type == "text/javascript"
            assert "immutable" in response.headers["Cache-Control"]
        (tmp_path / "assets" / "index-abc.js.gz").write_bytes(gzip.compress(b"export {}"))
        async with session.get(f"{base}assets/index-abc.js") as response:
            assert response.headers["Content-Encoding"] == "gzip"
            assert response.headers["Vary"] == "Accept-Encoding"
            assert response.content_type == "text/javascript"
            assert await response.text() == "export {}"
        async with session.get(f"{base}assets/index-abc.js", headers={"Accept-Encoding": "identity"}) as response:
            assert "Content-Encoding" not in response.headers
            assert await response.text() == "export {}"
        (tmp_path / "assets" / "index-abc.js").unlink()  # the build creates only compressed files
        for accepted, encoding in (("gzip", "gzip"), ("identity", None)):
            async with session.get(f"{base}assets/index-abc.js", headers={"Accept-Encoding": accepted}) as response:
                assert response.headers.get("Content-Encoding") == encoding
                assert response.headers["Vary"] == "Accept-Encoding"
                assert await response.text() == "export {}"
                headers = {"Accept-Encoding": accepted, "If-None-Match": response.headers["ETag"]}
            async with session.get(f"{base}assets/index-abc.js", headers=headers) as response:
                assert (response.status, await response.read()) == (304, b"")
        async with session.get(f"{base}assets/gone.js") as response:
            assert response.status == 404
        async with session.get(base) as response:
            tag = response.headers["ETag"]
        async with session.get(base, headers={"If-None-Match": tag}) as response:
            assert (response.status, await response.read()) == (304, b"")
        (tmp_path / "index.html").write_text("<!doctype html><title>built anew</title>", encoding="utf-8")
        async with session.get(base, headers={"If-None-Match": tag}) as response:
            assert await response.text() == "<!doctype html><title>built anew</title>"


@pytest.mark.parametrize("package", TUTORIAL_PACKAGES, ids=lambda package: package.parent.name)
@pytest.mark.parametrize(
    ("model", "links"),
    [("mbot_base", 5), ("mbot_with_camera", 6), ("mbot_with_kinect", 6), ("mbot_with_laser", 6)],
)
async def test_tutorial_models_are_shown(package, model, links, tmp_path):
    share = without_meshes(package, tmp_path)
    config = RvizConfig.load(share / "rviz" / "urdf.rviz")
    async with open_world(config, packages={"my_robot_description": share}) as world:
        world.describe((share / "urdf" / f"{model}.urdf").read_text(encoding="utf-8"))
        await world.settle()
        async with open_page(world.viewer) as client:
            opening = await client.opened()
    assert len(opening["robot_scene"]["links"]) == links
    view = opening["view_state"]["view"]["values"]
    assert (view["Distance"], view["Pitch"], view["Yaw"]) == (1.7, 0.33, 5.5)
    alpha = next(row for row in opening["tree"]["displays"][1]["properties"] if row["name"] == "Alpha")
    assert alpha["value"] == 0.8
    if model == "mbot_with_kinect":
        assert str(share / "meshes" / "kinect.dae") in world.status("RobotModel")["kinect_link"][1]


async def test_viewer_node_applies_node_options():
    options = NodeOptions(
        name="eyes",
        namespace="/robot",
        parameters={"use_sim_time": True, "fixed_frame": "tip"},
        arguments=["--ros-args", "-r", "robot_description:=other"],
    )
    async with open_world(options=options) as world:
        (name,) = [node_name for node_name in world.graph.node_names() if node_name.endswith("/eyes")]
        assert name == "/robot/eyes"
        assert world.viewer.manager.fixed_frame == "tip"
        assert world.viewer.manager.time.now_ns() == 0  # before the first /clock
        clock = world.graph.create_node("clock").create_publisher(Clock, "/clock", CLOCK_QOS)
        clock.publish(Clock(clock=Time(sec=12)))
        await world.settle()
        assert world.viewer.manager.time.now_ns() == 12_000_000_000


async def test_unknown_ros_argument_is_rejected():
    with pytest.raises(LinkwrightError, match="--no-such"):
        async with open_world(options=NodeOptions(arguments=["--ros-args", "--no-such"])):
            pass
