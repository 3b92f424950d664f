"""ros_control of ROS 1 for simulated robots: ``libgazebo_ros_control.so``.

The plugin runs the controllers of ROS 2 for a robot whose URDF has ``<transmission>`` elements.

Source: gazebo_ros_control's plugin and its ``DefaultRobotHWSim`` (parameters, gains, limits, emergency stop). Files of
parameters take the place of the parameter server: node ``gazebo_ros_control`` has the gains.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from linkwright.control.hardware.description import ComponentDescription, HardwareDescription, MimicDescription
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.control.hardware.transmissions import hardware_from_transmissions
from linkwright.control.motion.pid import PidGains
from linkwright.diagnostics import Diagnostic, phrase
from linkwright.graph import Logger, Node
from linkwright.graph.names.rules import join
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.ros2_control.classic_gains import parse_gains, read_gains
from linkwright.simulation.plugins.ros2_control.hardware import SimulatedSystem
from linkwright.simulation.plugins.ros2_control.plugin import ManagerParameters, SimulatedManager
from linkwright.simulation.scene.structure import PlacedJoint
from linkwright.urdf import Robot

_DEFAULT_SIMULATOR = "DefaultRobotHWSim"


@dataclass(frozen=True, kw_only=True)
class ClassicParameters(ManagerParameters):
    """Parameters of ``libgazebo_ros_control.so``."""

    robot_param: str = parameter("robot_description", aliases=("robotParam",))
    robot_sim_type: str = parameter(f"gazebo_ros_control/{_DEFAULT_SIMULATOR}", aliases=("robotSimType",))
    control_period: float | None = parameter(None, aliases=("controlPeriod",))
    e_stop_topic: str = parameter("", aliases=("eStopTopic",))
    legacy_mode_ns: bool = parameter(True, aliases=("legacyModeNS",))


class ClassicSystem(SimulatedSystem):
    """The joints of a robot's transmissions as hardware.

    Attributes:
        is_stopped: whether the emergency stop is active: positions are held, velocities and efforts are 0.
    """

    is_stopped = False

    def _split_gains(
        self, description: HardwareDescription, values: Mapping[str, Any], logger: Logger
    ) -> tuple[HardwareDescription, Mapping[tuple[str, str], PidGains]]:
        gains = {}
        for joint in description.joints:
            kind = joint.commands[0].name
            joint_gains = parse_gains(joint.name, values, logger) if kind != EFFORT else None
            if joint_gains is not None:
                gains[joint.name, kind] = joint_gains
        return description, gains

    def _may_hold(self, joint: ComponentDescription, placed_joint: PlacedJoint) -> bool:
        """Return whether a joint holds its position while it has no command.

        A deliberate difference: wheels without a controller roll, so that another plugin can drive them.
        """
        kind = joint.commands[0].name
        return kind != EFFORT and not (kind == VELOCITY and placed_joint.is_continuous)

    def stop(self, *, active: bool) -> None:
        """Switch the emergency stop on or off."""
        if active and not self.is_stopped:
            self._held_positions = {state.component: state.value for state in self.states if state.kind == POSITION}
        self.is_stopped = active

    def write(self, time_ns: int, period_s: float) -> None:
        """Apply the commands to the joints, or those of the emergency stop."""
        if self.is_stopped:
            for command in self.commands:
                command.value = self._held_positions[command.component] if command.kind == POSITION else 0.0
        super().write(time_ns, period_s)


class ClassicControl(SimulatedManager[ClassicParameters]):
    """The substitute for ``libgazebo_ros_control.so``."""

    PARAMETERS = ClassicParameters
    ENFORCES_LIMITS = True

    def start(self) -> None:
        """Create the controller manager, and report what replaces the plugin in ROS 2."""
        super().start()
        parameters = self.parameters
        logger = self.node.logger
        logger.warning(
            phrase(
                "libgazebo_ros_control.so is a plugin of ROS 1, which Gazebo cannot load with ROS 2: for ROS 2, use "
                "libgazebo_ros2_control.so, and write <ros2_control> instead of <transmission>"
            )
        )
        if parameters.robot_sim_type.rpartition("/")[2] != _DEFAULT_SIMULATOR:
            logger.warning(
                phrase(
                    "the robot simulator '{name}' is not available; {default} is used",
                    name=parameters.robot_sim_type,
                    default=_DEFAULT_SIMULATOR,
                )
            )
        step = self.simulation.step / NANOSECONDS_PER_SECOND
        if parameters.control_period is not None and parameters.control_period < step:
            logger.warning(
                phrase(
                    "the control period of {period:g} s is shorter than the step of the simulation, so controllers are "
                    "updated every {step:g} s",
                    period=parameters.control_period,
                    step=step,
                )
            )
        if parameters.e_stop_topic:
            self.node.subscribe("std_msgs/msg/Bool", parameters.e_stop_topic, self._on_emergency_stop)

    def _read_hardware(self, robot: Robot) -> tuple[list[HardwareDescription], list[Diagnostic]]:
        """Return the hardware of the transmissions.

        Joints that a mimic joint plugin moves follow their leaders.
        """
        hardware, findings = hardware_from_transmissions(robot)
        leaders = self._find_leaders()
        return [
            replace(
                system,
                joints=tuple(
                    replace(joint, mimic=joint.mimic or MimicDescription(leaders[joint.name]))
                    if joint.name in leaders
                    else joint
                    for joint in system.joints
                ),
            )
            for system in hardware
        ], findings

    def _find_leaders(self) -> dict[str, str]:
        """Return the leader of each joint that a mimic joint plugin of the model moves."""
        elements = [plugin.element for plugin in self.context.model.plugins] if self.context.model is not None else []
        pairs = [(element.first("mimicJoint"), element.first("joint")) for element in elements if element is not None]
        return {
            follower.text().strip(): leader.text().strip()
            for follower, leader in pairs
            if follower is not None and leader is not None
        }

    def _compute_update_rate(self, values: dict[str, Any]) -> float:
        """Return the update rate in Hz.

        It is the rate of ``<controlPeriod>``, of the manager's parameter, or of the simulation's steps.
        """
        step_rate = NANOSECONDS_PER_SECOND / self.simulation.step
        period = self.parameters.control_period
        rate = float(values.get("update_rate", step_rate)) if period is None else 1.0 / max(period, 1.0 / step_rate)
        return min(rate, step_rate)

    def _list_description_topics(self, node: Node) -> Iterable[str]:
        """Return the topics named like ROS 1's parameter, in all enclosing namespaces."""
        return _search_outwards(node.get_namespace(), self.parameters.robot_param)

    def _create_system(self, description: HardwareDescription, logger: Logger) -> SimulatedSystem:
        namespace = "/" if self.parameters.legacy_mode_ns else self._manager_node.name.rpartition("/")[0]
        gains = read_gains(self.parameters.parameters, namespace)
        return ClassicSystem(description, logger, self, holds_position=True, values=gains)

    def _on_emergency_stop(self, message: Any) -> None:
        for system in self._systems:
            assert isinstance(system, ClassicSystem)
            system.stop(active=bool(message.data))


def _search_outwards(namespace: str, name: str) -> Iterator[str]:
    """Yield a name in a namespace, then in the enclosing namespaces.

    ROS 1 searches for parameters in this order.
    """
    if name.startswith("/"):
        yield name
        return
    while namespace.strip("/"):
        yield join(namespace, name)
        namespace = namespace.rpartition("/")[0]
    yield join("/", name)
