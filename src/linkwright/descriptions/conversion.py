"""The conversion of robots, models and worlds to one SDF file without includes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path

from linkwright.descriptions.service import examine, examine_world, is_world
from linkwright.diagnostics import Diagnostic
from linkwright.loading.lean_typing import TYPE_CHECKING, Any
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.sdf.worlds import Sdf, World

_ADDRESSES = {
    "Animation": {"filename"},
    "Heightmap": {"uri"},
    "Image": {"uri"},
    "Mesh": {"uri"},
    "MaterialScript": {"uris"},
    "Shader": {"normal_map"},
    "Skin": {"filename"},
    "TerrainTexture": {"diffuse", "normal"},
    "Workflow": {
        *("albedo_map", "ambient_occlusion_map", "emissive_map", "environment_map", "glossiness_map", "light_map"),
        *("metalness_map", "normal_map", "roughness_map", "specular_map"),
    },
}
"""Classes of `linkwright.sdf` -> their fields that name files."""


@dataclass(frozen=True, slots=True)
class Converted:
    """The result of converting a file to SDF.

    Attributes:
        sdf: the SDF, or None if the file cannot be read.
        diagnostics: the findings about the file, and about parts that could not be converted.
        files: the files that were read, starting with the main file.
    """

    sdf: Sdf | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...]


def as_sdf(
    path: Path,
    finder: PackageFinder,
    *,
    arguments: Mapping[str, str] | None = None,
    lump_fixed_joints: bool = True,
    folder: Path | None = None,
) -> Converted:
    """Return a URDF, xacro or SDF file converted to one SDF.

    The SDF needs no other files except meshes and textures.

    Args:
        path: the file.
        finder: the finder of packages.
        arguments: values for the file's ``<xacro:arg>``.
        lump_fixed_joints: whether to merge links on fixed joints in a URDF; see
            `linkwright.sdf.from_urdf.model_from_robot`.
        folder: the folder of the new SDF, to which paths of meshes are relative. The default is the folder of the file.

    Raises:
        LinkwrightError: if the file is not XML, or cannot be expanded.
    """
    folder = folder or path.parent
    if is_world(path.name):
        world = examine_world(path, arguments=arguments, packages=finder)
        if world.sdf is None:
            return Converted(None, world.diagnostics, world.files)
        sdf = replace(world.sdf, worlds=tuple(map(_as_it_is, world.sdf.worlds)))
        return Converted(_relocate_paths(sdf, path.parent, folder), world.diagnostics, world.files)
    from linkwright.sdf.from_urdf import model_from_robot
    from linkwright.sdf.worlds import Sdf
    from linkwright.sdf.writer import VERSION

    description = examine(path, arguments=arguments, packages=finder)
    if description.robot is None or not description.robot.root:
        return Converted(None, description.diagnostics, description.files)
    conversion = model_from_robot(description.robot, lump_fixed_joints=lump_fixed_joints)
    sdf = Sdf(VERSION, models=(conversion.model,))
    found = (*description.diagnostics, *conversion.diagnostics)
    return Converted(_relocate_paths(sdf, path.parent, folder), found, description.files)


def _as_it_is(world: World) -> World:
    """Return a world in its saved state, with gravity in the element that SDF uses since 1.6."""
    from linkwright.sdf.saved import with_saved_state
    from linkwright.sdf.worlds import gravity_of

    world = replace(with_saved_state(world), states=())
    if world.gravity is None and any(physic.gravity for physic in world.physics):
        physics = tuple(replace(physic, gravity=None) for physic in world.physics)
        world = replace(world, gravity=gravity_of(world), physics=physics)
    return world


def _relocate_paths(part: Any, written_in: Path, folder: Path) -> Any:
    """Return a part of SDF whose relative paths are relative to another folder."""
    return with_changed_uris(part, written_in, lambda written, beside: _address(written, beside, folder))


def with_changed_uris(part: Any, written_in: Path, change: Callable[[str, Path], str]) -> Any:
    """Return a part of SDF with changed URIs of meshes, textures and other files.

    Args:
        part: an object of `linkwright.sdf`, or a tuple of them.
        written_in: the folder of the part's file, for an object that does not store its file.
        change: a function that returns the new URI, given a URI and the folder of the file that contains it.
    """
    if isinstance(part, tuple):
        return tuple(with_changed_uris(item, written_in, change) for item in part)
    if not is_dataclass(part) or isinstance(part, type):
        return part
    source = getattr(getattr(part, "element", None), "source", None)
    if source is not None:
        written_in = Path(source.name).parent
    addresses = _ADDRESSES.get(type(part).__name__, ())
    changed: dict[str, Any] = {}
    for field in fields(part):
        value = getattr(part, field.name)
        if field.name in addresses:
            many = isinstance(value, tuple)
            moved = tuple(change(item, written_in) for item in (value if many else (value,)))
            new = moved if many else moved[0]
        else:
            new = with_changed_uris(value, written_in, change)
        if new != value:
            changed[field.name] = new
    return replace(part, **changed) if changed else part


def _address(written: str, written_in: Path, folder: Path) -> str:
    """Return the URI of a file for an SDF in another folder.

    The relative path of an existing file becomes relative to the folder, or a file URI if the file is outside it. Other
    URIs are unchanged.
    """
    file = Path(os.path.abspath(written_in / written))  # noqa: PTH100 - links stay what they are
    folder = folder.absolute()
    if not written or "://" in written or Path(written).is_absolute() or not file.exists():
        return written
    return file.relative_to(folder).as_posix() if file.is_relative_to(folder) else file.as_uri()
