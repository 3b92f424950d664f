from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from linkwright.viewer.joints import JointBridge
from linkwright.viewer.protocol import CenterJoints, JointPositions, Joints, RandomizeJoints, SetJoint


@dataclass
class Slider:
    name: str
    kind: str = "revolute"
    lower: float = -1.0
    upper: float = 1.0
    zero: float = 0.0
    mimic: str | None = None


@dataclass
class Panel:
    joints: list[Slider]
    done: list = field(default_factory=list)
    listeners: list = field(default_factory=list)

    def sliders(self):
        return self.joints

    def positions(self):
        return {joint.name: joint.zero for joint in self.joints}

    def set_position(self, name, value):
        self.done.append((name, value))

    def randomize(self):
        self.done.append("randomize")

    def center(self):
        self.done.append("center")

    def subscribe(self, callback):
        self.listeners.append(callback)
        return lambda: self.listeners.remove(callback)


@pytest.fixture
def published():
    return []


@pytest.fixture
def bridge(published):
    return JointBridge(published.append)


@pytest.fixture
def panel():
    return Panel([Slider("a"), Slider("b", kind="prismatic", mimic="a")])


def test_without_a_panel_there_are_no_joints(bridge):
    assert bridge.messages() == [Joints(None)]
    bridge.receive(RandomizeJoints())


def test_a_panel_is_shown(bridge, panel, published):
    bridge.attach(panel)
    controls, positions = published
    assert [(control.name, control.kind, control.mimic) for control in controls.controls] == [
        ("a", "revolute", None),
        ("b", "prismatic", "a"),
    ]
    assert positions == JointPositions({"a": 0.0, "b": 0.0})
    assert bridge.messages() == published


def test_pages_move_joints_that_are_free(bridge, panel):
    bridge.attach(panel)
    for message in (SetJoint("a", 0.5), SetJoint("b", 0.5), SetJoint("c", 1.0), RandomizeJoints(), CenterJoints()):
        bridge.receive(message)
    assert panel.done == [("a", 0.5), "randomize", "center"]


def test_what_the_panel_tells_is_passed_on(bridge, panel, published):
    bridge.attach(panel)
    published.clear()
    panel.listeners[0]("positions")
    assert [type(message) for message in published] == [JointPositions]
    panel.joints.append(Slider("c"))
    panel.listeners[0]("sliders")
    assert [type(message) for message in published[1:]] == [Joints, JointPositions]
    assert "c" in published[-1].positions


def test_another_panel_takes_its_place(bridge, panel, published):
    bridge.attach(panel)
    bridge.attach(Panel([]))
    assert panel.listeners == []
    bridge.attach(None)
    assert published[-1] == Joints(None)
