"""Find simulator plugins that replace other plugins, such as the drive of a different Gazebo version."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.plugins import find_plugin_name, find_plugins, format_contents, is_added, is_removed
from linkwright.review.texts.element_values import format_own_content
from linkwright.xmltree import Element

_FILE_ROLE = re.compile(
    r"(lib)?((gazebo|gz|ignition|ign)[-_])?((sim|gazebo)[-_])?(ros2?[-_])?(?P<role>.+?)([-_](system|plugin))*(\.so)?"
)
"""A file name, with the role of the plugin between the parts about the simulator."""
_SEPARATORS = re.compile(r"[\W_]+")
_MIN_ROLE_LENGTH = 3
"""The minimum number of characters of a role."""


@dataclass(frozen=True, slots=True)
class PluginReplacement(Difference):
    """A plugin that replaces another plugin.

    Attributes:
        old_plugin: the old plugin.
        new_plugin: the new plugin.
    """

    old_plugin: Element | None = field(default=None, compare=False, repr=False)
    new_plugin: Element | None = field(default=None, compare=False, repr=False)

    @property
    def text(self) -> Phrase:
        """Both plugins with their values."""
        old, new = (_format_plugin(plugin) for plugin in (self.old_plugin, self.new_plugin) if plugin is not None)
        return phrase("{old} replaced by {new}", old=old, new=new)


def _format_plugin(plugin: Element) -> Phrase:
    title = phrase("plugin '{name}'", name=find_plugin_name(plugin))
    items = list(filter(None, [as_phrase(format_own_content(plugin)), format_contents(plugin)]))
    return phrase("{entry} ({items})", entry=title, items=joined(items)) if items else title


def merge_replaced_plugins(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, with replaced plugins as one difference each.

    A removed and an added plugin match if they have the same name or, of the others, the same role.
    """
    result = list(differences)
    for make_keys in (_make_name_keys, _make_role_keys):
        result = _merge_matching(result, make_keys)
    return result


def _merge_matching(differences: Sequence[Difference], make_keys: Callable[[Element], set[str]]) -> list[Difference]:
    """Return the differences, with a removed and an added plugin that share a key as one difference."""
    result = list(differences)
    candidates = [
        (candidate, plugin)
        for candidate in result
        if is_added(candidate) and (plugin := _find_only_plugin(candidate)) is not None
    ]
    for difference in tuple(result):
        old_plugin = _find_only_plugin(difference) if is_removed(difference) else None
        keys = set() if old_plugin is None else make_keys(old_plugin)
        number = next((number for number, (_, plugin) in enumerate(candidates) if keys & make_keys(plugin)), None)
        if old_plugin is None or number is None:
            continue
        added, new_plugin = candidates.pop(number)
        names = find_plugin_name(old_plugin), find_plugin_name(new_plugin)
        locations = difference.old_place, added.new_place
        index = next(index for index, candidate in enumerate(result) if candidate is added)
        result[index] = PluginReplacement(
            added.subject, added.name, "changed", added.property, *names, "", *locations, None, old_plugin, new_plugin
        )
        result = [candidate for candidate in result if candidate is not difference]
    return result


def _find_only_plugin(difference: Difference) -> Element | None:
    """Return the plugin that is the only content of an added or removed element, or None."""
    if difference.element is None:
        return None
    plugins = [plugin for plugin in find_plugins(difference.element) if plugin.attributes]
    children = list(difference.element.elements())
    is_alone = difference.element.tag == "plugin" or (difference.element.tag == "gazebo" and children == plugins)
    return plugins[0] if is_alone and len(plugins) == 1 else None


def _make_name_keys(plugin: Element) -> set[str]:
    return {find_plugin_name(plugin)} - {""}


def _make_role_keys(plugin: Element) -> set[str]:
    return set(_find_roles(plugin))


def _find_roles(plugin: Element) -> Iterator[str]:
    match = _FILE_ROLE.fullmatch(PurePosixPath(plugin.attributes.get("filename", "")).name)
    class_name = plugin.attributes.get("name", "").rpartition("::")
    for text in (match["role"] if match else "", class_name[2] if class_name[1] else ""):
        role = _SEPARATORS.sub("", text).lower()
        if len(role) >= _MIN_ROLE_LENGTH:
            yield role
