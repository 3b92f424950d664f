"""Calls to a controller manager's services, for spawner, unspawner and hardware_spawner.

Source: controller_manager of ros2_control (options, times, messages).
"""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Callable, Coroutine, Sequence
from typing import Any, NoReturn

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import Node, Parameter
from linkwright.messages import Duration, get_service
from linkwright.nodes.options import SingleNode
from linkwright.nodes.service_waits import wait_for_future, wait_for_service

_LOG_PERIOD_S = 10.0
"""The seconds between two log lines about a service that is not available."""
_MAX_ATTEMPTS = 3


class NoManagerError(Exception):
    """Raised when the manager's services are not available or do not respond.

    The message is the same as in ros2_control.
    """


class ManagerClient:
    """A client of the services of a controller manager.

    Args:
        node: the node that calls the services.
        manager: the name of the manager's node, relative to the namespace of `node`.
        timeout: seconds to wait for a service; 0 for no limit.
        call_timeout: seconds to wait for a response.
    """

    def __init__(self, node: Node, manager: str, timeout: float = 0.0, call_timeout: float = 10.0) -> None:
        namespace = node.get_namespace().rstrip("/")
        self.manager = manager if manager.startswith("/") else f"{namespace}/{manager}"
        self._node = node
        self._timeout, self._call_timeout = timeout, call_timeout

    async def call(self, service: str, **fields: Any) -> Any:
        """Call one of the manager's services, and return the response.

        Args:
            service: the name of the service, such as ``list_controllers``.
            fields: the fields of the request.

        Raises:
            NoManagerError: the manager is not available, or does not respond.
        """
        type_name = "".join(part.capitalize() for part in service.split("_"))
        return await self._call(f"controller_manager_msgs/srv/{type_name}", service, fields)

    async def set_parameter(self, name: str, value: Any) -> bool:
        """Set a parameter of the manager, and return whether the value was accepted.

        Raises:
            NoManagerError: the manager is not available, or does not respond.
        """
        parameter = Parameter(name, value=value).to_parameter_msg()
        response = await self._call("rcl_interfaces/srv/SetParameters", "set_parameters", {"parameters": [parameter]})
        return all(result.successful for result in response.results)

    async def switch(self, activate: Sequence[str], deactivate: Sequence[str], timeout: float, *, asap: bool) -> Any:
        """Switch controllers with strictness STRICT, and return the response."""
        duration = Duration.from_nanoseconds(round(timeout * 1e9))
        return await self.call(
            "switch_controller",
            activate_controllers=list(activate),
            deactivate_controllers=list(deactivate),
            strictness=2,
            activate_asap=asap,
            timeout=duration,
        )

    async def _call(self, service_type: str, service: str, fields: dict[str, Any]) -> Any:
        service_class = get_service(service_type)
        name = f"{self.manager}/{service}"
        client = self._node.create_client(service_class, name)
        try:
            await self._wait_for_server(client, name)
            for attempt in range(1, _MAX_ATTEMPTS + 1):
                future = client.call_async(service_class.Request(**fields))
                if await wait_for_future(self._node, future, self._call_timeout):
                    return future.result()
                client.remove_pending_request(future)
                self._node.get_logger().warning(
                    f"Failed getting a result from calling {name} in {self._call_timeout:g}. "
                    f"(Attempt {attempt} of {_MAX_ATTEMPTS}.)"
                )
        finally:
            self._node.destroy_client(client)
        raise NoManagerError(f"Could not successfully call service {name} after {_MAX_ATTEMPTS} attempts.")

    async def _wait_for_server(self, client: Any, name: str) -> None:
        """Wait until the server of a client is available.

        Raises:
            NoManagerError: the timeout has passed.
        """
        logger = self._node.get_logger()
        while not client.service_is_ready():
            logger.info(f"waiting for service {name} to become available...")
            if await wait_for_service(self._node, client, self._timeout or _LOG_PERIOD_S):
                return
            if self._timeout:
                raise NoManagerError(f"Could not contact service {name}")
            logger.warning(f"Could not contact service {name}")


class ManagerProgram(SingleNode):
    """A node that calls the services of a controller manager and then exits.

    Subclasses create `_node` and call `_begin`.
    """

    finished: asyncio.Future[int]

    def _begin(self, program: Callable[[], Coroutine[Any, Any, int]]) -> None:
        """Start a coroutine that returns the exit status of the program."""
        self.finished = asyncio.get_running_loop().create_future()
        self._task = asyncio.get_running_loop().create_task(self._run(program))

    def close(self) -> None:
        """Cancel the coroutine, and close the node."""
        self._task.cancel()
        super().close()

    async def _run(self, program: Callable[[], Coroutine[Any, Any, int]]) -> None:
        status = 1
        try:
            status = await program()
        except NoManagerError as error:
            self._node.get_logger().fatal(str(error))
        except LinkwrightError as error:
            self._node.get_logger().fatal(error.diagnostics[0].message)
        if not self.finished.done():
            self.finished.set_result(status)


def _drop_empty_arguments(parser: argparse.ArgumentParser, arguments: Sequence[str]) -> list[str]:
    """Return command-line arguments without the empty arguments of launch files.

    Empty values of options are kept.
    """
    flags = [action for action in parser._actions if action.nargs == 0]
    valueless = {"", *(option for action in flags for option in action.option_strings)}
    previous_arguments = ["", *arguments]
    return [
        argument
        for argument, previous in zip(arguments, previous_arguments, strict=False)
        if argument or (previous[:1] == "-" and previous not in valueless)
    ]


def parse_arguments(parser: argparse.ArgumentParser, arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the arguments of a command line.

    Raises:
        LinkwrightError: NODE831, the command line cannot be parsed.
    """

    def refuse(message: str) -> NoReturn:
        text = phrase("{program} cannot parse its arguments: {message}", program=parser.prog, message=foreign(message))
        raise LinkwrightError(Diagnostic("NODE831", text, hint=foreign(parser.format_usage().strip())))

    # If a required option is missing, argparse in Python up to 3.12 ends the program even with exit_on_error=False.
    parser.error = refuse  # type: ignore[method-assign]  # on purpose, see above
    try:
        return parser.parse_args(_drop_empty_arguments(parser, arguments))
    except argparse.ArgumentError as error:
        refuse(str(error))
