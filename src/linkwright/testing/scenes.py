"""Loads worlds and robots for simulations, and caches them until their files change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from linkwright.descriptions.conversion import as_sdf
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.packages import PackageFinder
from linkwright.sdf.models import Model
from linkwright.simulation.server.worlds import LoadedWorld, load_world

_MOST = 64
"""The most worlds and robots that are kept; a sweep over arguments makes one for each value."""


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

    world: LoadedWorld = _read_once(("world", str(Path.cwd()), name), read)
    return world


def read_model(path: Path, arguments: Mapping[str, str]) -> Model:
    """Load the robot or model of a URDF, xacro or SDF file.

    Raises:
        LinkwrightError: SIM142, the file contains no model; or the file has errors.
    """

    def read() -> tuple[Model, tuple[Path, ...]]:
        finder = PackageFinder(start=[path.parent, Path.cwd()])
        converted = as_sdf(path, finder, arguments=dict(arguments), folder=Path.cwd())
        if converted.sdf is None or not converted.sdf.models:
            message = phrase("there is no model in '{path}'", path=str(path))
            hint = phrase("a robot must be URDF, xacro, or SDF with a <model>")
            raise LinkwrightError(*converted.diagnostics or [Diagnostic("SIM142", message, hint=hint)])
        return converted.sdf.models[0], converted.files

    key = ("model", str(Path.cwd()), str(path), *sorted(arguments.items()))
    model: Model = _read_once(key, read)
    return model


def _read_once(key: tuple[object, ...], read: Callable[[], tuple[Any, tuple[Path, ...]]]) -> Any:
    entry = _cache.pop(key, None)
    if entry is None or entry.states != tuple(map(_state, entry.files)):
        value, files = read()
        entry = _CacheEntry(value, tuple(map(_state, files)), files)
    _cache[key] = entry
    if len(_cache) > _MOST:
        del _cache[next(iter(_cache))]
    return entry.value


def _state(path: Path) -> object:
    try:
        facts = path.stat()
    except OSError:
        return None
    return facts.st_mtime_ns, facts.st_size, facts.st_ino
