"""The open panels.

A browser opens the panels of the file on its first visit, and then the user's.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.rviz import RvizConfig
from tests.browser.conftest import wait_until_equal
from tests.browser.live import configuration
from tests.panels.panels import RVIZ_PANELS, open_panels, window_state

pytestmark = pytest.mark.browser

GRID = "- Class: rviz_default_plugins/Grid\n  Enabled: true\n  Name: Grid\n  Value: true"
LINKWRIGHT_PANELS = {"Links", "Diagnostics"}
DEFAULT_PANELS = ("Displays", "Views", "Tool Properties", "Selection", "Time")


@pytest.fixture(autouse=True)
def _user_state(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


def wait_for_panels(page, *names: str) -> None:
    """Wait until exactly these panels are open.

    The scene and the panels that RViz does not have are always open.
    """
    expected = sorted({*names, *LINKWRIGHT_PANELS})
    page.wait_for_function(
        """wanted => {
          const tabs = [...document.querySelectorAll('.panel-tab')].map(tab => tab.textContent.split(' (')[0].trim());
          const others = tabs.filter(name => name !== '3D View');
          return JSON.stringify([...new Set(others)].sort()) === JSON.stringify(wanted);
        }""",
        arg=expected,
    )


def close_panel(page, name: str) -> None:
    tab = page.locator(".panel-tab", has_text=name)
    tab.locator(".tab-title").click()
    tab.locator(".tab-close").click()


def choose_menu_entry(page, name: str) -> None:
    page.get_by_role("button", name="Panels", exact=True).click()
    page.get_by_role("menuitemcheckbox", name=name, exact=True).click()


def open_file(page, path: Path) -> None:
    page.keyboard.press("Control+o")
    page.get_by_label("File name").fill(str(path))
    page.keyboard.press("Enter")
    page.wait_for_function(f"() => document.querySelector('.file-name').textContent === {path.name!r}")


def column_width(page, name: str) -> float:
    group = page.locator(".dv-groupview", has=page.locator(".panel-tab", has_text=name))
    return group.bounding_box()["width"]


def is_unsaved(page) -> bool:
    return page.locator(".file-name .unsaved").count() == 1


def test_rviz_file_opens_panels_that_rviz_shows(start_viewer, open_page, tmp_path: Path):
    path, other_path = tmp_path / "robot.rviz", tmp_path / "other.rviz"
    path.write_text(RVIZ_PANELS + configuration(GRID) + window_state(Selection=False, **{"Tool Properties": False}))
    other_path.write_text("Panels:\n  - {Class: rviz_common/Time, Name: Time}\n" + configuration(GRID))
    viewer = start_viewer(configuration(GRID))
    page = open_page(viewer, wait=False)
    wait_for_panels(page, *DEFAULT_PANELS)  # the file does not list panels
    open_file(page, path)
    wait_for_panels(page, "Displays", "Views")
    open_file(page, other_path)
    wait_for_panels(page, "Time")
    open_file(page, path)
    wait_for_panels(page, "Displays", "Views")
    # The scene takes the remaining width.
    columns = ("Displays", "Views", "Diagnostics")
    wait_until_equal(lambda: [column_width(page, column) for column in columns], pytest.approx([320, 290, 290], abs=3))
    assert not is_unsaved(page)
    page.keyboard.press("Control+s")
    assert viewer.run(viewer.viewer.config.text) == path.read_text()


def test_opened_and_closed_panels_are_remembered_and_saved(start_viewer, open_page, tmp_path: Path):
    path = tmp_path / "robot.rviz"
    path.write_text(RVIZ_PANELS + configuration(GRID) + window_state(Selection=False, **{"Tool Properties": False}))
    viewer = start_viewer(configuration(GRID))
    page = open_page(viewer, wait=False)
    wait_for_panels(page, *DEFAULT_PANELS)
    open_file(page, path)
    wait_for_panels(page, "Displays", "Views")
    neighbor = open_page(viewer, wait=False)
    wait_for_panels(neighbor, "Displays", "Views")
    close_panel(page, "Views")
    choose_menu_entry(page, "Selection")
    wait_for_panels(page, "Displays", "Selection")
    page.locator(".file-name .unsaved").wait_for()
    choose_menu_entry(page, "Plots")  # RViz does not have this panel
    page.reload()
    page.locator(".panel-tab", has_text="Plots").wait_for()
    close_panel(page, "Plots")
    wait_for_panels(page, "Displays", "Selection")
    # Panels of other pages stay, and a new browser starts with the file's panels.
    wait_for_panels(neighbor, "Displays", "Views")
    wait_for_panels(open_page(viewer, wait=False), "Displays", "Selection")
    page.keyboard.press("Control+s")
    page.locator(".file-name .unsaved").wait_for(state="detached")
    assert open_panels(RvizConfig.load(path)) == ["displays", "selection"]
    page.get_by_role("button", name="Panels", exact=True).click()
    page.get_by_role("menuitem", name="Reset layout").click()
    wait_for_panels(page, "Displays", "Selection")


BROKEN = (
    '<robot name="r"><link name="a"><visual><geometry><mesh filename="file:///is/not/there.stl"/></geometry></visual>'
    "</link></robot>"
)


def test_reopened_diagnostics_tab_shows_count(start, open_page, tmp_path: Path):
    (tmp_path / "broken.urdf").write_text(BROKEN)
    page = open_page(start("view", str(tmp_path / "broken.urdf")), wait=False)
    page.get_by_role("tab", name="Diagnostics (").wait_for()
    text = page.locator(".panel-tab", has_text="Diagnostics").inner_text()
    close_panel(page, "Diagnostics")
    page.get_by_role("tab", name="Diagnostics").wait_for(state="detached")
    choose_menu_entry(page, "Diagnostics")
    page.get_by_role("tab", name=text.strip(), exact=True).wait_for()


def test_close_button_of_tab_is_beside_its_title(start_viewer, open_page):
    page = open_page(start_viewer(configuration(GRID)), wait=False)
    tab = page.locator(".panel-tab", has_text="Tool Properties")
    tab.locator(".tab-title").click()
    cross, name = tab.locator(".tab-close").bounding_box(), tab.locator(".tab-title").bounding_box()
    assert cross["x"] + cross["width"] <= name["x"]
