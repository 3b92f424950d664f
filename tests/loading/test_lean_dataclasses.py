"""Classes of `linkwright.loading.lean_dataclasses`, compared with those of `dataclasses`."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import subprocess
import sys
from typing import Any, ClassVar, NamedTuple, get_type_hints

import pytest

from linkwright.loading import lean_dataclasses

KINDS = [{"frozen": frozen, "slots": slots, "eq": eq} for frozen in (0, 1) for slots in (0, 1) for eq in (0, 1)]


def classes(library: Any, options: dict[str, int]) -> dict[str, Any]:
    """Return equal classes from one of the two libraries."""
    dataclass, field = library.dataclass, library.field
    options = {name: bool(value) for name, value in options.items()}

    @dataclass(**options)
    class Point:
        shared: ClassVar[int] = 7
        x: float
        y: float = 2.0

        @property
        def sum(self) -> float:
            return self.x + self.y

    @dataclass(**options)
    class Path:
        points: list[Point] = field(default_factory=list)
        place: object = field(default=None, compare=False, repr=False)
        count: int = field(init=False, repr=False)

        def __post_init__(self) -> None:
            object.__setattr__(self, "count", len(self.points))

    @dataclass(**options)
    class Named(Point):
        name: str = "origin"

        def __repr__(self) -> str:
            return f"<{self.name}>"

    class Derived(Point):
        pass

    @dataclass(**options)
    class Nothing:
        pass

    return {cls.__name__: cls for cls in (Point, Path, Named, Derived, Nothing)}


def observe_behavior(library: Any, options: dict[str, int]) -> list[object]:
    """Return the results of operations on objects of the classes."""
    class_by_name = classes(library, options)
    point, path, named, empty_class = (class_by_name[name] for name in ("Point", "Path", "Named", "Nothing"))
    objects = [point(1), point(1.0, y=2), point(3, 4), path(), path([point(1)], place="here"), named(1, 2, "tip")]
    objects += [class_by_name["Derived"](1), empty_class()]
    results: list[object] = [*map(repr, objects), [[first == other for other in objects] for first in objects]]
    for instance in objects:
        results.append(dataclasses.asdict(instance))
        results.append(repr(library.replace(instance)))
        results.append(repr(dataclasses.replace(instance)))
        results.append(repr(copy.deepcopy(instance)))
        results.append([(field.name, field.init, field.repr, field.compare) for field in dataclasses.fields(instance)])
        results += [outcome(lambda instance=instance: hash(instance) == hash(copy.copy(instance)))]
        copied = copy.copy(instance)
        if isinstance(instance, (class_by_name["Derived"], empty_class)):
            continue  # `dataclasses` raises a TypeError about super() here
        results += [
            outcome(lambda copied=copied: setattr(copied, copied.__match_args__[0], 5)),
            outcome(lambda copied=copied: delattr(copied, copied.__match_args__[0])),
        ]
        results.append(outcome(lambda copied=copied: setattr(copied, "new", 5)) is None)
        results += [hasattr(instance, "__dict__"), type(instance).__match_args__]
    results += [point.shared, objects[1].sum, repr(library.replace(objects[2], x=0)), vars(point).get("y") == 2.0]
    results += [outcome(point), outcome(lambda: point(1, 2, 3)), outcome(lambda: point(1, z=3))]
    results += [path().points is path().points, outcome(lambda: library.replace(path(), count=3))[1]]
    results += [outcome(lambda: library.replace(point(1), z=3))]
    return results


def outcome(call: Any) -> Any:
    """Return the result of a call, or its exception."""
    try:
        return call()
    except (AttributeError, TypeError, ValueError) as error:
        return type(error).__name__, str(error).partition("(")[0]


@pytest.mark.parametrize("options", KINDS)
def test_lean_dataclass_behaves_like_dataclass(options):
    assert observe_behavior(lean_dataclasses, options) == observe_behavior(dataclasses, options)


@lean_dataclasses.dataclass(frozen=True, slots=True)
class Kept:
    """A class that can be found by its name."""

    x: int
    others: tuple[int, ...] = ()


def test_frozen_slots_dataclass_can_be_pickled():
    assert pickle.loads(pickle.dumps(Kept(1, (2,)))) == Kept(1, (2,))


def test_class_is_restored_after_exception_in_default_factory():
    @lean_dataclasses.dataclass(frozen=True, slots=True)
    class Fragile:
        x: int = 0
        parts: list[int] = lean_dataclasses.field(default_factory=lambda: next(iter(())))

    with pytest.raises(StopIteration):
        Fragile()
    assert Fragile(1, [2]).parts == [2]


def test_dataclass_can_derive_from_lean_dataclass():
    @dataclasses.dataclass(frozen=True)
    class More(Kept):
        y: int = 3

    assert repr(More(1, (), 4)).endswith("More(x=1, others=(), y=4)")
    assert More(1) == More(1, y=3)


class Leaned(lean_dataclasses.NamedTuple):
    """A named tuple."""

    x: int
    others: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return len(self.others)


class Usual(NamedTuple):
    """A named tuple."""

    x: int
    others: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return len(self.others)


class Below(Leaned):
    """An ordinary class."""

    more = 1


def test_lean_named_tuple_matches_typing():
    for name in ("_fields", "_field_defaults", "__doc__", "__module__", "__bases__"):
        assert getattr(Leaned, name) == getattr(Usual, name), name
    assert get_type_hints(Leaned) == get_type_hints(Usual)
    assert repr(Leaned(1)) == repr(Usual(1)).replace("Usual", "Leaned")
    assert Leaned(1, (2, 3)).count == 2
    assert Leaned(1) == (1, ()) == pickle.loads(pickle.dumps(Leaned(1)))
    assert Leaned(1)._replace(x=2)._asdict() == {"x": 2, "others": ()}
    assert Below(1).more == 1
    with pytest.raises(AttributeError):
        Leaned(1).x = 2
    with pytest.raises(TypeError):
        Leaned()


def test_lean_dataclass_does_not_import_dataclasses():
    code = (
        "from __future__ import annotations\nimport sys\nfrom linkwright.loading.lean_dataclasses import dataclass\n"
        "@dataclass(frozen=True, slots=True)\nclass Point:\n    x: int\n"
        "print(Point(1), 'dataclasses' in sys.modules, 'inspect' in sys.modules)"
    )
    result = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert result.stdout == "Point(x=1) False False\n"
