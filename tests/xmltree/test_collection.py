"""The number of garbage collections during the construction of a tree."""

from __future__ import annotations

import gc
from types import SimpleNamespace

import pytest

from linkwright.xmltree import nodes as collection
from linkwright.xmltree.nodes import seldom_collected


@pytest.fixture
def fake_gc(monkeypatch):
    """Return the calls to a garbage collector of the test, with a number of frozen objects."""
    calls: list[object] = []
    settings = SimpleNamespace(frozen=0, counts=0, threshold=(700, 10, 10))

    def set_threshold(*values):
        settings.threshold = values
        calls.append(values)

    def count_frozen_objects():
        settings.counts += 1
        return settings.frozen

    stand_in = SimpleNamespace(
        get_threshold=lambda: settings.threshold,
        set_threshold=set_threshold,
        get_freeze_count=count_frozen_objects,
        freeze=lambda: calls.append("freeze"),
        unfreeze=lambda: calls.append("unfreeze"),
    )
    monkeypatch.setattr(collection, "gc", stand_in)
    monkeypatch.setattr(collection, "_were_frozen", False)
    return SimpleNamespace(calls=calls, settings=settings)


def test_outermost_context_freezes_new_objects_at_end(fake_gc):
    with seldom_collected(), seldom_collected():
        assert fake_gc.calls == [(50_000, 10, 10)]
    assert fake_gc.calls == [(50_000, 10, 10), "freeze", "unfreeze", (700, 10, 10)]


def test_frozen_objects_stay_frozen(fake_gc):
    fake_gc.settings.frozen = 3
    with seldom_collected():
        pass
    assert fake_gc.calls == [(50_000, 10, 10), (700, 10, 10)]


def test_frozen_objects_are_counted_once(fake_gc):
    fake_gc.settings.frozen = 3
    for _ in range(2):
        with seldom_collected():
            pass
    assert fake_gc.settings.counts == 1


@pytest.mark.parametrize("first", [0, 60_000])
def test_disabled_or_rare_collection_is_unchanged(fake_gc, first):
    fake_gc.settings.threshold = (first, 10, 10)
    with seldom_collected():
        assert fake_gc.settings.threshold == (first, 10, 10)
    assert fake_gc.settings.threshold == (first, 10, 10)


def test_exception_restores_collection_threshold():
    before = gc.get_threshold()
    with pytest.raises(ZeroDivisionError), seldom_collected():
        1 / (gc.get_threshold() == before)
    assert gc.get_threshold() == before
