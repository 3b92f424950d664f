"""Changes of the files of a world and its robot during a simulation."""

from __future__ import annotations

import asyncio
import io
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.descriptions import examine
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.simulated import SimulatedView, SimulatedWorld
from linkwright.packages import PackageFinder
from linkwright.simulation.nodes.simulator import Simulator
from linkwright.simulation.server.loading import WorldLoader
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.simulation import Simulation
from tests.hosting.test_driven import MBOT, infer_drive
from tests.simulation.worlds import GROUND, box
from tests.waiting import eventually

ARM = """<robot name="arm"><link name="base"/><link name="tip"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>{}</robot>"""
EXTRA_LINK = '<link name="more"/><joint name="on" type="fixed"><parent link="tip"/><child link="more"/></joint>'
FALLING = box("falling", "0 0 9 0 0 0")


@pytest.fixture(autouse=True)
def _logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


def world_text(*parts: str) -> str:
    """A world with a ground."""
    return f'<sdf version="1.7"><world name="w">{GROUND}{"".join(parts)}</world></sdf>'


class RunningSimulation:
    """A simulation with its output."""

    def __init__(self, view: SimulatedView, err: io.StringIO, wait_until_printed: Callable[[str], object]) -> None:
        self.view = view
        self.until = wait_until_printed
        self.err = err

    @property
    def simulator(self) -> Simulator:
        """The node of the simulation."""
        nodes = [node for _, node in self.view.host._running.values()]
        return next(node for node in nodes if isinstance(node, Simulator))

    @property
    def server(self) -> SimulationServer:
        """The server of the simulation, which runs in its own thread."""
        return self.simulator.server

    @property
    def worlds(self) -> WorldLoader:
        """The object that loads other worlds."""
        return self.simulator.services.worlds

    async def look(self, function: Callable[[Simulation], Any]) -> Any:
        """Return the result of a function in the thread of the simulation."""
        outcomes: list[Any] = []
        self.server.exchange.post(lambda: outcomes.append(function(self.server.simulation)))
        await eventually(lambda: bool(outcomes))
        return outcomes[0]

    async def wait_until(self, condition: Callable[[Simulation], bool]) -> None:
        """Wait until a condition holds in the thread of the simulation."""
        outcomes: list[bool] = []

        def is_so() -> bool:
            self.server.exchange.post(lambda: outcomes.append(condition(self.server.simulation)))
            return any(outcomes)

        await eventually(is_so, what=self.err.getvalue)


@asynccontextmanager
async def running_simulation(simulated: SimulatedWorld) -> AsyncIterator[RunningSimulation]:
    """Start a paused simulation without a page."""
    out, err = io.StringIO(), io.StringIO()
    finder = PackageFinder(start=simulated.path.parent)
    options = HostOptions(port=0, open_browser=False, network=False)
    view = SimulatedView(replace(simulated, headless=True, paused=True), finder, options, LaunchLog(out, err))
    running = asyncio.create_task(view.run(None))

    async def until(text: str, what: Callable[[], bool] = lambda: True) -> None:
        await eventually(lambda: (text in err.getvalue() and what()) or running.done(), what=err.getvalue)
        assert not running.done(), err.getvalue()

    try:
        await until("gzserver-2]: started" if simulated.text else "gzserver-1]: started")
        yield RunningSimulation(view, err, until)
    finally:
        view.interrupt("the test is over")
        await running


def add_robot(folder: Path, text: str) -> SimulatedWorld:
    """Add a robot to a world, from files in a folder."""
    (folder / "a.world").write_text(world_text(FALLING))
    (folder / "robot.urdf").write_text(text)
    description = examine(folder / "robot.urdf")
    assert description.robot is not None
    return SimulatedWorld(
        str(folder / "a.world"),
        folder / "robot.urdf",
        description,
        description.text,
        description.robot.name,
    )


def has_models(*names: str) -> Callable[[Simulation], bool]:
    """Return whether a simulation has these models."""
    return lambda simulation: set(simulation.scene.models) == set(names)


async def test_saved_world_is_reloaded_and_unchanged_models_keep_pose(tmp_path):
    (tmp_path / "a.world").write_text(world_text(FALLING))
    async with running_simulation(SimulatedWorld(str(tmp_path / "a.world"), tmp_path / "a.world")) as running:
        await running.look(lambda simulation: simulation.set_model_pose("falling", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)))
        (tmp_path / "a.world").write_text(world_text(FALLING, box("new", "5 5 1 0 0 0")))
        await running.wait_until(has_models("ground", "falling", "new"))
        assert (await running.look(lambda simulation: simulation.model_pose("falling")))[:3] == (1.0, 2.0, 3.0)
        assert f"reloaded {tmp_path / 'a.world'}" in running.err.getvalue()


async def test_edited_world_is_not_replaced_by_changed_file(tmp_path):
    file = tmp_path / "a.world"
    file.write_text(world_text(FALLING))
    async with running_simulation(SimulatedWorld(str(file), file)) as running:
        edited = world_text(FALLING, box("edited", "5 5 1 0 0 0"))
        await running.look(lambda _: running.worlds.load(str(file), edited))
        file.write_text(world_text(box("other", "5 5 1 0 0 0")))
        await running.until("has changed; the simulation continues with the edited world")
        assert await running.look(has_models("ground", "falling", "edited"))
        before = running.worlds.loaded
        file.write_text(edited)
        await running.until("", lambda: running.worlds.loaded is not before)
        file.write_text(world_text(box("other", "5 5 1 0 0 0")))
        await running.wait_until(has_models("ground", "other"))


async def test_broken_world_is_reported_and_simulation_continues(tmp_path):
    (tmp_path / "a.world").write_text(world_text(FALLING))
    async with running_simulation(SimulatedWorld(str(tmp_path / "a.world"), tmp_path / "a.world")) as running:
        (tmp_path / "a.world").write_text("<sdf version='1.7'><world></sdf>")
        await running.until("error[XML")
        assert [finding.code[:3] for finding in running.view.reload.findings()] == ["XML"]
        assert await running.look(has_models("ground", "falling"))
        (tmp_path / "a.world").write_text(world_text(box("new", "5 5 1 0 0 0")))
        await running.until("repaired")
        await running.wait_until(has_models("ground", "new"))
        assert running.view.reload.findings() == []


async def test_world_that_cannot_be_simulated_is_reported(tmp_path):
    (tmp_path / "a.world").write_text(world_text(FALLING))
    async with running_simulation(SimulatedWorld(str(tmp_path / "a.world"), tmp_path / "a.world")) as running:
        invalid_physics = '<physics type="ode"><max_step_size>-1</max_step_size></physics>'
        (tmp_path / "a.world").write_text(world_text(FALLING, invalid_physics))
        await running.until("; the simulation continues unchanged")
        assert "the changed world was not loaded: " in running.err.getvalue()
        assert "a time step of -1.0 s" in running.err.getvalue()


async def test_included_model_is_watched(tmp_path):
    (tmp_path / "crate").mkdir()
    (tmp_path / "crate/model.sdf").write_text(f'<sdf version="1.7">{FALLING}</sdf>')
    (tmp_path / "a.world").write_text(world_text("<include><uri>model://crate</uri></include>"))
    async with running_simulation(SimulatedWorld(str(tmp_path / "a.world"), tmp_path / "a.world")) as running:
        (tmp_path / "crate/model.sdf").write_text(f'<sdf version="1.7">{box("crate", "1 1 1 0 0 0")}</sdf>')
        await running.wait_until(has_models("ground", "crate"))


async def test_saved_robot_is_reloaded_with_pose_and_joint_positions(tmp_path):
    def elsewhere(simulation: Simulation) -> None:
        simulation.set_model_pose("arm", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0))
        simulation.set_joint_position("arm::turn", 0.5)

    async with running_simulation(add_robot(tmp_path, ARM.format(""))) as running:
        await running.look(elsewhere)
        (tmp_path / "robot.urdf").write_text(ARM.format(EXTRA_LINK))
        await running.wait_until(lambda simulation: "arm::more" in simulation.scene.bodies)
        pose = await running.look(lambda simulation: simulation.model_pose("arm"))
        assert pose[:3] == pytest.approx((1.0, 2.0, 3.0))
        assert (await running.look(lambda simulation: simulation.joint_state("arm::turn")))[0] == pytest.approx(0.5)
        (tmp_path / "robot.urdf").write_text(ARM.format("<link"))
        await running.until("error[XML")
        assert await running.look(lambda simulation: "arm::more" in simulation.scene.bodies)


async def test_driven_robot_is_completed_again_after_change(tmp_path):
    (tmp_path / "mbot.urdf").write_text(MBOT)
    async with running_simulation(infer_drive(tmp_path / "mbot.urdf")) as running:
        mast = '<link name="mast"/><joint name="m" type="fixed"><parent link="base_link"/><child link="mast"/></joint>'
        (tmp_path / "mbot.urdf").write_text(MBOT.replace("</robot>", f"{mast}</robot>"))
        await running.wait_until(lambda simulation: "mbot::mast" in simulation.scene.bodies)
        radius = await running.look(lambda simulation: simulation.wheel_radius("mbot::left_wheel_link"))
        assert radius == pytest.approx(0.06)


CUBE = "".join(
    f"facet normal 0 0 0 outer loop vertex {a} vertex {b} vertex {c} endloop endfacet\n"
    for a, b, c in [
        ("0 0 0", "0 1 0", "1 0 0"),
        ("0 0 0", "1 0 0", "0 0 1"),
        ("0 0 0", "0 0 1", "0 1 0"),
        ("1 0 0", "0 1 0", "0 0 1"),
    ]
)


async def test_changed_robot_mesh_is_reloaded(tmp_path):
    (tmp_path / "part.stl").write_text(f"solid part\n{CUBE}endsolid part\n")
    mesh = '<visual><geometry><mesh filename="part.stl"/></geometry></visual>'
    async with running_simulation(
        add_robot(tmp_path, ARM.format("").replace('<link name="tip">', f'<link name="tip">{mesh}'))
    ) as running:
        assert await running.look(_mesh_extent) < 1.5
        (tmp_path / "part.stl").write_text(f"solid part\n{CUBE.replace('1 0 0', '3 0 0')}endsolid part\n")
        await running.wait_until(lambda simulation: _mesh_extent(simulation) > 2.0)


async def test_changed_world_mesh_is_reloaded(tmp_path):
    (tmp_path / "part.stl").write_text(f"solid part\n{CUBE}endsolid part\n")
    mesh = '<visual name="v"><geometry><mesh><uri>part.stl</uri></mesh></geometry></visual>'
    part = f'<model name="part"><static>true</static><link name="l">{mesh}</link></model>'
    (tmp_path / "a.world").write_text(world_text(FALLING, part))
    async with running_simulation(SimulatedWorld(str(tmp_path / "a.world"), tmp_path / "a.world")) as running:
        await running.look(lambda simulation: simulation.set_model_pose("falling", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)))
        assert await running.look(_mesh_extent) < 1.5
        (tmp_path / "part.stl").write_text(f"solid part\n{CUBE.replace('1 0 0', '3 0 0')}endsolid part\n")
        await running.wait_until(lambda simulation: _mesh_extent(simulation) > 2.0)
        assert (await running.look(lambda simulation: simulation.model_pose("falling")))[:3] == (1.0, 2.0, 3.0)


def _mesh_extent(simulation: Simulation) -> float:
    """Return the greatest extent of all meshes in m."""
    return float(np.ptp(simulation.model.mesh_vert, axis=0).max())
