from __future__ import annotations

import math

import pytest
import yaml

from linkwright.viewer import RvizConfig
from linkwright.viewer.orbit import FIELD_OF_VIEW, PITCH_LIMIT


def view_of(text: str):
    config = RvizConfig.parse(yaml.safe_dump({"Visualization Manager": {"Views": {"Current": yaml.safe_load(text)}}}))
    return config.view, [warning.code for warning in config.warnings]


def eye(view):
    offset = (
        math.cos(view.yaw) * math.cos(view.pitch),
        math.sin(view.yaw) * math.cos(view.pitch),
        math.sin(view.pitch),
    )
    return [at + view.distance * step for at, step in zip(view.focal_point, offset, strict=True)]


def test_an_orbit_is_read_with_the_defaults_of_rviz():
    view, warnings = view_of("{Class: rviz_default_plugins/Orbit, Distance: 1.7, Pitch: 0.33, Yaw: 5.5}")
    assert (view.distance, view.pitch, view.yaw) == (1.7, 0.33, 5.5)
    assert (view.near_clip_distance, view.focal_shape_size, view.target_frame) == (0.01, 0.05, "<Fixed Frame>")
    assert view.focal_point == [0.0, 0.0, 0.0]
    assert warnings == []


def test_angles_are_brought_into_range():
    view, _ = view_of("{Class: rviz/Orbit, Pitch: 3, Yaw: -0.5, Near Clip Distance: 0}")
    assert view.pitch == PITCH_LIMIT
    assert view.yaw == pytest.approx(math.tau - 0.5)
    assert view.near_clip_distance == 0.001


def test_a_file_without_a_view_has_rviz_own():
    assert RvizConfig.parse("Visualization Manager: {}").view.yaw == 0.785398


def test_fps_keeps_eye_and_direction():
    view, warnings = view_of("{Class: rviz_default_plugins/FPS, Position: {X: 1, Y: 2, Z: 3}, Yaw: 0.4, Pitch: 0.6}")
    assert warnings == ["RVIZ203"]
    assert eye(view) == pytest.approx([1, 2, 3])
    assert view.focal_point[2] == pytest.approx(0.0)  # it turns about the ground that it looks at
    forward = [at - start for at, start in zip(view.focal_point, eye(view), strict=True)]
    assert math.atan2(forward[1], forward[0]) == pytest.approx(0.4)


def test_fps_that_looks_up_turns_about_a_point_before_it():
    view, _ = view_of("{Class: rviz_default_plugins/FPS, Position: {X: 0, Y: 0, Z: 1}, Pitch: -0.5}")
    assert view.distance == 10.0
    assert eye(view) == pytest.approx([0, 0, 1])


def test_top_down_shows_as_much_from_above():
    view, warnings = view_of("{Class: rviz_default_plugins/TopDownOrtho, Scale: 70, X: 1, Y: 2, Angle: 0}")
    assert warnings == ["RVIZ203"]
    assert view.pitch == PITCH_LIMIT
    assert view.focal_point == [1.0, 2.0, 0.0]
    assert 2 * view.distance * math.tan(FIELD_OF_VIEW / 2) == pytest.approx(10.0)
    up = (-math.cos(view.yaw), -math.sin(view.yaw))  # of the picture, seen from above
    assert up == pytest.approx((0.0, 1.0))


def test_a_view_is_written_only_where_it_differs():
    text = "Visualization Manager:\n  Views:\n    Current:\n      Class: rviz_default_plugins/Orbit\n      Yaw: -1\n"
    config = RvizConfig.parse(text)
    config.view = config.view
    assert config.text() == text
    view, _ = view_of("{Distance: 2, Focal Point: {X: 1}}")
    config.view = view
    again = RvizConfig.parse(config.text()).view
    assert again == view


def test_another_class_becomes_an_orbit_when_the_view_is_set():
    config = RvizConfig.parse("Visualization Manager: {Views: {Current: {Class: rviz_default_plugins/FPS}}}")
    view, _ = view_of("{Distance: 2}")
    config.view = view
    again = RvizConfig.parse(config.text())
    assert (again.view, again.warnings) == (view, [])


def test_a_view_that_is_none_is_refused():
    config = RvizConfig.default()
    view, _ = view_of("{}")
    view.focal_point = [1.0]
    with pytest.raises(ValueError):
        config.view = view
