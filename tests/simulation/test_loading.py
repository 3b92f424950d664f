"""Loading another world into a running simulation: `/load_world`."""

from __future__ import annotations

import pytest

from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message
from tests.simulation.test_plugins import joint_states, robot
from tests.simulation.test_server import simulator
from tests.simulation.worlds import box
from tests.waiting import eventually

GROUND = "<include><uri>model://ground_plane</uri></include>"
LATCHED = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SPIN = """<model name="arm"><pose>5 5 1 0 0 0</pose><link name="base"/>
<link name="tip"><pose>0 0 0.5 0 0 0</pose></link>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="turn" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 0 1</xyz></axis></joint>
{extra}</model>"""


def world_text(*parts: str) -> str:
    """Return a world's text."""
    return f'<sdf version="1.7"><world name="test">{GROUND}{"".join(parts)}</world></sdf>'


async def load_world(session, tmp_path, *parts: str, content: str = "", **flags: bool):
    """Load another text as the content of the world's file."""
    resource = get_message("simulation_interfaces/msg/Resource")
    world = resource(uri=str(tmp_path / "a.world"), resource_string=content or world_text(*parts))
    return await session.call("simulation_interfaces/srv/LoadWorld", "/load_world", world_resource=world, **flags)


async def step_simulation(session, count: int) -> None:
    """Step the simulation."""
    await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=count)


async def test_unchanged_models_keep_moving(tmp_path):
    falling, other = box("one", "0 0 9 0 0 0"), box("two", "3 0 9 0 0 0")
    async with simulator(tmp_path, falling, other) as session:
        simulation = session.simulator.server.simulation
        await step_simulation(session, 100)
        state = simulation.model_pose("one"), *map(tuple, simulation.link_velocity("one::link"))
        response = await load_world(
            session, tmp_path, "\n<!-- here -->", falling.replace("9 0 0 0", " 9.0  0 0 0"), other
        )
        assert (response.result.result, response.result.error_message) == (response.result.RESULT_OK, "")
        assert (response.world.name, response.world.world_resource.uri) == ("test", str(tmp_path / "a.world"))
        assert (simulation.model_pose("one"), *map(tuple, simulation.link_velocity("one::link"))) == state
        assert simulation.time == 100_000_000
        assert simulation.revision == 0, "MuJoCo's model was not compiled again"


async def test_relocated_model_is_moved_and_starts_there(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), box("two", "3 0 9 0 0 0")) as session:
        simulation = session.simulator.server.simulation
        await step_simulation(session, 100)
        state = simulation.model_pose("two"), *map(tuple, simulation.link_velocity("two::link"))
        await load_world(session, tmp_path, box("one", "0 1 5 0 0 0"), box("two", "3 0 9 0 0 0"))
        assert simulation.model_pose("one")[:3] == (0, 1, 5)
        assert not simulation.link_velocity("one::link")[0].any()
        assert (simulation.model_pose("two"), *map(tuple, simulation.link_velocity("two::link"))) == state
        await step_simulation(session, 100)
        await session.call("std_srvs/srv/Empty", "/reset_world")
        assert simulation.model_pose("one")[:3] == (0, 1, 5)
        assert simulation.model_pose("two")[:3] == (3, 0, 9)


async def test_relocated_fixed_model_keeps_joint_positions(tmp_path):
    async with simulator(tmp_path, SPIN.format(extra="")) as session:
        simulation = session.simulator.server.simulation
        simulation.set_joint_position("arm::turn", 0.7)
        await load_world(session, tmp_path, SPIN.format(extra="").replace("5 5 1 0", "6 5 1 0"))
        assert simulation.joint_state("arm::turn")[0] == pytest.approx(0.7)
        assert simulation.model_pose("arm")[:3] == (6, 5, 1)
        assert simulation.link_pose("arm::tip")[:3] == pytest.approx((6, 5, 1.5))


async def test_changed_model_is_replaced_at_current_pose(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0.3 0"), SPIN.format(extra="")) as session:
        simulation = session.simulator.server.simulation
        simulation.set_model_velocity("one", (1.0, 2.0, 0.0), (0.0, 0.0, 3.0))
        simulation.set_joint_position("arm::turn", 0.7)
        await step_simulation(session, 100)
        state = simulation.model_pose("one"), simulation.link_velocity("one::link")
        joint_state = simulation.joint_state("arm::turn")
        hand = '<link name="hand"/><joint name="hold" type="fixed"><parent>tip</parent><child>hand</child></joint>'
        await load_world(session, tmp_path, box("one", "0 0 9 0 0.3 0", size="1 1 2"), SPIN.format(extra=hand))
        assert simulation.model_pose("one") == pytest.approx(state[0], abs=1e-12)
        for velocity, velocity_before in zip(simulation.link_velocity("one::link"), state[1], strict=True):
            assert velocity == pytest.approx(velocity_before, abs=1e-12)
        assert simulation.joint_state("arm::turn") == joint_state
        assert "arm::hand" in simulation.scene.bodies
        await session.call("std_srvs/srv/Empty", "/reset_world")
        assert simulation.model_pose("one")[:3] == (0, 0, 9)


async def test_changed_and_relocated_model_uses_new_pose(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0")) as session:
        await step_simulation(session, 100)
        await load_world(session, tmp_path, box("one", "0 4 9 0 0 0", size="1 1 2"))
        assert session.simulator.server.simulation.model_pose("one")[:3] == (0, 4, 9)


async def test_models_are_added_and_removed_and_spawned_ones_kept(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), box("two", "3 0 9 0 0 0")) as session:
        descriptions = session.record("std_msgs/msg/String", "/world_description", LATCHED)
        xml = f'<sdf version="1.7">{box("spawned", "0 0 0 0 0 0")}</sdf>'
        await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="spawned", xml=xml)
        await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="one")
        await load_world(session, tmp_path, box("one", "0 0 9 0 0 0"), box("three", "6 0 9 0 0 0"))
        names = set(session.simulator.server.simulation.scene.models)
        assert names == {"ground_plane", "spawned", "one", "three"}
        await eventually(lambda: bool(descriptions) and "three" in descriptions[-1].data)
        assert "two" not in descriptions[-1].data


async def test_physics_gravity_light_and_plugins_are_updated(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), real_time_factor=0.0) as session:
        simulation = session.simulator.server.simulation
        log = session.record("rcl_interfaces/msg/Log", "/rosout")
        physics = (
            '<physics type="ode"><max_step_size>0.002</max_step_size><real_time_factor>2</real_time_factor></physics>'
        )
        sun = '<light name="sun" type="directional"/><scene><ambient>1 0 0 1</ambient></scene>'
        state = '<plugin name="state" filename="libnobody_knows.so"/>'
        await load_world(session, tmp_path, "<gravity>0 0 0</gravity>", physics, sun, state, box("one", "0 0 9 0 0 0"))
        await step_simulation(session, 500)
        assert simulation.time == 1_000_000_000
        assert simulation.model_pose("one")[2] == 9.0
        assert [light.name for light in simulation.world.lights] == ["sun"]
        assert simulation.world.scene.ambient[:3] == (1, 0, 0)
        await eventually(lambda: any("libnobody_knows" in message.msg for message in log))
        await load_world(session, tmp_path, box("one", "0 0 9 0 0 0"))
        await step_simulation(session, 100)
        assert simulation.model_pose("one")[2] < 9.0


async def test_plugins_restart_only_with_changed_models(tmp_path):
    async with simulator(tmp_path, robot(joint_states())) as session:
        server = session.simulator.server
        plugins = server.plugins("mbot")
        assert plugins
        await load_world(session, tmp_path, robot(joint_states()), box("one", "9 9 1 0 0 0"))
        assert server.plugins("mbot") == plugins
        await load_world(session, tmp_path, robot(joint_states(extra="<ros><namespace>/new</namespace></ros>")))
        (plugin,) = server.plugins("mbot")
        assert plugin not in plugins
        messages = session.record("sensor_msgs/msg/JointState", "/new/joint_states")
        await step_simulation(session, 1000)
        await eventually(lambda: bool(messages))


@pytest.mark.parametrize(
    ("content", "result", "message"),
    [
        ("<sdf", 103, "a.world:1:1: "),
        (world_text(box("one", "0 0 what 0 0 0")), 103, "a.world:1:"),
        ('<sdf version="1.7"><model name="m"><link name="l"/></model></sdf>', 101, "there is no world in"),
        (world_text("<include><uri>model://nowhere_at_all</uri></include>"), 104, "a.world:1:"),
        (world_text(box("spawned", "0 0 0 0 0 0")), 4, "a model 'spawned' already exists"),
        (world_text('<physics type="ode"><max_step_size>-1</max_step_size></physics>'), 4, "a time step of -1.0 s"),
        (world_text("<includ/>"), 106, "<includ> in <world> is not read"),
    ],
)
async def test_invalid_world_changes_nothing(tmp_path, content, result, message):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0")) as session:
        simulation = session.simulator.server.simulation
        xml = f'<sdf version="1.7">{box("spawned", "0 0 0 0 0 0")}</sdf>'
        await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="spawned", xml=xml)
        await step_simulation(session, 100)
        simulation.refresh()
        before = simulation.world, simulation.revision, simulation.data.qpos.tolist(), simulation.data.qvel.tolist()
        response = await load_world(session, tmp_path, content=content, fail_on_unsupported_element=True)
        assert response.result.result == result
        assert message in response.result.error_message
        simulation.refresh()
        after = simulation.world, simulation.revision, simulation.data.qpos.tolist(), simulation.data.qvel.tolist()
        assert after == before


async def test_missing_assets_can_be_ignored(tmp_path):
    async with simulator(tmp_path) as session:
        missing = "<include><uri>model://nowhere_at_all</uri></include>"
        response = await load_world(session, tmp_path, missing, ignore_missing_or_unsupported_assets=True)
        assert response.result.result == response.result.RESULT_OK
        response = await load_world(session, tmp_path, missing, box("one", "0 0 9 0 0 0"))
        assert response.result.result == response.result.RESULT_OK, "the include was already missing"


async def test_missing_world_and_unknown_file_are_reported(tmp_path):
    async with simulator(tmp_path) as session:
        response = await session.call("simulation_interfaces/srv/LoadWorld", "/load_world")
        assert (response.result.result, response.result.error_message) == (
            response.NO_RESOURCE,
            "no world was specified (pass the path of a world file, or the text of a world)",
        )
        resource = get_message("simulation_interfaces/msg/Resource")(uri="no_such")
        response = await session.call("simulation_interfaces/srv/LoadWorld", "/load_world", world_resource=resource)
        assert response.result.result == response.result.RESULT_NOT_FOUND


DRIVE = """<plugin name="drive" filename="libgazebo_ros_diff_drive.so"><left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint><wheel_separation>0.38</wheel_separation><wheel_diameter>0.12</wheel_diameter></plugin>"""


async def test_changed_robot_is_replaced_in_place_and_drives(tmp_path):
    async with simulator(tmp_path, robot(DRIVE)) as session:
        simulation = session.simulator.server.simulation
        command = session.node.create_publisher(get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
        await step_simulation(session, 100)
        simulation.set_model_pose("mbot", (2.0, 1.0, 0.11, 0.0, 0.0, 0.0, 1.0))
        await step_simulation(session, 10)
        pose, wheel_state = simulation.model_pose("mbot"), simulation.joint_state("mbot::left_joint")
        mast = "<link name='mast'/><joint name='m' type='fixed'><parent>base_link</parent><child>mast</child></joint>"
        await load_world(session, tmp_path, robot(DRIVE, mast))
        assert simulation.model_pose("mbot") == pytest.approx(pose, abs=1e-9)
        assert simulation.joint_state("mbot::left_joint") == pytest.approx(wheel_state, abs=1e-9)
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x = 0.5
        command.publish(twist)
        await step_simulation(session, 2000)
        assert simulation.model_pose("mbot")[0] > pose[0] + 0.5


CLASSIC = DRIVE.replace("</plugin>", "<publish_odom>true</publish_odom><odometry_source>0</odometry_source></plugin>")
GZ = """<plugin name="drive" filename="gz-sim-diff-drive-system"><left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint><wheel_separation>0.38</wheel_separation><wheel_radius>0.06</wheel_radius>
<topic>cmd_vel</topic><odom_topic>odom</odom_topic></plugin>"""
MAST = "<link name='mast'/><joint name='m' type='fixed'><parent>base_link</parent><child>mast</child></joint>"


@pytest.mark.parametrize("drive", [CLASSIC, GZ])
async def test_unchanged_drive_keeps_odometry_and_command(tmp_path, drive):
    async with simulator(tmp_path, robot(drive)) as session:
        simulation = session.simulator.server.simulation
        command = session.node.create_publisher(get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
        messages = session.record("nav_msgs/msg/Odometry", "/odom")
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x = 0.5
        command.publish(twist)
        await step_simulation(session, 2000)
        pose = simulation.model_pose("mbot")[0]
        assert pose > 0.5
        await load_world(session, tmp_path, robot(drive, MAST))
        messages.clear()
        await step_simulation(session, 1000)
        await eventually(lambda: bool(messages))
        assert simulation.model_pose("mbot")[0] > pose + 0.3
        assert messages[-1].pose.pose.position.x == pytest.approx(simulation.model_pose("mbot")[0], abs=0.05)


async def test_changed_drive_starts_again(tmp_path):
    async with simulator(tmp_path, robot(CLASSIC)) as session:
        command = session.node.create_publisher(get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x = 0.5
        command.publish(twist)
        await step_simulation(session, 2000)
        messages = session.record("nav_msgs/msg/Odometry", "/odom")
        await load_world(session, tmp_path, robot(CLASSIC.replace("0.38", "0.4"), MAST))
        messages.clear()
        await step_simulation(session, 1000)
        await eventually(lambda: bool(messages))
        assert abs(messages[-1].pose.pose.position.x) < 0.1
