"""controller_manager's hardware_spawner, which configures or activates hardware.

Source: controller_manager of ros2_control (options, messages).
"""

from __future__ import annotations

import argparse

from linkwright.control.nodes.manager_client import ManagerClient, ManagerProgram, parse_arguments
from linkwright.graph import Graph
from linkwright.graph.command_line.ros_arguments import remove_ros_arguments
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, create_node


class HardwareSpawner(ManagerProgram):
    """The running hardware_spawner, which exits when the manager has responded to its requests.

    Raises:
        LinkwrightError: NODE831, the command line cannot be parsed.
    """

    DEFAULT_NAME = "hardware_spawner"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        parser = argparse.ArgumentParser(prog=self.DEFAULT_NAME, add_help=False, exit_on_error=False)
        parser.add_argument("hardware_component_names", nargs="+")
        parser.add_argument("-c", "--controller-manager", default="controller_manager")
        parser.add_argument("--controller-manager-timeout", type=float, default=0.0)
        target = parser.add_mutually_exclusive_group(required=True)
        target.add_argument("--activate", action="store_true")
        target.add_argument("--configure", action="store_true")
        self._arguments = parse_arguments(parser, remove_ros_arguments(options.arguments))
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._client = ManagerClient(
            self._node, self._arguments.controller_manager, self._arguments.controller_manager_timeout
        )
        self._begin(self._set_states)

    async def _set_states(self) -> int:
        logger, status = self._node.get_logger(), 0
        target, action = (ACTIVE, "activated") if self._arguments.activate else (INACTIVE, "configured")
        loaded_names = [component.name for component in (await self._client.call("list_hardware_components")).component]
        for name in self._arguments.hardware_component_names:
            if name not in loaded_names:
                logger.warning("Hardware Component is not loaded - state can not be changed.")
                status = 1
                continue
            target_state = get_message("lifecycle_msgs/msg/State")(id=target.state_id, label=target.label)
            response = await self._client.call("set_hardware_component_state", name=name, target_state=target_state)
            if response.ok:
                logger.info(f"{action} component '{name}'. Hardware now in state: {response.state.label}.")
            else:
                logger.warning(f"Could not {action} component '{name}'. Hardware is in state: {response.state.label}.")
                status = 1
        return status
