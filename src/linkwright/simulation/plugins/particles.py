"""Smoke, fog and spray: ``gz-sim-particle-emitter-system``.

Each ``<particle_emitter>`` of a link emits particles along its x axis. They move in the world in straight lines, grow,
and change their color until their lifetime ends. The plugin publishes them as markers. ``std_msgs/msg/Bool`` on the
topic of an emitter starts and stops it.

Source: gz-sim and gz-rendering (elements, topics, how particles move); the SDFormat specification 1.12,
``particle_emitter.sdf`` (defaults). The topic of gz has the type ``gz.msgs.ParticleEmitter``, which no bridge converts.
Textures are left out, and so is the effect of particles on sensors.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError, Severity, phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Transform, compose
from linkwright.messages import Header, get_message
from linkwright.sdf.frames import transform_of
from linkwright.sdf.plugins import library_name
from linkwright.sdf.poses import AT_ORIGIN, POSE, SEPARATOR
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

PARTICLES_TOPIC = "/world_particles"
"""The topic of the particles, as ``visualization_msgs/msg/MarkerArray``."""
EMITTER, _LIBRARY = "particle_emitter", "gz-sim-particle-emitter-system"
_RATE_HZ = 20.0
_MAX_COUNT = 500
"""The largest number of particles of an emitter, as in gz."""
_AGE_GROUPS = 6
"""The number of groups of particles by age; the particles of a group have the same size."""
_SHAPES = ("point", "box", "cylinder", "ellipsoid")
_ADD, _DELETE, _SPHERE_LIST = 0, 2, 7
_TRUE = ("true", "1")


@dataclass(slots=True)
class _Emitter:
    """An emitter with its particles.

    Attributes:
        name: the name with the model and the link.
        link: the full name of the link.
        pose: the pose in the frame of the link.
        shape: the shape in which particles start, one of `_SHAPES`.
        size: the size of that shape in m, shape (3,).
        particle_size: the diameter of a new particle in m.
        growth: the speed at which the diameter grows, as a fraction of `particle_size` per second.
        lifetime: the lifetime of a particle in s.
        rate: the number of new particles per second.
        speeds: the slowest and the fastest speed in m/s.
        colors: the colors of new and of old particles, shape (2, 4).
        seconds: the time for which the emitter emits, in s.
        emits: whether the emitter emits, as in the description.
        is_on: whether the emitter emits now.
        rest: the fraction of a particle that is due.
        ages, positions, velocities: the particles, shapes (n,), (n, 3) and (n, 3), in s, m and m/s, in the world.
    """

    name: str
    link: str
    pose: Transform
    shape: str
    size: Array
    particle_size: float
    growth: float
    lifetime: float
    rate: float
    speeds: tuple[float, float]
    colors: Array
    seconds: float
    emits: bool
    is_on: bool
    rest: float = 0.0
    ages: Array = field(default_factory=lambda: np.empty(0))
    positions: Array = field(default_factory=lambda: np.empty((0, 3)))
    velocities: Array = field(default_factory=lambda: np.empty((0, 3)))

    def clear(self) -> None:
        """Remove the particles, and emit as at the start."""
        self.is_on, self.rest = self.emits, 0.0
        self.ages, self.positions, self.velocities = np.empty(0), np.empty((0, 3)), np.empty((0, 3))

    def move(self, seconds: float) -> None:
        """Move the particles, and remove the old ones."""
        self.ages = self.ages + seconds
        self.positions = self.positions + self.velocities * seconds
        is_young = self.ages < self.lifetime
        self.ages, self.positions, self.velocities = (
            self.ages[is_young],
            self.positions[is_young],
            self.velocities[is_young],
        )

    def emit(self, seconds: float, pose: Transform, random: np.random.Generator) -> None:
        """Add the particles of the last seconds, with the emitter at a pose of the world."""
        due = self.rate * seconds + self.rest
        count = min(int(due), _MAX_COUNT - len(self.ages))
        self.rest = due - int(due)
        if count <= 0:
            return
        ages = random.uniform(0.0, seconds, count)
        rotation = rotation_matrix(pose[3:])
        velocities = random.uniform(*self.speeds, count)[:, np.newaxis] * rotation[:, 0]
        starts = self._draw_starts(count, random) @ rotation.T + np.array(pose[:3])
        self.ages = np.concatenate([self.ages, ages])
        self.positions = np.concatenate([self.positions, starts + velocities * ages[:, np.newaxis]])
        self.velocities = np.concatenate([self.velocities, velocities])

    def _draw_starts(self, count: int, random: np.random.Generator) -> Array:
        """Return random points in the shape of the emitter, in its frame, shape (count, 3)."""
        if self.shape == "point":
            return np.zeros((count, 3))
        points = random.uniform(-0.5, 0.5, (count, 3))
        if self.shape != "box":
            axes = 2 if self.shape == "cylinder" else 3
            directions = random.standard_normal((count, axes))
            directions /= np.linalg.norm(directions, axis=1, keepdims=True)
            points[:, :axes] = directions * 0.5 * random.uniform(0.0, 1.0, (count, 1)) ** (1 / axes)
        starts: Array = points * self.size
        return starts


class GzParticleEmitters(SimulatedPlugin[NoParameters]):
    """The substitute for ``gz-sim-particle-emitter-system``."""

    CARRIED = ("_emitters",)

    def start(self) -> None:
        """Create the topic of the particles, and find the emitters.

        Raises:
            LinkwrightError: SIM160 or an error of SDF, an emitter is not valid.
        """
        self._emitters: dict[str, _Emitter] = {}
        self._revision = -1
        self._shown_emitters: set[str] = set()
        self._random = self.random
        self._output = self.node.publisher("visualization_msgs/msg/MarkerArray", PARTICLES_TOPIC)
        self._update_emitters()
        self.every(_RATE_HZ, self._update)

    def reset(self) -> None:
        """Remove all particles."""
        self._random = self.random
        for emitter in self._emitters.values():
            emitter.clear()

    def _update_emitters(self) -> None:
        """Find the emitters of models that were added or removed."""
        simulation = self.simulation
        simulation.refresh()
        if self._revision == simulation.revision:
            return
        self._revision = simulation.revision
        old_emitters, self._emitters = self._emitters, {}
        for scene_model in simulation.scene.models.values():
            for tree_link in scene_model.structure.links:
                link, full_name = tree_link.link.link, tree_link.link.name
                for element in () if link.element is None else link.element.elements(EMITTER):
                    name = f"{full_name}{SEPARATOR}{element.attributes.get('name', '')}"
                    emitter = old_emitters.get(name)
                    if emitter is None:
                        emitter = self._read_emitter(name, full_name, element)
                        self._subscribe(emitter, element)
                    self._emitters[name] = emitter

    def _read_emitter(self, name: str, link: str, element: Element) -> _Emitter:
        report, pose_element = SdfReport(), element.first("pose")
        raw_pose = AT_ORIGIN if pose_element is None else read_element(pose_element, POSE, report)
        errors = [finding for finding in report.in_order() if finding.severity is Severity.ERROR]
        if errors:
            raise LinkwrightError(*errors)
        shape = element.attributes.get("type", "point")
        duration = self.number_in(element, "duration", 0.0)
        emits = (self.text_in(element, "emitting") or "true").lower() in _TRUE
        width, height, _ = self._read_numbers(element, "particle_size", (1.0, 1.0, 1.0))
        white = (1.0, 1.0, 1.0, 1.0)
        return _Emitter(
            name,
            link,
            transform_of(raw_pose.pose),
            shape if shape in _SHAPES else "point",
            self._read_numbers(element, "size", (1.0, 1.0, 1.0)),
            (width + height) / 2.0,
            self.number_in(element, "scale_rate", 0.0),
            self.number_in(element, "lifetime", 5.0),
            self.number_in(element, "rate", 10.0),
            (self.number_in(element, "min_velocity", 1.0), self.number_in(element, "max_velocity", 1.0)),
            np.stack([self._read_numbers(element, f"color_{side}", white) for side in ("start", "end")]),
            duration if duration > 0.0 else inf,
            emits,
            emits,
        )

    def _read_numbers(self, element: Element, tag: str, default: tuple[float, ...]) -> Array:
        text = self.text_in(element, tag)
        try:
            numbers = tuple(float(word) for word in text.split()) if text else default
        except ValueError:
            numbers = ()
        if len(numbers) == len(default) - 1 == 3:  # a color without alpha
            numbers = (*numbers, 1.0)
        if len(numbers) != len(default):
            raise self.parameter_error(
                phrase("<{parent}> needs {count} numbers in <{tag}>", parent=EMITTER, count=len(default), tag=tag),
                element,
            )
        return np.array(numbers)

    def _subscribe(self, emitter: _Emitter, element: Element) -> None:
        *models, link, own_name = emitter.name.split(SEPARATOR)
        path = "/model/".join(("", *models))
        topic = self.text_in(element, "topic") or f"{path}/link/{link}/{EMITTER}/{own_name}/cmd"

        def switch(message: Any) -> None:
            emitter.is_on = bool(message.data)

        self.node.subscribe("std_msgs/msg/Bool", f"/{topic.lstrip('/')}", switch)

    def _update(self) -> None:
        self._update_emitters()
        simulation, seconds = self.simulation, 1.0 / _RATE_HZ
        for emitter in self._emitters.values():
            emitter.move(seconds)
            if emitter.is_on and simulation.seconds <= emitter.seconds:
                pose = compose(simulation.link_pose(emitter.link), emitter.pose)
                emitter.emit(seconds, pose, self._random)
        if self._output.is_wanted and (self._emitters or self._shown_emitters):
            markers = [marker for emitter in self._emitters.values() for marker in self._create_markers(emitter)]
            markers += self._remove_markers(self._shown_emitters - self._emitters.keys())
            self._shown_emitters = set(self._emitters)
            self._output.publish(get_message("visualization_msgs/msg/MarkerArray")(markers=markers))

    def _create_markers(self, emitter: _Emitter) -> Iterator[Any]:
        """Yield a marker for each group of particles by age."""
        point_class, color_class = get_message("geometry_msgs/msg/Point"), get_message("std_msgs/msg/ColorRGBA")
        ages = emitter.ages / emitter.lifetime if emitter.lifetime > 0.0 else emitter.ages
        groups = np.minimum((ages * _AGE_GROUPS).astype(int), _AGE_GROUPS - 1)
        start, end = emitter.colors
        for group in range(_AGE_GROUPS):
            is_in_group = groups == group
            marker = self._create_marker(emitter.name, group, _ADD if is_in_group.any() else _DELETE)
            middle_age = (group + 0.5) / _AGE_GROUPS
            size = emitter.particle_size * max(1.0 + emitter.growth * middle_age * emitter.lifetime, 0.0)
            marker.scale = get_message("geometry_msgs/msg/Vector3")(x=size, y=size, z=size)
            red, green, blue, alpha = (start + (end - start) * middle_age).tolist()
            marker.color = color_class(r=red, g=green, b=blue, a=alpha)
            marker.points = [point_class(x=x, y=y, z=z) for x, y, z in emitter.positions[is_in_group].tolist()]
            yield marker

    def _remove_markers(self, names: set[str]) -> list[Any]:
        return [self._create_marker(name, group, _DELETE) for name in sorted(names) for group in range(_AGE_GROUPS)]

    def _create_marker(self, name: str, number: int, action: int) -> Any:
        marker = get_message("visualization_msgs/msg/Marker")(ns=name, id=number, type=_SPHERE_LIST, action=action)
        marker.header = Header(stamp=self.stamp(), frame_id="world")
        marker.pose.orientation.w = 1.0
        return marker


def has_particles(world: World, model_text: str = "") -> bool:
    """Return whether a world publishes particles, or a model in it, given as text, would do so there."""
    if not any(library_name(plugin.filename) == _LIBRARY for plugin in world.plugins):
        return False
    models = list(world.models)
    for model in models:
        models.extend(model.models)
    links = (link for model in models for link in model.links)
    return EMITTER in model_text or any(link.element is not None and link.element.first(EMITTER) for link in links)
