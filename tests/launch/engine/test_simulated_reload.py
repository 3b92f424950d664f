"""Changes of the files of a world and a robot while a launch file simulates them."""

from __future__ import annotations

import asyncio
import io
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription
from linkwright.hosting.launch_log import LaunchLog
from linkwright.launch.engine.session import LaunchSession
from linkwright.launch.engine.supervisor import SessionOptions
from linkwright.packages import PackageFinder, use_finder
from linkwright.simulation.nodes.simulator import Simulator
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import GROUND, box
from tests.waiting import TIMEOUT_S, eventually

FALLING = box("falling", "0 0 9 0 0 0")
ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/><link name="tip"><inertial>
<mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>{}</robot>"""
EXTRA_LINK = '<link name="more"/><joint name="on" type="fixed"><parent link="tip"/><child link="more"/></joint>'


def world_text(*parts: str) -> str:
    return f'<sdf version="1.7"><world name="w">{GROUND}{"".join(parts)}</world></sdf>'


class SimulatedLaunch:
    """A running launch of a paused simulator and of a program that spawns a robot in its world."""

    def __init__(self, session: LaunchSession, err: io.StringIO) -> None:
        self._session = session
        self.err = err

    async def wait_until(self, condition: Callable[[Simulation], bool]) -> None:
        """Wait until a condition holds in the thread of the simulation."""
        outcomes: list[bool] = []

        def is_so() -> bool:
            for _, running in self._session.host._running.values():
                if isinstance(running, Simulator):
                    server = running.server
                    server.exchange.post(lambda server=server: outcomes.append(condition(server.simulation)))
            return any(outcomes)

        await eventually(is_so, what=self.err.getvalue)


@asynccontextmanager
async def run_launch(folder: Path) -> AsyncIterator[SimulatedLaunch]:
    err = io.StringIO()
    description = ParameterValue(Command(["xacro ", str(folder / "arm.xacro")]), value_type=str)
    facts = {"robot_description": description}
    entities = [
        Node(
            package="gazebo_ros",
            executable="gzserver",
            arguments=[str(folder / "a.world")],
            parameters=[{"pause": True}],
        ),
        Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[facts]),
        Node(
            package="gazebo_ros",
            executable="spawn_entity.py",
            arguments=["-topic", "robot_description", "-entity", "one", "-x", "2"],
        ),
    ]
    finder = PackageFinder(start=folder, environment={})
    with use_finder(finder):
        session = LaunchSession(finder, SessionOptions(port=0, open_browser=False), LaunchLog(io.StringIO(), err))
        task = asyncio.create_task(session.run(LaunchDescription(entities)))
        try:
            yield SimulatedLaunch(session, err)
        finally:
            session.interrupt("the test is over")
            await asyncio.wait_for(task, TIMEOUT_S)


async def test_launched_simulation_reloads_world_and_robot(write) -> None:
    files = write("a.world", world_text(FALLING)), write("arm.xacro", ARM.format(""))
    async with run_launch(files[0].parent) as running:
        await running.wait_until(lambda simulation: set(simulation.scene.models) == {"ground", "falling", "one"})
        files[0].write_text(world_text(FALLING, box("new", "5 5 1 0 0 0")))
        await running.wait_until(lambda simulation: set(simulation.scene.models) == {"ground", "falling", "one", "new"})
        files[1].write_text(ARM.format(EXTRA_LINK))
        await running.wait_until(lambda simulation: "one::more" in simulation.scene.bodies)
        await running.wait_until(lambda simulation: simulation.model_pose("one")[0] == 2.0)
        files[1].write_text(ARM.format("<link"))
        await eventually(lambda: "error[XML" in running.err.getvalue(), what=running.err.getvalue)
        await running.wait_until(lambda simulation: "one::more" in simulation.scene.bodies)
        files[1].write_text(ARM.format(""))
        await running.wait_until(lambda simulation: "one::more" not in simulation.scene.bodies)
