"""A world whose objects move and change color without recompiling MuJoCo's model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.lights import Light
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.factory import make_renderer
from linkwright.simulation.rendering.renderer import Renderer
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.simulation import Simulation
from linkwright.vision.datasets.classes import SceneObject, compute_geom_boxes
from linkwright.vision.datasets.textures import make_random_pattern

_PATTERNS_PER_KIND = 12
"""The number of patterns of each kind: objects, walls and ground."""
_PATTERN_SIZES = {"object": 64, "wall": 128, "ground": 256}
"""The side of a pattern in pixels, by kind."""
_HIDDEN_POSITION = np.array([0.0, 0.0, -1e5])
"""The position of hidden objects, in m."""
_MAX_FLAT_HEIGHT = 0.05
"""The maximum height in m of a shape that is not an obstacle."""
_DISTRACTOR_SHAPES = ("box", "capsule", "ellipsoid", "cylinder")


@dataclass(frozen=True)
class MovableObject:
    """A group of geoms that is moved as one object.

    Attributes:
        name: the name of the object.
        label: the index of its class; -1 for none.
        geoms: the indices of its geoms in MuJoCo's model.
        main_geom: its largest geom: the one whose bounding box has the largest face.
        positions: the positions of its geoms relative to the center of its base: shape (n, 3), in m.
        rotations: the rotation matrices of its geoms: shape (n, 3, 3).
        corners: the corners of the boxes around its geoms, relative to the center of its base: shape (n * 8, 3), in m.
        radius: the radius in m of a circle around the object, seen from above.
        is_round: whether the object is a ball, which has no upper side.
    """

    name: str
    label: int
    geoms: Any
    main_geom: int
    positions: Array
    rotations: Array
    corners: Array
    radius: float
    is_round: bool


class RandomizedWorld:
    """A world with copies of its labeled objects, and with distractors.

    Args:
        simulation: the world; it is changed.
        objects: the objects to label.
        copies: the minimum number of objects of each class.
        distractors: the number of objects without a label.

    Attributes:
        simulation: the world.
        renderer: renders the images of the world.
        movable_objects: the objects and their copies.
        distractors: the geoms of the objects without a label.
        ground: the geoms that are flat; they are always visible.
        structures: the other geoms of the surroundings, by model.
        area: the area for objects: minimum and maximum x and y in m, shape (2, 2).
        floor: the height of the ground below the objects, in m.
    """

    def __init__(self, simulation: Simulation, objects: Sequence[SceneObject], copies: int, distractors: int) -> None:
        simulation.refresh()
        self.simulation = simulation
        self._mujoco = load_mujoco()
        bases = {scene_object.name: _measure_object(simulation, scene_object) for scene_object in objects}
        object_geoms = [geom for scene_object in objects for geom in scene_object.geoms]
        copies_with_originals = self._copy_objects(objects, copies)
        self._add_distractors(distractors)
        self._add_materials()
        simulation.mark_changed()
        simulation.refresh()
        model, data = simulation.model, simulation.data
        self.movable_objects = [
            _create_movable(model, scene_object, bases[scene_object.name]) for scene_object in objects
        ]
        self.movable_objects += [
            _create_movable(model, copy, bases[original]) for copy, original in copies_with_originals
        ]
        self.floor = float(np.median([bases[scene_object.name].bottom for scene_object in objects])) if objects else 0.0
        first = [model.geom(f"distractor {index}").id for index in range(distractors)]
        self.distractors = first
        labeled = {model.geom(name).id for name in object_geoms} | {
            int(geom) for movable in self.movable_objects for geom in movable.geoms
        }
        properties_used_by_plugins = [
            geom
            for geom in range(model.ngeom)
            if model.geom_group[geom] == VISUAL_GROUP and geom not in labeled and geom not in first
        ]
        self.boxes = compute_geom_boxes(model, data)
        plane = self._mujoco.mjtGeom.mjGEOM_PLANE
        flat_geoms = [
            geom
            for geom in properties_used_by_plugins
            if model.geom_type[geom] == plane or self.boxes[geom, 1, 2] - self.boxes[geom, 0, 2] < _MAX_FLAT_HEIGHT
        ]
        self.ground = flat_geoms
        self.structures: dict[str, list[int]] = {}
        for geom in properties_used_by_plugins:
            if geom not in flat_geoms:
                self.structures.setdefault(model.geom(geom).name.partition("::")[0], []).append(geom)
        self.area = self._find_area(labeled)
        self._colors: Any = model.geom_rgba.copy()
        self._materials: Any = model.geom_matid.copy()
        self._initial_poses: tuple[Any, Any] = data.geom_xpos.copy(), data.geom_xmat.copy()
        self._original_world = simulation.world
        self.renderer: Renderer = make_renderer(simulation)

    def reset(self) -> None:
        """Restore the poses and colors of all structures, and hide all objects."""
        model, data = self.simulation.model, self.simulation.data
        data.geom_xpos[:], data.geom_xmat[:] = self._initial_poses
        model.geom_rgba[:], model.geom_matid[:] = self._colors, self._materials
        for movable in self.movable_objects:
            data.geom_xpos[movable.geoms] = _HIDDEN_POSITION
        self.hide(self.distractors)

    def hide(self, geoms: Sequence[int]) -> None:
        """Hide geoms by moving them far away."""
        self.simulation.data.geom_xpos[geoms] = _HIDDEN_POSITION

    def place_object(self, movable: MovableObject, position: Array, rotation: Array) -> None:
        """Place an object.

        Args:
            movable: the object.
            position: the position of the center of its base, in m.
            rotation: its rotation matrix, shape (3, 3).
        """
        data = self.simulation.data
        data.geom_xpos[movable.geoms] = position + movable.positions @ rotation.T
        data.geom_xmat[movable.geoms] = (rotation @ movable.rotations).reshape(-1, 9)

    def shape_distractor(self, geom: int, generator: np.random.Generator) -> float:
        """Give a distractor a random shape and size, and return its bounding radius in m.

        No shape resembles a ball, cube or drum.
        """
        model, geom_types = self.simulation.model, self._mujoco.mjtGeom
        short, medium, long = np.sort(generator.uniform(0.03, 0.12, 3)) * [0.5, 1.0, 1.0]
        long = max(long * generator.uniform(2.0, 6.0), 3.0 * medium)
        geom_type = int(model.geom_type[geom])
        if geom_type in (geom_types.mjGEOM_CAPSULE, geom_types.mjGEOM_CYLINDER):
            size = [short + 0.02, long, 0.0] if generator.random() < 0.6 else [medium + 0.1, short * 0.3, 0.0]
            if geom_type == geom_types.mjGEOM_CAPSULE:
                size[1] = max(size[1], 1.5 * size[0])
            half_size = np.array(
                [size[0], size[0], size[1] + (size[0] if geom_type == geom_types.mjGEOM_CAPSULE else 0.0)]
            )
        else:
            short = min(short, 0.45 * medium)
            half_size = generator.permutation(np.array([short, medium, long]))
            size = half_size.tolist()
        model.geom_size[geom] = size
        model.geom_rbound[geom] = float(np.linalg.norm(half_size))
        model.geom_aabb[geom] = [0.0, 0.0, 0.0, *half_size]
        return float(np.linalg.norm(half_size))

    def put_distractor(self, geom: int, position: Array, rotation: Array) -> None:
        """Place a distractor with its lowest point at the height of `position`."""
        model, data = self.simulation.model, self.simulation.data
        half_size = np.abs(rotation) @ model.geom_aabb[geom, 3:]
        data.geom_xpos[geom] = position + np.array([0.0, 0.0, half_size[2]])
        data.geom_xmat[geom] = rotation.reshape(9)

    def get_original_color(self, geom: int) -> Any:
        """Return the initial color of a geom: red, green, blue and opacity, from 0 to 1."""
        return self._colors[geom]

    def has_material(self, geom: int) -> bool:
        """Return whether a geom has a material in the original world."""
        return bool(self._materials[geom] >= 0)

    def paint(self, geom: int, color: Array, kind: str = "", pattern_index: int = 0) -> None:
        """Set the color and the pattern of a geom.

        Args:
            geom: the index of the geom in MuJoCo's model.
            color: red, green and blue.
            kind: the kind of pattern: ``object``, ``wall`` or ``ground``; empty for none.
            pattern_index: selects one of the patterns.
        """
        model = self.simulation.model
        model.geom_rgba[geom, :3] = color
        if kind:
            model.geom_matid[geom] = self._patterns[kind][pattern_index % _PATTERNS_PER_KIND]

    def set_lights(self, lights: Sequence[Light], ambient: Array, background: Array) -> None:
        """Replace the lights, the ambient light and the background of the world.

        Args:
            lights: the new lights.
            ambient: the red, green and blue of the ambient light.
            background: the red, green and blue of the background.
        """
        scene = replace(self._original_world.scene, ambient=_make_opaque(ambient), background=_make_opaque(background))
        self.simulation.world = replace(self._original_world, lights=tuple(lights), models=(), scene=scene)

    def set_patterns(self, generator: np.random.Generator) -> None:
        """Replace all patterns with random patterns.

        The next image takes longer to render.
        """
        model = self.simulation.model
        for kind, size in _PATTERN_SIZES.items():
            for index in range(_PATTERNS_PER_KIND):
                texture = model.texture(f"{kind} {index}").id
                pixels = make_random_pattern(generator, size, soft=kind == "object" or index % 2 == 0)
                start, faces = int(model.tex_adr[texture]), model.tex_height[texture] // size
                model.tex_data[start : start + faces * pixels.size] = np.tile(pixels.ravel(), faces)
        self._patterns = {
            kind: [model.material(f"{kind} {index}").id for index in range(_PATTERNS_PER_KIND)]
            for kind in _PATTERN_SIZES
        }
        self.reset()
        self.simulation.world = self._original_world
        self.renderer.close()
        self.renderer = make_renderer(self.simulation)  # images must not depend on what the previous renderer drew

    def close(self) -> None:
        """Release the renderer."""
        self.renderer.close()

    def _find_area(self, labeled: set[int]) -> Array:
        model, geom_types = self.simulation.model, self._mujoco.mjtGeom
        unbounded_types = (geom_types.mjGEOM_PLANE, geom_types.mjGEOM_HFIELD)
        bounded_geoms = [geom for geom in labeled if geom < len(self.boxes)]
        bounded_geoms += [geom for geoms in self.structures.values() for geom in geoms]
        bounded_geoms = [geom for geom in bounded_geoms if int(model.geom_type[geom]) not in unbounded_types]
        default_area = np.array([[-3.0, -3.0], [3.0, 3.0]])
        if not bounded_geoms:
            return default_area
        minimum, maximum = self.boxes[bounded_geoms, 0, :2].min(axis=0), self.boxes[bounded_geoms, 1, :2].max(axis=0)
        center = np.clip((minimum + maximum) / 2, -1e3, 1e3)
        half_size = np.clip((maximum - minimum) / 2, 3.0, 12.0)
        return np.stack([center - half_size, center + half_size])

    def _copy_objects(self, objects: Sequence[SceneObject], copies: int) -> list[tuple[SceneObject, str]]:
        """Add copies of objects as static bodies, and return each copy with its original's name."""
        model, spec = self.simulation.model, self.simulation.scene.spec
        counts: dict[int, int] = {}
        for scene_object in objects:
            counts[scene_object.label] = counts.get(scene_object.label, 0) + 1
        copies_with_originals = []
        for label, count in counts.items():
            originals = [scene_object for scene_object in objects if scene_object.label == label]
            for number in range(max(copies - count, 0)):
                original = originals[number % len(originals)]
                name = f"{original.name} copy {number}"
                body = spec.worldbody.add_body(name=name)
                body.explicitinertial = True
                names = []
                for index, geom in enumerate(original.geoms):
                    self._copy_geom(body, model.geom(geom).id, f"{name} {index}")
                    names.append(f"{name} {index}")
                copies_with_originals.append((SceneObject(name, label, tuple(names)), original.name))
        return copies_with_originals

    def _copy_geom(self, body: Any, geom: int, name: str) -> None:
        model = self.simulation.model
        geom_type = model.geom_type[geom]
        copy = body.add_geom(name=name, type=self._mujoco.mjtGeom(int(geom_type)), group=VISUAL_GROUP)
        copy.contype = copy.conaffinity = 0
        copy.rgba = model.geom_rgba[geom]
        if geom_type == self._mujoco.mjtGeom.mjGEOM_MESH:
            copy.meshname = model.mesh(model.geom_dataid[geom]).name
        else:
            copy.size = model.geom_size[geom]
        if model.geom_matid[geom] >= 0:
            copy.material = model.mat(model.geom_matid[geom]).name

    def _add_distractors(self, count: int) -> None:
        geom_types = self._mujoco.mjtGeom
        body = self.simulation.scene.spec.worldbody.add_body(name="distractors")
        body.explicitinertial = True
        for index in range(count):
            shape = _DISTRACTOR_SHAPES[index % len(_DISTRACTOR_SHAPES)]
            geom_type = getattr(geom_types, f"mjGEOM_{shape.upper()}")
            geom = body.add_geom(name=f"distractor {index}", type=geom_type, size=[0.1, 0.1, 0.1], group=VISUAL_GROUP)
            geom.contype = geom.conaffinity = 0

    def _add_materials(self) -> None:
        spec, texture_types = self.simulation.scene.spec, self._mujoco.mjtTexture
        for kind, size in _PATTERN_SIZES.items():
            is_flat = kind == "ground"
            for index in range(_PATTERNS_PER_KIND):
                name = f"{kind} {index}"
                texture = spec.add_texture(
                    name=name, type=texture_types.mjTEXTURE_2D if is_flat else texture_types.mjTEXTURE_CUBE
                )
                texture.width, texture.height, texture.nchannel = size, size if is_flat else 6 * size, 3
                texture.data = bytes(texture.width * texture.height * 3)
                material = spec.add_material(name=name)
                material.textures[self._mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
                material.texuniform = is_flat
                material.texrepeat = [0.25 * 1.5**index] * 2 if is_flat else [1.0, 1.0]
                material.specular, material.shininess = 0.1, 0.1


@dataclass(frozen=True)
class _InitialGeometry:
    """The initial geometry of an object, relative to the center of its base."""

    positions: Array
    rotations: Array
    corners: Array
    bottom: float
    is_round: bool


def _measure_object(simulation: Simulation, scene_object: SceneObject) -> _InitialGeometry:
    model, data = simulation.model, simulation.data
    geoms = [model.geom(name).id for name in scene_object.geoms]
    rotations = data.geom_xmat[geoms].reshape(-1, 3, 3)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    local = model.geom_aabb[geoms, None, :3] + signs * model.geom_aabb[geoms, None, 3:]
    corners = np.einsum("gij,gcj->gci", rotations, local) + data.geom_xpos[geoms, None, :]
    corners = corners.reshape(-1, 3)
    boxes = compute_geom_boxes(model, data)[geoms]
    minimum, maximum = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    base = np.array([*(minimum + maximum)[:2] / 2, minimum[2]])
    extent = maximum - minimum
    has_sphere = (model.geom_type[geoms] == load_mujoco().mjtGeom.mjGEOM_SPHERE).any()
    return _InitialGeometry(
        data.geom_xpos[geoms] - base,
        rotations.copy(),
        corners - base,
        float(minimum[2]),
        bool(has_sphere and extent.max() < 1.1 * extent.min()),
    )


def _create_movable(model: Any, scene_object: SceneObject, geometry: _InitialGeometry) -> MovableObject:
    geoms = np.array([model.geom(name).id for name in scene_object.geoms])
    radius = float(np.linalg.norm(geometry.corners[:, :2], axis=1).max())
    half_sizes = np.sort(model.geom_aabb[geoms, 3:], axis=1)
    main = int(geoms[np.argmax(half_sizes[:, 1] * half_sizes[:, 2])])
    poses = geometry.positions, geometry.rotations, geometry.corners
    return MovableObject(scene_object.name, scene_object.label, geoms, main, *poses, radius, geometry.is_round)


def _make_opaque(color: Array) -> tuple[float, float, float, float]:
    red, green, blue = (float(channel) for channel in color)
    return red, green, blue, 1.0
