"""The page feature of a course: shows steps, checks them when files are saved, and carries out requests of pages."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.learning.checks.results import CheckResult, StepResult
from linkwright.learning.classroom import REPLACED_FOLDER, Classroom
from linkwright.learning.course import Step
from linkwright.learning.page.check_runner import CheckRunner
from linkwright.learning.page.step_html import step_html
from linkwright.learning.progress import PROGRESS_FILE
from linkwright.page.audience import Page
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature

_DEBOUNCE_MS = 400
"""The longest time, in ms, for which changes of files are collected before the checks run."""

_UNWATCHED_FOLDERS = frozenset({"build", "install", "log", "__pycache__", REPLACED_FOLDER})
"""Folders of the workspace whose files are generated."""


_START_HINT = phrase("start it with `linkwright learn`")


class CourseFeature(PageFeature):
    """The feature of a course, which refuses all requests before `enable`."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._room: Classroom | None = None
        self._handlers: Mapping[type[PageMessage], Callable[[Classroom, Any], object]] = {
            messages.OpenStep: lambda room, message: self._open(room.course.find_step(message.address)),
            messages.CheckStep: lambda *_: self._check(),
            messages.AnswerStep: self._answer,
            messages.TakeHint: self._take_hint,
            messages.TakeSolution: self._take_solution,
        }

    def enable(self, room: Classroom, on_changed: Callable[[Path | None], object]) -> None:
        """Show a course in the pages, from its current step on.

        Args:
            room: the course in the learner's workspace.
            on_changed: called with the robot's file that is to be shown beside the step, when a step is opened and
                when files of the workspace have changed; None if no step has named one yet.
        """
        self._room = room
        self._on_changed = on_changed
        self._runner = CheckRunner(room.workspace, self._show_result)
        self._results: dict[str, messages.StepChecks] = {}
        self._step = room.current_step
        self._watch = asyncio.get_running_loop().create_task(self._watch_files(room.workspace))
        self._open(self._step)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the course, its shown step and the results of its checks."""
        if self._room is None:
            return []
        return [self._course(self._room), self._shown_step(self._room), self._checks()]

    def receive(self, page: Page, message: Any) -> None:
        """Carry out a request, or report why not."""
        if self._room is None:
            page.send(messages.CourseProblem(phrase("this program was started without a course"), _START_HINT))
            return
        if not page.is_here:
            problem = phrase("the course can be used only in pages on the machine of the program")
            page.send(messages.CourseProblem(problem, ""))
            return
        try:
            self._handlers[type(message)](self._room, message)
        except LinkwrightError as error:
            page.send(_problem(error.diagnostics[0]))
        else:
            page.send(messages.CourseProblem("", ""))

    def close(self) -> None:
        """Stop watching files and running checks."""
        if self._room is not None:
            self._watch.cancel()
            self._runner.close()

    def _open(self, step: Step) -> None:
        assert self._room is not None, "the requests of pages are refused before"
        self._room.open_step(step)
        self._step = step
        self._publish(self._course(self._room), self._shown_step(self._room))
        self._on_changed(self._room.shown_file(step))
        self._check()

    def _check(self) -> None:
        assert self._room is not None, "the requests of pages are refused before"
        self._runner.request(self._step, self._room.progress.step(self._step.address).answer)
        self._publish(self._checks())

    def _answer(self, room: Classroom, message: messages.AnswerStep) -> None:
        room.answer(self._step, message.answer.strip())
        self._publish(self._shown_step(room))
        self._check()

    def _take_hint(self, room: Classroom, _: messages.TakeHint) -> None:
        room.take_hint(self._step)
        self._publish(self._shown_step(room))

    def _take_solution(self, room: Classroom, _: messages.TakeSolution) -> None:
        room.take_solution(self._step)
        self._on_changed(room.shown_file(self._step))
        self._check()

    def _show_result(self, step: Step, result: StepResult) -> None:
        assert self._room is not None, "checks run only for a course"
        items = [_check_item(check) for check in result.checks]
        self._results[step.address] = messages.StepChecks(
            step.address, is_running=False, checks=items, checked_at=time.time()
        )
        try:
            self._room.note_result(step, result)
        except LinkwrightError as error:
            self._publish(_problem(error.diagnostics[0]))
        self._publish(self._checks(), self._course(self._room))

    def _publish(self, *published: ServerMessage) -> None:
        for message in published:
            self.context.pages.publish(message)

    def _course(self, room: Classroom) -> messages.Course:
        lessons = [
            messages.CourseLesson(
                lesson.id,
                lesson.title.texts,
                [
                    messages.CourseStepItem(
                        step.address, step.title.texts, is_passed=room.progress.step(step.address).passed is not None
                    )
                    for step in lesson.steps
                ],
            )
            for lesson in room.course.lessons
        ]
        return messages.Course(room.course.title.texts, str(room.workspace), lessons)

    def _shown_step(self, room: Classroom) -> messages.CourseStep:
        step, noted = self._step, room.progress.step(self._step.address)
        folder = step.lesson.folder
        is_first = step.id == step.lesson.steps[0].id
        hint_count = len(step.text("").hints)
        solution, shown_file = room.solution_files(step), room.shown_file(step)
        return messages.CourseStep(
            step.address,
            lesson=step.lesson.title.texts,
            title=step.title.texts,
            introduction={
                language: step_html(text.introduction, folder) if is_first else ""
                for language, text in step.lesson.texts.items()
            },
            body={language: step_html(text.body, folder) for language, text in step.texts.items()},
            hints=[
                {language: step_html(text.hints[index], folder) for language, text in step.texts.items()}
                for index in range(min(noted.hints, hint_count))
            ],
            hint_count=hint_count,
            files=[str(path) for path in solution if path == shown_file or path.name in step.text("").body],
            solution=[str(path) for path in solution],
            unit=step.unit,
            answer=noted.answer,
        )

    def _checks(self) -> messages.StepChecks:
        known = self._results.get(self._step.address)
        return messages.StepChecks(
            self._step.address,
            is_running=self._runner.is_running,
            checks=[] if known is None else known.checks,
            checked_at=None if known is None else known.checked_at,
        )

    async def _watch_files(self, workspace: Path) -> None:
        """Check the shown step when files of the workspace have changed."""
        import watchfiles

        try:
            async for changes in watchfiles.awatch(workspace, watch_filter=None, debounce=_DEBOUNCE_MS):
                paths = [Path(path) for _, path in changes]
                self._follow([path for path in paths if _is_watched(path, workspace)])
        except (OSError, RuntimeError) as error:
            reason = foreign(str(error))
            self.context.node.get_logger().warning(f"The files of the workspace are not watched: {reason}")

    def _follow(self, paths: list[Path]) -> None:
        assert self._room is not None, "files are watched only for a course"
        if any(path.name == PROGRESS_FILE for path in paths):
            try:
                self._room.reload()
            except LinkwrightError as error:
                self._publish(_problem(error.diagnostics[0]))
            self._publish(self._course(self._room), self._shown_step(self._room))
        if any(path.name != PROGRESS_FILE for path in paths):
            self._on_changed(self._room.shown_file(self._step))
            self._check()


def _is_watched(path: Path, workspace: Path) -> bool:
    """Return whether a change of a path may change the result of a check."""
    try:
        parts = path.relative_to(os.path.realpath(workspace)).parts
    except ValueError:
        parts = path.relative_to(workspace).parts if path.is_relative_to(workspace) else ()
    return bool(parts) and not any(part.startswith(".") or part in _UNWATCHED_FOLDERS for part in parts)


def _check_item(check: CheckResult) -> messages.StepCheck:
    message = None if check.message is None else check.message.texts
    return messages.StepCheck(check.title.texts, is_passed=check.passed, message=message)


def _problem(diagnostic: Diagnostic) -> messages.CourseProblem:
    return messages.CourseProblem(diagnostic.message, diagnostic.hint or "")
