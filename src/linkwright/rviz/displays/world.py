"""The display linkwright/World: the models of a simulated world."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, joined, phrase
from linkwright.geometry.single import Transform, compose, invert
from linkwright.graph import LATCHED_QOS, TF_QOS, TransformException
from linkwright.messages import TFMessage
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.page.protocol.robot import MeshStatus
from linkwright.page.protocol.worlds import CameraScene, WorldPoses, WorldRays, WorldScene, WorldWater
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, alpha, topic_spec
from linkwright.rviz.config.simulated_world import (
    DESCRIPTION_TOPIC,
    POSES_TOPIC,
    RAYS_TOPIC,
    WATER_TOPIC,
    WORLD_DISPLAY,
)
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import SideTopic, TopicDisplay
from linkwright.rviz.displays.world_rays import RAY_CHOICES, LidarRays
from linkwright.rviz.frames.history import PlacedFrame
from linkwright.rviz.lights import convert_lights
from linkwright.rviz.sensors import DisplayedLidar, convert_sensors
from linkwright.rviz.skies import compute_daylight, convert_fog
from linkwright.rviz.viewpoints import find_camera, find_robots
from linkwright.rviz.water import convert_water
from linkwright.rviz.worlds import WorldContent, make_content
from linkwright.sdf.frames import FrameError
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.sdf.reader import read
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import World

_POSES_PROPERTY = "Poses Topic"
_RAYS_TOPIC_PROPERTY, _RAYS_PROPERTY, _FRUSTUMS_PROPERTY = "Rays Topic", "Lidar Rays", "Camera Frustums"
_FRAME_ROW = "Frame"
_WORLD_ROW = "World"
_SCENE_KEY, _POSES_KEY, _WATER_KEY = "scene", "poses", "water"
_MAX_FINDINGS = 5
_MOVE_TOLERANCE = 1e-6
"""The smallest change of a position in m, or of a quaternion, after which the frames of tf are placed again."""


class WorldDisplay(TopicDisplay):
    """A display of all models of a world, with each link at its pose in the simulation.

    The poses are in the frame ``world``. If tf has no such frame, a link with the name of a tf frame connects both: the
    world is placed so that this link is at the pose of the tf frame. If the Fixed Frame is ``world``, the frames of tf
    are placed instead.
    """

    CLASS = WORLD_DISPLAY
    MESSAGE = "std_msgs/msg/String"
    TRANSFORMED = False
    FOLLOWS_TRANSFORMS = True
    SCHEMA = (
        topic_spec(
            default=DESCRIPTION_TOPIC,
            description="The topic of the world's SDF, std_msgs/msg/String.",
            depth=1,
            durability="Transient Local",
        ),
        PropertySpec(_POSES_PROPERTY, "string", POSES_TOPIC, "The topic of the links' poses, tf2_msgs/msg/TFMessage."),
        PropertySpec("Visual Enabled", "bool", True, "Draw the visual geometry."),
        PropertySpec("Collision Enabled", "bool", False, "Draw the collision geometry."),
        alpha("Opacity of all models: 0 is invisible."),
        PropertySpec(
            "Light",
            "enum",
            "Automatic",
            "The lights of the scene: one at the camera, as in RViz, a studio, or the world's, with its background, "
            "sky and fog. "
            "Automatic: the studio if a graphics card draws fast enough, else a soft light at the camera.",
            options=("Automatic", "Camera", "Studio", "World"),
        ),
        PropertySpec("Shadows", "bool", True, "Let the lights of the studio and of the world cast shadows."),
        PropertySpec(
            _RAYS_PROPERTY,
            "enum",
            RAY_CHOICES[0],
            "Draw the rays of lidars at their measured lengths: of lidars with "
            "<visualize>true</visualize>, of all, or of none. If a lidar has very many rays, only some "
            "are drawn.",
            options=RAY_CHOICES,
        ),
        PropertySpec(_RAYS_TOPIC_PROPERTY, "string", RAYS_TOPIC, "The topic of the rays, sensor_msgs/msg/LaserScan."),
        PropertySpec(
            _FRUSTUMS_PROPERTY,
            "enum",
            RAY_CHOICES[0],
            "Draw the view of cameras, from the near to the far plane: of cameras with "
            "<visualize>true</visualize>, of all, or of none.",
            options=RAY_CHOICES,
        ),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._poses_topic = SideTopic(host, "tf2_msgs/msg/TFMessage", self._on_poses)
        self._rays = LidarRays(host, self._show_rays, lambda lidar: self.remove_content(_rays_key(lidar)))
        self._water_topic = SideTopic(host, "std_msgs/msg/Float64MultiArray", self._on_water)
        self._water: WorldWater | None = None
        self._reading_task: asyncio.Task[None] | None = None
        self._revision = 0
        self._content = WorldContent()
        self._link_indices: dict[str, int] = {}
        self._poses: NDArray[np.float64] = np.empty((0, 7))
        self._moving_links: Sequence[str] = ()
        """The links in the last message of poses: all links that move."""
        self._stamp_ns = 0
        self._anchors: tuple[int, ...] = ()
        self._places_tf_frames = False
        self._world_pose: tuple[str, Pose | None] = ("", None)
        self._last_sent: tuple[Any, ...] = ()
        self._page_problems: dict[tuple[str, str], Phrase] = {}

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe to the description and to the poses."""
        super().start()
        self._subscribe_poses()
        self._subscribe_water()

    def stop(self) -> None:
        """Unsubscribe, and end the pages' access to the files of the world."""
        super().stop()
        self._poses_topic.close()
        self._water_topic.close()
        self._rays.close()
        self.context.transforms.set_placed_frame(self.id, None)
        self.context.meshes.replace(self.id, {})

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to other topics, or to the rays of other lidars."""
        super().on_property_changed(path)
        if path == (_POSES_PROPERTY,):
            self._subscribe_poses()
        elif path in ((_RAYS_PROPERTY,), (_RAYS_TOPIC_PROPERTY,)):
            self._subscribe_rays()

    def on_enabled_changed(self) -> None:
        """Subscribe if the display is enabled, or unsubscribe."""
        super().on_enabled_changed()
        self._subscribe_poses()
        self._subscribe_rays()
        self._subscribe_water()

    def on_time_changed(self) -> None:
        """Process the messages that were queued while time was paused."""
        super().on_time_changed()
        self._poses_topic.resume()
        self._water_topic.resume()
        self._rays.resume()

    def on_time_reset(self) -> None:
        """Hide the lidar rays until new measurements arrive.

        The world stays visible, because its description is not published again.
        """
        self._rays.clear()

    def reset(self) -> None:
        """Discard the world.

        The display stays empty until another description arrives.
        """
        self._cancel_reading()
        self._content, self._link_indices, self._last_sent = WorldContent(), {}, ()
        self._page_problems.clear()
        self._water = None
        self._rays.set_lidars(())
        self.context.meshes.replace(self.id, {})
        self.remove_content()

    def on_frames_changed(self) -> None:
        """Compute the pose of the world again, and send the poses."""
        self._show_poses()

    def on_transforms_received(self) -> None:
        """Place the world, if it has not been placed yet.

        Once it is placed, each message with poses updates its pose.
        """
        world_frame = self.context.transforms.placed_frame(WORLD)
        is_placed = (
            self._world_pose[1] is not None
            if not self._places_tf_frames
            else world_frame is not None and world_frame.parent is not None
        )
        if self._content.links and not is_placed and (self._places_tf_frames or self._world_pose[0] != WORLD):
            self._show_poses()

    def receive(self, status: MeshStatus) -> None:
        """Show in the status whether a page could load a mesh of the world."""
        row = self._link_indices.get(status.link)
        if row is None:
            return
        link = self._content.links[row]
        if not any(shape.url == status.url for shape in (*link.visuals, *link.collisions)):
            return
        key = (status.link, status.url)
        if status.error is None:
            self._page_problems.pop(key, None)
        else:
            name = status.url.partition("?")[0].rpartition("/")[2]
            self._page_problems[key] = phrase(
                "Could not load mesh '{name}': {reason}", name=name, reason=status.error[:500]
            )
        self._report_problems()

    def _subscribe_poses(self) -> None:
        self._poses_topic.close()
        topic = self.properties.text(_POSES_PROPERTY).strip()
        if not self.enabled or not topic:
            return
        problem = self._poses_topic.listen(topic, TF_QOS)
        if problem is not None:
            self.set_status_row(_POSES_PROPERTY, "error", problem)

    def _subscribe_water(self) -> None:
        self._water_topic.close()
        if self.enabled:
            self._water_topic.listen(WATER_TOPIC, LATCHED_QOS)

    def _on_water(self, message: Any) -> None:
        self._water = convert_water(message)
        if self._water is None:
            self.remove_content(_WATER_KEY)
        else:
            self.send(self._water, key=_WATER_KEY)

    def _subscribe_rays(self) -> None:
        problem = self._rays.subscribe(
            self.properties.text(_RAYS_TOPIC_PROPERTY).strip() if self.enabled else "",
            self.properties.text(_RAYS_PROPERTY),
        )
        if problem is None:
            self.delete_status_row(_RAYS_TOPIC_PROPERTY)
        else:
            self.set_status_row(_RAYS_TOPIC_PROPERTY, "error", problem)

    # --- descriptions ------------------------------------------------------------------------------------------

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Start reading a description.

        The previous world is shown until the new one has been read.
        """
        self._cancel_reading()
        self._reading_task = asyncio.get_running_loop().create_task(self._read(message.data))

    def _cancel_reading(self) -> None:
        if self._reading_task is not None:
            self._reading_task.cancel()
            self._reading_task = None

    async def _read(self, text: str) -> None:
        index = MeshIndex(self.context.finder)
        try:
            world, content = await asyncio.to_thread(_read_content, text, index)
        except LinkwrightError as error:
            self._refuse(error.diagnostics)
            return
        except FrameError as error:
            self.set_status_row(
                _WORLD_ROW, "error", phrase("The pose of '{name}' cannot be determined", name=error.name)
            )
            return
        self.context.meshes.replace(self.id, index.folders)
        previous_indices = {link.name: row for row, link in enumerate(self._content.links)}
        poses = np.array(content.poses, dtype=np.float64).reshape(-1, 7)
        moving_links = frozenset(self._moving_links)
        static_prefixes = tuple(f"{model.name}{SEPARATOR}" for model in world.models if model.static)
        for row, link in enumerate(content.links):  # keep the poses of moving links until new poses arrive
            if (
                link.name in moving_links
                and link.name in previous_indices
                and not link.name.startswith(static_prefixes)
            ):
                poses[row] = self._poses[previous_indices[link.name]]
        self._revision += 1
        self._content, self._poses, self._last_sent = content, poses, ()
        self._link_indices = {link.name: row for row, link in enumerate(content.links)}
        self._anchors = _find_anchors(content)
        self._page_problems.clear()
        lidars, cameras = convert_sensors(world)
        self.send(_make_world_scene(self._revision, world, content, lidars, cameras), key=_SCENE_KEY)
        self._rays.set_lidars(lidars)
        self._subscribe_rays()
        self.set_status_row(
            _WORLD_ROW,
            "ok",
            phrase("{models} models, {links} links", models=len(world.models), links=len(content.links)),
        )
        self._report_problems()
        self._show_poses()

    def _refuse(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR][:_MAX_FINDINGS]
        texts = [error.located_message for error in errors] or [phrase("The description is not SDF")]
        self.set_status_row(_WORLD_ROW, "error", joined(texts, "; "))

    def _report_problems(self) -> None:
        problems = [(link, text) for link, texts in self._content.problems.items() for text in texts]
        problems += [(link, text) for (link, _), text in self._page_problems.items()]
        self._report("Files", "error", [joined((link, text), ": ") for link, text in problems])

    def _report(self, name: str, level: StatusLevel, texts: list[Phrase]) -> None:
        extra_count = len(texts) - _MAX_FINDINGS
        if texts:
            text = joined(texts[:_MAX_FINDINGS], "; ")
            self.set_status_row(
                name,
                level,
                phrase("{texts}; and {count} more", texts=text, count=extra_count) if extra_count > 0 else text,
            )
        else:
            self.delete_status_row(name)

    # --- poses -------------------------------------------------------------------------------------------------

    def _on_poses(self, message: TFMessage) -> None:
        batch = message.batch
        rows = [self._link_indices.get(child, -1) for child in batch.children]
        poses = np.asarray(batch.poses)
        if not np.isfinite(poses).all():
            self.set_status_row(
                _POSES_PROPERTY, "error", phrase("Message contained invalid floating point values (nans or infs)")
            )
            return
        self.delete_status_row(_POSES_PROPERTY)
        self._moving_links = batch.children
        # Locate with the previous poses: the transforms for the new poses may not have arrived yet.
        self._place_world()
        known_indices = [index for index, row in enumerate(rows) if row >= 0]
        self._poses[[rows[pose_index] for pose_index in known_indices]] = poses[known_indices]
        self._stamp_ns = batch.stamp_ns
        self._send_poses()

    def _show_poses(self) -> None:
        self._place_world()
        self._send_poses()

    def _send_poses(self) -> None:
        if not self._content.links:
            return
        frame, pose = self._world_pose
        time_ns = self._stamp_ns if self._water is not None and self._water.waves else 0
        pose_state = (self._revision, self._poses.tobytes(), frame, None if pose is None else pose.tobytes(), time_ns)
        if pose_state == self._last_sent:
            return
        self._last_sent = pose_state
        content = WorldPoses(self._revision, self._poses.astype(np.float32))
        self.send(content, key=_POSES_KEY, frame=frame, pose=pose, stamp_ns=self._stamp_ns)

    def _show_rays(self, rays: WorldRays) -> None:
        self.send(rays, key=_rays_key(rays.lidar))

    def _place_world(self) -> None:
        """Compute the pose of the world in the Fixed Frame from the last poses of its links."""
        if not self._content.links:
            return
        frames = self.context.transforms.names()
        self._places_tf_frames = self.host.frames.fixed_frame == WORLD and WORLD not in frames
        if not self._places_tf_frames:
            self.context.transforms.set_placed_frame(self.id, None)
        anchor = self._find_anchor(frames) if self._places_tf_frames or WORLD not in frames else None
        if self._places_tf_frames or WORLD in frames:
            self._world_pose = (WORLD, None)
            self.set_status_row(_FRAME_ROW, "ok", phrase("The world is placed at the frame '{world}'", world=WORLD))
            if anchor is not None:
                self._place_frames(*anchor)
            elif self._places_tf_frames and self.context.transforms.placed_frame(WORLD) is None:
                self.context.transforms.set_placed_frame(self.id, PlacedFrame(WORLD))
        elif anchor is not None:
            row, frame, pose = anchor
            self._world_pose = ("", np.array(compose(pose, invert(tuple(self._poses[row])))))
            self.set_status_row(
                _FRAME_ROW,
                "ok",
                phrase(
                    "tf has no frame '{world}': the world is placed so that '{frame}' has the same pose in both",
                    world=WORLD,
                    frame=frame,
                ),
            )
        elif self._world_pose[1] is None:
            self._world_pose = ("", None)
            self.set_status_row(
                _FRAME_ROW,
                "warn",
                phrase(
                    "tf has neither '{world}' nor a frame of a model: the world is placed at the Fixed Frame",
                    world=WORLD,
                ),
            )

    def _place_frames(self, row: int, frame: str, pose: Transform) -> None:
        """Place the frames of tf in the world so that a frame is at the pose of its link.

        Args:
            row: the index of the link in the content of the world.
            frame: the frame that has the link's name.
            pose: the pose of the frame in the root frame of its tf tree.
        """
        pose_in_world = np.array(compose(tuple(self._poses[row]), invert(pose)))
        transforms, root = self.context.transforms, self._find_root(frame)
        previous_frame = transforms.placed_frame(WORLD)
        if (
            previous_frame is None
            or previous_frame.parent != root
            or np.abs(previous_frame.pose - pose_in_world).max() > _MOVE_TOLERANCE
        ):
            transforms.set_placed_frame(self.id, PlacedFrame(WORLD, root, pose_in_world))
        self.set_status_row(
            _FRAME_ROW,
            "ok",
            phrase(
                "tf has no frame '{world}': the frames of tf are placed so that '{frame}' has the same pose in both",
                world=WORLD,
                frame=frame,
            ),
        )

    def _find_anchor(self, frames: frozenset[str]) -> tuple[int, str, Transform] | None:
        """Return a link with the name of a tf frame whose pose is known, or None.

        Returns:
            The index of the link, its frame, and the pose of the frame. The pose is in the root frame of the tf tree
            if the world determines the poses of tf's frames, and in the Fixed Frame if not.
        """
        for row in self._anchors:
            frame = _frame_name(self._content.links[row].name)
            if frame not in frames:
                continue
            reference = self._find_root(frame) if self._places_tf_frames else self.host.frames.fixed_frame
            for stamp_ns in (self._stamp_ns, 0):
                with suppress(TransformException):
                    return row, frame, tuple(self.context.transforms.pose(reference, frame, stamp_ns))
        return None

    def _find_root(self, frame: str) -> str:
        """Return the root frame of the tf tree that contains a frame."""
        names, parents = self.host.frames.names, self.host.frames.parents
        if frame not in names:
            return frame
        row = names.index(frame)
        for _ in names:
            if parents[row] < 0:
                break
            row = parents[row]
        return names[row]


def _make_world_scene(
    revision: int, world: World, content: WorldContent, lidars: list[DisplayedLidar], cameras: list[CameraScene]
) -> WorldScene:
    camera = find_camera(world)
    return WorldScene(
        revision,
        world.name,
        content.links,
        convert_lights(world),
        list(world.scene.ambient[:3]),
        list(world.scene.background[:3]),
        world.scene.shadows,
        [lidar.scene for lidar in lidars],
        cameras,
        find_robots(world),
        None if camera is None else list(camera),
        compute_daylight(world.scene.sky),
        convert_fog(world.scene.fog),
    )


def _read_content(text: str, index: MeshIndex) -> tuple[World, WorldContent]:
    """Return the world described by a text, and the content that draws the world.

    Raises:
        LinkwrightError: the text is not SDF, or contains neither a world nor a model.
        FrameError: an element's pose cannot be determined.
    """
    document, _ = parse_as_gazebo(text, "<world>")
    reading = read(document)
    sdf = reading.sdf
    if sdf is None or not (sdf.worlds or sdf.models):
        raise LinkwrightError(*reading.diagnostics)
    world = sdf.worlds[0] if sdf.worlds else World(sdf.models[0].name, models=sdf.models)
    return world, make_content(world, index)


def _rays_key(lidar: str) -> str:
    return f"rays {lidar}"


def _frame_name(name: str) -> str:
    return name.rpartition(SEPARATOR)[2]


def _find_anchors(content: WorldContent) -> tuple[int, ...]:
    """Return the indices of the links with a unique frame name, in file order.

    These links are the possible anchors.
    """
    counts = Counter(_frame_name(link.name) for link in content.links)
    return tuple(row for row, link in enumerate(content.links) if counts[_frame_name(link.name)] == 1)
