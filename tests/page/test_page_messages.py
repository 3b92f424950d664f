"""After any valid message of a page, the viewer continues.

The configuration can still be saved.
"""

from __future__ import annotations

import random
import types
import typing
from typing import Any

import msgspec
import pytest

from linkwright.page.protocol.configuration import SetProperty
from linkwright.page.protocol.message import PageMessage, Received
from linkwright.rviz import RvizConfig
from tests.viewer.configured import TEXT
from tests.viewer.scene import open_page, open_world

DISPLAYS = "".join(
    f"    - {{Class: rviz_default_plugins/{name}, Enabled: true, Name: {name}}}\n"
    for name in ("RobotModel", "TF", "PointCloud2", "MarkerArray", "Map", "Camera", "DepthCloud", "Effort", "Odometry")
)
CONFIGURATION = TEXT.replace("  Global Options:", DISPLAYS + "  Global Options:")
WORDS = ["", "/", "a/b", "no name", "..", "~nobody", "../x.rviz", "\0", "x" * 3000, "\u2603", "(a+", "-1", "/tf"]
WORDS += ["tip", "rviz_default_plugins/Grid", "rviz_default_plugins/Orbit", "rviz_common/Group", "view-1", "/cmd_vel"]
ROWS = ("Enabled", "Topic", "Topic/Depth", "Alpha", "Decay Time")
IDS = ["global/Fixed Frame", "tool-6", "tool-6/Topic", *(f"display-{number}" for number in range(1, 14))]
IDS += [f"{display}/{row}" for display in IDS[3:] for row in ROWS]
# A page must not send false acknowledgments.
MESSAGES = [subclass for subclass in PageMessage.__subclasses__() if subclass is not Received]
MESSAGES += [SetProperty] * 30


def generate_value(kind: Any, name: str, rng: random.Random) -> Any:
    """Generate a JSON value that a field of the protocol may contain."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        hints = typing.get_type_hints(kind)
        fields = {field: generate_value(hints[field], field, rng) for field in kind.__struct_fields__}
        return fields | ({"type": kind.__struct_config__.tag} if issubclass(kind, PageMessage) else {})
    if origin is typing.Literal:
        return rng.choice(arguments)
    if origin is list:
        return [generate_value(arguments[0], name, rng) for _ in range(rng.choice([0, 1, 3, 7]))]
    if origin is dict:
        return {rng.choice(WORDS): generate_value(arguments[1], name, rng) for _ in range(rng.choice([0, 1, 3]))}
    if origin in (typing.Union, types.UnionType):
        return generate_value(rng.choice(arguments), name, rng)
    values: dict[Any, list[Any]] = {
        bool: [False, True],
        int: [0, 1, -1, 2**31, -(2**63), 10**30],
        float: [0.0, 1.0, -1.5, 1e308, -1e308, 5e-324],
        str: IDS if name in ("id", "display", "displays", "group", "before") and rng.random() < 0.8 else WORDS,
        type(None): [None],
    }
    return rng.choice(values[kind])


@pytest.mark.parametrize("seed", range(3))
async def test_viewer_survives_random_page_messages(seed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rng = random.Random(seed)
    async with open_world(RvizConfig.parse(CONFIGURATION)) as world, open_page(world.viewer) as client:
        await client.opened()
        world.move_arm()
        for _ in range(30):
            sent = [generate_value(rng.choice(MESSAGES), "", rng) for _ in range(20)]
            for message in sent:
                await client.socket.send_json(message)
            await client.drain(0.01)
            failures = [line for line in world.logged().splitlines() if "failed" in line or "Traceback" in line]
            assert failures == [], sent
        await client.send("request_configuration_text")
        text = (await client.until("configuration_text"))["text"]
        assert RvizConfig.parse(text).text() == text
