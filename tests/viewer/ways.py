"""Print the files of Linkwright whose functions run on two paths, as JSON.

The program is for `tests.viewer.test_data_path_length`.

The paths are from the start of `linkwright view` to an open page, and from a slider of a page to the page's next joint
positions and transforms. The process must not have imported Linkwright, because imports are part of the first path.
"""

from __future__ import annotations

import asyncio
import importlib.util
import io
import json
import os
import sys
import threading
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from types import FrameType
from typing import Any

import aiohttp

from tests.places import PACKAGE
from tests.waiting import TIMEOUT_S, eventually

ROBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"


class FunctionFiles:
    """Records the files below a folder whose functions run; the code of modules does not count.

    Args:
        folder: the folder whose files are recorded.
    """

    def __init__(self, folder: Path) -> None:
        self._prefix = f"{folder}{os.sep}"
        self._found: set[str] = set()
        self._records = False
        threading.setprofile(self._look)
        sys.setprofile(self._look)

    def _look(self, frame: FrameType, event: str, _argument: Any) -> None:
        if self._records and event == "call":
            code = frame.f_code
            if code.co_name != "<module>" and code.co_filename.startswith(self._prefix):
                self._found.add(code.co_filename)

    def start(self) -> None:
        """Start recording."""
        self._found.clear()
        self._records = True

    def stop(self) -> list[str]:
        """Stop recording, and return the paths of the files relative to the folder."""
        self._records = False
        return sorted(file.removeprefix(self._prefix) for file in self._found)


async def _until(
    socket: aiohttp.ClientWebSocketResponse, is_last: Callable[[str, dict[str, Any]], bool], *kinds: str
) -> None:
    """Receive until messages of all kinds have arrived.

    The last of them is one that `is_last` accepts.
    """
    missing = set(kinds)
    async for message in socket:
        text = message.type is aiohttp.WSMsgType.TEXT
        content = json.loads(message.data) if text else {}
        kind = content.get("type", "binary")
        missing.discard(kind)
        if not missing and is_last(kind, content):
            return


def _is_stored(kind: str, content: dict[str, Any]) -> bool:
    """Return whether a message is the history's report, which is sent each second."""
    return kind == "history_extent" and content["size"] > 0


async def _main() -> None:
    (folder,) = importlib.util.find_spec("linkwright").submodule_search_locations  # type: ignore[union-attr]
    files = FunctionFiles(Path(folder))
    files.start()
    from linkwright.hosting.launch_log import LaunchLog
    from linkwright.hosting.plans import HostOptions
    from linkwright.hosting.view import ModelView
    from linkwright.hosting.xacro_calls import XacroCall
    from linkwright.packages import PackageFinder

    output = io.StringIO()
    with redirect_stdout(output):
        finder = PackageFinder(start=[ROBOT.parent])
        view = ModelView(XacroCall(ROBOT, ()), finder, HostOptions("127.0.0.1", 0, False, network=False), LaunchLog())
        viewing = asyncio.create_task(view.run(None))
        await eventually(lambda: "Viewer: " in output.getvalue())
        address = output.getvalue().partition("Viewer: ")[2].split()[0]
        server, _, token = address.partition("/?token=")
        async with aiohttp.ClientSession(cookie_jar=aiohttp.CookieJar(unsafe=True)) as session:
            async with session.get(address) as response:
                await response.read()
            origin = {"Origin": server}
            async with session.ws_connect(f"{server.replace('http', 'ws')}/ws?token={token}", headers=origin) as page:
                await _until(page, _is_stored, "frame_table", "joints", "robot_scene", "binary")
                opening = files.stop()
                moves = []
                for position in (0.7, 0.9, 1.1):
                    files.start()
                    move = {"type": "set_joint", "name": "left_wheel_joint", "position": position}
                    await page.send_str(json.dumps(move))
                    await _until(page, _is_stored, "joint_positions", "binary")
                    moves.append(set(files.stop()))
                slider = sorted(set.intersection(*moves))  # code that runs only sometimes is not on the path
        view.interrupt("done")
        await viewing
    json.dump({"opening": opening, "slider": slider}, sys.stdout)


if __name__ == "__main__":
    asyncio.run(asyncio.wait_for(_main(), TIMEOUT_S))
