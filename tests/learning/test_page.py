"""A course in pages.

The tests cover steps, checks after changes, hints, answers, solutions, and hostile requests.
"""

from __future__ import annotations

import shutil
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from linkwright.cli import main
from linkwright.cli.command import _begins_without_verb
from linkwright.cli.learn.verb import VERBS
from linkwright.learning.classroom import Classroom, find_workspace, open_classroom
from linkwright.learning.course import find_course
from linkwright.learning.page.course_guide import CourseGuide
from linkwright.learning.page.feature import CourseFeature
from linkwright.learning.page.step_html import render_html
from linkwright.page.program_pages import ProgramPages
from tests.viewer.scene import open_page, open_world

ROBOT = find_course("example") / "01-one-link/solution/one-link/robot.urdf"
WRONG_ROBOT = '<robot name="r"><link name="bux"/></robot>'


class ShownFiles:
    """The files that the feature shows beside its steps."""

    def __init__(self) -> None:
        self.paths: list[Path | None] = []


def show_course(
    world: Any, room: Classroom, on_changed: Callable[[Path | None], object], programs: ProgramPages | None = None
) -> None:
    context = world.viewer.context
    guide = CourseGuide(room, context.pages.publish, context.node.get_logger(), on_changed, programs or ProgramPages())
    world.viewer.add_feature(CourseFeature).show(guide)


@asynccontextmanager
async def classroom(workspace: Path, shown: ShownFiles | None = None) -> AsyncIterator[Any]:
    workspace.mkdir(exist_ok=True)  # noqa: ASYNC240 - nothing else runs
    async with open_world() as world:
        room = open_classroom(workspace, "example")
        show_course(world, room, (shown or ShownFiles()).paths.append)
        async with open_page(world.viewer) as client:
            yield client


async def wait_for_results(client: Any, *, step: str = "01-one-link/one-link") -> dict[str, Any]:
    """Return the next results of a step."""
    message: dict[str, Any] = await client.until("step_checks", address=step, is_running=False)
    return message


async def wait_until_passed(client: Any) -> dict[str, Any]:
    while True:
        message = await wait_for_results(client)
        if message["checks"] and all(check["is_passed"] for check in message["checks"]):
            return message


async def test_saved_file_is_checked_and_progress_is_shown(tmp_path):
    shown = ShownFiles()
    async with classroom(tmp_path / "ws", shown) as client:
        first = await wait_for_results(client)
        assert [check["is_passed"] for check in first["checks"]] == [False, False]
        assert first["checks"][0]["message"] == {
            "en": "'ws' has no file 'robot.urdf'",
            "zh": "“ws”中没有文件“robot.urdf”",
        }
        shutil.copy(ROBOT, tmp_path / "ws")
        await wait_until_passed(client)
        course = await client.until("course")
        assert [step["is_passed"] for step in course["lessons"][0]["steps"]] == [True, False]
    assert set(shown.paths) == {tmp_path / "ws" / "robot.urdf"}


async def test_opened_page_receives_course_step_and_last_results(tmp_path):
    async with open_world() as world:
        workspace = tmp_path / "ws"
        workspace.mkdir()
        room = open_classroom(workspace, "example")
        show_course(world, room, lambda _: None)
        async with open_page(world.viewer) as client:
            await wait_for_results(client)
        async with open_page(world.viewer) as client:
            opened = await client.opened()
    assert opened["course"]["folder"] == str(workspace)
    assert opened["course_step"]["title"] == {"en": "A box", "zh": "一个方块"}
    assert "<p>Each heading" in opened["course_step"]["body"]["en"]
    assert opened["step_checks"]["checks"]


async def test_newest_check_result_is_shown(tmp_path):
    async with classroom(tmp_path / "ws") as client:
        await client.send("check_step")
        (tmp_path / "ws" / "robot.urdf").write_text(WRONG_ROBOT)
        shutil.copy(ROBOT, tmp_path / "ws")
        await wait_until_passed(client)


SLOW_CHECK = """
import time
from linkwright.learning import check

@check("one-link", en="It takes time.", zh="需要时间。")
def takes_time(work):
    time.sleep(0.0 if work.folder.joinpath("quick").exists() else 2.0)
"""


@pytest.mark.parametrize(("is_quick", "expected"), [(False, [True, False]), (True, [])])
async def test_slow_checks_pause_worlds_and_quick_checks_do_not(tmp_path, monkeypatch, is_quick, expected):
    course, workspace, paused = tmp_path / "course", tmp_path / "ws", []
    shutil.copytree(find_course("example"), course)
    (course / "01-one-link" / "checks.py").write_text(SLOW_CHECK, encoding="utf-8")
    workspace.mkdir()
    if is_quick:
        (workspace / "quick").touch()
    monkeypatch.setattr("linkwright.learning.page.course_guide._PAUSE_DELAY_S", 60.0 if is_quick else 0.2)
    programs = ProgramPages()
    monkeypatch.setattr(programs, "pause_worlds", lambda: paused.append(True))
    monkeypatch.setattr(programs, "resume_worlds", lambda: paused.append(False))
    async with open_world() as world:
        show_course(world, open_classroom(workspace, str(course)), lambda _: None, programs)
        async with open_page(world.viewer) as client:
            while not (await wait_for_results(client))["checks"]:
                pass
        while_open = list(paused)
    assert [value for value in while_open if value or expected] == expected


async def test_hints_are_shown_in_order_and_solution_keeps_replaced_file(tmp_path):
    workspace = tmp_path / "ws"
    async with classroom(workspace) as client:
        (workspace / "robot.urdf").write_text(WRONG_ROBOT)
        for count in (1, 2):
            await client.send("take_hint")
            while len((await client.until("course_step"))["hints"]) < count:
                pass
        await client.send("take_hint")
        assert len((await client.until("course_step"))["hints"]) == 2
        await client.send("take_solution")
        await wait_until_passed(client)
    (backup,) = (workspace / "replaced").rglob("robot.urdf")
    assert backup.read_text() == WRONG_ROBOT
    assert "solution: true" in (workspace / "learn.yaml").read_text()


async def test_answer_is_checked(tmp_path):
    async with classroom(tmp_path / "ws") as client:
        await client.send("open_step", address="01-one-link/mass")
        assert (await client.until("course_step", address="01-one-link/mass"))["unit"] == "kg"
        await client.send("answer_step", answer=" 12.5 ")
        while not all(
            check["is_passed"] for check in (await wait_for_results(client, step="01-one-link/mass"))["checks"]
        ):
            pass


async def test_solution_of_number_step_is_the_number(tmp_path):
    async with classroom(tmp_path / "ws") as client:
        await client.send("open_step", address="01-one-link/mass")
        shown = await client.until("course_step", address="01-one-link/mass")
        assert (shown["has_solution"], shown["right_answer"]) == (True, None)
        await client.send("take_solution")
        assert (await client.until("course_step", address="01-one-link/mass"))["right_answer"] == "12.5"
    assert "solution: true" in (tmp_path / "ws" / "learn.yaml").read_text()


async def test_progress_from_another_process_is_shown(tmp_path):
    async with classroom(tmp_path / "ws") as client:
        await wait_for_results(client)
        other = open_classroom(tmp_path / "ws")
        other.record_answer(other.course.find_step("mass"), "3")
        other.take_hint(other.course.find_step("one-link"))
        while not (await client.until("course_step"))["hints"]:
            pass
        await client.send("take_hint")
        while len((await client.until("course_step"))["hints"]) < 2:
            pass
    assert "answer: '3'" in (tmp_path / "ws" / "learn.yaml").read_text()


async def test_invalid_requests_are_answered_with_reason(tmp_path):
    async with classroom(tmp_path / "ws") as client:
        await client.send("open_step", address="01-one-link/bax")
        problem = await client.until("course_problem")
        assert problem["message"] == "the course 'example' has no step '01-one-link/bax'"
        await client.send("answer_step", answer="1")
        assert "does not ask for a number" in (await client.until("course_problem"))["message"]


async def test_remote_pages_are_refused(tmp_path, monkeypatch):
    refusal = "a course works only in pages on the machine where Linkwright runs"
    monkeypatch.setattr("linkwright.page.server.is_local_connection", lambda _: False)
    async with classroom(tmp_path / "ws") as client:
        await client.send("take_solution")
        assert (await client.until("course_problem"))["message"] == refusal
    assert not (tmp_path / "ws" / "robot.urdf").exists()


def test_lesson_text_becomes_safe_html_with_own_images_only(tmp_path):
    lesson = tmp_path / "lesson"
    (lesson / "images").mkdir(parents=True)
    (lesson / "images" / "a.png").write_bytes(b"PNG")
    (tmp_path / "secret.png").write_bytes(b"secret")
    (lesson / "link.png").symlink_to(tmp_path / "secret.png")
    html = render_html("<script>x</script> ![a picture](images/a.png)\n\n| a | b |\n| - | - |\n| 1 | 2 |", lesson)
    assert "&lt;script&gt;" in html
    assert '<img src="data:image/png;base64,UE5H" alt="a picture"' in html
    assert "<td>1</td>" in html
    hostile = ("../secret.png", "link.png", "images/none.png", "/etc/passwd", "images", "http://a.b/c.png", "%00.png")
    for name in hostile:
        assert render_html(f"![words](<{name}>)", lesson) == "<p>words</p>\n", name
    assert render_html("[a](javascript:alert)", lesson) == "<p>[a](javascript:alert)</p>\n"


def test_lines_of_chinese_text_join_without_space(tmp_path):
    assert render_html("形状、位置都相同的\n碰撞体：\n机身。", tmp_path) == "<p>形状、位置都相同的碰撞体：机身。</p>\n"
    assert render_html("这是**粗体**\n文字", tmp_path) == "<p>这是<strong>粗体</strong>文字</p>\n"
    assert render_html("写\n`mbot.xacro`\n文件", tmp_path) == "<p>写\n<code>mbot.xacro</code>\n文件</p>\n"
    assert render_html("“左转”\n是命令", tmp_path) == "<p>“左转”是命令</p>\n"
    assert render_html("“left”\n“right”", tmp_path) == "<p>“left”\n“right”</p>\n"
    assert render_html("two\nlines", tmp_path) == "<p>two\nlines</p>\n"


def test_workspace_is_current_folder_or_new_folder(tmp_path):
    assert find_workspace(tmp_path) == tmp_path
    (tmp_path / "file").touch()
    assert find_workspace(tmp_path) == tmp_path / "robot_ws"
    assert find_workspace(tmp_path, "example") == tmp_path / "example_ws"
    (tmp_path / "learn.yaml").write_text("course: example\n")
    (tmp_path / "src" / "deep").mkdir(parents=True)
    assert find_workspace(tmp_path / "src" / "deep") == tmp_path


def test_file_is_shown_from_first_step_that_names_it(tmp_path):
    room: Classroom = open_classroom(tmp_path, "robot")
    steps = room.course.steps
    assert room.find_shown_file(steps[0]) is None
    assert room.find_shown_file(steps[1]) == tmp_path / "src/my_robot_description/urdf/mbot_base.urdf"
    assert room.find_shown_file(steps[3]) == room.find_shown_file(steps[1])


@pytest.mark.parametrize(
    ("words", "is_default"),
    [
        ([], True),
        (["--no-open"], True),
        (["my_folder"], True),
        (["check"], False),
        (["chek"], False),
        (["--help"], False),
        (["./list"], True),
    ],
)
def test_learn_without_verb_opens_classroom(words, is_default):
    assert _begins_without_verb(words, VERBS) == is_default


def test_misspelled_verb_is_rejected_with_suggestion(capsys):
    assert main(["learn", "lst"]) == 2
    assert "there is no command 'lst'; did you mean 'list'" in capsys.readouterr().err


def test_folder_that_cannot_be_created_is_an_error(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main(["learn", str(tmp_path / "file" / "ws"), "--no-open"]) == 1
    assert "LEARN111" in capsys.readouterr().err


def test_course_on_public_host_is_refused_with_advice(tmp_path, capsys):
    (tmp_path / "ws").mkdir()
    words = ["learn", str(tmp_path / "ws"), "--course", "example", "--host", "0.0.0.0", "--no-open"]
    assert main(words) == 1
    error = capsys.readouterr().err
    assert "VIEW104" in error
    assert "SSH tunnel" in error
    assert "--terminal" not in error


async def test_earlier_steps_are_taken_over_after_confirmation(tmp_path: Path) -> None:
    workspace = tmp_path / "ws"
    async with classroom(workspace) as client:
        await client.until("course_step")
        await client.send("open_step", address="01-one-link/mass")
        step = await client.until("course_step", address="01-one-link/mass")
        assert step["missing_count"] == 1
        await client.send("request_catch_up")
        files = await client.until("catch_up_files")
        assert (files["new"], files["replaced"]) == ([str(workspace / "robot.urdf")], [])
        assert not (workspace / "robot.urdf").exists()
        await client.send("catch_up")
        course = await client.until("course")
        first = course["lessons"][0]["steps"][0]
        assert (first["is_passed"], first["is_taken_over"]) == (False, True)
        step = await client.until("course_step")
        assert step["missing_count"] == 0
        assert (workspace / "robot.urdf").read_text() == ROBOT.read_text()
