"""``pid_controller/PidController``, which commands degrees of freedom by PID from their errors.

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
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_LATEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def _check_interfaces(name: str, value: tuple[str, ...]) -> Phrase | None:
    """Return an error message unless a list contains one interface, or one and its derivative."""
    if not 1 <= len(value) <= 2:
        return phrase("Parameter '{name}' must be one interface, or an interface and its derivative", name=name)
    return None


@dataclass(frozen=True, kw_only=True)
class Gains(PidParameters):
    """The PID gains of a degree of freedom."""

    feedforward_gain: float = parameter(0.0, description="how much of the reference is added to the command")
    angle_wraparound: bool = parameter(False, description="whether it turns without an end")
    save_i_term: bool = parameter(True, description="keep the integral when the controller is activated again")


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the controller."""

    dof_names: tuple[str, ...] = parameter(
        (), read_only=True, description="the joints that are commanded", check=not_empty
    )
    reference_and_state_dof_names: tuple[str, ...] = parameter(
        (), read_only=True, description="the measured joints, if they are other ones"
    )
    command_interface: str = parameter("", read_only=True, description="position, velocity or effort", check=not_empty)
    reference_and_state_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the measured values: position, velocity", check=_check_interfaces
    )
    use_external_measured_states: bool = parameter(False, description="states come from ~/measured_state")
    enable_feedforward: bool = parameter(False, description="whether feedforward_gain counts from the beginning")
    gains: Mapping[str, Gains] = for_each("dof_names", Gains)

    @property
    def measured(self) -> tuple[str, ...]:
        """The degrees of freedom whose states and references are used."""
        return self.reference_and_state_dof_names or self.dof_names


class PidController(Controller[Parameters]):
    """A PID controller, whose references come from ``~/reference`` or from another controller."""

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """Return one command interface for each degree of freedom."""
        return [f"{dof_name}/{self.parameters.command_interface}" for dof_name in self.parameters.dof_names]

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces, ordered by kind; none if states are received on a topic."""
        return () if self.parameters.use_external_measured_states else self._measured_names()

    def reference_interfaces(self) -> Sequence[str]:
        """Return the names of the references, in the order of the states."""
        return self._measured_names()

    def exported_states(self) -> Sequence[str]:
        """Return the names of the exported states, in the order of the states."""
        return self._measured_names()

    def _measured_names(self) -> list[str]:
        parameters = self.parameters
        return [f"{name}/{kind}" for kind in parameters.reference_and_state_interfaces for name in parameters.measured]

    def on_configure(self) -> None:
        """Create the topics and the service.

        Raises:
            ControllerError: the two lists of degrees of freedom differ in length.
        """
        parameters = self.parameters
        if len(parameters.measured) != len(parameters.dof_names):
            raise ControllerError(
                f"Size of 'dof_names' ({len(parameters.dof_names)}) and 'reference_and_state_dof_names' "
                f"({len(parameters.measured)}) parameters has to be the same!"
            )
        self._pids = [Pid(parameters.gains[dof_name].pid) for dof_name in parameters.dof_names]
        self._feeds_forward = parameters.enable_feedforward
        self._output = self.node.publisher("control_msgs/msg/MultiDOFStateStamped", "~/controller_state")
        self._state_message = get_message("control_msgs/msg/SingleDOFState")
        self.node.subscribe("control_msgs/msg/MultiDOFCommand", "~/reference", self._commanded, _LATEST)
        if parameters.use_external_measured_states:
            self.node.subscribe(
                "control_msgs/msg/MultiDOFCommand", "~/measured_state", self._measured_by_topic, _LATEST
            )
        self.node.service("std_srvs/srv/SetBool", "~/set_feedforward_control", self._set_feedforward)

    def on_activate(self) -> None:
        """Start without a reference."""
        self._measured = [state.value for state in self.states] or [nan] * len(self._measured_names())
        self._export()
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
            self._measured = [state.value for state in self.states]
        self._export()
        for number, (name, pid, command) in enumerate(
            zip(self.parameters.dof_names, self._pids, self.commands, strict=True)
        ):
            gains = self.parameters.gains[name]
            if isfinite(self.references[number].value) and isfinite(self._measured[number]):
                command.value = self._command(number, pid, gains, period_s)
        if self._output.is_wanted:
            self._publish(time_ns, period_s)

    def _export(self) -> None:
        for exported, value in zip(self.exported, self._measured, strict=True):
            exported.value = value

    def _command(self, number: int, pid: Pid, gains: Gains, period_s: float) -> float:
        pid.gains = gains.pid
        rate = self._error_rate(number)
        reference = self._reference_rate(number) if self._has_rates else self.references[number].value
        forward = gains.feedforward_gain * reference if self._feeds_forward and isfinite(reference) else 0.0
        return forward + pid.command(self._error(number), period_s, rate if isfinite(rate) else None)

    @property
    def _has_rates(self) -> bool:
        return len(self.references) == 2 * len(self._pids)

    def _error(self, number: int) -> float:
        wanted, there = self.references[number].value, self._measured[number]
        turns = self.parameters.gains[self.parameters.dof_names[number]].angle_wraparound
        return shortest_turn(there, wanted) if turns else wanted - there

    def _reference_rate(self, number: int) -> float:
        return self.references[len(self._pids) + number].value if self._has_rates else nan

    def _error_rate(self, number: int) -> float:
        return self._reference_rate(number) - self._measured[len(self._pids) + number] if self._has_rates else nan

    # --- topics -------------------------------------------------------------------------------------------------------

    def _commanded(self, message: Any) -> None:
        if self.chained or not self.references:
            return
        values = self._in_order(message)
        for reference, value in zip(self.references, values, strict=False):
            if isfinite(value):
                reference.value = value

    def _measured_by_topic(self, message: Any) -> None:
        values = self._in_order(message)
        if values:
            self._measured = values

    def _in_order(self, message: Any) -> list[float]:
        """Return a message's values, and rates if used, in the order of the controller.

        Returns an empty list, and logs an error, if the message is invalid.
        """
        known = list(self.parameters.measured)
        names, values, rates = list(message.dof_names) or known, list(message.values), list(message.values_dot)
        wrong = len(names) != len(known) or len(values) != len(known) or (rates and len(rates) != len(known))
        if wrong:
            self.node.logger.error(
                f"Size of input data names ({len(names)}) and/or values ({len(values)}) is not matching the expected "
                f"size ({len(known)})."
            )
            return []
        for name in known:
            if name not in names:
                self.node.logger.error(f"DoF name '{name}' is not in the message: it has {', '.join(names)}.")
                return []
        places = [names.index(name) for name in known]
        ordered = [float(values[place]) for place in places]
        if self._has_rates:
            ordered += [float(rates[place]) if rates else nan for place in places]
        return ordered

    def _set_feedforward(self, request: Any, response: Any) -> Any:
        self._feeds_forward = bool(request.data)
        response.success = True
        return response

    def _publish(self, time_ns: int, period_s: float) -> None:
        message = get_message("control_msgs/msg/MultiDOFStateStamped")
        states = []
        for number, name in enumerate(self.parameters.measured):
            rates = len(self._pids) + number
            states.append(
                self._state_message(
                    name=name,
                    reference=self.references[number].value,
                    feedback=self._measured[number],
                    feedback_dot=self._measured[rates] if self._has_rates else nan,
                    error=self._error(number),
                    error_dot=self._error_rate(number),
                    time_step=period_s,
                    output=self.commands[number].value,
                )
            )
        self._output.publish(message(Header(stamp=Time(*divmod(time_ns, NANOSECONDS_PER_SECOND))), states))
