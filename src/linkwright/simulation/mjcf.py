"""Export of worlds and models as MJCF, MuJoCo's file format."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.packages import PackageFinder
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import Sdf, World
from linkwright.simulation.rendering.ray_renderer import compute_mean_color
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.scene import Scene

_DEFAULT_RGBA = [0.5, 0.5, 0.5, 1.0]
"""The color that means "use the material's color" in MuJoCo."""


def write_mjcf(sdf: Sdf, finder: PackageFinder) -> tuple[str, Sequence[Diagnostic]]:
    """Return the first world of an SDF file as MJCF with embedded meshes, and the findings.

    If the file has no world, its models are exported.

    Raises:
        LinkwrightError: CLI321, MuJoCo rejects the model; SIM101, MuJoCo is not installed.
    """
    world = sdf.worlds[0] if sdf.worlds else World(sdf.models[0].name if sdf.models else "", models=sdf.models)
    scene = Scene(world, MeshLibrary(ResourceFinder(finder)))
    try:
        model = scene.spec.compile()
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise LinkwrightError(
            Diagnostic("CLI321", phrase("MuJoCo rejects the model: {reason}", reason=foreign(reason)))
        ) from None
    _replace_textures(scene.spec, model)
    return scene.spec.to_xml(), scene.diagnostics


def _replace_textures(spec: Any, model: Any) -> None:
    """Remove all textures, and multiply the materials' colors by the textures' mean colors.

    MJCF stores only the file names of textures.
    """
    mean_colors: dict[str, Any] = {}
    for material in spec.materials:
        (texture_index,) = {
            int(number) for number in np.atleast_1d(model.mat_texid[model.material(material.name).id])
        } - {-1} or {-1}
        if texture_index >= 0:
            mean_colors[material.name] = np.array([*compute_mean_color(model, texture_index), 1.0])
            material.rgba = material.rgba * mean_colors[material.name]
            material.textures = [""] * len(material.textures)
    for geom in spec.geoms:
        if geom.material in mean_colors and list(geom.rgba) != _DEFAULT_RGBA:
            geom.rgba = geom.rgba * mean_colors[geom.material]
    for texture_index in list(spec.textures):
        spec.delete(texture_index)
