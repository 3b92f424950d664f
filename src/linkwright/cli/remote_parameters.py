"""Access to a running node's parameters through its services, and parsing of values."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import call, find_node
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

TYPE_NAMES = {
    0: "not set",
    1: "boolean",
    2: "integer",
    3: "double",
    4: "string",
    5: "byte array",
    6: "boolean array",
    7: "integer array",
    8: "double array",
    9: "string array",
}
"""The names of the types in ros2, by their numbers in rcl_interfaces/msg/ParameterType."""


class RemoteParameters:
    """The parameters of a running node, accessed through its services.

    Args:
        session: the session of the command.
        node: the node's full name.
        timeout: the time in seconds to wait for each response; None for no limit.
    """

    def __init__(self, session: Session, node: str, timeout: float | None = None) -> None:
        self._session = session
        self.node = node
        self._timeout = timeout

    @classmethod
    async def of(cls, session: Session, arguments: argparse.Namespace) -> RemoteParameters:
        """Return the parameters of the node that the command line names.

        Raises:
            LinkwrightError: CLI423, the node is not running.
        """
        node = await find_node(
            session, arguments.node_name, hidden=arguments.include_hidden_nodes, timeout=arguments.timeout
        )
        return cls(session, node, arguments.service_timeout)

    async def list_names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the sorted names of the declared parameters.

        Args:
            prefixes: if not empty, only names with one of these prefixes are returned.
        """
        response = await self._call("list_parameters", prefixes=list(prefixes))
        return sorted(response.result.names)

    async def get_values(self, names: Sequence[str]) -> list[Any]:
        """Return the values (rcl_interfaces/msg/ParameterValue) of parameters in the given order."""
        response = await self._call("get_parameters", names=list(names))
        return list(response.values)

    async def get_descriptors(self, names: Sequence[str]) -> list[Any]:
        """Return the descriptors (rcl_interfaces/msg/ParameterDescriptor) in the given order."""
        response = await self._call("describe_parameters", names=list(names))
        return list(response.descriptors)

    async def set(self, parameters: Sequence[Any]) -> list[Any]:
        """Set parameters (rcl_interfaces/msg/Parameter) one by one.

        Returns:
            A result (rcl_interfaces/msg/SetParametersResult) for each parameter.
        """
        response = await self._call("set_parameters", parameters=list(parameters))
        return list(response.results)

    async def set_together(self, parameters: Sequence[Any]) -> Any:
        """Set all parameters atomically, and return one rcl_interfaces/msg/SetParametersResult."""
        response = await self._call("set_parameters_atomically", parameters=list(parameters))
        return response.result

    async def check_declared(self, names: Sequence[str]) -> None:
        """Check that parameters are declared.

        Raises:
            LinkwrightError: CLI424, for each parameter that is not declared.
        """
        declared_names = await self.list_names()
        missing = [
            Diagnostic(
                "CLI424",
                phrase("Parameter not set: node '{node}' has no parameter '{name}'", node=self.node, name=name),
                hint=did_you_mean(name, declared_names)
                or phrase("run `linkwright param list {node}` to list its parameters", node=self.node),
            )
            for name in names
            if name not in declared_names
        ]
        if missing:
            raise LinkwrightError(*missing)

    async def _call(self, service: str, **fields: Any) -> Any:
        from linkwright.graph.parameters.parameter import get_service_type
        from linkwright.messages import get_service

        name = get_service_type(service)
        request = get_service(name).Request(**fields)
        return await call(self._session, name, f"{self.node}/{service}", request, timeout=self._timeout)


def parse_parameter(name: str, text: str) -> Any:
    """Return a rcl_interfaces/msg/Parameter whose value is parsed from a text.

    As in ros2, the text is read as YAML. A text that is not a boolean, a number or a list of one type remains a string.
    """
    import yaml

    from linkwright.graph.parameters.parameter import Parameter, ParameterType

    try:
        value = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError):
        value = text
    if isinstance(value, (bool, int, float)):
        return Parameter(name, value=value).to_parameter_msg()
    if isinstance(value, list):
        for array_type, element_type in (
            (ParameterType.BOOL_ARRAY, bool),
            (ParameterType.INTEGER_ARRAY, int),
            (ParameterType.DOUBLE_ARRAY, float),
            (ParameterType.STRING_ARRAY, str),
        ):
            if all(isinstance(item, element_type) for item in value):
                return Parameter(name, array_type, value).to_parameter_msg()
    return Parameter(name, ParameterType.STRING, text).to_parameter_msg()


def print_result(result: Any, success_text: str, failure_text: str) -> None:
    """Print a message for success or failure, followed by the reason if the node gave one."""
    text = success_text if result.successful else failure_text
    print(f"{text}: {result.reason}" if result.reason else text, file=sys.stdout if result.successful else sys.stderr)
