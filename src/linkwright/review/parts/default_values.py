"""Find values that are the same by default: a new argument or parameter of a macro has the old value as its default."""

from __future__ import annotations

import re
from itertools import chain

from linkwright.descriptions.comparison import find_remapped_name
from linkwright.review.parts.elements import PartDifference
from linkwright.review.parts.known_values import collect_values, evaluate_text
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.plugins import differ_only_in_slash, find_plugin_name, find_plugins, is_in_root_namespace

_REFERENCE = re.compile(r"\$\(arg\s+(?P<argument>[^\s()]+)\s*\)|\$\{(?P<expression>[^{}]*)\}")
"""The use of an argument, or of properties and parameters of a macro."""
_WORD = re.compile(r"[A-Za-z_]\w*")


def is_same_by_default(pair: PartPair, macro: str | None, difference: PartDifference) -> bool:
    """Return whether a changed value is the old one for callers that do not pass the names which it newly uses.

    Args:
        pair: both versions of the file.
        macro: the macro with the value; None outside of macros.
        difference: the difference between the values.
    """
    if difference.old is None or difference.new is None or difference.value == "conditions":
        return False
    old, new = " ".join(difference.old.split()), " ".join(difference.new.split())
    return " ".join(evaluate_text(new, collect_new_values(pair, macro), _find_names(old)).split()) == old


def collect_new_values(pair: PartPair, macro: str | None) -> dict[str, str]:
    """Return the values by default of names in the new version of a file, or of a macro in it."""
    outlines = pair.new, *pair.robots
    return collect_values(pair.defaults, outlines, None if macro is None else pair.new.macros.get(macro))


def names_same_topic_by_default(pair: PartPair, macro: str | None, difference: PartDifference) -> bool:
    """Return whether a topic of a sensor, or of a plugin without a namespace, only gains or loses its first slash.

    Args:
        pair: both versions of the file.
        macro: the macro with the plugin; None outside of macros.
        difference: the difference between the texts.
    """
    elements = difference.old_element, difference.new_element
    if difference.value != "text" or None in elements or not difference.old or not difference.new:
        return False
    is_topic = elements[1] is not None and (
        "topic" in elements[1].tag.lower() or find_remapped_name(elements[1]) is not None
    )
    if not is_topic or not differ_only_in_slash(difference.old, difference.new):
        return False
    values = collect_new_values(pair, macro)
    plugins = [
        plugin
        for outline, element in zip((pair.old, pair.new), elements, strict=True)
        for plugin in find_plugins(outline.root)
        if element is not None and any(child.offset == element.offset for child in plugin.walk())
    ]
    if not plugins:
        return elements[1] is not None and elements[1].tag == "topic"  # of a sensor; Gazebo adds the slash
    return len(plugins) == len(elements) and all(
        is_in_root_namespace([plugin], find_plugin_name(plugin), lambda text: evaluate_text(text, values))
        for plugin in plugins
    )


def _find_names(text: str) -> set[str]:
    """Return the names that a text uses, those of arguments with ``$``."""
    return set(
        chain.from_iterable(
            [f"${match['argument']}"] if match["argument"] else _WORD.findall(match["expression"])
            for match in _REFERENCE.finditer(text)
        )
    )
