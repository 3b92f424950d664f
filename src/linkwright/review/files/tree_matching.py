"""Match the nodes of two versions of a behavior tree."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from difflib import SequenceMatcher

from linkwright.review.files.behavior_tree_files import TreeNode

_Key = Callable[[TreeNode], Hashable]


def match_nodes(old: Sequence[TreeNode], new: Sequence[TreeNode]) -> dict[TreeNode, TreeNode]:
    """Return the nodes of the old tree that are also in the new one, each with its counterpart.

    Nodes whose contents are equal and unique are matched first, then equal nodes in the same order, then those that
    moved, then those with other attributes.
    """
    signatures = {**_sign_nodes(old), **_sign_nodes(new)}
    matches: dict[TreeNode, TreeNode] = {}
    _match_moved(old, new, signatures.__getitem__, matches)
    matched = frozenset(matches.values())
    old, new = [node for node in old if node not in matches], [node for node in new if node not in matched]
    matcher = SequenceMatcher(None, [_get_content(node) for node in old], [_get_content(node) for node in new], False)
    for operation, *ranges in matcher.get_opcodes():
        old_nodes, new_nodes = old[ranges[0] : ranges[1]], new[ranges[2] : ranges[3]]
        if operation == "equal":
            matches.update(zip(old_nodes, new_nodes, strict=True))
        elif operation == "replace":
            matches.update(_match_in_order(old_nodes, new_nodes))
    for get_key in (_get_content, _get_name, _get_type):
        _match_moved(old, new, get_key, matches)
    return matches


def _sign_nodes(nodes: Sequence[TreeNode]) -> dict[TreeNode, Hashable]:
    """Return the type, the attributes and all inner nodes of each node in comparable form."""
    children: dict[TreeNode, list[Hashable]] = {node: [] for node in nodes}
    signatures: dict[TreeNode, Hashable] = {}
    for node in reversed(nodes):  # inner nodes first
        signatures[node] = hash((_get_content(node), tuple(reversed(children[node]))))
        if node.parent is not None:
            children[node.parent].append(signatures[node])
    return signatures


def _get_content(node: TreeNode) -> Hashable:
    return node.type, tuple(sorted(node.values.items()))


def _get_name(node: TreeNode) -> Hashable:
    return (node.type, node.values["name"]) if "name" in node.values else node


def _get_type(node: TreeNode) -> Hashable:
    return node.type


def _match_in_order(old: Sequence[TreeNode], new: Sequence[TreeNode]) -> dict[TreeNode, TreeNode]:
    """Return the nodes of the same types in the same order, whose attributes differ."""
    matcher = SequenceMatcher(None, [node.type for node in old], [node.type for node in new], False)
    return {
        old[block.a + index]: new[block.b + index]
        for block in matcher.get_matching_blocks()
        for index in range(block.size)
    }


def _match_moved(
    old: Sequence[TreeNode], new: Sequence[TreeNode], get_key: _Key, matches: dict[TreeNode, TreeNode]
) -> None:
    """Match the remaining nodes of which each version has exactly one with the same key."""
    matched = set(matches.values())
    candidates = [_find_unique([node for node in old if node not in matches], get_key)]
    candidates.append(_find_unique([node for node in new if node not in matched], get_key))
    matches.update((node, candidates[1][key]) for key, node in candidates[0].items() if key in candidates[1])


def _find_unique(nodes: Sequence[TreeNode], get_key: _Key) -> dict[Hashable, TreeNode]:
    keys = [get_key(node) for node in nodes]
    return {key: node for key, node in zip(keys, nodes, strict=True) if keys.count(key) == 1}
