"""The programs ``remove``, ``delete_entity`` and ``set_entity_pose`` of ros_gz_sim.

Source: ros_gz_sim (parameters, options). In ros_gz_sim, models can also be named by a numeric ID; here, models have no
ID.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any, NoReturn

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.graph import Graph
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, create_node, handle_start_errors
from linkwright.simulation.nodes.spawner import SimulatorClient

_DELETE_SERVICE, _SET_STATE_SERVICE = "gazebo_msgs/srv/DeleteEntity", "gazebo_msgs/srv/SetEntityState"
_MODEL_TYPE, _LINK_TYPE = "6", "2"
"""The values of ros_gz_interfaces/msg/Entity.type that ``--type`` accepts: model and link."""


class Remove(SimulatorClient):
    """The node of ``remove``, which removes the model that its parameter ``entity_name`` names.

    Raises:
        LinkwrightError: NODE812, the parameter is empty.
    """

    DEFAULT_NAME = "ros_gz_sim_remove_entity"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._connect(self._node)
            self._node.declare_parameter("world", "")
            name = str(self._node.declare_parameter("entity_name", "").value)
            if not name:
                hint = phrase("set the parameter 'entity_name'")
                raise LinkwrightError(
                    Diagnostic(
                        "NODE812",
                        phrase("the command line of {program} does not name a model", program="remove"),
                        hint=hint,
                    )
                )
            self._remove(name)

    def _remove(self, name: str) -> None:
        self._call_service(
            _DELETE_SERVICE, "delete_entity", get_service(_DELETE_SERVICE).Request(name=name), self._on_response
        )

    def _on_response(self, response: Any) -> None:
        """Log the result of the request, and end with status 0 if it succeeded, else with 1."""
        if response.success:
            self._log("Result: true")
            self._finish(0)
        else:
            self._fail(f"Result: false, {getattr(response, 'status_message', '') or 'there is no such entity'}")


class DeleteEntity(Remove):
    """The node of ``delete_entity``, which removes the model that ``--name`` names.

    Raises:
        LinkwrightError: NODE812, the command line is invalid.
    """

    DEFAULT_NAME = "entity_deleter"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._connect(self._node)
            self._remove(_parse_command_line(_create_parser("delete_entity"), arguments).name)


class SetEntityPose(Remove):
    """The node of ``set_entity_pose``, which sets the pose of a model or link.

    The option ``--name`` names the model or link.

    Raises:
        LinkwrightError: NODE812, the command line is invalid.
    """

    DEFAULT_NAME = "entity_pose_setter"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, command_line = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._connect(self._node)
            parser = _create_parser("set_entity_pose")
            parser.add_argument("--pos", nargs=3, type=float, default=(0.0, 0.0, 0.0))
            rotation_options = parser.add_mutually_exclusive_group()
            rotation_options.add_argument("--quat", nargs=4, type=float)
            rotation_options.add_argument("--euler", nargs=3, type=float, default=(0.0, 0.0, 0.0))
            arguments = _parse_command_line(parser, command_line)
            state = get_message("gazebo_msgs/msg/EntityState")(name=arguments.name)
            position, orientation = state.pose.position, state.pose.orientation
            position.x, position.y, position.z = arguments.pos
            rotation = arguments.quat or quaternion_from_rpy(tuple(arguments.euler))
            orientation.x, orientation.y, orientation.z, orientation.w = rotation
            request = get_service(_SET_STATE_SERVICE).Request(state=state)
            self._call_service(_SET_STATE_SERVICE, "set_entity_state", request, self._on_response)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise LinkwrightError(Diagnostic("NODE812", foreign(message), hint=foreign(self.format_usage().strip())))


def _create_parser(program: str) -> _Parser:
    parser = _Parser(prog=program, add_help=False, allow_abbrev=False)
    parser.add_argument("--name")
    parser.add_argument("--id")
    parser.add_argument("--type", choices=(_MODEL_TYPE, _LINK_TYPE), default=_MODEL_TYPE)
    return parser


def _parse_command_line(parser: _Parser, command_line: Sequence[str]) -> argparse.Namespace:
    """Parse a command line that names an entity.

    Raises:
        LinkwrightError: NODE812, the command line is invalid.
    """
    arguments = parser.parse_args(command_line)
    if not arguments.name:
        message = phrase("the command line of {program} does not name a model", program=parser.prog)
        hint = phrase("pass its name with --name; Linkwright models have no numeric IDs")
        raise LinkwrightError(Diagnostic("NODE812", message, hint=hint))
    return arguments
