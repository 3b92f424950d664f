"""Viewing of a model without a launch file."""

from __future__ import annotations

import asyncio
import contextlib
import io
import re
import socket
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.view import ModelView, run_view
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.packages import PackageFinder
from linkwright.page.protocol.description import NO_ARGUMENT_FORM, ArgumentForm, SetArguments
from linkwright.panels.description import ArgumentsFeature
from tests.waiting import eventually

VALID_ROBOT = '<robot name="a"><link name="b"/></robot>'
BROKEN_ROBOT = '<robot name="a">\n  <link name="b">\n</robot>'


@pytest.fixture(autouse=True)
def _logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


@asynccontextmanager
async def open_view(
    path: Path, foxglove: int | None = None
) -> AsyncIterator[tuple[ModelView, Callable[[str], object]]]:
    """Start a view, and return a function that waits for a printed text.

    The view must end without a failure.
    """
    out, err = io.StringIO(), io.StringIO()
    finder = PackageFinder(start=path.parent, environment={})
    options = HostOptions(port=0, open_browser=False, network=False)
    view = ModelView(XacroCall(path), finder, options, LaunchLog(out, err))
    running = asyncio.create_task(view.run(foxglove))

    async def wait_until_printed(text: str) -> str:
        await eventually(lambda: text in err.getvalue() or running.done(), what=err.getvalue)
        assert not running.done(), err.getvalue()
        return err.getvalue()

    try:
        yield view, wait_until_printed
    finally:
        view.interrupt("the test is over")
        succeeded = await running
    assert succeeded


def started_names(printed: str) -> list[str]:
    return re.findall(r"^\[INFO\] \[(\S+)\]: started in the launcher's process", printed, re.MULTILINE)


async def test_viewer_starts_before_nodes(tmp_path: Path) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    async with open_view(tmp_path / "m.urdf") as (_, wait_until_printed):
        await wait_until_printed("Robot initialized")
        printed = await wait_until_printed("joint_state_publisher_gui-2]: started")
        assert started_names(printed) == ["viewer-3", "robot_state_publisher-1", "joint_state_publisher_gui-2"]


async def test_server_is_closed_when_viewer_cannot_be_created(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    printed = io.StringIO()
    options = HostOptions(port=0, open_browser=False, network=False)
    finder = PackageFinder(start=tmp_path, environment={})
    view = ModelView(XacroCall(tmp_path / "m.urdf"), finder, options, LaunchLog(printed, printed))

    def refuse(*_: object, **__: object) -> None:
        raise RuntimeError("no viewer today")

    monkeypatch.setattr("linkwright.viewer.Viewer", refuse)
    with contextlib.suppress(RuntimeError):
        await view.run(None)
    port = re.search(r"Viewer: http://127\.0\.0\.1:(\d+)/", printed.getvalue())
    assert port is not None, printed.getvalue()
    with socket.socket() as asking:
        assert asking.connect_ex(("127.0.0.1", int(port[1]))) != 0


async def test_address_is_printed_before_viewer_is_loaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    out, received = io.StringIO(), []
    monkeypatch.setattr("linkwright.hosting.node_host.load_viewer", lambda: received.append(out.getvalue()))
    options = HostOptions(port=0, open_browser=False, network=False)
    finder = PackageFinder(start=tmp_path, environment={})
    view = ModelView(XacroCall(tmp_path / "m.urdf"), finder, options, LaunchLog(out, err := io.StringIO()))
    running = asyncio.create_task(view.run(None))
    await eventually(lambda: "joint_state_publisher_gui-2]: started" in err.getvalue())
    view.interrupt("the test is over")
    assert await running
    assert received == [out.getvalue()]
    assert received[0].count("Viewer: http://127.0.0.1:") == 1


async def test_interrupt_while_viewer_loads_starts_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    loop = asyncio.get_running_loop()
    ended = threading.Event()

    def end() -> None:
        view.interrupt("the test is over")
        ended.set()

    def load() -> None:
        loop.call_soon_threadsafe(end)
        ended.wait()

    monkeypatch.setattr("linkwright.hosting.node_host.load_viewer", load)
    options = HostOptions(port=0, open_browser=False, network=False)
    finder = PackageFinder(start=tmp_path, environment={})
    view = ModelView(XacroCall(tmp_path / "m.urdf"), finder, options, LaunchLog(out := io.StringIO(), io.StringIO()))
    assert await view.run(None)
    assert started_names(out.getvalue()) == []
    port = int(re.search(r":(\d+)/", out.getvalue())[1])
    with socket.socket() as free:
        free.bind(("127.0.0.1", port))


async def test_foxglove_option_starts_bridge(tmp_path: Path) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    async with open_view(tmp_path / "m.urdf", foxglove=0) as (_, wait_until_printed):
        assert started_names(await wait_until_printed("foxglove_bridge-4]: started"))[-1] == "foxglove_bridge-4"


async def test_broken_model_is_published_once_fixed(tmp_path: Path) -> None:
    path = tmp_path / "m.urdf"
    path.write_text(BROKEN_ROBOT)
    async with open_view(path) as (view, wait_until_printed):
        printed = await wait_until_printed("joint_state_publisher_gui-1]: started")
        assert "error[XML" in printed
        assert started_names(printed) == ["viewer-2", "joint_state_publisher_gui-1"]
        path.write_text(VALID_ROBOT)
        printed = await wait_until_printed("Robot initialized")
        assert f"repaired {path}" in printed
        assert started_names(printed)[-1] == "robot_state_publisher-3"
        assert view.reload.findings() == []


async def test_errors_are_not_repeated_when_other_files_change(tmp_path: Path) -> None:
    path = tmp_path / "m.urdf"
    path.write_text(BROKEN_ROBOT)
    async with open_view(path) as (view, wait_until_printed):
        await wait_until_printed("joint_state_publisher_gui-1]: started")
        for changed, times in ((tmp_path / "log.txt", 1), (path, 2)):
            view.reload._on_change({changed})
            await eventually(lambda: not view.reload._running)
            assert (await wait_until_printed("error[XML")).count("error[XML") == times
        path.write_text(VALID_ROBOT)
        await wait_until_printed("Robot initialized")


def test_missing_model_is_one_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_view(tmp_path / "none.urdf", {}, HostOptions(open_browser=False)) == 1
    captured = capsys.readouterr()
    assert captured.err.count("error[") == 1
    assert "none.urdf" in captured.err
    assert captured.out == ""


def test_used_port_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "m.urdf").write_text(VALID_ROBOT)
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen()
        port = server.getsockname()[1]
        assert run_view(tmp_path / "m.urdf", {}, HostOptions(port=port, open_browser=False)) == 1
    err = capsys.readouterr().err
    assert f"{port}" in err
    assert err.count("error[VIEW") == 1


async def test_sdf_model_is_shown(tmp_path: Path) -> None:
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    link = f'<link name="base"><visual name="v">{box}</visual></link>'
    (tmp_path / "crate.sdf").write_text(f'<sdf version="1.9"><model name="crate">{link}</model></sdf>')
    async with open_view(tmp_path / "crate.sdf") as (view, wait_until_printed):
        assert "Unable to initialize" not in await wait_until_printed("Robot initialized")
        expansion = view.descriptions.expand(XacroCall(tmp_path / "crate.sdf"))
        robot = view.descriptions.library.read(expansion).robot
        assert robot is not None
        assert list(robot.links) == ["base"]


async def test_arguments_from_page_complete_the_robot(tmp_path: Path) -> None:
    path = tmp_path / "m.xacro"
    path.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="a"><link name="$(arg side)_link"/></robot>'
    )
    async with open_view(path) as (view, wait_until_printed):
        await wait_until_printed("the argument 'side' is not declared")
        await wait_until_printed("[viewer-2]: started")
        viewer = view._viewer
        assert viewer is not None
        feature = viewer.add_feature(ArgumentsFeature)
        await eventually(lambda: feature.opening_messages() != [NO_ARGUMENT_FORM])
        (form,) = feature.opening_messages()
        assert isinstance(form, ArgumentForm)
        assert form.names == ["side"]
        feature.receive(None, SetArguments({"side": "left", "other": "x"}))  # type: ignore[arg-type]
        await wait_until_printed("[robot_state_publisher-3]: started")
        assert feature.opening_messages() == [NO_ARGUMENT_FORM]
        assert viewer.manager.fixed_frame == "left_link"
