"""The poses of frames, compared with poses calculated by hand."""

from __future__ import annotations

from math import pi, sqrt

import pytest

from linkwright.geometry.single import Transform
from linkwright.sdf.frames import FrameError, Frames, placed_links
from tests.sdf.worlds import make_model_text, make_world_text

LINKS = '<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>'
QUARTER_TURN = f"0 0 0 0 0 {pi / 2}"


def is_at(transform: Transform, *xyz: float) -> bool:
    return transform[:3] == pytest.approx(xyz, abs=1e-12)


def test_link_pose_is_relative_to_model_or_named_frame():
    frames = Frames(
        make_model_text(
            f"""<link name="a"><pose>1 0 0 0 0 {pi / 2}</pose></link>
            <link name="b"><pose relative_to="a">1 0 0 0 0 0</pose></link>
            <link name="c"><pose relative_to="__model__">0 0 1 0 0 0</pose></link>"""
        )
    )
    assert is_at(frames.pose("a"), 1, 0, 0)
    assert is_at(frames.pose("b"), 1, 1, 0)
    assert is_at(frames.pose("c"), 0, 0, 1)
    assert frames.pose("b")[3:] == pytest.approx((0, 0, sqrt(0.5), sqrt(0.5)))


def test_joint_pose_is_relative_to_child():
    frames = Frames(
        make_model_text(
            LINKS
            + """<joint name="j" type="fixed"><parent>a</parent><child>b</child><pose>0 1 0 0 0 0</pose></joint>
            <joint name="k" type="fixed"><parent>world</parent><child>a</child><pose relative_to="j">1 0 0 0 0 0</pose>
            </joint>"""
        )
    )
    assert is_at(frames.pose("j"), 1, 1, 0)
    assert is_at(frames.pose("k"), 2, 1, 0)


def test_frame_pose_is_relative_to_attached_or_named_frame():
    frames = Frames(
        make_model_text(
            LINKS
            + """<frame name="f" attached_to="b"><pose>0 0 1 0 0 0</pose></frame>
            <frame name="g" attached_to="f"><pose relative_to="a">0 0 5 0 0 0</pose></frame><frame name="h"/>"""
        )
    )
    assert is_at(frames.pose("f"), 1, 0, 1)
    assert is_at(frames.pose("g"), 0, 0, 5)
    assert is_at(frames.pose("h"), 0, 0, 0)
    assert (frames.link("f"), frames.link("g"), frames.link("h")) == ("b", "b", "a")


def test_nested_names_are_resolved():
    frames = Frames(
        make_model_text(
            f"""<model name="arm"><pose>0 0 1 0 0 {pi / 2}</pose>{LINKS}<model name="hand"><pose>2 0 0 0 0 0</pose>
            <link name="tip"><pose>0 0 1 0 0 0</pose></link></model></model>
            <link name="lamp"><pose relative_to="arm::hand::tip">0 0 1 0 0 0</pose></link>"""
        )
    )
    assert is_at(frames.pose("arm::b"), 0, 1, 1)
    assert is_at(frames.pose("arm::hand::tip"), 0, 2, 2)
    assert is_at(frames.pose("lamp"), 0, 2, 3)
    assert frames.link("arm") == "arm::a"
    assert "arm::hand::tip" in frames
    assert "arm::hand::top" not in frames
    assert "leg::tip" not in frames


def test_model_frame_is_attached_to_canonical_link():
    assert Frames(make_model_text(LINKS)).link("__model__") == "a"
    assert Frames(make_model_text(LINKS, 'canonical_link="b"')).link("__model__") == "b"
    only_inner = '<model name="i"><link name="l"/></model>'
    assert Frames(make_model_text(only_inner)).link("__model__") == "i::l"


def test_placement_frame_is_placed_at_model_pose():
    parsed_world = make_world_text(
        f"""<model name="m" placement_frame="b"><pose>5 0 0 0 0 {pi / 2}</pose>{LINKS}</model>"""
    )
    frames = Frames(parsed_world)
    assert is_at(frames.pose("m"), 5, -1, 0)
    assert is_at(frames.pose("m::b"), 5, 0, 0)


def test_axis_is_expressed_in_joint_frame():
    for axis_text in (
        '<xyz expressed_in="__model__">1 0 0</xyz>',
        "<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>",
    ):
        owner = make_model_text(
            f"""<link name="a"/><link name="b"><pose>{QUARTER_TURN}</pose></link>
            <joint name="j" type="revolute"><parent>a</parent><child>b</child><axis>{axis_text}</axis></joint>"""
        )
        joint = owner.joints[0]
        assert joint.axis is not None
        assert Frames(owner).axis(joint, joint.axis) == pytest.approx((0, -1, 0))


def test_long_chain_of_frames_is_resolved():
    frames = [
        f'<frame name="f{number}"><pose relative_to="f{number - 1}">1 0 0 0 0 0</pose></frame>'
        for number in range(1, 5001)
    ]
    chain = Frames(make_model_text("".join(reversed(frames)) + '<frame name="f0"/><link name="a"/>'))
    assert is_at(chain.pose("f5000"), 5000, 0, 0)


def test_unknown_frames_are_errors():
    frames = Frames(make_model_text(LINKS))
    for name in ("c", "a::b", "c::d"):
        with pytest.raises(FrameError):
            frames.pose(name)


def test_world_links_have_poses_and_static_flag():
    parsed_world = make_world_text(
        f"""<model name="m"><pose>0 0 1 0 0 0</pose>{LINKS}</model>
        <model name="s"><static>1</static><pose relative_to="m">0 1 0 0 0 0</pose><model name="i">
        <pose>0 0 1 0 0 0</pose><link name="l"/></model></model>"""
    )
    assert [
        (placed_link.name, placed_link.pose[:3], placed_link.static) for placed_link in placed_links(parsed_world)
    ] == [
        ("m::a", (0, 0, 1), False),
        ("m::b", (1, 0, 1), False),
        ("s::i::l", (0, 1, 2), True),
    ]
