"""Fixtures of the launch tests: a launch in this process, and its log."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest

from linkwright.hosting.launch_log import LaunchLog
from linkwright.launch.engine.session import LaunchSession
from linkwright.launch.engine.supervisor import SessionOptions
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.packages import PackageFinder, use_finder
from linkwright.standins import activate
from tests.launch.launcher import Running

activate()


@dataclass
class Launched:
    """The result of a launch that has ended."""

    out: str
    err: str
    succeeded: bool
    session: LaunchSession

    @property
    def messages(self) -> list[str]:
        """Return the messages of LogInfo actions."""
        start = "[INFO] [launch.user]: "
        return [line[len(start) :] for line in self.err.splitlines() if line.startswith(start)]


@pytest.fixture(autouse=True)
def _isolated_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Keep log files in the folder of the test, and restore the environment after a launch."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")  # tests that need DDS enable it
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    for name in ("PROCESS_OUTPUT", "SCREEN_FORMAT", "LOG_FORMAT"):
        monkeypatch.delenv(f"OVERRIDE_LAUNCH_{name}", raising=False)
    before = dict(os.environ)
    yield
    os.environ.clear()
    os.environ.update(before)


@pytest.fixture
def launch(tmp_path: Path) -> Callable[..., object]:
    """Return a function that launches entities, waits for the end, and returns the result."""

    async def run_launch(
        *entities: LaunchDescriptionEntity,
        finder: PackageFinder | None = None,
        session_options: Mapping[str, Any] = MappingProxyType({}),
        **configurations: str,
    ) -> Launched:
        out, err = io.StringIO(), io.StringIO()
        finder = finder or PackageFinder(start=tmp_path, environment={})
        with use_finder(finder):
            options = SessionOptions(**{"port": 0, "open_browser": False, **session_options})
            session = LaunchSession(finder, options, LaunchLog(out, err))
            session.context.launch_configurations.update(configurations)
            succeeded = await session.run(LaunchDescription(entities))
        return Launched(out.getvalue(), err.getvalue(), succeeded, session)

    return run_launch


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    """Return a function that writes a file below the folder of the test."""

    def write_file(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write_file


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Running]]:
    running: list[Running] = []

    def start_launcher(*words: object, cwd: Path = tmp_path) -> Running:
        running.append(Running(tmp_path, [str(word) for word in words], cwd))
        return running[-1]

    yield start_launcher
    for launcher in running:
        if launcher.process.poll() is None:
            launcher.process.kill()
            launcher.process.wait()
