"""Simulated worlds whose time is stepped together with the time of a graph."""

import doctest
import os
import threading

import numpy as np
import pytest

import linkwright.testing.simulated
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import Parameter
from linkwright.messages import get_message, get_service
from linkwright.testing import AsyncSteppedSimulation, SteppedSimulation
from tests.places import PACKAGE

MBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"
Twist, Odometry = get_message("geometry_msgs/msg/Twist"), get_message("nav_msgs/msg/Odometry")
BOX = """<sdf version="1.7"><model name="crate"><link name="link"><inertial><mass>2</mass></inertial>
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model></sdf>"""
SLOPE = """<sdf version="1.7"><world name="slope"><model name="ramp"><static>true</static><link name="link">
<collision name="c"><pose>0 0 -0.5 0 0.3 0</pose><geometry><box><size>20 20 1</size></box></geometry></collision>
</link></model></world></sdf>"""

LASER_BEHIND_A_POST = """<robot name="observer">
<link name="base_link"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
<joint name="laser_joint" type="fixed"><origin xyz="0 0 0.3"/><parent link="base_link"/><child link="laser"/></joint>
<link name="laser"/>
<joint name="post_joint" type="fixed"><origin xyz="0.5 0 0.2"/><parent link="base_link"/><child link="post"/></joint>
<link name="post"><collision><geometry><box size="0.2 0.2 0.4"/></geometry></collision></link>
<gazebo reference="laser"><sensor type="ray" name="laser"><update_rate>10</update_rate><ray><scan><horizontal>
<samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></ray><plugin name="laser" filename="libgazebo_ros_ray_sensor.so">
<ros><remapping>~/out:=scan</remapping></ros><output_type>sensor_msgs/LaserScan</output_type>
<frame_name>laser</frame_name></plugin></sensor></gazebo></robot>"""


def test_documentation_example_runs():
    results = doctest.testmod(linkwright.testing.simulated)
    assert results.attempted == 1
    assert results.failed == 0


def test_mbot_drives_one_meter_and_odometry_matches():
    with SteppedSimulation("empty", MBOT) as test:
        odometry = test.record("/odom")
        test.drive(0.5)
        test.advance(2.4)
        test.drive(0.0)
        test.advance(0.6)
        position = odometry.last.pose.pose.position
        assert position.x == pytest.approx(test.robot_pose()[0], abs=0.05)
        assert 1.0 < position.x < 1.3
        assert odometry.times[-1] == pytest.approx(test.now)
        assert odometry.last.header.stamp.sec == 3
        assert test.simulation.time == 3_000_000_000


@pytest.mark.parametrize(("linear", "angular"), [(0.5, 0.0), (-0.5, 0.0), (0.0, 1.0), (0.3, 0.6), (0.3, -0.6)])
def test_accelerating_wheels_match_odometry(linear, angular):
    """The plugin ramps the commanded wheel speeds."""
    with SteppedSimulation("empty", MBOT) as test:
        odometry = test.record("/odom")
        test.drive(linear, angular)
        test.advance(2.0)
        test.drive(0.0)
        test.advance(1.0)
        x, y, _, *rotation = test.robot_pose()
        pose = odometry.last.pose.pose
        result = [getattr(pose.orientation, name) for name in "xyzw"]
        assert [x, y] == pytest.approx([pose.position.x, pose.position.y], abs=1e-3)
        assert rpy_from_quaternion(rotation)[2] == pytest.approx(rpy_from_quaternion(result)[2], abs=1e-3)


def test_laser_measures_links_on_fixed_joints(tmp_path):
    """gz merges these links with the laser's link, whose collisions rays ignore.

    Linkwright's server keeps them.
    """
    robot = tmp_path / "robot.urdf"
    robot.write_text(LASER_BEHIND_A_POST, encoding="utf-8")
    with SteppedSimulation("empty", robot) as test:
        scan = test.record("/scan")
        test.advance(0.5)
        assert list(scan.last.ranges) == pytest.approx([0.4], abs=0.01)


def _drive_mbot(seed: int) -> tuple[list[bytes], list[float]]:
    with SteppedSimulation("empty", MBOT, seed=seed, noise=2.0) as test:
        imu, odometry = test.record("/imu"), test.record("/odom")
        test.drive(0.3, 0.5)
        test.advance(0.5)
        assert imu.messages
        poses = [message.pose.pose.position.x for message in odometry]
        return [np.asarray([message.linear_acceleration.x]).tobytes() for message in imu], poses


def test_same_seed_gives_identical_run_and_other_seed_other_noise():
    assert _drive_mbot(1) == _drive_mbot(1)
    assert _drive_mbot(1)[0] != _drive_mbot(2)[0]


def test_rclpy_node_drives_robot_without_thread():
    from linkwright.standins.rclpy_api.node import Node

    class Keeper(Node):
        """A node that drives until odometry reports half a meter, and reads the clock."""

        def __init__(self):
            super().__init__("keeper", parameter_overrides=[Parameter("use_sim_time", value=True)])
            self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
            self.create_subscription(Odometry, "/odom", self.look, 10)
            self.ticks = []
            self.create_timer(0.1, lambda: self.ticks.append(self.get_clock().now().nanoseconds))

        def look(self, odometry):
            command = Twist()
            command.linear.x = 0.4 if odometry.pose.pose.position.x < 0.5 else 0.0
            self.commands.publish(command)

    threads = threading.active_count()
    with SteppedSimulation("empty", MBOT) as test:
        test.init_rclpy()
        keeper = Keeper()
        test.advance(3.0)
        assert test.robot_pose()[0] == pytest.approx(0.55, abs=0.05)
        assert keeper.ticks == [100_000_000 * number for number in range(1, 31)]
        assert threading.active_count() == threads


def test_reset_restarts_simulation():
    with SteppedSimulation("empty", MBOT) as test:
        odometry = test.record("/odom")
        test.drive(0.5)
        test.advance(1.0)
        first = odometry.last.pose.pose.position.x
        test.reset()
        assert test.simulation.time == 0
        odometry.clear()
        test.drive(0.5)
        test.advance(1.0)
        assert odometry.last.pose.pose.position.x == pytest.approx(first, abs=0.02)
        assert test.now == pytest.approx(2.0)


async def test_async_simulation_runs_in_coroutine():
    async with AsyncSteppedSimulation("empty", MBOT, pose=(1.0, 2.0, 0.0, 0.0, 0.0, 0.0)) as test:
        odometry = test.record("/odom")
        await test.advance(0.25)
        assert test.simulation.time == 250_000_000
        assert len(odometry) == 12
        assert test.robot_pose()[:2] == pytest.approx((1.0, 2.0), abs=1e-3)


def test_short_advances_add_up():
    with SteppedSimulation() as test:
        for _ in range(100):
            test.advance(0.0015)
        assert test.simulation.time == 150_000_000


@pytest.mark.parametrize(("friction", "slides"), [(0.2, True), (0.5, False)])
def test_friction_option_determines_sliding(tmp_path, friction, slides):
    (tmp_path / "crate.sdf").write_text(BOX)
    (tmp_path / "slope.world").write_text(SLOPE)
    pose = (0.0, 0.0, 0.55, 0.0, 0.3, 0.0)
    with SteppedSimulation(tmp_path / "slope.world", tmp_path / "crate.sdf", friction=friction, pose=pose) as test:
        test.advance(0.3)
        before = test.robot_pose()[0]
        test.advance(1.0)
        assert (test.robot_pose()[0] - before > 0.3) is slides


def test_mass_and_xacro_arguments_are_applied():
    with SteppedSimulation("empty", MBOT, arguments={"laser": True, "camera": False}) as test:
        light = test.simulation.mass_of("mbot")
        assert "/scan" in dict(test.graph.get_topic_names_and_types())
    with SteppedSimulation("empty", MBOT, mass=3.0) as test:
        assert test.simulation.mass_of("mbot") > 2.0 * light
        assert "/scan" not in dict(test.graph.get_topic_names_and_types())


def test_changed_file_is_read_again(tmp_path):
    path = tmp_path / "crate.sdf"
    masses = []
    for mass, modified_ns in (("2", 1_000_000_000), ("7", 2_000_000_000)):
        path.write_text(BOX.replace("<mass>2<", f"<mass>{mass}<"))
        os.utime(path, ns=(modified_ns, modified_ns))
        with SteppedSimulation(robot=path) as test:
            masses.append(test.simulation.mass_of("crate"))
    assert masses == [2.0, 7.0]


@pytest.mark.parametrize(
    ("world", "robot", "code"),
    [
        ("nowhere", None, "SIM150"),
        ("empty", "none.sdf", "XML101"),
        ("empty", "world.sdf", "SIM142"),
        ("empty", "package://nowhere/a.urdf", "PKG101"),
    ],
)
def test_missing_or_invalid_world_or_robot_is_one_error(tmp_path, monkeypatch, world, robot, code):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "world.sdf").write_text(SLOPE)
    with pytest.raises(LinkwrightError) as raised:
        SteppedSimulation(world, robot)
    assert [diagnostic.code for diagnostic in raised.value.diagnostics] == [code]


def test_callback_error_is_raised_by_advance():
    with SteppedSimulation() as test:
        test.create_node("broken").create_timer(0.05, lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            test.advance(0.1)


def test_robots_are_spawned_and_removed_during_test(tmp_path):
    (tmp_path / "crate.sdf").write_text(BOX)
    with SteppedSimulation("empty") as test:
        assert test.spawn(tmp_path / "crate.sdf", pose=(1, 2, 0.5, 0, 0, 0)) == "crate"
        assert test.spawn(tmp_path / "crate.sdf", "second", pose=(3, 2, 0.5, 0, 0, 0)) == "second"
        assert test.spawn(MBOT, namespace="/one", arguments={"laser": True}) == "mbot"
        odometry = test.record("/one/odom")
        test.advance(0.1)
        assert test.simulation.model_pose("second")[:3] == pytest.approx((3, 2, 0.5), abs=1e-3)
        assert odometry.messages
        with pytest.raises(LinkwrightError, match="already exists"):
            test.spawn(tmp_path / "crate.sdf")
        test.delete("crate")
        assert [name for name in test.simulation.scene.models if name != "ground"] == ["second", "mbot"]


def test_simulator_services_answer_at_once():
    spawn, empty = get_service("gazebo_msgs/srv/SpawnEntity"), get_service("std_srvs/srv/Empty")
    with SteppedSimulation("empty") as test:
        request = spawn.Request(name="crate", xml=BOX)
        request.initial_pose.position.z = 5.0
        assert test.call("/spawn_entity", request).success
        test.call("/pause_physics", empty.Request())
        test.advance(1.0)
        assert (test.now, test.simulation.time) == (1.0, 0)
        assert test.simulation.model_pose("crate")[2] == 5.0
        step = get_service("simulation_interfaces/srv/StepSimulation")
        assert test.call("/step_simulation", step.Request(steps=100)).result.result == 1
        assert test.simulation.time == 100_000_000
        test.call("/unpause_physics", empty.Request())
        test.advance(0.5)
        assert test.simulation.time == 600_000_000
        assert test.simulation.model_pose("crate")[2] < 4.0


def test_robot_state_publisher_runs_on_request():
    with SteppedSimulation("empty", MBOT, robot_state_publisher=True) as test:
        description, transforms = test.record("/robot_description"), test.record("/tf")
        test.drive(0.5)
        test.advance(0.5)
        assert "<robot" in description.last.data
        moved = {transform.child_frame_id for message in transforms for transform in message.transforms}
        assert {"left_wheel_link", "right_wheel_link", "base_footprint"} <= moved
