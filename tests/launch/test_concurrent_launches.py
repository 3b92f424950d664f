"""Two programs on one machine: views are independent, and launches report shared names."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import aiohttp
import psutil
import pytest

from tests.domains import own_domain
from tests.launch.launcher import Running, launch_file
from tests.waiting import TIMEOUT_S, eventually, wait_until

SHARED_NAMES_TEXT = "another launch or program on ROS_DOMAIN_ID"


@pytest.fixture(autouse=True)
def domain(monkeypatch: pytest.MonkeyPatch, _isolated_environment: None) -> int:
    """Let nodes join the domain of this process."""
    monkeypatch.delenv("LINKWRIGHT_DDS")
    return own_domain()


def write_robot(folder: Path, name: str) -> Path:
    path = folder / f"{name}.urdf"
    path.write_text(
        f'<robot name="{name}"><link name="{name}_base"/><link name="{name}_arm"/>'
        f'<joint name="{name}_joint" type="fixed">'
        f'<parent link="{name}_base"/><child link="{name}_arm"/></joint></robot>'
    )
    return path


def is_on_network(running: Running) -> bool:
    return bool(psutil.Process(running.process.pid).net_connections("udp"))


class LaunchPage:
    """The last messages that a page of a launch received, by type."""

    def __init__(self) -> None:
        self.told: dict[str, dict] = {}

    async def follow(self, running: Running, condition: Callable[[], object]) -> None:
        """Receive messages until a condition holds."""
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(running.url.replace("/?", "/ws?"), max_msg_size=0) as socket,
        ):
            while not condition():
                message = await socket.receive(timeout=TIMEOUT_S)
                if message.type is aiohttp.WSMsgType.TEXT:
                    decoded = json.loads(message.data)
                    for view_message in decoded if isinstance(decoded, list) else [decoded]:
                        self.told[view_message["type"]] = view_message

    def codes(self) -> list[str]:
        return [item["code"] for item in self.told.get("diagnostics", {"items": []})["items"]]

    def frames(self) -> list[str]:
        return self.told.get("frame_table", {"names": []})["names"]


async def test_views_are_isolated_unless_joined(start: Callable[..., Running], tmp_path: Path) -> None:
    views = {name: start("view", write_robot(tmp_path, name)) for name in ("red", "blue")}
    joined = start("view", write_robot(tmp_path, "green"), "--join")
    for launcher in (*views.values(), joined):
        launcher.until("Robot initialized")
    await eventually(lambda: is_on_network(joined))
    for name, view in views.items():
        page = LaunchPage()
        await page.follow(view, page.frames)
        assert page.frames() == [f"{name}_base", f"{name}_arm"]
        assert not is_on_network(view), "the view had more time to join than the one with --join"


async def test_launches_with_shared_node_names_are_reported_once(
    start: Callable[..., Running], tmp_path: Path, domain: int
) -> None:
    robot = write_robot(tmp_path, "red")
    actions = [
        f"Node(package='robot_state_publisher', executable='robot_state_publisher', arguments=['{robot}'])",
        "Node(package='rviz2', executable='rviz2')",
    ]
    (tmp_path / "a.launch.py").write_text(launch_file(*actions))
    first, second = start(tmp_path / "a.launch.py"), start(tmp_path / "a.launch.py")
    for launcher in (first, second):
        for node in ("/robot_state_publisher", "/rviz2"):
            wait_until(
                lambda launcher=launcher, node=node: node in _shared_lines(launcher),
                what=lambda launcher=launcher: launcher.err,
            )
    for launcher in (first, second):
        assert _shared_lines(launcher).count("/robot_state_publisher") == 1
        assert f"{SHARED_NAMES_TEXT} {domain} " in _shared_lines(launcher)
        assert f"for example with ROS_DOMAIN_ID={domain + 1} linkwright launch ..." in _shared_lines(launcher)
        assert "Another process has a node" not in launcher.err
    page = LaunchPage()
    await page.follow(second, lambda: page.codes() == ["LAUNCH148"])
    assert first.end()[0] == 130
    await page.follow(second, lambda: page.codes() == [])
    assert second.end()[0] == 130


def _shared_lines(running: Running) -> str:
    return "\n".join(line for line in running.err.splitlines() if SHARED_NAMES_TEXT in line)
