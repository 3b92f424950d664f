"""Plugins of Gazebo classic with topics and services.

The tests cover forces, states, properties and joint trajectories.
"""

from __future__ import annotations

import asyncio
from math import pi

import pytest

from linkwright.messages import get_message, get_service
from linkwright.testing import Recording
from tests.simulation.test_joint_controllers import arm_model
from tests.simulation.test_joint_trajectory import make_trajectory
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box
from tests.waiting import TIMEOUT_S

STATE = (
    '<plugin name="states" filename="libgazebo_ros_state.so"><ros><namespace>/world</namespace></ros>'
    "<update_rate>10</update_rate></plugin>"
)
PROPERTIES = '<plugin name="properties" filename="libgazebo_ros_properties.so"/>'


async def call_service(graph, server, service_type: str, service_name: str, /, **fields):
    """Call a service, and advance the simulation so that it answers."""
    service = get_service(service_type)
    node = graph.create_node("asker")
    future = node.create_client(service, service_name).call_async(service.Request(**fields))
    await graph.settle()
    server.advance(SECOND_NS // 1000)
    response = await asyncio.wait_for(future, TIMEOUT_S)
    node.destroy_node()
    return response


def box_with_force(extra: str = "", name: str = "push", yaw: float = 0.0) -> str:
    """Return a box of 2 kg with the force plugin."""
    plugin = (
        f'<plugin name="{name}" filename="libgazebo_ros_force.so"><link_name>link</link_name>'
        f"<ros><remapping>gazebo_ros_force:={name}</remapping></ros>{extra}</plugin>"
    )
    return box("crate", f"0 0 0 0 0 {yaw}", "1 1 1", 2.0).replace("</model>", f"{plugin}</model>")


async def publish_wrench(graph, topic: str, force: tuple[float, float, float]) -> None:
    """Publish a wrench."""
    message = get_message("geometry_msgs/msg/Wrench")()
    message.force.x, message.force.y, message.force.z = force
    node = graph.create_node("hand")
    node.create_publisher("geometry_msgs/msg/Wrench", topic, 10).publish(message)
    await graph.settle()
    node.destroy_node()


@pytest.mark.parametrize(("frame", "position"), [("world", (1.0, 0.0)), ("link", (0.0, 1.0))])
async def test_force_acts_in_world_or_link_frame(frame, position):
    text = box_with_force(f"<force_frame>{frame}</force_frame>", yaw=pi / 2)
    async with running_server("<gravity>0 0 0</gravity>", text) as (server, graph, log):
        await publish_wrench(graph, "/push", (4.0, 0.0, 0.0))
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("crate")[:2] == pytest.approx(position, abs=2e-3)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("crate")[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
        assert not log


async def test_forces_of_several_plugins_add_up():
    names = "<bodyName>link</bodyName><topicName>two</topicName>"
    second = f'<plugin name="two" filename="libgazebo_ros_force.so">{names}</plugin>'
    text = box_with_force().replace("</model>", f"{second}</model>")
    async with running_server("<gravity>0 0 0</gravity>", text) as (server, graph, log):
        await publish_wrench(graph, "/push", (4.0, 0.0, 0.0))
        await publish_wrench(graph, "/two", (0.0, 2.0, 0.0))
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("crate")[:2] == pytest.approx((1.0, 0.5), abs=2e-3)
        assert not log


async def test_unknown_force_frame_is_rejected():
    async with running_server(box_with_force("<force_frame>map</force_frame>")) as (server, _, log):
        assert not server.plugins("crate")
        assert [record.text for record in log if "<force_frame> must be" in record.text]


async def test_model_and_link_states_are_published():
    async with running_server(GROUND, robot(), STATE) as (server, graph, log):
        models, links = (Recording(graph, server.node, f"/world/{name}") for name in ("model_states", "link_states"))
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(models) == len(links) == 10
        assert models.last.name == ["ground", "mbot"]
        assert links.last.name[:3] == ["ground::link", "mbot::base_link", "mbot::left_wheel"]
        assert models.last.pose[1].position.z == pytest.approx(0.11, abs=2e-3)
        assert links.last.pose[2].position.y == pytest.approx(0.19, abs=1e-3)
        assert links.last.twist[2].linear.x == pytest.approx(0.0, abs=1e-3)
        assert not log


async def test_state_services_are_in_plugin_namespace():
    async with running_server(GROUND, robot(), STATE) as (server, graph, log):
        state = get_message("gazebo_msgs/msg/EntityState")(name="mbot")
        state.pose.position.x, state.pose.position.z = 2.0, 0.11
        response = await call_service(
            graph, server, "gazebo_msgs/srv/SetEntityState", "/world/set_entity_state", state=state
        )
        assert response.success
        response = await call_service(
            graph, server, "gazebo_msgs/srv/GetEntityState", "/world/get_entity_state", name="mbot"
        )
        assert response.state.pose.position.x == pytest.approx(2.0, abs=1e-3)
        response = await call_service(
            graph, server, "gazebo_msgs/srv/GetEntityState", "/world/get_entity_state", name="who"
        )
        assert not response.success
        state.name = "ground"
        response = await call_service(
            graph, server, "gazebo_msgs/srv/SetEntityState", "/world/set_entity_state", state=state
        )
        assert not response.success
        assert [record.text for record in log] == [
            "get_entity_state: there is no model or link 'who'",
            "set_entity_state: 'ground' is fixed to the world (delete it, and spawn it again at the intended pose)",
        ]


async def test_service_sets_joint_positions():
    horizontal_arm = arm_model("").replace("0 1 0", "0 0 1")
    kind, name = "gazebo_msgs/srv/SetModelConfiguration", "/world/set_joint_positions"
    async with running_server(horizontal_arm, STATE) as (server, graph, _):
        fields = {"model_name": "arm", "joint_names": ["shoulder"]}
        response = await call_service(graph, server, kind, name, joint_positions=[0.7], **fields)
        assert (response.success, response.status_message) == (True, "set_joint_positions: success")
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.7, abs=1e-6)
        response = await call_service(graph, server, kind, name, joint_positions=[0.7, 0.8], **fields)
        assert (response.success, "different lengths" in response.status_message) == (False, True)
        response = await call_service(graph, server, kind, name, model_name="legs")
        assert (response.success, response.status_message) == (False, "there is no model or link 'legs'")


async def test_services_return_properties_and_set_gravity():
    async with running_server(GROUND, arm_model(""), box("crate", "5 0 1 0 0 0", "1 1 1", 3.0), PROPERTIES) as (
        server,
        graph,
        log,
    ):
        response = await call_service(
            graph, server, "gazebo_msgs/srv/GetModelProperties", "/get_model_properties", model_name="arm"
        )
        assert (response.canonical_link_name, response.joint_names) == ("arm::link", ["shoulder"])
        kind = "gazebo_msgs/srv/GetLinkProperties"
        response = await call_service(graph, server, kind, "/get_link_properties", link_name="crate::link")
        assert (response.mass, response.ixx, response.gravity_mode) == (3.0, pytest.approx(0.5), True)
        kind = "gazebo_msgs/srv/GetJointProperties"
        response = await call_service(graph, server, kind, "/get_joint_properties", joint_name="arm::shoulder")
        assert (response.type, len(response.position), response.success) == (response.REVOLUTE, 1, True)
        kind = "gazebo_msgs/srv/SetPhysicsProperties"
        upward = get_message("geometry_msgs/msg/Vector3")(z=1.0)
        assert (await call_service(graph, server, kind, "/set_physics_properties", gravity=upward)).success
        response = await call_service(graph, server, "gazebo_msgs/srv/GetPhysicsProperties", "/get_physics_properties")
        assert (response.time_step, response.gravity.z) == (0.001, 1.0)
        speed = server.simulation.link_velocity("crate::link")[0][2]
        server.advance(SECOND_NS)
        assert server.simulation.link_velocity("crate::link")[0][2] - speed == pytest.approx(1.0, abs=1e-6)
        assert not log


async def test_services_change_link_and_joint_properties():
    crate = box("crate", "5 0 1 0 0 0", "1 1 1", 3.0)
    async with running_server(GROUND, arm_model(""), crate, PROPERTIES) as (server, graph, log):
        kind = "gazebo_msgs/srv/SetLinkProperties"
        facts = {"mass": 6.0, "ixx": 1.0, "iyy": 1.0, "izz": 1.0, "gravity_mode": False, "link_name": "crate::link"}
        assert (await call_service(graph, server, kind, "/set_link_properties", **facts)).success
        response = await call_service(
            graph, server, "gazebo_msgs/srv/GetLinkProperties", "/get_link_properties", link_name="crate::link"
        )
        assert (response.mass, response.izz, response.gravity_mode) == (6.0, pytest.approx(1.0), False)
        height = server.simulation.model_pose("crate")[2]
        server.advance(SECOND_NS // 10)
        assert server.simulation.model_pose("crate")[2] == pytest.approx(height)
        rejected = await call_service(graph, server, kind, "/set_link_properties", **(facts | {"ixx": 9.0}))
        assert (rejected.success, rejected.status_message) == (
            False,
            (
                "this mass or inertia is not physically possible; give a positive mass and moments that "
                "satisfy the triangle inequality"
            ),
        )

        config = get_message("gazebo_msgs/msg/ODEJointProperties")(damping=[2.0], hi_stop=[0.25])
        kind = "gazebo_msgs/srv/SetJointProperties"
        facts = {"joint_name": "arm::shoulder", "ode_joint_config": config}
        assert (await call_service(graph, server, kind, "/set_joint_properties", **facts)).success
        response = await call_service(
            graph, server, "gazebo_msgs/srv/GetJointProperties", "/get_joint_properties", joint_name="arm::shoulder"
        )
        assert list(response.damping) == [2.0]
        assert server.simulation.model.joint("arm::shoulder").range[1] == 0.25
        config = get_message("gazebo_msgs/msg/ODEJointProperties")(lo_stop=[0.0], hi_stop=[0.0])
        facts = {"joint_name": "arm::shoulder", "ode_joint_config": config}
        assert (await call_service(graph, server, kind, "/set_joint_properties", **facts)).success
        server.advance(SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.0, abs=0.01)
        assert not log


async def test_joint_pose_trajectory_jumps_between_points():
    plugin = '<plugin name="poses" filename="libgazebo_ros_joint_pose_trajectory.so"/>'
    async with running_server(arm_model(plugin).replace("0 1 0", "0 0 1")) as (server, graph, log):
        message = make_trajectory((1.0, 0.3), (1.0, 0.6), (0.0, 0.9))
        message.header.frame_id = "world"
        node = graph.create_node("planner")
        publisher = node.create_publisher("trajectory_msgs/msg/JointTrajectory", "/set_joint_trajectory", 1)
        publisher.publish(message)
        await graph.settle()
        positions = []
        for _ in range(3):
            server.advance(SECOND_NS // 2)
            positions.append(server.simulation.joint_state("arm::shoulder")[0])
            server.advance(SECOND_NS // 2)
        assert positions == pytest.approx([0.3, 0.6, 0.9], abs=1e-6)
        message.joint_names = ["elbow"]
        publisher.publish(message)
        await graph.settle()
        server.advance(SECOND_NS)
        assert [record.text for record in log] == ["plugin 'poses': there is no movable joint 'elbow'"]
