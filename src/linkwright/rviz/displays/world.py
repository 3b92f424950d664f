"""The display linkwright/World: the models of a simulated world, at the poses that the simulation publishes."""

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
from linkwright.graph import TF_QOS, TransformException
from linkwright.messages import TFMessage
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.page.protocol.robot import MeshStatus
from linkwright.page.protocol.worlds import CameraScene, WorldPoses, WorldRays, WorldScene
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, alpha, topic_spec
from linkwright.rviz.config.simulated_world import DESCRIPTION_TOPIC, POSES_TOPIC, RAYS_TOPIC, WORLD_DISPLAY
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import SideTopic, TopicDisplay
from linkwright.rviz.displays.world_rays import CHOICES, LidarRays
from linkwright.rviz.frames.history import OwnFrame
from linkwright.rviz.lights import lights_of
from linkwright.rviz.sensors import ShownLidar, sensors_of
from linkwright.rviz.skies import daylight, fog_of
from linkwright.rviz.viewpoints import camera_of, robots_of
from linkwright.rviz.worlds import WorldContent, content_of
from linkwright.sdf.frames import FrameError
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.sdf.reader import read
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import World

_POSES = "Poses Topic"
_RAYS_TOPIC, _RAYS, _FRUSTUMS = "Rays Topic", "Lidar Rays", "Camera Frustums"
_FRAME = "Frame"
_WORLD = "World"
_SCENE_KEY, _POSES_KEY = "scene", "poses"
_MOST_FINDINGS = 5
_UNMOVED = 1e-6
"""In m, and of quaternions: smaller changes do not move tf's frames in the world."""


class WorldDisplay(TopicDisplay):
    """A display of all models of a world with their visuals, each link at its pose in the simulation.

    The poses are in the frame ``world``. If neither tf nor the Fixed Frame has that name, the world is placed so that
    one of its links, usually a robot's, is at tf's pose for the frame of the same name. If the Fixed Frame has that
    name and tf has no such frame, tf's frames are placed so that the world does not move.
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
        PropertySpec(_POSES, "string", POSES_TOPIC, "The topic of the links' poses, tf2_msgs/msg/TFMessage."),
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
            _RAYS,
            "enum",
            CHOICES[0],
            "Draw the rays of lidars at their measured lengths: of lidars with "
            "<visualize>true</visualize>, of all, or of none. If a lidar has very many rays, only some "
            "are drawn.",
            options=CHOICES,
        ),
        PropertySpec(_RAYS_TOPIC, "string", RAYS_TOPIC, "The topic of the rays, sensor_msgs/msg/LaserScan."),
        PropertySpec(
            _FRUSTUMS,
            "enum",
            CHOICES[0],
            "Draw the view of cameras, from the near to the far plane: of cameras with "
            "<visualize>true</visualize>, of all, or of none.",
            options=CHOICES,
        ),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._side = SideTopic(host, "tf2_msgs/msg/TFMessage", self._moved)
        self._rays = LidarRays(host, self._show_rays, lambda lidar: self.forget(_rays_key(lidar)))
        self._reading: asyncio.Task[None] | None = None
        self._revision = 0
        self._content = WorldContent()
        self._rows_of: dict[str, int] = {}
        self._poses: NDArray[np.float64] = np.empty((0, 7))
        self._posed: Sequence[str] = ()
        """The links of the last poses: all links that move."""
        self._stamp_ns = 0
        self._anchors: tuple[int, ...] = ()
        self._leads = False
        self._placed: tuple[str, Pose | None] = ("", None)
        self._sent: tuple[Any, ...] = ()
        self._page_problems: dict[tuple[str, str], Phrase] = {}

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe to the description and to the poses."""
        super().start()
        self._follow()

    def stop(self) -> None:
        """Unsubscribe, and withdraw the world's files from pages."""
        super().stop()
        self._side.close()
        self._rays.close()
        self.context.transforms.place(self.id, None)
        self.context.meshes.replace(self.id, {})

    def changed(self, path: Path) -> None:
        """Subscribe to other topics, or to the rays of other lidars."""
        super().changed(path)
        if path == (_POSES,):
            self._follow()
        elif path in ((_RAYS,), (_RAYS_TOPIC,)):
            self._follow_rays()

    def enabled_changed(self) -> None:
        """Subscribe if the display is enabled, or unsubscribe."""
        super().enabled_changed()
        self._follow()
        self._follow_rays()

    def time_changed(self) -> None:
        """Process the messages that were queued while time was paused."""
        super().time_changed()
        self._side.resume()
        self._rays.resume()

    def time_reset(self) -> None:
        """Hide the lidar rays until new measurements arrive.

        The world stays visible, because its description is not published again.
        """
        self._rays.forget()

    def reset(self) -> None:
        """Discard the world; nothing is shown until another description arrives."""
        self._cancel()
        self._content, self._rows_of, self._sent = WorldContent(), {}, ()
        self._page_problems.clear()
        self._rays.describe(())
        self.context.meshes.replace(self.id, {})
        self.forget()

    def frames_changed(self) -> None:
        """Compute the pose of the world again, and send the poses."""
        self._show_poses()

    def transforms_received(self) -> None:
        """Place the world if it could not be placed before; later, each pose message updates its pose."""
        own = self.context.transforms.own(WORLD)
        placed = self._placed[1] is not None if not self._leads else own is not None and own.parent is not None
        if self._content.links and not placed and (self._leads or self._placed[0] != WORLD):
            self._show_poses()

    def receive(self, status: MeshStatus) -> None:
        """Show in the status whether a page could load a mesh of the world."""
        row = self._rows_of.get(status.link)
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

    def _follow(self) -> None:
        self._side.close()
        topic = self.properties.text(_POSES).strip()
        if not self.enabled or not topic:
            return
        problem = self._side.listen(topic, TF_QOS)
        if problem is not None:
            self.set_status_row(_POSES, "error", problem)

    def _follow_rays(self) -> None:
        problem = self._rays.follow(
            self.properties.text(_RAYS_TOPIC).strip() if self.enabled else "", self.properties.text(_RAYS)
        )
        if problem is None:
            self.delete_status_row(_RAYS_TOPIC)
        else:
            self.set_status_row(_RAYS_TOPIC, "error", problem)

    # --- descriptions ------------------------------------------------------------------------------------------

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Start to read a description; the former world is shown until the new one has been read."""
        self._cancel()
        self._reading = asyncio.get_running_loop().create_task(self._read(message.data))

    def _cancel(self) -> None:
        if self._reading is not None:
            self._reading.cancel()
            self._reading = None

    async def _read(self, text: str) -> None:
        index = MeshIndex(self.context.finder)
        try:
            world, content = await asyncio.to_thread(_content, text, index)
        except LinkwrightError as error:
            self._refuse(error.diagnostics)
            return
        except FrameError as error:
            self.set_status_row(_WORLD, "error", phrase("'{name}' cannot be placed", name=error.name))
            return
        self.context.meshes.replace(self.id, index.folders)
        before = {link.name: row for row, link in enumerate(self._content.links)}
        poses = np.array(content.poses, dtype=np.float64).reshape(-1, 7)
        moving = frozenset(self._posed)
        static = tuple(f"{model.name}{SEPARATOR}" for model in world.models if model.static)
        for row, link in enumerate(content.links):  # preserve moving links' poses until new ones arrive
            if link.name in moving and link.name in before and not link.name.startswith(static):
                poses[row] = self._poses[before[link.name]]
        self._revision += 1
        self._content, self._poses, self._sent = content, poses, ()
        self._rows_of = {link.name: row for row, link in enumerate(content.links)}
        self._anchors = _anchors(content)
        self._page_problems.clear()
        lidars, cameras = sensors_of(world)
        self.send(_scene(self._revision, world, content, lidars, cameras), key=_SCENE_KEY)
        self._rays.describe(lidars)
        self._follow_rays()
        self.set_status_row(
            _WORLD, "ok", phrase("{models} models, {links} links", models=len(world.models), links=len(content.links))
        )
        self._report_problems()
        self._show_poses()

    def _refuse(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR][:_MOST_FINDINGS]
        texts = [error.placed_message for error in errors] or [phrase("The description is not SDF")]
        self.set_status_row(_WORLD, "error", joined(texts, "; "))

    def _report_problems(self) -> None:
        problems = [(link, text) for link, texts in self._content.problems.items() for text in texts]
        problems += [(link, text) for (link, _), text in self._page_problems.items()]
        self._report("Files", "error", [joined((link, text), ": ") for link, text in problems])

    def _report(self, name: str, level: StatusLevel, texts: list[Phrase]) -> None:
        more = len(texts) - _MOST_FINDINGS
        if texts:
            text = joined(texts[:_MOST_FINDINGS], "; ")
            self.set_status_row(
                name, level, phrase("{texts}; and {more} more", texts=text, more=more) if more > 0 else text
            )
        else:
            self.delete_status_row(name)

    # --- poses -------------------------------------------------------------------------------------------------

    def _moved(self, message: TFMessage) -> None:
        batch = message.batch
        rows = [self._rows_of.get(child, -1) for child in batch.children]
        poses = np.asarray(batch.poses)
        if not np.isfinite(poses).all():
            self.set_status_row(
                _POSES, "error", phrase("Message contained invalid floating point values (nans or infs)")
            )
            return
        self.delete_status_row(_POSES)
        self._posed = batch.children
        # Locate with the previous poses: the transforms for the new poses may not have arrived yet.
        self._locate()
        known = [place for place, row in enumerate(rows) if row >= 0]
        self._poses[[rows[place] for place in known]] = poses[known]
        self._stamp_ns = batch.stamp_ns
        self._send_poses()

    def _show_poses(self) -> None:
        self._locate()
        self._send_poses()

    def _send_poses(self) -> None:
        if not self._content.links:
            return
        frame, pose = self._placed
        news = (self._revision, self._poses.tobytes(), frame, None if pose is None else pose.tobytes())
        if news == self._sent:
            return
        self._sent = news
        content = WorldPoses(self._revision, self._poses.astype(np.float32))
        self.send(content, key=_POSES_KEY, frame=frame, pose=pose, stamp_ns=self._stamp_ns)

    def _show_rays(self, rays: WorldRays) -> None:
        self.send(rays, key=_rays_key(rays.lidar))

    def _locate(self) -> None:
        """Compute the pose of the world in the Fixed Frame from the last poses of its links."""
        if not self._content.links:
            return
        frames = self.context.transforms.names()
        self._leads = self.host.frames.fixed_frame == WORLD and WORLD not in frames
        if not self._leads:
            self.context.transforms.place(self.id, None)
        found = self._anchor(frames) if self._leads or WORLD not in frames else None
        if self._leads or WORLD in frames:
            self._placed = (WORLD, None)
            self.set_status_row(_FRAME, "ok", phrase("The world is at the frame '{world}'", world=WORLD))
            if found is not None:
                self._place_frames(*found)
            elif self._leads and self.context.transforms.own(WORLD) is None:
                self.context.transforms.place(self.id, OwnFrame(WORLD))
        elif found is not None:
            row, frame, pose = found
            self._placed = ("", np.array(compose(pose, invert(tuple(self._poses[row])))))
            self.set_status_row(
                _FRAME,
                "ok",
                phrase(
                    "tf has no '{world}': the world is placed so that '{frame}' coincides in both",
                    world=WORLD,
                    frame=frame,
                ),
            )
        elif self._placed[1] is None:
            self._placed = ("", None)
            self.set_status_row(
                _FRAME,
                "warn",
                phrase("tf has no '{world}' and no frame of a model: the world is at the Fixed Frame", world=WORLD),
            )

    def _place_frames(self, row: int, frame: str, pose: Transform) -> None:
        """Place tf's frames in the world so that a frame is at its link's pose.

        Args:
            row: the row of the link.
            frame: the frame that has the link's name.
            pose: the frame's pose in tf's root frame.
        """
        placed = np.array(compose(tuple(self._poses[row]), invert(pose)))
        transforms, root = self.context.transforms, self._root(frame)
        before = transforms.own(WORLD)
        if before is None or before.parent != root or np.abs(before.pose - placed).max() > _UNMOVED:
            transforms.place(self.id, OwnFrame(WORLD, root, placed))
        self.set_status_row(
            _FRAME,
            "ok",
            phrase(
                "tf has no '{world}': its frames are placed so that '{frame}' coincides in both",
                world=WORLD,
                frame=frame,
            ),
        )

    def _anchor(self, frames: frozenset[str]) -> tuple[int, str, Transform] | None:
        """Return a link that is also a tf frame with a known pose, or None if there is no such link.

        Returns:
            The link's row, the frame, and the frame's pose. The pose is in the Fixed Frame, or in tf's root frame if
            the world determines where tf's frames are.
        """
        for row in self._anchors:
            frame = _unscoped(self._content.links[row].name)
            if frame not in frames:
                continue
            reference = self._root(frame) if self._leads else self.host.frames.fixed_frame
            for stamp_ns in (self._stamp_ns, 0):
                with suppress(TransformException):
                    return row, frame, tuple(self.context.transforms.pose(reference, frame, stamp_ns))
        return None

    def _root(self, frame: str) -> str:
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


def _scene(
    revision: int, world: World, content: WorldContent, lidars: list[ShownLidar], cameras: list[CameraScene]
) -> WorldScene:
    camera = camera_of(world)
    return WorldScene(
        revision,
        world.name,
        content.links,
        lights_of(world),
        list(world.scene.ambient[:3]),
        list(world.scene.background[:3]),
        world.scene.shadows,
        [lidar.scene for lidar in lidars],
        cameras,
        robots_of(world),
        None if camera is None else list(camera),
        daylight(world.scene.sky),
        fog_of(world.scene.fog),
    )


def _content(text: str, index: MeshIndex) -> tuple[World, WorldContent]:
    """Return the world that a text describes, and the content that draws the world.

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
    return world, content_of(world, index)


def _rays_key(lidar: str) -> str:
    return f"rays {lidar}"


def _unscoped(name: str) -> str:
    return name.rpartition(SEPARATOR)[2]


def _anchors(content: WorldContent) -> tuple[int, ...]:
    """Return the rows of the links whose frame name is unique, in file order; only they can be anchors."""
    counts = Counter(_unscoped(link.name) for link in content.links)
    return tuple(row for row, link in enumerate(content.links) if counts[_unscoped(link.name)] == 1)
