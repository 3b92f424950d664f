"""The simulation bar, and changes of a simulated world's models by pages."""

from __future__ import annotations

from contextlib import asynccontextmanager

import pytest

from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import Time, get_message, get_service
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

STATE = get_message("simulation_interfaces/msg/SimulationState")
METRICS = get_message("gazebo_msgs/msg/PerformanceMetrics")
SERVICES = {
    "/pause_physics": "std_srvs/srv/Empty",
    "/unpause_physics": "std_srvs/srv/Empty",
    "/reset_simulation": "std_srvs/srv/Empty",
    "/step_simulation": "simulation_interfaces/srv/StepSimulation",
    "/spawn_entity": "gazebo_msgs/srv/SpawnEntity",
    "/get_model_list": "gazebo_msgs/srv/GetModelList",
    "/delete_entity": "gazebo_msgs/srv/DeleteEntity",
    "/get_entity_state": "gazebo_msgs/srv/GetEntityState",
    "/set_entity_state": "gazebo_msgs/srv/SetEntityState",
    "/apply_link_wrench": "gazebo_msgs/srv/ApplyLinkWrench",
}


class FakeSimulator:
    """The topics and services of a simulator.

    It records requests, and returns a fixed pose for each model.
    """

    def __init__(self, world) -> None:
        self.world = world
        self.node = world.graph.create_node("gazebo")
        latched = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.state = self.node.create_publisher(STATE, "/simulation_state", latched)
        self.metrics = self.node.create_publisher(METRICS, "/performance_metrics", 10)
        self.requests: list[tuple[str, object]] = []
        for name, kind in SERVICES.items():
            self.node.create_service(
                get_service(kind), name, lambda request, response, name=name: self._record(name, request, response)
            )

    def _record(self, name: str, request, response):
        self.requests.append((name, request))
        if hasattr(response, "success"):
            response.success = getattr(request, "name", "") != "nobody"
            if not response.success:
                response.status_message = "there is no model 'nobody'"
        if name == "/set_entity_state":
            response.success = request.state.name != "ground"  # the response has no message
        if name == "/get_model_list":
            response.model_names = ["ground", "ground_2"]
        if name == "/get_entity_state":
            response.state.name = request.name
            response.state.pose.position.x = 1.0
            response.state.pose.orientation.z = 1.0
        return response

    async def request(self, name: str, count: int = 1):
        await eventually(lambda: [service for service, _ in self.requests].count(name) >= count)
        return [request for service, request in self.requests if service == name][-1]


@asynccontextmanager
async def open_simulation():
    async with open_world() as world:
        simulation = FakeSimulator(world)
        simulation.state.publish(STATE(state=1))
        async with open_page(world.viewer) as client:
            await client.until("simulation_status", present=True)
            yield simulation, client


async def test_simulation_is_absent_without_simulator():
    async with open_world() as world, open_page(world.viewer) as client:
        assert (await client.opened())["simulation_status"]["present"] is False


async def test_simulation_features_are_created_on_demand():
    def kinds(viewer) -> set[str]:
        return {type(feature).__name__ for feature in viewer._features}

    async with open_world() as world, open_page(world.viewer) as client:
        assert not (await client.opened())["modeling_state"]["available"]
        needless = {"SimulationFeature", "ModelingFeature", "RecordingFeature", "ComparisonFeature", "PointsFeature"}
        assert not needless & kinds(world.viewer)
        FakeSimulator(world).state.publish(STATE(state=1))
        await client.until("simulation_status", present=True)
        assert needless & kinds(world.viewer) == {"SimulationFeature"}
        await client.send("stop_recording")
        await client.until("recording_state", path="")
        assert needless & kinds(world.viewer) == {"SimulationFeature", "RecordingFeature"}


async def test_status_reports_pause_and_real_time_factor():
    async with open_simulation() as (simulation, client):
        simulation.state.publish(STATE(state=2))
        await client.until("simulation_status", paused=True)
        message = METRICS(real_time_factor=0.5)
        message.header.stamp = Time(sec=12, nanosec=500_000_000)
        simulation.metrics.publish(message)
        await client.until("simulation_status", paused=True, time=12.5, real_time_factor=0.5)


async def test_status_reports_drivable_robot():
    async with open_simulation() as (simulation, client):
        simulation.node.create_subscription("geometry_msgs/msg/TwistStamped", "robot/cmd_vel", lambda _: None, 10)
        await client.until("simulation_status", drivable=True)
        simulation.node.destroy_node()
        await client.until("simulation_status", present=False, drivable=False)


async def test_status_reports_end_of_simulation():
    async with open_simulation() as (simulation, client):
        simulation.node.destroy_node()
        await client.until("simulation_status", present=False)


@pytest.mark.parametrize(
    ("action", "service"),
    [
        ("play", "/unpause_physics"),
        ("pause", "/pause_physics"),
        ("reset", "/reset_simulation"),
        ("step", "/step_simulation"),
    ],
)
async def test_simulation_buttons_call_services(action, service):
    async with open_simulation() as (simulation, client):
        await client.send("control_simulation", action=action)
        request = await simulation.request(service)
        assert getattr(request, "steps", 1) == 1


async def test_models_are_spawned_from_path(tmp_path):
    robot = tmp_path / "box.urdf"
    robot.write_text("<robot name='box'><link name='base'/></robot>")
    model = tmp_path / "ball.sdf"
    model.write_text("<sdf version='1.9'><model name='ball'><static>true</static><link name='l'/></model></sdf>")
    async with open_simulation() as (simulation, client):
        await client.send("spawn_model", address=str(robot), position=[1, 2, 3])
        request = await simulation.request("/spawn_entity")
        assert '<robot name="box">' in request.xml
        assert (request.initial_pose.position.x, request.initial_pose.position.z) == (1.0, 3.0)
        assert (await client.until("model_added"))["name"] == "box"
        await client.send("spawn_model", address=str(model), position=[0, 0, 0])
        request = await simulation.request("/spawn_entity", 2)
        assert '<model name="ball">' in request.xml
        assert "<static>true</static>" in request.xml
        await client.send("spawn_model", address=str(tmp_path / "none.urdf"), position=[0, 0, 0])
        assert "none.urdf" in (await client.until("simulation_notice"))["text"]


async def test_duplicate_model_is_renamed_with_notice(tmp_path):
    robot = tmp_path / "robot.urdf"
    robot.write_text("<robot name='ground'><link name='base'/></robot>")
    async with open_simulation() as (simulation, client):
        await client.send("spawn_model", address=str(robot), position=[1, 2, 3])
        request = await simulation.request("/spawn_entity")
        assert (request.name, request.robot_namespace) == ("ground_3", "/ground_3")
        assert "the new one is named 'ground_3'" in (await client.until("simulation_notice"))["text"]


async def test_rejected_request_is_reported():
    async with open_simulation() as (_, client):
        await client.send("delete_model", model="nobody")
        assert (await client.until("simulation_notice"))["text"] == "there is no model 'nobody'"


async def test_missing_service_is_reported():
    async with open_world() as world:
        node = world.graph.create_node("gazebo")
        node.create_publisher(STATE, "/simulation_state", 1).publish(STATE(state=1))
        async with open_page(world.viewer) as client:
            await client.until("simulation_status", present=True)
            await client.send("control_simulation", action="pause")
            assert (await client.until("simulation_notice"))["text"] == "there is no service '/pause_physics'"


async def test_model_is_dragged_relative_to_its_pose():
    async with open_simulation() as (simulation, client):
        await client.send("drag_model", model="crate", begins=True, offset=[0, 0, 0])
        await simulation.request("/set_entity_state")
        await client.send("drag_model", model="crate", begins=False, offset=[2, 3, 0])
        state = (await simulation.request("/set_entity_state", 2)).state
        assert (state.name, state.reference_frame) == ("crate", "world")
        position, turn = state.pose.position, state.pose.orientation
        assert (position.x, position.y, position.z, turn.z) == (3.0, 3.0, 0.0, 1.0)
        assert [name for name, _ in simulation.requests].count("/get_entity_state") == 1


async def test_immovable_model_is_reported_by_name():
    async with open_simulation() as (_, client):
        await client.send("drag_model", model="ground", begins=True, offset=[0, 0, 0])
        notice = await client.until("simulation_notice")
        assert notice["text"] == "'ground' cannot be moved: it is fixed to the world, or no longer exists"


async def test_push_applies_wrench_at_point():
    async with open_simulation() as (simulation, client):
        await client.send("push_link", link="crate::link", point=[0, 0, 1], force=[5, 0, 0])
        request = await simulation.request("/apply_link_wrench")
        assert (request.link_name, request.reference_frame, request.reference_point.z) == ("crate::link", "world", 1.0)
        assert request.wrench.force.x == 5.0
        assert 0 < request.duration.nanosec < 1_000_000_000
        await client.send("push_link", link="crate::link", point=[0, 0], force=[5, 0, 0])
        await client.send("delete_model", model="crate")
        await simulation.request("/delete_entity")
        assert [name for name, _ in simulation.requests].count("/apply_link_wrench") == 1
