"""Compare quantities of whole SDF models."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.single import IDENTITY
from linkwright.picture import Scene
from linkwright.picture.scene_mesh import Mesh
from linkwright.review.changes import Figure
from linkwright.review.quantities import compare_quantity, compare_size
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, place_links, pose_of
from linkwright.sdf.links import Inertial
from linkwright.sdf.models import Model
from linkwright.sdf.worlds import Sdf


def compare_model_figures(old: Sdf, new: Sdf, scenes: Sequence[Scene]) -> Iterator[Figure]:
    """Yield the quantities that differ between the models of two files; none for worlds.

    Args:
        old: the old file, with its includes resolved.
        new: the new file, with its includes resolved.
        scenes: the visuals of both files; empty if they are equal or cannot be drawn.
    """
    if old.worlds or new.worlds:
        return
    try:
        measures = _Measures(old.models), _Measures(new.models)
    except FrameError:
        return
    for name, unit, measure in _QUANTITIES:
        yield from compare_quantity(name, unit, *map(measure, measures))
    if scenes:
        yield from compare_size(*map(_measure_scene, scenes))


class _Measures:
    """The quantities of the models of a file. Static models have no mass.

    Attributes:
        links: the number of links.
        joints: the number of joints.
        moving_joints: the number of joints that are not fixed.
        mass_properties: the mass properties of all models in the frame of the file; None if the simulator computes the
            mass properties of a link.
    """

    def __init__(self, models: Sequence[Model]) -> None:
        links = [link for model in models for link in place_links(model, Frames(model), IDENTITY, model.name)]
        joints = [joint for model in models for joint in _iterate_joint_mobility(model)]
        self.links = len(links)
        self.joints = len(joints)
        self.moving_joints = joints.count(True)
        inertials = [(link, link.link.inertial or Inertial()) for link in links if not link.static]
        self.mass_properties = None
        if not any(inertial.auto for _, inertial in inertials):
            self.mass_properties = combine(_compute_mass_properties(*pair) for pair in inertials)


def _iterate_joint_mobility(model: Model) -> Iterator[bool]:
    """Yield whether each joint of a model and of its nested models moves."""
    yield from (joint.type != "fixed" for joint in model.joints)
    for nested_model in model.models:
        yield from _iterate_joint_mobility(nested_model)


def _compute_mass_properties(placed: PlacedLink, inertial: Inertial) -> MassProperties:
    i = inertial.inertia
    tensor = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]])
    in_inertial_frame = MassProperties(inertial.mass, inertia=tensor)
    inertial_to_link = pose_of(placed.frames.in_link(inertial.pose, placed.link.name))
    return in_inertial_frame.moved(inertial_to_link).moved(pose_of(placed.pose))


def _get_total_mass(measures: _Measures) -> float | None:
    return None if measures.mass_properties is None else measures.mass_properties.mass


def _get_center_of_mass(measures: _Measures) -> Array | None:
    properties = measures.mass_properties
    return properties.center if properties is not None and properties.mass > 0 else None


def _measure_scene(scene: Scene) -> Array | None:
    """Return the size of all visuals in m, shape (3,); None if some cannot be drawn."""
    points = Mesh.of(scene.bodies).points  # those of the scene leave out the ends of a floor
    if scene.problems or not len(points):
        return None
    size: Array = np.ptp(points, axis=0)
    return size


_QUANTITIES: tuple[tuple[Phrase, str, Callable[[_Measures], object]], ...] = (
    (phrase("links"), "", lambda measures: measures.links),
    (phrase("joints"), "", lambda measures: measures.joints),
    (phrase("moving joints"), "", lambda measures: measures.moving_joints),
    (phrase("mass"), "kg", _get_total_mass),
    (phrase("center of mass"), "m", _get_center_of_mass),
)
"""The quantities: their names, their units, and the functions that measure them."""
