"""``battery_state_broadcaster/BatteryStateBroadcaster``: states of batteries.

Source: ros2_controllers (parameters, names of interfaces, topics, the combined state).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import isfinite, isnan, nan
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.diagnostics import Phrase, phrase
from linkwright.messages import Header, Time, get_message
from linkwright.nodes.parameter_tables import for_each, parameter

_MAX_TECHNOLOGY = 8
_UNKNOWN = 0
"""The unknown status, health and technology of ``sensor_msgs/msg/BatteryState``."""


def _check_technology(name: str, value: int) -> Phrase | None:
    """Return an error message unless a number is a technology of ``BatteryState``."""
    if 0 <= value <= _MAX_TECHNOLOGY:
        return None
    return phrase(
        "parameter '{name}' must be from 0 to {limit}, but it is {value}", name=name, limit=_MAX_TECHNOLOGY, value=value
    )


@dataclass(frozen=True, kw_only=True)
class BatteryInterfaces:
    """The optional state interfaces of a battery; each field is the name of one."""

    battery_temperature: bool = parameter(False, description="whether the battery measures its temperature, in °C")
    battery_current: bool = parameter(False, description="whether the battery measures its current, in A")
    battery_charge: bool = parameter(False, description="whether the battery measures its charge, in Ah")
    battery_percentage: bool = parameter(
        False,
        description="whether the battery measures its percentage, 0 to 100; otherwise it follows from the voltage",
    )
    battery_power_supply_status: bool = parameter(False, description="whether the battery knows its status")
    battery_power_supply_health: bool = parameter(False, description="whether the battery knows its health")
    battery_present: bool = parameter(
        False, description="whether the battery knows if it is present; otherwise a voltage other than 0 means so"
    )


@dataclass(frozen=True, kw_only=True)
class BatteryProperties:
    """The constant properties of a battery."""

    minimum_voltage: float = parameter(nan, description="the voltage at 0 %, in V")
    maximum_voltage: float = parameter(nan, description="the voltage at 100 %, in V")
    capacity: float = parameter(nan, description="the last known full capacity, in Ah")
    design_capacity: float = parameter(nan, description="the design capacity, in Ah")
    power_supply_technology: int = parameter(
        _UNKNOWN, description="the technology, as in sensor_msgs/msg/BatteryState", check=_check_technology
    )
    location: str = parameter("", description="the place of the battery, such as its slot")
    serial_number: str = parameter("", description="the serial number of the battery")


@dataclass(frozen=True, kw_only=True)
class BatteryParameters:
    """Parameters of the battery broadcaster."""

    batteries: tuple[str, ...] = parameter((), read_only=True, description="the names of the batteries in ros2_control")
    interfaces: Mapping[str, BatteryInterfaces] = for_each("batteries", BatteryInterfaces)
    properties: Mapping[str, BatteryProperties] = for_each("batteries", BatteryProperties, prefix="")
    sensor_name: str = parameter("", description="the sensor with an interface voltage; batteries replaces it")
    design_capacity: float = parameter(nan, description="the design capacity of the battery of sensor_name, in Ah")
    power_supply_technology: int = parameter(
        _UNKNOWN, description="the technology of the battery of sensor_name", check=_check_technology
    )


class BatteryStateBroadcaster(Controller[BatteryParameters]):
    """A broadcaster of the state of each battery, and of their combination.

    The topics are ``~/raw_battery_states`` and ``~/battery_state``.
    """

    PARAMETERS = BatteryParameters

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of all batteries, each with its voltage first."""
        parameters = self.parameters
        if parameters.sensor_name:
            return [f"{parameters.sensor_name}/voltage"]
        return [f"{battery}/{name}" for battery in parameters.batteries for name in self._list_interfaces(battery)]

    def _list_interfaces(self, battery: str) -> list[str]:
        enabled = self.parameters.interfaces[battery]
        return ["battery_voltage", *(item.name for item in fields(enabled) if getattr(enabled, item.name))]

    def on_configure(self) -> None:
        """Check the parameters, and create the publishers.

        Raises:
            ControllerError: there is not exactly one of ``batteries`` and ``sensor_name``, or a range of voltages is
                empty.
        """
        parameters = self.parameters
        if parameters.sensor_name and parameters.batteries:
            raise ControllerError(
                "You cannot use both 'sensor_name' and 'batteries' parameters. Please use only 'batteries' going "
                "forward."
            )
        if not parameters.sensor_name and not parameters.batteries:
            raise ControllerError("No batteries configured. Set 'batteries' (preferred) or 'sensor_name' (deprecated).")
        for battery, properties in parameters.properties.items():
            has_percentage = parameters.interfaces[battery].battery_percentage
            if not has_percentage and properties.minimum_voltage >= properties.maximum_voltage:
                raise ControllerError("Maximum battery voltage level must be greater than minimum voltage level.")
        self._combined = self.node.publisher("sensor_msgs/msg/BatteryState", "~/battery_state")
        self._single = self.node.publisher("control_msgs/msg/BatteryStateArray", "~/raw_battery_states")

    def update(self, time_ns: int, period_s: float) -> None:
        """Publish the states of the batteries if a topic has a subscription."""
        if not self._combined.is_wanted and not self._single.is_wanted:
            return
        stamp = Time.from_nanoseconds(time_ns)
        values = iter(state.value for state in self.states)
        if self.parameters.sensor_name:
            self._combined.publish(self._build_single_battery_state(stamp, next(values)))
            return
        batteries = []
        for name in self.parameters.batteries:
            measured = {interface: next(values) for interface in self._list_interfaces(name)}
            batteries.append(_build_battery_state(stamp, name, measured, self.parameters.properties[name]))
        self._single.publish(get_message("control_msgs/msg/BatteryStateArray")(battery_states=batteries))
        self._combined.publish(self._combine_states(stamp, batteries))

    def _build_single_battery_state(self, stamp: Time, voltage: float) -> Any:
        """Return the state of a battery whose voltage alone is measured, by ``sensor_name``."""
        parameters = self.parameters
        return _build_message(
            stamp,
            voltage=voltage,
            present=True,
            design_capacity=parameters.design_capacity,
            power_supply_technology=parameters.power_supply_technology,
        )

    def _combine_states(self, stamp: Time, batteries: Sequence[Any]) -> Any:
        """Return the combined state.

        Voltage, temperature, current and percentage are means over the batteries that measure them; charges and
        capacities are sums.
        """
        interfaces_by_battery = self.parameters.interfaces.values()
        technologies = {battery.power_supply_technology for battery in batteries}
        has_charge = any(interfaces.battery_charge for interfaces in interfaces_by_battery)
        percentage_mask = [
            interfaces.battery_percentage or isfinite(properties.maximum_voltage - properties.minimum_voltage)
            for interfaces, properties in zip(interfaces_by_battery, self.parameters.properties.values(), strict=True)
        ]
        return _build_message(
            stamp,
            voltage=_average([battery.voltage for battery in batteries]),
            temperature=_average_quantity(
                batteries, "temperature", [item.battery_temperature for item in interfaces_by_battery]
            ),
            current=_average_quantity(batteries, "current", [item.battery_current for item in interfaces_by_battery]),
            percentage=_average_quantity(batteries, "percentage", percentage_mask),
            charge=sum(battery.charge for battery in batteries if not isnan(battery.charge)) if has_charge else nan,
            capacity=sum(battery.capacity for battery in batteries),
            design_capacity=sum(battery.design_capacity for battery in batteries),
            power_supply_status=max(battery.power_supply_status for battery in batteries),
            power_supply_health=max(battery.power_supply_health for battery in batteries),
            power_supply_technology=technologies.pop() if len(technologies) == 1 else _UNKNOWN,
            present=True,
            location="".join(f"{battery.location}, " for battery in batteries),
            serial_number="".join(f"{battery.serial_number}, " for battery in batteries),
        )


def _build_battery_state(stamp: Time, name: str, measured: Mapping[str, float], properties: BatteryProperties) -> Any:
    """Return the state of a battery. Quantities that are not measured are NaN or unknown."""
    voltage = measured["battery_voltage"]
    percentage = measured.get("battery_percentage")
    if percentage is None:
        span = properties.maximum_voltage - properties.minimum_voltage
        percentage = (voltage - properties.minimum_voltage) * 100.0 / span if isfinite(span) else nan
    is_present = measured.get("battery_present", 0.0 if isnan(voltage) else voltage)
    return _build_message(
        stamp,
        name,
        voltage=voltage,
        temperature=measured.get("battery_temperature", nan),
        current=measured.get("battery_current", nan),
        charge=measured.get("battery_charge", nan),
        capacity=properties.capacity,
        design_capacity=properties.design_capacity,
        percentage=percentage,
        power_supply_status=_to_constant(measured.get("battery_power_supply_status", nan)),
        power_supply_health=_to_constant(measured.get("battery_power_supply_health", nan)),
        power_supply_technology=properties.power_supply_technology,
        present=bool(is_present) and not isnan(is_present),
        location=properties.location,
        serial_number=properties.serial_number,
    )


def _build_message(stamp: Time, frame: str = "", **values: Any) -> Any:
    """Return a battery state. Quantities without a value are NaN."""
    unknown = dict.fromkeys(("temperature", "current", "charge", "capacity", "percentage"), nan)
    return get_message("sensor_msgs/msg/BatteryState")(header=Header(stamp=stamp, frame_id=frame), **unknown | values)


def _to_constant(value: float) -> int:
    return int(value) if isfinite(value) else _UNKNOWN


def _average_quantity(batteries: Sequence[Any], quantity: str, measured_mask: Sequence[bool]) -> float:
    """Return the mean of a quantity over the batteries that measure it; NaN if none does."""
    pairs = zip(batteries, measured_mask, strict=True)
    return _average([getattr(battery, quantity) for battery, is_measured in pairs if is_measured])


def _average(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else nan
