"""Servers of dynamic_reconfigure, and web servers, in the sources of nodes in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

PYTHON = """import socketio
from dynamic_reconfigure.server import Server
from flask import Flask

server = Server(ArmConfig, on_config)


@app.route('/api/stop', methods=['POST'])
def stop():
    return halt()


@app.get('/api/state')
def state():
    return {}


@sio.on('spin')
def spin(data):
    turn(data)


@cache.get('key')
def key():
    pass
"""
CPP = """class Driver {
  dynamic_reconfigure ::Server < arm ::ArmConfig > server_;
};
"""


@pytest.mark.parametrize(
    ("path", "old", "new", "expected", "is_breaking"),
    [
        ("arm/a.py", "server = Server(ArmConfig, on_config)", "",
         ["servers of dynamic_reconfigure removed: 'ArmConfig'"], True),
        ("arm/a.py", "/api/stop", "/api/halt", ["web route '/api/stop' renamed to '/api/halt'"], True),
        ("arm/a.py", "def key", "@app.post('/api/key')\ndef key", ["web routes added: '/api/key'"], False),
        ("arm/a.py", "'spin'", "'spins'", ["event of Socket.IO 'spin' renamed to 'spins'"], True),
        ("arm/a.py", "'key'", "'keys'",
         ["in 'key()': `@cache.get('key') def key()` -> `@cache.get('keys') def key()`"], False),
        ("arm/a.py", "turn(data)", "turn(data.speed)",
         ["in 'spin()' (callback of event of Socket.IO 'spin'): `turn(data)` -> `turn(data.speed)`"], False),
        ("src/a.cpp", "  dynamic_reconfigure ::Server < arm ::ArmConfig > server_;\n", "",
         ["servers of dynamic_reconfigure removed: 'ArmConfig'"], True),
    ],
)  # fmt: skip
def test_servers_are_told(repository, compare, path, old, new, expected, is_breaking):
    text = PYTHON if path.endswith(".py") else CPP
    assert old in text
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), path: text})
    repository.write({path: text.replace(old, new)})
    result = compare(repository)
    assert [sentence for subject in result.subjects for sentence in sentences(subject)] == expected
    assert bool(breaking(result)) is is_breaking


def test_the_reason_quotes_each_of_several_lost_names(repository, compare):
    path = "arm/scripts/arm.py"
    call = "node.create_publisher(Bool, '{}', 10)\n"
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    text = "import rclpy\nfrom std_msgs.msg import Bool\n\nnode = rclpy.create_node('arm')\n"
    repository.commit({**manifest, path: text + call.format("left") + call.format("right")})
    repository.write({path: text})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "programs that use the names 'left', 'right' do not find them"
