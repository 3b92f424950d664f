"""YAML mappings with a fixed set of keys, where errors name the key and its position."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Any

import yaml

from linkwright.diagnostics import LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.files.yaml_documents import YamlDocument

_NULL = "tag:yaml.org,2002:null"


class Keys:
    """The keys and values of a YAML mapping.

    Args:
        document: the document that contains the mapping.
        node: the mapping.
        subject: the description of the mapping, for messages.
        allowed_keys: the allowed keys; None to allow any key.

    Raises:
        LinkwrightError: the node is not a mapping, or a key is not allowed or occurs twice.
    """

    def __init__(
        self, document: YamlDocument, node: yaml.Node | None, subject: Phrase, allowed_keys: Iterable[str] | None
    ) -> None:
        self._document, self._node, self.subject = document, node, subject
        self._values: dict[str, yaml.Node] = {}
        if not isinstance(node, yaml.MappingNode):
            raise self.error(phrase("{subject} must be a mapping of keys to values", subject=subject))
        allowed_names = None if allowed_keys is None else tuple(allowed_keys)
        for key, value in node.value:
            key_name = str(key.value) if isinstance(key, yaml.ScalarNode) else ""
            if allowed_names is not None and key_name not in allowed_names:
                hint = did_you_mean(key_name, allowed_names) or phrase(
                    "use one of {names}", names=", ".join(allowed_names)
                )
                raise self.error(phrase("{subject} has no '{key}'", subject=subject, key=key_name), key, hint)
            if key_name in self._values:
                raise self.error(phrase("'{key}' occurs twice", key=key_name), key)
            self._values[key_name] = value

    @classmethod
    def of(cls, document: YamlDocument, name: str, value: yaml.Node) -> Keys:
        """Return a mapping that has one key with the given value."""
        key = yaml.ScalarNode("tag:yaml.org,2002:str", name)
        mapping_node = yaml.MappingNode("tag:yaml.org,2002:map", [(key, value)])
        return cls(document, mapping_node, phrase("the mapping from languages to strings"), None)

    def names(self) -> list[str]:
        """Return the keys that are present."""
        return list(self._values)

    def node(self, key: str) -> yaml.Node | None:
        """Return the value node under a key, or None if the key is missing or the value is null."""
        node = self._values.get(key)
        return None if node is None or node.tag == _NULL else node

    def error(self, message: Phrase, node: yaml.Node | None = None, hint: Phrase | None = None) -> LinkwrightError:
        """Return the error for a problem at a node, or at the mapping itself."""
        return self._document.error(message, node or self._node, hint)

    def mapping(self, key: str) -> list[tuple[str, yaml.Node]] | None:
        """Return the keys and values of the mapping under a key, or None if the key is missing."""
        node = self.node(key)
        if node is None:
            return None
        nested = Keys(self._document, node, phrase("'{key}'", key=key), None)
        return [(name, nested._values[name]) for name in nested.names()]

    def text(self, key: str, *, is_required: bool = False) -> str:
        """Return the text under a key, or an empty string if the key is missing and not required."""
        node = self.node(key)
        if node is None and not is_required:
            return ""
        if not isinstance(node, yaml.ScalarNode) or not node.value:
            raise self._invalid_value(key, node, phrase("a string"))
        return str(node.value)

    def number(self, key: str, *, is_required: bool = False) -> float:
        """Return the number under a key, or 0 if the key is missing and not required."""
        node = self.node(key)
        if node is None and not is_required:
            return 0.0
        try:
            value = float(node.value) if isinstance(node, yaml.ScalarNode) else None
        except ValueError:
            value = None
        if value is None or not isfinite(value):
            raise self._invalid_value(key, node, phrase("a number"))
        return value

    def flag(self, key: str) -> bool:
        """Return the boolean under a required key."""
        node = self.node(key)
        if not isinstance(node, yaml.ScalarNode) or node.value.lower() not in ("true", "false"):
            raise self._invalid_value(key, node, phrase("true or false"))
        return bool(node.value.lower() == "true")

    def texts(self, key: str) -> list[tuple[str, yaml.Node | None]]:
        """Return the text or the list of texts under a key, each with its node."""
        node = self.node(key)
        items: list[yaml.Node | None] = list(node.value) if isinstance(node, yaml.SequenceNode) else [node]
        texts: list[tuple[str, yaml.Node | None]] = []
        for item in items:
            if not isinstance(item, yaml.ScalarNode) or not item.value:
                raise self._invalid_value(key, item, phrase("a string, or a list of strings"))
            texts.append((str(item.value), item))
        return texts

    def data(self, key: str) -> Any:
        """Return the value under a key as plain Python data, or an empty mapping if it is missing."""
        node = self.node(key)
        if node is None:
            return {}
        try:
            return yaml.constructor.SafeConstructor().construct_document(node)
        except yaml.YAMLError as error:
            raise self._invalid_value(key, node, phrase("plain data")) from error

    def _invalid_value(self, key: str, node: yaml.Node | None, expected: Phrase) -> LinkwrightError:
        if node is None:
            return self.error(
                phrase("{subject} must have '{key}', {expected}", subject=self.subject, key=key, expected=expected)
            )
        return self.error(phrase("'{key}' must be {expected}", key=key, expected=expected), node)
