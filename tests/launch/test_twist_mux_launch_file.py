"""The launch file of twist_mux, which other launch files include."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from launch.actions import IncludeLaunchDescription

from linkwright.packages.share_layout import find_substituted_share
from tests.launch.ending import end_when, has_printed


def make_include(**arguments: str) -> IncludeLaunchDescription:
    share = find_substituted_share("twist_mux")
    assert share is not None
    return IncludeLaunchDescription(str(share / "launch" / "twist_mux_launch.py"), launch_arguments=arguments.items())


@pytest.mark.parametrize(
    ("kind", "topic", "priority"),
    [("Topic", "nav_vel", 10), ("Topic", "joy_vel", 100), ("Lock", "stop_closing_loop", 200)],
)
async def test_default_topics_and_locks_are_used(launch: Any, kind: str, topic: str, priority: int) -> None:
    result = await launch(make_include(), end_when(has_printed(f"subscribed to topic '{topic}'")))
    assert result.succeeded, result.err
    assert any(f"'{topic}'" in line and f"priority = {priority}." in line for line in result.err.splitlines())


async def test_arguments_name_files_and_output(launch: Any, tmp_path: Path) -> None:
    topics = tmp_path / "topics.yaml"
    topics.write_text(
        "twist_mux: {ros__parameters: {topics: {web: {topic: web_vel, timeout: 0.5, priority: 7}}}}", encoding="utf-8"
    )
    include = make_include(config_topics=str(topics), config_joy="unused.yaml", cmd_vel_out="base/cmd_vel")
    result = await launch(include, end_when(has_printed("'web_vel'")))
    assert result.succeeded, result.err
    assert "'web_vel'" in result.err
    assert "nav_vel" not in result.err
