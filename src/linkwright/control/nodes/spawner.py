"""spawner and unspawner of controller_manager, which load and unload controllers.

As in Jazzy and later, the parameter files of the spawner's own process apply to the controllers, too.

Source: controller_manager of ros2_control, with the options of Humble and Jazzy and their messages.
"""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.control.nodes.manager_client import ManagerClient, ManagerProgram, parsed
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph
from linkwright.graph.command_line.ros_arguments import parse, remove_ros_arguments
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.messages import get_service
from linkwright.nodes.options import NodeOptions, create_node, starting

_TAKEN = ("type", "fallback_controllers")
"""Parameters of a controller that are the manager's."""


class Spawner(ManagerProgram):
    """The running spawner, which exits with status 0 once the controllers are active.

    Raises:
        LinkwrightError: NODE831, the command line cannot be parsed; NODE832, a parameter file does not exist.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._unloads = False
        wanted = parsed(_parser(), remove_ros_arguments(options.arguments))
        self._node, _ = create_node(graph, options, f"spawner_{wanted.controller_names[0]}")
        self._arguments = wanted
        of_process = [*options.for_others.files, *parse(options.arguments).parameters.files]
        self._files = list(dict.fromkeys([*(wanted.param_file or ()), *of_process]))
        with starting(self._node):
            for path in self._files:
                if not Path(path).is_file():
                    message = phrase("parameter file '{path}' does not exist", path=path)
                    raise LinkwrightError(Diagnostic("NODE832", message))
        self._client = ManagerClient(
            self._node, wanted.controller_manager, wanted.controller_manager_timeout, wanted.service_call_timeout
        )
        self._begin(self._spawn)

    def close(self) -> None:
        """Close the node, after unloading the controllers if ``--unload-on-kill`` is given."""
        if self._unloads:
            self._unloads = False
            self._unload_at_once()
        super().close()

    async def _spawn(self) -> int:
        wanted, logger = self._arguments, self._node.get_logger()
        for name in wanted.controller_names:
            if not await self._load(name):
                return 1
            if wanted.load_only:
                continue
            if not (await self._client.ask("configure_controller", name=name)).ok:
                logger.error("Failed to configure controller")
                return 1
            if wanted.inactive or wanted.activate_as_group:
                continue
            if not (await self._activate([name])).ok:
                logger.error(f"Failed to activate controller : {name}")
                return 1
            logger.info(f"Configured and activated {name}")
        if wanted.activate_as_group and not wanted.inactive and not wanted.load_only:
            if not (await self._activate(wanted.controller_names)).ok:
                logger.error(f"Failed to activate the parsed controllers list : {wanted.controller_names}")
                return 1
            logger.info(f"Configured and activated all the parsed controllers list : {wanted.controller_names}!")
        if wanted.unload_on_kill:
            logger.info("Waiting until interrupt to unload controllers")
            self._unloads = True
            await asyncio.get_running_loop().create_future()
        return 0

    async def _activate(self, names: Sequence[str]) -> Any:
        return await self._client.switch(names, (), self._arguments.switch_timeout, asap=self._arguments.switch_asap)

    async def _load(self, name: str) -> bool:
        logger = self._node.get_logger()
        listed = await self._client.ask("list_controllers")
        if any(controller.name == name for controller in listed.controller):
            logger.warning("Controller already loaded, skipping load_controller")
            return True
        for parameter, value in self._parameters(name).items():
            text = f'controller param "{parameter}" to "{value}" for {name}'
            if not await self._client.set_parameter(f"{name}.{parameter}", value):
                logger.fatal(f"Could not set {text}")
                return False
            logger.info(f"Setting {text}")
        if not (await self._client.ask("load_controller", name=name)).ok:
            logger.fatal(f"Failed loading controller {name}")
            return False
        logger.info(f"Loaded {name}")
        return True

    def _parameters(self, name: str) -> dict[str, Any]:
        """Return the parameters about a controller, such as its type, to be set on the manager."""
        wanted, found = self._arguments, {}
        if wanted.controller_type:
            found["type"] = wanted.controller_type
        if wanted.controller_ros_args:
            found["node_options_args"] = [
                word for controller_ros_arg in wanted.controller_ros_args for word in controller_ros_arg.split()
            ]
        if wanted.fallback_controllers:
            found["fallback_controllers"] = wanted.fallback_controllers
        if self._files:
            found["params_file"] = self._files
            full_name = join(self._node.get_namespace(), name)
            for path in self._files:
                values = read_parameter_file(path).for_node(full_name)
                found |= {key: values[key] for key in _TAKEN if key in values}
        return found

    def _unload_at_once(self) -> None:
        """Request deactivation and unloading of the controllers, without waiting for responses.

        The program ends meanwhile.
        """
        names, manager = self._arguments.controller_names, self._client.manager
        kind = get_service("controller_manager_msgs/srv/SwitchController")
        switch = self._node.create_client(kind, f"{manager}/switch_controller")
        switch.call_async(kind.Request(deactivate_controllers=names, strictness=2))
        unload = get_service("controller_manager_msgs/srv/UnloadController")
        client = self._node.create_client(unload, f"{manager}/unload_controller")
        for name in names:
            client.call_async(unload.Request(name=name))


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
        self._arguments = parsed(parser, remove_ros_arguments(options.arguments))
        self._node, _ = create_node(graph, options, f"unspawner_{self._arguments.controller_names[0]}")
        self._client = ManagerClient(self._node, self._arguments.controller_manager)
        self._begin(self._unspawn)

    async def _unspawn(self) -> int:
        logger, names = self._node.get_logger(), self._arguments.controller_names
        await self._client.switch((), names, self._arguments.switch_timeout, asap=True)
        logger.info("Deactivated controller")
        for name in names:
            if not (await self._client.ask("unload_controller", name=name)).ok:
                logger.info("Failed to unload controller")
                return 1
            logger.info("Unloaded controller")
        return 0


def _parser() -> argparse.ArgumentParser:
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
