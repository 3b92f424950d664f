"""The lines of a review about parameter files that still name a renamed node."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

MANIFEST = "<package><name>lamp</name><version>1.0.0</version></package>\n"
LAUNCH = """<launch>
  <node pkg="lamp" exec="lamp" name="{name}"><param from="$(find-pkg-share lamp)/config/lamp.yaml"/></node>
{more}</launch>
"""
SOURCE = 'from rclpy.node import Node\nclass Lamp(Node):\n    def __init__(self):\n        super().__init__("{}")\n'
SETTINGS = "{}:\n  ros__parameters:\n    level: 2\n"
OTHER = '  <node pkg="lamp" exec="other" name="lamp"/>\n'


@pytest.mark.parametrize(
    ("settings", "more", "is_found"),
    [
        (SETTINGS.format("lamp"), "", True),
        (SETTINGS.format("/lamp"), "", True),
        (SETTINGS.format("light"), "", False),
        (SETTINGS.format("/**"), "", False),
        (SETTINGS.format("lamp") + SETTINGS.format("light"), "", False),
        (SETTINGS.format("lamp"), OTHER, False),
    ],
)
def test_a_file_for_a_node_with_another_name_in_the_launch_file(repository, compare, settings, more, is_found):
    path = "lamp/launch/a.launch.xml"
    launches = [LAUNCH.format(name=name, more=more) for name in ("lamp", "light")]
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": settings, path: launches[0]})
    repository.write({path: launches[1]})
    found = [line for line in breaking(compare(repository)) if line.startswith("names the node")]
    assert found == ([f"names the node 'lamp', which '{path}' now calls 'light'"] if is_found else [])


@pytest.mark.parametrize(
    ("settings", "launch", "other", "is_found"),
    [
        (SETTINGS.format("lamp"), "<launch/>\n", "", True),
        (SETTINGS.format("light"), "<launch/>\n", "", False),
        (SETTINGS.format("lamp"), LAUNCH.format(name="lamp", more=""), "", False),
        (SETTINGS.format("lamp"), "<launch/>\n", SOURCE.format("lamp"), False),
    ],
)
def test_a_file_for_a_node_with_another_name_in_the_source(repository, compare, settings, launch, other, is_found):
    files = {
        "lamp/package.xml": MANIFEST,
        "lamp/config/lamp.yaml": settings,
        "lamp/launch/a.launch.xml": launch,
        "lamp/lamp/other.py": other,
    }
    repository.commit({**files, "lamp/lamp/lamp.py": SOURCE.format("lamp")})
    repository.write({"lamp/lamp/lamp.py": SOURCE.format("light")})
    found = [line for line in breaking(compare(repository)) if line.startswith("names the node")]
    assert found == (["names the node 'lamp', which 'lamp/lamp/lamp.py' now calls 'light'"] if is_found else [])


CLIENT = '#include <rclcpp/rclcpp.hpp>\nauto client = node->create_client<srv::SetParameters>("{}");\n'


@pytest.mark.parametrize(
    ("service", "more", "is_found"),
    [
        ("/lamp/set_parameters", "", True),
        ("lamp/change_state", "", True),
        ("/lamp/set_level", "", False),  # may be of another node
        ("/light/set_parameters", "", False),
        ("/set_parameters", "", False),
        ("/lamp/set_parameters", OTHER, False),
    ],
)
def test_a_client_of_a_node_with_another_name(repository, compare, service, more, is_found):
    path, source = "lamp/launch/a.launch.xml", "lamp/src/client.cpp"
    launches = [LAUNCH.format(name=name, more=more) for name in ("lamp", "light")]
    repository.commit({"lamp/package.xml": MANIFEST, source: CLIENT.format(service), path: launches[0]})
    repository.write({path: launches[1]})
    found = [line for line in breaking(compare(repository)) if line.startswith("calls ")]
    assert found == ([f"calls '{service}' of the node 'lamp', which '{path}' now calls 'light'"] if is_found else [])


def test_a_client_of_a_node_with_another_name_in_the_source(repository, compare):
    files = {"lamp/package.xml": MANIFEST, "lamp/src/client.cpp": CLIENT.format("/lamp/get_parameters")}
    repository.commit({**files, "lamp/lamp/lamp.py": SOURCE.format("lamp")})
    repository.write({"lamp/lamp/lamp.py": SOURCE.format("light")})
    found = [line for line in breaking(compare(repository)) if line.startswith("calls ")]
    assert found == ["calls '/lamp/get_parameters' of the node 'lamp', which 'lamp/lamp/lamp.py' now calls 'light'"]


@pytest.mark.parametrize(
    ("own", "topic", "is_found"),
    [("~/state", "/lamp/state", True), ("~/state", "/lamp/level", False), ("state", "/lamp/state", False)],
)
def test_a_subscriber_to_a_private_topic_of_a_node_with_another_name(repository, compare, own, topic, is_found):
    path, source = "lamp/launch/a.launch.xml", "view/view.py"
    launches = [LAUNCH.format(name=name, more="") for name in ("lamp", "light")]
    node = f"{SOURCE.format('lamp')}        self.create_publisher(Bool, '{own}', 1)\n"
    view = f"{SOURCE.format('view')}        self.create_subscription(Bool, '{topic}', print, 1)\n"
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/lamp/lamp.py": node, source: view, path: launches[0]})
    repository.write({path: launches[1]})
    found = [line for line in breaking(compare(repository)) if line.startswith("uses ")]
    assert found == ([f"uses '{topic}' of the node 'lamp', which '{path}' now calls 'light'"] if is_found else [])


@pytest.mark.parametrize(
    ("name", "settings", "more", "is_found"),
    [
        ("desk_lamb", SETTINGS.format("desk_lamp"), "", True),
        ("desk_lamp_node", SETTINGS.format("desk_lamp"), "", True),
        ("desk_lamb", SETTINGS.format("desk_lamp") + SETTINGS.format("desk_lamb"), "", False),
        ("desk_lamb", SETTINGS.format("desk_lamp"), OTHER.replace("lamp", "desk_lamp"), False),
        ("desk_lamb", SETTINGS.format("desk_lamp") + SETTINGS.format("/**"), "", False),
        ("desk2", SETTINGS.format("desk1"), "", False),
        ("map_server", SETTINGS.format("map_saver"), "", False),
        ("$(var name)", SETTINGS.format("desk_lamp"), "", False),
    ],
)
def test_a_node_whose_file_spells_its_name_in_another_way(repository, compare, name, settings, more, is_found):
    path = "lamp/launch/a.launch.xml"
    files = {"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": settings}
    repository.commit({**files, path: LAUNCH.format(name="desk", more=more)})
    repository.write({path: LAUNCH.format(name=name, more=more)})
    found = [line for line in breaking(compare(repository)) if "gets no parameters" in line]
    text = f"node '{name}' gets no parameters from 'lamp/config/lamp.yaml', which has those of 'desk_lamp'"
    assert found == ([text] if is_found else [])


def test_a_new_node_whose_file_spells_its_name_in_another_way_breaks_nothing(repository, compare):
    path = "lamp/launch/a.launch.xml"
    files = {"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": SETTINGS.format("desk_lamp")}
    repository.commit({**files, path: f"<launch>\n{OTHER}</launch>\n"})
    repository.write({path: LAUNCH.format(name="desk_lamb", more=OTHER)})
    review = compare(repository)
    assert [line for line in sentences(subject(review, path)) if "gets no parameters" in line]
    assert breaking(review) == []
