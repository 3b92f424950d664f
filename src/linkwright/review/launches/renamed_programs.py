"""Find programs that only have another name: renamed scripts, and executables of the same component."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import PurePosixPath

from linkwright.review.versions import Version, Versions

_REGISTRATION = re.compile(
    r"rclcpp_components_register_node\s*\([^()]*?PLUGIN\s+\"?(?P<plugin>[\w:]+)\"?[^()]*?EXECUTABLE\s+\"?(?P<name>[\w.-]+)"
)
_BUILD_FILE = "CMakeLists.txt"


def find_renamed_programs(versions: Versions) -> dict[str, str]:
    """Return the new names of renamed files and of executables, by old name."""
    names = {
        PurePosixPath(file.old_path).name: PurePosixPath(file.new_path).name
        for file in versions.changed_files
        if file.old_path and file.new_path
    }
    if not any(path.endswith(_BUILD_FILE) for path in names):
        return names
    old, new = _list_component_programs(versions.old), _list_component_programs(versions.new)
    left = set(new.values())
    return names | {old[plugin]: new[plugin] for plugin in old if plugin in new and old[plugin] not in left}


@lru_cache(maxsize=4)
def _list_component_programs(version: Version) -> dict[str, str]:
    """Return the names of the executables that CMake makes for components, by the class of the component."""
    texts = (version.text(path) for path in version.paths((_BUILD_FILE,)))
    return {match["plugin"]: match["name"] for text in texts for match in _REGISTRATION.finditer(text)}
