"""Driving a robot without physics.

The simulator with the inferred physics runs in this process.
"""

from __future__ import annotations

import io
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.descriptions import DescriptionLibrary, examine
from linkwright.graph import Graph
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.simulated import SimulatedView, SimulatedWorld
from linkwright.inertia import MeshLibrary
from linkwright.inference import infer
from linkwright.messages import get_message
from linkwright.packages import PackageFinder
from linkwright.simulation.server.entities import read_entity
from linkwright.simulation.server.server import ServerOptions, SimulationServer
from linkwright.simulation.server.worlds import load_world
from linkwright.simulation.simulation import Simulation
from linkwright.testing import Recording

MBOT = """<robot name="mbot">
  <link name="base_link"><visual><geometry><cylinder radius="0.2" length="0.16"/></geometry></visual></link>
  <link name="left_wheel_link">
    <visual><origin rpy="1.5707 0 0"/><geometry><cylinder radius="0.06" length="0.025"/></geometry></visual>
  </link>
  <link name="right_wheel_link">
    <visual><origin rpy="1.5707 0 0"/><geometry><cylinder radius="0.06" length="0.025"/></geometry></visual>
  </link>
  <link name="front_caster_link"><visual><geometry><sphere radius="0.015"/></geometry></visual></link>
  <link name="back_caster_link"><visual><geometry><sphere radius="0.015"/></geometry></visual></link>
  <joint name="left_wheel_joint" type="continuous">
    <origin xyz="0 0.19 -0.05"/><parent link="base_link"/><child link="left_wheel_link"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="right_wheel_joint" type="continuous">
    <origin xyz="0 -0.19 -0.05"/><parent link="base_link"/><child link="right_wheel_link"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="front_caster_joint" type="continuous">
    <origin xyz="0.18 0 -0.095"/><parent link="base_link"/><child link="front_caster_link"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="back_caster_joint" type="continuous">
    <origin xyz="-0.18 0 -0.095"/><parent link="base_link"/><child link="back_caster_link"/><axis xyz="0 1 0"/>
  </joint>
</robot>
"""
"""The dimensions of the tutorial's first robot: only visuals, without the elements that a simulator needs."""

SECOND_NS = 1_000_000_000
PUBLISHED_ROBOT = Path(__file__).parents[3] / "shared" / "tutorial" / "my_robot_description" / "urdf" / "mbot_base.urdf"


class DrivenRobot:
    """A robot in a simulation that only advances in `drive`."""

    def __init__(self, graph: Graph, server: SimulationServer) -> None:
        self._graph = graph
        self._server = server
        kind = get_message("geometry_msgs/msg/Twist")
        self._publisher = graph.create_node("driver").create_publisher(kind, "/cmd_vel", 10)
        self.odometry: list = []
        listener = graph.create_node("listener")
        listener.create_subscription(get_message("nav_msgs/msg/Odometry"), "/odom", self.odometry.append, 10)

    async def drive(self, forward: float, turning: float, seconds: float) -> None:
        """Send a velocity, and let time pass."""
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x, twist.angular.z = forward, turning
        self._publisher.publish(twist)
        await self._graph.settle()
        self._server.advance(round(seconds * SECOND_NS))
        await self._graph.settle()

    @property
    def pose(self):
        """Return the pose of the robot in the world."""
        return self._server.simulation.model_pose("mbot")


def infer_drive(path: Path) -> SimulatedWorld:
    """Return the drive that `linkwright drive` infers for a file."""
    description = examine(path)
    assert description.robot is not None
    meshes = MeshLibrary(PackageFinder(start=path.parent), path.parent)
    inference = infer(description.robot, meshes)
    return replace(
        SimulatedWorld.of("empty", description, inference, lambda robot: infer(robot, meshes)), headless=True
    )


@asynccontextmanager
async def simulate_robot(path: Path):
    """Simulate the robot of a file on a plane; time advances when the test asks for it."""
    drive = infer_drive(path)
    loaded = load_world(drive.world)
    graph = Graph(on_log=lambda record: None)
    simulation = Simulation(loaded.world, loaded.finder)
    server = SimulationServer(simulation, graph.create_node("gazebo"), ServerOptions(usual_names=True))
    server.start()
    model = read_entity(drive.text, loaded.finder, DescriptionLibrary()).model
    server.spawn(model, drive.name, (*drive.pose, 1.0))
    try:
        yield DrivenRobot(graph, server)
    finally:
        server.close()
        await graph.close()


def write_robots(folder: Path) -> list[Path]:
    """Return robots without physics: Linkwright's own, and the tutorial's if available."""
    path = folder / "mbot_base.urdf"
    path.write_text(MBOT)
    return [path, *([PUBLISHED_ROBOT] if PUBLISHED_ROBOT.exists() else [])]


async def test_robot_drives_one_meter_straight_and_then_turns(tmp_path):
    for path in write_robots(tmp_path):
        await _assert_drives_one_meter_and_turns(path)


async def _assert_drives_one_meter_and_turns(path: Path) -> None:
    async with simulate_robot(path) as mbot:
        await mbot.drive(0.5, 0.0, 1.5)
        start = mbot.pose
        assert start[2] == pytest.approx(0.11, abs=1e-3)
        await mbot.drive(0.5, 0.0, 2.0)
        end = mbot.pose
        assert end[0] - start[0] == pytest.approx(1.0, abs=1e-3)
        assert end[1] == pytest.approx(0.0, abs=1e-3)
        await mbot.drive(0.0, 1.0, 2.0)
        heading = get_yaw(mbot.pose)
        await mbot.drive(0.0, 1.0, 1.0)
        assert get_yaw(mbot.pose) - heading == pytest.approx(1.0, abs=0.01)
        assert mbot.odometry[-1].child_frame_id == "base_link"


async def test_drive_ends_after_simulated_seconds(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    path = write_robots(tmp_path)[0]
    drive = replace(infer_drive(path), seconds=0.5, rate=-1.0)
    out, err = io.StringIO(), io.StringIO()
    options = HostOptions(port=0, open_browser=False, network=False)
    model = SimulatedView(drive, PackageFinder(start=path.parent, environment={}), options, LaunchLog(out, err))
    odometry = Recording(model.host.graph, model.host.graph.create_node("listener"), "/odom")
    assert await model.run(None)
    assert odometry.last.child_frame_id == "base_link", "the simulator uses the inferred drive"
    assert "[gzserver-2]: has finished cleanly" in err.getvalue()


async def test_missing_world_is_an_error(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    path = write_robots(tmp_path)[0]
    out, err = io.StringIO(), io.StringIO()
    options = HostOptions(port=0, open_browser=False, network=False)
    drive = replace(infer_drive(path), world="nowhere.world")
    model = SimulatedView(drive, PackageFinder(start=path.parent, environment={}), options, LaunchLog(out, err))
    assert not await model.run(None)
    assert "there is no world 'nowhere.world'" in err.getvalue()
