"""Measure expansion: real robots in this process, whole commands, and memory, compared with PyPI's xacro.

Run it with ``python -m benchmarks xacro``. The robots are those of the corpus, where it is beside the repository, else
robots made for this. The environment variable LINKWRIGHT_ROBOTS names a folder with further descriptions, which are all
expanded in one process, and then again. "Cold" forgets at the beginning of each pass, or of each single model,
everything that was kept from earlier ones; within a pass over all models a file is read once.
"""

from __future__ import annotations

import gc
import io
import os
import statistics
import sys
import tempfile
import time
import types
from collections.abc import Callable
from contextlib import redirect_stderr
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import LINKWRIGHT, Row, commands, peak_memory, show, side_by_side
from benchmarks.robots import SHIPPED, Model, collected, models
from linkwright.xacro import cache, expand, macros
from linkwright.xacro.expressions import expression, scope, template, yaml_conversion, yaml_data

SMALL = SHIPPED / "urdf" / "mbot_base.xacro"
PASSES = 7
SINGLES = 9
STARTS = 11
LARGEST = 4
COLLECTION_PASSES = 3
_FOUND = "found_description"
_FINDING = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="a"><visual><geometry><mesh filename="$(find {_FOUND})/a.stl"/></geometry></visual></link>
</robot>"""
FEWEST_LINES = 15
"""The minimum number of lines of a robot. A shorter file contains only macros."""
PEER = "xacro"

Engine = Callable[[Model], object]


def ours(model: Model) -> object:
    """Expand a model with this project."""
    return str(expand(model.path, model.arguments, packages=model.packages))


def theirs() -> Engine | None:
    """Return the engine of PyPI's xacro, or None if it is not installed."""
    xacro = peers.load(PEER)
    if xacro is None:
        return None
    packages: dict[str, str] = {}
    index = types.ModuleType("ament_index_python.packages")
    index.get_package_share_directory = packages.__getitem__  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = index

    def run(model: Model) -> object:
        packages.clear()
        packages.update(model.packages)
        with redirect_stderr(io.StringIO()):
            return xacro.process_file(model.path, mappings=dict(model.arguments)).toprettyxml(indent="  ")

    return run


def forget() -> None:
    """Clear all caches of earlier expansions."""
    for values in (
        cache.documents.values,
        template.templates,
        expression.expressions,
        yaml_data.cache.values,
        yaml_conversion.tags,
    ):
        values.clear()
    macros.parse_parameters.cache_clear()
    scope.parse_number_or_boolean.cache_clear()
    gc.collect()


def one_pass(engine: Engine, robots: list[Model]) -> None:
    """Expand all robots once."""
    for model in robots:
        engine(model)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    with tempfile.TemporaryDirectory() as folder:
        robots = models(Path(folder))
        other = theirs()
        largest = _largest(robots, other or ours)
        table = _in_process(robots, largest, other)
        return table + _collection(other) + _whole_commands(largest[0], Path(folder))


def _collection(other: Engine | None) -> list[Row]:
    """Measure the processor time of the descriptions of LINKWRIGHT_ROBOTS that both programs expand, twice."""
    folder = os.environ.get("LINKWRIGHT_ROBOTS")
    if not folder:
        return []
    robots = [model for model in collected(Path(folder)) if _expands(ours, model) and _expands(other or ours, model)]
    engines: dict[str, Engine] = {"ours": ours, **({} if other is None else {PEER: other})}
    first: dict[str, list[float]] = {name: [] for name in engines}
    again: dict[str, list[float]] = {name: [] for name in engines}
    for _ in range(COLLECTION_PASSES):
        for name, engine in engines.items():
            forget()
            for times in (first[name], again[name]):
                begin = time.process_time()
                one_pass(engine, robots)
                times.append(time.process_time() - begin)
    what = f"{len(robots)} public descriptions, processor time"
    return [
        _row(
            f"{what}, first pass",
            {name: statistics.median(seconds) for name, seconds in first.items()},
            "a tenth of xacro's",
        ),
        _row(
            f"{what}, again",
            {name: statistics.median(seconds) for name, seconds in again.items()},
            "a twentieth of xacro's",
        ),
    ]


def _expands(engine: Engine, model: Model) -> bool:
    try:
        return len(str(engine(model)).splitlines()) > FEWEST_LINES
    except (Exception, SystemExit):  # noqa: BLE001 - xacro fails in any way
        return False


def _in_process(robots: list[Model], largest: list[Model], other: Engine | None) -> list[Row]:
    def calls(chosen: list[Model]) -> dict[str, Callable[[], None] | None]:
        peer = None if other is None else lambda: one_pass(other, chosen)
        return {"ours": lambda: one_pass(ours, chosen), PEER: peer}

    count = f"{len(robots)} models"
    cold = side_by_side(calls(robots), PASSES, before=forget)
    warm = side_by_side(calls(robots), PASSES)
    table = [
        _row(f"{count}, cold at the start of each pass", cold, "5 times faster, towards 10"),
        _row(f"{count}, files and texts known", warm, ""),
    ]
    for model in largest:
        times = side_by_side(calls([model]), SINGLES, before=forget)
        table.append(_row(f"{model.name}, cold", times, "5 times faster"))
    return table


def _row(what: str, seconds: dict[str, float], target: str) -> Row:
    other = seconds.get(PEER)
    return Row(what, seconds["ours"] * 1e3, "ms", target, {PEER: None if other is None else other * 1e3})


def _largest(robots: list[Model], engine: Engine) -> list[Model]:
    """Return the slowest models, one for each file."""
    times = {model.name: side_by_side({"": lambda model=model: engine(model)}, 1)[""] for model in robots}
    chosen: dict[str, Model] = {}
    for model in sorted(robots, key=lambda model: -times[model.name]):
        chosen.setdefault(model.path, model)
    return list(chosen.values())[:LARGEST]


def _whole_commands(large: Model, folder: Path) -> list[Row]:
    prefix, stand_in = _prefix(large, folder), _ament_index(folder)
    (prefix / "share" / _FOUND).mkdir()
    (prefix / "share" / "ament_index" / "resource_index" / "packages" / _FOUND).touch()
    environment = {"AMENT_PREFIX_PATH": str(prefix), "PYTHONPATH": str(stand_in)}
    peer = peers.command(PEER)
    values = [f"{name}:={value}" for name, value in large.arguments.items()]
    table = []
    for what, words, target in (
        (f"command, small model ({SMALL.name})", [str(SMALL)], "60 ms over a bare interpreter"),
        (f"command, large model ({large.name})", [large.path, *values], "half of xacro's"),
        ("command, file without content", [str(_written(folder, "empty", "<robot/>"))], "no slower than xacro"),
        ("command, file with $(find)", [str(_written(folder, "find", _FINDING))], "no slower than xacro"),
    ):
        calls = {
            "ours": [LINKWRIGHT, "xacro", *words],
            PEER: [peer, *words] if peer else None,
            "bare interpreter": [sys.executable, "-c", "pass"],
        }
        times = commands(calls, STARTS, **environment)
        others = {name: times[name] * 1e3 if name in times else None for name in (PEER, "bare interpreter")}
        table.append(Row(what, times["ours"] * 1e3, "ms", target, others))
        peaks = {name: peak_memory(words, **environment) if words else None for name, words in calls.items()}
        mine = peaks.pop("ours")
        assert mine is not None
        table.append(Row(what.replace("command", "memory"), mine, "MB", "at most twice xacro's", peaks))
    return table


def _written(folder: Path, name: str, text: str) -> Path:
    path = folder / f"{name}.xacro"
    path.write_text(text, encoding="utf-8")
    return path


def _prefix(model: Model, folder: Path) -> Path:
    """Create an install prefix with the packages of a model, for both programs."""
    prefix = folder / "prefix"
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    for name, place in model.packages.items():
        (index / name).touch()
        (prefix / "share" / name).symlink_to(place)
    return prefix


def _ament_index(folder: Path) -> Path:
    """Create a simple replacement of ament_index_python, with which PyPI's xacro finds share folders."""
    package = folder / "stand_in" / "ament_index_python"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "packages.py").write_text(_INDEX, encoding="utf-8")
    return package.parent


_INDEX = """
import os

def get_package_share_directory(name):
    return os.path.join(os.environ["AMENT_PREFIX_PATH"], "share", name)
"""


def main() -> None:
    """Measure and print."""
    os.environ.pop("AMENT_PREFIX_PATH", None)
    show(rows())


if __name__ == "__main__":
    main()
