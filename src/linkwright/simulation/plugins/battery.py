"""Batteries with a linear voltage curve: ``gz-sim-linearbatteryplugin-system``.

The open-circuit voltage is ``E0 + E1 (1 - q / c)``, with the charge q and the capacity c. The current of a load with
the power P is ``P / V``; it passes a low-pass filter, and the internal resistance reduces the voltage.

Source: gz-sim (parameters, defaults, topics, formulas). By default, gz lets the state of charge fall much faster than
the charge, which ``<fix_issue_225>`` ends; here this happens only with `gazebo_mistakes`. gz starts and stops charging
by services, which have no counterpart in ROS, and with ``<recharge_by_topic>`` also by topics; here by topics.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import nan
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph.qos.profile import SENSOR_DATA_QOS
from linkwright.messages import Header, get_message
from linkwright.messages.errors import InterfaceNotFoundError
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MESSAGE_TYPE = "sensor_msgs/msg/BatteryState"
_PUBLISH_RATE_HZ = 50.0
"""The rate of the state, in Hz, which gz does not exceed."""
_SEARCH_RATE_HZ = 10.0
"""The rate at which the plugin looks for the types of topics, in Hz of simulated time."""
_SECONDS_PER_HOUR = 3600.0
_MIN_VOLTAGE = 1e-3
_FULL_LEVEL = 0.9
"""The state of charge from which a battery counts as full and takes no more current."""
_RATE_CORRECTION_STEPS = 100
"""The number of steps whose charges gz subtracts again in each step."""


@dataclass(frozen=True, kw_only=True)
class BatteryParameters:
    """Parameters of ``gz-sim-linearbatteryplugin-system``."""

    battery_name: str = parameter()
    voltage: float = parameter()
    capacity: float = parameter()
    open_circuit_voltage_constant_coef: float = 0.0
    open_circuit_voltage_linear_coef: float = 0.0
    initial_charge: float | None = None
    resistance: float = 0.0
    smooth_current_tau: float = 1.0
    power_load: float = 0.0
    start_draining: bool = False
    power_draining_topic: tuple[str, ...] = ()
    stop_power_draining_topic: tuple[str, ...] = ()
    enable_recharge: bool = False
    charging_time: float | None = None
    invert_current_sign: bool = False
    fix_issue_225: bool = False


class GzBattery(SimulatedPlugin[BatteryParameters]):
    """The substitute for ``gz-sim-linearbatteryplugin-system``.

    The battery starts to drain when a joint of the model is commanded, at a message on a ``<power_draining_topic>``, or
    at once with ``<start_draining>``.

    Attributes:
        loads: the power in W that other plugins draw from the battery, by their names.
    """

    PARAMETERS = BatteryParameters
    IGNORED = ("recharge_by_topic", "soc_threshold", "start_on_motion")
    CARRIED = ("_charge", "_level", "_voltage", "_current", "_recent_charges", "_is_draining", "_is_charging")

    def start(self) -> None:
        """Create the topics.

        Raises:
            LinkwrightError: SIM160, the capacity or the charging time is not positive.
        """
        parameters, node = self.parameters, self.node
        if parameters.capacity <= 0.0:
            raise self._not_positive_error("capacity")
        self.loads: dict[str, float] = {}
        self._revision = -1
        self.reset()
        base = f"/model/{self.context.path}/battery/{parameters.battery_name}"
        if parameters.enable_recharge:
            if parameters.charging_time is None or parameters.charging_time <= 0.0:
                raise self._not_positive_error("charging_time")
            node.subscribe("std_msgs/msg/Bool", f"{base}/recharge/start", self._on_start_charging)
            node.subscribe("std_msgs/msg/Bool", f"{base}/recharge/stop", self._on_stop_charging)
        self._awaited_topics = dict.fromkeys(parameters.power_draining_topic, self._on_start_draining)
        self._awaited_topics |= dict.fromkeys(parameters.stop_power_draining_topic, self._on_stop_draining)
        if self._awaited_topics:
            self.every(_SEARCH_RATE_HZ, self._subscribe_to_known_topics)
            self._subscribe_to_known_topics()
        self._output = node.publisher(_MESSAGE_TYPE, f"{base}/state")
        self.every(0.0, self._update)
        self.every(_PUBLISH_RATE_HZ, self._publish)

    def reset(self) -> None:
        """Restore the initial charge."""
        parameters = self.parameters
        charge = parameters.capacity if parameters.initial_charge is None else parameters.initial_charge
        self._charge = min(max(charge, 0.0), parameters.capacity)
        self._level = self._charge / parameters.capacity
        self._voltage, self._current = parameters.voltage, 0.0
        self._recent_charges: deque[float] = deque(maxlen=_RATE_CORRECTION_STEPS)
        self._is_draining, self._is_charging = parameters.start_draining, False

    @property
    def is_empty(self) -> bool:
        """Whether no charge is left."""
        return self._level <= 0.0

    def _not_positive_error(self, tag: str) -> Exception:
        return self.parameter_error(
            phrase("plugin '{plugin}': <{tag}> must be greater than 0", plugin=self.context.name, tag=tag)
        )

    def _subscribe_to_known_topics(self) -> None:
        """Subscribe to the awaited topics that have a type now.

        Messages of any type start and stop the draining, so the type is that of the first endpoint in the graph.
        """
        types = dict(self.node.graph_node.get_topic_names_and_types()) if self._awaited_topics else {}
        for name in [*self._awaited_topics]:
            topic = f"/{name.lstrip('/')}"
            if topic in types:
                callback = self._awaited_topics.pop(name)
                try:
                    self.node.subscribe(types[topic][0], topic, callback, SENSOR_DATA_QOS)
                except InterfaceNotFoundError as error:
                    self.node.logger.warning(error.diagnostics[0].message)

    def _on_start_draining(self, _: Any) -> None:
        self._is_draining = True

    def _on_stop_draining(self, _: Any) -> None:
        self._is_draining = False

    def _on_start_charging(self, _: Any) -> None:
        self._is_charging = True

    def _on_stop_charging(self, _: Any) -> None:
        self._is_charging = False

    def _update(self) -> None:
        self._is_draining = self._is_draining or self._has_commanded_joint()
        if self._is_draining or self._is_charging:
            self._move_charge(self.simulation.step / NANOSECONDS_PER_SECOND)

    def _has_commanded_joint(self) -> bool:
        """Return whether a joint of the model has a commanded force or velocity."""
        simulation = self.simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._revision = simulation.revision
            self._find_commands()
        data = simulation.data
        return bool(data.qfrc_applied[self._degrees_of_freedom].any() or data.ctrl[self._actuators].any())

    def _find_commands(self) -> None:
        """Find the indices of the model's degrees of freedom and actuators."""
        model, prefix = self.simulation.model, f"{self.context.path}{SEPARATOR}"
        names = [model.joint(index).name for index in range(model.njnt)]
        joints = {index for index, name in enumerate(names) if name.startswith(prefix)}
        self._degrees_of_freedom = [index for index, joint in enumerate(model.dof_jntid.tolist()) if joint in joints]
        self._actuators = [index for index, (joint, _) in enumerate(model.actuator_trnid.tolist()) if joint in joints]

    def _move_charge(self, seconds: float) -> None:
        """Drain and charge the battery for a time in s."""
        parameters, capacity = self.parameters, self.parameters.capacity
        if not self._is_charging and (self.is_empty or self._voltage < _MIN_VOLTAGE):
            self._current = 0.0
            return
        current = 0.0
        if self._is_draining and self._voltage >= _MIN_VOLTAGE:
            current = (parameters.power_load + sum(self.loads.values())) / self._voltage
        if self._is_charging and parameters.charging_time is not None and self._level < _FULL_LEVEL:
            current -= capacity / parameters.charging_time
        time_constant = parameters.smooth_current_tau if parameters.smooth_current_tau > 0.0 else 1.0
        self._current += (current - self._current) * min(seconds / time_constant, 1.0)
        moved_charge = self._current * seconds / _SECONDS_PER_HOUR
        self._charge = max(self._charge - moved_charge, 0.0)
        if self.gazebo_mistakes and not parameters.fix_issue_225:
            self._recent_charges.append(moved_charge)
            self._level -= sum(self._recent_charges) / capacity
        else:
            self._level = self._charge / capacity
        open_circuit_voltage = (
            parameters.open_circuit_voltage_constant_coef
            + parameters.open_circuit_voltage_linear_coef * (1.0 - self._charge / capacity)
        )
        self._voltage = max(open_circuit_voltage - parameters.resistance * self._current, 0.0)
        if self.is_empty and self._is_draining and not self._is_charging:
            self.node.logger.warning(
                phrase(
                    "the battery '{battery}' of '{model}' is empty",
                    battery=parameters.battery_name,
                    model=self.context.path,
                )
            )

    def _compute_status(self) -> int:
        """Return the status as a constant of the message."""
        message = get_message(_MESSAGE_TYPE)
        if self._is_charging:
            status = message.POWER_SUPPLY_STATUS_CHARGING
        elif self._is_draining:
            status = message.POWER_SUPPLY_STATUS_DISCHARGING
        elif self._level > _FULL_LEVEL:
            status = message.POWER_SUPPLY_STATUS_FULL
        else:
            status = message.POWER_SUPPLY_STATUS_NOT_CHARGING
        return int(status)

    def _publish(self) -> None:
        """Publish the state of the battery.

        As in gz, a positive current drains the battery unless the sign is inverted.
        """
        if not self._output.is_wanted:
            return
        parameters = self.parameters
        self._output.publish(
            get_message(_MESSAGE_TYPE)(
                header=Header(stamp=self.stamp()),
                voltage=self._voltage,
                temperature=nan,
                current=-self._current if parameters.invert_current_sign else self._current,
                charge=self._charge,
                capacity=parameters.capacity,
                design_capacity=nan,
                percentage=self._level * (100.0 if parameters.fix_issue_225 else 1.0),
                power_supply_status=self._compute_status(),
                present=True,
            )
        )
