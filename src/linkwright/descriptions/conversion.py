"""Convert robots, models and worlds to one SDF file without includes."""

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

_URI_FIELDS = {
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
"""The fields that name files, by the name of their class in `linkwright.sdf`."""


@dataclass(frozen=True, slots=True)
class ConversionResult:
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
) -> ConversionResult:
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
            return ConversionResult(None, world.diagnostics, world.files)
        sdf = replace(world.sdf, worlds=tuple(map(_apply_saved_state, world.sdf.worlds)))
        return ConversionResult(_relocate_paths(sdf, path.parent, folder), world.diagnostics, world.files)
    from linkwright.sdf.from_urdf import model_from_robot
    from linkwright.sdf.worlds import Sdf
    from linkwright.sdf.writer import WRITTEN_VERSION

    description = examine(path, arguments=arguments, packages=finder)
    if description.robot is None or not description.robot.root:
        return ConversionResult(None, description.diagnostics, description.files)
    conversion = model_from_robot(description.robot, lump_fixed_joints=lump_fixed_joints)
    sdf = Sdf(WRITTEN_VERSION, models=(conversion.model,))
    diagnostics = (*description.diagnostics, *conversion.diagnostics)
    return ConversionResult(_relocate_paths(sdf, path.parent, folder), diagnostics, description.files)


def _apply_saved_state(world: World) -> World:
    """Return a world in its saved state, with gravity in the element of SDF 1.6 and later."""
    from linkwright.sdf.saved import with_saved_state
    from linkwright.sdf.worlds import find_gravity

    world = replace(with_saved_state(world), states=())
    if world.gravity is None and any(physic.gravity for physic in world.physics):
        physics = tuple(replace(physic, gravity=None) for physic in world.physics)
        world = replace(world, gravity=find_gravity(world), physics=physics)
    return world


def _relocate_paths(sdf_object: Any, source_folder: Path, folder: Path) -> Any:
    """Return a part of SDF whose relative paths are relative to another folder."""
    return with_changed_uris(sdf_object, source_folder, lambda uri, uri_folder: _relocate_uri(uri, uri_folder, folder))


def with_changed_uris(sdf_object: Any, source_folder: Path, change: Callable[[str, Path], str]) -> Any:
    """Return a part of SDF with changed URIs of meshes, textures and other files.

    Args:
        sdf_object: an object of `linkwright.sdf`, or a tuple of such objects.
        source_folder: the folder of the part's file, for an object that does not store its file.
        change: a function that returns the new URI, given a URI and the folder of the file that contains it.
    """
    if isinstance(sdf_object, tuple):
        return tuple(with_changed_uris(item, source_folder, change) for item in sdf_object)
    if not is_dataclass(sdf_object) or isinstance(sdf_object, type):
        return sdf_object
    source = getattr(getattr(sdf_object, "element", None), "source", None)
    if source is not None:
        source_folder = Path(source.name).parent
    uri_fields = _URI_FIELDS.get(type(sdf_object).__name__, ())
    changed_fields: dict[str, Any] = {}
    for field in fields(sdf_object):
        value = getattr(sdf_object, field.name)
        if field.name in uri_fields:
            is_tuple = isinstance(value, tuple)
            new_uris = tuple(change(item, source_folder) for item in (value if is_tuple else (value,)))
            new_value = new_uris if is_tuple else new_uris[0]
        else:
            new_value = with_changed_uris(value, source_folder, change)
        if new_value != value:
            changed_fields[field.name] = new_value
    return replace(sdf_object, **changed_fields) if changed_fields else sdf_object


def _relocate_uri(uri: str, source_folder: Path, folder: Path) -> str:
    """Return the URI of a file for an SDF in another folder.

    The relative path of an existing file becomes relative to the folder, or a file URI if the file is outside it. Other
    URIs are unchanged.
    """
    file = Path(os.path.abspath(source_folder / uri))  # noqa: PTH100 - do not resolve links
    folder = folder.absolute()
    if not uri or "://" in uri or Path(uri).is_absolute() or not file.exists():
        return uri
    return file.relative_to(folder).as_posix() if file.is_relative_to(folder) else file.as_uri()
