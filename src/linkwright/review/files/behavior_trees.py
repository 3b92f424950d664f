"""Compare behavior trees: trees, nodes with their ports, the order of nodes, and descriptions of nodes."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from linkwright.diagnostics import Phrase, joined, joined_first, phrase, quoted_names
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.files.behavior_tree_files import Tree, TreeFile, TreeNode, read_tree_file
from linkwright.review.files.tree_matching import match_nodes
from linkwright.review.versions import Version

_USER_SUFFIXES = (".cpp", ".cc", ".cxx", ".hpp", ".h", ".py", ".yaml", ".yml", ".launch", ".xml")
_MAIN_TREE = "main_tree_to_execute"


def compare_behavior_trees(pair: FilePair) -> None:
    """Compare two versions of a file of behavior trees."""
    files = pair.read(read_tree_file)
    if files is None:
        return
    old, new = files
    _compare_settings(pair, old, new)
    renamed = _find_renamed_trees(old, new)
    _report_renamed_and_removed_trees(pair, old, new, renamed)
    old_names = {new_name: old_name for old_name, new_name in renamed.items()}
    for name, tree in new.trees.items():
        old_tree = old.trees.get(old_names.get(name, name))
        if old_tree is None:
            text = phrase("{tree} added: {nodes}", tree=_format_tree(tree), nodes=_list_types(tree.nodes))
            pair.add(text, pair.location(tree.element.span()))
        else:
            _compare_trees(pair, old_tree, tree, renamed)
    _report_missing_subtrees(pair, old, new)
    _compare_models(pair, old, new)


def tree_contents(version: Version, path: str) -> Phrase | None:
    """Return the trees of an added or removed file in one line, or None if there are none."""
    file = read_tree_file(version.file(path))
    items = [
        phrase("{tree} ({nodes})", tree=_format_tree(tree), nodes=_list_types(tree.nodes))
        for tree in file.trees.values()
    ]
    if file.models and not items:
        return phrase("descriptions of the nodes {names}", names=joined_first(file.models, MAX_NAMES))
    return joined_first(items, MAX_NAMES) if items else None


def _format_tree(tree: Tree) -> Phrase:
    return phrase("tree '{name}'", name=tree.name) if tree.name else phrase("tree")


def _list_types(nodes: Sequence[TreeNode]) -> Phrase:
    return joined_first(dict.fromkeys(node.title for node in nodes), MAX_NAMES)


# --- the file --------------------------------------------------------------------------------------------------------


def _compare_settings(pair: FilePair, old: TreeFile, new: TreeFile) -> None:
    location = pair.location(new.root.span())
    for name in dict.fromkeys([*old.settings, *new.settings]):
        before, after = old.settings.get(name), new.settings.get(name)
        if before is None:
            pair.add(phrase("{name} {value} added", name=name, value=after), location)
        elif after is None:
            pair.add(phrase("{name} {value} removed", name=name, value=before), location)
        elif before != after:
            pair.add(phrase("{name} {old} -> {new}", name=name, old=before, new=after), location)
    for name, element in new.includes.items():
        if name not in old.includes:
            pair.add(phrase("includes the file '{path}' now", path=name), pair.location(element.span()))
    for name, element in old.includes.items():
        if name not in new.includes:
            text = phrase("no longer includes the file '{path}'", path=name)
            pair.add(text, pair.location(element.span(), is_old=True))


def _find_renamed_trees(old: TreeFile, new: TreeFile) -> dict[str, str]:
    """Return the new names of renamed trees by old name: those with the same nodes, or the main tree."""
    lost = [name for name in old.trees if name not in new.trees]
    added = [name for name in new.trees if name not in old.trees]
    renamed: dict[str, str] = {}
    for name in lost:
        contents = _get_contents(old.trees[name])
        match = next((other for other in added if _get_contents(new.trees[other]) == contents), None)
        if match is not None:
            added.remove(match)
            renamed[name] = match
    lost = [name for name in lost if name not in renamed]
    if len(lost) == len(added) == 1 and (
        (old.settings.get(_MAIN_TREE), new.settings.get(_MAIN_TREE)) == (lost[0], added[0])
        or len(old.trees) == len(new.trees) == 1
    ):
        renamed[lost[0]] = added[0]
    return renamed


def _get_contents(tree: Tree) -> list[tuple[str, object]]:
    return [(node.type, dict(node.values)) for node in tree.nodes]


def _report_renamed_and_removed_trees(pair: FilePair, old: TreeFile, new: TreeFile, renamed: Mapping[str, str]) -> None:
    for name, tree in old.trees.items():
        if name in new.trees:
            continue
        reason = _find_user_reason(pair.versions.new, name, pair.new_path)
        if name in renamed:
            text = phrase("tree '{old}' renamed to '{new}'", old=name, new=renamed[name])
            pair.add(text, pair.location(new.trees[renamed[name]].element.span()), reason)
        else:
            text = phrase("{tree} removed: {nodes}", tree=_format_tree(tree), nodes=_list_types(tree.nodes))
            pair.add(text, pair.location(tree.element.span(), is_old=True), reason)


def _find_user_reason(version: Version, name: str, own_path: str) -> Phrase | None:
    """Return why a lost tree is breaking: another file of the new version still names it."""
    if not name:
        return None
    pattern = re.compile(rf"[\"'\s]{re.escape(name)}[\"'\s]")
    definition = _make_definition_pattern(name)
    users = []
    for path in version.paths(_USER_SUFFIXES):
        text = version.text(path)
        if path.endswith(".xml") and definition.search(text):
            return None
        is_user = name in text and "tree" in text.lower() and pattern.search(text) is not None
        users += [path] if is_user and path != own_path else []
    return phrase("'{path}' still names the tree '{name}'", path=users[0], name=name) if users else None


def _make_definition_pattern(name: str) -> re.Pattern[str]:
    """Return the pattern of the start tag that defines a tree."""
    return re.compile(rf"<BehaviorTree\b[^>]*\bID\s*=\s*[\"']{re.escape(name)}[\"']")


def _report_missing_subtrees(pair: FilePair, old: TreeFile, new: TreeFile) -> None:
    """Report the subtrees that the new version runs but defines no longer, and no other file does."""
    for node in (node for tree in new.trees.values() for node in tree.nodes if node.subtree):
        if node.subtree in new.trees or node.subtree not in old.trees or "{" in node.subtree:
            continue
        text = phrase("runs the tree '{name}', which no longer exists", name=node.subtree)
        texts = map(pair.versions.new.text, pair.versions.new.paths((".xml",)))
        if not any(map(_make_definition_pattern(node.subtree).search, texts)):
            pair.add(text, pair.location(node.element.span()), phrase("the behavior tree cannot be loaded"))


def _compare_models(pair: FilePair, old: TreeFile, new: TreeFile) -> None:
    """Report the changes in the descriptions of nodes, which editors and version 4 for defaults read."""
    location = pair.location(new.root.span())
    added = [name for name in new.models if name not in old.models]
    removed = [name for name in old.models if name not in new.models]
    if added:
        pair.add(phrase("descriptions of nodes added: {names}", names=quoted_names(added[:MAX_NAMES])), location)
    if removed:
        pair.add(phrase("descriptions of nodes removed: {names}", names=quoted_names(removed[:MAX_NAMES])), location)
    for name, ports in new.models.items():
        changes = list(_list_value_changes(old.models.get(name, ports), ports))
        if changes:
            pair.add(phrase("description of the node '{name}': {ports}", name=name, ports=joined(changes)), location)


# --- a tree ----------------------------------------------------------------------------------------------------------


def _compare_trees(pair: FilePair, old: Tree, new: Tree, renamed: Mapping[str, str]) -> None:
    """Report the differences between two versions of a tree.

    A node whose subtree was only renamed is the same node.
    """
    for node in old.nodes:
        if node.subtree in renamed:
            node.type = node.type.replace(f"'{node.subtree}'", f"'{renamed[node.subtree]}'")
    matches = match_nodes(old.nodes, new.nodes)
    tree = _format_tree(new)
    matched = set(matches.values())
    for node in _find_topmost(new.nodes, matched):
        inner = [other for other in new.nodes if other not in matched and other is not node and _contains(node, other)]
        around = [child for child in new.nodes if child in matched and _find_unmatched_parent(child, matched) is node]
        text = _format_part(node, inner, around)
        pair.add(phrase("{tree}: added {node}", tree=tree, node=text), pair.location(node.element.span()))
    for node in _find_topmost(old.nodes, matches):
        inner = [other for other in old.nodes if other not in matches and other is not node and _contains(node, other)]
        around = [child for child in old.nodes if child in matches and _find_unmatched_parent(child, matches) is node]
        text = _format_part(node, inner, around)
        location = pair.location(node.element.span(), is_old=True)
        pair.add(phrase("{tree}: removed {node}", tree=tree, node=text), location)
    _report_matches(pair, tree, old, new, matches)


def _report_matches(pair: FilePair, tree: Phrase, old: Tree, new: Tree, matches: Mapping[TreeNode, TreeNode]) -> None:
    """Report other attributes, other parents and another order of nodes that both versions have."""
    matched = frozenset(matches.values())
    children: dict[TreeNode | None, list[TreeNode]] = {}
    for old_node in (node for node in old.nodes if node in matches):
        node = matches[old_node]
        changes = list(_list_value_changes(old_node.values, node.values))
        if changes:
            text = phrase("{tree}: {node}: {changes}", tree=tree, node=node.title, changes=joined(changes))
            pair.add(text, pair.location(node.element.span()))
        old_parent, new_parent = _find_matched_parent(old_node, matches), _find_matched_parent(node, matched)
        if (None if old_parent is None else matches[old_parent]) is new_parent:
            children.setdefault(new_parent, []).append(node)
        else:
            text = phrase("{tree}: {node} moved from {old} to {new}", tree=tree, node=node.title,
                          old=_format_parent(old_parent), new=_format_parent(new_parent))  # fmt: skip
            pair.add(text, pair.location(node.element.span()))
    positions = {node: index for index, node in enumerate(new.nodes)}
    for parent, old_order in children.items():
        new_order = sorted(old_order, key=positions.__getitem__)
        if old_order != new_order:
            text = phrase(
                "{tree}: order in {parent}: {old} -> {new}", tree=tree, parent=_format_parent(parent),
                old=joined(_list_distinct_titles(old_order, new)), new=joined(_list_distinct_titles(new_order, new)),
            )  # fmt: skip
            pair.add(text, pair.location(new_order[0].element.span()))


def _list_distinct_titles(nodes: Sequence[TreeNode], tree: Tree) -> list[str]:
    """Return the titles of nodes, with the first node in each of those that have the same title."""
    titles = [node.title for node in nodes]
    inner = {node: next((child for child in tree.nodes if child.parent is node), None) for node in nodes}
    return [
        f"{title} of {child.title}" if titles.count(title) > 1 and (child := inner[node]) is not None else title
        for node, title in zip(nodes, titles, strict=True)
    ]


def _find_topmost(nodes: Sequence[TreeNode], matched: Collection[TreeNode]) -> list[TreeNode]:
    """Return the unmatched nodes that are in no other unmatched node, or only below a matched one."""
    return [node for node in nodes if node not in matched and (node.parent is None or node.parent in matched)]


def _contains(node: TreeNode, other: TreeNode) -> bool:
    parent = other.parent
    while parent is not None and parent is not node:
        parent = parent.parent
    return parent is node


def _find_unmatched_parent(node: TreeNode, matched: Collection[TreeNode]) -> TreeNode | None:
    """Return the topmost of the unmatched nodes directly around a node; None if its parent is matched."""
    found, parent = None, node.parent
    while parent is not None and parent not in matched:
        found, parent = parent, parent.parent
    return found


def _find_matched_parent(node: TreeNode, matched: Collection[TreeNode]) -> TreeNode | None:
    parent = node.parent
    while parent is not None and parent not in matched:
        parent = parent.parent
    return parent


def _format_parent(parent: TreeNode | None) -> Phrase | str:
    return phrase("the root of the tree") if parent is None else parent.title


def _format_part(node: TreeNode, inner: Sequence[TreeNode], around: Sequence[TreeNode]) -> Phrase | str:
    """Return an added or removed node with its attributes and the nodes in it."""
    values = [f"{name}={value}" for name, value in node.values.items() if name != "name"]
    text: Phrase | str = node.title
    if values:
        text = phrase("{node} ({values})", node=text, values=joined(values))
    if inner:
        text = phrase("{node} with {nodes}", node=text, nodes=_list_types(inner))
    if around:
        text = phrase("{node} around {nodes}", node=text, nodes=_list_types(around))
    if node.parent is not None:
        text = phrase("{node} in {parent}", node=text, parent=node.parent.title)
    return text


def _list_value_changes(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[Phrase]:
    for name in dict.fromkeys([*new, *old]):
        before, after = old.get(name), new.get(name)
        if before is None:
            yield phrase("{name} {value} added", name=name, value=after)
        elif after is None:
            yield phrase("{name} {value} removed", name=name, value=before)
        elif not _are_equal(before, after):
            yield phrase("{name} {old} -> {new}", name=name, old=before, new=after)


def _are_equal(old: str, new: str) -> bool:
    """Return whether two values are equal as texts or as numbers."""
    try:
        return old == new or float(old) == float(new)
    except ValueError:
        return False
