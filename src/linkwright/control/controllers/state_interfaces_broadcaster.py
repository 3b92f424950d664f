"""``state_interfaces_broadcaster/StateInterfacesBroadcaster``: values of state interfaces.

Source: ros2_controllers (parameters, topics).
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.controller import Controller, InterfaceNames
from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import Header, Time, get_message
from linkwright.nodes.parameter_tables import not_empty, parameter

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True, kw_only=True)
class StateInterfacesParameters:
    """Parameters of the broadcaster."""

    interfaces: tuple[str, ...] = parameter(
        (), description="the names of the interfaces, such as joint1/position", check=not_empty
    )


class StateInterfacesBroadcaster(Controller[StateInterfacesParameters]):
    """A broadcaster of values, whose names are published once, in the same order."""

    PARAMETERS = StateInterfacesParameters

    def state_interfaces(self) -> InterfaceNames:
        """Return the names of the interfaces."""
        return self.parameters.interfaces

    def on_configure(self) -> None:
        """Create the publishers, and publish the names."""
        names = self.node.publisher("control_msgs/msg/Keys", "~/names", _LATCHED)
        header = Header(stamp=self.node.graph_node.get_clock().now().to_msg(), frame_id="")
        names.publish(get_message("control_msgs/msg/Keys")(header=header, keys=list(self.parameters.interfaces)))
        self._values = self.node.publisher("control_msgs/msg/Float64Values", "~/values")

    def update(self, time_ns: int, period_s: float) -> None:
        """Publish the values if the topic has a subscription."""
        if self._values.is_wanted:
            header = Header(stamp=Time.from_nanoseconds(time_ns), frame_id="")
            values = [state.value for state in self.states]
            self._values.publish(get_message("control_msgs/msg/Float64Values")(header=header, values=values))
