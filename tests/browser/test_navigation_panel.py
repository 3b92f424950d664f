"""nav2's panel in a real browser."""

from __future__ import annotations

import pytest

from tests.browser.axe import find_violations
from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.navigation.page.test_navigation_panel import Nav2
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

PANELS = """\
Panels:
  - {Class: rviz_common/Displays, Name: Displays}
  - {Class: nav2_rviz_plugins/Navigation 2, Name: Navigation 2}
"""
VALUES = "[...document.querySelectorAll('.navigation-value')].map((element) => element.textContent)"


def test_configuration_opens_navigation_panel_and_its_buttons_work(start_viewer, open_page, tmp_path):
    viewer = start_viewer(PANELS + configuration("- {Class: rviz_default_plugins/Grid, Enabled: true, Name: Grid}"))
    nav2 = viewer.run(lambda: Nav2(viewer.node.graph))
    page = open_page(viewer, wait=False)
    until(page, f"{VALUES}[0] === 'active' && {VALUES}[1] === 'active'")
    assert page.get_by_role("button", name="Resume", exact=True).is_disabled()
    viewer.run(lambda: (nav2.publish_goal_states(2), nav2.publish_progress(3.456)))
    until(page, f"String({VALUES}) === 'active,active,active,1 min 15 s,3.46 m,12.5 s,2'")
    page.screenshot(path=tmp_path / "navigation.png")
    assert find_violations(page, ".navigation") == []
    page.get_by_role("button", name="Cancel", exact=True).click()
    wait_until(lambda: nav2.cancel_count == 1)
    panel = page.locator(".navigation")
    panel.get_by_role("button", name="Pause", exact=True).click()
    until(page, f"{VALUES}[0] === 'inactive'")
    panel.get_by_role("button", name="Resume", exact=True).click()
    until(page, f"{VALUES}[1] === 'active'")
    viewer.run(
        lambda: (nav2.log.error("Goal failed: the goal (1.00, 2.00) is in an obstacle"), nav2.publish_goal_states(6))
    )
    until(page, f"{VALUES}[2] === 'aborted'")
    notice = page.get_by_role("alert").filter(has_text="The goal was aborted")
    notice.filter(has_text="is in an obstacle").wait_for()
    page.screenshot(path=tmp_path / "failed.png")
    assert find_violations(page, "[data-notice=goal]") == []
    notice.get_by_role("button").click()
    notice.wait_for(state="hidden")
