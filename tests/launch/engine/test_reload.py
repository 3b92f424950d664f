"""Descriptions that a launch reloads when their files change."""

from __future__ import annotations

import asyncio
import io
import os
import shutil
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from launch.actions import TimerAction
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription
from linkwright.diagnostics import Diagnostic
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.reload import FileWatch
from linkwright.launch.engine.session import LaunchSession
from linkwright.launch.engine.supervisor import SessionOptions
from linkwright.packages import PackageFinder, use_finder
from tests.waiting import TIMEOUT_S, eventually

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def model_text(link: str) -> str:
    return f'<robot name="r" {XACRO}><link name="{link}"/></robot>'


BROKEN = f'<robot name="r" {XACRO}>\n  <link name="${{nothing}}"/>\n</robot>'


class ReloadedLaunch:
    """A running launch of robot_state_publisher and viewer on one model."""

    def __init__(self, session: LaunchSession, err: io.StringIO, out: io.StringIO) -> None:
        self.session = session
        self._err = err
        self._out = out

    @property
    def err(self) -> str:
        return self._err.getvalue()

    @property
    def out(self) -> str:
        return self._out.getvalue()

    def description(self) -> str:
        for plan, running in self.session.host._running.values():
            if plan.package == "robot_state_publisher":
                return running.node.get_parameter("robot_description").value
        return ""

    def findings(self) -> list[Diagnostic]:
        return self.session.reload.findings()

    async def until(self, condition: Callable[[], bool]) -> None:
        await eventually(condition, what=lambda: self.err)

    async def wait_until_shown(self, link: str) -> None:
        await self.until(lambda: f'<link name="{link}"/>' in self.description())

    async def watching(self) -> None:
        """Wait until files are watched.

        This is the case when a change of an unrelated file is reported.
        """
        await self.until(lambda: self.session.reload._watch is not None)
        watch = self.session.reload._watch
        assert watch is not None
        probes, result, pass_on = {Path(folder) / ".probe" for folder, _ in watch._folders}, set(), watch._on_change

        def on_change(paths: set[Path]) -> None:
            result.update(paths & probes)
            if paths - probes:
                pass_on(paths - probes)

        watch._on_change = on_change
        while result != probes:
            for probe in probes:
                probe.write_text("")
            await asyncio.sleep(0.05)


@asynccontextmanager
async def run_launch(
    path: Path, *arguments: str, viewer: bool = True, delay: float | None = None
) -> AsyncIterator[ReloadedLaunch]:
    out, err = io.StringIO(), io.StringIO()
    description = ParameterValue(Command(["xacro ", str(path)]), value_type=str)
    entities = [
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": description}],
        )
    ]
    if delay is not None:
        entities = [TimerAction(period=delay, actions=entities)]
    if viewer:
        entities.append(Node(package="rviz2", executable="rviz2", arguments=arguments))
    finder = PackageFinder(start=path.parent, environment={})
    with use_finder(finder):
        session = LaunchSession(finder, SessionOptions(port=0, open_browser=False), LaunchLog(out, err))
        task = asyncio.create_task(session.run(LaunchDescription(entities)))
        try:
            yield ReloadedLaunch(session, err, out)
        finally:
            session.interrupt("the test is over")
            await asyncio.wait_for(task, TIMEOUT_S)


async def test_saved_file_reaches_running_node(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        for link in ("b", "c", "d"):
            path.write_text(model_text(link))
            await bench.wait_until_shown(link)
        assert "reloaded" in bench.err


async def test_node_started_later_receives_reloaded_description(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path, delay=0.2) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.write_text(model_text("b"))
        await bench.wait_until_shown("b")


async def test_file_replaced_by_rename_is_reloaded(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        for link in ("b", "c"):
            path.rename(path.with_suffix(".bak"))
            await asyncio.sleep(0.08)
            new = path.with_suffix(".new")
            new.write_text(model_text(link))
            new.replace(path)
            await bench.wait_until_shown(link)
        assert "error" not in bench.err


async def test_include_behind_symlink_is_watched(write, tmp_path: Path) -> None:
    real = write("sources/part.xacro", f'<robot {XACRO}><link name="a"/></robot>')
    link = tmp_path / "share" / "part.xacro"
    link.parent.mkdir()
    link.symlink_to(real)
    path = write("share/r.xacro", f'<robot name="r" {XACRO}><xacro:include filename="part.xacro"/></robot>')
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        real.write_text(f'<robot {XACRO}><link name="b"/></robot>')
        await bench.wait_until_shown("b")


async def test_new_include_is_watched(write) -> None:
    path = write("r.xacro", model_text("a"))
    part = write("parts/part.xacro", f'<robot {XACRO}><link name="b"/></robot>')
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.write_text(f'<robot name="r" {XACRO}><xacro:include filename="parts/part.xacro"/></robot>')
        await bench.wait_until_shown("b")
        await bench.watching()
        part.write_text(f'<robot {XACRO}><link name="c"/></robot>')
        await bench.wait_until_shown("c")


async def test_broken_file_keeps_last_valid_robot_until_fixed(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.write_text(BROKEN)
        await bench.until(lambda: bool(bench.findings()))
        (finding,) = bench.findings()
        assert finding.span is not None
        assert (finding.span.file, finding.span.line) == (str(path), 2)
        assert "nothing" in finding.message
        assert bench.err.count("error[XAC") == 1
        assert '<link name="a"/>' in bench.description()
        path.write_text(model_text("c"))
        await bench.wait_until_shown("c")
        await bench.until(lambda: not bench.findings())
        assert "repaired" in bench.err


async def test_description_with_two_roots_is_rejected(write) -> None:
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.write_text('<robot name="r"><link name="a"/><link name="b"/></robot>')
        await bench.until(lambda: bool(bench.findings()))
        assert bench.findings()[0].code.startswith("URDF")
        assert '<link name="b"/>' not in bench.description()


async def test_deleted_file_is_reported_and_reloaded_when_recreated(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.unlink()
        await bench.until(lambda: bool(bench.findings()))
        assert '<link name="a"/>' in bench.description()
        path.write_text(model_text("b"))
        await bench.wait_until_shown("b")


@pytest.mark.parametrize("start", [BROKEN, '<robot name="r"><link name="a"/><link name="b"/></robot>', "<robot", ""])
async def test_model_broken_at_start_is_loaded_once_fixed(write, start: str) -> None:
    path = write("r.xacro", start)
    async with run_launch(path) as bench:
        await bench.until(lambda: "Viewer: " in bench.out and bool(bench.findings()))
        assert "error[" in bench.err
        assert bench.description() == ""
        await bench.watching()
        path.write_text(model_text("good"))
        await bench.wait_until_shown("good")
        await bench.until(lambda: not bench.findings())
        await bench.watching()
        path.write_text(model_text("better"))
        await bench.wait_until_shown("better")


async def test_broken_model_without_viewer_ends_launch(write) -> None:
    path = write("r.xacro", BROKEN)
    async with run_launch(path, viewer=False) as bench:
        await bench.until(lambda: bench.session.is_ending)
        assert bench.err.count("error[XAC") == 1


async def test_missing_model_ends_launch(tmp_path: Path) -> None:
    async with run_launch(tmp_path / "none.urdf") as bench:
        await bench.until(lambda: bench.session.is_ending)
        assert bench.err.count("error[") == 1
        assert "Viewer:" not in bench.out


async def test_change_before_watch_starts_is_detected(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        path.write_text(model_text("b"))
        os.utime(path, ns=(time.time_ns() + 10**9,) * 2)
        await bench.wait_until_shown("b")


async def test_whitespace_change_updates_source_positions(write) -> None:
    path = write("r.xacro", model_text("a"))
    async with run_launch(path) as bench:
        await bench.wait_until_shown("a")
        await bench.watching()
        path.write_text("\n\n" + model_text("a"))
        await bench.until(lambda: "reloaded" in bench.err)
        robot = bench.session.descriptions.library.read(bench.description()).robot
        assert robot is not None
        span = robot.links["a"].element.span()
        assert span is not None
        assert span.line == 3


async def test_package_added_later_fixes_model(write, tmp_path: Path) -> None:
    path = write("r.xacro", f'<robot name="r" {XACRO}><xacro:include filename="$(find late)/part.xacro"/></robot>')
    async with run_launch(path) as bench:
        await bench.until(lambda: "Viewer: " in bench.out and bool(bench.findings()))
        assert bench.findings()[0].code == "PKG101"
        await bench.watching()
        write("late/part.xacro", f'<robot {XACRO}><link name="a"/></robot>')
        write("late/package.xml", "<package><name>late</name></package>")
        path.write_text(path.read_text() + "\n")
        await bench.wait_until_shown("a")


async def test_viewer_messages_have_node_name_prefix(write) -> None:
    path = write(
        "r.urdf",
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="package://none_at_all/a.dae"/></geometry>'
        "</visual></link></robot>",
    )
    config = write(
        "a.rviz",
        "Visualization Manager:\n  Displays:\n    - Class: rviz_default_plugins/RobotModel\n      Enabled: true\n"
        "      Name: RobotModel\n      Description Topic: {Value: /robot_description}\n",
    )
    async with run_launch(path, "-d", str(config)) as bench:
        await bench.until(lambda: "none_at_all" in bench.err)
        line = next(line for line in bench.err.splitlines() if "none_at_all" in line and line.startswith("["))
        assert line.startswith("[rviz2-2] [ERROR]")


@pytest.mark.parametrize("depth", [1, 3])
async def test_recreated_folder_is_watched_again(tmp_path: Path, depth: int) -> None:
    top = tmp_path / "install"
    path = top.joinpath(*("share", "r", "urdf")[: depth - 1], "r.xacro")

    def build(link: str) -> None:
        path.parent.mkdir(parents=True)
        path.write_text(model_text(link))

    build("a")
    async with run_launch(path, viewer=False) as bench:
        await bench.wait_until_shown("a")
        path.write_text(model_text("b"))
        await bench.until(lambda: '<link name="b"/>' in bench.description())
        for link in ("c", "d"):
            shutil.rmtree(top)
            await bench.until(lambda: bool(bench.findings()))
            build(link)
            await bench.until(lambda link=link: f'<link name="{link}"/>' in bench.description())
            assert not bench.findings()


async def test_file_deleted_before_watch_starts_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FileWatch, "watch", lambda *_: True)  # the watch never begins
    path = tmp_path / "m.xacro"
    path.write_text(model_text("a"))
    async with run_launch(path, viewer=False) as bench:
        await bench.wait_until_shown("a")
        path.unlink()
        bench.session.reload._reload_missed()
        await bench.until(lambda: bool(bench.findings()))


async def test_urdf_findings_are_reported_with_xacro_error(tmp_path: Path) -> None:
    path = tmp_path / "m.xacro"
    path.write_text(model_text("good"))
    async with run_launch(path, viewer=False) as bench:
        await bench.wait_until_shown("good")
        await bench.watching()
        path.write_text(
            f'<robot name="r" {XACRO}>\n  <link name="${{nothing}}"/>\n  <link name="a"/>\n'
            '  <joint name="j" type="hinge"><parent link="a"/><child link="b"/></joint>\n</robot>'
        )
        await bench.until(lambda: len(bench.findings()) > 1)
        codes = [finding.code for finding in bench.findings()]
        assert codes[0].startswith("XAC")
        assert any(code.startswith("URDF") for code in codes[1:])
        assert bench.description().count('name="good"') == 1, "the last model without errors is kept"
