"""Measure expansion in this process and by commands, compared with PyPI's xacro.

Run it with ``python -m benchmarks xacro``. The robots are those of the corpus, if it is next to the repository, or else
generated ones. The environment variable LINKWRIGHT_ROBOTS names a folder with further descriptions, all of which are
expanded twice in one process. "Cold" means that all caches are cleared before each pass or each single model; within a
pass over all models, a file is read once.
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
from benchmarks.measure import LINKWRIGHT, Row, measure_commands, measure_peak_memory, measure_side_by_side, show
from benchmarks.robots import SHIPPED, Model, collect_models, find_models
from linkwright.xacro import cache, expand, macros
from linkwright.xacro.expressions import expression, scope, template, yaml_conversion, yaml_data

SMALL = SHIPPED / "urdf" / "mbot_base.xacro"
PASS_COUNT = 7
SINGLE_COUNT = 9
START_COUNT = 11
LARGEST_COUNT = 4
COLLECTION_PASSES = 3
_FOUND = "found_description"
_FINDING = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="a"><visual><geometry><mesh filename="$(find {_FOUND})/a.stl"/></geometry></visual></link>
</robot>"""
FEWEST_LINES = 15
"""The minimum number of lines of a robot. A shorter file contains only macros."""
PEER = "xacro"

Engine = Callable[[Model], object]


def expand_model(model: Model) -> object:
    """Expand a model with this project."""
    return str(expand(model.path, model.arguments, packages=model.packages))


def load_peer() -> Engine | None:
    """Return the engine of PyPI's xacro, or None if it is not installed."""
    xacro = peers.load_module(PEER)
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


def clear_caches() -> None:
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


def expand_all(engine: Engine, robots: list[Model]) -> None:
    """Expand all robots once."""
    for model in robots:
        engine(model)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    with tempfile.TemporaryDirectory() as folder:
        robots = find_models(Path(folder))
        other = load_peer()
        largest = _find_slowest(robots, other or expand_model)
        table = _measure_in_process(robots, largest, other)
        return table + _measure_collection(other) + _measure_commands(largest[0], Path(folder))


def _measure_collection(other: Engine | None) -> list[Row]:
    """Measure the processor time of two passes over the descriptions of LINKWRIGHT_ROBOTS.

    Only descriptions that both programs expand are measured.
    """
    folder = os.environ.get("LINKWRIGHT_ROBOTS")
    if not folder:
        return []
    robots = [
        model
        for model in collect_models(Path(folder))
        if _can_expand(expand_model, model) and _can_expand(other or expand_model, model)
    ]
    engines: dict[str, Engine] = {"ours": expand_model, **({} if other is None else {PEER: other})}
    first: dict[str, list[float]] = {name: [] for name in engines}
    again: dict[str, list[float]] = {name: [] for name in engines}
    for _ in range(COLLECTION_PASSES):
        for name, engine in engines.items():
            clear_caches()
            for times in (first[name], again[name]):
                begin = time.process_time()
                expand_all(engine, robots)
                times.append(time.process_time() - begin)
    what = f"{len(robots)} public descriptions, processor time"
    return [
        _make_row(
            f"{what}, first pass",
            {name: statistics.median(seconds) for name, seconds in first.items()},
            "a tenth of xacro's",
        ),
        _make_row(
            f"{what}, again",
            {name: statistics.median(seconds) for name, seconds in again.items()},
            "a twentieth of xacro's",
        ),
    ]


def _can_expand(engine: Engine, model: Model) -> bool:
    try:
        return len(str(engine(model)).splitlines()) > FEWEST_LINES
    except (Exception, SystemExit):  # noqa: BLE001 - xacro fails in any way
        return False


def _measure_in_process(robots: list[Model], largest: list[Model], other: Engine | None) -> list[Row]:
    def calls(chosen: list[Model]) -> dict[str, Callable[[], None] | None]:
        peer = None if other is None else lambda: expand_all(other, chosen)
        return {"ours": lambda: expand_all(expand_model, chosen), PEER: peer}

    count = f"{len(robots)} models"
    cold = measure_side_by_side(calls(robots), PASS_COUNT, before=clear_caches)
    warm = measure_side_by_side(calls(robots), PASS_COUNT)
    table = [
        _make_row(f"{count}, cold at the start of each pass", cold, "5 times faster, towards 10"),
        _make_row(f"{count}, files and texts known", warm, ""),
    ]
    for model in largest:
        times = measure_side_by_side(calls([model]), SINGLE_COUNT, before=clear_caches)
        table.append(_make_row(f"{model.name}, cold", times, "5 times faster"))
    return table


def _make_row(what: str, seconds: dict[str, float], target: str) -> Row:
    other = seconds.get(PEER)
    return Row(what, seconds["ours"] * 1e3, "ms", target, {PEER: None if other is None else other * 1e3})


def _find_slowest(robots: list[Model], engine: Engine) -> list[Model]:
    """Return the slowest models, one for each file."""
    times = {model.name: measure_side_by_side({"": lambda model=model: engine(model)}, 1)[""] for model in robots}
    chosen: dict[str, Model] = {}
    for model in sorted(robots, key=lambda model: -times[model.name]):
        chosen.setdefault(model.path, model)
    return list(chosen.values())[:LARGEST_COUNT]


def _measure_commands(large: Model, folder: Path) -> list[Row]:
    prefix, stand_in = _create_prefix(large, folder), _create_ament_index(folder)
    (prefix / "share" / _FOUND).mkdir()
    (prefix / "share" / "ament_index" / "resource_index" / "packages" / _FOUND).touch()
    environment = {"AMENT_PREFIX_PATH": str(prefix), "PYTHONPATH": str(stand_in)}
    peer = peers.find_command(PEER)
    values = [f"{name}:={value}" for name, value in large.arguments.items()]
    table = []
    for what, words, target in (
        (f"command, small model ({SMALL.name})", [str(SMALL)], "60 ms over a bare interpreter"),
        (f"command, large model ({large.name})", [large.path, *values], "half of xacro's"),
        ("command, file without content", [str(_write_file(folder, "empty", "<robot/>"))], "no slower than xacro"),
        ("command, file with $(find)", [str(_write_file(folder, "find", _FINDING))], "no slower than xacro"),
    ):
        calls = {
            "ours": [LINKWRIGHT, "xacro", *words],
            PEER: [peer, *words] if peer else None,
            "bare interpreter": [sys.executable, "-c", "pass"],
        }
        times = measure_commands(calls, START_COUNT, **environment)
        others = {name: times[name] * 1e3 if name in times else None for name in (PEER, "bare interpreter")}
        table.append(Row(what, times["ours"] * 1e3, "ms", target, others))
        peaks = {name: measure_peak_memory(words, **environment) if words else None for name, words in calls.items()}
        mine = peaks.pop("ours")
        assert mine is not None
        table.append(Row(what.replace("command", "memory"), mine, "MB", "at most twice xacro's", peaks))
    return table


def _write_file(folder: Path, name: str, text: str) -> Path:
    path = folder / f"{name}.xacro"
    path.write_text(text, encoding="utf-8")
    return path


def _create_prefix(model: Model, folder: Path) -> Path:
    """Create an install prefix with the packages of a model, for both programs."""
    prefix = folder / "prefix"
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    for name, place in model.packages.items():
        (index / name).touch()
        (prefix / "share" / name).symlink_to(place)
    return prefix


def _create_ament_index(folder: Path) -> Path:
    """Create a simple ament_index_python, with which PyPI's xacro finds share folders."""
    package = folder / "stand_in" / "ament_index_python"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "packages.py").write_text(_AMENT_INDEX_CODE, encoding="utf-8")
    return package.parent


_AMENT_INDEX_CODE = """
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
