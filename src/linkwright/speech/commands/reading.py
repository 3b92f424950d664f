"""Read mappings with known keys in a YAML file; errors contain the keys and positions."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Any

import yaml

from linkwright.diagnostics import LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.files.yaml_documents import YamlDocument

_NULL = "tag:yaml.org,2002:null"


class Keys:
    """Reads the keys of a mapping.

    Args:
        document: the document that contains the mapping.
        node: the mapping.
        what: a description for messages.
        known: the known keys; None to allow any key.

    Raises:
        LinkwrightError: the node is not a mapping, or a key is unknown or occurs twice.
    """

    def __init__(
        self, document: YamlDocument, node: yaml.Node | None, what: Phrase, known: Iterable[str] | None
    ) -> None:
        self._document, self._node, self.what = document, node, what
        self._values: dict[str, yaml.Node] = {}
        if not isinstance(node, yaml.MappingNode):
            raise self.error(phrase("{what} must be a mapping of keys to values", what=what))
        names = None if known is None else tuple(known)
        for key, value in node.value:
            name = str(key.value) if isinstance(key, yaml.ScalarNode) else ""
            if names is not None and name not in names:
                hint = did_you_mean(name, names) or phrase("the package has {known}", known=", ".join(names))
                raise self.error(phrase("{what} has no '{key}'", what=what, key=name), key, hint)
            if name in self._values:
                raise self.error(phrase("'{key}' occurs twice", key=name), key)
            self._values[name] = value

    @classmethod
    def of(cls, document: YamlDocument, name: str, value: yaml.Node) -> Keys:
        """Read a mapping with one key."""
        key = yaml.ScalarNode("tag:yaml.org,2002:str", name)
        pair = yaml.MappingNode("tag:yaml.org,2002:map", [(key, value)])
        return cls(document, pair, phrase("strings by language"), None)

    def names(self) -> list[str]:
        """Return the keys that are present."""
        return list(self._values)

    def node(self, key: str) -> yaml.Node | None:
        """Return the node under a key; None if there is none."""
        node = self._values.get(key)
        return None if node is None or node.tag == _NULL else node

    def error(self, message: Phrase, node: yaml.Node | None = None, hint: Phrase | None = None) -> LinkwrightError:
        """Return the error for a problem at a node, or at the mapping."""
        return self._document.error(message, node or self._node, hint)

    def mapping(self, key: str) -> list[tuple[str, yaml.Node]] | None:
        """Return the keys and values of the mapping under a key, or None if it is missing."""
        node = self.node(key)
        if node is None:
            return None
        inner = Keys(self._document, node, phrase("'{key}'", key=key), None)
        return [(name, inner._values[name]) for name in inner.names()]

    def text(self, key: str, *, needed: bool = False) -> str:
        """Return the text under a key; empty if it is missing and not required."""
        node = self.node(key)
        if node is None and not needed:
            return ""
        if not isinstance(node, yaml.ScalarNode) or not node.value:
            raise self._missing(key, node, phrase("a string"))
        return str(node.value)

    def number(self, key: str, *, needed: bool = False) -> float:
        """Return the number under a key; 0 if it is missing and not required."""
        node = self.node(key)
        if node is None and not needed:
            return 0.0
        try:
            value = float(node.value) if isinstance(node, yaml.ScalarNode) else None
        except ValueError:
            value = None
        if value is None or not isfinite(value):
            raise self._missing(key, node, phrase("a number"))
        return value

    def flag(self, key: str) -> bool:
        """Return the boolean under a key; False if it is missing."""
        node = self.node(key)
        if not isinstance(node, yaml.ScalarNode) or node.value.lower() not in ("true", "false"):
            raise self._missing(key, node, phrase("true or false"))
        return bool(node.value.lower() == "true")

    def texts(self, key: str) -> list[tuple[str, yaml.Node | None]]:
        """Return the texts under a key, one or a list, each with its position."""
        node = self.node(key)
        items: list[yaml.Node | None] = list(node.value) if isinstance(node, yaml.SequenceNode) else [node]
        found: list[tuple[str, yaml.Node | None]] = []
        for item in items:
            if not isinstance(item, yaml.ScalarNode) or not item.value:
                raise self._missing(key, item, phrase("a string, or a list of strings"))
            found.append((str(item.value), item))
        return found

    def plain(self, key: str) -> Any:
        """Return the value of a key as lists, mappings, numbers and texts; an empty mapping if it is missing."""
        node = self.node(key)
        if node is None:
            return {}
        try:
            return yaml.constructor.SafeConstructor().construct_document(node)
        except yaml.YAMLError as error:
            raise self._missing(key, node, phrase("plain data")) from error

    def _missing(self, key: str, node: yaml.Node | None, wanted: Phrase) -> LinkwrightError:
        if node is None:
            return self.error(phrase("{what} needs '{key}', {wanted}", what=self.what, key=key, wanted=wanted))
        return self.error(phrase("'{key}' must be {wanted}", key=key, wanted=wanted), node)
