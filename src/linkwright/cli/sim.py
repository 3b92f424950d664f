"""``linkwright sim``: simulate a world, with a robot in it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.assignments import parse_assignments
from linkwright.cli.simulation_options import add_simulation_options, positive
from linkwright.cli.view import add_viewer_options
from linkwright.diagnostics import Diagnostic, phrase, print_diagnostics

if TYPE_CHECKING:
    from linkwright.hosting.simulated import SimulatedWorld
    from linkwright.packages import PackageFinder


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("world", metavar="WORLD", help="a file in SDF, or the name of a world; empty is a plane")
    parser.add_argument("robot", metavar="ROBOT", nargs="?", help="a URDF, xacro or SDF file of what is put into it")
    parser.add_argument(
        "values", metavar="NAME:=VALUE", nargs="*", default=[], help="values for the robot's <xacro:arg>"
    )
    parser.add_argument("-x", metavar="M", type=float, default=0.0, help="where the robot begins, along x (m)")
    parser.add_argument("-y", metavar="M", type=float, default=0.0, help="the same along y")
    parser.add_argument("-z", metavar="M", type=float, default=0.0, help="the same upwards")
    parser.add_argument("-Y", metavar="RAD", type=float, default=0.0, help="how far the robot is turned (rad)")
    add_simulation_options(parser)
    parser.add_argument("--step", metavar="S", type=positive, default=0.0, help="the time step (default: the world's)")
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="what noise follows from (default: 0)")
    parser.add_argument("--pause", action="store_true", help="begin paused")
    add_viewer_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Simulate until the user ends it; 1 when something is wrong with the world or the robot."""
    from linkwright.hosting.plans import HostOptions
    from linkwright.hosting.simulated import SimulatedWorld, run_simulated
    from linkwright.packages import PackageFinder
    from linkwright.simulation.library import load_mujoco
    from linkwright.simulation.server.worlds import load_world

    load_mujoco()
    load_world(arguments.world)  # a world that cannot be had is said at once, and not in the middle of a log
    path = Path(arguments.robot or arguments.world).absolute()
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    world = SimulatedWorld(
        arguments.world,
        path,
        pose=(arguments.x, arguments.y, arguments.z, 0.0, 0.0, arguments.Y),
        seconds=arguments.seconds,
        rate=arguments.rate,
        step=arguments.step,
        seed=arguments.seed,
        paused=arguments.pause,
        headless=arguments.headless,
    )
    if arguments.robot is not None:
        with_robot = _with_robot(world, finder, parse_assignments(arguments.values))
        if with_robot is None:
            return 1
        world = with_robot
    options = HostOptions(arguments.host, arguments.port, not arguments.no_open)
    return run_simulated(world, finder, options, foxglove=arguments.foxglove)


def _with_robot(world: SimulatedWorld, finder: PackageFinder, values: dict[str, str]) -> SimulatedWorld | None:
    """The world with the robot of its path; None where that is wrong, which has been told then."""
    from dataclasses import replace

    from linkwright.descriptions import examine, is_world
    from linkwright.descriptions.conversion import as_sdf

    if is_world(world.path.name):
        from linkwright.sdf.writer import save

        converted = as_sdf(world.path, finder, arguments=values, folder=Path.cwd())
        if converted.sdf is None or not converted.sdf.models:
            print_diagnostics(converted.diagnostics or [_no_model(world.path)], sys.stderr)
            return None
        return replace(world, text=save(converted.sdf.models[0]), name=converted.sdf.models[0].name)
    description = examine(world.path, arguments=values, packages=finder)
    if description.robot is None or not description.robot.links:
        print_diagnostics(description.diagnostics, sys.stderr)
        return None
    return replace(world, description=description, text=description.text, name=description.robot.name)


def _no_model(path: Path) -> Diagnostic:
    message = phrase("there is no model in '{path}'", path=str(path))
    return Diagnostic("CLI331", message, hint=phrase("the robot is to be URDF, xacro, or SDF with a <model>"))
