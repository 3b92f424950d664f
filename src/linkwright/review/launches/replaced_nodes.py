"""Tell which nodes of a launch file take the place of nodes of other programs."""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkwright.review.launches.outlines import CONDITION, NAMESPACE, PARAMETER, REMAPPING, Entry

COMMON_PARAMETERS = frozenset({"use_sim_time", "robot_description", "frame_id", "autostart", "node_names"})
"""Parameters that many programs have."""
_COMMON_NAME = re.compile(
    r"(.*_)?frame(_id)?|((publish|loop|update)_)?(rate|frequency)|debug|verbose|(.*_)?(name|prefix)"
)
"""The names of parameters that unlike programs have with equal values."""
_CLASS = re.compile(r"(?:[A-Z][a-z0-9]+){2,}")
"""The name of a class of several words."""


def register_same_class(old: str, new: str) -> bool:
    """Return whether two programs start the same component, whose package has another name.

    Such programs have the name of the package before that of the class, such as ``arm/arm_GripperDriver``.
    """
    names = [program.removeprefix(f"{package}_") for package, _, program in (old.partition("/"), new.partition("/"))]
    return names[0] == names[1] and _CLASS.fullmatch(names[0]) is not None


def have_same_names(old: Entry, new: Entry) -> bool:
    """Return whether two nodes have the same remappings and parameters, at least one of each."""
    settings = [_find_names_and_parameters(entry) for entry in (old, new)]
    has_parameter = any(not _is_common(name) for name in settings[1] if not name.startswith(REMAPPING))
    has_remapping = any(name.startswith(REMAPPING) for name in settings[1])
    return settings[0] == settings[1] and has_parameter and has_remapping


def match_lone_nodes(removed: Mapping[int, Entry], added: Mapping[int, Entry]) -> dict[int, int]:
    """Return the pair of the only removed and the only added node, if they have a common parameter.

    The nodes belong to different packages, and have the same condition, namespace and remappings.
    """
    old, new = ({i: entry for i, entry in entries.items() if entry.kind == "node"} for entries in (removed, added))
    if len(old) != 1 or len(new) != 1:
        return {}
    (i, old_node), (k, new_node) = *old.items(), *new.items()
    if old_node.name.partition("/")[0] == new_node.name.partition("/")[0]:
        return {}
    contexts = [
        {
            name: value
            for name, value in node.settings.items()
            if name in (CONDITION, NAMESPACE) or name.startswith(REMAPPING)
        }
        for node in (old_node, new_node)
    ]
    common = old_node.settings.items() & new_node.settings.items()
    has_parameter = any(name.startswith(PARAMETER) and not _is_common(name) for name, _ in common)
    return {i: k} if contexts[0] == contexts[1] and has_parameter else {}


def _find_names_and_parameters(entry: Entry) -> dict[str, str]:
    prefixes = (REMAPPING, PARAMETER, "parameters")
    return {name: value for name, value in entry.settings.items() if name.startswith(prefixes)}


def _is_common(setting: str) -> bool:
    name = setting.removeprefix(PARAMETER).removeprefix("~")
    return name in COMMON_PARAMETERS or _COMMON_NAME.fullmatch(name) is not None
