"""Displays: classes, statuses, the grid and TF."""

from __future__ import annotations

import subprocess
import sys

import pytest

from linkwright.rviz import RvizConfig
from linkwright.rviz.displays.catalog import display_classes, has_display
from tests.viewer.scene import ARM, IDENTITY, open_page, open_world, rows_by_id


def make_config(displays: str, fixed_frame: str = "base") -> RvizConfig:
    return RvizConfig.parse(
        f"Visualization Manager:\n  Global Options: {{Fixed Frame: {fixed_frame}}}\n  Displays:\n{displays}"
    )


GRID = "    - {Class: rviz_default_plugins/Grid, Enabled: true}\n"


async def open_client(world):
    async with open_page(world.viewer) as client:
        return await client.opened()


async def wait_for_rows(client, identity: str) -> dict[str, dict]:
    """Return the rows of a display when it has one with this ID.

    Frames are discovered one by one.
    """
    while True:
        rows = rows_by_id((await client.until("display_properties"))["properties"])
        if identity in rows:
            return rows


# --- display classes -----------------------------------------------------------------------------------------------


def test_display_classes_are_found_by_unique_names():
    for cls in display_classes():
        assert has_display(cls.CLASS)
    assert len({cls.CLASS for cls in display_classes()}) == len(display_classes())


def test_data_displays_are_imported_lazily():
    """Without these imports, the program responds to a browser sooner."""
    code = "import sys, linkwright.viewer.viewer; print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    rooms = ("clouds", "image_compression", "markers", "displays.base.topic_display")
    assert not {f"linkwright.rviz.{room}" for room in rooms} & set(result.stdout.split())
    assert not {"PIL", "cyclonedds", "rosbags", "linkwright.inertia"} & set(result.stdout.split())


# --- Grid ----------------------------------------------------------------------------------------------------------


async def test_grid_properties_and_defaults_match_rviz():
    async with open_world(make_config(GRID)) as world:
        (grid,) = (await open_client(world))["tree"]["displays"]
    assert (grid["id"], grid["name"], grid["enabled"], grid["supported"]) == ("display-1", "Grid", True, True)
    values = {row["name"]: row["value"] for row in grid["properties"]}
    assert values == {
        "Reference Frame": "<Fixed Frame>",
        "Plane Cell Count": 10,
        "Normal Cell Count": 0,
        "Cell Size": 1.0,
        "Line Style": "Lines",
        "Color": "#a0a0a4",
        "Alpha": 0.5,
        "Plane": "XY",
        "Offset": None,
    }
    offset = next(row for row in grid["properties"] if row["name"] == "Offset")
    assert [(row["name"], row["value"]) for row in offset["children"]] == [("X", 0.0), ("Y", 0.0), ("Z", 0.0)]
    assert grid["status"] == [{"name": "Transform", "level": "ok", "text": "Transform OK"}]


async def test_line_width_is_shown_only_for_billboards():
    async with open_world(make_config(GRID)) as world, open_page(world.viewer) as client:
        opening = await client.opened()
        assert "display-1/Line Style/Line Width" not in rows_by_id(opening["tree"]["displays"][0]["properties"])
        await client.set("display-1/Line Style", "Billboards")
        rows = rows_by_id((await client.until("display_properties"))["properties"])
        assert rows["display-1/Line Style/Line Width"]["value"] == 0.03


async def test_grid_in_unknown_frame_is_reported():
    async with open_world(make_config(GRID)) as world, open_page(world.viewer) as client:
        await client.opened()
        await client.set("display-1/Reference Frame", "/tip")
        status = await client.until("display_status", display="display-1")
        assert (status["level"], status["status"][0]["text"]) == ("error", "Could not transform from [tip] to [base]")
        world.move_arm()
        status = await client.until("display_status", display="display-1")
        assert (status["level"], status["status"][0]["text"]) == ("ok", "Transform OK")


# --- TF ------------------------------------------------------------------------------------------------------------


def tf_display(properties: str = "") -> str:
    return f"    - {{Class: rviz_default_plugins/TF, Enabled: true{properties}}}\n"


async def test_tf_display_lists_frames():
    async with open_world(
        make_config(tf_display(", Frames: {All Enabled: false, tip: {Value: false}, gone: {Value: false}}"))
    ) as world:
        world.move_arm()
        await world.settle()
        display = (await open_client(world))["tree"]["displays"][0]
    rows = {row["name"]: row for row in display["properties"]}
    assert rows["Frame Timeout"]["value"] == 15.0
    frames = {row["name"]: row["value"] for row in rows["Frames"]["children"]}
    assert list(frames.items()) == [("All Enabled", False), ("base", True), ("mark", True), ("tip", False)]
    (base,) = rows["Tree"]["children"]
    (tip,) = base["children"]
    (mark,) = tip["children"]
    assert [row["name"] for row in (base, tip, mark)] == ["base", "tip", "mark"]
    assert [(row["name"], row["text"]) for row in display["status"]] == [
        (name, "Transform OK") for name in ("base", "mark", "tip")
    ]


async def test_tf_frame_checkboxes_are_saved():
    async with open_world(make_config(tf_display())) as world, open_page(world.viewer) as client:
        world.move_arm()
        await wait_for_rows(client, "display-1/Frames/mark")
        await client.set("display-1/Frames/tip", False)
        assert (await client.until("property_changed", id="display-1/Frames/tip"))["value"] is False
        await client.set("display-1/Frames/All Enabled", False)
        rows = rows_by_id((await client.until("display_properties"))["properties"])
        assert [rows[f"display-1/Frames/{name}"]["value"] for name in ("base", "mark", "tip")] == [False] * 3
        section = world.viewer.config.displays[0].section
        assert section.scalar("Frames", "base").text == "false"
        assert section.section("Frames", "base").keys() == ["Value"]


async def test_disabled_frame_unchecks_all_enabled():
    async with open_world(make_config(tf_display())) as world, open_page(world.viewer) as client:
        world.move_arm()
        properties = (await client.until("display_properties", display="display-1"))["properties"]
        rows = rows_by_id(properties)
        assert rows["display-1/Frames/tip"]["details"] == "frame"
        assert rows["display-1/Frames/All Enabled"]["details"] is None
        await client.set("display-1/Frames/tip", False)
        assert (await client.until("property_changed", id="display-1/Frames/All Enabled"))["value"] is False
        await client.until("property_changed", id="display-1/Frames/tip")
        assert world.display("TF").properties.get("Frames", "base") is True


async def test_tf_frames_without_transform_are_reported():
    async with open_world(make_config(tf_display(), fixed_frame="map")) as world:
        world.move_arm()
        await world.settle()
        display = (await open_client(world))["tree"]["displays"][0]
    assert display["level"] == "warn"
    assert {row["text"] for row in display["status"]} == {
        f"No transform from [{name}] to [map]" for name in ("base", "mark", "tip")
    }


async def test_tf_filters_choose_frames():
    async with open_world(make_config(tf_display())) as world, open_page(world.viewer) as client:
        world.move_arm()
        await wait_for_rows(client, "display-1/Frames/mark")

        async def frames_with(name: str, text: str) -> list[str]:
            await client.set(f"display-1/{name}", text)
            frames = next(
                row for row in (await client.until("display_properties"))["properties"] if row["name"] == "Frames"
            )
            return [row["name"] for row in frames["children"][1:]]

        assert await frames_with("Filter (whitelist)", "^(tip|mark)$") == ["mark", "tip"]
        assert await frames_with("Filter (blacklist)", "ar") == ["tip"]
        assert await frames_with("Filter (whitelist)", "") == ["base", "tip"]
        await client.set("display-1/Filter (whitelist)", "(")
        status = await client.until("display_status", display="display-1", level="error")
        text = "This expression is not used: missing ) at position 1"
        assert status["status"][0] == {"name": "Filter (whitelist)", "level": "error", "text": text}


async def test_slow_tf_filter_is_disabled_and_reported():
    long = "a" * 200 + "!"
    async with open_world(make_config(tf_display(", Filter (whitelist): (a|aa)+$"))) as world:
        world.move({("base", long): IDENTITY})
        await world.settle()
        (display,) = (await open_client(world))["tree"]["displays"]
        text = "This expression is not used: matching it with the frame names takes too long"
        assert display["status"][0] == {"name": "Filter (whitelist)", "level": "error", "text": text}
        assert {row["name"] for row in display["status"][1:]} == {"base", long}
        world.display("TF").set_property(("Filter (whitelist)",), "^b")
        assert set(world.status("TF")) == {"base"}


async def test_long_frame_chain_is_shown():
    poses = {(f"f{number}", f"f{number + 1}"): IDENTITY for number in range(400)}
    async with open_world(make_config(tf_display(), fixed_frame="f0")) as world:
        world.move(poses)
        await world.settle()
        display = (await open_client(world))["tree"]["displays"][0]
    assert len(display["status"]) == 401
    tree = display["properties"][-1]
    depth = 0
    while tree["children"]:
        (tree,) = tree["children"]
        depth += 1
    assert (tree["name"], depth) == ("...", 61)


# --- others --------------------------------------------------------------------------------------------------------


async def test_unsupported_displays_are_listed_and_kept():
    text = "    - {Class: my_plugins/Radar, Enabled: true, Name: Radar, Size (m): 0.05}\n"
    async with open_world(make_config(text)) as world:
        (radar,) = (await open_client(world))["tree"]["displays"]
        assert (radar["supported"], radar["level"], radar["properties"]) == (False, "warn", [])
        assert "my_plugins/Radar" in radar["status"][0]["text"]
        assert "Size (m): 0.05" in world.viewer.config.text()


@pytest.mark.parametrize("cls", ["Grid", "TF", "RobotModel", "LaserScan"])
async def test_disabled_display_has_no_status_until_enabled(cls):
    async with open_world(make_config(f"    - {{Class: rviz_default_plugins/{cls}, Value: true}}\n")) as world:
        world.describe(ARM)
        world.move_arm()
        await world.settle()
        async with open_page(world.viewer) as client:
            before = (await client.opened())["tree"]["displays"][0]["status"]
            assert before
            await client.set("display-1/Enabled", False)
            assert (await client.until("property_changed", id="display-1/Enabled"))["value"] is False
            assert (await client.until("display_status", display="display-1"))["status"] == []
            await client.set("display-1/Enabled", True)
            assert (await client.until("display_status", display="display-1"))["status"] == before
            await client.set("display-1/Enabled", "on")
            assert await client.until("property_changed", id="display-1/Enabled", value=True)
