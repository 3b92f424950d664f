"""The world of a run, and the plugin through which the judge monitors it.

The world is the exercise's, with the models of the judge and a plugin. It is a file of its own, so that the judged run
and a run in real time (``linkwright sim``) use the same one. The plugin publishes the state of the judge on
``/judge/status``, a ``std_msgs/String`` with JSON.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import partial
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from linkwright.diagnostics import phrase
from linkwright.learning.errors import file_error
from linkwright.learning.judging.exercise import Exercise, load_exercise
from linkwright.learning.judging.judge import Judge
from linkwright.learning.judging.robots import include_robot, write_robot
from linkwright.learning.judging.scene import Scene
from linkwright.messages import String
from linkwright.simulation.plugins.plugin import SimulatedPlugin

JUDGE_FILE, WORLD_FILE = "judge.py", "world.sdf"
STATUS_TOPIC = "/judge/status"
_UPDATE_RATE_HZ, _STATUS_RATE_HZ = 50.0, 5.0


@dataclass(frozen=True)
class Arrangement:
    """The world of a run, the robot and its initial pose.

    Attributes:
        world: the file of the world.
        robot: the file of the robot, or None if the world contains it.
        pose: the pose of the robot's frame: x, y, z in m, roll, pitch, yaw in rad.
    """

    world: Path
    robot: Path | None
    pose: tuple[float, float, float, float, float, float]


def create_judge(exercise: Exercise, seed: int) -> Judge:
    """Create the judge of a run.

    Raises:
        LinkwrightError: LEARN140, ``judge.py`` contains no judge.
    """
    path = exercise.folder / JUDGE_FILE
    spec = spec_from_file_location(f"linkwright_judge_{exercise.id}", path)
    assert spec is not None, "a file that ends in .py has a loader"
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    for value in vars(module).values():
        if isinstance(value, type) and issubclass(value, Judge) and value.__module__ == spec.name:
            return value(exercise, seed)
    raise file_error("LEARN140", path, phrase("the file contains no class that derives from Judge"))


def write_world(exercise: Exercise, seed: int, folder: Path, *, publishes: bool) -> Arrangement:
    """Write the world of a run and its robot into a folder.

    Args:
        exercise: the exercise with its world and judge.
        seed: the seed of the run.
        folder: the folder, in which the file gets a name of its own.
        publishes: whether the judge publishes its state, which a judged program must not receive.

    Raises:
        LinkwrightError: LEARN140, the exercise has no judge; or the robot has errors.
        OSError: a file cannot be written.
    """
    scene = Scene()
    create_judge(exercise, seed).arrange(scene)
    for other in scene.robots:
        scene.add_sdf(include_robot(other, exercise.folder, folder))
    plugin = (
        f'<plugin name="judge" filename="liblinkwright_judge.so"><exercise>{escape(str(exercise.folder))}</exercise>'
        f"<seed>{seed}</seed><publish>{str(publishes).lower()}</publish></plugin>"
    )
    text = (exercise.folder / WORLD_FILE).read_text(encoding="utf-8")
    path = folder / f"{exercise.id}-{seed}.sdf"
    path.write_text(scene.insert_into(text, plugin), encoding="utf-8")
    x, y, yaw = scene.start
    robot = write_robot(exercise.robot, exercise.arguments, exercise.folder, folder) if exercise.robot else None
    return Arrangement(path, robot, (x, y, scene.start_height, 0.0, 0.0, yaw))


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The plugin's parameters: the exercise's folder, the run's seed, and whether to publish."""

    exercise: str
    seed: int = 0
    publish: bool = True


class JudgePlugin(SimulatedPlugin[Parameters]):
    """The plugin that runs a judge in a simulated world.

    Attributes:
        judge: the judge of the current run.
    """

    PARAMETERS = Parameters

    def start(self) -> None:
        """Create the judge."""
        self._exercise = load_exercise(Path(self.parameters.exercise))
        self.reset()
        for topic, msg_type in self.judge.TOPICS:
            self.node.subscribe(msg_type, topic, partial(self._receive, topic))
        self._outputs = {topic: self.node.publisher(msg_type, topic) for topic, msg_type in self.judge.PUBLISHED}
        self.every(_UPDATE_RATE_HZ, self._watch)
        if self.parameters.publish:
            self._status = self.node.publisher("std_msgs/msg/String", STATUS_TOPIC, 10)
            self.every(_STATUS_RATE_HZ, self._publish)

    def reset(self) -> None:
        """Start another run with the same seed."""
        self.judge = create_judge(self._exercise, self.parameters.seed)
        self.judge.arrange(Scene())  # again, because the judge remembers what it has placed
        self._has_begun = False

    def _watch(self) -> None:
        if not self._has_begun:
            if not all(model in self.simulation.scene.models for model in self._exercise.models):
                return
            self.judge.begin(self.simulation, lambda topic, message: self._outputs[topic].publish(message))
            self._has_begun = True
        self.judge.watch()

    def _receive(self, topic: str, message: Any) -> None:
        if self._has_begun and not self.judge.is_finished:
            self.judge.on_message(topic, message)

    def _publish(self) -> None:
        if self._status.is_wanted:
            self._status.publish(String(data=json.dumps(status(self.judge), ensure_ascii=False)))


def status(judge: Judge) -> dict[str, Any]:
    """Return the state of a judge as data for JSON."""
    figure = judge.exercise.figure
    return {
        "exercise": judge.exercise.id,
        "time": round(judge.time, 2),
        "figure": round(judge.figure, figure.decimals),
        "name": figure.name.texts,
        "unit": figure.unit,
        "progress": round(judge.progress, 3),
        "collisions": judge.collisions,
        "is_solved": judge.is_solved,
        "is_finished": judge.is_finished,
        "score": judge.score,
        "reasons": [reason.texts for reason in judge.reasons],
    }
