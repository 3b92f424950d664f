"""A simulated world without a launch file."""

from __future__ import annotations

import asyncio
import io
from dataclasses import replace
from pathlib import Path

import pytest

from linkwright.cli.command import main
from linkwright.descriptions import examine
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.sensor_topics import find_image_topics, find_scan_topics
from linkwright.hosting.simulated import PlannedNode, SimulatedView, SimulatedWorld
from linkwright.messages import get_service
from linkwright.packages import PackageFinder
from linkwright.testing import Recording
from tests.waiting import eventually

MBOT = Path(__file__).parents[2] / "robots/my_robot_description/urdf/mbot_gazebo.xacro"
OPTIONS = HostOptions(port=0, open_browser=False, network=False)


@pytest.fixture(autouse=True)
def _logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


def simulate_mbot() -> SimulatedWorld:
    """Simulate mbot in a world without a page for two seconds, as fast as possible."""
    description = examine(MBOT)
    assert description.robot is not None
    return SimulatedWorld(
        "empty", MBOT, description, description.text, description.robot.name, seconds=2.0, rate=-1.0, headless=True
    )


async def test_headless_robot_publishes_odometry_joint_states_and_tf():
    err = io.StringIO()
    view = SimulatedView(simulate_mbot(), PackageFinder(start=MBOT.parent), OPTIONS, LaunchLog(io.StringIO(), err))
    listener = view.host.graph.create_node("listener")
    recordings = {
        name: Recording(view.host.graph, listener, name) for name in ("/odom", "/joint_states", "/tf", "/clock")
    }
    assert await view.run(None), err.getvalue()
    assert all(len(recording) > 0 for recording in recordings.values()), {
        name: len(recording) for name, recording in recordings.items()
    }
    assert recordings["/joint_states"].last.header.stamp.sec >= 1


async def test_nodes_of_a_world_run_beside_the_simulator():
    node = PlannedNode("tf2_ros", "static_transform_publisher", {}, ("--frame-id", "here", "--child-frame-id", "there"))
    view = SimulatedView(
        replace(simulate_mbot(), nodes=(node,)),
        PackageFinder(start=MBOT.parent),
        OPTIONS,
        LaunchLog(io.StringIO(), err := io.StringIO()),
    )
    frames = Recording(view.host.graph, view.host.graph.create_node("listener"), "/tf_static", "tf2_msgs/msg/TFMessage")
    assert await view.run(None), err.getvalue()
    assert "there" in {transform.child_frame_id for message in frames for transform in message.transforms}


async def test_viewer_uses_world_frame_and_simulated_time():
    world = replace(simulate_mbot(), headless=False, seconds=0.0)
    err = io.StringIO()
    view = SimulatedView(world, PackageFinder(start=MBOT.parent), OPTIONS, LaunchLog(io.StringIO(), err))
    running = asyncio.create_task(view.run(None))
    await eventually(lambda: "gzserver-2]: started" in err.getvalue() or running.done(), what=err.getvalue)
    config = view._create_viewer_config()
    assert config.options.text("Fixed Frame") == "world"
    displays = {display.cls.rpartition("/")[2]: display.checked for display in config.displays}
    assert displays == {"Grid": True, "RobotModel": False, "TF": False, "World": True, "Odometry": False}
    listener = view.host.graph.create_node("listener")
    client = listener.create_client(get_service("rcl_interfaces/srv/GetParameters"), "/viewer/get_parameters")
    response = await client.call_async(client.srv_type.Request(names=["use_sim_time"]))
    assert response.values[0].bool_value, "without simulated time, later messages would seem old after a reset"
    view.interrupt("the test is over")
    assert await running


async def test_robot_without_collisions_is_reported_in_viewers(tmp_path: Path):
    file = tmp_path / "seen.urdf"
    visual = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    file.write_text(f'<robot name="seen">\n<link name="base">{visual}</link></robot>')
    description = examine(file)
    world = SimulatedWorld("empty", file, description, description.text, "seen", headless=True)
    view = SimulatedView(world, PackageFinder(start=tmp_path), OPTIONS, LaunchLog(io.StringIO(), io.StringIO()))
    running = asyncio.create_task(view.run(None))
    await eventually(lambda: "SIM143" in [finding.code for finding in view.reload.findings()] or running.done())
    [finding] = [finding for finding in view.reload.findings() if finding.code == "SIM143"]
    assert (finding.span.file, finding.span.line) == (str(file), 2)
    view.interrupt("the test is over")
    assert await running


async def test_robot_named_like_world_model_ends_simulation(tmp_path: Path):
    model = '<model name="mbot"><static>true</static><link name="link"/></model>'
    (tmp_path / "a.world").write_text(f'<sdf version="1.7"><world name="w">{model}</world></sdf>')
    world = replace(simulate_mbot(), world=str(tmp_path / "a.world"), seconds=0.0)
    err = io.StringIO()
    view = SimulatedView(world, PackageFinder(start=MBOT.parent), OPTIONS, LaunchLog(io.StringIO(), err))
    assert not await view.run(None)
    assert "error[SIM102]: a model 'mbot' already exists" in err.getvalue()


def test_missing_world_is_one_error(capsys):
    assert main(["sim", "emty"]) == 1
    printed = capsys.readouterr()
    assert "there is no world 'emty'" in printed.err
    assert "empty" in printed.err


def test_model_file_is_rejected_as_world(tmp_path, capsys):
    (tmp_path / "box.sdf").write_text('<sdf version="1.7"><model name="box"><link name="a"/></model></sdf>')
    assert main(["sim", str(tmp_path / "box.sdf")]) == 1
    assert "linkwright sim empty" in capsys.readouterr().err


def test_malformed_robot_is_one_error(tmp_path, capsys):
    (tmp_path / "robot.urdf").write_text("<robot")
    assert main(["sim", "empty", str(tmp_path / "robot.urdf"), "--headless"]) == 1
    assert capsys.readouterr().err.count("error[") == 1


def test_scan_topics_are_read_from_description():
    classic = "<sensor name='a' type='ray'><plugin><ros><remapping>~/out:=scan</remapping></ros></plugin></sensor>"
    newer = '<sensor name="b" type="gpu_lidar"><topic>/front/scan</topic></sensor>'
    camera = '<sensor name="c" type="camera"><topic>image</topic></sensor>'
    assert find_scan_topics(classic + newer + camera + newer) == ["/scan", "/front/scan"]
    assert find_scan_topics("") == []


async def test_scans_particles_and_first_camera_are_shown():
    camera = "<sensor name='{}' type='camera'><topic>{}</topic></sensor>"
    scan = "<sensor name='a' type='ray'><plugin><ros><remapping>~/out:=scan</remapping></ros></plugin></sensor>"
    text = f"{scan}{camera.format('b', 'left')}{camera.format('c', 'right')}"
    world = replace(simulate_mbot(), text=text, particles_topic="/world_particles")
    view = SimulatedView(world, PackageFinder(start=MBOT.parent), OPTIONS, LaunchLog(io.StringIO(), io.StringIO()))
    topics = [
        (display.name, display.section.text("Topic", "Value"), display.checked)
        for display in view._create_viewer_config().displays
    ]
    assert topics[4:] == [
        ("LaserScan", "/scan", True),
        ("Particles", "/world_particles", True),
        ("Image", "/left", True),
        ("Image", "/right", False),
    ]
    await view.host.close()


def test_image_topics_are_read_from_description():
    classic = "<sensor name='camera' type='camera'><plugin filename='libgazebo_ros_camera.so'>{}</plugin></sensor>"
    assert find_image_topics(classic.format("")) == ["/camera/image_raw"]
    assert find_image_topics(classic.format("<cameraName>left</cameraName><imageTopicName>rgb</imageTopicName>")) == [
        "/left/rgb"
    ]
    remapping = "<ros><namespace>mbot</namespace><remapping>camera/image_raw:={}</remapping></ros>"
    assert find_image_topics(classic.format(remapping.format("seen"))) == ["/mbot/seen"]
    assert find_image_topics(classic.format(remapping.format("/seen"))) == ["/seen"]
    newer = '<sensor type="{}" name="b">{}</sensor>'
    assert find_image_topics(newer.format("camera", "") + newer.format("gpu_lidar", "<topic>scan</topic>")) == [
        "/image"
    ]
    assert find_image_topics(newer.format("rgbd_camera", "<topic>front</topic>")) == ["/front/image"]
    assert find_image_topics(newer.format("depth_camera", "")) == ["/depth_image"]
