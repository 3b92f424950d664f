"""Courses and lessons, read from their folders and validated."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, display_path, phrase, quoted_names
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.learning.errors import file_error, unreadable_file_error
from linkwright.learning.lesson_text import LessonText, StepText, read_lesson_text
from linkwright.learning.local_text import LocalText

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

COURSE_FILE, LESSON_FILE, CHECKS_FILE, CASES_FILE = "course.toml", "lesson.toml", "checks.py", "cases.py"
DEFAULT_COURSE = "robot"


@dataclass(frozen=True)
class Step:
    """A step of a lesson.

    Attributes:
        lesson: the lesson that contains the step.
        id: the name of the step, the same in all languages.
        texts: the text in each language of the lesson.
    """

    lesson: Lesson
    id: str
    texts: Mapping[str, StepText]

    @property
    def address(self) -> str:
        """The name of the step in progress files and commands: ``LESSON/STEP``."""
        return f"{self.lesson.id}/{self.id}"

    @property
    def title(self) -> LocalText:
        """The title in each language."""
        return LocalText({language: text.title for language, text in self.texts.items()})

    @property
    def points(self) -> float:
        """The points that a grade includes for the step."""
        return self.lesson.points.get(self.id, 1)

    @property
    def unit(self) -> str | None:
        """The unit of the number that the step asks for, or None if the step has no question."""
        return next(iter(self.texts.values())).unit

    @property
    def shown_file(self) -> str | None:
        """The robot's file that the page shows from this step on; None for no change.

        The path is relative to the workspace.
        """
        return next(iter(self.texts.values())).shown_file

    def text(self, language: str) -> StepText:
        """Return the text in a language, or in the first language that the lesson has."""
        return self.texts.get(language) or next(iter(self.texts.values()))

    @property
    def solution(self) -> Path:
        """The folder with the files of the solution; it need not exist."""
        return self.lesson.folder / "solution" / self.id

    @property
    def right_answer(self) -> str | None:
        """The correct answer, a number as text; None if the lesson does not contain it.

        Raises:
            LinkwrightError: LEARN102, the file with the number cannot be read.
        """
        path = self.solution.with_name(f"{self.id}.answer")
        try:
            return path.read_text(encoding="utf-8").strip() if self.unit is not None else None
        except FileNotFoundError:
            return None
        except (OSError, UnicodeDecodeError) as error:
            raise unreadable_file_error(path, error) from None


@dataclass(frozen=True)
class Lesson:
    """A lesson of a course.

    Attributes:
        folder: the lesson's folder, whose name is the lesson's name.
        title: the title in each language.
        needs: the extras of Linkwright that the lesson needs, such as ``sim``.
        texts: the text in each language.
        points: the points of steps, by the step's name; other steps have 1 point.
    """

    folder: Path
    title: LocalText
    needs: tuple[str, ...]
    texts: Mapping[str, LessonText]
    points: Mapping[str, float] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """The lesson's name in progress files and commands."""
        return self.folder.name

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """The steps in order."""
        first = next(iter(self.texts.values()))
        return tuple(
            Step(self, step.id, {language: text.steps[index] for language, text in self.texts.items()})
            for index, step in enumerate(first.steps)
        )

    @property
    def start(self) -> Path:
        """The folder with the initial files of the lesson; it need not exist."""
        return self.folder / "start"


@dataclass(frozen=True)
class Course:
    """A course.

    Attributes:
        folder: the course's folder, whose name is the course's name.
        title: the title in each language.
        lessons: the lessons in order.
    """

    folder: Path
    title: LocalText
    lessons: tuple[Lesson, ...]

    @property
    def id(self) -> str:
        """The course's name in progress files and commands."""
        return self.folder.name

    @property
    def steps(self) -> tuple[Step, ...]:
        """The steps of all lessons in order."""
        return tuple(step for lesson in self.lessons for step in lesson.steps)

    def files_before(self, step: Step) -> dict[Path, Path]:
        """Return the files of the course before a step, by their paths in the workspace.

        These are the initial files of the lessons, and the solutions of all earlier steps.
        """
        files: dict[Path, Path] = {}
        for earlier_step in self.steps[: self.steps.index(step)]:
            files = {
                **dict(iterate_files(earlier_step.lesson.start)),
                **files,
                **dict(iterate_files(earlier_step.solution)),
            }
        return files

    def find_lessons(self, names: Sequence[str]) -> tuple[Lesson, ...]:
        """Return the lessons with the given names, or all lessons if there are none.

        Raises:
            LinkwrightError: LEARN106, there is no such lesson.
        """
        known = {lesson.id: lesson for lesson in self.lessons}
        for name in names:
            if name not in known:
                message = phrase("the course '{course}' has no lesson '{name}'", course=self.id, name=name)
                hint = did_you_mean(name, known) or phrase("its lessons are {names}", names=quoted_names(known))
                raise LinkwrightError(Diagnostic("LEARN106", message, hint=hint))
        return tuple(known[name] for name in names) or self.lessons

    def find_step(self, name: str, lessons: Sequence[Lesson] = ()) -> Step:
        """Return the step with a name: ``LESSON/STEP``, or ``STEP`` if the name is unique.

        Args:
            name: the step's name, as in commands.
            lessons: the lessons to search; all if there are none.

        Raises:
            LinkwrightError: LEARN106, there is no such step, or there are several.
        """
        steps = [step for lesson in lessons or self.lessons for step in lesson.steps]
        matches = [step for step in steps if name in {step.address, step.id}]
        if len(matches) == 1:
            return matches[0]
        if matches:
            raise LinkwrightError(
                Diagnostic(
                    "LEARN106",
                    phrase("several lessons have a step '{name}'", name=name),
                    hint=phrase("write {names}", names=quoted_names((step.address for step in matches), " or ")),
                )
            )
        names = [*(step.address for step in steps), *(step.id for step in steps)]
        message = phrase("the course '{course}' has no step '{name}'", course=self.id, name=name)
        hint = did_you_mean(name, names) or phrase("list the steps with `linkwright learn list`")
        if lessons:
            lesson_names = quoted_names([lesson.id for lesson in lessons], " or ")
            message = phrase("there is no step '{name}' in {lessons}", name=name, lessons=lesson_names)
            hint = did_you_mean(name, names) or phrase("write {names}", names=quoted_names(names[len(steps) :], " or "))
        raise LinkwrightError(Diagnostic("LEARN106", message, hint=hint))


def iterate_files(folder: Path) -> Iterator[tuple[Path, Path]]:
    """Yield the relative and the absolute path of each file below a folder.

    The folder need not exist.
    """
    for path in sorted(folder.rglob("*")) if folder.is_dir() else ():
        if path.is_file() and "__pycache__" not in path.parts:
            yield path.relative_to(folder), path


def find_courses_folder() -> Path | None:
    """Return the folder of the shipped courses, or None if there is none.

    The folder is in the wheel, or in the repository of an editable install.
    """
    package = Path(__file__).parents[1]
    return next((path for path in (package / "courses", package.parents[1] / "courses") if path.is_dir()), None)


def find_course(name: str) -> Path:
    """Return the folder of a course: a shipped one by its name, or any by its path.

    Raises:
        LinkwrightError: LEARN101, there is no such course.
    """
    shipped = find_courses_folder()
    for folder in (Path(name), *([] if shipped is None else [shipped / name])):
        if (folder / COURSE_FILE).is_file():
            return folder
    names = [] if shipped is None else sorted(file.parent.name for file in shipped.glob(f"*/{COURSE_FILE}"))
    raise LinkwrightError(
        Diagnostic(
            "LEARN101",
            phrase("there is no course '{name}'", name=name),
            hint=did_you_mean(name, names)
            or phrase(
                "pass a folder with a {file}, or the name of a shipped course: {names}",
                file=COURSE_FILE,
                names=quoted_names(names),
            ),
        )
    )


def load_course(folder: Path) -> Course:
    """Read a course with all its lessons.

    Raises:
        LinkwrightError: LEARN102, a file cannot be read; LEARN103, the text of a lesson is not valid; LEARN104, a TOML
            file is not valid; LEARN105, the languages of a lesson have different steps.
    """
    folder = folder.resolve()
    path = folder / COURSE_FILE
    data = _read_toml(path)
    names = data.get("lessons")
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise file_error("LEARN104", path, phrase("'lessons' must be a list of folder names"))
    lessons = tuple(load_lesson(folder / name) for name in names)
    return Course(folder, _read_titles(path, data), lessons)


def load_lesson(folder: Path) -> Lesson:
    """Read a lesson.

    Raises:
        LinkwrightError: as for `load_course`.
    """
    path = folder / LESSON_FILE
    data = _read_toml(path)
    title = _read_titles(path, data)
    needs = data.get("needs", [])
    if not isinstance(needs, list) or not all(isinstance(extra, str) for extra in needs):
        raise file_error("LEARN104", path, phrase("'needs' must be a list of extras of Linkwright"))
    texts = {language: read_lesson_text(folder / f"lesson.{language}.md") for language in title.texts}
    _compare_languages(list(texts.values()))
    lesson = Lesson(folder.resolve(), title, tuple(needs), texts, _read_points(path, data))
    if unknown := sorted(set(lesson.points) - {step.id for step in lesson.steps}):
        raise file_error(
            "LEARN104", path, phrase("'points' names the step '{step}', which does not exist", step=unknown[0])
        )
    return lesson


def _read_points(path: Path, data: Mapping[str, object]) -> dict[str, float]:
    points = data.get("points", {})
    if not isinstance(points, dict) or not all(_is_number_of_points(value) for value in points.values()):
        raise file_error("LEARN104", path, phrase("'points' must give each step a number of at least 0"))
    return points


def _is_number_of_points(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < math.inf


def _select_shared_properties(step: StepText) -> tuple[object, ...]:
    """Return the properties of a step that must be equal in all languages."""
    return step.id, step.unit, step.shown_file, len(step.hints)


def _compare_languages(texts: Sequence[LessonText]) -> None:
    first = texts[0]
    for other in texts[1:]:
        steps, other_steps = ([_select_shared_properties(step) for step in text.steps] for text in (first, other))
        if steps == other_steps:
            continue
        index = next(
            (index for index, pair in enumerate(zip(steps, other_steps, strict=False)) if pair[0] != pair[1]),
            min(len(steps), len(other_steps)),
        )
        line = other.steps[min(index, len(other.steps) - 1)].line
        message = phrase(
            "step {number} differs from the same step in '{other_file}': names, attributes and numbers of hints "
            "must be equal",
            number=index + 1,
            other_file=display_path(first.path),
        )
        raise file_error("LEARN105", other.path, message, line=line)


def _read_toml(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable_file_error(path, error) from None
    except tomllib.TOMLDecodeError as error:
        raise file_error("LEARN104", path, phrase("the file is not valid TOML: {error}", error=str(error))) from None


def _read_titles(path: Path, data: Mapping[str, object]) -> LocalText:
    titles = data.get("title")
    if isinstance(titles, dict) and titles and all(isinstance(title, str) for title in titles.values()):
        if unknown := sorted(set(titles) - set(LANGUAGES)):
            raise file_error("LEARN104", path, phrase("there is no language '{name}'", name=unknown[0]))
        return LocalText(titles)
    raise file_error(
        "LEARN104", path, phrase("'title' must have a text for each language, as in title.en = \"First steps\"")
    )
