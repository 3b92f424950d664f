"""Lookup and reading of the world to simulate."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from linkwright.descriptions.service import examine_world
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, has_errors, joined, phrase
from linkwright.packages import PackageFinder
from linkwright.sdf.link_counts import has_more_links
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World
from linkwright.simulation.scene.compiling import MAX_LINKS, count_links, too_many_links_hint
from linkwright.xmltree import Overlay
from linkwright.xmltree.reader import read_bytes


class LoadedWorld(NamedTuple):
    """A world with its includes resolved.

    Attributes:
        world: the parsed world.
        finder: finds the models and meshes to which the world refers.
        diagnostics: the findings about the world and its files.
        path: the file of the world.
        files: all files from which the world was read.
        read_ns: the time when reading began, in nanoseconds since the epoch.
    """

    world: World
    finder: ResourceFinder
    diagnostics: tuple[Diagnostic, ...]
    path: Path
    files: tuple[Path, ...]
    read_ns: int

    @property
    def mesh_files(self) -> tuple[Path, ...]:
        """The existing mesh files of the world's models."""
        from linkwright.sdf.mesh_files import find_mesh_files

        return find_mesh_files(self.world.models, self.finder)


def load_world(name: str, text: str | None = None, environment: Mapping[str, str] | None = None) -> LoadedWorld:
    """Read the first world in a file.

    Args:
        name: the file or its address, or the name of a world on the search path, or ``empty``.
        text: replaces the text of the file, which then need not exist.
        environment: the variables with the search paths; by default the variables of the process.

    Raises:
        LinkwrightError: SIM150, there is no such world; SIM151, the file does not contain a world; SIM105, the world
            has too many links; other errors of the file.
    """
    read_ns = time.time_ns()
    path = Path(name.removeprefix("file://")).expanduser()
    finder = PackageFinder(start=[path.absolute().parent, Path.cwd()])
    resources = ResourceFinder(finder, environment)
    if text is None:
        path = _find_world(name, resources)
    if path.suffix != ".xacro" and (text is not None or path.is_file()):
        _check_link_count(read_bytes(path) if text is None else text)
    description = examine_world(
        path, packages=finder, environment=environment, overlay=None if text is None else Overlay({path: text})
    )
    if description.sdf is None:
        raise LinkwrightError(*description.diagnostics)
    if not description.sdf.worlds:
        errors = [diagnostic for diagnostic in description.diagnostics if has_errors([diagnostic])]
        message = phrase("there is no world in '{path}'", path=str(path))
        hint = phrase("add a model to a world: linkwright sim empty {path}", path=str(path))
        raise LinkwrightError(*errors or [Diagnostic("SIM151", message, hint=hint)])
    world = description.sdf.worlds[0]
    count_links(world.models)
    return LoadedWorld(world, resources, description.diagnostics, path, description.files, read_ns)


def _check_link_count(text: bytes | str) -> None:
    if has_more_links(text, MAX_LINKS):
        message = phrase("a world of more than {maximum} links cannot be simulated", maximum=MAX_LINKS)
        raise LinkwrightError(Diagnostic("SIM105", message, hint=too_many_links_hint()))


def _find_world(name: str, finder: ResourceFinder) -> Path:
    path = finder.world(name)
    if path is not None:
        return path
    world_names = finder.worlds()
    message = phrase("there is no world '{name}'", name=name)
    hint = did_you_mean(name, world_names) or phrase(
        "pass a file, or one of {names}", names=joined(sorted(world_names)[:8])
    )
    raise LinkwrightError(Diagnostic("SIM150", message, hint=hint))
