"""``admittance_controller/AdmittanceController``: an arm that yields to the forces on its tool.

Source: ros2_controllers (parameters, topics, references, and the treatment of unknown values). The equation of the
motion is in `linkwright.control.motion.admittance`. The kinematics follow from the robot description, not a plugin.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, isnan, nan
from typing import Any

import numpy as np

from linkwright.control.controllers.admittance_parameters import AdmittanceParameters
from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.hardware.interfaces import ACCELERATION, POSITION, VELOCITY
from linkwright.control.motion.admittance import Admittance
from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.arrays import Array, quaternion_from_matrix
from linkwright.kinematics.chain import KinematicChain
from linkwright.messages import (
    Header,
    JointState,
    Quaternion,
    Time,
    Transform,
    TransformStamped,
    Vector3,
    from_values,
    get_message,
)

_WRENCH_INTERFACES = tuple(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz")


class AdmittanceController(Controller[AdmittanceParameters]):
    """A controller that adds the displacement by measured forces to the references of an arm."""

    PARAMETERS = AdmittanceParameters

    # --- interfaces ---------------------------------------------------------------------------------------------------

    def command_interfaces(self) -> InterfaceNames:
        """Return the command interfaces, kind by kind."""
        parameters = self.parameters
        joints = parameters.command_joints or parameters.joints
        return [f"{joint}/{kind}" for kind in parameters.command_interfaces for joint in joints]

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the joints, kind by kind, and those of the sensor."""
        parameters = self.parameters
        joint_states = [f"{joint}/{kind}" for kind in parameters.state_interfaces for joint in parameters.joints]
        return [*joint_states, *(f"{parameters.ft_sensor.name}/{kind}" for kind in _WRENCH_INTERFACES)]

    def reference_interfaces(self) -> Sequence[str]:
        """Return the references, kind by kind."""
        parameters = self.parameters
        return [f"{joint}/{kind}" for kind in parameters.chainable_command_interfaces for joint in parameters.joints]

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def on_configure(self) -> None:
        """Read the chain of the arm, and create the topics.

        Raises:
            ControllerError: the description does not have the chain, a frame is not part of it, or the parameters
                contradict each other.
        """
        parameters = self.parameters
        if parameters.command_joints and len(parameters.command_joints) != len(parameters.joints):
            raise ControllerError("'command_joints' parameter has to have the same size as 'joints' parameter.")
        if POSITION not in parameters.state_interfaces:
            raise ControllerError("Position state interface is required.")
        self._chain = self._read_chain()
        self._order = [parameters.joints.index(name) for name in self._chain.joint_names]
        self._admittance = Admittance(self._chain)
        self._settings = parameters.settings
        self._wrench_reference = np.zeros(6)
        self.node.subscribe("trajectory_msgs/msg/JointTrajectoryPoint", "~/joint_references", self._on_joint_references)
        self.node.subscribe("geometry_msgs/msg/WrenchStamped", "~/wrench_reference", self._on_wrench_reference)
        self._output = self.node.publisher("control_msgs/msg/AdmittanceControllerState", "~/status")

    def _read_chain(self) -> KinematicChain:
        parameters, robot = self.parameters, self.robot
        if robot is None:
            raise ControllerError(
                phrase("the controller needs the kinematics of the robot, but there is no valid robot_description")
            )
        try:
            chain = KinematicChain(robot, parameters.kinematics.base, parameters.kinematics.tip)
        except LinkwrightError as error:
            raise ControllerError(error.diagnostics[0].message) from None
        if set(chain.joint_names) != set(parameters.joints):
            message = phrase(
                "the joints from '{base}' to '{tip}' are {chain_joints}, but the parameter 'joints' has {joints}",
                base=parameters.kinematics.base,
                tip=parameters.kinematics.tip,
                chain_joints=", ".join(chain.joint_names),
                joints=", ".join(parameters.joints),
            )
            raise ControllerError(message)
        for name, link in parameters.frames.items():
            if link not in chain.links:
                message = phrase(
                    "link '{link}' ({parameter}) is not part of the chain: {links}",
                    link=link,
                    parameter=name,
                    links=", ".join(chain.links),
                )
                raise ControllerError(message)
        return chain

    def on_activate(self) -> None:
        """Hold the arm at its position, until references or forces arrive.

        Raises:
            ControllerError: a position is not known.
        """
        self._settings = self.parameters.settings
        self._admittance.reset()
        self._wrench_reference = np.zeros(6)
        count = len(self.parameters.joints)
        self._last_commands: dict[str, Array] = {
            POSITION: np.full(count, nan),
            VELOCITY: np.zeros(count),
            ACCELERATION: np.zeros(count),
        }
        self._last_references = {kind: self._read_joints(kind) for kind in (POSITION, VELOCITY)}
        if np.isnan(self._last_references[POSITION]).any():
            raise ControllerError("Failed to read joint positions from the hardware.")
        self._joint_references: Any = None
        for reference in self.references:
            reference.value = nan

    def on_deactivate(self) -> None:
        """Forget the references and the wrench."""
        for reference in self.references:
            reference.value = nan
        self._admittance.reset()

    # --- updates ------------------------------------------------------------------------------------------------------

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the latest message on ``~/joint_references`` into the references."""
        message = self._joint_references
        if message is None:
            return
        given = {POSITION: message.positions, VELOCITY: message.velocities}
        for kind in self.parameters.chainable_command_interfaces:
            for reference, value in zip(self._references_of(kind), given[kind], strict=False):
                reference.value = float(value)

    def update(self, time_ns: int, period_s: float) -> None:
        """Compute the displacement by the wrench, and command the displaced references."""
        if self.parameters.enable_parameter_update_without_reactivation:
            self._settings = self.parameters.settings
        references = self._read_references()
        positions = self._read_joints(POSITION)
        order = self._order
        self._admittance.step(
            self._settings,
            self._read_wrench() + self._wrench_reference,
            positions[order],
            references[POSITION][order],
            period_s,
        )
        self._write_commands(references)
        if self._output.is_wanted:
            self._publish(time_ns)

    def _read_joints(self, kind: str) -> Array:
        """Return the measured values of the joints, or the last commands if one is unknown or is not measured."""
        parameters = self.parameters
        if kind not in parameters.state_interfaces:
            return self._last_commands[kind]
        count = len(parameters.joints)
        first = parameters.state_interfaces.index(kind) * count
        values = np.array([state.value for state in self.states[first : first + count]])
        return self._last_commands[kind] if np.isnan(values).any() else values

    def _read_wrench(self) -> Array:
        """Return the measured force and torque, or zeros if a value is unknown."""
        wrench = np.array([state.value for state in self.states[-len(_WRENCH_INTERFACES) :]])
        return np.zeros(6) if np.isnan(wrench).any() else wrench

    def _references_of(self, kind: str) -> Sequence[Any]:
        parameters = self.parameters
        count = len(parameters.joints)
        first = parameters.chainable_command_interfaces.index(kind) * count
        return self.references[first : first + count]

    def _read_references(self) -> dict[str, Array]:
        """Return the references; unknown ones are those of the last update."""
        for kind in self.parameters.chainable_command_interfaces:
            values = np.array([reference.value for reference in self._references_of(kind)])
            self._last_references[kind] = np.where(np.isnan(values), self._last_references[kind], values)
            for reference, value in zip(self._references_of(kind), self._last_references[kind], strict=True):
                if isnan(reference.value):
                    reference.value = float(value)
        return self._last_references

    def _write_commands(self, references: dict[str, Array]) -> None:
        state = self._admittance.state
        displacements = {POSITION: state.positions, VELOCITY: state.velocities, ACCELERATION: state.accelerations}
        count = len(self._order)
        for kind, displacement in displacements.items():
            commands = np.zeros(count) if kind == ACCELERATION else references[kind].copy()
            commands[self._order] += displacement
            self._last_commands[kind] = commands
        for index, kind in enumerate(self.parameters.command_interfaces):
            if kind in self._last_commands:
                for command, value in zip(
                    self.commands[index * count : (index + 1) * count], self._last_commands[kind], strict=True
                ):
                    command.value = float(value)

    # --- topics -------------------------------------------------------------------------------------------------------

    def _on_joint_references(self, message: Any) -> None:
        self._joint_references = message

    def _on_wrench_reference(self, message: Any) -> None:
        frame, expected_frame = message.header.frame_id, self.parameters.ft_sensor.frame.id
        if frame not in ("", expected_frame):
            self.node.logger.error(
                f"Ignoring wrench reference as it is on the wrong frame: {frame}. Expected reference frame: "
                f"{expected_frame}"
            )
            return
        wrench = message.wrench
        values = [getattr(vector, axis) for vector in (wrench.force, wrench.torque) for axis in "xyz"]
        if all(map(isfinite, values)):
            self._wrench_reference = np.array(values)

    def _publish(self, time_ns: int) -> None:
        state, settings, parameters = self._admittance.state, self._settings, self.parameters
        message = get_message("control_msgs/msg/AdmittanceControllerState")()
        header = Header(stamp=Time.from_nanoseconds(time_ns), frame_id=parameters.kinematics.base)
        message.mass.data = settings.mass.tolist()
        message.damping.data = settings.damping.tolist()
        message.stiffness.data = settings.stiffness.tolist()
        message.selected_axes.data = [int(axis) for axis in settings.selected_axes]
        message.ft_sensor_frame.data = settings.sensor_frame
        message.rot_base_control = _to_quaternion(state.control_rotation)
        message.ref_trans_base_ft = TransformStamped(
            header=header, child_frame_id=settings.sensor_frame, transform=_to_transform(state.reference_frame)
        )
        displacement = np.eye(4)
        displacement[:3, :3], displacement[:3, 3] = state.rotation, state.displacement[:3]
        message.admittance_position = TransformStamped(
            header=header, child_frame_id="admittance_offset", transform=_to_transform(displacement)
        )
        for name, value in (("velocity", state.velocity), ("acceleration", state.acceleration)):
            stamped = getattr(message, f"admittance_{name}")
            stamped.header = header
            stamped.twist.linear, stamped.twist.angular = _to_vectors(value)
        message.wrench_base.header = header
        message.wrench_base.wrench.force, message.wrench_base.wrench.torque = _to_vectors(state.wrench)
        message.joint_state = JointState(
            header=header,
            name=list(self._chain.joint_names),
            position=state.positions.tolist(),
            velocity=state.velocities.tolist(),
            effort=state.accelerations.tolist(),
        )
        self._output.publish(message)


def _to_vectors(values: Array) -> tuple[Any, Any]:
    return from_values(Vector3, values[:3].tolist()), from_values(Vector3, values[3:].tolist())


def _to_quaternion(rotation: Array) -> Any:
    return from_values(Quaternion, quaternion_from_matrix(rotation).tolist())


def _to_transform(frame: Array) -> Any:
    return Transform(translation=from_values(Vector3, frame[:3, 3].tolist()), rotation=_to_quaternion(frame[:3, :3]))
