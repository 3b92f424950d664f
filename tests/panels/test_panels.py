"""The visible panels of RViz in a file, and changes to them."""

from __future__ import annotations

import difflib

import pytest

from linkwright.rviz import RvizConfig
from linkwright.rviz.config.panels import is_shown, set_dock_shown
from tests.panels.panels import RVIZ_PANELS, window_state
from tests.viewer.configured import open_configured
from tests.viewer.scene import open_page

DISPLAYS = "Visualization Manager:\n  Displays: []\n"
FIRST_OF_RVIZ = {"Selection": False, "Tool Properties": False}
"""The hidden panels of RViz's first window."""


def parse_panels(geometry: str = "", panels: str = RVIZ_PANELS) -> RvizConfig:
    return RvizConfig.parse(panels + DISPLAYS + geometry)


def changed_lines(config: RvizConfig, before: str) -> list[str]:
    """Return the changed lines, without those that only contain the state of the window."""
    lines = difflib.ndiff(before.splitlines(), config.text().splitlines())
    return [line for line in lines if line[0] in "+-" and "QMainWindow State" not in line]


def test_listed_panels_are_shown_in_file_order():
    assert parse_panels().panels.shown == ["displays", "selection", "tool-properties", "views"]
    assert parse_panels(panels="Panels: []\n").panels.shown == []
    assert parse_panels(panels="").panels.shown is None
    assert parse_panels(panels="Panels: ~\n").panels.shown is None


def test_panels_hidden_in_window_state_are_not_shown():
    assert parse_panels(window_state(**FIRST_OF_RVIZ)).panels.shown == ["displays", "views"]
    assert parse_panels(window_state(Views=False)).panels.shown == ["displays", "selection", "tool-properties"]


def test_panels_on_collapsed_window_side_are_not_shown():
    assert parse_panels(window_state(("Views",), hide_right=True)).panels.shown == [
        "displays",
        "selection",
        "tool-properties",
    ]
    # RViz shows a collapsed dock if its side is not hidden.
    assert "views" in (parse_panels(window_state(("Views",), Views=False)).panels.shown or [])


def test_rviz1_panel_names_are_recognized_and_unnamed_entries_skipped():
    former = ("Displays, Name: Displays", "Time, Name: Zeit", "Views")
    config = parse_panels(panels="Panels:\n" + "".join(f"  - {{Class: rviz/{name}}}\n" for name in former))
    assert config.panels.shown == ["displays", "time"]
    config.panels.show(["displays", "time", "selection", "transformation"])
    assert config.panels.shown == ["displays", "time", "selection"]
    assert "rviz/Selection" in config.text()
    assert "Transformation" not in config.text(), "RViz 1 has no panel Transformation"


@pytest.mark.parametrize("cls", ["rviz/Help", "rviz_common/Help"])
def test_help_and_visual_tools_are_panels_of_the_page(cls):
    entries = f"  - {{Class: {cls}, Name: Help}}\n  - {{Class: rviz_visual_tools/RvizVisualToolsGui, Name: Steps}}\n"
    config = parse_panels(panels=f"Panels:\n{entries}")
    assert config.panels.shown == ["help", "visual-tools"]
    assert not config.warnings
    config.panels.show([])
    config.panels.show(["visual-tools"])
    assert config.panels.shown == ["visual-tools"]
    assert "rviz_visual_tools/RvizVisualToolsGui" in config.text()


def test_unknown_panels_are_reported_once_and_kept():
    config = parse_panels()
    assert [(warning.code, warning.span.line) for warning in config.warnings] == [("RVIZ204", 16)]
    assert "'Knobs'" in config.warnings[0].message
    config.panels.show([])
    assert config.panels.shown == []
    assert "  - Class: some_package/Knobs\n    Level: 11\n    Name: Knobs\n" in config.text()


def test_closed_panel_is_hidden_in_window_state_and_keeps_entry():
    config = parse_panels(window_state(**FIRST_OF_RVIZ))
    before = config.text()
    assert config.panels.show(["displays"])
    assert changed_lines(config, before) == []
    reread = RvizConfig.parse(config.text())
    assert reread.panels.shown == ["displays"]
    assert not reread.panels.show(["displays"])
    assert reread.panels.show(["displays", "views"])
    assert (reread.panels.shown, reread.text()) == (["displays", "views"], before)


def test_closed_panel_without_window_state_returns_to_its_position():
    config = parse_panels()
    before = config.text()
    config.panels.show(["tool-properties"])
    assert RvizConfig.parse(config.text()).panels.shown == ["tool-properties"]
    config.panels.show(["views", "displays", "selection", "tool-properties"])
    assert config.text() == before


def test_opened_panel_missing_from_file_is_added():
    for geometry in ("", window_state(**FIRST_OF_RVIZ)):
        config = parse_panels(geometry)
        before = config.text()
        shown = config.panels.shown
        config.panels.show([*shown, "time"])
        assert changed_lines(config, before) == ["+   - Class: rviz_common/Time", "+     Name: Time"]
        assert RvizConfig.parse(config.text()).panels.shown == [*shown, "time"]
        config.panels.show(shown)
        assert config.text() == before


def test_opened_panel_is_expanded():
    config = parse_panels(window_state(("Views",), hide_right=True, Views=False))
    before = config.text()
    config.panels.show([*config.panels.shown, "views"])
    assert RvizConfig.parse(config.text()).panels.shown == ["displays", "selection", "tool-properties", "views"]
    assert changed_lines(config, before) == ["-     collapsed: true", "+     collapsed: false"]


def test_file_without_panels_gets_a_list():
    config = parse_panels(panels="")
    assert config.panels.show(["displays", "time"])
    assert RvizConfig.parse(config.text()).panels.shown == ["displays", "time"]
    assert config.text().startswith("Panels:\n- Class: rviz_common/Displays\n  Name: Displays\n- Class: rviz_")


@pytest.mark.parametrize("state", ["", "zz", "00 ff", "fb0000000a0056006900650077007", "fbffffffff00560069"])
def test_invalid_window_state_is_ignored(state):
    assert is_shown(state, "Views") is None
    assert set_dock_shown(state, "Views", is_visible=False) == state


def test_first_of_duplicate_docks_applies():
    views = "FB0000000A00560069006500770073"
    state = f"00ff{views}01aa{views}03bb"
    assert is_shown(state, "Views") is True
    hidden = set_dock_shown(state, "Views", is_visible=False)
    assert hidden == f"00ff{views}00aa{views}03bb"
    assert set_dock_shown(hidden, "Views", is_visible=True) == state
    assert is_shown(state, "View") is None


async def test_pages_open_with_panels_of_file_and_last_change_is_saved(tmp_path):
    path = tmp_path / "a.rviz"
    text = RVIZ_PANELS + DISPLAYS + window_state(**FIRST_OF_RVIZ)
    async with open_configured(text, path) as (world, client):
        assert client.first["panels"]["shown"] == ["displays", "views"]
        assert client.first["panels"]["opened"] == client.first["configuration"]["opened"] == 1
        await client.send("show_panels", shown=["displays", "views"])
        await client.send("show_panels", shown=["displays", "time"])
        assert (await client.until("configuration"))["unsaved"]
        assert world.viewer.config.panels.shown == ["displays", "time"]
        await client.send("save_configuration", path=None, replace=False)
        await client.until("configuration_saved")
        assert RvizConfig.load(path).panels.shown == ["displays", "time"]
        await client.send("new_configuration", discard=False)
        message = await client.until("panels")
        assert message["opened"] == 2
        assert message["shown"] == ["displays", "selection", "tool-properties", "views", "time"]


async def test_panel_changes_do_not_affect_other_pages(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(RVIZ_PANELS + DISPLAYS, path) as (world, client), open_page(world.viewer) as other:
        await other.opened()
        await client.send("show_panels", shown=[])
        await other.until("configuration", unsaved=True)
        assert "panels" not in [message["type"] for message in await other.drain() if isinstance(message, dict)]
        async with open_page(world.viewer) as late_client:
            assert (await late_client.opened())["panels"]["shown"] == []


async def test_panel_changes_without_file_are_not_unsaved_edits(tmp_path):
    async with open_configured(RVIZ_PANELS + DISPLAYS) as (world, client):
        await client.send("show_panels", shown=["time"])
        await client.drain(0.03)
        assert not world.viewer.manager.history.has_unsaved_edits
        await client.send("save_configuration", path=str(tmp_path / "a.rviz"), replace=False)
        await client.until("configuration_saved")
    assert RvizConfig.load(tmp_path / "a.rviz").panels.shown == ["time"]
