"""Find the names and attributes that a changed Python source uses although nothing defines them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.sources.names import SourceNames


class UndefinedUse(NamedTuple):
    """A use of an undefined name, with the text of its line, its location and the reason why it is breaking.

    The reason is None in an added source, which no program used before.
    """

    text: Phrase
    span: Span
    reason: Phrase | None


def find_undefined_uses(
    old: SourceNames, new: SourceNames, is_defined: Callable[[str, str], bool], *, is_added: bool
) -> Iterator[UndefinedUse]:
    """Yield the undefined names, attributes and methods that only the new version of a source uses.

    If the old version used undefined ones, something unknown may define them, so new ones are not certain.

    Args:
        old: the names in the old source.
        new: the names in the new source.
        is_defined: whether another source may define an attribute, by the name of the class that uses it and its name.
        is_added: whether only the new version has the source.
    """
    for name, span in new.undefined_names.items():
        reason = phrase("the code that uses the name fails")
        if name in old.undefined_names:
            continue
        if name in old.bound_names - new.bound_names:
            yield UndefinedUse(phrase("uses '{name}', which it no longer defines or imports", name=name), span, reason)
        elif is_added or (old.bound_names and not old.undefined_names):
            text = phrase("uses '{name}', which nothing defines", name=name)
            yield UndefinedUse(text, span, None if is_added else reason)
    for name, use in new.undefined_attributes.items() if not is_added and old.bound_names else ():
        is_lost = name in old.attributes
        is_certain = is_lost or not (name.startswith("_") or old.undefined_attributes)  # a base class may have it
        if not is_certain or is_defined(use.class_name, name):
            continue
        if use.is_call:
            lost = phrase("calls its method '{name}', which is no longer defined", name=name)
            text = lost if is_lost else phrase("calls its method '{name}', which nothing defines", name=name)
            yield UndefinedUse(text, use.span, phrase("the call fails"))
        else:
            lost = phrase("uses its attribute '{name}', which is no longer defined", name=name)
            text = lost if is_lost else phrase("uses its attribute '{name}', which nothing defines", name=name)
            yield UndefinedUse(text, use.span, phrase("the access fails"))
