"""Find links of a macro without the prefix with which a joint of the macro names them.

The default of the prefix, which is mostly empty, hides the mistake.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkwright.diagnostics import phrase
from linkwright.review.parts.outline import MacroOutline
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_PREFIXED = re.compile(r"\$\{\s*(?P<parameter>\w+)\s*\}(?P<link>[\w-]+)")
_ENDS = ("parent", "child")


def compare_links_without_prefix(pair: PartPair) -> None:
    """Report the links that macros newly make without the prefix with which their joints name them.

    Args:
        pair: both versions of the file with the macros.
    """
    known = {name for macro in pair.old.macros.values() for name in _find_links_without_prefix(macro)}
    for macro in pair.new.macros.values():
        for name, (link, parameter) in _find_links_without_prefix(macro).items():
            if name in known:
                continue
            text = phrase("macro '{name}': link '{link}' lacks the prefix of its joint", name=macro.name, link=name)
            reason = phrase(
                "with a '{parameter}', the description has no link '{link}'",
                parameter=parameter,
                link=f"${{{parameter}}}{name}",
            )
            pair.add(text, None, link, reason)


def _find_links_without_prefix(macro: MacroOutline) -> Mapping[str, tuple[Element, str]]:
    """Return the links without a prefix, and the parameter of the macro that is the prefix in a joint, by link name.

    A link that a joint names without the prefix is not among them.
    """
    elements = list(macro.element.walk())
    links = {element.attributes["name"]: element for element in elements if _is_link(element)}
    used = {element.attributes.get("link", "") for element in elements if element.tag in _ENDS}
    matches = (match for name in used - links.keys() if (match := _PREFIXED.fullmatch(name)) is not None)
    return {
        match["link"]: (links[match["link"]], match["parameter"])
        for match in sorted(matches, key=lambda match: match["link"])
        if match["link"] in links.keys() - used and match["parameter"] in macro.parameters
    }


def _is_link(element: Element) -> bool:
    return element.tag == "link" and "name" in element.attributes
