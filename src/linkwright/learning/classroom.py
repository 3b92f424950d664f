"""A course in a learner's workspace: its files, checks, hints and solutions."""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.learning.checks.check_process import check_in_process
from linkwright.learning.checks.results import StepResult
from linkwright.learning.course import (
    DEFAULT_COURSE,
    Course,
    Step,
    find_course,
    find_courses_folder,
    iterate_files,
    load_course,
)
from linkwright.learning.progress import PROGRESS_FILE, Progress, read_progress, write_progress

REPLACED_FOLDER = "replaced"
"""The folder of the workspace for files that a solution replaced."""


@dataclass(frozen=True)
class FilePlan:
    """The files of a course to write into the workspace.

    Attributes:
        new: the files that do not exist yet, with the course's file for each path.
        replaced: the existing files with other content, with the course's file for each path.
    """

    new: Mapping[Path, Path]
    replaced: Mapping[Path, Path]

    @property
    def files(self) -> Mapping[Path, Path]:
        """All files to write, with the course's file for each path."""
        return {**self.new, **self.replaced}


class Classroom:
    """A course in a learner's workspace.

    Args:
        workspace: the folder of the workspace, which is created with the first file.
        course: the course that the learner takes.
        progress: the progress in the course.

    Attributes:
        workspace: the folder of the workspace.
        course: the course that the learner takes.
        progress: the progress in the course.
    """

    def __init__(self, workspace: Path, course: Course, progress: Progress) -> None:
        self.workspace = workspace
        self.course = course
        self.progress = progress

    @property
    def current_step(self) -> Step:
        """The step at which the learner continues.

        It is the step that was begun or passed last, or the first one after it that is not passed. If there is none
        after it, it is the first step of the course that is not passed, or the last step.
        """
        steps = self.course.steps
        last = max(range(len(steps)), key=lambda index: (self._find_last_time(steps[index]), index))
        begin = last if self._find_last_time(steps[last]) > -math.inf else 0
        return next((step for step in (*steps[begin:], *steps) if not self._is_passed(step)), steps[-1])

    def _is_passed(self, step: Step) -> bool:
        return self.progress.step(step.address).passed is not None

    def _find_last_time(self, step: Step) -> float:
        """Return the time when a step was last begun or passed.

        The time is in s since the epoch; minus infinity for never.
        """
        step_progress = self.progress.step(step.address)
        times = [time.timestamp() for time in (step_progress.started, step_progress.passed) if time is not None]
        return max(times, default=-math.inf)

    def open_step(self, step: Step) -> list[Path]:
        """Open a step: record the time, and copy the initial files of its lesson.

        Existing files are not changed.

        Returns:
            The copied files.

        Raises:
            LinkwrightError: LEARN111, a file cannot be written.
        """
        with _report_write_errors(self.workspace):
            copied = [
                self.workspace / name
                for name, source in iterate_files(step.lesson.start)
                if not (self.workspace / name).exists() and _copy_file(source, self.workspace / name)
            ]
        if self.progress.step(step.address).started is None:
            self._record_progress(step, started=_get_current_time())
        return copied

    def check(self, step: Step, run: Callable[..., StepResult] = check_in_process) -> StepResult:
        """Check a step, and record it as passed if all checks are satisfied.

        Args:
            step: the step to check.
            run: runs the checks; see `check_in_process`.

        Raises:
            LinkwrightError: LEARN111, the progress cannot be written.
        """
        result = run(step, self.workspace, answer=self.progress.step(step.address).answer)
        self.record_result(step, result)
        return result

    def record_result(self, step: Step, result: StepResult) -> None:
        """Record a step as passed if all its checks are satisfied.

        Raises:
            LinkwrightError: LEARN111, the progress cannot be written.
        """
        if result.passed and self.progress.step(step.address).passed is None:
            self._record_progress(step, passed=_get_current_time())

    def reload(self) -> None:
        """Read the progress file again, because another program may have changed it.

        Raises:
            LinkwrightError: LEARN102, LEARN110: the progress cannot be read.
        """
        self.progress = read_progress(self.workspace) or self.progress

    def find_shown_file(self, step: Step) -> Path | None:
        """Return the robot's file to show beside a step, or None; the file need not exist.

        It is the one that the step names, or the last one that a step before it names. It is None if there is none.
        """
        steps = self.course.steps
        names = [
            earlier_step.shown_file
            for earlier_step in steps[: steps.index(step) + 1]
            if earlier_step.shown_file is not None
        ]
        return self.workspace / names[-1] if names else None

    def list_solution_files(self, step: Step) -> list[Path]:
        """Return the paths in the workspace that the solution of a step writes."""
        return [self.workspace / name for name, _ in iterate_files(step.solution)]

    def record_answer(self, step: Step, text: str) -> None:
        """Record the learner's answer to a step.

        Raises:
            LinkwrightError: LEARN111, the progress cannot be written; LEARN112, the step asks for no number.
        """
        if step.unit is None:
            raise LinkwrightError(
                Diagnostic("LEARN112", phrase("the step '{step}' does not ask for a number", step=step.address))
            )
        self._record_progress(step, answer=text)

    def take_hint(self, step: Step) -> int:
        """Record that one more hint of a step is shown, and return the number of shown hints."""
        available = len(step.text("").hints)
        hint_count = min(self.progress.step(step.address).hints + 1, available)
        self._record_progress(step, hints=hint_count)
        return hint_count

    def take_solution(self, step: Step) -> list[Path]:
        """Copy the solution of a step into the workspace, and record that it was used.

        A step that asks for a number may have no files; `Step.right_answer` is its solution.

        Files with other content are first copied to the folder `REPLACED_FOLDER`, which colcon ignores.

        Returns:
            The files that were written.

        Raises:
            LinkwrightError: LEARN111, a file cannot be written; LEARN113, the step has no solution.
        """
        files = dict(iterate_files(step.solution))
        if not files and step.right_answer is None:
            raise LinkwrightError(
                Diagnostic("LEARN113", phrase("the step '{step}' has no solution", step=step.address))
            )
        written = self._write_files(self._plan_files(files))
        self._record_progress(step, solution=True)
        return written

    def find_steps_to_catch_up(self, step: Step) -> list[Step]:
        """Return the earlier steps with files that are neither passed nor taken over."""
        earlier_steps = self.course.steps[: self.course.steps.index(step)]
        steps_with_progress = [
            (earlier_step, self.progress.step(earlier_step.address)) for earlier_step in earlier_steps
        ]
        return [
            earlier_step
            for earlier_step, done in steps_with_progress
            if done.passed is None and not done.taken_over and earlier_step.solution.is_dir()
        ]

    def plan_catch_up(self, step: Step) -> FilePlan:
        """Return the files to write so that the workspace has the course's state before a step.

        Raises:
            LinkwrightError: LEARN111, a file cannot be read.
        """
        return self._plan_files(self.course.files_before(step))

    def catch_up(self, step: Step) -> list[Path]:
        """Bring the workspace into the course's state before a step.

        The earlier steps are marked as taken over. Passed steps stay passed. Files with other content are backed up as
        in `take_solution`.

        Returns:
            The files that were written.

        Raises:
            LinkwrightError: LEARN111, a file cannot be written.
        """
        written = self._write_files(self.plan_catch_up(step))
        earlier_steps = self.course.steps[: self.course.steps.index(step)]
        missing = [
            earlier_step for earlier_step in earlier_steps if self.progress.step(earlier_step.address).passed is None
        ]
        self._record_progress(*missing, taken_over=True)
        return written

    def _plan_files(self, files: Mapping[Path, Path]) -> FilePlan:
        """Return the files, by path in the workspace, that differ from the workspace's files."""
        with _report_write_errors(self.workspace):
            targets = {self.workspace / name: source for name, source in files.items()}
            new = {target: source for target, source in targets.items() if not target.exists()}
            replaced = {
                target: source
                for target, source in targets.items()
                if target not in new and target.read_bytes() != source.read_bytes()
            }
        return FilePlan(new, replaced)

    def _write_files(self, plan: FilePlan) -> list[Path]:
        """Write the files of a plan, and back up the files that they replace."""
        name = datetime.now().astimezone().strftime("%Y-%m-%d-%H%M%S")
        folders = (self.workspace / REPLACED_FOLDER / f"{name}{suffix}" for suffix in ("", *range(-2, -100, -1)))
        backup = next(folder for folder in folders if not folder.exists())
        with _report_write_errors(self.workspace):
            for target in plan.replaced:
                _copy_file(target, backup / target.relative_to(self.workspace))
                (backup.parent / "COLCON_IGNORE").touch()
            for target, source in plan.files.items():
                _copy_file(source, target)
        return sorted(plan.files)

    def _record_progress(self, *steps: Step, **changes: object) -> None:
        self.reload()
        for step in steps:
            self.progress = self.progress.with_step(step.address, **changes)
        with _report_write_errors(self.workspace):
            self.workspace.mkdir(parents=True, exist_ok=True)
            write_progress(self.workspace, self.progress)


def find_enclosing_workspace(folder: Path) -> Path:
    """Return the nearest folder at or above a folder that has a progress file, or the folder."""
    return next((path for path in (folder, *folder.parents) if (path / PROGRESS_FILE).is_file()), folder)


def find_workspace(folder: Path, course: str | None = None) -> Path:
    """Return the workspace for a learner who works in a folder.

    It is the nearest folder with a progress file at or above the folder; the folder itself if it is empty; otherwise
    the folder ``COURSE_ws`` in it, such as ``robot_ws``.

    Args:
        folder: the folder in which the learner works.
        course: the course: the name of a shipped one, or a folder; None for the shipped course about a robot.
    """
    enclosing = find_enclosing_workspace(folder)
    if (enclosing / PROGRESS_FILE).is_file() or not any(folder.iterdir()):
        return enclosing
    return folder / f"{Path(course or DEFAULT_COURSE).name}_ws"


def open_classroom(workspace: Path, course: str | None = None) -> Classroom:
    """Open a course in a workspace.

    Args:
        workspace: the folder of the workspace, which need not exist.
        course: the course: the name of a shipped one, or a folder; None for the course of the workspace, or for the
            shipped course about a robot if the workspace is new.

    Raises:
        LinkwrightError: LEARN101 to LEARN110: the course or the progress cannot be read; LEARN114, the workspace
            belongs to another course.
    """
    progress = read_progress(workspace)
    name = course or (progress.course if progress else DEFAULT_COURSE)
    loaded = load_course(find_course(name))
    shipped = find_courses_folder()
    is_shipped = shipped is not None and loaded.folder.parent == shipped.resolve()
    known_name = loaded.id if is_shipped else str(loaded.folder)
    if progress is not None and progress.course not in {known_name, name}:
        message = phrase(
            "'{folder}' is the workspace of the course '{course}'",
            folder=display_path(workspace),
            course=progress.course,
        )
        hint = phrase("pass another folder, or rename its {file}", file=PROGRESS_FILE)
        raise LinkwrightError(Diagnostic("LEARN114", message, hint=hint))
    return Classroom(workspace, loaded, progress or Progress(known_name, {}))


def _copy_file(source: Path, target: Path) -> bool:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, target)
    return True


def _get_current_time() -> datetime:
    return datetime.now(timezone.utc).replace(microsecond=0)


@contextmanager
def _report_write_errors(workspace: Path) -> Iterator[None]:
    """Raise LEARN111 in place of an OSError in the context."""
    try:
        yield
    except OSError as error:
        path = display_path(Path(error.filename or workspace))
        message = phrase("cannot write '{path}': {error}", path=path, error=error.strerror or str(error))
        raise LinkwrightError(Diagnostic("LEARN111", message)) from error
