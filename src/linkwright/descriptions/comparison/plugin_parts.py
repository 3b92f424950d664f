"""Distinguish plugins of the same name by the joint or topic that each is for."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.xmltree import Element

_PART_TAGS = ("joint_name", "jointName", "topic", "topicName")
"""The parameters of plugins that name their joint or topic, the most specific first."""


def find_plugin_parts(versions: Sequence[Sequence[Element]]) -> dict[int, str]:
    """Return the joint or topic of plugins that have siblings of the same name, by the identity of the element.

    Plugins that lack the parameter, or that share a joint or topic, are left out.

    Args:
        versions: the siblings in each version.
    """
    plugins = [[element for element in siblings if element.tag == "plugin"] for siblings in versions]
    parts: dict[int, str] = {}
    for name in {element.attributes.get("name", "") for siblings in plugins for element in siblings} - {""}:
        groups = [[plugin for plugin in siblings if plugin.attributes.get("name") == name] for siblings in plugins]
        if max(map(len, groups)) < 2:
            continue
        for tag in _PART_TAGS:
            texts = [[_find_text(plugin, tag) for plugin in group] for group in groups]
            if all(all(found) and len(set(found)) == len(found) for found in texts):
                pairs = (
                    (plugin, text)
                    for group, found in zip(groups, texts, strict=True)
                    for plugin, text in zip(group, found, strict=True)
                )
                parts |= {id(plugin): text for plugin, text in pairs}
                break
    return parts


def _find_text(plugin: Element, tag: str) -> str:
    child = plugin.first(tag)
    return "" if child is None else child.text().strip()
