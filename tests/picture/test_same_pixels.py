"""The same pixels on every machine: digests, with the processor's features switched off in other processes.

After an intended change of the pixels, the digests are those that the failing tests print.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from linkwright.picture.camera import VIEWS
from linkwright.picture.rendering import Style, render
from linkwright.picture.robots import GHOST_COLOR, OUTLINE_COLOR
from tests.picture.robots import BLUE, GREEN, RED, joint, link, scene, urdf
from tests.places import REPOSITORY

SLIDE = '<mimic joint="bend" multiplier="0.1"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
ARM = urdf(
    link("base", '<cylinder radius="0.3" length="0.2"/>', RED),
    link("upper", '<box size="0.1 0.12 0.8"/>', GREEN, "0 0 0.4", "0.1 0.2 0.3"),
    link("fore", '<capsule radius="0.06" length="0.5"/>', "0.2 0.3 0.8 0.6", "0 0 0.3"),
    link("tip", '<sphere radius="0.11"/>', BLUE, "0.02 0 0"),
    joint("turn", "base", "upper", "continuous", "0 0 0.1", '<axis xyz="0 0.6 0.8"/>'),
    joint(
        "bend",
        "upper",
        "fore",
        "revolute",
        "0.1 0 0.8",
        '<axis xyz="0 1 0"/><limit lower="0.4" upper="2" effort="1" velocity="1"/>',
    ),
    joint("slide", "fore", "tip", "prismatic", "0 0 0.6", SLIDE),
).replace('<robot name="r">', '<robot name="r" version="1.1">')
MBOT = REPOSITORY / "robots" / "my_robot_description" / "urdf" / "mbot_with_kinect.urdf"

DIGESTS = {
    "arm iso": "04e81c85046136f89636ffb0455fdfae0454b87f4e8da82cf23e0c868c267e8c",
    "arm front": "c47f881c3b264278585f5a49d8ebef404f3170bb6d152be226339baddfb43da6",
    "arm from below": "07cabd6056ca3c07e1c71ebfbcc5bb48c6071416d81d078b238408bb399e3aff",
    "arm compared": "c2a29b5aaa3fbfb82af5b66dcfcbf39c5edad0388ee741291e3ba62d56f1dec2",
    "mbot iso": "fb0efd362d5ab92a10465f96a4777453d33488c70ee65239f6a418fd04e8abf0",
    "mbot top": "0e253ccaabead2e03dab3c06d6ea153b34d232621a5421bcf29333982e6bb376",
}


def digests() -> dict[str, str]:
    """Return the digests of the pixels of all images."""
    from linkwright.descriptions import load
    from linkwright.packages import PackageFinder
    from linkwright.picture.camera import View
    from linkwright.picture.robots import robot_scene

    size = (200, 150)
    arm = scene(ARM, {"turn": 0.7})
    finder = PackageFinder(start=[MBOT.parent])
    mbot = robot_scene(load(MBOT, packages=finder), finder, {})
    old = scene(ARM, {"turn": -0.4, "bend": 1.9}, ghost=GHOST_COLOR)
    new = scene(ARM, {"turn": 0.7}, outlined={"fore": OUTLINE_COLOR})
    images = {
        "arm iso": render(arm, VIEWS["iso"], size, Style(transparent=True, labels="links")),
        "arm front": render(arm, VIEWS["front"], size, Style(labels="joints")),
        "arm from below": render(arm, View(-133.3, -21.7), size),
        "arm compared": render(new + old, View(201.5, 33.0), size, Style(grid=True)),
        "mbot iso": render(mbot, VIEWS["iso"], size, Style(grid=True)),
        "mbot top": render(mbot, VIEWS["top"], size),
    }
    return {name: hashlib.sha256(np.ascontiguousarray(pixels)).hexdigest() for name, pixels in images.items()}


def test_pixels_are_those_of_every_other_machine() -> None:
    assert digests() == DIGESTS


def switchable() -> list[str]:
    """Return the features of this processor that numpy can be told not to use."""
    from numpy._core import _multiarray_umath as core  # type: ignore[attr-defined]

    return [name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name)]


@pytest.mark.parametrize("count", [1, 2, 99], ids=["without one", "without two", "without all"])
def test_pixels_do_not_depend_on_the_processor(count: int) -> None:
    names = switchable()[-count:]
    if not names:
        pytest.skip("numpy uses no features of this processor beyond the least")
    program = "import json; from tests.picture.test_same_pixels import digests; print(json.dumps(digests()))"
    environment = {**os.environ, "NPY_DISABLE_CPU_FEATURES": " ".join(names), "PYTHONPATH": str(REPOSITORY)}
    environment["OPENBLAS_CORETYPE"] = "Prescott"
    printed = subprocess.run(
        [sys.executable, "-c", program], env=environment, cwd=Path.cwd(), check=True, capture_output=True, text=True
    ).stdout
    import json

    assert json.loads(printed) == DIGESTS


def test_the_same_scene_twice_gives_the_same_pixels() -> None:
    first, second = (render(scene(ARM), VIEWS["iso"], (120, 90)) for _ in range(2))
    assert (first == second).all()
