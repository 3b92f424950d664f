"""A simulator's own topics: time, state, description, poses and performance."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.conversion import with_changed_uris
from linkwright.geometry.single import Transform
from linkwright.graph import LATCHED_QOS, SIMULATION_CLOCK_QOS
from linkwright.graph.stepped.node import Output, SteppedNode
from linkwright.messages import Header, String, Time, get_message
from linkwright.messages.tf_message import TFMessage, TransformBatch
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.frames import pose_of
from linkwright.sdf.models import Model
from linkwright.sdf.poses import WORLD, RawPose
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.writer import WrittenModel, save_model_of_world, save_world
from linkwright.simulation.plugins.water import WATER_TOPIC, WATER_TYPE, WaterSurface, create_water_message
from linkwright.simulation.server.server import SimulationServer

T = TypeVar("T")
_CLOCK_TYPE, _STATE_TYPE = "rosgraph_msgs/msg/Clock", "simulation_interfaces/msg/SimulationState"
_METRICS_TYPE = "gazebo_msgs/msg/PerformanceMetrics"
_POSES_PERIOD_S, _METRICS_PERIOD_S, _PAUSED_CLOCK_PERIOD_S = 1 / 30, 0.5, 0.1
"""The publishing periods of poses, performance metrics and the time of a paused simulation, in s of real time."""
PLAYING, PAUSED = 1, 2
"""The values of ``state`` in simulation_interfaces/msg/SimulationState."""


class Reports:
    """The publishers of a simulator's own topics, for use in the simulation's thread.

    Args:
        server: the server of the simulation.
        node: the simulator's node.
        clock_rate: the rate of ``/clock`` in simulated time, in Hz; 0 for every step.
        repeats_time: whether a paused simulation repeats its time, at 10 Hz of real time.
    """

    def __init__(
        self, server: SimulationServer, node: SteppedNode, clock_rate: float, *, repeats_time: bool = False
    ) -> None:
        self._server = server
        self._repeats_time = repeats_time
        self._clock = node.publisher(_CLOCK_TYPE, "/clock", SIMULATION_CLOCK_QOS)
        self._state = node.publisher(_STATE_TYPE, "/simulation_state", LATCHED_QOS)
        self._description = node.publisher("std_msgs/msg/String", "/world_description", LATCHED_QOS)
        self._poses = node.publisher("tf2_msgs/msg/TFMessage", "/world_poses", 10)
        self._metrics = node.publisher(_METRICS_TYPE, "/performance_metrics", 10)
        self._node = node
        self._water_output: Output | None = None
        self._water: WaterSurface | None = None
        self._names: tuple[str, ...] = ()
        self._bodies: NDArray[np.intp] = np.zeros(0, dtype=np.intp)
        self._revision = -1
        self._finder: ResourceFinder | None = None
        self._saved_models: dict[
            tuple[int, str, Transform], tuple[Model, WrittenModel]
        ] = {}  # stored models keep their ids
        self._last_poses = self._last_metrics = self._last_repeat = 0.0
        server.on_reset.append(self._publish_time)
        server.simulation.call_every(
            round(NANOSECONDS_PER_SECOND / clock_rate) if clock_rate > 0 else 0, self._publish_time
        )

    def start_description(self) -> None:
        """Publish the description of the world now and after each change."""
        self._server.on_change.append(self.publish_description)
        self.publish_description()

    def publish_state(self, *, paused: bool) -> None:
        """Publish whether the simulation is paused."""
        self._state.publish(get_message(_STATE_TYPE)(state=PAUSED if paused else PLAYING))

    def publish_description(self) -> None:
        """Publish the world as SDF, with models at their initial poses and absolute file addresses."""
        simulation = self._server.simulation
        if self._finder is not simulation.finder:
            self._finder, self._saved_models = simulation.finder, {}
        figures = ((figure.model, figure.model.name, figure.pose) for figure in simulation.scene.figures)
        models = [*((model.model, model.name, model.pose) for model in simulation.scene.models.values()), *figures]
        self._saved_models = {
            (id(model), name, pose): self._save_model(model, name, pose) for model, name, pose in models
        }
        world = replace(simulation.world, models=(), actors=(), roads=())
        text = save_world(self._make_uris_absolute(world), [saved for _, saved in self._saved_models.values()])
        self._description.publish(String(data=text))

    def _save_model(self, model: Model, name: str, pose: Transform) -> tuple[Model, WrittenModel]:
        """Return a model and its SDF.

        The SDF is reused if the model, its name and its pose have not changed.
        """
        cached = self._saved_models.get((id(model), name, pose))
        if cached is not None:
            return cached
        placed_model = replace(model, name=name, pose=RawPose(pose_of(pose)), placement_frame="")
        return model, save_model_of_world(self._make_uris_absolute(placed_model))

    def _make_uris_absolute(self, part: T) -> T:
        converted: T = with_changed_uris(part, Path.cwd(), self._to_absolute_uri)
        return converted

    def publish_due(self, get_factor: Callable[[], float], *, paused: bool) -> None:
        """Publish poses, the real-time factor, and the time of a paused simulation if they are due.

        Poses are due at 30 Hz, the factor at 2 Hz and the time at 10 Hz of real time; call this at least as often.
        Poses and the factor are published only if they have subscriptions.
        """
        now = time.monotonic()
        if paused and self._repeats_time and now - self._last_repeat >= _PAUSED_CLOCK_PERIOD_S:
            self._last_repeat = now
            self._publish_time()
        if now - self._last_poses >= _POSES_PERIOD_S and self._poses.is_wanted:
            self._last_poses = now
            self.publish_water()
            self.publish_poses()
        if now - self._last_metrics >= _METRICS_PERIOD_S and self._metrics.is_wanted:
            self._last_metrics = now
            message = get_message(_METRICS_TYPE)(
                header=Header(stamp=Time.from_nanoseconds(self._server.simulation.time)), real_time_factor=get_factor()
            )
            self._metrics.publish(message)

    def publish_poses(self) -> None:
        """Publish the poses of all links that can move, in the frame ``world``."""
        simulation = self._server.simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._revision = simulation.revision
            model = simulation.model
            self._bodies = np.flatnonzero(model.body_weldid)
            self._names = tuple(model.body(int(body)).name for body in self._bodies)
        data, bodies = simulation.data, self._bodies
        poses = np.hstack([data.xpos[bodies], data.xquat[bodies][:, [1, 2, 3, 0]]])
        batch = TransformBatch((WORLD,) * len(bodies), self._names, simulation.time, poses)
        self._poses.publish(TFMessage(batch=batch))

    def publish_water(self) -> None:
        """Publish the surface of the water if it has changed.

        The topic exists only in worlds with water.
        """
        water = self._server.find_water()
        if water == self._water:
            return
        self._water = water
        if self._water_output is None:
            self._water_output = self._node.publisher(WATER_TYPE, WATER_TOPIC, LATCHED_QOS)
        self._water_output.publish(create_water_message(water))

    def _publish_time(self) -> None:
        self._clock.publish(get_message(_CLOCK_TYPE)(clock=Time.from_nanoseconds(self._server.simulation.time)))

    def _to_absolute_uri(self, uri: str, folder: Path) -> str:
        resolved = self._server.simulation.finder.file(uri, folder) if uri else Missing
        return resolved.as_uri() if isinstance(resolved, Path) and resolved.is_absolute() else uri
