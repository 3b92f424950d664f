"""Convert common YAML nodes to values: mappings and lists of scalars.

PyYAML's own conversion has the same results but needs a dozen calls for each value. PyYAML still converts the rare
cases: merge keys, keys that are not scalars, dates, and tags.
"""

from __future__ import annotations

import sys

import yaml

from linkwright.loading.lean_typing import Any

_TAG_PREFIX = "tag:yaml.org,2002:"
_MAX_CACHED_TAGS = 10_000
_MAX_DEPTH = 200
_MAX_MERGED_PAIRS = 100_000
_MAX_NUMBER_LENGTH = 4_000
_MAX_LARGE_NUMBERS = 1_000

tags: dict[str, str] = {}
"""The tags of plain scalars, by text. A tag does not depend on the location of the scalar."""


class NodeLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """PyYAML's safe loader with limits and a cache of the tags of plain scalars.

    Without the limits, a file of a few lines could exhaust the memory, or overflow the stack of libyaml's composer.
    """

    depth = 0
    merged_pair_count = 0
    large_number_count = 0

    def resolve(self, kind: Any, value: Any, implicit: Any) -> Any:
        """Return the tag of a node without an explicit tag."""
        if kind is not yaml.ScalarNode or not implicit[0]:
            return super().resolve(kind, value, implicit)
        tag = tags.get(value)
        if tag is None:
            if len(tags) >= _MAX_CACHED_TAGS:
                tags.clear()
            tag = tags[value] = super().resolve(kind, value, implicit)
        return tag

    def descend_resolver(self, node: Any, _index: Any) -> None:
        """Check the nesting depth of a node.

        The path to a node does not affect its tag.
        """
        self.depth += 1
        if self.depth > _MAX_DEPTH:
            message = f"the values are nested more than {_MAX_DEPTH} levels deep"
            raise yaml.composer.ComposerError(None, None, message, node.start_mark)

    def ascend_resolver(self) -> None:
        """Leave a nesting level; see `descend_resolver`."""
        self.depth -= 1

    def construct_yaml_int(self, node: Any) -> Any:
        """Return the integer of a node, and count integers whose hashes may collide.

        Keys with colliding hashes make a mapping slow.
        """
        if len(node.value) > _MAX_NUMBER_LENGTH:
            message = f"the number has more than {_MAX_NUMBER_LENGTH:,} characters"
            raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
        number = super().construct_yaml_int(node)
        if abs(number) >= sys.hash_info.modulus:
            self.large_number_count += 1
            if self.large_number_count > _MAX_LARGE_NUMBERS:
                message = f"more than {_MAX_LARGE_NUMBERS:,} numbers have more than 60 bits"
                raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
        return number

    def flatten_mapping(self, node: Any) -> None:
        """Add the pairs of merged mappings to a mapping, unless there are too many."""
        super().flatten_mapping(node)
        self.merged_pair_count += len(node.value)
        if self.merged_pair_count > _MAX_MERGED_PAIRS:
            message = f"the merged mappings have more than {_MAX_MERGED_PAIRS:,} keys"
            raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)


NodeLoader.add_constructor(f"{_TAG_PREFIX}int", NodeLoader.construct_yaml_int)


class _UnusualError(Exception):
    """Raised for a node that PyYAML must convert."""


def construct(loader: Any, node: Any) -> Any:
    """Return the value of the root node of a document.

    Raises:
        yaml.YAMLError: if the node has no value.
    """
    try:
        return _Construction(loader).value(node)
    except _UnusualError:
        return loader.construct_document(node)


class _Construction:
    def __init__(self, loader: Any) -> None:
        self._scalars = {
            f"{_TAG_PREFIX}int": loader.construct_yaml_int,
            f"{_TAG_PREFIX}float": loader.construct_yaml_float,
            f"{_TAG_PREFIX}bool": loader.construct_yaml_bool,
            f"{_TAG_PREFIX}null": loader.construct_yaml_null,
        }
        self._started_nodes: set[int] = set()
        self._values_by_id: dict[int, Any] = {}  # the value of each node, which aliases share

    def value(self, node: Any) -> Any:
        tag = node.tag
        if isinstance(node, yaml.ScalarNode):
            if tag == "tag:yaml.org,2002:str":
                return node.value
            convert = self._scalars.get(tag)
            if convert is None:
                raise _UnusualError
            return convert(node)
        key = id(node)
        if key in self._values_by_id:
            return self._values_by_id[key]
        if key in self._started_nodes:
            raise _UnusualError
        self._started_nodes.add(key)
        if tag == "tag:yaml.org,2002:map":
            value: Any = self._mapping(node)
        elif tag == "tag:yaml.org,2002:seq":
            value = [self.value(item) for item in node.value]
        else:
            raise _UnusualError
        self._values_by_id[key] = value
        return value

    def _mapping(self, node: Any) -> dict[Any, Any]:
        mapping = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise _UnusualError
            mapping[self.value(key)] = self.value(value)
        return mapping
