"""The cache of documents: its bound, and the entries that it replaces."""

from __future__ import annotations

from linkwright.xacro import cache, expand
from linkwright.xacro.cache import BoundedCache


def test_cache_size_stays_below_bound() -> None:
    cache: BoundedCache[int, str] = BoundedCache(100, lambda _, text: len(text))
    for number in range(1000):
        cache.store(number, "x" * (number % 7))
        assert sum(map(len, cache.values.values())) <= 100
        assert number in cache.values


def test_cyclic_access_beyond_capacity_has_hits() -> None:
    cache: BoundedCache[int, int] = BoundedCache(100, lambda *_: 1)
    hits = 0
    for _ in range(10):
        for number in range(150):
            hits += number in cache.values
            if number not in cache.values:
                cache.store(number, number)
    assert hits > 9 * 50


def test_replaced_entry_is_counted_once() -> None:
    cache: BoundedCache[str, int] = BoundedCache(100, lambda _, size: size)
    cache.store("first", 40)
    for _ in range(50):
        cache.store("edited", 50)
    assert cache.values == {"first": 40, "edited": 50}


def test_divisor_reduces_cache_bound(monkeypatch) -> None:
    monkeypatch.setattr(BoundedCache, "divisor", 8)
    cache: BoundedCache[int, str] = BoundedCache(800, lambda _, text: len(text))
    for number in range(1000):
        cache.store(number, "x" * (number % 7))
    assert 50 < sum(map(len, cache.values.values())) <= 100


def test_document_cache_holds_600_files(tmp_path) -> None:
    for number in range(600):
        (tmp_path / f"{number}.urdf").write_text(f'<robot name="r{number}"><link name="base"/></robot>')
    robots = [tmp_path / f"{number}.urdf" for number in range(600)]
    for robot in robots:
        expand(robot)
    assert {str(robot) for robot in robots} <= {path for path, _ in cache.documents.values}
