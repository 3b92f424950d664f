"""controller_manager's ros2_control_node, which runs controllers in real time.

The node reads, updates and writes at ``update_rate`` on the event loop, so topics and services need no transfer between
threads. Missed updates are skipped if ``overruns.manage`` is set, and are run later otherwise. The description comes
from the topic ``robot_description`` (Jazzy), the topic ``~/robot_description``, or a parameter (Humble).
"""

from __future__ import annotations

from typing import Any

from linkwright.control.hardware.component import Hardware
from linkwright.control.hardware.description import HardwareDescription
from linkwright.control.hardware.resources import Resources, create_installed_hardware
from linkwright.control.manager.exchange import DirectExchange
from linkwright.control.manager.hardware_loading import load_hardware
from linkwright.control.manager.manager import ControllerManager
from linkwright.control.manager.nodes import ProcessArguments
from linkwright.control.manager.services import ManagerServices
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import DESCRIPTION_QOS, Graph
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.log.logger import Logger
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_DEFAULT_UPDATE_RATE_HZ = 100
_SIMULATOR_TYPES = ("GazeboSystem", "GazeboSimSystem", "IgnitionSystem")
"""The hardware types of gazebo_ros2_control, gz_ros2_control and their forks, which only run in a simulator."""


def _create_hardware(description: HardwareDescription, logger: Logger) -> Hardware | None:
    """Create the hardware of a description, or return None if its type is not installed.

    Raises:
        LinkwrightError: NODE833, the hardware exists only in a simulator.
    """
    if description.plugin.rpartition("/")[2] in _SIMULATOR_TYPES:
        message = phrase(
            "hardware '{name}': '{plugin}' only runs in a simulator, which has its own controller "
            "manager; remove ros2_control_node from the launch file",
            name=description.name,
            plugin=description.plugin,
        )
        raise LinkwrightError(Diagnostic("NODE833", message))
    return create_installed_hardware(description, logger)


class Ros2ControlNode(SingleNode):
    """The running ros2_control_node.

    Raises:
        LinkwrightError: NODE830, the update rate is invalid; or a name, a remapping or a ROS argument is not valid.
    """

    DEFAULT_NAME = "controller_manager"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        self._library = options.library
        with handle_start_errors(self._node):
            self._start(options)

    def _start(self, options: NodeOptions) -> None:
        ros_arguments = parse(options.arguments)
        rules = ParameterRules()
        rules.add(options.parameters_of_others)
        rules.add(ros_arguments.parameters)
        remappings = [*ros_arguments.remappings_for(self.DEFAULT_NAME), *options.remappings]
        logger = self._node.get_logger()
        rate = self._read_update_rate()
        logger.info(f"update rate is {rate} Hz")
        self._manages_overruns = self._is_enabled("overruns.manage")
        self._warns_of_overruns = self._manages_overruns and self._is_enabled("overruns.print_warnings")
        logger.info(f"Overruns handling is : {'enabled' if self._manages_overruns else 'disabled'}")
        self._manager = ControllerManager(
            self._node,
            DirectExchange(),
            Resources(logger),
            ProcessArguments(rules, remappings),
            update_rate=rate,
        )
        self._is_loaded = False
        text = self._node.get_parameter_or("robot_description").value
        if text:
            logger.warning(
                "[Deprecated] Passing the robot description parameter directly to the control_manager node is "
                "deprecated. Use the 'robot_description' topic from 'robot_state_publisher' instead."
            )
            self._load(text)
            return
        topics = dict.fromkeys(
            self._node.handle.resolve_topic_name(name) for name in ("robot_description", "~/robot_description")
        )
        for topic in topics:
            self._node.create_subscription(String, topic, self._on_description, DESCRIPTION_QOS)
            logger.info(f"Subscribing to '{topic}' topic for robot description.")

    def close(self) -> None:
        """Deactivate the controllers, and close the node."""
        self._manager.close()
        super().close()

    def _read_update_rate(self) -> int:
        value: Any = self._node.get_parameter_or("update_rate").value
        if value is None:
            self._node.get_logger().warning("'update_rate' parameter not set, using default value.")
            return _DEFAULT_UPDATE_RATE_HZ
        if not isinstance(value, int) or isinstance(value, bool) or not 0 < value <= 100_000:
            message = phrase("the update_rate must be an integer from 1 to 100000 (Hz), but it is {value}", value=value)
            raise LinkwrightError(Diagnostic("NODE830", message, hint=phrase("write 'update_rate: 100'")))
        return value

    def _is_enabled(self, parameter: str) -> bool:
        return self._node.get_parameter_or(parameter).value is not False

    def _on_description(self, message: String) -> None:
        logger = self._node.get_logger()
        logger.info("Received robot description from topic.")
        if self._is_loaded:
            logger.warning("ResourceManager has already loaded a urdf. Ignoring attempt to reload a robot description.")
            return
        self._load(message.data)

    def _load(self, description: str) -> None:
        manager = self._manager
        self._is_loaded = load_hardware(manager, description, self._library, _create_hardware) and bool(
            manager.resources.components
        )
        if not self._is_loaded:  # Services of this node would hide the services of another manager.
            return
        node = SteppedNode(self._node, DirectExchange(), owned=False)
        services = ManagerServices(manager, node)
        self._node.create_timer(1.0, services.publish_diagnostics)
        self._clock = self._node.get_clock()
        self._period_ns = round(NANOSECONDS_PER_SECOND / manager.update_rate)
        self._was_simulated = self._clock.ros_time_is_active
        self._cycle_duration_ns = 0
        self._last_cycle_ns = self._clock.timer_ns()
        self._next_cycle_ns = self._last_cycle_ns + self._period_ns
        self._timer = self._node.create_timer(1.0 / manager.update_rate, self._update)

    def _update(self) -> None:
        scheduled_ns, self._next_cycle_ns = self._next_cycle_ns, self._timer.next_call_ns()
        missed_count = round((self._next_cycle_ns - scheduled_ns) / self._period_ns) - 1
        if missed_count > 0 and self._clock.ros_time_is_active is self._was_simulated is False:
            self._handle_missed_updates(missed_count)
        self._cycle()

    def _cycle(self) -> None:
        clock = self._clock
        timer_ns, is_simulated = clock.timer_ns(), clock.ros_time_is_active
        period_ns = timer_ns - self._last_cycle_ns
        if is_simulated is not self._was_simulated or period_ns < 0:  # The time source changed, or time jumped back.
            self._was_simulated, period_ns = is_simulated, self._period_ns
        self._last_cycle_ns = timer_ns
        self._manager.cycle(clock.now_ns(), period_ns / NANOSECONDS_PER_SECOND)
        self._cycle_duration_ns = clock.timer_ns() - timer_ns

    def _handle_missed_updates(self, count: int) -> None:
        """Skip missed updates if overruns are managed, and run them now otherwise.

        A warning is logged if the last update took too long.
        """
        rate, duration_ns = self._manager.update_rate, self._cycle_duration_ns
        if self._warns_of_overruns and duration_ns > self._period_ns:
            self._node.get_logger().warning(
                f"Overrun detected! The controller manager missed its desired rate of {rate:.0f} Hz. The loop took "
                f"{duration_ns / 1e6:f} ms (missed cycles : {count}).",
                throttle_duration_sec=1.0,
            )
        if not self._manages_overruns:
            for _ in range(min(count, int(rate))):  # At most the missed updates of one second are run.
                self._cycle()
