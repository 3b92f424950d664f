"""The guide of a course: it shows and checks steps, and handles page requests.

Steps are checked when files are saved.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, foreign
from linkwright.graph import Logger
from linkwright.learning.checks.results import CheckResult, StepResult
from linkwright.learning.classroom import REPLACED_FOLDER, Classroom
from linkwright.learning.course import Step
from linkwright.learning.page.check_runner import CheckRunner
from linkwright.learning.page.guide import Guide, Publish, problem_message
from linkwright.learning.page.step_html import render_html
from linkwright.learning.progress import PROGRESS_FILE
from linkwright.page.program_pages import ProgramPages
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage

_DEBOUNCE_MS = 400
"""The longest time, in ms, for which changes of files are collected before the checks run."""

_PAUSE_DELAY_S = 1.0
"""The time, in s, after which running worlds are paused for the checks, since longer checks run a simulation."""

_UNWATCHED_FOLDERS = frozenset({"build", "install", "log", "__pycache__", REPLACED_FOLDER})
"""Folders of the workspace whose files are generated."""


class CourseGuide(Guide):
    """The guide of a learner through a course, on the running event loop.

    Args:
        classroom: the course in the learner's workspace.
        publish: sends a message to all pages.
        logger: logs the reason if files cannot be watched.
        on_changed: called with the robot's file to show beside the step, or None, when a step is opened and when
            files of the workspace have changed.
        programs: the programs in the terminals, whose worlds are paused while checks simulate.
    """

    def __init__(
        self,
        classroom: Classroom,
        publish: Publish,
        logger: Logger,
        on_changed: Callable[[Path | None], object],
        programs: ProgramPages,
    ) -> None:
        self._classroom = classroom
        self._publish = publish
        self._logger = logger
        self._on_changed = on_changed
        self._runner = CheckRunner(classroom.workspace, self._show_result)
        self._programs = programs
        programs.on_pause = lambda: self._publish(self._make_checks_message())
        self._pause_timer: asyncio.TimerHandle | None = None
        self._results: dict[str, messages.StepChecks] = {}
        self._step = classroom.current_step
        self._watch_task = asyncio.get_running_loop().create_task(self._watch_files(classroom.workspace))
        self._handlers: Mapping[type[PageMessage], Callable[[Any], object]] = {
            messages.OpenStep: lambda message: self._open(classroom.course.find_step(message.address)),
            messages.CheckStep: lambda _: self._check(),
            messages.AnswerStep: self._answer,
            messages.TakeHint: self._take_hint,
            messages.TakeSolution: self._take_solution,
            messages.RequestCatchUp: lambda _: self._publish(self._make_catch_up_files()),
            messages.CatchUp: self._catch_up,
        }
        self._open(self._step)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the messages with the course, the shown step and the results of its checks."""
        return [self._make_course_message(), self._make_step_message(), self._make_checks_message()]

    def handle(self, message: PageMessage) -> None:
        """Handle a request of a page."""
        self._handlers[type(message)](message)

    def close(self) -> None:
        """Stop watching files and running checks."""
        self._watch_task.cancel()
        self._runner.close()
        self._stop_pause_timer()
        self._programs.resume_worlds()

    def _open(self, step: Step) -> None:
        self._classroom.open_step(step)
        self._step = step
        self._publish(self._make_course_message())
        self._publish(self._make_step_message())
        self._on_changed(self._classroom.find_shown_file(step))
        self._check()

    def _check(self) -> None:
        self._runner.request(self._step, self._classroom.progress.step(self._step.address).answer)
        if self._pause_timer is None:
            self._pause_timer = asyncio.get_running_loop().call_later(_PAUSE_DELAY_S, self._programs.pause_worlds)
        self._publish(self._make_checks_message())

    def _stop_pause_timer(self) -> None:
        if self._pause_timer is not None:
            self._pause_timer.cancel()
            self._pause_timer = None

    def _answer(self, message: messages.AnswerStep) -> None:
        self._classroom.record_answer(self._step, message.answer.strip())
        self._publish(self._make_step_message())
        self._check()

    def _take_hint(self, _: messages.TakeHint) -> None:
        self._classroom.take_hint(self._step)
        self._publish(self._make_step_message())

    def _take_solution(self, _: messages.TakeSolution) -> None:
        self._classroom.take_solution(self._step)
        self._publish(self._make_step_message())
        self._on_changed(self._classroom.find_shown_file(self._step))
        self._check()

    def _make_catch_up_files(self) -> messages.CatchUpFiles:
        plan = self._classroom.plan_catch_up(self._step)
        new, replaced = (sorted(map(str, files)) for files in (plan.new, plan.replaced))
        return messages.CatchUpFiles(self._step.address, new, replaced)

    def _catch_up(self, _: messages.CatchUp) -> None:
        self._classroom.catch_up(self._step)
        self._publish(self._make_course_message())
        self._publish(self._make_step_message())
        self._on_changed(self._classroom.find_shown_file(self._step))
        self._check()

    def _show_result(self, step: Step, result: StepResult) -> None:
        self._stop_pause_timer()
        self._programs.resume_worlds()
        items = [_make_check_item(check) for check in result.checks]
        self._results[step.address] = messages.StepChecks(
            step.address, is_running=False, is_world_paused=False, checks=items, checked_at=time.time()
        )
        try:
            self._classroom.record_result(step, result)
        except LinkwrightError as error:
            self._publish(problem_message(error))
        self._publish(self._make_checks_message())
        self._publish(self._make_course_message())

    def _make_course_message(self) -> messages.Course:
        classroom = self._classroom
        lessons = [
            messages.CourseLesson(
                lesson.id,
                lesson.title.texts,
                [self._make_step_item(step) for step in lesson.steps],
            )
            for lesson in classroom.course.lessons
        ]
        return messages.Course(classroom.course.title.texts, str(classroom.workspace), "", lessons)

    def _make_step_item(self, step: Step) -> messages.CourseStepItem:
        noted = self._classroom.progress.step(step.address)
        return messages.CourseStepItem(
            step.address, step.title.texts, is_passed=noted.passed is not None, is_taken_over=noted.taken_over
        )

    def _make_step_message(self) -> messages.CourseStep:
        classroom = self._classroom
        step, noted = self._step, classroom.progress.step(self._step.address)
        folder = step.lesson.folder
        is_first = step.id == step.lesson.steps[0].id
        hint_count = len(step.text("").hints)
        solution, shown_file = classroom.list_solution_files(step), classroom.find_shown_file(step)
        return messages.CourseStep(
            step.address,
            lesson=step.lesson.title.texts,
            title=step.title.texts,
            introduction={
                language: render_html(text.introduction, folder) if is_first else ""
                for language, text in step.lesson.texts.items()
            },
            body={language: render_html(text.body, folder) for language, text in step.texts.items()},
            hints=[
                {language: render_html(text.hints[index], folder) for language, text in step.texts.items()}
                for index in range(min(noted.hints, hint_count))
            ],
            hint_count=hint_count,
            files=[str(path) for path in solution if path == shown_file or path.name in step.text("").body],
            solution=[str(path) for path in solution],
            has_solution=bool(solution) or step.right_answer is not None,
            unit=step.unit,
            answer=noted.answer,
            right_answer=step.right_answer if noted.solution else None,
            missing_count=len(classroom.find_steps_to_catch_up(step)),
        )

    def _make_checks_message(self) -> messages.StepChecks:
        known = self._results.get(self._step.address)
        return messages.StepChecks(
            self._step.address,
            is_running=self._runner.is_running,
            is_world_paused=self._programs.is_world_paused,
            checks=[] if known is None else known.checks,
            checked_at=None if known is None else known.checked_at,
        )

    async def _watch_files(self, workspace: Path) -> None:
        """Check the shown step whenever files of the workspace have changed."""
        import watchfiles

        try:
            async for changes in watchfiles.awatch(workspace, watch_filter=None, debounce=_DEBOUNCE_MS):
                paths = [Path(path) for _, path in changes]
                self._handle_changes([path for path in paths if _is_watched(path, workspace)])
        except (OSError, RuntimeError) as error:
            reason = foreign(str(error))
            self._logger.warning(f"The files of the workspace are not watched: {reason}")

    def _handle_changes(self, paths: list[Path]) -> None:
        if any(path.name == PROGRESS_FILE for path in paths):
            try:
                self._classroom.reload()
            except LinkwrightError as error:
                self._publish(problem_message(error))
            self._publish(self._make_course_message())
            self._publish(self._make_step_message())
        if any(path.name != PROGRESS_FILE for path in paths):
            self._on_changed(self._classroom.find_shown_file(self._step))
            self._check()


def _is_watched(path: Path, workspace: Path) -> bool:
    """Return whether a change of a path may change the result of a check."""
    try:
        parts = path.relative_to(os.path.realpath(workspace)).parts
    except ValueError:
        parts = path.relative_to(workspace).parts if path.is_relative_to(workspace) else ()
    return bool(parts) and not any(part.startswith(".") or part in _UNWATCHED_FOLDERS for part in parts)


def _make_check_item(check: CheckResult) -> messages.StepCheck:
    message = None if check.message is None else check.message.texts
    return messages.StepCheck(check.title.texts, is_passed=check.passed, message=message)
