"""Read behavior trees in XML files of BehaviorTree.CPP 3 and 4."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.review.lenient_xml import read_lenient_root
from linkwright.xmltree import Element

_TREE_FILE = re.compile(rb"<(?:BehaviorTree|TreeNodesModel)\b")
_MAX_BYTES = 1 << 22
_TREE_TAG = "BehaviorTree"
_MODELS_TAG = "TreeNodesModel"
_INCLUDE_TAG = "include"
_SUBTREE_TAGS = ("SubTree", "SubTreePlus")
_EXPLICIT_TAGS = frozenset({"Action", "Condition", "Control", "Decorator"})
"""The tags of nodes whose attribute ``ID`` gives the type. Other tags are types themselves."""
_IGNORED_ATTRIBUTES = frozenset({"ID", "_uid", "_description", "_fullpath", "_collapsed"})
"""The attribute with the type, and those that only editors use."""
_PORT_TAGS = {"input_port": "input", "output_port": "output", "inout_port": "in/out"}


@dataclass(eq=False)
class TreeNode:
    """A node of a behavior tree.

    Attributes:
        type: the registered type, or the tag and the tree of a subtree, such as ``SubTree 'Recover'``.
        values: the ports and other attributes by name.
        element: the XML element.
        parent: the node that contains it; None for the root of a tree.
        subtree: the tree that the node runs; empty for other nodes.
    """

    type: str
    values: Mapping[str, str]
    element: Element
    parent: TreeNode | None
    subtree: str = ""

    @property
    def title(self) -> str:
        """The type, and the name of this node if it has one of its own."""
        name = self.values.get("name", "")
        return f"{self.type} '{name}'" if name and name != self.type else self.type


@dataclass
class Tree:
    """A behavior tree.

    Attributes:
        name: the value of ``ID``; empty without one.
        element: the XML element.
        nodes: the nodes, each before the nodes that it contains.
    """

    name: str
    element: Element
    nodes: list[TreeNode]


@dataclass
class TreeFile:
    """The contents of a file of behavior trees.

    Attributes:
        settings: the main tree and the format.
        trees: the trees by name.
        models: the ports of each type of node that the file describes, by type.
        includes: the included files.
        root: the root element.
    """

    root: Element
    settings: dict[str, str] = field(default_factory=dict)
    trees: dict[str, Tree] = field(default_factory=dict)
    models: dict[str, dict[str, str]] = field(default_factory=dict)
    includes: dict[str, Element] = field(default_factory=dict)


def is_tree_file(file: Path) -> bool:
    """Return whether an XML file contains behavior trees or describes their nodes."""
    try:
        is_small = file.suffix == ".xml" and file.stat().st_size <= _MAX_BYTES
        return is_small and _TREE_FILE.search(file.read_bytes()) is not None
    except OSError:
        return False


def read_tree_file(file: Path) -> TreeFile:
    """Return the contents of a file of behavior trees.

    Raises:
        LinkwrightError: the file is not XML.
    """
    root = read_lenient_root(file)
    settings = {name: value for name, value in root.attributes.items() if name in _SETTING_TITLES}
    result = TreeFile(root, settings)
    for element in root.elements():
        if element.tag == _TREE_TAG:
            name = element.attributes.get("ID", "")
            result.trees[name] = Tree(name, element, list(_read_nodes(element, None)))
        elif element.tag == _INCLUDE_TAG:
            package = element.attributes.get("ros_pkg", "")
            path = element.attributes.get("path", "")
            result.includes[f"{package}: {path}" if package else path] = element
        elif element.tag == _MODELS_TAG:
            for model in element.elements():
                result.models[model.attributes.get("ID", "")] = dict(_read_ports(model))
    return result


_SETTING_TITLES = ("main_tree_to_execute", "BTCPP_format")


def _read_nodes(parent_element: Element, parent: TreeNode | None) -> Iterator[TreeNode]:
    for element in parent_element.elements():
        name = element.attributes.get("ID", "")
        attributes = element.attributes.items()
        values = {key: " ".join(value.split()) for key, value in attributes if key not in _IGNORED_ATTRIBUTES}
        if element.tag in _SUBTREE_TAGS:
            node = TreeNode(f"{element.tag} '{name}'", values, element, parent, name)
        else:
            node = TreeNode(name if element.tag in _EXPLICIT_TAGS and name else element.tag, values, element, parent)
        yield node
        yield from _read_nodes(element, node)


def _read_ports(model: Element) -> Iterator[tuple[str, str]]:
    """Yield the ports of a type of node, each with its direction and default."""
    for port in model.elements():
        direction = _PORT_TAGS.get(port.tag)
        if direction is not None:
            default = port.attributes.get("default", "")
            yield port.attributes.get("name", ""), f"{direction} = {default}" if default else direction
