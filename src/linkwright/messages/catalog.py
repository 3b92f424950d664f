"""The interfaces that come with Linkwright: the interfaces of ROS 2 Humble.

Each package has one text file in ``data/`` with its interface files, each after a heading such as
``=== msg/JointState``. The comments differ from ROS's, and rarely used types have none. A file is read when the
first of its interfaces is requested. If ``jazzy`` follows the name in a heading, the definition applies to later
distributions. It is used if ``ROS_DISTRO`` names one of them.
"""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING

from linkwright.messages.distribution import is_before_iron

if TYPE_CHECKING:
    from pathlib import Path

_FOLDER = os.path.join(os.path.dirname(__file__), "data")  # noqa: PTH118, PTH120 - pathlib takes long to import
_HEADING_PREFIX = "=== "
_LATER_SUFFIX = " jazzy"


@cache
def list_packages() -> tuple[str, ...]:
    """Return the sorted names of the packages that come with Linkwright."""
    return tuple(sorted(name[:-4] for name in os.listdir(_FOLDER) if name.endswith(".txt")))  # noqa: PTH208 - as above


def get_file(package: str) -> Path:
    """Return the file with the interfaces of a package that comes with Linkwright."""
    from pathlib import Path

    return Path(_FOLDER, package + ".txt")


def read_texts(package: str) -> dict[str, str]:
    """Return the texts of a package's interface files by name, such as ``msg/JointState``.

    The dictionary is empty for any package that does not come with Linkwright.
    """
    return _read_texts(package, not is_before_iron())


def read_all_texts(package: str) -> list[tuple[str, str]]:
    """Return the names and texts of a package's interface files of all distributions, in the order of the file."""
    return [(heading.removesuffix(_LATER_SUFFIX), text) for heading, text in _read_sections(package)]


@cache
def _read_texts(package: str, later: bool) -> dict[str, str]:
    return {
        heading.removesuffix(_LATER_SUFFIX): text
        for heading, text in (_read_sections(package) if package in list_packages() else ())
        if later or not heading.endswith(_LATER_SUFFIX)
    }


def _read_sections(package: str) -> list[tuple[str, str]]:
    with open(os.path.join(_FOLDER, package + ".txt"), encoding="utf-8") as file:  # noqa: PTH118, PTH123 - as above
        text = file.read()
    sections = (part.partition("\n") for part in text.removeprefix(_HEADING_PREFIX).split("\n" + _HEADING_PREFIX))
    return [(heading, body if body.endswith("\n") or not body else body + "\n") for heading, _, body in sections]
