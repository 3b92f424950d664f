"""The displays of Autoware, drawn in a real browser."""

from __future__ import annotations

import pytest

from tests.browser.conftest import state, until
from tests.browser.live import configuration
from tests.rviz.displays import autoware_messages as street

pytestmark = pytest.mark.browser

TOPICS = {
    "rviz_plugins/Trajectory": ("/trajectory", street.make_trajectory),
    "rviz_plugins/Path": ("/path", street.make_path),
    "tier4_planning_factor_rviz_plugin/PlanningFactorRvizPlugin": ("/factors", street.make_factors),
    "autoware_perception_rviz_plugin/DetectedObjects": ("/detected", street.make_detected),
    "autoware_perception_rviz_plugin/TrackedObjects": ("/tracked", street.make_tracked),
    "autoware_perception_rviz_plugin/PredictedObjects": ("/predicted", street.make_predicted),
}


def test_street_of_a_car_is_drawn(start_viewer, open_page, tmp_path):
    displays = [
        f"- {{Class: {cls}, Enabled: true, Name: {topic[1:]}, Topic: {{Value: {topic}}}, Show Safety Factors: true}}"
        for cls, (topic, _) in TOPICS.items()
    ]
    displays.append(
        "- {Class: rviz_plugins/PolarGridDisplay, Enabled: true, Name: polar, Max Range: 20, Wave Velocity: 0}"
    )
    viewer = start_viewer(configuration("\n".join(displays), distance=32, pitch=0.8, yaw=-2.2))
    page = open_page(viewer, wait=False)
    viewer.place("tip", 1.0, 0.0, 0.0)
    for topic, make in TOPICS.values():
        viewer.publish(topic, make())
    has_markers = "(display) => Object.keys(display.drawn?.markers ?? {}).length > 0"
    until(page, f"lw.displays.length === {len(displays)} && lw.displays.every({has_markers})")
    viewer.settle(page)
    page.screenshot(path=tmp_path / "street.png")
    assert len(state(page, "displays[3].drawn.markers")) == 12, "a shape, a label, a velocity and an ellipse for each"
