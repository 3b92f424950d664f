"""The course of a learner: steps, texts, results of checks, hints and solutions.

The server owns the course and the learner's progress. All pages show the same step. Texts of courses are sent in all
their languages, by the language's tag, and the page selects one.
"""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class CourseStepItem(Record):
    """A step in the outline of a course.

    `address` is ``LESSON/STEP``. `is_taken_over` is whether the learner took it over from the course.
    """

    address: str
    title: dict[str, str]
    is_passed: bool
    is_taken_over: bool


class CourseLesson(Record):
    """A lesson in the outline of a course."""

    id: str
    title: dict[str, str]
    steps: list[CourseStepItem]


class Course(ServerMessage):
    """The outline of the course, with the learner's progress.

    It is sent when a page opens, and again when the progress changes. `folder` is the learner's workspace. `file` is
    the absolute path of the file that the editor shows first, or empty for the file of the robot.
    """

    title: dict[str, str]
    folder: str
    file: str
    lessons: list[CourseLesson]


class CourseStep(ServerMessage):
    """The step that is shown.

    Texts are HTML without scripts. `introduction` is the introduction of the lesson if this is its first step, or
    empty. `hints` are the hints that the learner has taken, of `hint_count` hints. `solution` lists the files that the
    solution writes, and `files` the files among them that the page shows or the text mentions, all as absolute paths.
    `unit` is the unit of the number that the step asks for, or None if it asks for none. `answer` is the learner's
    answer as text. `right_answer` is the right answer, or None before the learner has taken the solution.
    `has_solution` is whether there is a solution. `missing_count` is the number of earlier steps that are neither
    passed nor taken over, and whose files this step may need.
    """

    address: str
    lesson: dict[str, str]
    title: dict[str, str]
    introduction: dict[str, str]
    body: dict[str, str]
    hints: list[dict[str, str]]
    hint_count: int
    files: list[str]
    solution: list[str]
    has_solution: bool
    unit: str | None
    answer: str | None
    right_answer: str | None
    missing_count: int


class StepCheck(Record):
    """The result of one check.

    `message` describes what is missing, or is None if the check is satisfied.
    """

    title: dict[str, str]
    is_passed: bool
    message: dict[str, str] | None


class StepChecks(ServerMessage):
    """The last results of a step's checks, and whether the checks run or have paused a running world.

    `checks` is empty before the first results. `checked_at` is the time of the results in seconds since the epoch, or
    None if there are none.
    """

    address: str
    is_running: bool
    is_world_paused: bool
    checks: list[StepCheck]
    checked_at: float | None


class CourseProblem(ServerMessage):
    """The reason why the last request of a page failed, and a hint; both may be empty."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ()

    message: str
    hint: str


class CatchUpFiles(ServerMessage):
    """The files that `CatchUp` would write, as absolute paths. Response to `RequestCatchUp`."""

    address: str
    new: list[str]
    replaced: list[str]


class OpenStep(PageMessage):
    """A request to show a step."""

    address: str


class CheckStep(PageMessage):
    """A request to run the checks of the shown step again."""


class AnswerStep(PageMessage):
    """The learner's answer to the shown step."""

    answer: str


class TakeHint(PageMessage):
    """A request for one more hint for the shown step."""


class TakeSolution(PageMessage):
    """A request to copy the solution of the shown step into the workspace."""


class RequestCatchUp(PageMessage):
    """A request for the files that `CatchUp` would write."""


class CatchUp(PageMessage):
    """A request to bring the workspace into the course's state before the shown step."""
