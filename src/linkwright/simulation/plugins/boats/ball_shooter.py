"""Ball shooters of boats: ``libBallShooterPlugin.so``, and ``libball_shooter_plugin.so`` of Gazebo Classic.

A shot moves the projectile to its pose in the frame of the shooter, at rest, and pushes it along its x axis for one
step of the simulation. The projectile is a model of its own, which is used again for the next shot.

Source: VRX (parameters, defaults, topic, force). VRX pushes along the x axis that the projectile had before the shot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Transform, compose
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import AT_ORIGIN, POSE, SEPARATOR
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MAX_SHOTS = 2**32 - 1


@dataclass(frozen=True, kw_only=True)
class BallShooterParameters:
    """Parameters of ``libBallShooterPlugin.so``: the force in N."""

    num_shots: int = _MAX_SHOTS
    shot_force: float = 250.0
    topic_name: str = parameter("/ball_shooter/fire", aliases=("topic",))


class BallShooter(SimulatedPlugin[BallShooterParameters]):
    """The substitute for ``libBallShooterPlugin.so``.

    Attributes:
        TRIGGER_TYPE: the type of the messages that fire a shot.
    """

    PARAMETERS = BallShooterParameters
    TRIGGER_TYPE: ClassVar[str] = "std_msgs/msg/Bool"
    IGNORED = ("projectile",)
    CARRIED = ("_remaining_shots",)

    def start(self) -> None:
        """Read the projectile, and subscribe to the shots.

        Raises:
            LinkwrightError: SIM160, the projectile has no model or link.
        """
        element = None if self.context.element is None else self.context.element.first("projectile")
        self._model, self._link, self._frame = (
            self.text_in(element, tag) for tag in ("model_name", "link_name", "frame")
        )
        if not self._model or not self._link:
            message = phrase(
                "plugin '{plugin}': <projectile> needs <model_name> and <link_name>", plugin=self.context.name
            )
            raise self.parameter_error(message, element)
        pose_element = None if element is None else element.first("pose")
        raw_pose = AT_ORIGIN if pose_element is None else read_element(pose_element, POSE, SdfReport())
        self._pose = transform_of(raw_pose.pose)
        self.reset()
        self.node.subscribe(self.TRIGGER_TYPE, self.parameters.topic_name, self._on_fire)
        self.every(0.0, self._shoot)

    def reset(self) -> None:
        """Restore all shots."""
        self._remaining_shots = self.parameters.num_shots
        self._is_due = False

    def _on_fire(self, _: Any) -> None:
        self._is_due = self._remaining_shots > 0

    def _shoot(self) -> None:
        """Push the projectile for one step if a shot is due, and end the previous push."""
        self.stop_pushing()
        if not self._is_due:
            return
        self._is_due = False
        simulation, link = self.simulation, f"{self._model}{SEPARATOR}{self._link}"
        simulation.refresh()
        frame = self._find_frame_pose()
        if link not in simulation.scene.bodies or frame is None:
            missing = self._frame if frame is None else link
            message = phrase("plugin '{plugin}': there is no link '{name}'", plugin=self.context.name, name=missing)
            self.node.logger.warning(message)
            return
        axis = self._find_axis(link)
        simulation.set_model_pose(self._model, compose(frame, self._pose))
        simulation.set_model_velocity(self._model, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        if not self.gazebo_mistakes:
            simulation.refresh()
            axis = self._find_axis(link)
        self.push(link, self.parameters.shot_force * axis)
        self._remaining_shots -= 1

    def _find_axis(self, link: str) -> Array:
        """Return the x axis of a link in the world."""
        return rotation_matrix(np.array(self.simulation.link_pose(link)[3:]))[:, 0]

    def _find_frame_pose(self) -> Transform | None:
        """Return the pose of the link or model in whose frame the pose of the projectile is; None if it is missing."""
        if not self._frame:
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
        simulation, scene = self.simulation, self.simulation.scene
        if self._frame in scene.models:
            return simulation.model_pose(self._frame)
        prefix = f"{self.context.path}{SEPARATOR}"
        names = (name for name in scene.bodies if f"{SEPARATOR}{name}".endswith(f"{SEPARATOR}{self._frame}"))
        link = min(names, key=lambda name: not name.startswith(prefix), default="")
        return simulation.link_pose(link) if link else None


class ClassicBallShooter(BallShooter):
    """The substitute for ``libball_shooter_plugin.so``, which ``std_msgs/msg/Empty`` fires."""

    TRIGGER_TYPE = "std_msgs/msg/Empty"
