"""The interfaces that come with Linkwright: those of ROS 2 Humble, as one text file for each package in ``data/``.

A file has the interface files of its package one after the other, each after a line such as ``=== msg/JointState``.
Comments are our own; types that few programs use have none. It is read when the first of its interfaces is asked for.
A head with ``jazzy`` after the name begins the form that later distributions have, which ``ROS_DISTRO`` asks for.
"""

from __future__ import annotations

import os
from functools import cache

from linkwright.messages.distribution import is_before_iron

_FOLDER = os.path.join(os.path.dirname(__file__), "data")  # noqa: PTH118, PTH120 - pathlib takes long to import
_HEAD = "=== "
_LATER = " jazzy"


@cache
def packages() -> tuple[str, ...]:
    """The names of the packages, sorted."""
    return tuple(sorted(name[:-4] for name in os.listdir(_FOLDER) if name.endswith(".txt")))  # noqa: PTH208 - as above


def texts(package: str) -> dict[str, str]:
    """The interfaces of a package: kind and name, such as ``msg/JointState``, -> text; empty for an unknown package."""
    return _texts(package, not is_before_iron())


@cache
def _texts(package: str, later: bool) -> dict[str, str]:
    if package not in packages():
        return {}
    with open(os.path.join(_FOLDER, package + ".txt"), encoding="utf-8") as file:  # noqa: PTH118, PTH123 - as above
        text = file.read()
    found: dict[str, str] = {}
    for part in text.removeprefix(_HEAD).split("\n" + _HEAD):
        head, _, body = part.partition("\n")
        name = head.removesuffix(_LATER)
        if later or name == head:
            found[name] = body if body.endswith("\n") or not body else body + "\n"
    return found
