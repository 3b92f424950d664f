"""Find programs that only have another name: renamed scripts, and executables of the same component."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import PurePosixPath

from linkwright.review.files.cmake_files import CMAKE_FILE
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.versions import Version, Versions


def find_renamed_programs(versions: Versions) -> dict[str, str]:
    """Return the new names of renamed files and of executables, by old name."""
    names = {
        PurePosixPath(file.old_path).name: PurePosixPath(file.new_path).name
        for file in versions.changed_files
        if file.old_path and file.new_path
    }
    paths = {file.path for file in versions.changed_files if PurePosixPath(file.path).name == CMAKE_FILE}
    old, new = _read_component_programs(versions.old, paths), _read_component_programs(versions.new, paths)
    left = set(new.values())
    return names | {old[plugin]: new[plugin] for plugin in old if plugin in new and old[plugin] not in left}


def _read_component_programs(version: Version, paths: Collection[str]) -> dict[str, str]:
    """Return the executables of components in the packages of build files, by the class of the component."""
    folders = {folder for path in paths if (folder := version.package_of(path)) is not None}
    facts = [read_package_facts(version, folder) for folder in sorted(folders)]
    return {plugin: name for item in facts if item is not None for plugin, name in item.component_programs.items()}
