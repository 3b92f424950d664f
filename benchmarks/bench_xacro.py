"""What expanding costs: real robots in this process, and one small robot in a process of its own.

Run it with ``python -m benchmarks xacro``. The robots are those of the corpus, where it is beside the repository, else
the one that is shipped. Where PyPI's `xacro` is installed it is measured too; it is no dependency of this project.
"""

from __future__ import annotations

import importlib.util
import json
import statistics
import subprocess
import sys
import time
import types
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from linkwright.xacro import expand, sources, template, yamldata

REPOSITORY = Path(__file__).resolve().parents[1]
CORPUS = REPOSITORY.parent / "shared" / "corpus"
SHIPPED = REPOSITORY / "robots" / "my_robot_description"
SMALL = SHIPPED / "urdf" / "mbot_base.xacro"
PASSES = 7
STARTS = 11


@dataclass(frozen=True)
class Model:
    """A description, its arguments, and where the packages are that it names."""

    path: str
    arguments: dict[str, str]
    packages: dict[str, str]


Engine = Callable[[Model], object]


def models() -> list[Model]:
    """The robots to expand."""
    if not CORPUS.is_dir():
        found = sorted(SHIPPED.rglob("*.xacro"))
        return [Model(str(path), {}, {SHIPPED.name: str(SHIPPED)}) for path in found if path.parent.name == "urdf"]
    manifest = json.loads((CORPUS / "manifest.json").read_text(encoding="utf-8"))
    packages = {name: str(CORPUS / folder) for name, folder in manifest["packages"].items()}
    return [Model(str(CORPUS / "robots" / model["entry"]), model["args"], packages) for model in manifest["models"]]


def ours(model: Model) -> object:
    """Expand with this project."""
    return str(expand(model.path, model.arguments, packages=model.packages))


def theirs() -> Engine | None:
    """What expands with PyPI's xacro, or None where it is not installed."""
    if importlib.util.find_spec("xacro") is None:
        return None
    import xacro

    packages: dict[str, str] = {}
    index = types.ModuleType("ament_index_python.packages")
    index.get_package_share_directory = packages.__getitem__  # type: ignore[attr-defined]
    sys.modules.setdefault("ament_index_python", types.ModuleType("ament_index_python"))
    sys.modules["ament_index_python.packages"] = index

    def run(model: Model) -> object:
        packages.clear()
        packages.update(model.packages)
        return xacro.process_file(model.path, mappings=dict(model.arguments)).toprettyxml(indent="  ")

    return run


def forget() -> None:
    """Drop everything that was kept from earlier expansions."""
    for kept in (sources.documents, template.templates, template.expressions, yamldata.loaded):
        kept.clear()


def one_pass(engine: Engine, robots: list[Model]) -> float:
    """Seconds for all robots once."""
    started = time.perf_counter()
    for model in robots:
        engine(model)
    return time.perf_counter() - started


def first_pass(robots: list[Model]) -> float:
    """Seconds for all robots, each as if it were the first of the process."""
    seconds = 0.0
    for model in robots:
        forget()
        seconds += one_pass(ours, [model])
    return seconds


def start(code: str) -> float:
    """Seconds that a fresh interpreter takes for some code, the median of several."""
    times = []
    for _ in range(STARTS):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def main() -> None:
    """Measure and print."""
    robots = models()
    one_pass(ours, robots)
    cold = min(first_pass(robots) for _ in range(PASSES))
    warm = min(one_pass(ours, robots) for _ in range(PASSES))
    print(f"{len(robots)} robots, each as if first in its process {cold * 1e3:8.1f} ms")
    print(f"{len(robots)} robots, files and texts known            {warm * 1e3:8.1f} ms")
    other = theirs()
    if other is None:
        print("PyPI's xacro is not installed, so there is nothing to compare with")
    else:
        seconds = min(one_pass(other, robots) for _ in range(PASSES))
        print(f"{len(robots)} robots, PyPI's xacro                     {seconds * 1e3:8.1f} ms", end="")
        print(f"  ({seconds / cold:.1f} and {seconds / warm:.1f} times as long)")
    bare = start("pass")
    code = f"from linkwright.xacro import expand; print(expand({str(SMALL)!r}, packages={{}}))"
    print(f"a process for {SMALL.name:<29} {start(code) * 1e3:8.1f} ms  (a bare interpreter {bare * 1e3:.1f} ms)")


if __name__ == "__main__":
    main()
