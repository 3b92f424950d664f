"""The nodes that run beside the program of an exercise."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.hosting.simulated import PlannedNode
from linkwright.learning.errors import file_error
from linkwright.learning.judging.exercise import EXERCISE_FILE, Exercise, ExerciseNode
from linkwright.learning.judging.robots import create_finder
from linkwright.nodes import EXECUTABLES
from linkwright.nodes.options import NodeOptions
from linkwright.packages import use_finder

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.nodes.options import RunningNode


async def start_companions(exercise: Exercise, robot: Path | None, graph: Graph) -> list[RunningNode]:
    """Start the nodes of an exercise in a graph in lockstep, and return them.

    Raises:
        LinkwrightError: LEARN104, there is no such node; or a node cannot start.
    """
    running = []
    for node in exercise.nodes:
        create = EXECUTABLES.get((node.package, node.executable))
        if create is None:
            message = phrase("there is no node '{name}'", name=f"{node.package}/{node.executable}")
            raise file_error("LEARN104", exercise.folder / EXERCISE_FILE, message)
        options = NodeOptions(parameters=companion_parameters(exercise, node, robot), arguments=list(node.arguments))
        with use_finder(create_finder(exercise.folder)):
            running.append(create(graph, options))
    return running


def plan_companions(exercise: Exercise, robot: Path | None) -> list[PlannedNode]:
    """Return the nodes of an exercise for a world that runs in real time.

    Raises:
        LinkwrightError: see `companion_parameters`.
    """
    return [
        PlannedNode(node.package, node.executable, companion_parameters(exercise, node, robot), node.arguments)
        for node in exercise.nodes
    ]


def companion_parameters(exercise: Exercise, node: ExerciseNode, robot: Path | None) -> dict[str, Any]:
    """Return the parameters of a node, with the description of the exercise's robot.

    Args:
        exercise: the exercise.
        node: one of its nodes.
        robot: the file of the robot, as it was written for the run; None if the world contains it.

    Raises:
        LinkwrightError: the MoveIt package does not exist, or a file of it has errors.
    """
    parameters: dict[str, Any] = {}
    if node.moveit is not None:
        from linkwright.launch.moveit import MoveItConfigsBuilder  # Only a few exercises plan motions.

        with use_finder(create_finder(exercise.folder)):
            builder = MoveItConfigsBuilder(node.moveit.robot, package_name=node.moveit.package)
            parameters = builder.to_moveit_configs().to_dict()
        if robot is not None:
            parameters["robot_description"] = robot.read_text(encoding="utf-8")
    return {**parameters, **node.parameters, "use_sim_time": True}
