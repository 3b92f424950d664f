"""Judges, which monitor the ground truth of a simulated world and score a program."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from linkwright.learning.judging.exercise import Exercise
from linkwright.learning.local_text import LocalText
from linkwright.sdf.poses import SEPARATOR

if TYPE_CHECKING:
    from linkwright.learning.judging.scene import Scene
    from linkwright.simulation.simulation import Simulation

_MAX_UNSOLVED_POINTS = 40.0
"""The maximum number of points, of 100, for an exercise that is not solved."""
_COLLISION_PAUSE_S = 1.0
"""The time without a contact after which the next contact is another collision."""

_GROUND_NAMES = ("ground", "floor")


class Judge:
    """The judge of one run of an exercise.

    An exercise defines a subclass in its ``judge.py``. The same judge works headless and in a world that runs in real
    time: a plugin of the world calls `update` 50 times per simulated second.

    Args:
        exercise: the exercise that is judged.
        seed: the seed of the run, which determines everything that varies between runs.

    Attributes:
        TOPICS: the topics on which the program publishes its answers, with their types; see `on_message`.
        PUBLISHED: the topics on which the judge publishes tasks, with their types; see `publish`.
        exercise: the exercise that is judged.
        random: the random numbers of the run.
        time: the simulated time since the start, in s.
        figure: the number that is shown while the program runs, and judged at the end.
        progress: the completed fraction of the task, from 0 to 1.
        is_solved: whether the task is done, so that the figure counts.
        is_finished: whether the run has ended.
        collisions: the number of collisions of the robot.
        reasons: the reasons for added and subtracted points.
    """

    TOPICS: ClassVar[tuple[tuple[str, str], ...]] = ()
    PUBLISHED: ClassVar[tuple[tuple[str, str], ...]] = ()

    def __init__(self, exercise: Exercise, seed: int) -> None:
        self.exercise = exercise
        self.random = np.random.default_rng([seed, 36])
        self.time = 0.0
        self.figure = 0.0
        self.progress = 0.0
        self.is_solved = False
        self.is_finished = False
        self.collisions = 0
        self.reasons: list[LocalText] = []
        self._penalty = 0.0
        self._last_contact = -_COLLISION_PAUSE_S
        self._simulation: Simulation | None = None
        self._publish: Callable[[str, Any], object] | None = None
        self._geom_models: tuple[int, list[str]] = (-1, [])

    # --- methods for judges to override -------------------------------------------------------------------------------

    def arrange(self, scene: Scene) -> None:
        """Place the robot, and add the models that vary with the seed."""

    def start(self) -> None:
        """Prepare for a run, when all models are placed in the simulation."""

    def update(self) -> None:
        """Inspect the world, and set `figure` and `progress`.

        Call `finish` or `fail` when the run has ended.
        """
        raise NotImplementedError

    def on_message(self, topic: str, message: Any) -> None:
        """Receive an answer of the program on one of `TOPICS`."""

    def at_time_limit(self) -> None:
        """Score a run that has reached the time limit. By default, the task counts as failed."""
        self.fail(en="the task is not done", zh="任务没有完成")

    # --- methods for judges to call -----------------------------------------------------------------------------------

    @property
    def simulation(self) -> Simulation:
        """The simulation, with the ground truth of the world."""
        assert self._simulation is not None, "the run has not started"
        return self._simulation

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message on one of `PUBLISHED`."""
        assert self._publish is not None, "the run has not started"
        self._publish(topic, message)

    def pose(self, model: str = "") -> tuple[float, float, float]:
        """Return the true x and y in m and yaw in rad of a model, by default of the robot."""
        x, y, _, qx, qy, qz, qw = self.simulation.model_pose(model or self.exercise.model)
        return x, y, atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))

    def height(self, model: str = "") -> float:
        """Return the height of a model's frame above the world's origin, in m."""
        return self.simulation.model_pose(model or self.exercise.model)[2]

    def touched_models(self, model: str = "") -> set[str]:
        """Return the names of the models that touch a model, by default the robot.

        The ground is left out.
        """
        own_name = model or self.exercise.model
        data = self.simulation.data
        if not data.ncon:
            return set()
        names = self._list_model_names_by_geom()
        pairs = {(names[first], names[second]) for first, second in data.contact.geom.tolist()}
        touched = {name for pair in pairs if own_name in pair for name in pair} - {own_name}
        return {name for name in touched if name and not name.startswith(_GROUND_NAMES)}

    def finish(self, en: str = "", zh: str = "") -> None:
        """End the run as successful."""
        self.is_solved = True
        self._end(en, zh)

    def fail(self, en: str, zh: str) -> None:
        """End the run as failed. The score then depends on `progress`."""
        self._end(en, zh)

    def penalize(self, points: float, en: str, zh: str) -> None:
        """Subtract points."""
        self._penalty += points
        self.note(en, zh)

    def note(self, en: str, zh: str) -> None:
        """Add a reason for the score."""
        self.reasons.append(LocalText({"en": en, "zh": zh}))

    # --- called by runs -----------------------------------------------------------------------------------------------

    @property
    def score(self) -> float:
        """The points of the run so far, from 0 to 100."""
        figure = self.exercise.figure
        earned = figure.points(self.figure) if self.is_solved else _MAX_UNSOLVED_POINTS * self.progress
        return round(max(0.0, min(100.0, earned - self._penalty)), 1)

    def begin(self, simulation: Simulation, publish: Callable[[str, Any], object] | None = None) -> None:
        """Start to judge a run.

        Args:
            simulation: the simulation, which contains the robot.
            publish: publishes a message on a topic of `PUBLISHED`.
        """
        self._simulation, self._publish = simulation, publish
        self.start()

    def watch(self) -> None:
        """Update the judge from the current state of the simulation."""
        if self.is_finished:
            return
        self.time = self.simulation.seconds
        self._count_collisions()
        self._call_unless_finished(self.update)
        if self.time >= self.exercise.time_limit:
            self._call_unless_finished(self.at_time_limit)

    def _call_unless_finished(self, function: Callable[[], None]) -> None:
        if not self.is_finished:
            function()

    def _end(self, en: str, zh: str) -> None:
        if en:
            self.note(en, zh)
        self.is_finished = True

    def _count_collisions(self) -> None:
        touched_models = self.touched_models()
        if not touched_models:
            return
        if self.time - self._last_contact > _COLLISION_PAUSE_S:
            self.collisions += 1
            cost, names = self.exercise.collision_cost, ", ".join(sorted(touched_models))
            if cost:
                self.penalize(
                    cost,
                    en=f"the robot hit {names} at {self.time:.1f} s: -{cost:g}",
                    zh=f"机器人在 {self.time:.1f} s 时撞到了 {names}：-{cost:g}",
                )
        self._last_contact = self.time

    def _list_model_names_by_geom(self) -> list[str]:
        """Return the name of the model of each geom of MuJoCo."""
        revision, names = self._geom_models
        if revision != self.simulation.revision:
            model = self.simulation.model
            names = [model.geom(index).name.partition(SEPARATOR)[0] for index in range(model.ngeom)]
            self._geom_models = (self.simulation.revision, names)
        return names
