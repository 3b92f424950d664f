"""Unsaved texts: their precedence, and the calls of the listeners."""

from __future__ import annotations

import os
from pathlib import Path

from linkwright.descriptions.unsaved import Listener, UnsavedText, UnsavedTexts, UpdateOutcome


class Editor:
    """An editor with unsaved texts."""

    def edit(self, path: str, number: int, text: str) -> None:
        raise NotImplementedError


ONE, TWO = Editor(), Editor()


def real_path(path: str) -> str:
    return os.path.realpath(path)


def texts_of(unsaved: UnsavedTexts) -> dict[str, str]:
    return {path: unsaved_text.text for path, unsaved_text in unsaved.texts.items()}


async def test_newest_unsaved_text_of_two_editors_applies(tmp_path: Path) -> None:
    unsaved, path = UnsavedTexts([]), str(tmp_path / "a.urdf")
    real = real_path(path)
    await unsaved.store(UnsavedText(ONE, path, 1, "first"))
    await unsaved.store(UnsavedText(TWO, path, 1, "second"))
    assert texts_of(unsaved) == {real: "second"}
    await unsaved.store(UnsavedText(ONE, path, 2, "third"))
    assert texts_of(unsaved) == {real: "third"}
    await unsaved.remove(ONE, path)
    assert texts_of(unsaved) == {real: "second"}
    await unsaved.remove_all(TWO)
    assert texts_of(unsaved) == {}


async def test_store_returns_outcome_of_listeners(tmp_path: Path) -> None:
    listeners: list[Listener] = []
    unsaved, path = UnsavedTexts(listeners), str(tmp_path / "a.urdf")
    assert await unsaved.store(UnsavedText(ONE, path, 1, "")) == "elsewhere"
    paths: list[str] = []

    def listener(outcome: UpdateOutcome) -> None:
        async def listen(real_path: str) -> UpdateOutcome:
            paths.append(real_path)
            return outcome

        listeners.append(listen)

    listener("elsewhere")
    listener("shown")
    assert await unsaved.store(UnsavedText(ONE, path, 2, "")) == "shown"
    listener("errors")
    assert await unsaved.remove(ONE, path) == "errors"
    assert await unsaved.remove(ONE, path) == "elsewhere"  # the text was removed before
    assert paths == [real_path(path)] * 5
