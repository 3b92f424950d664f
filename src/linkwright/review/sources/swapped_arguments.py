"""Find parameters of C++ functions that change places although the types of the parameters stay the same."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import phrase
from linkwright.review.sources.names import NameKind, SourceNames
from linkwright.review.sources.namespaces import HeaderChange


def compare_argument_order(old: SourceNames, new: SourceNames) -> Iterator[HeaderChange]:
    """Yield the public functions of a header whose parameters of equal types have another order.

    Calls with the old order still build.
    """
    spans = {item.name: item.span for item in new.of_kind(NameKind.FUNCTION)}
    for key, after in new.parameter_names.items():
        name, _ = key
        before = old.parameter_names.get(key, ())
        if before == after or "" in before or sorted(before) != sorted(after) or name not in spans:
            continue
        text = phrase(
            "function '{name}': parameters ({old}) -> ({new}) change places",
            name=name,
            old=", ".join(before),
            new=", ".join(after),
        )
        reason = phrase("code that calls '{name}' builds, but passes the values in the old order", name=name)
        yield HeaderChange(text, spans[name], reason)
