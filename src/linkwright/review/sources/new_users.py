"""Find topics and services that a source stops offering while another one begins to use them: a third offers them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.names import NameKind, SourceName

_OFFERED_KINDS = (NameKind.PUBLISHER, NameKind.SERVICE, NameKind.ACTION)


def describe_new_user(
    text: Phrase, items: Sequence[SourceName], old: ChangedSources, new: ChangedSources, path: str
) -> Phrase | None:
    """Return the line about removed names that another source of the package begins to use; None for other names.

    The new user, which had another source before, gets them from a program of another package, for example.

    Args:
        text: the line about the removed names.
        items: the removed names.
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        path: the path of the source that offered them.
    """
    users: set[str] = set()
    for item in items:
        used = new.list_changed_users(item, path) if item.kind in _OFFERED_KINDS else []
        found = {user for user in used if user != path and old.lacks_use(item, user)}
        if not found:
            return None
        users |= found
    file = PurePosixPath(min(users)).name
    if items[0].kind is NameKind.PUBLISHER:
        return phrase("{change}; '{file}' newly subscribes to it", change=text, file=file)
    return phrase("{change}; '{file}' newly calls it", change=text, file=file)
