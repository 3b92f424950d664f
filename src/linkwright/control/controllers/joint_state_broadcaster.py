"""``joint_state_broadcaster/JointStateBroadcaster``, which publishes the states of joints.

Source: ros2_controllers (parameters, defaults, topics, NaN for missing states of a joint). Joints are in the order of
the hardware.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from linkwright.control.controllers.controller import Controller, InterfaceNames
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY, Interfaces, StateInterface
from linkwright.messages import Header, JointState, Time, get_message
from linkwright.nodes.parameter_tables import parameter


@dataclass(frozen=True, kw_only=True)
class InterfaceMap:
    """The names of the interfaces that fill the fields of joint states."""

    position: str = POSITION
    velocity: str = VELOCITY
    effort: str = EFFORT


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the broadcaster."""

    use_local_topics: bool = parameter(False, description="whether topics are in the namespace of the controller")
    joints: tuple[str, ...] = parameter((), description="the joints to publish, combined with interfaces")
    extra_joints: tuple[str, ...] = parameter((), description="additional joints, published with the value 0")
    interfaces: tuple[str, ...] = parameter((), description="the interfaces to publish, combined with joints")
    map_interface_to_joint_state: InterfaceMap = InterfaceMap()
    use_urdf_to_filter: bool = parameter(
        True, description="whether joint_states contains only joints of the robot's description"
    )
    frame_id: str = parameter("", description="the frame_id of joint_states")


class JointStateBroadcaster(Controller[Parameters]):
    """A broadcaster that publishes ``joint_states`` and ``dynamic_joint_states``."""

    PARAMETERS = Parameters

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces named by the parameters, or all interfaces if none is named."""
        joints, interfaces = self.parameters.joints, self.parameters.interfaces
        if not joints or not interfaces:
            return Interfaces.ALL
        return [f"{joint}/{interface}" for joint in joints for interface in interfaces]

    def on_configure(self) -> None:
        """Create the publishers."""
        prefix = "~/" if self.parameters.use_local_topics else ""
        self._output = self.node.publisher("sensor_msgs/msg/JointState", f"{prefix}joint_states")
        self._dynamic_output = self.node.publisher(
            "control_msgs/msg/DynamicJointState", f"{prefix}dynamic_joint_states"
        )

    def on_activate(self) -> None:
        """Assign the state interfaces to joints and message fields."""
        interface_map = self.parameters.map_interface_to_joint_state
        fields = {interface_map.position: 0, interface_map.velocity: 1, interface_map.effort: 2}
        self._states_by_joint: dict[str, dict[str, StateInterface]] = {}
        joints: dict[str, list[StateInterface | None]] = {}
        robot_joints = self._list_robot_joints()
        for state in self.states:
            self._states_by_joint.setdefault(state.component, {})[state.kind] = state
            if state.kind in fields and (robot_joints is None or state.component in robot_joints):
                joints.setdefault(state.component, [None, None, None])[fields[state.kind]] = state
        self._extra = [extra_joint for extra_joint in self.parameters.extra_joints if extra_joint not in joints]
        self._names = [*joints, *self._extra]
        unknown_state, zero_state = StateInterface("", ""), StateInterface("", "", 0.0)
        columns = [
            [
                *(joint_states[field_index] or unknown_state for joint_states in joints.values()),
                *(zero_state for _ in self._extra),
            ]
            for field_index in range(3)
        ]
        # A field that no joint provides, often the efforts, is the same in each message, so its values are computed
        # only once.
        self._columns = [
            (column, _to_array(column) if {unknown_state, zero_state}.issuperset(column) else None)
            for column in columns
        ]

    def update(self, time_ns: int, period_s: float) -> None:
        """Publish to the topics that have subscriptions."""
        if self._output.is_wanted:
            self._output.publish(self._build_joint_states(self._build_header(time_ns)))
        if self._dynamic_output.is_wanted:
            self._dynamic_output.publish(self._build_dynamic_states(self._build_header(time_ns)))

    def _list_robot_joints(self) -> set[str] | None:
        if not self.parameters.use_urdf_to_filter or self.parameters.joints:
            return None
        return set(self.robot.joints) if self.robot is not None else None

    def _build_header(self, time_ns: int) -> Header:
        return Header(stamp=Time.from_nanoseconds(time_ns), frame_id=self.parameters.frame_id)

    def _build_joint_states(self, header: Header) -> JointState:
        position, velocity, effort = (
            _to_array(column) if fixed_values is None else fixed_values[:] for column, fixed_values in self._columns
        )
        return JointState(header=header, name=[*self._names], position=position, velocity=velocity, effort=effort)

    def _build_dynamic_states(self, header: Header) -> object:
        value_type = get_message("control_msgs/msg/InterfaceValue")
        interface_values = [
            value_type(interface_names=list(states), values=[state.value for state in states.values()])
            for states in self._states_by_joint.values()
        ] + [value_type(interface_names=[POSITION, VELOCITY, EFFORT], values=[0.0, 0.0, 0.0]) for _ in self._extra]
        names: Sequence[str] = [*self._states_by_joint, *self._extra]
        return get_message("control_msgs/msg/DynamicJointState")(
            header=header, joint_names=list(names), interface_values=interface_values
        )


def _to_array(states: Sequence[StateInterface]) -> array[float]:
    """Return the values of states as an array for a message field.

    An array is faster than a list, because the message checks each element of a list.
    """
    return array("d", [state.value for state in states])
