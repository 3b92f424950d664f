"""Names of `linkwright.loading.lean_typing`, compared with those of `typing`."""

from __future__ import annotations

import typing
from collections.abc import Callable
from typing import Any

import pytest

from linkwright.loading import lean_typing


@pytest.mark.parametrize("library", [typing, lean_typing])
def test_lean_typing_names_support_subclassing_subscripts_and_unions(library: Any) -> None:
    kind = library.TypeVar("kind", bound=str)
    other = library.TypeVar("other", int, str)

    class Named(library.Protocol):
        name: str

    class Kept(library.Generic[kind, other]):
        def __init__(self, value: Any) -> None:
            self.value = value

    class Box(Kept[str, int], Named):
        name = "box"

    assert Kept[str, int](7).value == Box(7).value == 7
    assert issubclass(Box, Kept)
    assert library.get_args(library.Literal["a", "b"]) == ("a", "b")
    assert Callable[[library.Any], None]
    assert dict[str, library.Any]
    assert library.cast("int", "text") == "text"
    assert library.Union[str, None]
    assert library.Any | None
    assert not library.TYPE_CHECKING


def test_lean_typing_exports_only_typing_names() -> None:
    assert all(hasattr(typing, name) and hasattr(lean_typing, name) for name in lean_typing.__all__)
