"""The joint state broadcaster: which interfaces it publishes, on which topics."""

from __future__ import annotations

from math import isnan

from linkwright.control.controllers.joint_state_broadcaster import JointStateBroadcaster
from linkwright.control.controllers.registry import controller_class

DESCRIPTION = """<robot name='r'><link name='a'/><link name='b'/><joint name='hip' type='continuous'>
<parent link='a'/><child link='b'/></joint></robot>"""


def test_controller_is_found_by_type():
    assert controller_class("joint_state_broadcaster/JointStateBroadcaster") is JointStateBroadcaster


async def test_missing_state_interfaces_are_nan(bench):
    bench.joint("hip", position=0.5, velocity=1.0)
    bench.joint("knee", position=-0.5, temperature=30.0)
    joint_states = bench.record("sensor_msgs/msg/JointState", "joint_states")
    dynamic = bench.record("control_msgs/msg/DynamicJointState", "dynamic_joint_states")
    await bench.step(bench.start(JointStateBroadcaster))
    (message,) = joint_states
    assert message.name == ["hip", "knee"]
    assert list(message.position) == [0.5, -0.5]
    assert message.velocity[0] == 1.0
    assert isnan(message.velocity[1])
    assert message.header.stamp.nanoseconds == 10_000_000
    assert dynamic[0].joint_names == ["hip", "knee"]
    assert dynamic[0].interface_values[1].interface_names == ["position", "temperature"]
    assert list(dynamic[0].interface_values[1].values) == [-0.5, 30.0]


async def test_missing_values_are_not_shared_between_messages(bench):
    bench.joint("hip", position=0.5)
    joint_states = bench.record("sensor_msgs/msg/JointState", "joint_states")
    broadcaster = bench.start(JointStateBroadcaster)
    await bench.step(broadcaster)
    joint_states[0].effort[0] = 7.0
    await bench.step(broadcaster)
    assert isnan(joint_states[1].effort[0])


async def test_only_described_and_extra_joints_are_published(bench):
    bench.joint("hip", position=0.5)
    bench.joint("imu", position=1.0)
    joint_states = bench.record("sensor_msgs/msg/JointState", "joint_states")
    await bench.step(bench.start(JointStateBroadcaster, description=DESCRIPTION, extra_joints=["gripper"]))
    assert joint_states[0].name == ["hip", "gripper"]
    assert list(joint_states[0].position) == [0.5, 0.0]


async def test_selected_interfaces_are_published_on_local_topics(bench):
    bench.joint("hip", position=0.5, velocity=1.0)
    bench.joint("knee", position=0.7, velocity=2.0)
    parameters = {"joints": ["knee"], "interfaces": ["velocity"], "use_local_topics": True}
    broadcaster = bench.start(JointStateBroadcaster, "jsb", **parameters)
    joint_states = bench.record("sensor_msgs/msg/JointState", "/jsb/joint_states")
    await bench.step(broadcaster)
    assert (joint_states[0].name, list(joint_states[0].velocity)) == (["knee"], [2.0])


async def test_state_interfaces_can_be_mapped(bench):
    bench.joint("hip", kinematic=0.5)
    joint_states = bench.record("sensor_msgs/msg/JointState", "joint_states")
    await bench.step(bench.start(JointStateBroadcaster, map_interface_to_joint_state={"position": "kinematic"}))
    assert list(joint_states[0].position) == [0.5]


async def test_unknown_parameter_is_reported(bench):
    bench.start(JointStateBroadcaster, joint=["hip"])
    (warning,) = [record.text for record in bench.log if "not a parameter" in record.text]
    assert warning == "'joint' is not a parameter of this controller; did you mean 'joints'?"
