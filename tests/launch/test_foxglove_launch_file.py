"""The launch file of foxglove_bridge, which other launch files include."""

from __future__ import annotations

from launch.actions import IncludeLaunchDescription

from linkwright.packages.share_layout import find_substituted_share
from tests.launch.ending import end_when, has_printed


async def test_included_file_starts_bridge_with_its_arguments(launch) -> None:
    share = find_substituted_share("foxglove_bridge")
    assert share is not None
    path = str(share / "launch" / "foxglove_bridge_launch.xml")
    include = IncludeLaunchDescription(path, launch_arguments={"port": "0", "tls": "false"}.items())
    result = await launch(include, end_when(has_printed("Foxglove and Lichtblick connect to ws://127.0.0.1:")))
    assert result.succeeded, result.err
