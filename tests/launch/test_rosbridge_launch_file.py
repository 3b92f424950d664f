"""The launch file of rosbridge_server, which other launch files include."""

from __future__ import annotations

from launch.actions import IncludeLaunchDescription

from linkwright.packages.share_layout import find_substituted_share
from tests.launch.ending import end_when, has_printed


async def start_rosbridge(launch, printed: str, **arguments: str):
    share = find_substituted_share("rosbridge_server")
    assert share is not None
    path = str(share / "launch" / "rosbridge_websocket_launch.xml")
    include = IncludeLaunchDescription(path, launch_arguments={"port": "0", **arguments}.items())
    return await launch(include, end_when(has_printed(printed)))


async def test_included_file_starts_both_nodes_with_its_arguments(launch) -> None:
    result = await start_rosbridge(
        launch,
        "Rosbridge WebSocket server started on port",
        topics_glob="[/odom, /camera/*]",
        url_path="/robot",
        retry_startup_delay="1",
        delay_between_messages="0",
        ssl="false",
    )
    assert result.succeeded, result.err
    assert "/robot" in result.out + result.err
    assert "rosapi_node" in result.out + result.err


async def test_certificate_that_does_not_exist_is_named(launch) -> None:
    result = await start_rosbridge(launch, "cannot use", ssl="true", certfile="/none.pem", keyfile="/none.key")
    assert "cannot use the certificate '/none.pem'" in result.out + result.err
