"""Classes of a package whose constructors make publishers, subscriptions, services and clients, in a review."""

from __future__ import annotations

import os

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
SETUP = """from setuptools import setup
setup(name="arm", entry_points={"console_scripts": ["left = arm.left:main", "right = arm.right:main"]})
"""
EVENTS = """from rclpy.node import Node


class Sender(Node):
    def __init__(self, msg_type, topic: str = "mode", depth=10):
        super().__init__("sender")
        self.pub = self.create_publisher(msg_type, topic, depth)


class Listener(Node):
    def __init__(self, msg_type, topic, *, call=None):
        super().__init__("listener")
        self.topic = topic
        self.sub = self.create_subscription(msg_type, self.topic, call, 10)


class Asker(Listener):
    def __init__(self, node, name):
        self.cli = node.create_client(Move, name)


class Quick(Sender):
    pass


class Changing(Node):
    def __init__(self, topic):
        topic = topic.lower()
        self.pub = self.create_publisher(String, topic, 10)
"""
USER = """import rclpy
{imports}
from std_msgs.msg import String


def main():
    rclpy.init()
    {call}
"""
FILES = {**MANIFEST, "arm/setup.py": SETUP, "arm/arm/__init__.py": "", "arm/arm/events.py": EVENTS}
IMPORT = "from arm.events import Asker, Changing, Listener, Quick, Sender"


@pytest.mark.parametrize(
    ("imports", "call", "expected"),
    [
        (IMPORT, "Sender(String, 'goal')", "publishers removed: 'goal' (String)"),
        ("from . import events", "events.Sender(topic='goal', msg_type=String)", "publishers removed: 'goal' (String)"),
        (IMPORT, "Sender(String)", "publishers removed: 'mode' (String)"),
        (IMPORT, "Quick(String, 'goal')", "publishers removed: 'goal' (String)"),
        (IMPORT, "Listener(String, 'scan')", "subscriptions removed: 'scan' (String)"),
        (IMPORT, "Asker(node, 'move')", "service clients removed: 'move'"),
    ],
)
def test_name_that_a_caller_passes_to_a_class_is_told(repository, compare, imports, call, expected):
    path = "arm/arm/left.py"
    repository.commit({**FILES, path: USER.format(imports=imports, call=call)})
    repository.write({path: USER.format(imports=imports, call="pass")})
    result = compare(repository)
    assert expected in sentences(subject(result, path))
    assert bool(breaking(result)) is not expected.startswith("service clients")


@pytest.mark.parametrize("call", ["Changing('goal')", "Sender(*arguments)", "Unknown(String, 'goal')"])
def test_name_that_the_class_may_change_is_not_told(repository, compare, call):
    path = "arm/arm/left.py"
    repository.commit({**FILES, path: USER.format(imports=IMPORT, call=call)})
    repository.write({path: USER.format(imports=IMPORT, call="pass")})
    assert breaking(compare(repository)) == []


def test_qos_that_a_caller_passes_to_a_class_is_compared(repository, compare):
    path = "arm/arm/left.py"
    repository.commit({**FILES, path: USER.format(imports=IMPORT, call="Sender(String, 'goal', 10)")})
    repository.write({path: USER.format(imports=IMPORT, call="Sender(String, 'goal', 5)")})
    assert sentences(subject(compare(repository), path)) == ["publisher 'goal': QoS 10 -> 5"]


CERTAIN = "programs that use the name '{}' do not find it"
LAUNCH = '<launch><node pkg="arm" exec="{program}" namespace="base">{remap}</node></launch>'
WIDGET = """from arm.events import Listener, Sender


class Widget:
    def __init__(self):
        self.sub = Listener(String, "scan")
        self.pub = Sender(String, "goal")
"""


@pytest.mark.parametrize(
    ("program", "name", "is_breaking"),
    [
        ("left", "/base/goal", True),
        ("left", "/base/scan", False),
        ("left", "/base/other", False),
        ("right", "/base/goal", False),
        ("right", "/base/other", True),
    ],
)
@pytest.mark.parametrize("is_added", [True, False])
def test_sources_of_a_program_are_its_module_and_those_that_it_imports(
    repository, compare, program, name, is_breaking, is_added
):
    left = USER.format(imports="from arm.widget import Widget", call="Widget()")
    right = USER.format(imports=IMPORT, call="Sender(String, 'other')")
    path = "arm/launch/arm.launch.xml"
    remapped = LAUNCH.format(program=program, remap=f'<remap from="{name}" to="/x"/>')
    texts = [LAUNCH.format(program=program, remap=""), remapped]
    modules = {"arm/arm/left.py": left, "arm/arm/right.py": right, "arm/arm/widget.py": WIDGET}
    repository.commit({**FILES, **modules, path: texts[not is_added]})
    repository.write({path: texts[is_added]})
    reason = CERTAIN.format(name if is_added else "/x")
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == (reason if is_breaking else None)


def test_program_that_computes_a_name_may_publish_any(repository, compare):
    path = "arm/launch/arm.launch.xml"
    left = USER.format(imports=IMPORT, call="Sender(String, compute())")
    repository.commit({**FILES, "arm/arm/left.py": left, path: LAUNCH.format(program="left", remap="")})
    repository.write({path: LAUNCH.format(program="left", remap='<remap from="goal" to="/x"/>')})
    (change,) = subject(compare(repository), path).changes
    assert str(change.reason) == "if the node publishes or serves 'goal', programs that use it do not find it"


@pytest.mark.parametrize(("added", "is_breaking"), [("right", False), ("left", True)])
def test_name_that_an_added_node_publishes_is_moved(repository, compare, added, is_breaking):
    remap = '<remap from="{}" to="/x"/>'
    mixer, left, right = (
        USER.format(imports=IMPORT, call=call)
        for call in ("Sender(String, 'out_mix')", "Listener(String, 'goal')", "Sender(String, 'goal')")
    )
    setup = SETUP.replace('["', '["mixer = arm.mixer:main", "')
    path = "arm/launch/arm.launch.xml"
    files = {"arm/setup.py": setup, "arm/arm/mixer.py": mixer, "arm/arm/left.py": left, "arm/arm/right.py": right}
    old = LAUNCH.format(program="mixer", remap=remap.format("out_mix"))
    repository.commit({**FILES, **files, path: old})
    node = LAUNCH.format(program=added, remap=remap.format("goal")).removeprefix("<launch>")
    repository.write({path: LAUNCH.format(program="mixer", remap="").replace("</launch>", node)})
    found = [change for change in subject(compare(repository), path).changes if change.reason is not None]
    assert [str(change.reason) for change in found] == ([CERTAIN.format("/x")] if is_breaking else [])


HANDLERS = """import rospy


class Handler(object):
    def __init__(self, name, topic, msg_type):
        self.topic = topic
        self.msg_type = msg_type
        rospy.init_node(name)


class Sender(Handler):
    def __init__(self, name, topic, msg_type, size=10):
        CALL
        self.pub = rospy.Publisher(self.topic, self.msg_type, queue_size=size)
"""
HANDLER_USER = "from handlers import Sender\nfrom std_msgs.msg import Bool, String\n\nSender('arm', 'state', String)\n"


@pytest.mark.parametrize(
    ("call", "is_told"),
    [
        ("super(Sender, self).__init__(name, topic, msg_type)", True),
        ("super().__init__(name, msg_type=msg_type, topic=topic)", True),
        ("Handler.__init__(self, name, topic, msg_type)", True),
        ("super().__init__(name, topic.lower(), msg_type)", False),
        ("super().__init__(name, topic, msg_type)\n        self.topic = 'other'", False),
        ("super().__init__(name, topic, msg_type)\n        LATER", True),
    ],
)
def test_name_that_a_class_passes_to_its_base_class_is_told(repository, compare, call, is_told):
    text = HANDLERS.replace("CALL", call.replace("\n        LATER", ""))
    text += "\n    def move(self, topic):\n        self.topic = topic\n" if "LATER" in call else ""
    files = {"arm/scripts/handlers.py": text, "arm/scripts/arm.py": HANDLER_USER}
    repository.commit({**MANIFEST, **files})
    repository.write({"arm/scripts/arm.py": HANDLER_USER.replace(", String)", ", Bool)")})
    assert ("publisher 'state': type String -> Bool" in breaking(compare(repository))) == is_told


@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
@pytest.mark.parametrize(("target", "is_beside"), [("../handlers", True), ("../../handlers", False)])
def test_modules_behind_a_link_are_read_if_they_are_beside_the_package(repository, compare, target, is_beside):
    text = HANDLERS.replace("CALL", "Handler.__init__(self, name, topic, msg_type)")
    package = repository.root / "src/arm"
    package.mkdir(parents=True)
    (package / "handlers").symlink_to(target)
    repository.commit(
        {
            "src/arm/package.xml": MANIFEST["arm/package.xml"],
            "src/handlers/__init__.py" if is_beside else "handlers/__init__.py": text,
            "src/arm/arm.py": HANDLER_USER,
        }
    )
    repository.write({"src/arm/arm.py": HANDLER_USER.replace(", String)", ", Bool)")})
    assert ("publisher 'state': type String -> Bool" in breaking(compare(repository))) == is_beside
