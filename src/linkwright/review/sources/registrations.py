"""Find the classes that C++ sources register for programs which load them by name."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.review.sources.names import FoundName, NameKind

_CLASS = r"\s*(?:::)?(?P<name>\w+(?:\s*::\s*\w+)*(?:\s*<[\w\s:,<>]*>)?)\s*"
_BASE = r"\s*(?:::)?(?P<base>\w+(?:\s*::\s*\w+)*(?:\s*<[\w\s:,<>]*>)?)"
_TEXT = r'\s*(?:[^(),;"]*,)?\s*"(?P<text>[^"\\]+)"'
_PATTERNS = (
    (NameKind.PLUGIN, rf"\bRCLCPP_COMPONENTS_REGISTER_NODE\s*\({_CLASS}\)"),
    (NameKind.PLUGINLIB_CLASS, rf"\b(?:PLUGINLIB_EXPORT_CLASS|CLASS_LOADER_REGISTER_CLASS)\s*\({_CLASS},{_BASE}"),
    (NameKind.PLUGINLIB_CLASS, rf"\bPLUGINLIB_REGISTER_CLASS\s*\(\s*\w+\s*,{_CLASS},{_BASE}"),
    (NameKind.PLUGINLIB_CLASS, rf"\bPLUGINLIB_DECLARE_CLASS\s*\(\s*\w+\s*,\s*\w+\s*,{_CLASS},{_BASE}"),
    (NameKind.LIBRARY_PLUGIN, rf"\bGZ_REGISTER_[A-Z]+_PLUGIN\s*\({_CLASS}\)"),
    (NameKind.SIMULATION_PLUGIN, rf"\b(?:GZ|IGNITION)_ADD_PLUGIN\s*\({_CLASS}[,)]"),
    (NameKind.SIMULATION_PLUGIN, rf"\b(?:GZ|IGNITION)_ADD_PLUGIN_ALIAS\s*\({_CLASS},(?P<aliases>[^()]*)\)"),
    (NameKind.TREE_NODE, r"[.>]\s*(?:registerNodeType|registerBuilder)\s*(?:<[^;{}()]*>)?\s*\(" + _TEXT),
    (NameKind.TREE_NODE, rf"[.>]\s*registerSimple(?:Action|Condition|Decorator)\s*\({_TEXT}"),
    (NameKind.TREE_PORT, rf"\b(?:Input|Output|Bidirectional)Port\s*(?:<[^;{{}}()]*>)?\s*\((?!\s*[^\"\s]){_TEXT}"),
    (NameKind.TREE_NODE, rf"\b(?:CreateRosNodePlugin|RegisterRos\w*(?:\s*<[^;{{}}()]*>)?)\s*\({_TEXT}"),
)
_COMPILED = [(kind, re.compile(pattern)) for kind, pattern in _PATTERNS]
_ALIAS = re.compile(r'"(?P<alias>[^"\\]+)"')
_DEFINITION = re.compile(r"^[ \t]*#[ \t]*define\b(?:[^\n\\]|\\\r?\n|\\.)*", re.MULTILINE)


def find_registrations(text: str) -> Iterator[FoundName]:
    """Yield the classes that a source registers, and the nodes of behavior trees with their ports.

    A class of Gazebo with other names only has these, because worlds name them.

    Args:
        text: the text of the source without comments.
    """
    text = _DEFINITION.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    aliased = set()
    found = []
    for kind, pattern in _COMPILED:
        for match in pattern.finditer(text):
            groups = match.groupdict()
            if groups.get("text"):
                found.append(FoundName(kind, match["text"], match.start("text"), match.end("text")))
                continue
            name = "".join(match["name"].split())
            if groups.get("aliases"):
                aliased.add(name)
                start = match.start("aliases")
                found += (
                    FoundName(kind, alias["alias"], start + alias.start("alias"), start + alias.end("alias"))
                    for alias in _ALIAS.finditer(match["aliases"])
                )
                continue
            base = "".join((groups.get("base") or "").split())
            found.append(FoundName(kind, name, match.start("name"), match.end("name"), base))
    for item in found:
        if item.name not in aliased or item.kind is not NameKind.SIMULATION_PLUGIN:
            yield item
