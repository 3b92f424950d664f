"""`ros2_control_node`: its services, topics, descriptions and update cycles."""

from __future__ import annotations

import pytest

from linkwright.control.nodes.ros2_control_node import Ros2ControlNode
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import String, get_service
from linkwright.nodes.options import NodeOptions
from tests.control.robots import joint, robot

CONTROL = robot(joint("hip", initial="0.5") + joint("knee"))
PARAMETER_FILE = """
controller_manager:
  ros__parameters:
    update_rate: 100
    broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    positions: {type: forward_command_controller/ForwardCommandController}
positions:
  ros__parameters:
    joints: [hip, knee]
    interface_name: position
"""


def start_manager_node(graph, tmp_path, text=None, **parameters):
    path = tmp_path / "controllers.yaml"
    path.write_text(PARAMETER_FILE)
    words = ["--ros-args", "--params-file", str(path), "-r", "/positions/commands:=/wanted"]
    if text is not None:
        parameters["robot_description"] = text
    return Ros2ControlNode(graph, NodeOptions(parameters=parameters, arguments=words, library=DescriptionLibrary()))


async def call_service(graph, node, service, **fields):
    service_type = get_service(
        "controller_manager_msgs/srv/" + "".join(part.capitalize() for part in service.split("_"))
    )
    client = node.create_client(service_type, f"/controller_manager/{service}")
    future = client.call_async(service_type.Request(**fields))
    await graph.settle()
    return future.result()


async def advance(graph, clock, count):
    for _ in range(count):
        await clock.advance(0.01)
        await graph.settle()


async def test_controllers_are_managed_by_services_and_topics(graph, clock, tmp_path, logged):
    node_under_test = start_manager_node(graph, tmp_path, CONTROL)
    node = graph.create_node("test_node")
    states, activity = [], []
    node.create_subscription("sensor_msgs/msg/JointState", "/joint_states", states.append, 10)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(
        "controller_manager_msgs/msg/ControllerManagerActivity",
        "/controller_manager/activity",
        activity.append,
        latched,
    )
    await graph.settle()
    for name in ("broadcaster", "positions"):
        assert (await call_service(graph, node, "load_controller", name=name)).ok
        assert (await call_service(graph, node, "configure_controller", name=name)).ok
    response = await call_service(
        graph, node, "switch_controller", activate_controllers=["broadcaster", "positions"], strictness=2
    )
    assert response.ok, response.message
    await advance(graph, clock, 2)
    assert list(states[-1].position) == [0.5, 0.0]
    controllers = (await call_service(graph, node, "list_controllers")).controller
    assert [(controller.name, controller.state, list(controller.claimed_interfaces)) for controller in controllers] == [
        ("broadcaster", "active", []),
        ("positions", "active", ["hip/position", "knee/position"]),
    ]
    assert [controller.state.label for controller in activity[-1].controllers] == ["active", "active"]
    components = (await call_service(graph, node, "list_hardware_components")).component
    assert [(component.name, component.plugin_name, component.state.label) for component in components] == [
        ("arm", "mock_components/GenericSystem", "active")
    ]
    interfaces = await call_service(graph, node, "list_hardware_interfaces")
    assert [
        (command_interface.name, command_interface.is_claimed) for command_interface in interfaces.command_interfaces
    ] == [
        ("hip/position", True),
        ("knee/position", True),
    ]
    assert len((await call_service(graph, node, "list_controller_types")).types) >= 6
    assert (await call_service(graph, node, "reload_controller_libraries", force_kill=True)).ok
    assert (await call_service(graph, node, "list_controllers")).controller == []
    node_under_test.close()


async def test_process_remappings_apply_to_controllers(graph, clock, tmp_path):
    node_under_test = start_manager_node(graph, tmp_path, CONTROL)
    node = graph.create_node("test_node")
    states = []
    node.create_subscription("sensor_msgs/msg/JointState", "/joint_states", states.append, 10)
    publisher = node.create_publisher("std_msgs/msg/Float64MultiArray", "/wanted", 10)
    for name in ("broadcaster", "positions"):
        await call_service(graph, node, "load_controller", name=name)
        await call_service(graph, node, "configure_controller", name=name)
    await call_service(
        graph, node, "switch_controller", activate_controllers=["broadcaster", "positions"], strictness=2
    )
    publisher.publish(publisher.msg_type(data=[1.0, -1.0]))
    await advance(graph, clock, 3)
    assert list(states[-1].position) == [1.0, -1.0]
    node_under_test.close()


async def test_description_is_received_from_topic(graph, clock, tmp_path, logged):
    node_under_test = start_manager_node(graph, tmp_path)
    node = graph.create_node("test_node")
    node.create_publisher(String, "/robot_description", DESCRIPTION_QOS).publish(String(data=CONTROL))
    await graph.settle()
    components = (await call_service(graph, node, "list_hardware_components")).component
    assert [component.name for component in components] == ["arm"]
    set_state = await call_service(graph, node, "set_hardware_component_state", name="nobody")
    assert not set_state.ok
    assert logged("ERROR") == ["hardware component with name 'nobody' does not exist"]
    node_under_test.close()


async def test_malformed_description_is_reported_and_next_one_used(graph, clock, tmp_path, logged):
    node_under_test = start_manager_node(graph, tmp_path)
    publisher = graph.create_node("test_node").create_publisher(String, "/robot_description", DESCRIPTION_QOS)
    publisher.publish(String(data="<robot"))
    await graph.settle()
    assert logged("ERROR")[0].startswith("The published robot description file (urdf) seems not to be genuine")
    publisher.publish(String(data=CONTROL))
    await graph.settle()
    assert list(node_under_test._manager.resources.components) == ["arm"]
    node_under_test.close()


def record_cycle_periods(node_under_test, during_cycle=lambda: None):
    """Return the periods in seconds of the manager's next cycles; each calls `during_cycle`."""
    periods, cycle = [], node_under_test._manager.cycle

    def count_cycle(time_ns, period_s):
        periods.append(period_s)
        cycle(time_ns, period_s)
        during_cycle()

    node_under_test._manager.cycle = count_cycle
    return periods


OVERRUN = (
    "Overrun detected! The controller manager missed its desired rate of 100 Hz. The loop took 25.000000 ms "
    "(missed cycles : 1)."
)


@pytest.mark.parametrize(
    ("parameters", "expected_periods", "message"),
    [
        ({}, [0.025, 0.005, 0.01], [OVERRUN]),
        ({"overruns.print_warnings": False}, [0.025, 0.005, 0.01], []),
        ({"overruns.manage": False}, [0.025, 0.0, 0.005, 0.01], []),
    ],
)
async def test_missed_updates_are_skipped_with_warning_or_caught_up(
    graph, clock, tmp_path, logged, parameters, expected_periods, message
):
    node_under_test = start_manager_node(graph, tmp_path, CONTROL, **parameters)
    await graph.settle()
    warnings_before = logged("WARN")
    delays = iter([0.0, 0.025])
    periods = record_cycle_periods(
        node_under_test, lambda: clock._move_to(clock.steady_ns() + round(next(delays, 0.0) * 1e9))
    )
    await clock.advance(0.06)
    assert periods == [0.01, 0.01, *expected_periods]
    assert logged("WARN") == warnings_before + message
    node_under_test.close()


async def test_simulated_time_jump_is_not_an_overrun(graph, clock, tmp_path, logged):
    node_under_test = start_manager_node(graph, tmp_path, CONTROL, use_sim_time=True)
    await graph.settle()
    time = node_under_test._node.get_clock()
    time.set_simulated_time(1_000_000_000)
    await graph.settle()
    periods = record_cycle_periods(node_under_test)
    count_before = len(logged("WARN"))
    for now_ns in (1_010_000_000, 1_050_000_000, 20_000_000, 30_000_000, 40_000_000):
        time.set_simulated_time(now_ns)
        await graph.settle()
    assert periods == [0.01, 0.04, 0.01, 0.01]
    assert logged("WARN")[count_before:] == []
    time.set_ros_time_is_active(False)
    await clock.advance(0.01)
    assert periods[4:] == [0.01]
    node_under_test.close()


@pytest.mark.parametrize(
    "plugin", ["gazebo_ros2_control/GazeboSystem", "gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"]
)
async def test_simulator_hardware_is_left_to_simulator(graph, tmp_path, logged, plugin):
    start_manager_node(graph, tmp_path, CONTROL.replace("mock_components/GenericSystem", plugin))
    await graph.settle()
    assert [line for line in logged("ERROR") if plugin in line]
    services = graph.create_node("test_node").get_service_names_and_types()
    assert not [name for name, _ in services if name.endswith("/list_controllers")]
