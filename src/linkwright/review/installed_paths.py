"""The installed paths of moved files: other packages find a file that is installed at the same place."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path, PurePosixPath

from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build_facts import BuildFacts
from linkwright.review.files.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.setup_files import SETUP_FILE, read_setup_facts
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document


def keeps_installed_path(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether both versions certainly install a moved file at the same place, or neither installs it."""
    old_places, new_places = _places(versions.old, old_path), _places(versions.new, new_path)
    return old_places is not None and old_places == new_places


def _places(version: Version, path: str) -> frozenset[str] | None:
    """Return the installed paths of a file without the name of its package, or None if they are not known."""
    parents = (parent for parent in PurePosixPath(path).parents if version.file(f"{parent}/{MANIFEST}").is_file())
    package = next(parents, None)
    facts = None if package is None else _facts(version.root, version, package.as_posix().removeprefix("."))
    if facts is None or not facts.is_complete:
        return None
    source = PurePosixPath(path).relative_to(package or ".").as_posix()
    return frozenset(facts.place(target) for target, other in facts.files.items() if other == source)


@lru_cache(maxsize=64)
def _facts(root: Path, version: Version, package: str) -> BuildFacts | None:
    """Return what the build file of a package installs, or None if it is not known. Catkin also finds the sources."""
    folder = root / package
    if Manifest(read_document(str(folder / MANIFEST))).is_ros1:
        return None
    for name, read in ((CMAKE_FILE, read_cmake_facts), (SETUP_FILE, read_setup_facts)):
        if (folder / name).is_file():
            try:
                return read(version, f"{package}/{name}".lstrip("/"))
            except (UnreadableFileError, OSError, ValueError):
                return None
    return None
