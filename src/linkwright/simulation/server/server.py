"""A simulation, and the plugins that connect it to a graph."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any
from zlib import crc32

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, joined, phrase
from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph import Node
from linkwright.graph.stepped.calls import Calls
from linkwright.graph.stepped.exchange import Exchange
from linkwright.sdf.comparison import have_equal_content
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import Plugin, find_original_library, library_name
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.saved import with_saved_state
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.bridged_topics import BridgedTopics
from linkwright.simulation.plugins.contexts import model_plugins, world_plugins
from linkwright.simulation.plugins.findings import error_findings
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.plugins.parameters import parameters_from
from linkwright.simulation.plugins.plugin import PluginClass, PluginContext, SimulatedPlugin
from linkwright.simulation.plugins.registry import (
    find_plugin_class,
    find_sensor_class,
    is_built_in,
    shares_node,
)
from linkwright.simulation.plugins.ros_element import read_node_description
from linkwright.simulation.plugins.water import WaterSurface
from linkwright.simulation.scene.scene import SceneModel
from linkwright.simulation.server.changes import (
    AddedModel,
    add_models,
    check_models,
    find_changes,
    get_properties_used_by_plugins,
)
from linkwright.simulation.server.ground_contact import find_collision_warnings, lift_onto_ground
from linkwright.simulation.server.motion import record_motion, restore_motion
from linkwright.simulation.server.overlaps import find_overlaps
from linkwright.simulation.server.unsimulated import (
    find_unsimulated_elements,
    find_unsimulated_model_elements,
    report_unsimulated_plugins,
)
from linkwright.simulation.simulation import Simulation

_WORLD_OWNER = ""
"""The key of the world's plugins. No model has this name."""
_PACE_OWNER = "::pace"
"""The key of the finding about the pace. No model has this name, because names contain no '::'."""


@dataclass(frozen=True, slots=True)
class ServerOptions:
    """Options of a simulation.

    Attributes:
        seed: the seed of all random numbers.
        usual_names: whether topics of gz, such as ``/model/robot/cmd_vel``, also have their usual names, such as
            ``/cmd_vel`` for the first robot that has this topic.
        gazebo_mistakes: whether plugins reproduce known mistakes of Gazebo.
        systems: the default plugins of a world that does not declare any.
    """

    seed: int = 0
    usual_names: bool = False
    gazebo_mistakes: bool = False
    systems: Sequence[Plugin] = ()


class SimulationServer:
    """A simulation, and the plugins that connect it to a graph.

    All methods must be called in the thread that advances the simulation, which may be any thread.

    Args:
        simulation: the simulation of the world.
        node: the node of the simulator, which plugins of gz share.
        options: the options of the simulation.

    Attributes:
        simulation: the simulation of the world.
        node: the node of the simulator.
        exchange: passes messages to the graph, and commands from the graph to the simulation's thread.
        on_change: called after models were added or removed.
        on_reset: called after a reset.
        on_findings: called after `findings` have changed.
        on_failure: called with the exception of a plugin's code, after it was logged.
        stored_values: the values that plugins store by name for later instances, which read them after a model is
            changed.
    """

    def __init__(self, simulation: Simulation, node: Node, options: ServerOptions | None = None) -> None:
        self.simulation = simulation
        self.node = node
        self.exchange = Exchange()
        self.on_change: list[Callable[[], None]] = []
        self.on_reset: list[Callable[[], None]] = []
        self.on_findings: list[Callable[[], object]] = []
        self.on_failure: list[Callable[[Exception], object]] = []
        self._options = options or ServerOptions()
        self._used_conventional_topics: set[str] | None = set() if self._options.usual_names else None
        self._bridged = BridgedTopics(node, self.exchange)
        self._plugins: dict[str, list[SimulatedPlugin[object]]] = {}
        self.stored_values: dict[str, Any] = {}
        self._namespaces: dict[str, str] = {}
        self._world_models = set(simulation.scene.models)
        self._node_names: set[str] = set()
        self._logged_names: set[str] = set()
        self._findings: dict[str, list[Diagnostic]] = {}

    def start(self) -> None:
        """Start the plugins of the world and of its models."""
        self.report(self.simulation.scene.diagnostics)
        self._warn_unsimulated(find_unsimulated_elements(self.simulation.world))
        self._start_plugins(_WORLD_OWNER, world_plugins(self.simulation.world, self._options.systems), "")
        for scene_model in tuple(self.simulation.scene.models.values()):
            self._start_plugins(
                scene_model.name, model_plugins(self.simulation.world, scene_model.model, scene_model.name), ""
            )
        self.report(find_overlaps(self.simulation))  # after the plugins have attached models
        self._call_on_change()

    @property
    def findings(self) -> list[Diagnostic]:
        """The findings on the models in the world.

        The findings may be read from any thread.
        """
        return [diagnostic for findings in tuple(self._findings.values()) for diagnostic in tuple(findings)]

    @property
    def gazebo_mistakes(self) -> bool:
        """Whether plugins reproduce the known mistakes of Gazebo."""
        return self._options.gazebo_mistakes

    def random(self, name: str) -> np.random.Generator:
        """Return a random number generator that depends only on the seed and a name."""
        return np.random.default_rng([self._options.seed, crc32(name.encode())])

    def plugins(self, model: str) -> tuple[SimulatedPlugin[object], ...]:
        """Return the running plugins and sensors of a model."""
        return tuple(self._plugins.get(model, ()))

    @property
    def world_plugins(self) -> tuple[SimulatedPlugin[object], ...]:
        """The running plugins of the world."""
        return tuple(self._plugins.get(_WORLD_OWNER, ()))

    def find_water(self) -> WaterSurface | None:
        """Return the surface of the water on which plugins float bodies, or None.

        If plugins differ, the surface has waves: some plugins may not have received them.
        """
        surfaces = [plugin.water for plugin in self._running_plugins() if plugin.water is not None]
        return next((surface for surface in surfaces if surface.waves), surfaces[0] if surfaces else None)

    def spawn(self, model: Model, name: str, pose: Transform = IDENTITY, namespace: str = "") -> None:
        """Add a model to the world and start its plugins.

        Args:
            model: the model, with its includes resolved.
            name: the name of the model in the world.
            pose: the pose of the model's frame in the world; a model inside the ground is lifted onto it.
            namespace: the default namespace for the nodes of the model's plugins.

        Raises:
            LinkwrightError: SIM102, there is already a model with this name; SIM140, the model cannot be placed or
                moved.
        """
        if name in self.simulation.scene.models:
            raise LinkwrightError(Diagnostic("SIM102", phrase("a model '{name}' already exists", name=name)))
        self._replace_models((), (AddedModel(model, name, pose, namespace),))
        lift_onto_ground(self.simulation, name)
        self.report(find_overlaps(self.simulation, (name,)))
        self.report(find_collision_warnings(self.simulation, name), name)
        self._warn_unsimulated(find_unsimulated_model_elements(model, self.simulation.world))

    def replace_model(self, model: Model, name: str) -> None:
        """Replace a model with a changed model, and keep the pose, velocity and joint positions.

        Args:
            model: the changed model, with its includes resolved.
            name: the name of the running model, which the changed model keeps.

        Raises:
            LinkwrightError: SIM141, there is no model with this name; SIM140, the changed model cannot be placed or
                moved, and nothing has changed.
        """
        old_model = self._find_model(name)
        added = AddedModel(model, name, old_model.pose, self._namespaces.get(name, ""), keeps_motion=True)
        check_models(self.simulation.world, self.simulation, (added,), self.simulation.finder)
        self._replace_models((), (replace(added, motion=record_motion(self.simulation, name)),))
        self.report(find_collision_warnings(self.simulation, name), name)

    def load(
        self, world: World, finder: ResourceFinder, check_findings: Callable[[Sequence[Diagnostic]], object]
    ) -> None:
        """Replace the running world with another one.

        Models and plugins that both worlds contain continue, and spawned models remain.

        Args:
            world: the other world, with its includes resolved.
            finder: the finder of mesh files.
            check_findings: called before anything changes, with the findings on elements that cannot be simulated. It
                may raise an error to prevent the replacement.

        Raises:
            LinkwrightError: SIM102, a model has the name of a spawned model; SIM104, SIM140, the world cannot be
                simulated. The running world is then unchanged.
        """
        simulation, old_world = self.simulation, self.simulation.world
        new_world = with_saved_state(world)
        changes = find_changes(new_world, simulation.scene.models, self._world_models)
        if get_properties_used_by_plugins(old_world) != get_properties_used_by_plugins(new_world):
            changes = changes.with_all_replaced(simulation.scene.models, self._namespaces)
        changes = changes.with_connected_replaced(simulation.scene.models, self._namespaces)
        check_findings(check_models(new_world, simulation, (*changes.replaced, *changes.added), finder))
        replaced = tuple(replace(change, motion=record_motion(simulation, change.name)) for change in changes.replaced)
        simulation.set_world(world, finder)
        simulation.set_initial_poses(changes.moved)
        self._replace_models(changes.removed_names, (*replaced, *changes.added))
        self.report(find_overlaps(simulation, {*changes.moved, *(change.name for change in changes.added)}))
        self._world_models = {model.name for model in new_world.models}
        if not have_equal_content(old_world.plugins, new_world.plugins):
            self._close_plugins(self._plugins.pop(_WORLD_OWNER, []))
            self._start_plugins(_WORLD_OWNER, world_plugins(new_world, self._options.systems), "")

    def _replace_models(self, removed: Iterable[str], added: Sequence[AddedModel]) -> None:
        """Remove the models in `removed`, and add the models in `added`.

        An added model replaces a running model of the same name. Models attached to a removed or replaced model are
        also replaced.
        """
        simulation = self.simulation
        old_count = len(simulation.scene.diagnostics)
        old_plugins: dict[str, list[SimulatedPlugin[object]]] = {}
        removed, added = (
            tuple(removed),
            (*added, *self._attached_models({*removed, *(change.name for change in added)})),
        )
        removed_names = {*removed, *(change.name for change in added)}
        for name in [name for name in reversed(simulation.scene.models) if name in removed_names]:
            old_plugins[name] = self._plugins.pop(name, [])
            self._close_plugins(old_plugins[name])
            simulation.delete(name)
        self._remove_findings(removed_names)
        if added:
            add_models(simulation, added)
        for change in added:
            if change.motion is not None:
                restore_motion(simulation, change.name, change.motion, keeps_pose=change.keeps_motion)
        self.report(simulation.scene.diagnostics[old_count:])
        for change in added:
            self._namespaces[change.name] = change.namespace
            contexts = model_plugins(simulation.world, change.model, change.name)
            is_continued = change.keeps_motion and change.motion is not None
            self._start_plugins(
                change.name, contexts, change.namespace, old_plugins[change.name] if is_continued else ()
            )
        self._call_on_change()

    def _attached_models(self, names: Collection[str]) -> Iterator[AddedModel]:
        """Yield the models that joints of the world attach to the named models.

        These models are added again, with their current poses and velocities.
        """
        models = self.simulation.scene.models
        for name in {
            item: None
            for removed_name in names & models.keys()
            for item in self.simulation.scene.find_attached_models(removed_name)
        }:
            if name not in names:
                motion = record_motion(self.simulation, name)
                scene_model, namespace = models[name], self._namespaces.get(name, "")
                yield AddedModel(scene_model.model, name, scene_model.pose, namespace, motion, keeps_motion=True)

    def delete(self, name: str) -> None:
        """Stop the plugins of a model, and remove the model.

        Models attached to it by joints remain.

        Raises:
            LinkwrightError: SIM141, there is no model with this name.
        """
        self._find_model(name)
        self._replace_models((name,), ())
        self.stored_values.clear()
        self._world_models.discard(name)

    def _find_model(self, name: str) -> SceneModel:
        if name not in self.simulation.scene.models:
            raise LinkwrightError(Diagnostic("SIM141", phrase("there is no model '{name}'", name=name)))
        return self.simulation.scene.models[name]

    def reset(self) -> None:
        """Restart at time 0, with the initial poses and the same random numbers."""
        self.simulation.reset()
        for plugin in self._running_plugins():
            plugin.node.calls.call(plugin.reset)
        for function in self.on_reset:
            function()

    def advance(self, duration: int) -> None:
        """Run posted commands, advance simulated time, and publish all messages in this thread.

        Args:
            duration: the time to advance, in nanoseconds.

        Raises:
            UnstableError: a value in the simulation is no longer finite.
        """
        self.exchange.run_commands()
        try:
            self.simulation.advance(duration)
        finally:
            self.exchange.deliver()

    def close(self) -> None:
        """Stop all plugins of the world and of its models."""
        self._bridged.close()
        self._close_plugins(self._running_plugins())
        self._plugins.clear()

    def _running_plugins(self) -> list[SimulatedPlugin[object]]:
        return [plugin for plugins in self._plugins.values() for plugin in plugins]

    def _close_plugins(self, plugins: list[SimulatedPlugin[object]]) -> None:
        for plugin in reversed(plugins):
            self._release_node_name(plugin.context, plugin.node)
            plugin.close(partial(self._log_failure, plugin.context))

    def _release_node_name(self, context: PluginContext, node: PluginNode) -> None:
        if not is_shared(context):
            self._node_names.discard(node.name)

    def _call_on_change(self) -> None:
        for function in self.on_change:
            function()

    # --- plugins ------------------------------------------------------------------------------------------------------

    def _start_plugins(
        self,
        owner: str,
        contexts: Iterable[PluginContext],
        namespace: str,
        old_plugins: Sequence[SimulatedPlugin[object]] = (),
    ) -> None:
        """Start the plugins and sensors of a model or world.

        Unchanged plugins take over the state of their previous instances in `old_plugins`.
        """
        self._plugins[owner] = []
        unsimulated_contexts: list[PluginContext] = []
        for context in contexts:
            with self._logging_failures(context):
                plugin_type = self._find_plugin_class(context)
                if plugin_type is None:
                    unsimulated_contexts.append(context)
                else:
                    self._start_plugin(owner, plugin_type, context, namespace, old_plugins)
        read_sensors = {name for plugin in self._plugins[owner] for name in plugin.read_sensors}
        unsimulated: dict[str, bool] = {}
        for context in unsimulated_contexts:
            if context.plugin is not None or context.sensor is None or context.sensor.name not in read_sensors:
                unsimulated |= _find_unsimulated_names(context)
        new_names = {name: unsimulated[name] for name in unsimulated if name not in self._logged_names}
        self._logged_names.update(new_names)
        if new_names:
            report_unsimulated_plugins(new_names, self.simulation.finder, self.node.get_logger().info)

    def _find_plugin_class(self, context: PluginContext) -> PluginClass | None:
        if context.plugin is None:
            assert context.sensor is not None
            return find_sensor_class(context.sensor.sensor.type)
        filename, original = context.plugin.filename, find_original_library(context.plugin.name)
        found_class = find_plugin_class(library_name(filename))
        if (
            found_class is None
            and (found_class := find_plugin_class(original)) is not None
            and filename not in self._logged_names
        ):
            self._logged_names.add(filename)
            notice = phrase(
                "'{copy}' is simulated as '{original}', because its plugin class belongs to '{original}'",
                copy=filename,
                original=original,
            )
            self.node.get_logger().info(notice)
        return found_class

    def _start_plugin(
        self,
        owner: str,
        plugin_type: PluginClass,
        context: PluginContext,
        namespace: str,
        old_plugins: Sequence[SimulatedPlugin[object]],
    ) -> None:
        """Start a plugin or sensor.

        The plugin or sensor resumes from its unchanged previous instance, if `old_plugins` contains one.
        """
        calls = Calls(lambda error: self._end_failed_plugin(owner, context, error))
        node = self._create_node(context, namespace, calls)
        started: list[SimulatedPlugin[object]] = []

        def start() -> None:
            parameters, findings = parameters_from(
                plugin_type.PARAMETERS, context.plugin.element if context.plugin else None, plugin_type.IGNORED
            )
            self.report(findings)
            plugin = plugin_type(context, node, parameters, self)
            started.append(plugin)
            self._plugins[owner].append(plugin)
            plugin.start()
            predecessor = next(
                (simulated_plugin for simulated_plugin in old_plugins if plugin.is_same_plugin(simulated_plugin)), None
            )
            if predecessor is not None:
                plugin.resume(predecessor)

        calls.call(start)
        if not started:
            self._release_node_name(context, node)
            node.close()

    def _end_failed_plugin(self, owner: str, context: PluginContext, error: Exception) -> None:
        """Log the error of a plugin or sensor, and end only that plugin."""
        self._log_failure(context, error)
        running = self._plugins.get(owner, [])
        failed_plugins = [simulated_plugin for simulated_plugin in running if simulated_plugin.context is context]
        running[:] = [simulated_plugin for simulated_plugin in running if simulated_plugin.context is not context]
        self._close_plugins(failed_plugins)

    def _log_failure(self, context: PluginContext, error: Exception) -> None:
        self.report(error_findings(error, context.name, context.element))
        if not isinstance(error, LinkwrightError):
            for function in self.on_failure:
                function(error)

    def _create_node(self, context: PluginContext, namespace: str, calls: Calls) -> PluginNode:
        """Return the node for a plugin or sensor.

        Plugins of gz, sensors without a plugin, and some plugins of Gazebo Classic share the simulator's node; other
        plugins get a separate node.

        Raises:
            LinkwrightError: SIM135, another plugin has a node with the same name.
        """
        if is_shared(context):
            return PluginNode(
                self.node,
                self.exchange,
                owned=False,
                qos={},
                used_conventional_topics=self._used_conventional_topics,
                bridged=self._bridged,
                now_ns=self._get_time_ns,
                calls=calls,
            )
        node_description = read_node_description(context.name, context.element, namespace)
        full_name = node_description.full_name
        if full_name in self._node_names:
            message = phrase(
                "plugin '{plugin}' is not loaded: another plugin already uses the node name '{name}'",
                plugin=context.name,
                name=full_name,
            )
            hint = phrase("give the plugin another name, or a namespace in <ros>")
            span, source = (context.element.span(), context.element.source) if context.element else (None, None)
            raise LinkwrightError(Diagnostic("SIM135", message, span, hint=hint, source=source))
        node = Node(
            self.node.graph,
            node_description.name,
            namespace=node_description.namespace,
            parameters={"use_sim_time": True, **node_description.parameters},
            remappings=node_description.remappings,
        )
        self._node_names.add(full_name)
        node.graph.creators[node.get_logger().name] = self.node.get_logger().name
        return PluginNode(
            node,
            self.exchange,
            owned=True,
            qos=node_description.qos,
            used_conventional_topics=None,
            now_ns=self._get_time_ns,
            calls=calls,
        )

    def _get_time_ns(self) -> int:
        return self.simulation.time

    def _warn_unsimulated(self, elements: Iterable[str]) -> None:
        new_names = [element for element in elements if element not in self._logged_names]
        self._logged_names.update(new_names)
        if new_names:
            self.node.get_logger().info(phrase("these elements are not simulated: {names}", names=joined(new_names)))

    @contextmanager
    def _logging_failures(self, context: PluginContext) -> Iterator[None]:
        """Log and suppress an error in the context, so that other plugins are still started."""
        try:
            yield
        except Exception as error:  # noqa: BLE001 - a plugin of any world or package may raise anything
            self._log_failure(context, error)

    def report(self, findings: Iterable[Diagnostic], model: str = _WORLD_OWNER) -> None:
        """Log each new finding once, and keep the findings about a model in `findings`.

        The findings about a model are removed with the model.
        """
        reported = list(findings)
        if reported and model != _WORLD_OWNER:
            self._findings.setdefault(model, []).extend(reported)
            self._call_on_findings()
        for diagnostic in reported:
            text = f"{diagnostic.span}: {diagnostic.message}" if diagnostic.span else str(diagnostic.message)
            if text in self._logged_names:
                continue
            self._logged_names.add(text)
            logger = self.node.get_logger()
            line = f"{text} ({diagnostic.hint})" if diagnostic.hint else text
            if diagnostic.severity is Severity.ERROR:  # The logger distinguishes calls by line.
                logger.error(line)
            else:
                logger.warning(line)

    def show_pace(self, finding: Diagnostic | None) -> None:
        """Keep and log the finding that the world is slow, or remove it."""
        self._remove_findings({_PACE_OWNER})
        if finding is not None:
            self.report([finding], _PACE_OWNER)

    def _remove_findings(self, models: Collection[str]) -> None:
        models_with_findings = models & self._findings.keys()
        for name in models_with_findings:
            del self._findings[name]
        if models_with_findings:
            self._call_on_findings()

    def _call_on_findings(self) -> None:
        for function in self.on_findings:
            function()


def is_shared(context: PluginContext) -> bool:
    """Return whether a plugin or sensor shares the simulator's node."""
    return context.plugin is None or shares_node(context.plugin.filename)


def _find_unsimulated_names(context: PluginContext) -> dict[str, bool]:
    """Return the library or sensor type of a plugin that is not simulated, and whether it is a library.

    The result is empty if the simulation itself does the work of the library.
    """
    if context.plugin is None:
        return {} if context.sensor is None else {context.sensor.sensor.type: False}
    return {} if is_built_in(context.plugin.filename) else {context.plugin.filename: True}
