"""``linkwright sim``: simulate a world, optionally with a robot."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.model_arguments import add_values
from linkwright.cli.simulation_options import (
    add_pose_options,
    add_simulation_options,
    load_model,
    open_recording,
    parse_positive_seconds,
    refuse_terminal_without_page,
)
from linkwright.cli.view import add_viewer_options, find_terminal_folder
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.hosting.simulated import PlannedNode
    from linkwright.viewer import Viewer


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``sim``."""
    parser.add_argument(
        "world", metavar="WORLD", help="an SDF file, or the name of a world; the world 'empty' is a ground plane"
    )
    parser.add_argument(
        "robot", metavar="ROBOT", nargs="?", help="the URDF, xacro or SDF file of a robot or model to add"
    )
    add_values(parser, values_help="values for the robot's <xacro:arg>")
    add_pose_options(parser)
    add_simulation_options(parser)
    parser.add_argument(
        "--step", metavar="S", type=parse_positive_seconds, default=0.0, help="the time step (default: the world's)"
    )
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="the seed of noise (default: 0)")
    parser.add_argument("--pause", action="store_true", help="start paused")
    parser.add_argument("--gazebo-mistakes", action="store_true", help="let plugins reproduce the known bugs of Gazebo")
    add_viewer_options(parser)


def run(
    arguments: argparse.Namespace,
    viewer_started: Callable[[Viewer], object] | None = None,
    nodes: Sequence[PlannedNode] = (),
) -> int:
    """Simulate until the user interrupts the command.

    Args:
        arguments: the arguments of the command.
        viewer_started: called with the viewer after its start; None if no call is needed.
        nodes: the nodes to run beside the simulator.

    Returns:
        The exit status, which is 1 if the world or the robot has errors.
    """
    from linkwright.hosting.plans import HostOptions
    from linkwright.hosting.simulated import SimulatedWorld, run_simulated
    from linkwright.packages import PackageFinder
    from linkwright.simulation.library import load_mujoco
    from linkwright.simulation.plugins.drawings import has_drawings
    from linkwright.simulation.plugins.particles import PARTICLES_TOPIC, has_particles
    from linkwright.simulation.server.worlds import load_world

    refuse_terminal_without_page(arguments)
    load_mujoco()
    loaded_world = load_world(arguments.world)  # report a missing world before the simulation starts to log
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
        gazebo_mistakes=arguments.gazebo_mistakes,
        nodes=tuple(nodes),
    )
    if arguments.robot is not None:
        values = parse_assignments(arguments.values)
        model = load_model(path, values, finder)
        if model is None:
            return 1
        world = replace(
            world, description=model.description, text=model.text, name=model.name, arguments=tuple(values.items())
        )
    if has_particles(loaded_world.world, world.text) or has_drawings(loaded_world.world, world.text):
        world = replace(world, particles_topic=PARTICLES_TOPIC)
    options = HostOptions(
        arguments.host,
        arguments.port,
        not arguments.no_open,
        history=arguments.history,
        terminal=find_terminal_folder(arguments),
        needs_terminal=arguments.needs_terminal,
        viewer_started=viewer_started,
    )
    with open_recording(arguments) as writer:
        return run_simulated(world, finder, options, foxglove=arguments.foxglove, writer=writer)
