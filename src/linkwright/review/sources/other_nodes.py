"""Find names that a node loses or gets although another node of its package has the same names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import quote_first
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources, imports
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.sources.separate_programs import are_in_separate_programs

_CLIENT_KINDS = (NameKind.CLIENT, NameKind.ACTION_CLIENT)
_KINDS = (*COMMUNICATION_KINDS, NameKind.PARAMETER)


def has_only_in_other_nodes(
    item: SourceName, side: ChangedSources, other: ChangedSources, paths: Sequence[str]
) -> bool:
    """Return whether the package has a name in both versions only in sources of other nodes.

    Such a name did not move. Sources that one of the files includes or imports, or that include it, are of the same
    node. Of parameters, and of an added source, sources count as other nodes, too, if no program is built of both.

    Args:
        item: a name that only the other version of a source has.
        side: the sources of the version that lacks the name.
        other: the sources of the version that has the name.
        paths: the paths of the source in `side` and in `other`.
    """
    return item.kind in _KINDS and (
        _has_only_elsewhere(item, side, other, paths, lambda names: names.makes_node)
        or (
            (item.kind is NameKind.PARAMETER or paths[0] not in side.paths)
            and _has_only_in_other_programs(item, side, other, paths)
        )
    )


def _has_only_in_other_programs(
    item: SourceName, side: ChangedSources, other: ChangedSources, paths: Sequence[str]
) -> bool:
    """Return whether only sources of other programs of the package have a name, in both versions."""
    owners = side.list_owners(item, paths[0]).keys()
    sources, path = (side, paths[0]) if paths[0] in side.paths else (other, paths[1])
    package = sources.find_package(path)
    return (
        package is not None
        and bool(owners)
        and owners <= other.list_owners(item, paths[1]).keys()
        and not any(are_connected(sources, path, owner) for owner in owners)
        and are_in_separate_programs(sources.version, package, path, owners)
    )


def is_new_in_plugin(item: SourceName, old: ChangedSources, new: ChangedSources, paths: Sequence[str]) -> bool:
    """Return whether a plugin newly has a parameter that only other plugins and nodes of its package had before.

    The names of such parameters are often in the namespace of each plugin.

    Args:
        item: a parameter that only the new version of a source has.
        old: the sources of the old version.
        new: the sources of the new version.
        paths: the paths of the source in both versions.
    """
    return item.kind is NameKind.PARAMETER and _has_only_elsewhere(item, old, new, paths, _is_complete)


def _is_complete(names: SourceNames) -> bool:
    """Return whether a source makes a node or exports a plugin."""
    return names.makes_node or any(True for _ in names.of_kind(NameKind.PLUGINLIB_CLASS))


def _has_only_elsewhere(
    item: SourceName,
    side: ChangedSources,
    other: ChangedSources,
    paths: Sequence[str],
    is_separate: Callable[[SourceNames], bool],
) -> bool:
    """Return whether only separate sources of the package have a name, in both versions."""
    if not all(is_separate(sources.get_names(path)) for sources, path in zip((side, other), paths, strict=True)):
        return False
    owners = side.list_owners(item, paths[0])
    return (
        bool(owners)
        and all(is_separate(names) and not are_connected(side, paths[0], owner) for owner, names in owners.items())
        and owners.keys() <= other.list_owners(item, paths[1]).keys()
    )


def find_other_node_reason(items: Sequence[SourceName]) -> Phrase | None:
    """Return the reason why a node that loses names is breaking, though other nodes have them; None for clients."""
    if items[0].kind in _CLIENT_KINDS:
        return None
    names = quote_first(item.name for item in items)
    if items[0].kind is NameKind.PARAMETER:
        return phrase("values of {names} for this node have no effect", names=names)
    return phrase("this node no longer has {names}; only another node of the package still has it", names=names)


def are_connected(sources: ChangedSources, path: str, other: str) -> bool:
    """Return whether one of two files includes or imports the other one or its header."""
    stems = PurePosixPath(path).stem, PurePosixPath(other).stem
    return stems[0] == stems[1] or any(
        imports(sources.version.text(file), stem) for stem, file in zip(stems, (other, path), strict=True)
    )
