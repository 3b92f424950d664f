"""The lines of a review about removed groups of parameters in files without nodes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package><name>lamp</name><version>1.0.0</version></package>\n"
REST = "model: a\n"
GROUP = "devices:\n  lamp:\n    id: 1\n    bus: main\n"
FLAT = "devices:\n  id: 1\n  bus: main\n  rate: 2\n"
KEYS = "id: 1\nbus: second\n"
LAUNCH = '<launch><rosparam file="$(find lamp)/config/{name}" command="load"/></launch>\n'


@pytest.mark.parametrize(
    ("group", "files", "is_breaking"),
    [
        (GROUP, {}, True),
        ("devices:\n  lamp: 1\n", {}, False),
        (GROUP.replace("devices", "ros__parameters"), {}, False),
        (GROUP, {"lamp/config/more.yaml": GROUP}, True),
        (GROUP, {"lamp/config/more.yaml": GROUP, "lamp/launch/a.launch": LAUNCH.format(name="more.yaml")}, False),
        (FLAT, {"lamp/config/more.yaml": KEYS, "lamp/launch/a.launch": LAUNCH.format(name="more.yaml")}, False),
        (FLAT, {"lamp/config/more.yaml": "id: 2\n", "lamp/launch/a.launch": LAUNCH.format(name="more.yaml")}, True),
        (FLAT, {"lamp/config/more.yaml": KEYS}, True),
    ],
)
def test_a_removed_group_of_parameters_is_breaking(repository, compare, group, files, is_breaking):
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": REST + group})
    repository.write({"lamp/config/lamp.yaml": REST, **files})
    assert [line.partition(":")[0] for line in breaking(compare(repository))] == (
        ["devices removed"] if is_breaking else []
    )


ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="lamp">
  <xacro:property name="data" value="${{xacro.load_yaml('$(find lamp)/config/lamp.yaml')}}"/>
  <link name="{}"/>
</robot>
"""


@pytest.mark.parametrize(
    ("files", "is_breaking"),
    [
        ({"lamp/urdf/lamp.urdf.xacro": ROBOT.format("base")}, False),
        ({"lamp/urdf/lamp.urdf.xacro": ROBOT.format("${data['devices']['id']}")}, True),
        ({"lamp/urdf/lamp.urdf.xacro": ROBOT.format("base"), "lamp/read.py": "devices = load()\n"}, True),
        ({"lamp/urdf/lamp.urdf.xacro": ROBOT.format("base"), "lamp/read.py": "load('lamp.yaml')\n"}, True),
    ],
)
def test_a_group_that_no_description_reads_from_a_file_for_descriptions_is_not_missed(
    repository, compare, files, is_breaking
):
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": REST + FLAT, **files})
    repository.write({"lamp/config/lamp.yaml": REST})
    assert any(line.startswith("devices removed") for line in breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(("kept", "is_breaking"), [("", False), ("  - {name: spin, type: a/Slow}\n", True)])
def test_a_group_of_a_plugin_that_its_list_loses_is_not_missed(repository, compare, kept, is_breaking):
    plugins = "behaviors:\n  - {name: back, type: a/Back}\n"
    old = f"{plugins}  - {{name: spin, type: a/Spin}}\nspin:\n  rate: 1\n  angle: 2\n"
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/config/lamp.yaml": old})
    repository.write({"lamp/config/lamp.yaml": plugins + kept})
    assert [line.partition(":")[0] for line in breaking(compare(repository))] == (
        ["spin removed"] if is_breaking else []
    )
