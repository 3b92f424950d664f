"""Find programs that only have another name: renamed scripts, and renamed executables of a build file."""

from __future__ import annotations

from pathlib import PurePosixPath

from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.facts import find_renamed_targets
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.versions import Versions


def find_renamed_programs(versions: Versions) -> dict[str, str]:
    """Return the new names of renamed files and of executables, by old name."""
    names = {
        PurePosixPath(file.old_path).name: PurePosixPath(file.new_path).name
        for file in versions.changed_files
        if file.old_path and file.new_path
    }
    for file in versions.changed_files:
        if PurePosixPath(file.path).name != CMAKE_FILE or file.old_path is None or file.new_path is None:
            continue
        folders = versions.old.package_of(file.old_path), versions.new.package_of(file.new_path)
        if None not in folders:
            names |= _find_renamed_targets(versions, *map(str, folders))
    return names


def _find_renamed_targets(versions: Versions, old_folder: str, new_folder: str) -> dict[str, str]:
    """Return the new names of the renamed executables of a package, by old name."""
    old, new = read_package_facts(versions.old, old_folder), read_package_facts(versions.new, new_folder)
    if old is None or new is None:
        return {}
    left = {*new.targets, *new.component_programs.values()}
    renamed = find_renamed_targets(versions, old, new)
    return {name: other for name, other in renamed.items() if name not in left}
