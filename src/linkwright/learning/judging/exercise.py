"""Exercises, read from their folders and validated."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase, quoted_names
from linkwright.learning.course import find_courses_folder
from linkwright.learning.errors import file_error, unreadable_file_error
from linkwright.learning.local_text import LocalText

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

EXERCISE_FILE, TEMPLATE_FILE = "exercise.toml", "template.py"


@dataclass(frozen=True)
class Figure:
    """The number by which a program is judged.

    Attributes:
        name: the measured quantity.
        unit: the unit of the quantity, such as ``s``.
        none: the value that is worth no points.
        half: the value that is worth 50 points.
        full: the value that is worth 100 points.
        decimals: the number of decimals to show.
    """

    name: LocalText
    unit: str
    none: float
    half: float
    full: float
    decimals: int = 1

    def points(self, value: float) -> float:
        """Return the points for a value, from 0 to 100."""
        above_half = (value - self.half) / (self.full - self.half)
        below_half = (value - self.half) / (self.half - self.none)
        return 50.0 + 50.0 * (min(above_half, 1.0) if above_half > 0.0 else max(below_half, -1.0))


@dataclass(frozen=True)
class Rival:
    """The other robot of an exercise, driven by another program.

    Attributes:
        model: its name in the world, which is also the namespace of its topics.
        program: the file of the program that drives it, unless another one is chosen.
        topics: the topics of the robot, without the namespace.
        start: the topic of them whose first message to the learner's robot starts the program in real time.
    """

    model: str
    program: Path
    topics: tuple[str, ...]
    start: str

    @property
    def ros_arguments(self) -> list[str]:
        """The arguments that make a program for the learner's robot drive this one."""
        rules = [f"__ns:=/{self.model}", *(f"/{topic}:=/{self.model}/{topic}" for topic in self.topics)]
        return ["--ros-args", *(word for rule in rules for word in ("-r", rule))]


@dataclass(frozen=True)
class MoveItFiles:
    """A MoveIt configuration package, whose files are the parameters of a node.

    Attributes:
        package: the name of the package.
        robot: the name of the robot in it, from which the names of its files derive.
    """

    package: str
    robot: str


@dataclass(frozen=True)
class ExerciseNode:
    """A node that runs beside the program, such as one that plans motions.

    Attributes:
        package: the package of the node.
        executable: the name of its executable.
        arguments: the command line without the name of the program.
        parameters: the values of parameters.
        moveit: the package with further parameters, and None for a node without them.
    """

    package: str
    executable: str
    arguments: tuple[str, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)
    moveit: MoveItFiles | None = None


@dataclass(frozen=True)
class Exercise:
    """A programming exercise whose result a judge measures in simulation.

    Attributes:
        folder: its folder, whose name is the name of the exercise.
        title: the title in each language.
        difficulty: from 1 (easy) to 5.
        minutes: the estimated time that a learner needs.
        needs: the extras of Linkwright that the exercise needs, such as ``sim``.
        robot: the file of the robot, or its ``package://`` URI; empty if the world contains it.
        arguments: the robot's xacro arguments.
        model: the name of the robot in the world.
        time_limit: the simulated time after which a run ends, in s.
        collision_cost: the points subtracted for each collision of the robot.
        figure: the number by which a program is judged.
        rival: the other robot, or None.
        nodes: the nodes that run beside the program.
        settings: further values for the judge.
    """

    folder: Path
    title: LocalText
    difficulty: int
    minutes: int
    needs: tuple[str, ...]
    robot: str
    arguments: Mapping[str, object]
    model: str
    time_limit: float
    collision_cost: float
    figure: Figure
    rival: Rival | None = None
    nodes: tuple[ExerciseNode, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """The name of the exercise in commands."""
        return self.folder.name

    @property
    def models(self) -> tuple[str, ...]:
        """The names of the robots in the world, the learner's first."""
        return (self.model,) if self.rival is None else (self.model, self.rival.model)

    @property
    def template(self) -> Path:
        """The program from which the learner starts."""
        return self.folder / TEMPLATE_FILE

    def solution(self, name: str) -> Path:
        """Return a solution that the exercise comes with: ``reference`` or ``simple``."""
        return self.folder / "solutions" / f"{name}.py"

    def text(self, language: str) -> str:
        """Return the Markdown of the exercise in a language, or in English."""
        translated = self.folder / f"README.{language}.md"
        return (translated if translated.is_file() else self.folder / "README.md").read_text(encoding="utf-8")


def find_exercises_folder() -> Path | None:
    """Return the folder of the shipped exercises, or None if there is none."""
    courses = find_courses_folder()
    return None if courses is None else courses / "exercises"


def list_exercise_names() -> list[str]:
    """Return the names of the shipped exercises, from easy to difficult."""
    folder = find_exercises_folder()
    files = [] if folder is None else sorted(folder.glob(f"*/{EXERCISE_FILE}"))
    exercises = [load_exercise(file.parent) for file in files]
    return [exercise.id for exercise in sorted(exercises, key=lambda exercise: (exercise.difficulty, exercise.minutes))]


def find_exercise(name: str) -> Exercise:
    """Return an exercise: a shipped one by its name, or any by the path of its folder.

    Raises:
        LinkwrightError: LEARN141, there is no such exercise; or the errors of `load_exercise`.
    """
    shipped = find_exercises_folder()
    for folder in (Path(name), *([] if shipped is None else [shipped / name])):
        if (folder / EXERCISE_FILE).is_file():
            return load_exercise(folder)
    names = list_exercise_names()
    raise LinkwrightError(
        Diagnostic(
            "LEARN141",
            phrase("there is no exercise '{name}'", name=name),
            hint=did_you_mean(name, names)
            or phrase(
                "pass a folder with a {file}, or the name of a shipped exercise: {names}",
                file=EXERCISE_FILE,
                names=quoted_names(names),
            ),
        )
    )


def load_exercise(folder: Path) -> Exercise:
    """Read an exercise.

    Raises:
        LinkwrightError: LEARN102, the file cannot be read; LEARN104, it is not valid.
    """
    folder = folder.resolve()
    path = folder / EXERCISE_FILE
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable_file_error(path, error) from None
    except tomllib.TOMLDecodeError as error:
        raise file_error("LEARN104", path, phrase("the file is not valid TOML: {error}", error=str(error))) from None
    try:
        return _exercise_from_data(folder, data)
    except KeyError as error:
        raise file_error("LEARN104", path, phrase("the key '{name}' is missing", name=str(error.args[0]))) from None
    except (TypeError, ValueError, AttributeError) as error:
        raise file_error("LEARN104", path, phrase("a value is not valid: {error}", error=str(error))) from None


def _exercise_from_data(folder: Path, data: Mapping[str, Any]) -> Exercise:
    figure = data["figure"]
    half, full = float(figure["half"]), float(figure["full"])
    none = float(figure.get("none", 2.0 * half - full))
    if not (none < half < full or none > half > full):
        raise ValueError("figure.none, figure.half and figure.full must be in order")
    return Exercise(
        folder,
        LocalText(data["title"]),
        int(data["difficulty"]),
        int(data["minutes"]),
        tuple(data["needs"]),
        str(data.get("robot", "")),
        dict(data.get("arguments", {})),
        str(data["model"]),
        float(data["time_limit"]),
        float(data.get("collision_cost", 10.0)),
        Figure(LocalText(figure["name"]), str(figure["unit"]), none, half, full, int(figure.get("decimals", 1))),
        _rival_from_data(folder, data["rival"]) if "rival" in data else None,
        tuple(map(_node_from_data, data.get("nodes", ()))),
        dict(data.get("settings", {})),
    )


def _node_from_data(data: Mapping[str, Any]) -> ExerciseNode:
    moveit = data.get("moveit")
    return ExerciseNode(
        str(data["package"]),
        str(data["executable"]),
        tuple(map(str, data.get("arguments", ()))),
        dict(data.get("parameters", {})),
        None if moveit is None else MoveItFiles(str(moveit["package"]), str(moveit["robot"])),
    )


def _rival_from_data(folder: Path, data: Mapping[str, Any]) -> Rival:
    return Rival(str(data["model"]), folder / str(data["program"]), tuple(map(str, data["topics"])), str(data["start"]))
