"""What a viewer shows at one moment, apart from the program that shows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, foreign, phrase
from linkwright.nodes.joint_layout import layout_of
from linkwright.nodes.joint_settings import JointSettings
from linkwright.urdf import Robot
from linkwright.viewer.features.export.joint_state import positions_now
from linkwright.viewer.protocol.displays import Display, DisplayProperties, Tree
from linkwright.viewer.protocol.frames import FrameTable, unpack_transforms
from linkwright.viewer.protocol.joints import JointControl, JointPositions, Joints
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.protocol.parts import Property
from linkwright.viewer.protocol.robot import RobotScene
from linkwright.viewer.protocol.session import Hello
from linkwright.viewer.protocol.views import SavedViews, View, ViewClasses, ViewState
from linkwright.viewer.web.files import MeshFolders
from linkwright.viewer.web.outbox import ScaledData

if TYPE_CHECKING:
    from linkwright.viewer.displays.robot_model import RobotModelDisplay
    from linkwright.viewer.features.page_feature import FeatureHost
    from linkwright.viewer.visualization.manager import VisualizationManager
    from linkwright.viewer.web.outbox import Payload

_TAKEN = (DisplayProperties, FrameTable, Hello, SavedViews, ViewClasses, ViewState)
"""Messages that go along as they are: nothing of the machine that the program runs on is in them."""

_PATHS = frozenset({"Description File"})
"""Properties that are paths of that machine."""


@dataclass(frozen=True)
class Snapshot:
    """A robot, and all that is seen with it.

    Attributes:
        name: of the robot.
        robot: its description.
        scene: its links as pages draw them.
        positions: joint -> rad or m.
        messages: what a page must be told, the frame table last.
        frames: binary frames, the transforms first.
        meshes: finds the files that `scene` names.
        problems: what of the robot cannot be drawn.
        marker_meshes: addresses of the meshes that markers show.
        fit: nobody chose where the camera is: it is to show all of the robot.
    """

    name: str
    robot: Robot
    scene: RobotScene
    positions: Mapping[str, float]
    messages: Sequence[ServerMessage]
    frames: Sequence[bytes]
    meshes: MeshFolders = field(repr=False)
    problems: Sequence[Diagnostic] = ()
    marker_meshes: Sequence[str] = ()
    fit: bool = False


def snapshot_of(viewer: FeatureHost, manager: VisualizationManager, view: View | None = None) -> Snapshot:
    """What is seen now of a configuration, to be exported.

    Args:
        viewer: that shows it.
        manager: what is seen.
        view: the camera; None for where a page that opens has it.

    Raises:
        LinkwrightError: VIEW201, there is no robot.
    """
    models = (model for model in manager.robot_models() if model.enabled and model.scene.links)
    model = next(models, None)
    if model is None:
        raise no_robot()
    told, frames = viewer.opening_messages(manager)
    if view is not None:
        told = [ViewState(view, each.revision) if isinstance(each, ViewState) else each for each in told]
    return take_snapshot(model, told, frames, viewer.context.meshes)


def take_snapshot(
    model: RobotModelDisplay, told: Sequence[ServerMessage], payloads: Sequence[Payload], meshes: MeshFolders
) -> Snapshot:
    """The part of the messages to a new page that it needs to run without a server.

    Args:
        model: shows the robot whose joints can be moved.
        told: the messages to a page that opens.
        payloads: the binary frames to it.
        meshes: the folders that it may read from.

    Raises:
        LinkwrightError: VIEW201, the display has no robot.
    """
    robot, scene = model.robot, model.scene
    if robot is None:
        raise no_robot()
    frames = [frame for payload in payloads if isinstance(frame := _whole(payload), bytes)]
    table = next(message for message in told if isinstance(message, FrameTable))
    poses = _poses(table, frames)
    positions = positions_now(robot, {link.name: poses[link.frame] for link in scene.links if link.frame in poses})
    messages: list[ServerMessage] = []
    for message in told:
        if isinstance(message, Tree):
            messages.append(_anonymous(message))
        elif isinstance(message, RobotScene):
            messages.append(replace(message, links=[replace(link, place=None) for link in message.links]))
        elif isinstance(message, _TAKEN):
            messages.append(message)
    controls = _controls(robot)
    messages[-1:-1] = [
        Joints(controls),
        JointPositions({each.name: positions.get(each.name, 0.0) for each in controls}),
    ]
    problems = [
        Diagnostic(
            "VIEW203",
            phrase("of link '{link}' something is left out: {text}", link=link, text=foreign(text)),
            severity=Severity.WARNING,
        )
        for link, texts in model.file_problems.items()
        for text in texts
    ]
    return Snapshot(
        robot.name, robot, scene, positions, messages, frames, meshes.copy(), problems, _marker_meshes(payloads)
    )


def no_robot() -> LinkwrightError:
    """The error where there is nothing to export (VIEW201)."""
    hint = phrase("wait until the robot is drawn, or enable its RobotModel display")
    return LinkwrightError(Diagnostic("VIEW201", phrase("there is no robot to export"), hint=hint))


def _whole(payload: Payload) -> bytes | str | None:
    """All of a content, as a page that has nothing is sent it."""
    if isinstance(payload, ScaledData):
        return payload.whole
    return payload if isinstance(payload, (bytes, str)) else payload.since(0)[0]


def _marker_meshes(payloads: Sequence[Payload]) -> list[str]:
    from linkwright.viewer.markers.store import MarkerStore  # most programs never export

    shapes = [shape for payload in payloads if isinstance(payload, MarkerStore) for shape in payload.shapes]
    return [shape.mesh.url for shape in shapes if shape.mesh is not None and shape.mesh.url is not None]


def _poses(table: FrameTable, frames: Sequence[bytes]) -> dict[str, NDArray[np.float64]]:
    for frame in frames:
        revision, poses = unpack_transforms(frame)
        if revision == table.revision:
            return {name: pose for name, pose in zip(table.names, poses, strict=True) if not np.isnan(pose[0])}
    return {}


def _anonymous(tree: Tree) -> Tree:
    """The displays without their status and without paths, which tell of this machine."""
    displays: list[Display] = [
        replace(each, status=[], level="ok", properties=_without_paths(each.properties)) for each in tree.displays
    ]
    return replace(tree, global_status=[], global_level="ok", displays=displays)


def _without_paths(properties: Sequence[Property]) -> list[Property]:
    return [
        replace(each, value="" if each.name in _PATHS else each.value, children=_without_paths(each.children))
        for each in properties
    ]


def _controls(robot: Robot) -> list[JointControl]:
    """A slider for each joint that moves, as joint_state_publisher_gui has them."""
    layout = layout_of(robot, JointSettings())
    controls = []
    for joint in layout.ranges.values():
        if joint.lower == joint.upper:
            continue
        follows = layout.dependent.get(joint.name)
        kind = cast("Any", joint.kind)  # the joints that move are of these three kinds
        control = JointControl(joint.name, kind, joint.lower, joint.upper, joint.zero)
        if follows is not None:
            control = replace(control, mimic=follows.parent, multiplier=follows.factor, offset=follows.offset)
        controls.append(control)
    return controls
