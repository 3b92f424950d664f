"""Find plugins in parameter files that no list of their node names, so that the node does not read them."""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.texts.list_changes import list_items

_NAMING_PARAMETER = re.compile(r"(\w+_)?(plugins?|filters|plugin_ids|plugin_names)")
"""The parameters of Nav2 that name the plugins that a node loads."""
_LAYER = re.compile(r"\w+_layer")
"""The names of the layers of costmaps, whose class the file may leave out."""
_DEFAULT_PLUGINS = frozenset({"progress_checker", "goal_checker", "general_goal_checker"})
"""The plugins that a node of Nav2 loads by default, beside those that another list names."""
_CRITIC = "Critic"
"""The end of the names of the critics of MPPI."""


def is_unread_plugin(parameter: str, root: str, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> bool:
    """Return whether a lost parameter belongs to a plugin that its node did not load, or that a list no longer names.

    The line about the list tells the latter.

    Args:
        parameter: the path of the parameter.
        root: the path of the parameters of the node.
        old: the old values by path.
        new: the new values by path.
    """
    plugin, _, rest = parameter.removeprefix(f"{root}.").partition(".")
    if _is_unread_critic(rest.partition(".")[0], f"{root}.{plugin}.critics", old, new):
        return True
    if f"{root}.{plugin}.plugin" not in old and not _LAYER.fullmatch(plugin):
        return False
    lists = {name: list_items(value.text) for name, value in old.items() if _names_plugins(name, root)}
    new_lists = {name: list_items(value.text) for name, value in new.items() if _names_plugins(name, root)}
    if not lists or any(plugin in items for items in new_lists.values()):
        return False
    naming = [name for name, items in lists.items() if plugin in items]
    if not naming:
        return plugin not in _DEFAULT_PLUGINS
    return all(name in new_lists for name in naming)


def _is_unread_critic(name: str, critics: str, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> bool:
    """Return whether a controller of Nav2 no longer lists a critic, or never did."""
    if critics not in old or critics not in new or name in list_items(new[critics].text):
        return False
    return name in list_items(old[critics].text) or name.endswith(_CRITIC)


def _names_plugins(name: str, root: str) -> bool:
    """Return whether a value directly below a node names plugins."""
    parent, _, key = name.rpartition(".")
    return parent == root and _NAMING_PARAMETER.fullmatch(key) is not None
