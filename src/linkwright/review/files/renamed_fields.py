"""Find the renamed fields and constants of an interface."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher

from linkwright.messages.definitions.interfaces import Constant, Field


def find_renamed_fields(old: Sequence[Field], new: Sequence[Field]) -> list[tuple[Field, Field]]:
    """Return the pairs of the old and new definition of each renamed field.

    A renamed field has the same type and the same place among the other fields.
    """
    names = [field.name for field in old], [field.name for field in new]
    matcher = SequenceMatcher(None, *names, autojunk=False)
    return [
        (before, after)
        for kind, old_start, old_end, new_start, new_end in matcher.get_opcodes()
        if kind == "replace" and old_end - old_start == new_end - new_start
        for before, after in zip(old[old_start:old_end], new[new_start:new_end], strict=True)
        if before.type == after.type and before.name not in names[1] and after.name not in names[0]
    ]


def find_renamed_constants(old: Sequence[Constant], new: Sequence[Constant]) -> list[tuple[Constant, Constant]]:
    """Return the pairs of the old and new definition of each renamed constant.

    A renamed constant has the same type and value, and no other constant of one version alone has them.
    """
    removed, added = (
        [constant for constant in own if all(constant.name != item.name for item in other)]
        for own, other in ((old, new), (new, old))
    )
    pairs = []
    for constant in removed:
        matching = [
            [item for item in items if (item.type, item.value) == (constant.type, constant.value)]
            for items in (removed, added)
        ]
        if len(matching[0]) == len(matching[1]) == 1:
            pairs.append((constant, matching[1][0]))
    return pairs
