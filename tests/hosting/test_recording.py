"""``--record`` of simulations: all topics, simulated times, and complete files at any end."""

from __future__ import annotations

import asyncio
import io
from pathlib import Path

import pytest

from linkwright.bag import BagReader, BagWriter
from linkwright.cli.command import main
from linkwright.descriptions import examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.simulated import SimulatedView, SimulatedWorld
from linkwright.packages import PackageFinder
from linkwright.testing import Recording
from tests.recordings import needs_rosbags
from tests.waiting import eventually

pytestmark = needs_rosbags

MBOT = Path(__file__).parents[2] / "robots/my_robot_description/urdf/mbot_gazebo.xacro"
OPTIONS = HostOptions(port=0, open_browser=False, network=False)
SECOND_NS = 1_000_000_000


@pytest.fixture(autouse=True)
def _logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


def simulate_mbot(seconds: float) -> SimulatedWorld:
    """Simulate mbot on a plane without a page, as fast as possible."""
    description = examine(MBOT)
    assert description.robot is not None
    return SimulatedWorld(
        "empty", MBOT, description, description.text, description.robot.name, seconds=seconds, rate=-1.0, headless=True
    )


def make_view(world: SimulatedWorld) -> tuple[SimulatedView, io.StringIO]:
    err = io.StringIO()
    return SimulatedView(world, PackageFinder(start=MBOT.parent), OPTIONS, LaunchLog(io.StringIO(), err)), err


class WatchedRecording(BagWriter):
    """A recording that reports the topics of its messages."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.written: set[str] = set()

    def write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        super().write(topic, stamp_ns, data)
        self.written.add(topic)


async def test_all_topics_are_recorded_with_simulated_time(tmp_path: Path) -> None:
    view, err = make_view(simulate_mbot(2.0))
    with BagWriter(tmp_path / "run") as writer:
        assert await view.run(None, writer), err.getvalue()
    with BagReader(tmp_path / "run") as bag:
        topics_and_stamps = [(topic, stamp) for topic, stamp, _ in bag.messages()]
        assert not bag.findings
    assert {"/clock", "/odom", "/tf", "/tf_static", "/robot_description", "/imu"} <= {
        topic for topic, _ in topics_and_stamps
    }
    stamps = [stamp for _, stamp in topics_and_stamps]
    assert stamps == sorted(stamps)
    assert 0 < stamps[0] <= stamps[-1] <= 2 * SECOND_NS


async def test_recording_is_complete_when_user_ends_simulation(tmp_path: Path) -> None:
    view, err = make_view(simulate_mbot(0.0))
    with WatchedRecording(tmp_path / "run") as writer:
        running = asyncio.create_task(view.run(None, writer))
        await eventually(lambda: {"/odom", "/tf_static"} <= writer.written or running.done(), what=err.getvalue)
        view.interrupt("the test is over")
        assert await running, err.getvalue()
    with BagReader(tmp_path / "run") as bag:
        assert {topic for topic, _, _ in bag.messages()} == writer.written
        assert not bag.findings


@pytest.mark.parametrize("refusing", ["write", "close"])
async def test_full_disk_ends_recording_but_not_simulation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, refusing: str
) -> None:
    def refuse(*_: object) -> None:
        raise LinkwrightError(Diagnostic("BAG108", phrase("the disk is full")))

    view, err = make_view(simulate_mbot(2.0))
    clock = Recording(view.host.graph, view.host.graph.create_node("listener"), "/clock")
    with BagWriter(tmp_path / "run") as writer, monkeypatch.context() as patched:
        patched.setattr(BagWriter, refusing, refuse)
        assert not await view.run(None, writer), "the result means exit status 1"
    assert err.getvalue().count("the disk is full") == 1
    assert "has finished cleanly" in err.getvalue()
    assert clock.last.clock.sec >= 1, "the simulation did not end with the first message"


@pytest.mark.parametrize("words", [("sim", "empty"), ("drive", str(MBOT))], ids=["sim", "drive"])
def test_existing_folder_is_not_overwritten(tmp_path: Path, capsys, words: tuple[str, ...]) -> None:
    assert main([*words, "--headless", "--record", str(tmp_path)]) == 1
    output = capsys.readouterr().err
    assert output.count("error[") == 1
    assert "it exists already" in output
