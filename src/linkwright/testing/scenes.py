"""Load worlds and robots for simulations, and cache them until a file changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from linkwright.descriptions.conversion import as_sdf
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.packages import PackageFinder
from linkwright.sdf.models import Model
from linkwright.simulation.server.worlds import LoadedWorld, load_world

_MAX_CACHED_SCENES = 64
"""The maximum number of cached worlds and robots.

A test over many arguments loads a robot for each value.
"""


class _CacheEntry(NamedTuple):
    value: Any
    states: tuple[object, ...]
    files: tuple[Path, ...]


_cache: dict[tuple[object, ...], _CacheEntry] = {}


def read_world(name: str | Path) -> LoadedWorld:
    """Load a world by its file or name, including the files that it includes.

    Raises:
        LinkwrightError: the errors of `load_world`.
    """

    def read() -> tuple[LoadedWorld, tuple[Path, ...]]:
        loaded = load_world(str(name))
        return loaded, loaded.files

    world: LoadedWorld = _read_cached(("world", str(Path.cwd()), name), read)
    return world


def read_model(path: Path, arguments: Mapping[str, str]) -> Model:
    """Load the robot or model of a URDF, xacro or SDF file.

    Raises:
        LinkwrightError: SIM142, the file contains no model; or the file has errors.
    """

    def read() -> tuple[Model, tuple[Path, ...]]:
        finder = PackageFinder(start=[path.parent, Path.cwd()])
        # As in the server of a world, keep links on fixed joints, because a laser measures all links except its own.
        conversion = as_sdf(path, finder, arguments=dict(arguments), lump_fixed_joints=False, folder=Path.cwd())
        if conversion.sdf is None or not conversion.sdf.models:
            message = phrase("the file '{path}' contains no model", path=str(path))
            hint = phrase("use a URDF or xacro file, or an SDF file with a <model>")
            raise LinkwrightError(*conversion.diagnostics or [Diagnostic("SIM142", message, hint=hint)])
        return conversion.sdf.models[0], conversion.files

    key = ("model", str(Path.cwd()), str(path), *sorted(arguments.items()))
    model: Model = _read_cached(key, read)
    return model


def _read_cached(key: tuple[object, ...], read: Callable[[], tuple[Any, tuple[Path, ...]]]) -> Any:
    entry = _cache.pop(key, None)
    if entry is None or entry.states != tuple(map(_read_file_state, entry.files)):
        value, files = read()
        entry = _CacheEntry(value, tuple(map(_read_file_state, files)), files)
    _cache[key] = entry
    if len(_cache) > _MAX_CACHED_SCENES:
        del _cache[next(iter(_cache))]
    return entry.value


def _read_file_state(path: Path) -> object:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
