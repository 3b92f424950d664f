"""Find the topics, services, actions and parameters that move from one node to another one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources, get_comparison_name
from linkwright.review.sources.details import format_names
from linkwright.review.sources.names import NameKind, SourceName
from linkwright.review.sources.other_nodes import are_connected


def find_moved_names(
    items: Sequence[SourceName], old: ChangedSources, new: ChangedSources, file: ChangedFile
) -> Iterator[tuple[Phrase, SourceName, Phrase | None]]:
    """Yield a line for each node to which names of a source move, with the first of the names and a reason.

    Only one changed source has the name in each version, both make a node, and neither uses the other one. A parameter
    may move to a new node that its source uses: files give the values of parameters to a node by its name.

    Args:
        items: names of one kind that the source no longer has, but that the new version has.
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        file: the source.
    """
    kind = items[0].kind if items else None
    if kind not in (*COMMUNICATION_KINDS, NameKind.PARAMETER) or file.old_path is None or file.new_path is None:
        return
    moved: dict[str, list[SourceName]] = {}
    for item in items:
        owners = _list_owners(item, new)
        is_only = len(owners) == 1 and _list_owners(item, old) == [file.old_path]
        is_of_node = is_only and old.get_names(file.old_path).makes_node and new.get_names(owners[0]).makes_node
        if kind is NameKind.PARAMETER:
            is_moved = is_of_node and _is_new_node(old, new, file.old_path, file.new_path, owners[0])
        else:
            is_moved = is_of_node and not are_connected(new, file.new_path, owners[0])
        if is_moved:
            moved.setdefault(owners[0], []).append(item)
    for path, names in moved.items():
        title = names[0].kind.title if len(names) == 1 else names[0].kind.plural
        text = phrase("{kind} moved to '{file}': {names}", kind=title, file=path, names=format_names(names))
        reason = phrase("values that parameter files give to the old node have no effect")
        yield text, names[0], reason if kind is NameKind.PARAMETER else None


def _is_new_node(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str, owner: str) -> bool:
    """Return whether a source makes nodes that no changed source made before, while another one still makes its own."""
    nodes = {item.name for item in new.get_names(owner).of_kind(NameKind.NODE)}
    known = {item.name for path in old.paths for item in old.get_names(path).of_kind(NameKind.NODE)}
    own = [
        {item.name for item in sources.get_names(path).of_kind(NameKind.NODE)}
        for sources, path in ((old, old_path), (new, new_path))
    ]
    return bool(nodes) and nodes.isdisjoint(known) and bool(own[0]) and own[0] == own[1]


def _list_owners(item: SourceName, sources: ChangedSources) -> list[str]:
    """Return the paths of the changed sources that have a name."""
    key = get_comparison_name(item)
    return [
        path
        for path in sources.paths
        if any(get_comparison_name(known) == key for known in sources.get_names(path).of_kind(item.kind))
    ]
