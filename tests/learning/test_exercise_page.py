"""An exercise in pages.

The tests cover its text, the state of the judge in the running world, and the scores of the program.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from linkwright.learning.judging.exercise import find_exercise
from linkwright.learning.page.exercise_guide import ExerciseGuide
from linkwright.learning.page.feature import CourseFeature
from linkwright.messages import String
from tests.learning.simulator import FakeSimulator
from tests.viewer.scene import open_page, open_world

STATE = {
    "figure": 23.42,
    "unit": "s",
    "name": {"en": "lap time", "zh": "一圈的时间"},
    "is_solved": False,
    "reasons": [{"en": "It left the line.", "zh": "它离开了线。"}],
}


@asynccontextmanager
async def open_exercise_page(program: Path, name: str = "follow_line") -> AsyncIterator[tuple[Any, Any]]:
    async with open_world() as world:
        context = world.viewer.context
        guide = ExerciseGuide(find_exercise(name), program, context.pages.publish, context.node)
        world.viewer.add_feature(CourseFeature).show(guide)
        async with open_page(world.viewer) as client:
            yield world, client


async def test_exercise_page_shows_text_and_judge_status(tmp_path):
    async with open_exercise_page(tmp_path / "mine.py") as (world, client):
        opened = await client.opened()
        assert opened["course"]["folder"] == str(tmp_path)
        assert opened["course"]["file"] == str(tmp_path / "mine.py")
        assert opened["course_step"]["files"] == [str(tmp_path / "mine.py")]
        assert "<td><code>cmd_vel</code></td>" in opened["course_step"]["body"]["zh"]
        assert opened["step_checks"]["checks"][0]["title"]["en"] == (
            "the world has not sent the state of the judge yet"
        )
        publisher = world.graph.create_node("judge").create_publisher(String, "/judge/status", 10)
        publisher.publish(String(data=json.dumps(STATE)))
        (check,) = (await client.until("step_checks"))["checks"]
        assert check["title"] == {"en": "lap time 23.4 s", "zh": "一圈的时间 23.4 s"}
        assert (check["is_passed"], check["message"]["en"]) == (False, "It left the line.")


async def test_missing_program_is_not_judged(tmp_path):
    async with open_exercise_page(tmp_path / "mine.py") as (_, client):
        await client.send("check_step")
        assert "there is no program" in (await client.until("course_problem"))["message"]
        await client.send("take_hint")
        assert (await client.until("course_problem"))["message"] == ""


@pytest.mark.slow
@pytest.mark.extra("sim")
async def test_program_is_judged_with_several_seeds(tmp_path):
    program = tmp_path / "balance.py"
    shutil.copy(find_exercise("balance").solution("reference"), program)
    async with open_exercise_page(program, "balance") as (_, client):
        await client.send("check_step")
        assert (await client.until("step_checks", is_running=True))["checked_at"] is None
        checks = (await client.until("step_checks", is_running=False))["checks"]
        while len(checks) < 4:
            checks = (await client.until("step_checks", is_running=False))["checks"]
    assert [check["is_passed"] for check in checks[1:]] == [True, True, True]
    assert checks[1]["title"]["en"].startswith("0: ")


async def test_judge_failure_is_reported_and_world_pauses_while_judging(tmp_path, monkeypatch):
    program = tmp_path / "mine.py"
    program.touch()
    monkeypatch.setattr("linkwright.learning.page.exercise_guide.sys.executable", "/bin/false")
    async with open_exercise_page(program) as (world, client):
        simulator = FakeSimulator(world.graph)
        await world.settle()
        await client.send("check_step")
        while not (message := (await client.until("course_problem"))["message"]):
            pass
        assert message.startswith("the program cannot be judged")
        await world.settle()
    assert simulator.calls == ["pause", "resume"]
