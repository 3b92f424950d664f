"""The imported modules when a page opens."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

OPENING = """
import asyncio, sys
from tests.viewer.scene import open_page, open_world

async def main():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        print(*sys.modules)
        await client.send("watch_node_graph", watched=True)
        await client.until("node_graph")
        print(*sys.modules)

asyncio.run(main())
"""


def test_panels_and_displays_are_imported_on_demand():
    root = Path(__file__).parents[2]
    result = subprocess.run([sys.executable, "-c", OPENING], capture_output=True, text=True, cwd=root, check=True)
    opened, watching = (set(line.split()) for line in result.stdout.splitlines())
    panels, displays = "linkwright.panels", "linkwright.rviz.displays"
    lazy_modules = {f"{panels}.monitor.{name}" for name in ("node_graph", "parameters", "plots", "teleop", "topics")}
    lazy_modules |= {f"{displays}.{name}" for name in ("image", "map", "marker", "point_clouds")}
    assert not opened & {*lazy_modules, f"{panels}.export.feature", "linkwright.sdf.reader", "linkwright.sdf.writer"}
    assert not [module for module in opened if module.startswith("linkwright.planning")]
    assert watching & lazy_modules == {f"{panels}.monitor.node_graph"}


GIVING_OUT = """
import asyncio, sys
import linkwright.hosting.view
from linkwright.page.page_server import PageServer

async def main():
    server = PageServer("127.0.0.1", 0)
    await server.open()
    print(*sys.modules)
    await server.close()

asyncio.run(main())
"""


def test_page_is_served_before_robot_modules_are_imported():
    root = Path(__file__).parents[2]
    result = subprocess.run([sys.executable, "-c", GIVING_OUT], capture_output=True, text=True, cwd=root, check=True)
    rooms = {f"linkwright.{room}" for room in ("graph", "messages", "urdf", "viewer.viewer", "page.protocol")}
    assert not set(result.stdout.split()) & {*rooms, "numpy", "yaml", "msgspec"}
