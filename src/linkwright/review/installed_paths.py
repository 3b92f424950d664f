"""Compare the installed paths of moved files. Other packages still find a file with the same installed path."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.build.facts import BuildFacts, FactKind, find_own_include_text
from linkwright.review.files.build.setup_files import SETUP_FILE, read_setup_facts
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_EXPORTED_FOLDER = re.compile(r"-I\$\{prefix\}/(?P<folder>[\w./-]+)")
"""A folder with headers in the compiler flags that a manifest of rosbuild exports."""
_FINDS_BUILD_TOOL = re.compile(r"^[ \t]*find_package\s*\(\s*(?:ament_cmake|catkin)\b", re.IGNORECASE | re.MULTILINE)


def keeps_installed_path(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether a moved file certainly keeps its installed path.

    This also holds for a file that is not installed.
    """
    old_package, new_package = versions.old.package_of(old_path), versions.new.package_of(new_path)
    if old_package is None or old_package != new_package:
        return False
    if find_module(versions.old, old_package, old_path) != find_module(versions.new, new_package, new_path):
        return False
    old_installed_paths = find_installed_paths(versions.old, old_package, old_path)
    return old_installed_paths is not None and old_installed_paths == find_installed_paths(
        versions.new, old_package, new_path
    )


def is_without_manifest(version: Version, path: str) -> bool:
    """Return whether a file is in the folder of a build file of catkin or ament that has no manifest.

    Such a folder is not a package, and its build fails, so that nothing of it is installed.
    """
    if version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST)) is not None:
        return False
    return any(
        _FINDS_BUILD_TOOL.search(version.text((parent / CMAKE_FILE).as_posix())) is not None
        for parent in PurePosixPath(path).parents
        if version.file((parent / CMAKE_FILE).as_posix()).is_file()
    )


def find_module(version: Version, package: str, path: str) -> PurePosixPath | None:
    """Return the path by which other programs import a file, or None if it is in no installed Python package."""
    if not path.endswith(".py"):
        return None
    source = PurePosixPath(path).relative_to(package)
    source = source.relative_to("src") if source.is_relative_to("src") else source
    is_module = any(source.is_relative_to(folder) for folder in find_python_packages(version, package))
    return source if is_module else None


def keeps_type(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether a moved ROS 1 interface keeps its type.

    Type names of ROS 1 contain no folder.
    """
    old, new = PurePosixPath(old_path), PurePosixPath(new_path)
    package = versions.new.package_of(new_path)
    if old.name != new.name or package is None or versions.old.package_of(old_path) != package:
        return False
    facts = read_package_facts(versions.new, package)
    is_built = facts is not None and any(
        fact.kind is FactKind.INTERFACE and fact.name == new.relative_to(package).as_posix() for fact in facts.facts
    )
    return is_built and Manifest(read_document(str(versions.new.root / package / MANIFEST))).is_ros1


def find_installed_paths(version: Version, package: str, path: str) -> frozenset[str] | None:
    """Return the installed paths of a file, or None if they are unknown.

    They do not contain the name of the package.
    """
    folder = version.root / package
    if Manifest(read_document(str(folder / MANIFEST))).is_ros1:
        return None  # catkin also finds files in the source folder, whatever is installed
    return find_targets(version, package, path)


def find_targets(version: Version, package: str, path: str) -> frozenset[str] | None:
    """Return the paths to which the build installs a file, or None if they are unknown.

    They do not contain the name of the package.
    """
    facts = read_package_facts(version, package)
    if facts is None or not facts.is_complete:
        return None
    source = PurePosixPath(path).relative_to(package).as_posix()
    return frozenset(facts.strip_project(target) for target, other in facts.files.items() if other == source)


@cached_in_review(maxsize=64)
def read_package_facts(version: Version, package: str) -> BuildFacts | None:
    """Return the facts of the build file of a package, or None if no build file can be read.

    Args:
        version: the version of the repository.
        package: the folder of the package relative to the root; empty for the root.
    """
    for name, read in ((CMAKE_FILE, read_cmake_facts), (SETUP_FILE, read_setup_facts)):
        path = f"{package}/{name}".lstrip("/")
        if version.file(path).is_file():
            try:
                return read(version, path)
            except (UnreadableFileError, LinkwrightError, OSError, ValueError):
                return None
    return None


def find_build_file(version: Version, package: str) -> str | None:
    """Return the path of the build file of a package, or None if it has none."""
    paths = (f"{package}/{name}".lstrip("/") for name in (CMAKE_FILE, SETUP_FILE))
    return next((path for path in paths if version.file(path).is_file()), None)


def find_python_packages(version: Version, package: str) -> list[str]:
    """Return the folders of the installed Python packages.

    They are relative to the package or to its ``src`` folder.
    """
    names: list[str] = []
    for name, read in ((CMAKE_FILE, read_cmake_facts), (SETUP_FILE, read_setup_facts)):
        path = f"{package}/{name}".lstrip("/")
        if version.file(path).is_file():
            try:
                facts = read(version, path)
            except (UnreadableFileError, LinkwrightError, OSError, ValueError):
                continue
            names += (fact.name.replace(".", "/") for fact in facts.facts if fact.kind is FactKind.MODULE)
    return names


def is_exported_header(version: Version, package: str, path: str) -> bool:
    """Return whether other packages find a header.

    Such a header is installed, or is in a folder that catkin or the manifest of rosbuild exports. If not all installed
    files are known, a header in a folder that a package of ament exports counts as installed.
    """
    facts = read_package_facts(version, package)
    source = PurePosixPath(path).relative_to(package).as_posix()
    rosbuild_folders = _EXPORTED_FOLDER.findall(version.text(f"{package}/{ROSBUILD_MANIFEST}".lstrip("/")))
    if any(PurePosixPath(source).is_relative_to(folder) for folder in rosbuild_folders):
        return True
    if facts is None:
        return False
    if any(target.startswith("include/") and source == other for target, other in facts.files.items()):
        return True
    folders = set(facts.header_paths)
    if not facts.is_complete:
        folders |= {fact.name for fact in facts.facts if fact.kind is FactKind.EXPORTED_FOLDER}
    return any(PurePosixPath(source).is_relative_to(folder) for folder in folders)


def find_include_text(version: Version, package: str, path: str) -> str:
    """Return the text by which other packages include a header that they find.

    This is its installed path below an exported folder, or else its path below the folder ``include`` of the package.
    """
    facts = read_package_facts(version, package)
    source = PurePosixPath(path).relative_to(package)
    own_text = find_own_include_text(source.as_posix()) or source.name
    targets = [] if facts is None else [target for target, other in facts.files.items() if other == source.as_posix()]
    texts = [text for target in targets if facts is not None for text in facts.find_include_texts(target)]
    return own_text if own_text in texts or not texts else min(texts, key=len)
