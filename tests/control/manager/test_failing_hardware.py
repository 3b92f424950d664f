"""A user's hardware that fails while controllers run.

The tests cover which controllers stop, which continue, and the recovery.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from linkwright.control.hardware.component import Hardware, HardwareError
from linkwright.control.nodes.ros2_control_node import Ros2ControlNode
from linkwright.descriptions import DescriptionLibrary
from linkwright.loading import extensions
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions
from tests.control.manager.test_ros2_control_node import advance, call_service
from tests.control.robots import joint, robot

State = get_message("lifecycle_msgs/msg/State")
PARAMETER_FILE = """
controller_manager:
  ros__parameters:
    update_rate: 100
    hips: {type: forward_command_controller/ForwardCommandController}
    knees: {type: forward_command_controller/ForwardCommandController}
hips: {ros__parameters: {joints: [hip], interface_name: velocity}}
knees: {ros__parameters: {joints: [knee], interface_name: velocity}}
"""
DESCRIPTION = (
    robot(joint("hip", "velocity", "velocity"))
    .replace("mock_components/GenericSystem", "my_robot/Arm")
    .replace(
        "</robot>",
        "<ros2_control name='leg' type='system'><hardware><plugin>mock_components/GenericSystem</plugin></hardware>"
        f"{joint('knee', 'velocity', 'velocity')}</ros2_control></robot>",
    )
)


class Arm(Hardware):
    """An arm as in a user's package; its cable can be unplugged."""

    fault: Exception | None = None
    life: tuple[str, ...] = ()
    sent: float = 0.0

    def on_activate(self) -> None:
        type(self).life += ("on",)

    def on_error(self) -> None:
        type(self).life += ("error",)

    def read(self, time_ns: int, period_s: float) -> None:
        if self.fault is not None:
            raise self.fault

    def write(self, time_ns: int, period_s: float) -> None:
        type(self).sent = self.commands[0].value


@pytest.fixture
def arm(tmp_path, monkeypatch) -> Iterator[type[Arm]]:
    """Install the hardware's package."""
    metadata = tmp_path / "my_robot-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my_robot\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[linkwright.hardware]\nmy_robot/Arm = {__name__}:Arm\n")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("fault", "life", "sent"):
        monkeypatch.setattr(Arm, name, getattr(Arm, name))
    extensions._read_all_groups.cache_clear()
    yield Arm
    extensions._read_all_groups.cache_clear()


@pytest.mark.parametrize("fault", [HardwareError("the cable is out"), OSError("the cable is out")])
async def test_failed_hardware_stops_its_controllers_and_can_be_reactivated(graph, clock, tmp_path, logged, arm, fault):
    path = tmp_path / "controllers.yaml"
    path.write_text(PARAMETER_FILE)
    words = ["--ros-args", "--params-file", str(path)]
    options = NodeOptions(parameters={"robot_description": DESCRIPTION}, arguments=words, library=DescriptionLibrary())
    node_under_test = Ros2ControlNode(graph, options)
    node = graph.create_node("test_node")
    for name in ("hips", "knees"):
        assert (await call_service(graph, node, "load_controller", name=name)).ok
        assert (await call_service(graph, node, "configure_controller", name=name)).ok
    assert (
        await call_service(graph, node, "switch_controller", activate_controllers=["hips", "knees"], strictness=2)
    ).ok
    array = get_message("std_msgs/msg/Float64MultiArray")
    publishers = {name: node.create_publisher(array, f"/{name}/commands", 10) for name in ("hips", "knees")}
    for publisher in publishers.values():
        publisher.publish(array(data=[2.0]))
    await advance(graph, clock, 3)
    assert arm.sent == 2.0

    arm.fault = fault
    await advance(graph, clock, 3)
    controllers = (await call_service(graph, node, "list_controllers")).controller
    assert {controller.name: controller.state for controller in controllers} == {"hips": "inactive", "knees": "active"}
    components = (await call_service(graph, node, "list_hardware_components")).component
    assert {component.name: component.state.label for component in components} == {
        "arm": "unconfigured",
        "leg": "active",
    }
    assert arm.life == ("on", "error")
    first, second = logged("ERROR")
    assert first.startswith("Error while reading hardware 'arm': ")
    assert first.endswith("the cable is out")
    assert second == ("Deactivating controllers : [ hips ] as their hardware components failed: [ arm ]")
    publishers["knees"].publish(array(data=[3.0]))
    await advance(graph, clock, 2)
    leg = node_under_test._manager.resources.components["leg"]
    assert [command.value for command in leg.commands] == [3.0]

    response = await call_service(graph, node, "switch_controller", activate_controllers=["hips"], strictness=2)
    assert not response.ok
    arm.fault = None
    set_state = {"name": "arm", "target_state": State(id=0, label="active")}
    assert (await call_service(graph, node, "set_hardware_component_state", **set_state)).ok
    assert (await call_service(graph, node, "switch_controller", activate_controllers=["hips"], strictness=2)).ok
    publishers["hips"].publish(array(data=[1.0]))
    await advance(graph, clock, 3)
    assert (arm.sent, arm.life) == (1.0, ("on", "error", "on"))
