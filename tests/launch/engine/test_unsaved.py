"""Unsaved displays at the end of a launch."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from pathlib import Path

import aiohttp
import pytest

from linkwright.rviz import RvizConfig
from tests.launch.launcher import Running, launch_file
from tests.viewer.scene import Client

URDF = '<robot name="arm"><link name="base"/></robot>'


@pytest.fixture(autouse=True)
def recovery_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "linkwright" / "unsaved"


def add_axes(running: Running) -> None:
    """Add a display of axes, as a page does."""

    async def add() -> None:
        address = running.url.replace("/?", "/ws?")
        async with aiohttp.ClientSession() as session, session.ws_connect(address) as socket:
            page = Client(socket)
            await page.until("configuration")
            await page.send("add_display", cls="rviz_default_plugins/Axes", name="Added", group=None, topic=None)
            await page.until("configuration", unsaved=True)

    asyncio.run(add())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_unsaved_displays_are_stored_and_path_is_printed(
    start: Callable[..., Running], tmp_path: Path, recovery_folder: Path, number: int
) -> None:
    config = tmp_path / "mine.rviz"
    config.write_text(RvizConfig.default().text())
    (tmp_path / "arm.urdf").write_text(URDF)
    nodes = [
        f"Node(package='robot_state_publisher', executable='robot_state_publisher', arguments=['{tmp_path}/arm.urdf'])",
        f"Node(package='rviz2', executable='rviz2', arguments=['-d', '{config}'])",
    ]
    (tmp_path / "a.launch.py").write_text(launch_file(*nodes))
    running = start(tmp_path / "a.launch.py")
    running.until("Robot initialized")
    add_axes(running)
    assert running.end(number)[0] == 128 + number
    (file,) = recovery_folder.iterdir()
    assert [display.name for display in RvizConfig.load(file).walk()] == ["Grid", "Added"]
    text = f"unsaved changes to '{config}' are stored in '{file}': open that file in the page, or with 'rviz2"
    assert text in running.err
    restarted = start(tmp_path / "a.launch.py")
    restarted.until("Robot initialized")
    assert "info[RVIZ302]" in restarted.err
    assert str(file) in restarted.err
    assert restarted.end()[0] == 130
    assert "RVIZ301" not in restarted.err
    assert list(recovery_folder.iterdir()) == [file]


def test_unsaved_displays_of_viewed_model_are_stored(
    start: Callable[..., Running], tmp_path: Path, recovery_folder: Path
) -> None:
    (tmp_path / "arm.urdf").write_text(URDF)
    running = start("view", tmp_path / "arm.urdf")
    add_axes(running)
    assert running.end()[0] == 130
    (file,) = recovery_folder.iterdir()
    assert file.name.startswith("arm-"), "edits are stored by model"
    assert [display.name for display in RvizConfig.load(file).walk()] == ["Grid", "RobotModel", "TF", "Added"]


def test_unedited_launch_stores_nothing(start: Callable[..., Running], recovery_folder: Path) -> None:
    running = start("my_robot_description", "display.launch.py")
    running.until("Robot initialized")
    assert running.end()[0] == 130
    assert not recovery_folder.exists()
