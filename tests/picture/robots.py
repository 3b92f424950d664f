"""Robots for tests of images, and the pixels of images."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.descriptions import load
from linkwright.packages import PackageFinder
from linkwright.picture.camera import VIEWS
from linkwright.picture.rendering import Image, Style, render
from linkwright.picture.robots import robot_scene
from linkwright.picture.scene import Scene

RED, GREEN, BLUE = "0.9 0.1 0.1 1", "0.1 0.8 0.1 1", "0.1 0.1 0.9 1"


def link(name: str, shape: str, color: str, origin: str = "0 0 0", rpy: str = "0 0 0") -> str:
    """Return a link with one visual."""
    return (
        f'<link name="{name}"><visual><origin xyz="{origin}" rpy="{rpy}"/><geometry>{shape}</geometry>'
        f'<material name="of {name}"><color rgba="{color}"/></material></visual></link>'
    )


def joint(name: str, parent: str, child: str, kind: str = "fixed", xyz: str = "0 0 0", content: str = "") -> str:
    """Return a joint."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/>{content}</joint>'
    )


def urdf(*parts: str) -> str:
    """Return a robot."""
    return f'<robot name="r">{"".join(parts)}</robot>'


def make_scene(text: str, positions: Mapping[str, float] | None = None, **options: Any) -> Scene:
    """Return the scene of a robot."""
    finder = PackageFinder(start=[Path.cwd()])
    return robot_scene(load(text, packages=finder), finder, positions, **options)


def render_image(text: str, view: str = "front", size: tuple[int, int] = (120, 90), **style: Any) -> Image:
    """Return the image of a robot."""
    return render(make_scene(text), VIEWS[view], size, Style(**style))


def strongest_channel(pixel: np.ndarray) -> str:
    """Return the channel that is by far the strongest, or ``gray`` if there is none."""
    red, green, blue = (int(value) for value in pixel[:3])
    for name, value, other_channels in (
        ("red", red, (green, blue)),
        ("green", green, (red, blue)),
        ("blue", blue, (red, green)),
    ):
        if value > 60 + max(other_channels):
            return name
    return "grey"
