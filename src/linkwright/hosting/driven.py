"""Driving one robot in a simulated world, without a launch file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import VIEWER, HostedPlan, HostOptions
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.view import ModelView
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.inference.applying import completed
from linkwright.packages import PackageFinder
from linkwright.xmltree import write

if TYPE_CHECKING:
    from linkwright.descriptions import Description
    from linkwright.inference import Inference
    from linkwright.viewer import RvizConfig

EMPTY_WORLD = "empty"
_CLOCK_RATE = 100.0
"""Hz of simulated time in which the time is told: transforms are not older than that."""
_SIMULATOR = ("gazebo_ros", "gzserver")
_WORLD_DISPLAY = "linkwright/World"


@dataclass(frozen=True, slots=True)
class Drive:
    """A robot, and how it is put into a world.

    Attributes:
        path: the file that it is written in.
        text: its URDF, with all that a simulator needs.
        name: what it is called in the world.
        height: the z of its root link in the world, in m.
        odometry_frame: what stands still for it: the fixed frame of the page.
        world: a file, or the name of a world.
        seconds: after how many simulated seconds it ends; 0 for never.
        headless: whether there is no page.
        rate: simulated seconds in a real one; negative for as many as can be.
    """

    path: Path
    text: str
    name: str
    height: float
    odometry_frame: str
    world: str = EMPTY_WORLD
    seconds: float = 0.0
    headless: bool = False
    rate: float = 0.0

    @classmethod
    def of(cls, description: Description, found: Inference) -> Drive:
        """The drive of a robot by what was inferred about it, in an empty world."""
        assert description.robot is not None, "something was inferred about it"
        frame = found.base_frame if found.fixed_base or found.drive is None else "odom"
        text = write(completed(description.document, found))
        return cls(Path(description.name).absolute(), text, description.robot.name, -found.ground, frame)

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters of the simulator."""
        return {
            "world": self.world,
            "publish_rate": _CLOCK_RATE,
            "real_time_factor": self.rate,
            "seconds": self.seconds,
            "usual_names": True,
            "robot_description": self.text,
            "robot_name": self.name,
            "robot_pose": [0.0, 0.0, self.height, 0.0, 0.0, 0.0],
        }


def run_drive(drive: Drive, finder: PackageFinder, options: HostOptions, *, foxglove: int | None = None) -> int:
    """Drive a robot until the user ends it, or its seconds are over.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.
    """
    options = replace(options, title=drive.path.name)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def show() -> bool:
            signals.session = driven = DrivenModel(drive, finder, options, log)
            return await driven.run(foxglove)

        return signals.run(show)

    return run_to_end(run, finder, log)


class DrivenModel(ModelView):
    """A robot in a simulated world, on the running event loop: simulator, robot_state_publisher and the viewer."""

    def __init__(self, drive: Drive, finder: PackageFinder, options: HostOptions, log: LaunchLog) -> None:
        super().__init__(XacroCall(drive.path, ()), finder, options, log)
        self._drive = drive
        self._text = drive.text

    def _publish(self) -> bool:
        """Have the robot published; it is right already."""
        parameters = {"robot_description": self._drive.text, "use_sim_time": True}
        self._plan("robot_state_publisher", "robot_state_publisher", parameters)
        return True

    def _plan_others(self) -> None:
        self._plan(*_SIMULATOR, self._drive.parameters, output="screen")
        if not self._drive.headless:
            self._plan(*VIEWER, name="viewer", viewer_config=self._viewer_config)

    def _viewer_config(self) -> RvizConfig:
        """As for a model that is shown, with the frame that it moves in as the fixed one; and the world around it."""
        config = super()._viewer_config()
        config.options.set(("Fixed Frame",), self._drive.odometry_frame)
        if self._drive.world != EMPTY_WORLD:
            config.insert(config.make(_WORLD_DISPLAY, "World"))
        return config

    def node_ended(self, plan: HostedPlan, status: int) -> None:
        """Without the simulator there is nothing to drive."""
        if plan.package == _SIMULATOR[0]:
            if status:
                self.fail(plan)
            self.shut_down("the simulation has ended")
