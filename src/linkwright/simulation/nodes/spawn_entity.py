"""The program spawn_entity.py of gazebo_ros, which calls ``/spawn_entity``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import NoReturn

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import Graph
from linkwright.messages import get_service
from linkwright.nodes.options import NodeOptions, create_node, handle_start_errors
from linkwright.simulation.nodes.spawner import Entity, EntitySpawner, read_description, read_stdin


class SpawnEntity(EntitySpawner):
    """The node of spawn_entity.py, which spawns an entity and ends.

    The exit status is 0, or 1 after a failure. With ``-b``, the node runs until it is closed, and then deletes the
    entity.

    Raises:
        LinkwrightError: NODE810, the command line is invalid; NODE811, the file cannot be read.
    """

    DEFAULT_NAME = "spawn_entity"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            parsed = self._arguments = parse_arguments(arguments)
            self._environment = options.environment
            namespace = self._node.get_namespace() if parsed.robot_namespace is None else parsed.robot_namespace
            entity = Entity(
                parsed.entity,
                (parsed.x, parsed.y, parsed.z),
                (parsed.R, parsed.P, parsed.Y),
                namespace,
                parsed.reference_frame,
            )
            self._prepare(self._node, entity, service_namespace=parsed.gazebo_namespace or "", timeout=parsed.timeout)
            if parsed.wait is None:
                self._start_spawning()
            else:
                self._log(f"Waiting for entity {parsed.wait} to exist")
                self._wait_for_entity(parsed.wait)

    def close(self) -> None:
        """Close the node, and delete the entity if ``-b`` was given."""
        if self._arguments.b and self._has_description and not self.finished.done():
            service_type = get_service("gazebo_msgs/srv/DeleteEntity")
            client = self._node.create_client(service_type, f"{self._service_namespace}/delete_entity")
            client.call_async(service_type.Request(name=self._entity.name))
        super().close()

    def _start_spawning(self) -> None:
        arguments = self._arguments
        if arguments.topic is not None:
            self._spawn_from_topic(arguments.topic)
        elif arguments.file is not None:
            self._spawn(read_description(arguments.file, self._environment))
        elif arguments.database is not None:
            self._spawn(read_description(f"model://{arguments.database}", self._environment))
        else:
            self._spawn(read_stdin())

    def _spawn(self, description: str) -> None:
        super()._spawn(
            description.replace("package://", "model://") if self._arguments.package_to_model else description
        )

    def _wait_for_entity(self, name: str) -> None:
        def on_names(names: list[str]) -> None:
            if name in names:
                self._start_spawning()
                return

            def retry() -> None:
                timer.cancel()
                self._wait_for_entity(name)

            timer = self._node.create_timer(0.5, retry)

        self._request_names(on_names)

    def _on_spawned(self) -> None:
        if self._arguments.unpause:
            service_type = "std_srvs/srv/Empty"
            self._call_service(
                service_type,
                "unpause_physics",
                get_service(service_type).Request(),
                lambda _: self._finish_unless_bound(),
            )
        else:
            self._finish_unless_bound()

    def _finish_unless_bound(self) -> None:
        if not self._arguments.b:
            self._finish(0)


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the command line, whose long options begin with a single dash.

    Raises:
        LinkwrightError: NODE810, the command line is invalid.
    """
    parser = argparse.ArgumentParser(prog="spawn_entity.py", add_help=False, exit_on_error=False, allow_abbrev=False)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("-file")
    source.add_argument("-topic")
    source.add_argument("-database")
    source.add_argument("-stdin", action="store_true")
    parser.add_argument("-entity", required=True)
    parser.add_argument("-reference_frame", default="")
    parser.add_argument("-gazebo_namespace", default="")
    parser.add_argument("-robot_namespace")
    parser.add_argument("-timeout", type=float, default=30.0)
    parser.add_argument("-unpause", action="store_true")
    parser.add_argument("-wait")
    for name in ("-x", "-y", "-z", "-R", "-P", "-Y"):
        parser.add_argument(name, type=float, default=0.0)
    parser.add_argument("-package_to_model", action="store_true")
    parser.add_argument("-b", action="store_true")
    # argparse ends the program if a required option is missing, and up to Python 3.12 even with exit_on_error=False.
    parser.error = _refuse  # type: ignore[method-assign]  # on purpose, see above
    try:
        return parser.parse_args(arguments)
    except argparse.ArgumentError as error:
        _refuse(str(error))


def _refuse(message: str) -> NoReturn:
    text = phrase("spawn_entity.py: {message}", message=foreign(message))
    hint = phrase("give it a name and a source, such as -entity robot -topic robot_description")
    raise LinkwrightError(Diagnostic("NODE810", text, hint=hint))
