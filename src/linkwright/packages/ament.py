"""Installed packages: the ament resource index and colcon's ``install`` folders.

An ament package at a prefix has the marker ``share/ament_index/resource_index/packages/NAME`` and its files in
``share/NAME``. colcon creates a workspace's ``install`` folder either as one prefix for all packages
(``--merge-install``) or with one prefix for each package. With ``--symlink-install``, the files in ``share`` are links
to the sources. As in ROS, the returned paths are those in ``share``, with links unresolved.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from linkwright.packages.manifest import MANIFEST

PREFIX_PATH_VARIABLE = "AMENT_PREFIX_PATH"
"""The environment variable that is set when ROS or a workspace is sourced."""

ROS_VARIABLES = {"ROS_DISTRO": "humble", "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}
"""The other variables that are set when ROS 2 is sourced, with the values of Humble."""

_PACKAGE_MARKERS = Path("share", "ament_index", "resource_index", "packages")
_COLCON_LAYOUT = ".colcon_install_layout"


def install_prefix(share: Path) -> Path:
    """Return the install prefix of a package, given its share folder.

    For a package that is not installed, the result is its source folder.
    """
    return share.parents[1] if is_installed(share) else share


def is_installed(share: Path) -> bool:
    """Return whether a share folder belongs to an installed package, rather than a source tree."""
    return share.parent.name == "share"


def list_environment_prefixes(environment: Mapping[str, str]) -> list[Path]:
    """Return the prefixes in ``AMENT_PREFIX_PATH``, in their order."""
    return [Path(entry) for entry in environment.get(PREFIX_PATH_VARIABLE, "").split(os.pathsep) if entry]


def is_share_of_prefix(folder: Path) -> bool:
    """Return whether a folder is the ``share`` folder of a prefix with an ament resource index."""
    return folder.name == "share" and (folder.parent / _PACKAGE_MARKERS).is_dir()


def find_share_in_prefix(prefix: Path, name: str) -> Path | None:
    """Return the share folder of a package in one prefix, or None if it is not installed there.

    A ``package.xml`` in the share folder suffices, because hand-written ``setup.py`` files often do not install the
    index marker.
    """
    share = prefix / "share" / name
    if (prefix / _PACKAGE_MARKERS / name).is_file() or (share / MANIFEST).is_file():
        return share
    return None


def iterate_packages_in_prefix(prefix: Path) -> Iterator[tuple[str, Path]]:
    """Yield the name and share folder of every package in one prefix, sorted by name."""
    names = set(_list_entries(prefix / _PACKAGE_MARKERS))
    share = prefix / "share"
    names.update(name for name in _list_entries(share) if (share / name / MANIFEST).is_file())
    for name in sorted(names):
        yield name, share / name


def is_colcon_install(folder: Path) -> bool:
    """Return whether a folder named ``install`` was created by colcon."""
    return (folder / _COLCON_LAYOUT).is_file() or (folder / "local_setup.sh").is_file()


def find_share_in_install(install: Path, name: str) -> Path | None:
    """Return the share folder of a package in a colcon install folder of either layout.

    The result is None if the folder does not contain the package.
    """
    return find_share_in_prefix(install / name, name) or find_share_in_prefix(install, name)


def iterate_packages_in_install(install: Path) -> Iterator[tuple[str, Path]]:
    """Yield the name and share folder of each package in a colcon install folder.

    Both layouts, isolated and merged, are supported.
    """
    yield from iterate_packages_in_prefix(install)
    for entry in _list_entries(install):
        share = find_share_in_prefix(install / entry, entry)
        if share is not None:
            yield entry, share


def _list_entries(folder: Path) -> list[str]:
    try:
        return sorted(os.listdir(folder))  # noqa: PTH208 - names only, and much faster than Path objects
    except OSError:
        return []
