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
            wanted = self._arguments = parse(arguments)
            self._environment = options.environment
            namespace = self._node.get_namespace() if wanted.robot_namespace is None else wanted.robot_namespace
            entity = Entity(
                wanted.entity,
                (wanted.x, wanted.y, wanted.z),
                (wanted.R, wanted.P, wanted.Y),
                namespace,
                wanted.reference_frame,
            )
            self._prepare(self._node, entity, service_namespace=wanted.gazebo_namespace or "", timeout=wanted.timeout)
            if wanted.wait is None:
                self._begin()
            else:
                self._log(f"Waiting for entity {wanted.wait} to exist")
                self._wait_for_entity(wanted.wait)

    def close(self) -> None:
        """Close the node, and delete the entity if ``-b`` was given."""
        if self._arguments.b and self._described and not self.finished.done():
            service_type = get_service("gazebo_msgs/srv/DeleteEntity")
            client = self._node.create_client(service_type, f"{self._service_namespace}/delete_entity")
            client.call_async(service_type.Request(name=self._entity.name))
        super().close()

    def _begin(self) -> None:
        arguments = self._arguments
        if arguments.topic is not None:
            self._wait_for(arguments.topic)
        elif arguments.file is not None:
            self._spawn(read_description(arguments.file, self._environment))
        elif arguments.database is not None:
            self._spawn(read_description(f"model://{arguments.database}", self._environment))
        else:
            self._spawn(read_stdin())

    def _spawn(self, text: str) -> None:
        super()._spawn(text.replace("package://", "model://") if self._arguments.package_to_model else text)

    def _wait_for_entity(self, name: str) -> None:
        def look(names: list[str]) -> None:
            if name in names:
                self._begin()
                return

            def again() -> None:
                timer.cancel()
                self._wait_for_entity(name)

            timer = self._node.create_timer(0.5, again)

        self._request_names(look)

    def _spawned(self) -> None:
        if self._arguments.unpause:
            service_type = "std_srvs/srv/Empty"
            self._call_service(
                service_type, "unpause_physics", get_service(service_type).Request(), lambda _: self._stay_or_end()
            )
        else:
            self._stay_or_end()

    def _stay_or_end(self) -> None:
        if not self._arguments.b:
            self._end(0)


def parse(words: Sequence[str]) -> argparse.Namespace:
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
        return parser.parse_args(words)
    except argparse.ArgumentError as error:
        _refuse(str(error))


def _refuse(message: str) -> NoReturn:
    text = phrase("spawn_entity.py: {message}", message=foreign(message))
    hint = phrase("give it a name and a source, such as -entity robot -topic robot_description")
    raise LinkwrightError(Diagnostic("NODE810", text, hint=hint))
