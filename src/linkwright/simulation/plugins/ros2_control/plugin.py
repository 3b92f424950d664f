"""The plugins of ros2_control for simulated robots.

The libraries are ``libgazebo_ros2_control.so``, ``gz_ros2_control-system`` and ``ign_ros2_control-system``.

Controllers are updated in the thread of the world, in simulated time, at the manager's ``update_rate``.

Source: gazebo_ros2_control and gz_ros2_control (parameters, node names, how the description is obtained).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from math import nan
from typing import Any, ClassVar, Generic, TypeVar

from linkwright.control.hardware.component import Hardware
from linkwright.control.hardware.description import HardwareDescription, hardware_from_robot
from linkwright.control.hardware.resources import Resources
from linkwright.control.manager.hardware_loading import load_hardware
from linkwright.control.manager.manager import ControllerManager, SavedState
from linkwright.control.manager.nodes import ProcessArguments
from linkwright.control.manager.services import ManagerServices
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic
from linkwright.graph import DESCRIPTION_QOS, Logger, Node
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.graph.stepped.node import SteppedNode
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.ros2_control.hardware import SimulatedSystem
from linkwright.simulation.plugins.ros_element import read_node_description
from linkwright.urdf import Robot

_DEFAULT_RATE_HZ = 100


@dataclass(frozen=True, kw_only=True)
class ManagerParameters:
    """Parameters of all plugins that run a controller manager."""

    parameters: tuple[str, ...] = ()
    controller_manager_name: str = "controller_manager"


@dataclass(frozen=True, kw_only=True)
class Parameters(ManagerParameters):
    """Parameters of the ros2_control plugins."""

    hold_joints: bool = True
    position_proportional_gain: float = nan


P = TypeVar("P", bound=ManagerParameters)


class SimulatedManager(SimulatedPlugin[P], Generic[P]):
    """A plugin that runs a controller manager for the joints of its model.

    Attributes:
        ENFORCES_LIMITS: whether commands are limited even if the manager's parameters do not request it.
    """

    ENFORCES_LIMITS: ClassVar[bool] = False

    def _read_hardware(self, robot: Robot) -> tuple[list[HardwareDescription], list[Diagnostic]]:
        """Return the hardware in the robot's description, and findings about it."""
        return hardware_from_robot(robot)

    def _compute_update_rate(self, values: dict[str, Any]) -> float:
        """Return the rate of the updates in Hz, from the parameters of the manager."""
        return float(values.get("update_rate", _DEFAULT_RATE_HZ))

    def _list_description_topics(self, node: Node) -> Iterable[str]:
        """Return the topics of the robot's description; the first description that arrives is used."""
        return (node.handle.resolve_topic_name(name) for name in ("robot_description", "~/robot_description"))

    @abstractmethod
    def _create_system(self, description: HardwareDescription, logger: Logger) -> SimulatedSystem:
        """Create the hardware of a description."""

    def start(self) -> None:
        """Create the controller manager, and subscribe to the topics of the robot's description."""
        namespace = self.node.name.rpartition("/")[0] or "/"
        parameter_rules = ParameterRules()
        for path in self.parameters.parameters:
            parameter_rules.add(read_parameter_file(path))
        node_description = read_node_description(self.context.name, self.context.element, namespace)
        self._values = {**parameter_rules.for_node(self.node.name), **node_description.parameters}
        name = self.parameters.controller_manager_name
        values = {
            "use_sim_time": True,
            **parameter_rules.for_node(join(namespace, name)),
            **node_description.parameters,
        }
        node = Node(
            self.node.graph_node.graph,
            name,
            namespace=namespace,
            parameters=values,
            remappings=[remapping for remapping in node_description.remappings if not remapping[0].startswith("__")],
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        node.graph.creators[node.get_logger().name] = self.node.logger.name
        self._manager_node = SteppedNode(node, self.node.exchange, owned=True, calls=self.node.calls)
        self._manager_values = values
        self._manager = ControllerManager(
            node,
            self.node.exchange,
            Resources(node.get_logger()),
            ProcessArguments(parameter_rules, node_description.remappings),
            update_rate=self._compute_update_rate(values),
        )
        self._systems: list[SimulatedSystem] = []
        self._last_update = self.simulation.time
        self._is_loaded = False
        node.get_logger().info("Loading controller_manager")
        for topic in dict.fromkeys(self._list_description_topics(node)):
            self._manager_node.subscribe("std_msgs/msg/String", topic, self._on_description, DESCRIPTION_QOS)

    def reset(self) -> None:
        """Restore the initial state of the hardware, and keep active controllers active."""
        self._last_update = self.simulation.time
        for system in self._systems:
            system.begin()
        for controller in self._manager.controllers.values():
            controller.next_update_ns = 0

    def stop(self) -> None:
        """Close the controller manager, and save its state for the next instance.

        The next instance replaces this plugin in a changed model.
        """
        if hasattr(self, "_manager"):
            self.stored_values[self._manager_node.name] = self._manager.saved_state()
            self._manager.close()
            self._manager_node.close()

    def create_generator(self, name: str) -> Any:
        """Return the random number generator of a sensor.

        The generator is seeded from the simulation's seed and the sensor's name.
        """
        return self._environment.random(name)

    def _on_description(self, message: Any) -> None:
        if self._is_loaded:
            return
        manager = self._manager
        self._is_loaded = load_hardware(
            manager,
            message.data,
            DescriptionLibrary(),
            self._add_system,
            read_hardware=self._read_hardware,
            enforces_limits=self.ENFORCES_LIMITS,
        )
        if not self._is_loaded:
            return
        services = ManagerServices(manager, self._manager_node)
        self.every(1.0, services.publish_diagnostics)
        self._last_update = self.simulation.time
        self.every(manager.update_rate, self._update)
        manager.resume(self.stored_values.pop(self._manager_node.name, SavedState()))

    def _add_system(self, description: HardwareDescription, logger: Logger) -> Hardware:
        system = self._create_system(description, logger)
        self._systems.append(system)
        if system.has_pids:
            self.every(0.0, lambda: system.push(self.simulation.step / NANOSECONDS_PER_SECOND))
        return system

    def _update(self) -> None:
        now = self.simulation.time
        period_ns, self._last_update = now - self._last_update, now
        self._manager.cycle(now, period_ns / NANOSECONDS_PER_SECOND)


class SimulatedControl(SimulatedManager[Parameters]):
    """The substitute for the ros2_control plugins: it runs the controllers of a robot."""

    PARAMETERS = Parameters
    IGNORED = (
        "robot_param",  # the description is received on a topic
        "robot_param_node",
        "e_stop_topic",
        "control_period",
        "robot_sim_type",
        "controller_manager_prefix_node_name",
    )

    def _create_system(self, description: HardwareDescription, logger: Logger) -> SimulatedSystem:
        gain = self._manager_values.get("position_proportional_gain", self.parameters.position_proportional_gain)
        return SimulatedSystem(
            description,
            logger,
            self,
            holds_position=self.parameters.hold_joints,
            gain=float(gain),
            values=self._values,
        )
