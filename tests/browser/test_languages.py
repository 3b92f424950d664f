"""A change of the page's language during use."""

from __future__ import annotations

import pytest

from tests.browser.conftest import state, until, wait_until_equal
from tests.places import PACKAGE

pytestmark = pytest.mark.browser

MBOT = PACKAGE / "urdf" / "mbot_with_kinect.urdf"

_SHOWN = """({
  view: lw.view.values,
  selection: lw.selection,
  focus: lw.description.focus,
  tool: lw.tool.class,
  joints: lw.joints,
  rows: [...document.querySelectorAll('.displays-panel .row')].map((row) => row.dataset.key),
  visuals: lw.robot.visuals,
  search: document.querySelector('.displays-panel input[type=search]').value,
  panels: document.querySelectorAll('.dv-tab').length,
})"""


def test_language_switch_keeps_view_state_and_reloads_no_mesh(start, open_page):
    page = open_page(start("view", str(MBOT)))
    page.mouse.move(640, 400)
    page.mouse.wheel(0, -360)
    page.locator(".dv-tab", has_text="Views").locator(".tab-close").click()
    page.locator('[data-joint="left_wheel_joint"] input[type=range]').fill("1.2")
    until(page, "lw.joints.left_wheel_joint > 1")
    page.get_by_role("button", name="Select").first.click()
    page.get_by_role("tab", name="Links").click()
    page.locator('.joint-of[data-joint="kinect_joint"]').click()
    page.get_by_role("tab", name="Displays").click()
    page.get_by_role("searchbox", name="Filter displays and properties").fill("link")
    until(page, "lw.selection.length === 1 && lw.description.focus?.kind === 'joint' && lw.settled")
    state_before = page.evaluate(f"() => {{ const lw = window.linkwright; return {_SHOWN}; }}")
    assert state_before["tool"] == "rviz_default_plugins/Select"

    page.get_by_role("button", name="中文").click()
    page.get_by_role("button", name="EN").wait_for()
    until(page, "lw.ready && lw.settled")
    wait_until_equal(lambda: page.evaluate(f"() => {{ const lw = window.linkwright; return {_SHOWN}; }}"), state_before)
    mesh_requests = page.evaluate(
        "() => performance.getEntriesByType('resource').filter(({ name }) => name.includes('/mesh/'))"
        ".map(({ transferSize, encodedBodySize }) => transferSize < encodedBodySize)"
    )
    assert mesh_requests == [True]
    # A reload, in contrast, clears the selection.
    page.reload()
    until(page, "lw.ready")
    assert state(page, "selection") == []
