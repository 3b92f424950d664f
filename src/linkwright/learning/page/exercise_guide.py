"""The guide of an exercise: it shows the text, the judge's state in the world, and scores."""

from __future__ import annotations

import asyncio
import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.graph import Node
from linkwright.hosting.world_pause import WorldPause
from linkwright.learning.judging.exercise import Exercise
from linkwright.learning.judging.world import STATUS_TOPIC
from linkwright.learning.local_text import LocalText
from linkwright.learning.page.guide import Guide, Publish
from linkwright.learning.page.step_html import render_html
from linkwright.messages import String
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage

_PASS_SCORE = 50.0
"""The minimum score, of 100 points, with which a run passes."""
_NO_STATE = phrase("the world has not sent the state of the judge yet")


class ExerciseGuide(Guide):
    """The guide of a learner through an exercise, on the running event loop.

    The first check shows the state of the judge in the world that runs in real time. A check request judges the
    program with several seeds, in a separate process, and shows one check for each. The world is paused meanwhile,
    because a weak computer cannot simulate two worlds.

    Args:
        exercise: the exercise that is shown and judged.
        program: the learner's program.
        publish: sends a message to all pages.
        node: the node that subscribes to the state of the judge.
        rival: the program of the other robot, if the exercise has one.
    """

    def __init__(
        self, exercise: Exercise, program: Path, publish: Publish, node: Node, rival: Path | None = None
    ) -> None:
        self._exercise = exercise
        self._program = program
        self._rival = rival
        self._publish = publish
        self._state: Mapping[str, Any] | None = None
        self._scores: list[messages.StepCheck] = []
        self._judged_at: float | None = None
        self._task: asyncio.Task[None] | None = None
        self._world = WorldPause(node)
        node.create_subscription(String, STATUS_TOPIC, self._receive, 10)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the exercise as a course of one step, and the state of the judge."""
        return [self._make_course(), self._make_step(), self._make_checks()]

    def handle(self, message: PageMessage) -> None:
        """Judge the program at the request of a page.

        Other requests are ignored, because exercises lack them.
        """
        if not isinstance(message, messages.CheckStep) or self._task is not None:
            return
        if not self._program.is_file():
            message_text = phrase("there is no program '{path}'", path=display_path(self._program))
            raise LinkwrightError(Diagnostic("LEARN142", message_text))
        self._scores, self._judged_at = [], None
        self._task = asyncio.get_running_loop().create_task(self._judge())
        self._publish(self._make_checks())

    def close(self) -> None:
        """End a running judge process."""
        if self._task is not None:
            self._task.cancel()

    def _receive(self, message: String) -> None:
        self._state = json.loads(message.data)
        self._publish(self._make_checks())

    async def _judge(self) -> None:
        self._world.begin()
        self._publish(self._make_checks())
        command = [sys.executable, "-m", "linkwright", "learn", "judge", str(self._exercise.folder), str(self._program)]
        if self._rival is not None:
            command += ["--rival", str(self._rival)]
        process = await asyncio.create_subprocess_exec(
            *command, "--json", stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
        )
        try:
            output, errors = await process.communicate()
        except asyncio.CancelledError:
            process.kill()
            raise
        self._task, self._judged_at = None, time.time()
        self._world.end()
        try:
            self._scores = [self._make_score_check(run) for run in json.loads(output)["runs"]]
        except (ValueError, KeyError):
            reason = foreign((errors.decode(errors="replace").strip().splitlines() or [""])[-1])
            message = phrase("the program cannot be judged: {reason}", reason=reason)
            self._publish(messages.CourseProblem(message, ""))
        self._publish(self._make_checks())

    def _make_course(self) -> messages.Course:
        item = messages.CourseStepItem(
            self._exercise.id, self._exercise.title.texts, is_passed=False, is_taken_over=False
        )
        lesson = messages.CourseLesson(self._exercise.id, self._exercise.title.texts, [item])
        return messages.Course(self._exercise.title.texts, str(self._program.parent), str(self._program), [lesson])

    def _make_step(self) -> messages.CourseStep:
        folder = self._exercise.folder
        return messages.CourseStep(
            self._exercise.id,
            lesson=self._exercise.title.texts,
            title=self._exercise.title.texts,
            introduction={},
            body={
                language: render_html(_remove_title(self._exercise.text(language)), folder) for language in LANGUAGES
            },
            hints=[],
            hint_count=0,
            files=[str(self._program)],
            solution=[],
            has_solution=False,
            unit=None,
            answer=None,
            right_answer=None,
            missing_count=0,
        )

    def _make_checks(self) -> messages.StepChecks:
        return messages.StepChecks(
            self._exercise.id,
            is_running=self._task is not None,
            is_world_paused=self._world.is_active,
            checks=[self._make_live_check(), *self._scores],
            checked_at=self._judged_at,
        )

    def _make_live_check(self) -> messages.StepCheck:
        """Return the state of the judge in the running world."""
        if self._state is None:
            name = LocalText.from_phrase(_NO_STATE).texts
            return messages.StepCheck(name, is_passed=False, message=None)
        return messages.StepCheck(
            self._format_figure(self._state), is_passed=self._state["is_solved"], message=_join_reasons(self._state)
        )

    def _make_score_check(self, run: Mapping[str, Any]) -> messages.StepCheck:
        """Return the result of a judged run."""
        figures = self._format_figure(run)
        titles = {language: f"{run['seed']}: {text} · {run['score']:g}" for language, text in figures.items()}
        return messages.StepCheck(titles, is_passed=run["score"] >= _PASS_SCORE, message=_join_reasons(run))

    def _format_figure(self, state: Mapping[str, Any]) -> dict[str, str]:
        value = f"{state['figure']:.{self._exercise.figure.decimals}f} {state['unit']}".strip()
        return {language: f"{name} {value}" for language, name in state["name"].items()}


def _join_reasons(state: Mapping[str, Any]) -> dict[str, str] | None:
    """Return the reasons of a judge, and the last line of the program's error."""
    reasons = state["reasons"]
    lines = (state.get("error") or "").rstrip().splitlines()[-1:]
    texts = {
        language: " ".join([*(reason.get(language) or reason["en"] for reason in reasons), *lines])
        for language in LANGUAGES
    }
    return texts if any(texts.values()) else None


def _remove_title(text: str) -> str:
    """Return a Markdown text without its first heading, because the page shows the title."""
    title, _, body = text.lstrip().partition("\n")
    return body if title.startswith("# ") else text
