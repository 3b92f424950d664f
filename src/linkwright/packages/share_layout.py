"""The share folders of unbuilt packages, and the substitutes for ROS packages.

In most packages, the installed files have the same paths as the sources, so the source folder serves as the share
folder. Some packages differ: ``install(DIRECTORY description/urdf DESTINATION share/${PROJECT_NAME})``, or
``glob('cfg/*')`` to ``config``. For these packages, a folder of links is created in the user's cache, with the
installed files at their installed paths and all other files from the sources. A program that uses the share folder,
such as a launch file with ``os.path.join``, then finds the files that would exist after a build. Files that require
compilation are replaced by Linkwright's files, if there are any.

Linkwright's substitutes replace ROS packages that launch files include, such as those of Gazebo and nav2. The
substitutes contain the launch files of these packages and the files that the launch files need, and they start
Linkwright's nodes. The substitutes are registered as entry points in the group ``linkwright.package_substitutes``. Each
entry point has the name of a package and refers to a module whose folder is a prefix that contains ``share/NAME``. A
package that is replaced only by modules, messages or nodes, such as rclpy, std_msgs and robot_state_publisher, has a
share folder that does not exist.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from linkwright.files.user_folders import PREFIXES_SUBFOLDER, SHARES_SUBFOLDER
from linkwright.loading.extensions import extensions
from linkwright.packages.ament import find_share_in_prefix, install_prefix
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.installed import InstalledFile

_GROUP = "linkwright.package_substitutes"
_PARTIAL_PREFIX = Path(__file__).parent / "substitutes"
"""The prefix of the packages that are replaced without files."""


def find_substituted_share(name: str) -> Path | None:
    """Return the share folder of the substitute for a ROS package, or None if there is none."""
    share = _find_share_with_files(name)
    if share is None and name in _find_partly_replaced_packages():
        return _PARTIAL_PREFIX / "share" / name
    return share


def iterate_substitutes() -> Iterator[tuple[str, Path]]:
    """Yield the name and share folder of every substitute that has files, sorted by name."""
    for name in sorted(extensions(_GROUP)):
        share = _find_share_with_files(name)
        if share is not None:
            yield name, share


def _find_share_with_files(name: str) -> Path | None:
    entry_point = extensions(_GROUP).get(name)
    if entry_point is None:
        return None
    try:
        prefix = Path(entry_point.load().__file__).parent
    except Exception as error:  # noqa: BLE001 - a broken package must not stop the search
        warnings.warn(f"'{entry_point.distribution}' provides no substitute for '{name}': {error}", stacklevel=2)
        return None
    return find_share_in_prefix(prefix, name)


@cache
def find_substituted_executables() -> dict[str, frozenset[str]]:
    """Return the partly replaced packages, each with the names of the replaced executables.

    Modules, messages or nodes of Linkwright replace these packages.
    """
    lines = Path(__file__).with_name("substituted_names.txt").read_text(encoding="utf-8").splitlines()
    return {package: frozenset(executables) for package, *executables in map(str.split, lines)}


@cache
def _find_partly_replaced_packages() -> frozenset[str]:
    """Return the packages that Linkwright or one of its extensions replaces in part."""
    nodes = (name for group in ("linkwright.nodes", "linkwright.components") for name in extensions(group))
    return frozenset({*find_substituted_executables(), *(name.partition("/")[0] for name in nodes)})


def is_substitute(share: Path) -> bool:
    """Return whether a share folder belongs to a substitute for a ROS package.

    A substitute contains the launch files that other packages include, but not the rest of the package.
    """
    return install_prefix(share) == _PARTIAL_PREFIX or share == _find_share_with_files(share.name)


def find_substituted_files(name: str, folder: Path) -> dict[str, InstalledFile]:
    """Return the files of a substitute that the unbuilt sources of the package lack.

    The result maps paths in the share folder to files. A launch file that a build generates, such as ros_gz_sim's
    ``gz_sim.launch.py``, starts programs of that build, while the substitute's file starts Linkwright's nodes. Files in
    the sources take precedence: Linkwright's nodes have the same names, and the user may have edited the files.

    Args:
        name: the package.
        folder: the source folder of the package.
    """
    text = _read_text_with_targets(folder)  # checked first, because reading the entry points takes longer
    share = None if text is None else _find_share_with_files(name)
    if text is None or share is None or not _is_compiled(folder, text):
        return {}
    substitute_files = {file.relative_to(share).as_posix(): file for file in sorted(share.rglob("*")) if file.is_file()}
    return {
        path: InstalledFile(str(file), f"share/{name}/{path}")
        for path, file in substitute_files.items()
        if path != MANIFEST and file.suffix != ".pyc" and not (folder / path).is_file()
    }


_COMPILING_COMMANDS = ("add_executable", "add_library", "add_module", "add_subdirectory", "include", "register_node")
"""Fragments of the CMake commands that declare compiled targets, or run other files."""


def _read_text_with_targets(folder: Path) -> str | None:
    """Return the text of a ``CMakeLists.txt``, or None if it cannot declare compiled targets."""
    try:
        text = (folder / "CMakeLists.txt").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    lower_text = text.casefold()
    return text if any(command in lower_text for command in _COMPILING_COMMANDS) else None


def _is_compiled(folder: Path, text: str) -> bool:
    """Return whether a package must be compiled, given the text of its ``CMakeLists.txt``."""
    from linkwright.diagnostics import SourceText
    from linkwright.packages.readers.cmake import read_cmake

    return bool(read_cmake(SourceText(str(folder / "CMakeLists.txt"), text), folder).compiled)


_LINK_FOLDER_MARK = os.path.join("", "linkwright", SHARES_SUBFOLDER, "")  # noqa: PTH118 - a part of the path as text

_PREFIX_MARK = os.path.join(_LINK_FOLDER_MARK, PREFIXES_SUBFOLDER, "")  # noqa: PTH118 - a part of the path as text


def find_share_of_sources(name: str, folder: Path) -> Path:
    """Return the share folder of an unbuilt package: its source folder, or a folder of links.

    If the links cannot be created, the result is the source folder. This happens on a full disk, or on Windows if the
    user may not create links.

    Args:
        name: the package.
        folder: the source folder of the package.
    """
    if _LINK_FOLDER_MARK in str(folder):  # a launch file in a folder of links started the search
        return folder
    moved_files = {path: file for path, file in _iterate_share_files(name, folder) if path != file.source}
    moved_files |= find_substituted_files(name, folder)
    if not moved_files:
        return folder
    from linkwright.packages.link_folder import make_link_folder

    try:
        return make_link_folder(name, folder, moved_files)
    except OSError:
        return folder


def find_prefix(name: str, share: Path) -> Path:
    """Return the install prefix of a package, as programs see it.

    For a package that is not installed, this is a folder in the user's cache, because programs look for files in
    ``PREFIX/share/NAME``. If its link cannot be created, the result is the source folder.

    Args:
        name: the package.
        share: the share folder of the package.
    """
    prefix = install_prefix(share)
    if prefix != share:
        return prefix
    from linkwright.packages.link_folder import make_prefix

    try:
        return make_prefix(name, share)
    except OSError:
        return prefix


def leave_prefix(folder: Path) -> Path:
    """Return the folder behind a folder in a prefix of `find_prefix`, and any other folder unchanged.

    Without this, a search that starts there would take an unbuilt package for an installed one.
    """
    return Path(os.path.realpath(folder)) if _PREFIX_MARK in str(folder) else folder


def find_source(path: str) -> str:
    """Return the source file behind a file in a folder of links, and any other path unchanged."""
    return os.path.realpath(path) if _LINK_FOLDER_MARK in path else path


def _iterate_share_files(name: str, folder: Path) -> Iterator[tuple[str, InstalledFile]]:
    """Yield the files that a package installs into its share folder, each with its path there.

    Some files with the same path in the sources are omitted.
    """
    share = f"share/{name}/"
    with suppress(OSError, ValueError):
        for file in _iterate_installed_files(folder, share):
            if file.destination.startswith(share) and _is_inside_package(file.source):
                yield file.destination[len(share) :], file


def _is_inside_package(source: str) -> bool:
    """Return whether a source path is inside the package.

    A page must not show files from outside an untrusted package.
    """
    path = Path(os.path.normpath(source))
    return not path.is_absolute() and path.parts[:1] != (os.pardir,)


def _iterate_installed_files(folder: Path, share: str) -> Iterator[InstalledFile]:
    for build_file in ("CMakeLists.txt", "setup.py"):
        try:
            text = (folder / build_file).read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue
        from linkwright.diagnostics import SourceText

        source = SourceText(str(folder / build_file), text)
        if build_file == "setup.py":
            from linkwright.packages.readers.setup_py import read_setup

            yield from read_setup(source).installed_files(folder)
            return
        from linkwright.packages.readers.cmake import read_cmake

        cmake = read_cmake(source, folder)
        hooks = set(cmake.hooks)  # only sourcing a build reads the hooks
        yield from (file for file in cmake.moved_files(folder, share) if file.destination not in hooks)
        return
