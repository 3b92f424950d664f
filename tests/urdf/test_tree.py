"""The tree of links.

The tests cover the order of children, the parent that urdfdom keeps, and the printed tree.
"""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given

from linkwright.descriptions import load
from linkwright.urdf import children_of, parent_joints, to_gv, tree_text
from linkwright.urdf.tree import walk
from tests.urdf.robots import robot_text, robots


def joint_text(name, parent, child, inside=""):
    return f'<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>'


BRANCHES = robot_text(
    '<link name="base"/><link name="b"/><link name="a"/><link name="tip"/>',
    joint_text("z_to_a", "base", "a"),
    joint_text("Y_to_b", "base", "b", '<origin xyz="0.1 1e-7 123456789" rpy="0 1.5707963267948966 0.3"/>'),
    joint_text("tip_joint", "b", "tip", '<origin xyz="-0 0 0.333" rpy="-1.57079632679 0 0"/>'),
)
DIAMOND = robot_text(
    '<link name="r"/><link name="a"/><link name="b"/>',
    joint_text("i", "r", "a"),
    joint_text("j", "r", "b", '<origin xyz="1 0 0"/>'),
    joint_text("k", "a", "b", '<origin xyz="2 0 0"/>'),
)


def test_children_are_ordered_by_joint_name():
    children = children_of(load(BRANCHES))
    assert [below.child for below in children["base"]] == ["b", "a"]
    assert children["tip"] == ()


def test_tree_text_lists_children():
    assert tree_text(load(BRANCHES)) == (
        "robot name is: r\n"
        "---------- Successfully Parsed XML ---------------\n"
        "root Link: base has 2 child(ren)\n"
        "    child(1):  b\n"
        "        child(1):  tip\n"
        "    child(2):  a\n"
    )


def test_tree_text_of_single_link():
    assert tree_text(load(robot_text('<link name="only"/>'))).endswith("root Link: only has 0 child(ren)\n")


def test_gv_matches_urdf_to_graphviz():
    assert to_gv(load(BRANCHES)) == (
        "digraph G {\n"
        "node [shape=box];\n"
        '"base" [label="base"];\n'
        '"b" [label="b"];\n'
        '"tip" [label="tip"];\n'
        '"a" [label="a"];\n'
        "node [shape=ellipse, color=blue, fontcolor=blue];\n"
        '"base" -> "Y_to_b" [label="xyz: 0.1 1e-07 1.23457e+08 \\nrpy: 0 1.5708 0.3"]\n'
        '"Y_to_b" -> "b"\n'
        '"b" -> "tip_joint" [label="xyz: -0 0 0.333 \\nrpy: -1.5708 0 0"]\n'
        '"tip_joint" -> "tip"\n'
        '"base" -> "z_to_a" [label="xyz: 0 0 0 \\nrpy: 0 -0 0"]\n'
        '"z_to_a" -> "a"\n'
        "}\n"
    )


def test_link_with_two_parents_is_listed_under_both():
    robot = load(DIAMOND)
    assert parent_joints(robot)["b"].name == "k"
    assert tree_text(robot).count("  b\n") == 2
    gv = to_gv(robot)
    assert '"r" -> "k" [label="xyz: 2 0 0 ' in gv
    assert '"a" -> "k" [label="xyz: 2 0 0 ' in gv
    assert '"j"' not in gv


def test_tree_text_of_many_paths_is_bounded():
    count = 60
    links = "".join(f'<link name="l{n}"/>' for n in range(count))
    doubled = "".join(joint_text(f"{side}{n:02}", f"l{n - 1}", f"l{n}") for n in range(1, count) for side in "xy")
    text = tree_text(load(robot_text(links, doubled)))
    assert 64 * count < text.count("\n") < 200 * count


@given(robots())
def test_walk_visits_each_link_once_after_its_parent(robot):
    visited = [robot.root]
    steps = list(walk(robot))
    for below, _ in steps:
        assert below.parent in visited
        assert below.child not in visited
        visited.append(below.child)
    assert set(visited) == set(robot.links)
    assert all(later <= earlier + 1 for (_, earlier), (_, later) in pairwise(steps))
