"""The order of the files of a test run."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

from tests.order import spread, spread_waiting_files


def test_few_are_spread_over_many_in_their_order():
    assert spread([1, 2, 3, 4, 5, 6], ["a", "b"]) == [1, 2, "a", 3, 4, 5, "b", 6]
    assert spread([1, 2], []) == [1, 2]
    assert spread([], ["a", "b"]) == ["a", "b"]


def test_files_of_waiting_rooms_are_not_neighbors():
    names = ["bag/test_a.py", "browser/test_b.py", "browser/test_c.py", "cli/test_d.py", "learning/x/test_e.py"]
    names += [f"xacro/test_{letter}.py" for letter in "fghijk"]
    items = [SimpleNamespace(path=Path("/tests", name), number=number) for name in names for number in range(2)]
    spread_items = spread_waiting_files(items, Path("/tests"))
    order = [item.path.relative_to("/tests").as_posix() for item in spread_items[::2]]
    assert sorted(order) == sorted(names)
    rooms = [name.partition("/")[0] for name in order]
    waits = [room in ("browser", "learning") for room in rooms]
    assert (True, True) not in pairwise(waits)
    assert [item.path for item in spread_items[::2]] == [item.path for item in spread_items[1::2]]
    assert [item.number for item in spread_items] == [0, 1] * len(names)
