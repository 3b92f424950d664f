"""The launch files of urdf_launch, which other launch files include."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.actions import IncludeLaunchDescription

from linkwright.packages.share_layout import find_substituted_share
from linkwright.rviz.config.rviz_config import RvizConfig
from tests.launch.ending import end_when, has_printed

Write = Callable[[str, str], Path]


def make_include(name: str, **arguments: str) -> IncludeLaunchDescription:
    share = find_substituted_share("urdf_launch")
    assert share is not None
    return IncludeLaunchDescription(str(share / "launch" / name), launch_arguments=arguments.items())


@pytest.fixture
def described(write: Write, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, str]:
    """Write a package with a robot description, and return the arguments that name it."""
    write("ws/arm/package.xml", "<package><name>arm</name></package>")
    robot = '<robot name="a"><link name="base_link"/></robot>'
    write("ws/arm/urdf/an arm.xacro", robot)
    monkeypatch.chdir(tmp_path / "ws")
    return {"urdf_package": "arm", "urdf_package_path": "urdf/an arm.xacro"}


async def test_description_file_starts_robot_state_publisher(launch: Any, described: dict[str, str]) -> None:
    result = await launch(
        make_include("description.launch.py", **described), end_when(has_printed("Robot initialized"))
    )
    assert result.succeeded, result.err


@pytest.mark.parametrize(("gui", "node"), [("true", "joint_state_publisher_gui"), ("false", "joint_state_publisher")])
async def test_display_file_starts_publishers_and_page(
    launch: Any, described: dict[str, str], gui: str, node: str
) -> None:
    include = make_include("display.launch.py", jsp_gui=gui, **described)
    result = await launch(include, end_when(has_printed(f"[{node}-2]: started in the launcher's process")))
    assert result.succeeded, result.err
    assert "Viewer: http://" in result.out


def test_view_loads_without_warnings() -> None:
    share = find_substituted_share("urdf_launch")
    assert share is not None
    config = RvizConfig.load(share / "config" / "urdf.rviz")
    assert not config.warnings
    assert [display.name for display in config.displays] == ["Grid", "RobotModel", "TF"]
