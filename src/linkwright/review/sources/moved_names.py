"""Find the topics, services and actions that move from one node to another one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources, get_comparison_name
from linkwright.review.sources.details import format_names
from linkwright.review.sources.names import SourceName
from linkwright.review.sources.other_nodes import are_connected


def find_moved_names(
    items: Sequence[SourceName], old: ChangedSources, new: ChangedSources, file: ChangedFile
) -> Iterator[tuple[Phrase, SourceName]]:
    """Yield a line for each node to which names of a source move, with the first of the names.

    Only one changed source has the name in each version, both make a node, and neither uses the other one.

    Args:
        items: names of one kind that the source no longer has, but that the new version has.
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        file: the source.
    """
    if not items or items[0].kind not in COMMUNICATION_KINDS or file.old_path is None or file.new_path is None:
        return
    moved: dict[str, list[SourceName]] = {}
    for item in items:
        owners = _list_owners(item, new)
        is_only = len(owners) == 1 and _list_owners(item, old) == [file.old_path]
        is_of_node = is_only and old.get_names(file.old_path).makes_node and new.get_names(owners[0]).makes_node
        if is_of_node and not are_connected(new, file.new_path, owners[0]):
            moved.setdefault(owners[0], []).append(item)
    for path, names in moved.items():
        kind = names[0].kind
        title = kind.title if len(names) == 1 else kind.plural
        yield phrase("{kind} moved to '{file}': {names}", kind=title, file=path, names=format_names(names)), names[0]


def _list_owners(item: SourceName, sources: ChangedSources) -> list[str]:
    """Return the paths of the changed sources that have a name."""
    key = get_comparison_name(item)
    return [
        path
        for path in sources.paths
        if any(get_comparison_name(known) == key for known in sources.get_names(path).of_kind(item.kind))
    ]
