"""Find the parameters of ROS 1 whose namespace changes."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.review.sources.names import NameKind, SourceName, SourceNames


def find_scoped(
    before: Mapping[str, SourceName], after: Mapping[str, SourceName], old_names: SourceNames, new_names: SourceNames
) -> list[tuple[SourceName, SourceName]]:
    """Return the parameters of ROS 1 that become private, or no longer are, each in both versions.

    Args:
        before: the parameters of the old source by the names that are compared.
        after: the parameters of the new source by the names that are compared.
        old_names: the names in the old source.
        new_names: the names in the new source.
    """
    unknown = old_names.unknown_scopes | new_names.unknown_scopes
    known = [{item.name.lstrip("/") for item in names.of_kind(NameKind.PARAMETER)} for names in (old_names, new_names)]
    return [
        (before[name], item)
        for name, item in after.items()
        if name in before
        and name not in unknown
        and before[name].name.startswith("~") != item.name.startswith("~")
        and before[name].name.lstrip("/") not in known[1]
        and item.name.lstrip("/") not in known[0]
    ]
