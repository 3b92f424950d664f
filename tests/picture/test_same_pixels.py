"""The same pixels on every machine.

The tests compare digests of images, also in processes that disable features of the processor.

After an intended change of the pixels, copy the digests that the failing tests print.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from linkwright.picture.bodies import Axes
from linkwright.picture.camera import VIEWS
from linkwright.picture.rendering import Style, render
from linkwright.picture.robots import GHOST_COLOR, OUTLINE_COLOR
from linkwright.picture.scene import Scene
from tests.picture.robots import BLUE, GREEN, RED, joint, link, make_scene, urdf
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
    "arm iso": "82e2e64309f770b6854b721a813c99b4e446d9246ad875a9abea48697190401c",
    "arm front": "be709f879b9513486e11503349c0331fdba560ca1c2a97e62176dcf2297116c8",
    "arm from below": "77eaefe4f90a3559e702c93abedb09e1b7db27026dc01ec69f3b695bb4f80c87",
    "arm compared": "e577409808bc4cf360406b131cc67446639a08a31bc8aca8a98a591d90b6982a",
    "arm parts": "66de04a84011596333bdf455ddcd4812cd51cde72aafda53197feae7488ddbad",
    "mbot iso": "56e2b901f5958d37f39426e94db76f428922486f8c4ae0270aa6e067876fd1d2",
    "mbot top": "6ac9d75571f905ee9e058b4b29a7f9d550d803bd4b42806617eb9568421c20d4",
}


def compute_digests() -> dict[str, str]:
    """Return the digests of the pixels of all images."""
    from linkwright.descriptions import load
    from linkwright.packages import PackageFinder
    from linkwright.picture.camera import View
    from linkwright.picture.robots import robot_scene

    size = (200, 150)
    arm = make_scene(ARM, {"turn": 0.7})
    finder = PackageFinder(start=[MBOT.parent])
    mbot = robot_scene(load(MBOT, packages=finder), finder, {})
    old = make_scene(ARM, {"turn": -0.4, "bend": 1.9}, ghost=GHOST_COLOR)
    new = make_scene(ARM, {"turn": 0.7}, outlined={"fore": OUTLINE_COLOR})
    parts = make_scene(ARM, {"turn": 0.7}, outlined=dict.fromkeys(("upper", "fore"), OUTLINE_COLOR))
    axes = [Axes(body.frame, 0.3) for body in parts.bodies if body.name == "tip"]
    images = {
        "arm iso": render(arm, VIEWS["iso"], size, Style(transparent=True, labels="links")),
        "arm front": render(arm, VIEWS["front"], size, Style(labels="joints")),
        "arm from below": render(arm, View(-133.3, -21.7), size),
        "arm compared": render(new + old, View(201.5, 33.0), size, Style(grid=True)),
        "arm parts": render(
            Scene(parts.bodies, labels=parts.labels, axes=axes), VIEWS["iso"], size, Style(labels="links")
        ),
        "mbot iso": render(mbot, VIEWS["iso"], size, Style(grid=True)),
        "mbot top": render(mbot, VIEWS["top"], size),
    }
    return {name: hashlib.sha256(np.ascontiguousarray(pixels)).hexdigest() for name, pixels in images.items()}


def test_pixels_match_recorded_digests() -> None:
    assert compute_digests() == DIGESTS


def find_switchable_features() -> list[str]:
    """Return the features of this processor that numpy can disable."""
    from numpy._core import _multiarray_umath as core  # type: ignore[attr-defined]

    return [name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name)]


@pytest.mark.parametrize("count", [1, 2, 99], ids=["without one", "without two", "without all"])
def test_pixels_do_not_depend_on_processor_features(count: int) -> None:
    names = find_switchable_features()[-count:]
    paths = [str(REPOSITORY), *filter(None, [os.environ.get("PYTHONPATH")])]
    program = "import json; from tests.picture import test_same_pixels as t; print(json.dumps(t.compute_digests()))"
    environment = {**os.environ, "NPY_DISABLE_CPU_FEATURES": " ".join(names), "PYTHONPATH": os.pathsep.join(paths)}
    environment["OPENBLAS_CORETYPE"] = "Prescott"
    printed = subprocess.run(
        [sys.executable, "-c", program], env=environment, cwd=Path.cwd(), check=True, capture_output=True, text=True
    ).stdout
    assert json.loads(printed) == DIGESTS


def test_repeated_rendering_gives_same_pixels() -> None:
    first, second = (render(make_scene(ARM), VIEWS["iso"], (120, 90)) for _ in range(2))
    assert (first == second).all()
