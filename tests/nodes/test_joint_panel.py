"""`joint_state_publisher_gui`: sliders, and the positions that they publish."""

from math import inf, nan, pi
from random import Random

import pytest

from linkwright.messages import JointState
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointPanel, JointSlider, JointStatePublisherGui
from tests.nodes.harness import joint, mimic, robot

ROBOT = robot(
    joint("lift", "prismatic", limit="lower='0.5' upper='1.5'"),
    joint("stuck", limit="lower='1' upper='1'"),
    joint("claw", content=mimic("grip", "multiplier='-1' offset='0.1'")),
    joint("grip"),
    joint("follows_stuck", content=mimic("stuck")),
    joint("spin", "continuous"),
)


@pytest.fixture
async def gui(harness):
    gui = harness.gui()
    await harness.describe(ROBOT)
    return gui


@pytest.fixture
def messages(gui):
    messages = []
    gui.panel.subscribe(messages.append)
    return messages


def test_sliders_match_joints_of_description(gui):
    assert gui.panel.sliders() == [
        JointSlider("lift", "prismatic", 0.5, 1.5, 1.0),
        JointSlider("claw", "revolute", -1.0, 2.0, 0.1, "grip", -1.0, 0.1),
        JointSlider("grip", "revolute", -1.0, 2.0, 0.0),
        JointSlider("spin", "continuous", -pi, pi, 0.0),
    ]
    assert gui.panel.positions() == {"lift": 1.0, "claw": 0.1, "grip": 0.0, "spin": 0.0}
    assert gui.node.get_fully_qualified_name() == "/joint_state_publisher"


async def test_panel_has_no_sliders_without_description(harness):
    panel = harness.gui().panel
    assert panel.sliders() == []
    assert panel.positions() == {}
    panel.randomize()
    panel.center()
    assert not panel.set_position("a", 1.0)


async def test_moves_are_published_at_once_and_combined(harness, gui, messages):
    before = len(harness.joint_states)
    for position in (0.1, 0.2, 0.3):
        assert gui.panel.set_position("grip", position)
    assert gui.panel.positions()["grip"] == 0.3
    await harness.graph.settle()
    assert len(harness.joint_states) == before + 1
    assert harness.positions()["grip"] == 0.3
    assert harness.positions()["claw"] == pytest.approx(-0.2)
    assert messages == ["positions"]


async def test_move_updates_transforms_immediately(harness, gui, clock):
    harness.robot_state_publisher(ROBOT)
    await clock.advance(0.512)
    gui.panel.set_position("lift", 1.25)
    await harness.graph.settle()
    assert harness.positions()["lift"] == 1.25
    turned = harness.buffer.lookup("base", "lift_link")
    assert turned[2] == 1.25


async def test_last_move_of_drag_is_published(harness, gui, clock):
    harness.robot_state_publisher(ROBOT)
    await clock.advance(0.512)
    for step in range(1, 11):
        gui.panel.set_position("lift", 0.5 + 0.05 * step)
        await clock.advance(0.016)
    await clock.advance(0.05)
    assert harness.buffer.lookup("base", "lift_link")[2] == pytest.approx(1.0)


async def test_publish_timer_restarts_after_move(harness, gui, clock):
    await clock.advance(0.06)
    gui.panel.set_position("grip", 1.0)
    await harness.graph.settle()
    harness.joint_states.clear()
    await clock.advance(0.09)
    assert harness.joint_states == []
    await clock.advance(0.02)
    assert len(harness.joint_states) == 1


@pytest.mark.parametrize(("value", "position"), [(9.0, 2.0), (-9.0, -1.0), (0.5, 0.5)])
async def test_moves_are_clamped_to_limits(gui, value, position):
    assert gui.panel.set_position("grip", value)
    assert gui.panel.positions()["grip"] == position


@pytest.mark.parametrize(
    ("name", "value"), [("gone", 1.0), ("claw", 1.0), ("stuck", 1.0), ("grip", nan), ("grip", inf)]
)
async def test_invalid_moves_are_ignored(harness, gui, messages, name, value):
    before = gui.panel.positions()
    assert not gui.panel.set_position(name, value)
    await harness.graph.settle()
    assert gui.panel.positions() == before
    assert messages == []


async def test_randomize_covers_range_within_limits(harness, gui, messages, logged):
    panel = JointPanel(gui.node, gui.joints, gui.publish_soon, Random(1))
    panel.rebuild()
    positions_by_joint = {name: [] for name in panel.positions()}
    for _ in range(200):
        panel.randomize()
        for name, position in panel.positions().items():
            positions_by_joint[name].append(position)
    for slider in panel.sliders():
        if slider.mimic is None:
            width = slider.upper - slider.lower
            assert slider.lower <= min(positions_by_joint[slider.name]) < slider.lower + 0.1 * width
            assert slider.upper - 0.1 * width < max(positions_by_joint[slider.name]) <= slider.upper
    assert positions_by_joint["claw"] == pytest.approx([0.1 - position for position in positions_by_joint["grip"]])
    assert logged("INFO")[-1] == "Randomizing"


async def test_center_moves_to_zeros(harness):
    gui = harness.gui(zeros={"grip": 0.75, "spin": 99.0})
    await harness.describe(ROBOT)
    gui.panel.randomize()
    gui.panel.center()
    assert gui.panel.positions() == {"lift": 1.0, "claw": pytest.approx(-0.65), "grip": 0.75, "spin": pi}


async def test_new_description_notifies_and_keeps_positions(harness, gui, messages):
    gui.panel.set_position("grip", 1.25)
    await harness.describe(robot(joint("grip"), joint("added")))
    assert set(messages) == {"positions", "sliders"}
    assert [slider.name for slider in gui.panel.sliders()] == ["grip", "added"]
    assert gui.panel.positions() == {"grip": 1.25, "added": 0.0}


async def test_source_topics_and_sweep_move_sliders(harness, clock):
    gui = harness.gui(source_list=["source"], delta=0.125)
    await harness.describe(robot(joint("a")))
    messages = []
    gui.panel.subscribe(messages.append)
    harness.node.create_publisher(JointState, "source", 10).publish(JointState(name=["a"], position=[1.0]))
    await harness.graph.settle()
    assert gui.panel.positions() == {"a": 1.0}
    assert messages == ["positions"]
    await clock.advance(0.1)
    assert gui.panel.positions() == {"a": 1.125}
    assert messages == ["positions", "positions"]


async def test_subscribers_can_unsubscribe_and_fail(harness, gui, messages, logged):
    def fail(_change):
        raise RuntimeError("page is gone")

    late_updates = []
    gui.panel.subscribe(fail)
    end = gui.panel.subscribe(late_updates.append)
    gui.panel.set_position("grip", 1.0)
    await harness.graph.settle()
    end()
    end()
    gui.panel.set_position("grip", 0.0)
    await harness.graph.settle()
    assert messages == ["positions", "positions"]
    assert late_updates == ["positions"]
    assert logged("ERROR")[0].startswith("joint panel callback failed:\nTraceback")


async def test_description_file_argument_creates_sliders(harness, tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT, encoding="utf-8")
    gui = JointStatePublisherGui(harness.graph, NodeOptions(arguments=[str(path)]))
    assert len(gui.panel.sliders()) == 4
    gui.close()
