"""The example display of the page about users' displays."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest

from linkwright.loading import extensions
from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.displays import catalog
from tests.docs.pages import DOCS, read_blocks
from tests.toml_files import read_toml
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_page, open_world

PAGES = (DOCS / "own-displays.md", DOCS / "zh" / "own-displays.md")
CLASS = "street_displays/TrackedObjects"
POINTS_CLASS = "street_displays/ObjectPoints"
CONFIG = f"""\
Visualization Manager:
  Global Options: {{Fixed Frame: base}}
  Displays:
    - Class: {CLASS}
      Enabled: true
      Name: Street
      Topic: {{Value: /objects}}
"""


def read_files(language: Path) -> dict[str, str]:
    return {block.title: block.text for block in read_blocks(language) if block.title}


@pytest.fixture(params=PAGES, ids=["en", "zh"])
def installed_display(request, tmp_path, monkeypatch):
    """Install the package of the page, and return its workspace."""
    texts = read_files(request.param)
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    project = read_toml(texts["street_displays/pyproject.toml"])["project"]
    facts = tmp_path / "street_displays" / "street_displays-1.0.dist-info"
    facts.mkdir()
    points = {**project["entry-points"]["linkwright.displays"], POINTS_CLASS: "object_points:ObjectPoints"}
    lines = ["[linkwright.displays]", *(f"{name} = {value}" for name, value in points.items()), ""]
    (facts / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(tmp_path / "street_displays"))
    monkeypatch.chdir(tmp_path)
    extensions._read_all_groups.cache_clear()
    catalog._load_display_class.cache_clear()
    yield
    monkeypatch.undo()
    sys.modules.pop("street_displays", None)
    sys.modules.pop("object_points", None)
    extensions._read_all_groups.cache_clear()
    catalog._load_display_class.cache_clear()


def make_car(number: int, x: float, *, label: str = "car", speed: float = 3.0, path: int = 0) -> Any:
    car = get_message("street_msgs/msg/TrackedObject")(id=number, label=label, speed=speed)
    car.pose.position.x = x
    car.size.x, car.size.y, car.size.z = 4.0, 2.0, 1.5
    car.path = [get_message("geometry_msgs/msg/Point")(x=x + step) for step in range(path)]
    return car


def make_detections(*objects: Any) -> Any:
    cars = get_message("street_msgs/msg/TrackedObjects")(objects=list(objects))
    cars.header.frame_id = "street"
    return cars


def test_both_languages_have_same_example():
    first, second = map(read_files, PAGES)
    assert first == second


def test_example_display_has_at_most_60_lines():
    lines = read_files(PAGES[0])["street_displays/street_displays.py"].splitlines()
    assert len([line for line in lines if line.strip()]) <= 60


async def test_example_display_draws_and_removes_tracked_objects(installed_display):
    async with open_world(RvizConfig.parse(CONFIG)) as world, open_page(world.viewer) as client:
        await client.opened()
        await client.send("request_display_choices")
        choices = (await client.until("display_choices"))["classes"]
        assert {"cls": CLASS, "messages": ["street_msgs/msg/TrackedObjects"]} in choices
        node = world.graph.create_node("perception")
        publisher = node.create_publisher("street_msgs/msg/TrackedObjects", "/objects", 10)
        await world.settle()
        publisher.publish(make_detections(make_car(1, 5.0, path=3), make_car(2, -5.0, label="bicycle")))
        await world.settle()
        (display,) = world.viewer.displays
        assert display.row().drawing == "rviz_default_plugins/MarkerArray"
        assert shown_markers(display) == {}  # there is no frame 'street' yet
        world.move({("base", "street"): (0, 0, 1, 0, 0, 0, 1)}, static=True)
        await world.settle()
        markers = shown_markers(display)
        assert {name: marker["shape"] for name, marker in markers.items()} == {
            "boxes/1": "cube",
            "names/1": "text",
            "paths/1": "line_strip",
            "boxes/2": "cube",
            "names/2": "text",
        }
        assert markers["boxes/1"]["pose"][:3] == [5, 0, 1]
        assert markers["names/1"]["text"] == "car 3.0 m/s"
        display.set_property(("Show Names",), False)
        display.set_property(("Alpha",), 0.25)
        markers = shown_markers(display)
        assert sorted(markers) == ["boxes/1", "boxes/2", "paths/1"]
        assert markers["boxes/2"]["color"] == pytest.approx([1, 0.6, 0, 0.25])
        publisher.publish(make_detections(make_car(2, -4.0, speed=math.inf)))
        await world.settle()
        assert list(shown_markers(display)) == ["boxes/2"]
        assert world.status("TrackedObjects")["Speed"] == ("warn", "The speed of object 2 is impossible")
        publisher.publish(make_detections(make_car(3, math.nan)))
        await world.settle()
        status = world.status("TrackedObjects")
        assert status["boxes/3"] == ("error", "Contains invalid floating point values (nans or infs)")
        assert "Speed" not in status
        assert world.viewer.config.text() != CONFIG
        display.set_property(("Show Names",), True)


async def test_configuration_with_example_display_is_saved_unchanged(installed_display):
    async with open_world(RvizConfig.parse(CONFIG)) as world:
        assert world.viewer.displays[0].SUPPORTED
        assert world.viewer.config.text() == CONFIG


async def test_the_objects_are_drawn_as_points_with_a_channel(installed_display):
    async with open_world(RvizConfig.parse(CONFIG.replace(CLASS, POINTS_CLASS))) as world:
        publisher = world.graph.create_node("perception").create_publisher(
            "street_msgs/msg/TrackedObjects", "/objects", 10
        )
        world.move({("base", "street"): (0, 0, 1, 0, 0, 0, 1)}, static=True)
        await world.settle()
        publisher.publish(make_detections(make_car(1, 5.0), make_car(2, -5.0)))
        await world.settle()
        (display,) = world.viewer.displays
        assert display.row().drawing == "rviz_default_plugins/PointCloud2"
        assert display.get_fields("", 0) == {"speed": 3.0}
        assert world.status("ObjectPoints")["Points"][0] == "ok"
