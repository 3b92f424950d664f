"""``linkwright spawn``: put a robot or model into a world that is being simulated."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.assignments import parse_assignments
from linkwright.cli.calls import NoAnswerError, call
from linkwright.cli.model_arguments import add_values
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.simulation_options import add_place_options, load_model
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", help="a URDF, xacro or SDF file of what is put into the world")
    add_values(parser, values_help="values for the file's <xacro:arg>")
    parser.add_argument(
        "-name", "--name", metavar="NAME", default="", help="what it is called in the world (default: as the file says)"
    )
    parser.add_argument(
        "--namespace", metavar="NAMESPACE", default="", help="begins the names of what its plugins bring to ROS"
    )
    add_place_options(parser)
    add_session_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Ask the simulation to take the model; 1 when the file is wrong.

    Raises:
        LinkwrightError: CLI332, there is no simulation; CLI333, it does not take the model.
    """
    from linkwright.nodes.gazebo.spawner import SPAWN_SERVICE, Entity, spawn_request
    from linkwright.packages import PackageFinder

    path = Path(arguments.file).absolute()
    model = load_model(path, parse_assignments(arguments.values), PackageFinder(start=[path.parent, Path.cwd()]))
    if model is None:
        return 1
    entity = Entity(
        arguments.name or model.name,
        (arguments.x, arguments.y, arguments.z),
        (0.0, 0.0, arguments.Y),
        arguments.namespace,
    )

    async def job(session: Session) -> int:
        try:
            response = await call(session, SPAWN_SERVICE, "/spawn_entity", spawn_request(entity, model.text))
        except NoAnswerError as error:
            message = phrase("there is no simulation to put '{name}' into", name=entity.name)
            hint = phrase("start one, such as `linkwright sim empty`, on the same ROS_DOMAIN_ID")
            raise LinkwrightError(Diagnostic("CLI332", message, hint=hint)) from error
        if not response.success:
            reason = foreign(response.status_message)
            message = phrase("the simulation does not take '{name}': {reason}", name=entity.name, reason=reason)
            raise LinkwrightError(Diagnostic("CLI333", message))
        print(response.status_message)
        return 0

    return run_in_graph(arguments, job)
