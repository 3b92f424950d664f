"""``pid_controller/PidController``: a PID controller for each degree of freedom.

Source: ros2_controllers (parameters, topics, service, interfaces for chaining, feed-forward).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.pid_parameters import PidParameters
from linkwright.control.hardware.interfaces import POSITION
from linkwright.control.motion.pid import Pid
from linkwright.control.motion.trajectory import shortest_turn
from linkwright.diagnostics import Phrase, phrase
from linkwright.graph.qos.profile import QoSProfile, ReliabilityPolicy
from linkwright.messages import Header, Time, get_message
from linkwright.nodes.parameter_tables import for_each, not_empty, parameter

_LATEST_MESSAGE_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def _check_interfaces(name: str, value: tuple[str, ...]) -> Phrase | None:
    """Return an error message unless a list contains one or two interfaces.

    The second interface is the derivative of the first.
    """
    if not 1 <= len(value) <= 2:
        return phrase("parameter '{name}' must contain one interface, or an interface and its derivative", name=name)
    return None


@dataclass(frozen=True, kw_only=True)
class Gains(PidParameters):
    """The PID gains of a degree of freedom."""

    feedforward_gain: float = parameter(0.0, description="the factor of the reference in the command")
    angle_wraparound: bool = parameter(False, description="whether the degree of freedom rotates without limits")
    save_i_term: bool = parameter(True, description="whether the integral is kept on activation")


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The parameters of a pid_controller."""

    dof_names: tuple[str, ...] = parameter((), read_only=True, description="the commanded joints", check=not_empty)
    reference_and_state_dof_names: tuple[str, ...] = parameter(
        (), read_only=True, description="the measured joints, if they differ"
    )
    command_interface: str = parameter("", read_only=True, description="the commanded interface", check=not_empty)
    reference_and_state_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the measured interfaces: a value and its derivative", check=_check_interfaces
    )
    use_external_measured_states: bool = parameter(False, description="whether states are received on ~/measured_state")
    set_current_state_as_first_setpoint: bool = parameter(
        False, read_only=True, description="whether the states are the references until others arrive"
    )
    enable_feedforward: bool = parameter(False, description="whether feedforward_gain applies at the start")
    gains: Mapping[str, Gains] = for_each("dof_names", Gains)

    @property
    def measured_dof_names(self) -> tuple[str, ...]:
        """The names of the degrees of freedom that provide states and references."""
        return self.reference_and_state_dof_names or self.dof_names


class PidController(Controller[Parameters]):
    """A PID controller with references from ``~/reference`` or from another controller."""

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """Return one command interface for each degree of freedom."""
        return [f"{dof_name}/{self.parameters.command_interface}" for dof_name in self.parameters.dof_names]

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces, kind by kind, or none if states are received on a topic."""
        return () if self.parameters.use_external_measured_states else self._list_interface_names()

    def reference_interfaces(self) -> Sequence[str]:
        """Return the names of the references, in the order of the states."""
        return self._list_interface_names()

    def exported_states(self) -> Sequence[str]:
        """Return the names of the exported states, in the order of the states."""
        return self._list_interface_names()

    def _list_interface_names(self) -> list[str]:
        parameters = self.parameters
        return [
            f"{name}/{kind}"
            for kind in parameters.reference_and_state_interfaces
            for name in parameters.measured_dof_names
        ]

    def on_configure(self) -> None:
        """Create the publisher, the subscriptions and the service.

        Raises:
            ControllerError: the two lists of degrees of freedom differ in length.
        """
        parameters = self.parameters
        if len(parameters.measured_dof_names) != len(parameters.dof_names):
            raise ControllerError(
                f"Size of 'dof_names' ({len(parameters.dof_names)}) and 'reference_and_state_dof_names' "
                f"({len(parameters.measured_dof_names)}) parameters has to be the same!"
            )
        self._pids = [Pid(parameters.gains[dof_name].pid) for dof_name in parameters.dof_names]
        self._uses_feedforward = parameters.enable_feedforward
        self._output = self.node.publisher("control_msgs/msg/MultiDOFStateStamped", "~/controller_state")
        self._state_type = get_message("control_msgs/msg/SingleDOFState")
        self.node.subscribe("control_msgs/msg/MultiDOFCommand", "~/reference", self._on_reference, _LATEST_MESSAGE_QOS)
        if parameters.use_external_measured_states:
            self.node.subscribe(
                "control_msgs/msg/MultiDOFCommand", "~/measured_state", self._on_measured_state, _LATEST_MESSAGE_QOS
            )
        self.node.service("std_srvs/srv/SetBool", "~/set_feedforward_control", self._on_set_feedforward)

    def on_activate(self) -> None:
        """Discard earlier references, and reset the integrals that are not kept."""
        self._measured_values = [state.value for state in self.states] or [nan] * len(self._list_interface_names())
        self._export_states()
        self._awaits_states = self.parameters.set_current_state_as_first_setpoint
        for reference in self.references:
            reference.value = nan
        for pid, gains in zip(self._pids, self.parameters.gains.values(), strict=True):
            if not gains.save_i_term:
                pid.reset()

    def on_deactivate(self) -> None:
        """Command 0, unless positions are commanded."""
        if self.parameters.command_interface != POSITION:
            for command in self.commands:
                command.value = 0.0

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the degrees of freedom whose references and states are known."""
        if self.states:
            self._measured_values = [state.value for state in self.states]
        self._export_states()
        if self._awaits_states and all(map(isfinite, self._measured_values)):
            self._set_first_references()
        for index, (name, pid, command) in enumerate(
            zip(self.parameters.dof_names, self._pids, self.commands, strict=True)
        ):
            gains = self.parameters.gains[name]
            if isfinite(self.references[index].value) and isfinite(self._measured_values[index]):
                command.value = self._compute_command(index, pid, gains, period_s)
        if self._output.is_wanted:
            self._publish(time_ns, period_s)

    def _set_first_references(self) -> None:
        """Make the states the references that have no value yet."""
        self._awaits_states = False
        for reference, value in zip(self.references, self._measured_values, strict=True):
            if not isfinite(reference.value):
                reference.value = value

    def _export_states(self) -> None:
        for exported, value in zip(self.exported, self._measured_values, strict=True):
            exported.value = value

    def _compute_command(self, index: int, pid: Pid, gains: Gains, period_s: float) -> float:
        pid.gains = gains.pid
        rate = self._compute_error_rate(index)
        reference = self._get_reference_rate(index) if self._has_rates else self.references[index].value
        feedforward = gains.feedforward_gain * reference if self._uses_feedforward and isfinite(reference) else 0.0
        return feedforward + pid.command(self._compute_error(index), period_s, rate if isfinite(rate) else None)

    @property
    def _has_rates(self) -> bool:
        return len(self.references) == 2 * len(self._pids)

    def _compute_error(self, index: int) -> float:
        reference, measured = self.references[index].value, self._measured_values[index]
        wraps_around = self.parameters.gains[self.parameters.dof_names[index]].angle_wraparound
        return shortest_turn(measured, reference) if wraps_around else reference - measured

    def _get_reference_rate(self, index: int) -> float:
        return self.references[len(self._pids) + index].value if self._has_rates else nan

    def _compute_error_rate(self, index: int) -> float:
        return (
            self._get_reference_rate(index) - self._measured_values[len(self._pids) + index] if self._has_rates else nan
        )

    # --- topics -------------------------------------------------------------------------------------------------------

    def _on_reference(self, message: Any) -> None:
        if self.is_chained or not self.references:
            return
        values = self._order_values(message)
        for reference, value in zip(self.references, values, strict=False):
            if isfinite(value):
                reference.value = value

    def _on_measured_state(self, message: Any) -> None:
        values = self._order_values(message)
        if values:
            self._measured_values = values

    def _order_values(self, message: Any) -> list[float]:
        """Return a message's values, and rates if used, in the order of the controller.

        Returns an empty list, and logs an error, if the message is invalid.
        """
        expected_names = list(self.parameters.measured_dof_names)
        names, values, rates = list(message.dof_names) or expected_names, list(message.values), list(message.values_dot)
        has_wrong_size = (
            len(names) != len(expected_names)
            or len(values) != len(expected_names)
            or (rates and len(rates) != len(expected_names))
        )
        if has_wrong_size:
            self.node.logger.error(
                f"Size of input data names ({len(names)}) and/or values ({len(values)}) is not matching the expected "
                f"size ({len(expected_names)})."
            )
            return []
        for name in expected_names:
            if name not in names:
                self.node.logger.error(f"DoF name '{name}' is not in the message: it has {', '.join(names)}.")
                return []
        indices = [names.index(name) for name in expected_names]
        ordered = [float(values[index]) for index in indices]
        if self._has_rates:
            ordered += [float(rates[index]) if rates else nan for index in indices]
        return ordered

    def _on_set_feedforward(self, request: Any, response: Any) -> Any:
        self._uses_feedforward = bool(request.data)
        response.success = True
        return response

    def _publish(self, time_ns: int, period_s: float) -> None:
        message = get_message("control_msgs/msg/MultiDOFStateStamped")
        states = []
        for index, name in enumerate(self.parameters.measured_dof_names):
            rate_index = len(self._pids) + index
            states.append(
                self._state_type(
                    name=name,
                    reference=self.references[index].value,
                    feedback=self._measured_values[index],
                    feedback_dot=self._measured_values[rate_index] if self._has_rates else nan,
                    error=self._compute_error(index),
                    error_dot=self._compute_error_rate(index),
                    time_step=period_s,
                    output=self.commands[index].value,
                )
            )
        self._output.publish(message(header=Header(stamp=Time.from_nanoseconds(time_ns)), dof_states=states))
