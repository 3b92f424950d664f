"""controller_manager's spawner and unspawner, which load and unload controllers.

As in Jazzy and later, the parameter files of the spawner's own process also apply to the controllers.

Source: controller_manager of ros2_control, with the options of Humble and Jazzy and their messages.
"""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.control.nodes.manager_client import ManagerClient, ManagerProgram, parse_arguments
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph
from linkwright.graph.command_line.ros_arguments import parse, remove_ros_arguments
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.messages import get_service
from linkwright.nodes.options import NodeOptions, create_node, handle_start_errors

_MANAGER_PARAMETER_NAMES = ("type", "fallback_controllers")
"""The entries in a controller's parameter file that are set as parameters of the manager."""


class Spawner(ManagerProgram):
    """The running spawner, which exits with status 0 once the controllers are active.

    Raises:
        LinkwrightError: NODE831, the command line cannot be parsed; NODE832, a parameter file does not exist.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._unloads_on_close = False
        arguments = parse_arguments(_create_parser(), remove_ros_arguments(options.arguments))
        self._node, _ = create_node(graph, options, f"spawner_{arguments.controller_names[0]}")
        self._arguments = arguments
        process_files = [*options.parameters_of_others.files, *parse(options.arguments).parameters.files]
        self._files = list(dict.fromkeys([*(arguments.param_file or ()), *process_files]))
        with handle_start_errors(self._node):
            for path in self._files:
                if not Path(path).is_file():
                    message = phrase("parameter file '{path}' does not exist", path=path)
                    raise LinkwrightError(Diagnostic("NODE832", message))
        self._client = ManagerClient(
            self._node,
            arguments.controller_manager,
            arguments.controller_manager_timeout,
            arguments.service_call_timeout,
        )
        self._begin(self._spawn)

    def close(self) -> None:
        """Unload the controllers if ``--unload-on-kill`` is set, and close the node."""
        if self._unloads_on_close:
            self._unloads_on_close = False
            self._request_unload()
        super().close()

    async def _spawn(self) -> int:
        arguments, logger = self._arguments, self._node.get_logger()
        for name in arguments.controller_names:
            if not await self._load(name):
                return 1
            if arguments.load_only:
                continue
            if not (await self._client.call("configure_controller", name=name)).ok:
                logger.error("Failed to configure controller")
                return 1
            if arguments.inactive or arguments.activate_as_group:
                continue
            if not (await self._activate([name])).ok:
                logger.error(f"Failed to activate controller : {name}")
                return 1
            logger.info(f"Configured and activated {name}")
        if arguments.activate_as_group and not arguments.inactive and not arguments.load_only:
            if not (await self._activate(arguments.controller_names)).ok:
                logger.error(f"Failed to activate the parsed controllers list : {arguments.controller_names}")
                return 1
            logger.info(f"Configured and activated all the parsed controllers list : {arguments.controller_names}!")
        if arguments.unload_on_kill:
            logger.info("Waiting until interrupt to unload controllers")
            self._unloads_on_close = True
            await asyncio.get_running_loop().create_future()
        return 0

    async def _activate(self, names: Sequence[str]) -> Any:
        return await self._client.switch(names, (), self._arguments.switch_timeout, asap=self._arguments.switch_asap)

    async def _load(self, name: str) -> bool:
        logger = self._node.get_logger()
        response = await self._client.call("list_controllers")
        if any(controller.name == name for controller in response.controller):
            logger.warning("Controller already loaded, skipping load_controller")
            return True
        for parameter, value in self._get_manager_parameters(name).items():
            assignment = f'controller param "{parameter}" to "{value}" for {name}'
            if not await self._client.set_parameter(f"{name}.{parameter}", value):
                logger.fatal(f"Could not set {assignment}")
                return False
            logger.info(f"Setting {assignment}")
        if not (await self._client.call("load_controller", name=name)).ok:
            logger.fatal(f"Failed loading controller {name}")
            return False
        logger.info(f"Loaded {name}")
        return True

    def _get_manager_parameters(self, name: str) -> dict[str, Any]:
        """Return the parameters to set on the manager for a controller, such as its type."""
        arguments, parameters = self._arguments, {}
        if arguments.controller_type:
            parameters["type"] = arguments.controller_type
        if arguments.controller_ros_args:
            parameters["node_options_args"] = [
                argument
                for controller_ros_arg in arguments.controller_ros_args
                for argument in controller_ros_arg.split()
            ]
        if arguments.fallback_controllers:
            parameters["fallback_controllers"] = arguments.fallback_controllers
        if self._files:
            parameters["params_file"] = self._files
            full_name = join(self._node.get_namespace(), name)
            for path in self._files:
                values = read_parameter_file(path).for_node(full_name)
                parameters |= {key: values[key] for key in _MANAGER_PARAMETER_NAMES if key in values}
        return parameters

    def _request_unload(self) -> None:
        """Request the deactivation and unloading of the controllers, without waiting for responses.

        The program ends before the responses arrive.
        """
        names, manager = self._arguments.controller_names, self._client.manager
        switch_type = get_service("controller_manager_msgs/srv/SwitchController")
        switch_client = self._node.create_client(switch_type, f"{manager}/switch_controller")
        switch_client.call_async(switch_type.Request(deactivate_controllers=names, strictness=2))
        unload_type = get_service("controller_manager_msgs/srv/UnloadController")
        unload_client = self._node.create_client(unload_type, f"{manager}/unload_controller")
        for name in names:
            unload_client.call_async(unload_type.Request(name=name))


class Unspawner(ManagerProgram):
    """The running unspawner, which exits with status 0 once the controllers are unloaded.

    Raises:
        LinkwrightError: NODE831, the command line cannot be parsed.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        parser = argparse.ArgumentParser(prog="unspawner", add_help=False, exit_on_error=False)
        parser.add_argument("controller_names", nargs="+")
        parser.add_argument("-c", "--controller-manager", default="/controller_manager")
        parser.add_argument("--switch-timeout", type=float, default=5.0)
        self._arguments = parse_arguments(parser, remove_ros_arguments(options.arguments))
        self._node, _ = create_node(graph, options, f"unspawner_{self._arguments.controller_names[0]}")
        self._client = ManagerClient(self._node, self._arguments.controller_manager)
        self._begin(self._unspawn)

    async def _unspawn(self) -> int:
        logger, names = self._node.get_logger(), self._arguments.controller_names
        await self._client.switch((), names, self._arguments.switch_timeout, asap=True)
        logger.info("Deactivated controller")
        for name in names:
            if not (await self._client.call("unload_controller", name=name)).ok:
                logger.info("Failed to unload controller")
                return 1
            logger.info("Unloaded controller")
        return 0


def _create_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="spawner", add_help=False, exit_on_error=False)
    parser.add_argument("controller_names", nargs="+")
    parser.add_argument("-c", "--controller-manager", default="controller_manager")
    parser.add_argument("-p", "--param-file", action="append")
    parser.add_argument("-n", "--namespace")
    parser.add_argument("-t", "--controller-type")
    parser.add_argument("--load-only", action="store_true")
    parser.add_argument("--inactive", "--stopped", action="store_true")
    parser.add_argument("-u", "--unload-on-kill", action="store_true")
    parser.add_argument("--controller-manager-timeout", type=float, default=0.0)
    parser.add_argument("--switch-timeout", type=float, default=5.0)
    parser.add_argument("--service-call-timeout", type=float, default=10.0)
    parser.add_argument("--activate-as-group", action="store_true")
    parser.add_argument("--switch-asap", action=argparse.BooleanOptionalAction, default=False)
    parser.add_argument("--fallback_controllers", nargs="*")
    parser.add_argument("--controller-ros-args", action="append")
    return parser
