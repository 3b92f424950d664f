"""A world whose objects are moved, coloured and lit for each image without recompiling MuJoCo's model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.lights import Light
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.choice import make_renderer
from linkwright.simulation.rendering.renderer import Renderer
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.simulation import Simulation
from linkwright.vision.datasets.classes import SceneObject, geom_boxes
from linkwright.vision.datasets.textures import pattern

_PATTERNS = 12
"""The number of patterns of each kind: for objects, for structures, for the ground."""
_SIZES = {"object": 64, "wall": 128, "ground": 256}
"""The sides of patterns in pixels, by use."""
_AWAY = np.array([0.0, 0.0, -1e5])
"""The position in m of hidden objects."""
_LOW = 0.05
"""The height in m up to which a shape is not an obstacle."""
_DISTRACTORS = ("box", "capsule", "ellipsoid", "cylinder")


@dataclass(frozen=True)
class Prop:
    """A movable group of geoms.

    Attributes:
        name: the name of the object.
        label: the index of its class, -1 for none.
        geoms: its geoms in MuJoCo's model.
        main: its largest geom: the one whose box has the longest side.
        positions: the positions of its geoms, relative to the centre of its base: shape (n, 3), in m.
        turns: the axes of its geoms: shape (n, 3, 3).
        corners: the corners of the boxes around its geoms, relative to the centre of its base: shape (n * 8, 3).
        radius: the radius of a circle around its base, in m.
        is_round: whether it has no upper side.
    """

    name: str
    label: int
    geoms: Any
    main: int
    positions: Array
    turns: Array
    corners: Array
    radius: float
    is_round: bool


class Stage:
    """A world with copies of its objects, and unlabelled distractors.

    Args:
        simulation: the world, which the stage copies.
        objects: the objects to label.
        copies: the minimum number of objects of each class.
        distractors: the number of objects without a label.

    Attributes:
        simulation: the world.
        renderer: renders its images.
        props: the objects and their copies.
        distractors: objects without a label.
        ground: the flat geoms, which are always visible.
        structures: the other geoms of each model of the surroundings.
        area: the area for objects: minimum and maximum x and y in m, shape (2, 2).
        floor: the height of the ground below the objects, in m.
    """

    def __init__(self, simulation: Simulation, objects: Sequence[SceneObject], copies: int, distractors: int) -> None:
        simulation.refresh()
        self.simulation = simulation
        self._mujoco = load_mujoco()
        bases = {scene_object.name: _facts(simulation, scene_object) for scene_object in objects}
        shown = [geom for scene_object in objects for geom in scene_object.geoms]
        copied = self._copy(objects, copies)
        self._add_distractors(distractors)
        self._add_materials()
        simulation.set_altered()
        simulation.refresh()
        model, data = simulation.model, simulation.data
        self.props = [_prop(model, scene_object, bases[scene_object.name]) for scene_object in objects]
        self.props += [_prop(model, copy, bases[original]) for copy, original in copied]
        self.floor = float(np.median([bases[scene_object.name].bottom for scene_object in objects])) if objects else 0.0
        first = [model.geom(f"distractor {number}").id for number in range(distractors)]
        self.distractors = first
        labelled = {model.geom(name).id for name in shown} | {int(geom) for prop in self.props for geom in prop.geoms}
        around = [
            geom
            for geom in range(model.ngeom)
            if model.geom_group[geom] == VISUAL_GROUP and geom not in labelled and geom not in first
        ]
        self.boxes = geom_boxes(model, data)
        plane = self._mujoco.mjtGeom.mjGEOM_PLANE
        flat = [
            geom
            for geom in around
            if model.geom_type[geom] == plane or self.boxes[geom, 1, 2] - self.boxes[geom, 0, 2] < _LOW
        ]
        self.ground = flat
        self.structures: dict[str, list[int]] = {}
        for geom in around:
            if geom not in flat:
                self.structures.setdefault(model.geom(geom).name.partition("::")[0], []).append(geom)
        self.area = self._area(labelled)
        self._colours: Any = model.geom_rgba.copy()
        self._materials: Any = model.geom_matid.copy()
        self._places: tuple[Any, Any] = data.geom_xpos.copy(), data.geom_xmat.copy()
        self._own = simulation.world
        self.renderer: Renderer = make_renderer(simulation)

    def begin(self) -> None:
        """Reset the world: structures at their places in their colours, and all objects hidden."""
        model, data = self.simulation.model, self.simulation.data
        data.geom_xpos[:], data.geom_xmat[:] = self._places
        model.geom_rgba[:], model.geom_matid[:] = self._colours, self._materials
        for prop in self.props:
            data.geom_xpos[prop.geoms] = _AWAY
        self.hide(self.distractors)

    def hide(self, geoms: Sequence[int]) -> None:
        """Hide geoms."""
        self.simulation.data.geom_xpos[geoms] = _AWAY

    def put(self, prop: Prop, position: Array, turn: Array) -> None:
        """Place an object.

        Args:
            prop: the object.
            position: the position for the centre of its base, in m.
            turn: its axes, shape (3, 3).
        """
        data = self.simulation.data
        data.geom_xpos[prop.geoms] = position + prop.positions @ turn.T
        data.geom_xmat[prop.geoms] = (turn @ prop.turns).reshape(-1, 9)

    def shape_distractor(self, geom: int, generator: np.random.Generator) -> float:
        """Give a distractor a random size, unlike a ball, a cube or a drum, and return its radius in m."""
        model, kinds = self.simulation.model, self._mujoco.mjtGeom
        thin, middle, long = np.sort(generator.uniform(0.03, 0.12, 3)) * [0.5, 1.0, 1.0]
        long = max(long * generator.uniform(2.0, 6.0), 3.0 * middle)
        kind = int(model.geom_type[geom])
        if kind in (kinds.mjGEOM_CAPSULE, kinds.mjGEOM_CYLINDER):
            size = [thin + 0.02, long, 0.0] if generator.random() < 0.6 else [middle + 0.1, thin * 0.3, 0.0]
            if kind == kinds.mjGEOM_CAPSULE:
                size[1] = max(size[1], 1.5 * size[0])
            half = np.array([size[0], size[0], size[1] + (size[0] if kind == kinds.mjGEOM_CAPSULE else 0.0)])
        else:
            thin = min(thin, 0.45 * middle)
            half = generator.permutation(np.array([thin, middle, long]))
            size = half.tolist()
        model.geom_size[geom] = size
        model.geom_rbound[geom] = float(np.linalg.norm(half))
        model.geom_aabb[geom] = [0.0, 0.0, 0.0, *half]
        return float(np.linalg.norm(half))

    def put_distractor(self, geom: int, position: Array, turn: Array) -> None:
        """Place a distractor with its lowest point at the height of `position`."""
        model, data = self.simulation.model, self.simulation.data
        half = np.abs(turn) @ model.geom_aabb[geom, 3:]
        data.geom_xpos[geom] = position + np.array([0.0, 0.0, half[2]])
        data.geom_xmat[geom] = turn.reshape(9)

    def colour_of(self, geom: int) -> Any:
        """Return the colour of a geom in the original world: red, green, blue and opacity."""
        return self._colours[geom]

    def has_image(self, geom: int) -> bool:
        """Return whether a geom has its own material."""
        return bool(self._materials[geom] >= 0)

    def paint(self, geom: int, colour: Array, kind: str = "", number: int = 0) -> None:
        """Set the colour and the pattern of a geom.

        Args:
            geom: the geom.
            colour: red, green and blue.
            kind: ``object``, ``wall`` or ``ground`` for a pattern; empty for none.
            number: selects one of the patterns.
        """
        model = self.simulation.model
        model.geom_rgba[geom, :3] = colour
        if kind:
            model.geom_matid[geom] = self._patterns[kind][number % _PATTERNS]

    def light(self, lights: Sequence[Light], ambient: Array, background: Array) -> None:
        """Replace the lights of the world.

        Args:
            lights: all lights.
            ambient: red, green and blue of the ambient light.
            background: the colour of the background.
        """
        scene = replace(self._own.scene, ambient=_colour(ambient), background=_colour(background))
        self.simulation.world = replace(self._own, lights=tuple(lights), models=(), scene=scene)

    def set_patterns(self, generator: np.random.Generator) -> None:
        """Replace all patterns. The next image takes longer."""
        model = self.simulation.model
        for kind, size in _SIZES.items():
            for number in range(_PATTERNS):
                texture = model.texture(f"{kind} {number}").id
                pixels = pattern(generator, size, soft=kind == "object" or number % 2 == 0)
                first, faces = int(model.tex_adr[texture]), model.tex_height[texture] // size
                model.tex_data[first : first + faces * pixels.size] = np.tile(pixels.ravel(), faces)
        self._patterns = {
            kind: [model.material(f"{kind} {number}").id for number in range(_PATTERNS)] for kind in _SIZES
        }
        self.begin()
        self.simulation.world = self._own
        self.renderer.close()
        self.renderer = make_renderer(self.simulation)  # a new renderer, so that images do not depend on earlier ones

    def close(self) -> None:
        """Release the renderer."""
        self.renderer.close()

    def _area(self, labelled: set[int]) -> Array:
        model, kinds = self.simulation.model, self._mujoco.mjtGeom
        endless = (kinds.mjGEOM_PLANE, kinds.mjGEOM_HFIELD)
        ends = [geom for geom in labelled if geom < len(self.boxes)]
        ends += [geom for geoms in self.structures.values() for geom in geoms]
        ends = [geom for geom in ends if int(model.geom_type[geom]) not in endless]
        near = np.array([[-3.0, -3.0], [3.0, 3.0]])
        if not ends:
            return near
        least, greatest = self.boxes[ends, 0, :2].min(axis=0), self.boxes[ends, 1, :2].max(axis=0)
        middle = np.clip((least + greatest) / 2, -1e3, 1e3)
        half = np.clip((greatest - least) / 2, 3.0, 12.0)
        return np.stack([middle - half, middle + half])

    def _copy(self, objects: Sequence[SceneObject], copies: int) -> list[tuple[SceneObject, str]]:
        """Add copies of objects as static bodies, each with the name of its original."""
        model, spec = self.simulation.model, self.simulation.scene.spec
        counts: dict[int, int] = {}
        for scene_object in objects:
            counts[scene_object.label] = counts.get(scene_object.label, 0) + 1
        added = []
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
                added.append((SceneObject(name, label, tuple(names)), original.name))
        return added

    def _copy_geom(self, body: Any, geom: int, name: str) -> None:
        model = self.simulation.model
        kind = model.geom_type[geom]
        copy = body.add_geom(name=name, type=self._mujoco.mjtGeom(int(kind)), group=VISUAL_GROUP)
        copy.contype = copy.conaffinity = 0
        copy.rgba = model.geom_rgba[geom]
        if kind == self._mujoco.mjtGeom.mjGEOM_MESH:
            copy.meshname = model.mesh(model.geom_dataid[geom]).name
        else:
            copy.size = model.geom_size[geom]
        if model.geom_matid[geom] >= 0:
            copy.material = model.mat(model.geom_matid[geom]).name

    def _add_distractors(self, count: int) -> None:
        kinds = self._mujoco.mjtGeom
        body = self.simulation.scene.spec.worldbody.add_body(name="distractors")
        body.explicitinertial = True
        for number in range(count):
            shape = _DISTRACTORS[number % len(_DISTRACTORS)]
            kind = getattr(kinds, f"mjGEOM_{shape.upper()}")
            geom = body.add_geom(name=f"distractor {number}", type=kind, size=[0.1, 0.1, 0.1], group=VISUAL_GROUP)
            geom.contype = geom.conaffinity = 0

    def _add_materials(self) -> None:
        spec, kinds = self.simulation.scene.spec, self._mujoco.mjtTexture
        for kind, size in _SIZES.items():
            flat = kind == "ground"
            for number in range(_PATTERNS):
                name = f"{kind} {number}"
                texture = spec.add_texture(name=name, type=kinds.mjTEXTURE_2D if flat else kinds.mjTEXTURE_CUBE)
                texture.width, texture.height, texture.nchannel = size, size if flat else 6 * size, 3
                texture.data = bytes(texture.width * texture.height * 3)
                material = spec.add_material(name=name)
                material.textures[self._mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
                material.texuniform = flat
                material.texrepeat = [0.25 * 1.5**number] * 2 if flat else [1.0, 1.0]
                material.specular, material.shininess = 0.1, 0.1


@dataclass(frozen=True)
class _Facts:
    """An object's initial pose and geometry in its world."""

    positions: Array
    turns: Array
    corners: Array
    bottom: float
    is_round: bool


def _facts(simulation: Simulation, scene_object: SceneObject) -> _Facts:
    model, data = simulation.model, simulation.data
    geoms = [model.geom(name).id for name in scene_object.geoms]
    turns = data.geom_xmat[geoms].reshape(-1, 3, 3)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    local = model.geom_aabb[geoms, None, :3] + signs * model.geom_aabb[geoms, None, 3:]
    corners = np.einsum("gij,gcj->gci", turns, local) + data.geom_xpos[geoms, None, :]
    corners = corners.reshape(-1, 3)
    boxes = geom_boxes(model, data)[geoms]
    least, greatest = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    base = np.array([*(least + greatest)[:2] / 2, least[2]])
    width = greatest - least
    ball = (model.geom_type[geoms] == load_mujoco().mjtGeom.mjGEOM_SPHERE).any()
    return _Facts(
        data.geom_xpos[geoms] - base,
        turns.copy(),
        corners - base,
        float(least[2]),
        bool(ball and width.max() < 1.1 * width.min()),
    )


def _prop(model: Any, scene_object: SceneObject, facts: _Facts) -> Prop:
    geoms = np.array([model.geom(name).id for name in scene_object.geoms])
    radius = float(np.linalg.norm(facts.corners[:, :2], axis=1).max())
    sides = np.sort(model.geom_aabb[geoms, 3:], axis=1)
    main = int(geoms[np.argmax(sides[:, 1] * sides[:, 2])])
    places = facts.positions, facts.turns, facts.corners
    return Prop(scene_object.name, scene_object.label, geoms, main, *places, radius, facts.is_round)


def _colour(colour: Array) -> tuple[float, float, float, float]:
    red, green, blue = (float(channel) for channel in colour)
    return red, green, blue, 1.0
