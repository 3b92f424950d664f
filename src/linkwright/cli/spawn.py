"""``linkwright spawn``: add a robot or model to a running simulation."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.calls import NoResponseError, call
from linkwright.cli.model_arguments import add_values
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.simulation_options import add_pose_options, load_model
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.cli.session import Session


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``spawn``."""
    parser.add_argument(
        "file", metavar="FILE", help="the URDF, xacro or SDF file of a robot or model to add to the world"
    )
    add_values(parser, values_help="values for the file's <xacro:arg>")
    parser.add_argument(
        "-name",
        "--name",
        metavar="NAME",
        default="",
        help="the model's name in the world (default: the name in the file)",
    )
    parser.add_argument(
        "--namespace", metavar="NAMESPACE", default="", help="the namespace of the ROS names that its plugins use"
    )
    add_pose_options(parser)
    add_session_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Ask the running simulation to add a model, and return 1 if the model's file has errors.

    Raises:
        LinkwrightError: CLI332, no simulation is running; CLI333, the simulation rejects the model.
    """
    from linkwright.packages import PackageFinder
    from linkwright.simulation.nodes.spawner import SPAWN_SERVICE, Entity, create_spawn_request

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
            response = await call(session, SPAWN_SERVICE, "/spawn_entity", create_spawn_request(entity, model.text))
        except NoResponseError as error:
            message = phrase("there is no running simulation to add '{name}' to", name=entity.name)
            hint = phrase("start a simulation with the same ROS_DOMAIN_ID, for example with `linkwright sim empty`")
            raise LinkwrightError(Diagnostic("CLI332", message, hint=hint)) from error
        if not response.success:
            reason = foreign(response.status_message)
            message = phrase("the simulation rejects '{name}': {reason}", name=entity.name, reason=reason)
            raise LinkwrightError(Diagnostic("CLI333", message))
        print(response.status_message)
        return 0

    return run_in_graph(arguments, job)
