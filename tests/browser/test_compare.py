"""Two descriptions in one scene: the list, the selection, and the drawing of both robots."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page

from tests.browser.axe import find_violations
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.pixels import colors_at
from tests.browser.test_export import export_page, open_file  # noqa: F401 - a fixture

pytestmark = pytest.mark.browser

OLD = """\
<robot name="stand">
  <material name="green"><color rgba="0 0.6 0 1"/></material>
  <link name="base"><visual><geometry><box size="1 1 0.2"/></geometry><material name="green"/></visual></link>
  <link name="arm"><visual><geometry><box size="0.2 0.2 1"/></geometry><material name="green"/></visual></link>
  <link name="camera"><visual><geometry><sphere radius="0.15"/></geometry><material name="green"/></visual></link>
  <joint name="turn" type="continuous"><origin xyz="0 0 0.6"/><parent link="base"/><child link="arm"/>
    <axis xyz="1 0 0"/></joint>
  <joint name="mount" type="fixed"><origin xyz="0.4 0.4 0.2"/><parent link="base"/><child link="camera"/></joint>
</robot>
"""
NEW = """\
<robot name="stand">
  <material name="green"><color rgba="0 0.6 0 1"/></material>
  <link name="base"><visual><geometry><box size="1 1 0.2"/></geometry><material name="green"/></visual></link>
  <link name="arm"><visual><geometry><box size="0.2 0.2 1"/></geometry><material name="green"/></visual></link>
  <link name="lidar"><visual><geometry><sphere radius="0.15"/></geometry><material name="green"/></visual></link>
  <joint name="turn" type="continuous"><origin xyz="0 0.3 0.6"/><parent link="base"/><child link="arm"/>
    <axis xyz="1 0 0"/></joint>
  <joint name="mast" type="fixed"><origin xyz="-0.4 -0.4 0.2"/><parent link="base"/><child link="lidar"/></joint>
</robot>
"""
BLUE, YELLOW, RED, GRAY = "#56b4e9", "#f0c020", "#cc3377", "#c4ccd6"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """Return the old file and the new one."""
    folder = tmp_path / "models"
    folder.mkdir()
    old, new = folder / "old.urdf", folder / "new.urdf"
    old.write_text(OLD, encoding="utf-8")
    new.write_text(NEW, encoding="utf-8")
    return old, new


def link_appearance(page: Page, index: int) -> dict[str, tuple[str, float]]:
    """Return color and opacity of each link of the first or second robot."""
    robots = [display["drawn"] for display in state(page, "displays") if display["class"].endswith("RobotModel")]
    visuals = {name: text["visuals"] for name, text in robots[index]["links"].items()}
    return {
        name: (shapes[0]["materials"][0]["color"], round(shapes[0]["materials"][0]["opacity"], 2))
        for name, shapes in visuals.items()
        if shapes
    }


def drawn_bounds(page: Page, index: int, link: str) -> Any:
    robots = [display["drawn"] for display in state(page, "displays") if display["class"].endswith("RobotModel")]
    box = robots[index]["links"][link]["visuals"][0]["bounds"]
    return [(low + high) / 2 for low, high in zip(box["min"], box["max"], strict=True)]


def locate_group(page: Page, name: str, kind: str = "Link"):
    return page.locator(".difference-group", has=page.get_by_title(f"Select {name} and", exact=False)).filter(
        has_text=kind
    )


def test_both_robots_are_drawn_with_difference_colors(start, open_page, files):
    page = open_page(start("view", *map(str, files)))
    page.get_by_text("5 differences").wait_for()
    green = "#009900"
    wait_until_equal(lambda: link_appearance(page, 0), {"base": (green, 1), "arm": (YELLOW, 1), "lidar": (BLUE, 1)})
    wait_until_equal(lambda: link_appearance(page, 1), {"arm": (GRAY, 0.4), "camera": (RED, 0.63)})
    assert page.locator(".comparison-legend li").all_inner_texts() == ["added", "changed", "removed", "old"]
    page.get_by_label("Color the differences").uncheck()
    wait_until_equal(lambda: set(link_appearance(page, 0).values()), {(green, 1)})
    wait_until_equal(lambda: set(link_appearance(page, 1).values()), {(GRAY, 0.4)})


def sample_pixels(page: Page) -> list[tuple[int, int, int]]:
    """Return colors of the scene on a grid of pixels."""
    until(page, "lw.settled")
    box = page.locator(".canvas-box canvas").first.bounding_box()
    assert box is not None
    points = [
        (box["x"] + box["width"] * i / 60, box["y"] + box["height"] * j / 60)
        for i in range(1, 60)
        for j in range(9, 57)
    ]
    return colors_at(page, *points)


def toggle_robot(page: Page, title: str, *, is_shown: bool) -> None:
    """Toggle a robot."""
    box = page.get_by_title(title, exact=False).get_by_role("checkbox")
    count = "lw.displays.filter((display) => display.class.endsWith('RobotModel') && display.enabled).length"
    count_before = page.evaluate(f"() => {{ const lw = window.linkwright; return {count}; }}")
    box.set_checked(is_shown)
    until(page, f"{count} === {count_before + (1 if is_shown else -1)}")


def test_identical_old_robot_is_hidden(start, open_page, files):
    old, new = files
    old.write_text(NEW, encoding="utf-8")
    page = open_page(start("view", str(old), str(new)))
    page.get_by_text("are identical").wait_for()
    both_robots = sample_pixels(page)
    assert sum(g > 60 and g > 2 * max(r, b) for r, g, b in both_robots) > 100, "the robot is visible"
    toggle_robot(page, "Show the old robot", is_shown=False)
    new_only = sample_pixels(page)
    assert [
        (pixel, pixel_alone) for pixel, pixel_alone in zip(both_robots, new_only, strict=True) if pixel != pixel_alone
    ] == []


def test_robots_can_be_shown_alone_and_old_opacity_is_adjustable(start, open_page, files):
    page = open_page(start("view", *map(str, files)))
    page.get_by_text("5 differences").wait_for()
    both_robots = sample_pixels(page)
    toggle_robot(page, "Show the new robot", is_shown=False)
    old_only = sample_pixels(page)
    assert sum(g > 60 and g > 2 * max(r, b) for r, g, b in old_only) == 0
    assert old_only != both_robots
    page.get_by_label("Opacity of the old robot").fill("1")
    wait_until_equal(lambda: {alpha for _, alpha in link_appearance(page, 1).values()}, {1})
    opaque = sample_pixels(page)
    assert sum(sum(pixel) for pixel in opaque) < sum(sum(pixel) for pixel in old_only), (
        "the gray of the old robot is darker than the ground behind it"
    )
    toggle_robot(page, "Show the new robot", is_shown=True)
    toggle_robot(page, "Show the old robot", is_shown=False)
    wait_until_equal(lambda: sum(b > 1.5 * r and b > 60 for r, g, b in sample_pixels(page)) > 0, True)


def test_difference_selects_link_and_opens_both_sources(start, open_page, files):
    page = open_page(start("view", *map(str, files)))
    locate_group(page, "lidar").locator("button.difference-name").click()
    page.locator(".selection-card strong", has_text="lidar").wait_for()
    distance = state(page, "view.distance")
    page.keyboard.press("Escape")
    locate_group(page, "camera").locator("button.difference-name").click()
    page.locator(".selection-card strong", has_text="camera").wait_for()
    assert state(page, "view.distance") == pytest.approx(distance, rel=0.05), "both spheres have the same size"
    locate_group(page, "turn", "Joint").locator(".difference-values").click()
    page.locator(".selection-card strong", has_text="arm").wait_for()
    assert "0 0 0.6" in locate_group(page, "turn", "Joint").inner_text()
    for side, number in (("old.urdf:6", 6), ("new.urdf:6", 6)):
        locate_group(page, "turn", "Joint").get_by_role("button", name=side, exact=False).click()
        until(page, "lw.panels.source.expanded.lines > 0")
        wait_until_equal(lambda name=side[:8]: state(page, "panels.source.origin.file").endswith(name), True)
        wait_until_equal(lambda: [mark["from"] for mark in state(page, "panels.source.origin.marks")][-1:], [number])


def test_joint_sliders_move_both_robots_and_edits_are_followed(start, open_page, files):
    old, new = files
    page = open_page(start("view", *map(str, files)))
    page.get_by_text("5 differences").wait_for()
    page.locator('[data-joint="turn"] input[type=range]').fill("1.5707963")
    wait_until_equal(lambda: [round(bound, 2) for bound in drawn_bounds(page, 0, "arm")], [0, 0.3, 0.6])
    until(page, "Math.abs(lw.frames['old/arm'].orientation[0] - Math.SQRT1_2) < 1e-3")
    new.write_text(NEW.replace('xyz="0 0.3 0.6"', 'xyz="0 0 0.6"'), encoding="utf-8")
    page.get_by_text("4 differences").wait_for()
    old.write_text(OLD.replace('size="1 1 0.2"', 'size="1 1 0.3"'), encoding="utf-8")
    page.get_by_text("5 differences").wait_for()
    locate_group(page, "base").get_by_text("1 1 0.3").wait_for()
    old.write_text(OLD.replace("</robot>", ""), encoding="utf-8")
    page.get_by_text("old.urdf:", exact=False).first.wait_for()
    old.write_text(NEW, encoding="utf-8")
    page.get_by_text("1 difference", exact=True).wait_for()


def test_git_commit_is_compared_as_old_version(start, open_page, files):
    _, new = files
    folder = new.parent
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org"]
    new.write_text(OLD, encoding="utf-8")
    for arguments in (["init", "-q"], ["add", "new.urdf"], [*identity, "commit", "-qm", "one"]):
        subprocess.run(["git", *arguments], cwd=folder, check=True)
    new.write_text(NEW, encoding="utf-8")
    page = open_page(start("view", str(new), "--against", "HEAD"))
    page.get_by_text("5 differences").wait_for()
    wait_until_equal(lambda: link_appearance(page, 1).get("camera"), (RED, 0.63))
    locate_group(page, "camera").get_by_role("button", name="HEAD:new.urdf:5", exact=False).click()
    wait_until_equal(lambda: state(page, "panels.source.origin.file").endswith("files/new.urdf"), True)
    page.locator(".source-panel").get_by_text('"camera"').first.wait_for()
    assert page.locator(".source-file").evaluate("(e) => e.selectedOptions[0].textContent") == "HEAD:new.urdf"


def test_comparison_list_is_in_front_in_small_window(start, open_page, files):
    page = open_page(start("view", *map(str, files)))
    page.get_by_text("5 differences").wait_for()
    page.set_viewport_size({"width": 800, "height": 600})
    page.locator(".comparison-count:visible").wait_for()
    assert page.get_by_role("tab", name="Compare").get_attribute("aria-selected") == "true"
    panel, first = page.locator(".comparison").bounding_box(), page.locator(".difference-group").first.bounding_box()
    assert panel is not None
    assert first is not None
    assert first["y"] + first["height"] <= panel["y"] + panel["height"]
    groups = [group.bounding_box() for group in page.locator(".difference-group").all()]
    assert max(group["x"] + group["width"] for group in groups) > 700, "the groups are arranged in columns"


def test_comparison_panel_passes_axe(start, open_page, files):
    page = open_page(start("view", *map(str, files)))
    locate_group(page, "camera").locator("button.difference-name").click()
    page.locator(".difference-group.selected").wait_for()
    assert find_violations(page, ".comparison") == []


def test_exported_review_shows_both_robots_list_and_joint_sliders(open_file, files, tmp_path):  # noqa: F811 - the fixture
    old, new = files
    exported_file = tmp_path / "review.html"
    export_page(exported_file, old, str(new))
    assert str(tmp_path) not in exported_file.read_text(encoding="utf-8")
    page = open_file(exported_file)
    assert page.locator(".comparison-count").inner_text() == "5 differences"
    wait_until_equal(lambda: link_appearance(page, 1), {"arm": (GRAY, 0.4), "camera": (RED, 0.63)})
    assert link_appearance(page, 0)["lidar"] == (BLUE, 1)
    assert "old.urdf:6" in locate_group(page, "turn", "Joint").inner_text()
    assert locate_group(page, "turn", "Joint").get_by_role("button", name="old.urdf", exact=False).count() == 0
    locate_group(page, "camera").locator("button.difference-name").click()
    page.locator(".selection-card strong", has_text="camera").wait_for()
    page.locator('[data-joint="turn"] input[type=range]').fill("1.5707963")
    wait_until_equal(lambda: round(state(page, "frames")["arm"]["orientation"][0], 3), 0.707)
    assert round(state(page, "frames")["old/arm"]["orientation"][0], 3) == 0.707
    page.get_by_title("Show the new robot", exact=False).get_by_role("checkbox").uncheck()
    wait_until_equal(lambda: sorted(link_appearance(page, 1)), ["arm", "base", "camera"])
