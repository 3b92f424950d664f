"""The services and topics of a simulator, and its thread."""

from __future__ import annotations

from contextlib import asynccontextmanager

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import CLOCK_QOS, DurabilityPolicy, Graph, LogLevel, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.writer import save_model_of_world as saved
from linkwright.sdf.writer import save_world
from linkwright.simulation.nodes.simulator import Simulator
from linkwright.simulation.server import reports
from tests.simulation.test_plugins import joint_states, robot
from tests.simulation.worlds import box
from tests.waiting import eventually

LATCHED = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
URDF = """<robot name="crate"><link name="base"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>"""


class SimulatorSession:
    """A simulator in this process, and a node that calls it."""

    def __init__(self, graph: Graph, simulator: Simulator, log: list) -> None:
        self.graph = graph
        self.log = log
        self.simulator = simulator
        self.node = graph.create_node("asker")

    async def call(self, kind: str, service_name: str, /, **fields):
        """Call a service, and return its answer."""
        service = get_service(kind)
        return await self.node.create_client(service, service_name).call_async(service.Request(**fields))

    def record(self, kind: str, topic: str, qos: QoSProfile | int = 100):
        """Return a list that receives a topic's messages."""
        messages: list = []
        self.node.create_subscription(get_message(kind), topic, messages.append, qos)
        return messages


@asynccontextmanager
async def simulator(tmp_path, *parts: str, **parameters):
    """Run a simulator of a world with a ground and models; it is paused by default."""
    path = tmp_path / "a.world"
    ground = "<include><uri>model://ground_plane</uri></include>"
    path.write_text(f'<sdf version="1.7"><world name="test">{ground}{"".join(parts)}</world></sdf>')
    log: list = []
    graph = Graph(on_log=log.append)
    options = {"world": str(path), "pause": True, "real_time_factor": -1.0} | parameters
    node = Simulator(graph, NodeOptions(parameters=options))
    try:
        yield SimulatorSession(graph, node, log)
    finally:
        node.close()
        await graph.close()


UNKNOWN_SHAPE_SDF = (
    '<sdf version="1.7"><model name="r"><link name="base"><visual name="v"><geometry><pyramid/></geometry></visual>'
    "</link></model></sdf>"
)


async def test_sdf_model_with_unknown_shape_is_rejected_with_reason(tmp_path):
    async with simulator(tmp_path) as session:
        response = await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="one", xml=UNKNOWN_SHAPE_SDF)
        assert not response.success
        assert "the <geometry> of visual 'v' contains <pyramid>, which is not a shape" in response.status_message
        assert "one" not in session.simulator.server.simulation.scene.models


@pytest.mark.parametrize("shape", ["<pyramid/>", "", "<box/>", '<cylinder radius="1"/>', '<box size="1 a 1"/>'])
async def test_robot_with_invalid_shape_is_spawned_without_it_and_error_is_logged(tmp_path, shape):
    text = (
        '<robot name="r"><link name="base"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
        f"<collision><geometry>{shape}</geometry></collision></link></robot>"
    )
    async with simulator(tmp_path) as session:
        response = await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="one", xml=text)
        assert response.success, response.status_message
        assert "one" in session.simulator.server.simulation.scene.models
        errors = [record.text for record in session.log if record.level is LogLevel.ERROR]
        assert len(errors) == 1
        assert "<geometry>" in errors[0] or "of link 'base'" in errors[0]


async def test_models_are_spawned_and_deleted_by_services(tmp_path):
    async with simulator(tmp_path) as session:
        sent = {"name": "one", "xml": URDF, "robot_namespace": ""}
        pose = get_message("geometry_msgs/msg/Pose")()
        pose.position.z = 4.0
        response = await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", initial_pose=pose, **sent)
        assert (response.success, response.status_message) == (True, "SpawnEntity: Successfully spawned entity [one]")
        response = await session.call("gazebo_msgs/srv/GetModelList", "/get_model_list")
        assert sorted(response.model_names) == ["ground_plane", "one"]
        response = await session.call("gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="one")
        assert response.success
        assert response.state.pose.position.z == 4.0
        response = await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="one")
        assert response.success
        response = await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="one")
        assert (response.success, response.status_message) == (False, "there is no model 'one'")


@pytest.mark.parametrize(
    ("xml", "reason"),
    [
        (URDF, "a model 'one' already exists"),
        ("<robot", "<the description>:1:1"),
        ("<html/>", "the root element is <html>"),
        ('<sdf version="1.7"><world name="w"/></sdf>', "one of the models of the world"),
        ('<robot name="a"/>', ""),
    ],
)
async def test_invalid_spawn_request_is_rejected_with_reason(tmp_path, xml, reason):
    async with simulator(tmp_path, box("one", "0 0 1 0 0 0")) as session:
        response = await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="one", xml=xml)
        assert not response.success
        assert reason in response.status_message
        response = await session.call("gazebo_msgs/srv/GetModelList", "/get_model_list")
        assert sorted(response.model_names) == ["ground_plane", "one"]


async def test_step_service_advances_paused_simulation(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), publish_rate=100.0) as session:
        clock = session.record("rosgraph_msgs/msg/Clock", "/clock", CLOCK_QOS)
        response = await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=25)
        assert response.result.result == response.result.RESULT_OK
        assert session.simulator.server.simulation.time == 25_000_000
        await eventually(lambda: bool(clock))
        assert clock[-1].clock.nanosec == 20_000_000
        await session.call("std_srvs/srv/Empty", "/reset_world")
        assert session.simulator.server.simulation.time == 0


async def test_reliable_and_best_effort_subscriptions_receive_clock(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), publish_rate=100.0) as session:
        clocks = [session.record("rosgraph_msgs/msg/Clock", "/clock", qos) for qos in (CLOCK_QOS, QoSProfile(10))]
        await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=25)
        await eventually(lambda: all(clocks))


@pytest.mark.parametrize("pause", [True, False])
async def test_paused_start_logs_how_to_unpause(tmp_path, pause):
    async with simulator(tmp_path, pause=pause) as session:
        assert any("/unpause_physics" in record.text for record in session.log) is pause


async def test_simulation_runs_in_thread_and_ends_after_duration(tmp_path):
    async with simulator(tmp_path, robot(joint_states()), pause=False, seconds=1.0) as session:
        states = session.record("simulation_interfaces/msg/SimulationState", "/simulation_state", LATCHED)
        messages = session.record("sensor_msgs/msg/JointState", "/joint_states")
        await eventually(session.simulator.finished.done)
        assert session.simulator.server.simulation.time == 1_000_000_000
        await eventually(lambda: bool(states) and states[-1].state == states[-1].STATE_PAUSED)
        await eventually(lambda: bool(messages) and messages[-1].header.stamp.sec == 1)
        response = await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=1)
        assert response.result.result == response.result.RESULT_OK


async def test_failed_simulation_ends_before_its_duration(tmp_path):
    strong_gravity = "<gravity>0 0 -1e14</gravity>" + box("one", "0 0 9 0 0 0")
    async with simulator(tmp_path, strong_gravity, pause=False, seconds=1.0) as session:
        await eventually(session.simulator.finished.done)
        assert session.simulator.finished.result() == 1


async def test_running_simulation_rejects_steps(tmp_path):
    async with simulator(tmp_path, pause=False) as session:
        response = await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=1)
        assert response.result.result == response.result.RESULT_INCORRECT_STATE
        await session.call("std_srvs/srv/Empty", "/pause_physics")
        assert session.simulator.runner.is_paused
        await session.call("std_srvs/srv/Empty", "/unpause_physics")
        assert not session.simulator.runner.is_paused


async def test_unstable_simulation_is_paused(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), pause=False) as session:
        wrench = get_message("geometry_msgs/msg/Wrench")()
        wrench.force.x = float("inf")
        duration = get_message("builtin_interfaces/msg/Duration")(sec=-1)
        response = await session.call(
            "gazebo_msgs/srv/ApplyLinkWrench", "/apply_link_wrench", link_name="link", wrench=wrench, duration=duration
        )
        assert not response.success
        response = await session.call(
            "gazebo_msgs/srv/ApplyLinkWrench",
            "/apply_link_wrench",
            link_name="one::link",
            wrench=wrench,
            duration=duration,
        )
        assert response.success
        await eventually(lambda: session.simulator.runner.is_paused)


async def test_wrench_acts_for_its_duration(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 90 0 0 0", mass=2.0)) as session:
        wrench = get_message("geometry_msgs/msg/Wrench")()
        wrench.force.x = 4.0
        duration = get_message("builtin_interfaces/msg/Duration")(nanosec=100_000_000)
        await session.call(
            "gazebo_msgs/srv/ApplyLinkWrench",
            "/apply_link_wrench",
            link_name="one::link",
            wrench=wrench,
            duration=duration,
        )
        await session.call("simulation_interfaces/srv/StepSimulation", "/step_simulation", steps=200)
        state = (await session.call("gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="one")).state
        assert state.twist.linear.x == pytest.approx(0.2, abs=1e-9)


async def test_set_entity_state_sets_pose_and_velocity(tmp_path):
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0")) as session:
        state = get_message("gazebo_msgs/msg/EntityState")(name="one")
        state.pose.position.x, state.pose.orientation.z, state.pose.orientation.w = 3.0, 1.0, 0.0
        state.twist.linear.x, state.twist.angular.z = 1.0, 2.0
        assert (await session.call("gazebo_msgs/srv/SetEntityState", "/set_entity_state", state=state)).success
        message = (await session.call("gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="one")).state
        assert (message.pose.position.x, message.pose.orientation.z) == (3.0, 1.0)
        assert (message.twist.linear.x, message.twist.angular.z) == pytest.approx((1.0, 2.0))
        message = (
            await session.call(
                "gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="ground_plane", reference_frame="one"
            )
        ).state
        assert message.pose.position.x == pytest.approx(3.0)


async def test_service_failure_without_message_field_is_logged(tmp_path):
    ends = "<parent>one::link</parent><child>two::link</child>"
    hinge = f'<joint name="hinge" type="revolute">{ends}<axis><xyz>0 0 1</xyz></axis></joint>'
    async with simulator(tmp_path, box("one", "0 0 9 0 0 0"), box("two", "3 0 9 0 0 0"), hinge) as session:
        for name in ("ground_plane", "two", "three"):
            state = get_message("gazebo_msgs/msg/EntityState")(name=name)
            assert not (await session.call("gazebo_msgs/srv/SetEntityState", "/set_entity_state", state=state)).success
        assert not (await session.call("gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="on")).success
        await session.call("gazebo_msgs/srv/LinkRequest", "/clear_link_wrenches", link_name="wheel")
        assert (await session.call("gazebo_msgs/srv/GetEntityState", "/get_entity_state", name="one")).success
        assert [record.text for record in session.log if record.level == LogLevel.ERROR] == [
            (
                "/set_entity_state: 'ground_plane' is fixed to the world "
                "(delete it, and spawn it again at the intended pose)"
            ),
            ("/set_entity_state: a joint of the world connects 'two' to 'one' (move 'one' instead)"),
            "/set_entity_state: there is no model or link 'three'",
            "/get_entity_state: there is no model or link 'on' (did you mean 'one'?)",
            "/clear_link_wrenches: there is no model or link 'wheel'",
        ]


async def test_late_subscriber_gets_world_with_spawned_models(tmp_path):
    async with simulator(tmp_path) as session:
        await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="late", xml=URDF)
        worlds = session.record("std_msgs/msg/String", "/world_description", LATCHED)
        await eventually(lambda: bool(worlds) and 'name="late"' in worlds[-1].data)
        assert 'name="ground_plane"' in worlds[-1].data


async def test_world_with_robot_is_serialized_once_at_start(tmp_path, monkeypatch):
    saved_worlds: list[str] = []
    monkeypatch.setattr(
        reports, "save_world", lambda *world: saved_worlds.append(save_world(*world)) or saved_worlds[-1]
    )
    async with simulator(tmp_path, robot_description=URDF, robot_name="first") as session:
        worlds = session.record("std_msgs/msg/String", "/world_description", LATCHED)
        await eventually(lambda: bool(worlds))
        assert [world.data for world in worlds] == saved_worlds
        assert 'name="first"' in saved_worlds[0]


async def test_only_changed_models_are_serialized_again(tmp_path, monkeypatch):
    saved_names: list[str] = []
    monkeypatch.setattr(reports, "save_model_of_world", lambda model: saved_names.append(model.name) or saved(model))
    async with simulator(tmp_path, box("one", "1 0 9 0 0 0")) as session:
        worlds = session.record("std_msgs/msg/String", "/world_description", LATCHED)
        assert saved_names == ["one", "ground_plane"]
        for name in ("two", "three"):
            await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name=name, xml=URDF)
        await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="two")
        await session.call(
            "gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="two", xml=URDF.replace("1 1 1", "2 2 2")
        )
        await eventually(lambda: bool(worlds) and "<size>2 2 2</size>" in worlds[-1].data)
        assert saved_names == ["one", "ground_plane", "two", "three", "two"]
        assert [line for line in worlds[-1].data.splitlines() if line.startswith("    <model")] == [
            f'    <model name="{name}">' for name in ("one", "ground_plane", "three", "two")
        ]


async def test_actors_and_roads_are_described_as_models(tmp_path):
    ball = "<geometry><sphere><radius>0.5</radius></sphere></geometry>"
    actor = (
        f'<actor name="walker"><link name="head"><visual name="v">{ball}</visual></link><script>'
        '<trajectory id="0" type="walk"><waypoint><time>0</time><pose>2 0 1 0 0 0</pose></waypoint></trajectory>'
        "</script></actor>"
    )
    road = '<road name="lane"><point>0 0 0</point><point>4 0 0</point></road>'
    async with simulator(tmp_path, actor, road) as session:
        worlds = session.record("std_msgs/msg/String", "/world_description", LATCHED)
        await eventually(lambda: bool(worlds))
        assert '<model name="walker">' in worlds[-1].data
        assert '<model name="lane">' in worlds[-1].data
        assert "<actor" not in worlds[-1].data
        poses = session.record("tf2_msgs/msg/TFMessage", "/world_poses")
        await eventually(lambda: bool(poses))
        [transform] = poses[-1].transforms
        assert transform.child_frame_id == "walker::head"
        assert transform.transform.translation.x == pytest.approx(2.0)


async def test_world_poses_contain_movable_links_only(tmp_path):
    async with simulator(tmp_path, box("one", "1 0 9 0 0 0")) as session:
        poses = session.record("tf2_msgs/msg/TFMessage", "/world_poses")
        await eventually(lambda: bool(poses))
        [transform] = poses[-1].transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("world", f"one{SEPARATOR}link")
        assert transform.transform.translation.z == pytest.approx(9.0)


async def test_robot_can_be_spawned_at_start(tmp_path):
    parameters = {"robot_description": URDF, "robot_name": "r", "robot_pose": [1.0, 2.0, 0.5, 0.0, 0.0, 0.0]}
    async with simulator(tmp_path, **parameters) as session:
        assert session.simulator.server.simulation.model_pose("r")[:3] == (1.0, 2.0, 0.5)


async def test_findings_of_model_last_while_it_is_in_world(tmp_path):
    description = URDF.replace("collision>", "visual>")
    async with simulator(tmp_path, robot_description=description, robot_name="first", pause=False) as session:
        server = session.simulator.server
        messages: list[list[str]] = []
        server.on_findings.append(lambda: messages.append([finding.code for finding in server.findings]))
        [finding] = server.findings
        assert (finding.code, finding.span.line) == ("SIM143", 1)
        session.simulator.services.replace_model(description.replace('mass value="1"', 'mass value="2"'), "first")
        await eventually(lambda: messages == [[], ["SIM143"]])
        session.simulator.services.replace_model(URDF, "first")
        await eventually(lambda: messages[2:] == [[]])
        await session.call("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", name="second", xml=description)
        assert [finding.code for finding in server.findings] == ["SIM143"]
        await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="second")
        assert server.findings == []


async def test_world_can_be_given_as_text_or_ros_gz_parameter(tmp_path):
    text = f'<sdf version="1.7"><world name="told">{box("crate", "0 0 1 0 0 0")}</world></sdf>'
    async with simulator(tmp_path, world_sdf_string=text) as session:
        response = await session.call("gazebo_msgs/srv/GetModelList", "/get_model_list")
        assert response.model_names == ["crate"]
    path = tmp_path / "other.sdf"
    path.write_text(text.replace("crate", "chest"), encoding="utf-8")
    async with simulator(tmp_path, world_sdf_file=str(path)) as session:
        response = await session.call("gazebo_msgs/srv/GetModelList", "/get_model_list")
        assert response.model_names == ["chest"]


async def test_malformed_world_text_is_rejected(tmp_path):
    with pytest.raises(LinkwrightError, match="world_sdf_string"):
        async with simulator(tmp_path, world_sdf_string="<sdf"):
            pass
