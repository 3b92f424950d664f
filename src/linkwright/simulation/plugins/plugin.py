"""Base classes of plugins and sensors.

To add a plugin or a type of sensor, write a class and declare it as an entry point (`registry`):

    class JointStatePublisher(SimulatedPlugin[Parameters]):
        PARAMETERS = Parameters  # a dataclass, see `parameters`

        def start(self) -> None:
            self._joints = [self.joint(name) for name in self.parameters.joint_name]
            self._output = self.node.publisher("sensor_msgs/msg/JointState", "joint_states", 1000)
            self.every(self.parameters.update_rate, self._publish)

        def _publish(self) -> None:
            positions = [self.simulation.joint_state(joint)[0] for joint in self._joints]
            self._output.publish(JointState(Header(self.stamp()), ..., positions, ...))

For a sensor, `sensor` is the sensor to measure, with its pose. The same class serves a sensor with a plugin in its
``<sensor>``, which ``linkwright.simulated_plugins`` finds by its library, and a sensor without a plugin, which
``linkwright.simulated_sensors`` finds by its type. Noise is drawn from `random`, so the same seed gives the same noise.
Create costly messages only if ``output.is_wanted``.

All methods are called in the simulation's thread: `start` after the model is added, functions passed to `every` at
their simulated times, callbacks of topics and services between two chunks of time, `reset` after time restarts, and
`stop` before the model is removed. A model whose file was saved is replaced at its current pose, and `resume` takes
over the state of the previous plugin. An exception in any of these methods is logged and ends only that plugin or
sensor (`calls`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, Generic, Protocol, TypeVar

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform
from linkwright.messages import Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import Plugin
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Sensor
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.water import WaterSurface
from linkwright.simulation.schedule import Task
from linkwright.simulation.simulation import Simulation
from linkwright.xmltree import Element

P = TypeVar("P")


@dataclass(frozen=True, slots=True)
class PlacedSensor:
    """A sensor of a model.

    Attributes:
        name: the name with the models and the link or joint that contain the sensor: ``robot::head::camera``.
        sensor: the parsed sensor.
        link: the link that carries the sensor, named as in the simulation; for a sensor in a joint, the child link.
        joint: the joint that contains the sensor; empty for a sensor of a link.
        pose: the pose of the sensor in the frame of `link`.
    """

    name: str
    sensor: Sensor
    link: str
    joint: str
    pose: Transform


@dataclass(frozen=True, slots=True)
class PlacedVisual:
    """A visual of a link that contains a plugin.

    Attributes:
        name: the name of the visual in its link.
        link: the link, named as in the simulation.
        pose: the pose of the visual in the frame of `link`.
    """

    name: str
    link: str
    pose: Transform


@dataclass(frozen=True, slots=True)
class PluginContext:
    """The elements that contain a plugin, or a sensor without a plugin.

    Attributes:
        name: the name of the plugin, or of the sensor without a plugin.
        plugin: the plugin as written in the SDF; None for a sensor without a plugin.
        world: the world, as it was read.
        model: the model that contains the plugin; None for a plugin of the world.
        path: the name of the model that contains the plugin, ``robot`` or ``robot::arm``; empty for the world.
        sensor: the sensor that contains the plugin, or the sensor without a plugin; None for other plugins.
        visual: the visual that contains the plugin; None for other plugins.
    """

    name: str
    plugin: Plugin | None
    world: World
    model: Model | None
    path: str
    sensor: PlacedSensor | None
    visual: PlacedVisual | None = None

    @property
    def element(self) -> Element | None:
        """The element that declares the plugin or sensor, or None if there is none."""
        if self.plugin is not None:
            return self.plugin.element
        return None if self.sensor is None else self.sensor.sensor.element


class Environment(Protocol):
    """The interface of the simulation's server that plugins use."""

    @property
    def simulation(self) -> Simulation:
        """The simulation in which the plugins run."""

    @property
    def gazebo_mistakes(self) -> bool:
        """Whether plugins reproduce known mistakes of Gazebo."""

    @property
    def stored_values(self) -> dict[str, Any]:
        """The values that plugins store by name for later instances.

        Later instances read the values after a model is changed.
        """

    def random(self, name: str) -> np.random.Generator:
        """Return a random number generator that depends only on the seed and a name."""

    def plugins(self, model: str) -> tuple[SimulatedPlugin[Any], ...]:
        """Return the running plugins and sensors of a model."""

    def spawn(self, model: Model, name: str, pose: Transform) -> None:
        """Add a model to the world at a pose, and start its plugins."""


class SimulatedPlugin(Generic[P]):
    """A running plugin or sensor.

    Attributes:
        PARAMETERS: the dataclass with its parameters.
        IGNORED: the names of parameters that have no effect here and give no warning.
        CARRIED: the names of the attributes that `resume` copies from the previous instance.
        context: the elements that contain the plugin, and its name.
        node: creates the plugin's topics and services.
        parameters: the values of the parameters, an instance of `PARAMETERS`.
        simulation: the simulation in which the plugin runs.
        gazebo_mistakes: whether to reproduce known mistakes of Gazebo; each is documented where it is reproduced.
    """

    PARAMETERS: ClassVar[type[Any]] = NoParameters
    IGNORED: ClassVar[Collection[str]] = ()
    CARRIED: ClassVar[tuple[str, ...]] = ()

    def __init__(self, context: PluginContext, node: PluginNode, parameters: P, environment: Environment) -> None:
        self.context = context
        self.node = node
        self.parameters = parameters
        self.simulation = environment.simulation
        self.gazebo_mistakes = environment.gazebo_mistakes
        self._environment = environment
        self._tasks: list[Task] = []
        self._pushed_links: set[str] = set()

    # --- methods for plugins to override ------------------------------------------------------------------------------

    def start(self) -> None:
        """Find links and joints, create topics, and register functions with `every`.

        Raises:
            LinkwrightError: the plugin cannot work; this is logged, and the plugin does not run.
        """

    def reset(self) -> None:
        """Restore the initial state, because simulated time restarts."""

    def resume(self, previous: SimulatedPlugin[P]) -> None:
        """Adopt the state of the previous instance with the same parameters.

        The simulation calls this after `start` when it has replaced a model.

        Args:
            previous: the previous instance, which has ended.
        """
        for name in self.CARRIED:
            setattr(self, name, getattr(previous, name))

    def is_same_plugin(self, other: SimulatedPlugin[Any]) -> bool:
        """Return whether another plugin has the same class, position in its model, and parameters."""
        own_context, other_context = self.context, other.context
        is_same_position = (own_context.path, own_context.name) == (other_context.path, other_context.name)
        return type(self) is type(other) and is_same_position and bool(self.parameters == other.parameters)

    def stop(self) -> None:
        """Clean up resources other than the node and the functions registered with `every`."""

    @property
    def stored_values(self) -> dict[str, Any]:
        """The values that previous instances stored by name before the model was changed."""
        return self._environment.stored_values

    @property
    def water(self) -> WaterSurface | None:
        """The surface of the water on which the plugin floats bodies, or None."""
        return None

    @property
    def read_sensors(self) -> Collection[str]:
        """The names of sensors without a plugin that this plugin reads, so that they are not reported as missing."""
        return ()

    # --- methods for plugins to call ----------------------------------------------------------------------------------

    @property
    def sensor(self) -> PlacedSensor:
        """The sensor that the plugin is or belongs to.

        Use this only in sensors and their plugins.

        Raises:
            LinkwrightError: SIM160, the plugin of a sensor is not in a sensor.
        """
        if self.context.sensor is None:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}' must be in a <sensor>, whose measurements it publishes", plugin=self.context.name
                )
            )
        return self.context.sensor

    @property
    def random(self) -> np.random.Generator:
        """A new random number generator for this plugin, determined by its name and the seed.

        Store the generator, and get a new one in `reset`, which repeats the same numbers.
        """
        name = self.sensor.name if self.context.sensor is not None else f"{self.context.path}::{self.context.name}"
        return self._environment.random(name)

    def every(self, rate: float, function: Callable[[], None]) -> None:
        """Register a function to be called `rate` times per simulated second.

        A rate of 0 means after each step.
        """
        period = round(NANOSECONDS_PER_SECOND / rate) if rate > 0 else 0
        self._tasks.append(self.simulation.call_every(period, partial(self.node.calls.call, function)))

    def push(
        self,
        link: str,
        force: Array | Sequence[float],
        torque: Array | Sequence[float] = (0.0, 0.0, 0.0),
        *,
        at: Array | Sequence[float] | None = None,
    ) -> None:
        """Set the plugin's force in N and its torque in N m on a link, in world axes.

        They act until the plugin sets them again, or ends. The forces of several plugins on a link add up, also if the
        plugins have the same name.

        Args:
            link: the full name of the link.
            force: the force, shape (3,).
            torque: the torque, shape (3,).
            at: the point of the world at which the force acts, in m, shape (3,); None for the center of mass.
        """
        self._pushed_links.add(link)
        self.simulation.push(link, force, torque, by=self, at=at)

    def stop_pushing(self, *, except_links: Collection[str] = ()) -> None:
        """Remove the plugin's forces from all links, or from all except some."""
        released_links = self._pushed_links.difference(except_links)
        for link in released_links & self.simulation.scene.bodies.keys():
            self.simulation.push(link, (0.0, 0.0, 0.0), by=self)
        self._pushed_links -= released_links

    def stamp(self) -> Time:
        """Return the current simulated time as a stamp for message headers."""
        return Time.from_nanoseconds(self.simulation.time)

    def link(self, name: str) -> str:
        """Return the full name of a link of the plugin's model, as used in the simulation.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        return self._full_name(name, self.simulation.scene.bodies, "SIM133")

    def joint(self, name: str) -> str:
        """Return the full name of a movable joint of the plugin's model, as used in the simulation.

        Raises:
            LinkwrightError: SIM134, there is no such joint.
        """
        return self._full_name(name, self.simulation.scene.joints, "SIM134")

    @property
    def first_link(self) -> str:
        """The full name of the first link of the top-level model that contains the plugin."""
        top_model, _, _ = self.context.path.partition(SEPARATOR)
        return self.simulation.scene.models[top_model].structure.links[0].link.name

    @property
    def model_plugins(self) -> tuple[SimulatedPlugin[Any], ...]:
        """The running plugins and sensors of the top-level model that contains the plugin."""
        return self._environment.plugins(self.context.path.partition(SEPARATOR)[0])

    def parameter_error(self, message: Phrase, element: Element | None = None) -> LinkwrightError:
        """Return the error SIM160, to raise in `start` for contradictory parameters.

        Parameters may contradict each other or the model. The location of the error is `element`, or by default the
        element of the plugin.
        """
        element = self.context.element if element is None else element
        if element is None:
            return LinkwrightError(Diagnostic("SIM160", message))
        return LinkwrightError(Diagnostic("SIM160", message, element.span(), source=element.source))

    def spawn(self, model: Model, name: str, pose: Transform) -> None:
        """Add a model to the world, and start its plugins.

        Call this only in callbacks of topics and services.

        Args:
            model: the model, with its includes resolved.
            name: the name of the model in the world.
            pose: the pose of the model's frame in the world; a model inside the ground is lifted onto it.

        Raises:
            LinkwrightError: SIM102, there is already a model with this name; SIM140, the model cannot be placed or
                moved.
        """
        self._environment.spawn(model, name, pose)

    @staticmethod
    def text_in(parent: Element | None, tag: str) -> str:
        """Return the text in a child of a nested element, or an empty text for an absent child."""
        child = None if parent is None else parent.first(tag)
        return "" if child is None else child.text().strip()

    def number_in(self, parent: Element | None, tag: str, default: float | None = None) -> float:
        """Return the number in a child of a nested element, for which `PARAMETERS` has no field.

        Args:
            parent: the nested element; None if it is absent.
            tag: the tag of the child.
            default: the number for an absent child; None if the child is required.

        Raises:
            LinkwrightError: SIM160, the child is absent and required, or its text is not a number.
        """
        child = None if parent is None else parent.first(tag)
        if child is None and default is not None:
            return default
        try:
            return float("" if child is None else child.text())
        except ValueError as error:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <{parent}> needs a number in <{tag}>",
                    plugin=self.context.name,
                    parent="plugin" if parent is None else parent.tag,
                    tag=tag,
                ),
                parent if child is None else child,
            ) from error

    def close(self, on_error: Callable[[Exception], object]) -> None:
        """Call `stop`, and remove the plugin's forces, node and functions.

        An error in `stop` is passed to `on_error`.
        """
        for task in self._tasks:
            task.is_cancelled = True
        self.node.calls.close(self._end, on_error)
        self.node.close()

    def _end(self) -> None:
        try:
            self.stop()
        finally:
            self.stop_pushing()

    def _full_name(self, name: str, known_names: Collection[str], code: str) -> str:
        """Return the full name for a name that may omit the model or nested models.

        Raises:
            LinkwrightError: the error `code`, there is no such name, or several nested models have it.
        """
        prefix = f"{self.context.path}{SEPARATOR}" if self.context.path else ""
        model_names = [name for name in known_names if name.startswith(prefix)]
        for candidate in (f"{prefix}{name}", name):
            if candidate in model_names:
                return candidate
        matches = [full_name for full_name in model_names if full_name.endswith(f"{SEPARATOR}{name}")]
        if len(matches) == 1:
            return matches[0]
        element = self.context.element
        names = [item.removeprefix(prefix) for item in model_names]
        if code == "SIM133":
            message = phrase("plugin '{plugin}': there is no link '{name}'", plugin=self.context.name, name=name)
        else:
            message = phrase(
                "plugin '{plugin}': there is no movable joint '{name}'", plugin=self.context.name, name=name
            )
        span, source = (element.span(), element.source) if element is not None else (None, None)
        raise LinkwrightError(Diagnostic(code, message, span, hint=did_you_mean(name, names), source=source))


PluginClass = type[SimulatedPlugin[Any]]
