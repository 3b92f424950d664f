"""Animations of a turn around a robot."""

from __future__ import annotations

import time

import numpy as np
import pytest

from linkwright.picture.camera import VIEWS
from linkwright.picture.rendering import Style, render
from linkwright.picture.turntable import iterate_turning_cameras, render_turntable
from tests.picture.robots import BLUE, RED, joint, link, make_scene, urdf

LONG = urdf(
    link("base", '<box size="2 0.3 0.3"/>', RED, "1 0 0"),
    link("end", '<box size="0.3 0.3 1"/>', BLUE, "2 0 0.5"),
    joint("j", "base", "end"),
)


def test_robot_stays_within_image_at_constant_scale() -> None:
    shown = make_scene(LONG)
    scales = set()
    for camera in iterate_turning_cameras(VIEWS["iso"], (160, 120), shown.points, 24):
        x, y, _ = camera.project(shown.points)
        assert x.min() > 0
        assert x.max() < 160
        assert y.min() > 0
        assert y.max() < 120
        scales.add((camera.distance, camera.scale))
    assert len(scales) == 1


def test_rotation_axis_stays_in_place() -> None:
    shown = make_scene(LONG)
    low, high = shown.points.min(axis=0), shown.points.max(axis=0)
    middle = (low + high)[None, :] / 2
    places = [
        [float(value[0]) for value in camera.project(middle)[:2]]
        for camera in iterate_turning_cameras(VIEWS["iso"], (160, 120), shown.points, 7)
    ]
    np.testing.assert_allclose(places, [places[0]] * 7, atol=1e-6)


def test_images_match_their_cameras_across_threads() -> None:
    shown = make_scene(LONG)
    finished: list[int] = []
    images = render_turntable(shown, VIEWS["iso"], (64, 48), Style(), 4, finished.append)
    assert finished == [1, 2, 3, 4]
    cameras = iterate_turning_cameras(VIEWS["iso"], (64, 48), shown.points, 4)
    for image, camera in zip(images, cameras, strict=True):
        assert (image == render(shown, VIEWS["iso"], (64, 48), Style(), camera)).all()
    assert not (images[0] == images[1]).all()


def test_interruption_does_not_wait_for_remaining_images(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[int] = []

    def slow(*_: object) -> np.ndarray:
        drawn.append(1)
        time.sleep(0.05)
        return np.zeros((1, 1, 4), np.uint8)

    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("linkwright.picture.turntable.render", slow)
    with pytest.raises(KeyboardInterrupt):
        render_turntable(make_scene(LONG), VIEWS["iso"], (64, 48), Style(), 200, interrupt)
    assert len(drawn) < 50
