"""Displays and page features from other packages."""

from __future__ import annotations

import os
import sys
from importlib.metadata import entry_points

import pytest

from linkwright.loading import extensions
from linkwright.rviz import RvizConfig
from linkwright.rviz.displays import catalog
from tests.viewer.scene import open_page, open_world

MODULE = """\
from linkwright.rviz.displays.geometry import PolygonDisplay
from linkwright.panels.page_feature import PageFeature
from linkwright.page.protocol.message import PageMessage, ServerMessage


class Fence(PolygonDisplay):
    CLASS = "brought/Fence"
    DRAWN_AS = PolygonDisplay.CLASS
    MESSAGE = "geometry_msgs/msg/PolygonStamped"


class Greet(PageMessage):
    name: str


class Greeting(ServerMessage):
    text: str


class GreetingFeature(PageFeature):
    RECEIVES = (Greet,)

    def receive(self, page, message):
        page.send(Greeting(f"hello {message.name}"))
"""
ENTRY_POINTS = """\
[linkwright.displays]
brought/Fence = brought_to_linkwright:Fence
brought/Broken = brought_to_linkwright:Nothing
rviz_default_plugins/Grid = brought_to_linkwright:Fence

[linkwright.page_features]
greeting = brought_to_linkwright:GreetingFeature
broken = brought_to_linkwright:nothing
"""


@pytest.fixture
def extension_package(tmp_path, monkeypatch):
    """Create a package with a display and a page feature, and others that cannot be loaded."""
    (tmp_path / "brought_to_linkwright.py").write_text(MODULE)
    facts = tmp_path / "brought_to_linkwright-1.0.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text("Metadata-Version: 2.1\nName: brought-to-linkwright\nVersion: 1.0\n")
    (facts / "entry_points.txt").write_text(ENTRY_POINTS)
    monkeypatch.syspath_prepend(str(tmp_path))
    extensions._read_all_groups.cache_clear()
    catalog._load_display_class.cache_clear()
    yield
    monkeypatch.undo()
    sys.modules.pop("brought_to_linkwright", None)
    extensions._read_all_groups.cache_clear()
    catalog._load_display_class.cache_clear()


def make_config(cls: str) -> RvizConfig:
    config = RvizConfig.for_model("base")
    config.insert(config.make_display(cls, "Brought"))
    return config


async def test_display_of_another_package_is_created_and_offered(extension_package):
    async with open_world(make_config("brought/Fence")) as world, open_page(world.viewer) as client:
        first = await client.opened()
        (fence,) = [display for display in first["tree"]["displays"] if display["cls"] == "brought/Fence"]
        assert (fence["supported"], fence["drawing"]) == (True, "rviz_default_plugins/Polygon")
        await client.send("request_display_choices")
        classes = (await client.until("display_choices"))["classes"]
        assert {"cls": "brought/Fence", "messages": ["geometry_msgs/msg/PolygonStamped"]} in classes


async def test_display_that_cannot_be_imported_is_kept_and_reported(extension_package):
    async with open_world(make_config("brought/Broken")) as world:
        assert not world.viewer.displays[-1].SUPPORTED
        assert "'brought/Broken' cannot be imported: AttributeError" in world.logged()


def test_built_in_display_cannot_be_replaced(extension_package):
    assert extensions.extensions("linkwright.displays")["rviz_default_plugins/Grid"].value.startswith("linkwright.")


async def test_page_feature_of_another_package_receives_messages(extension_package):
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        await client.send("greet", name="you")
        assert (await client.until("greeting"))["text"] == "hello you"
        assert "The page feature 'broken' cannot be loaded: AttributeError" in world.logged()


def test_extensions_match_installation_metadata():
    for group, entries in extensions._read_all_groups().items():
        declared = {(entry.name, entry.value) for entry in entry_points(group=group)}
        assert {(entry.name, entry.value) for entry in entries.values()} == declared


def test_entry_points_support_nested_attributes_and_extras():
    assert extensions.EntryPoint("join", "os:path.join [some, extras]", "none").load() is os.path.join
