"""Robots as one HTML file; a browser test checks its appearance."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import os
import re

import pytest

from linkwright.messages import get_message
from linkwright.panels.export import html
from linkwright.panels.export.feature import export_snapshot, find_format
from linkwright.panels.export.snapshot import take_configuration_snapshot
from linkwright.rviz import RvizConfig
from tests.browser.golden import link_element, mesh_visual, robot_of
from tests.browser.mesh_writers import make_png, write_dae, write_glb, write_obj, write_stl_binary
from tests.panels.export.robots import GRIPPER, make_snapshot
from tests.viewer.scene import ARM, open_world


@pytest.fixture(autouse=True)
def built(tmp_path, monkeypatch):
    """Create the files of a built page."""
    folder = tmp_path / "page" / "export"
    folder.mkdir(parents=True)
    (folder / "export.js").write_text('console.log("</script><!--")')
    (folder / "export.css").write_text("body { color: red }")
    monkeypatch.setattr(html, "PAGE_FOLDER", tmp_path / "page")


def read_recording(text: str) -> dict:
    (recording_text,) = re.findall(r'<script type="application/json" id="recorded">(.*?)</script>', text, re.DOTALL)
    return json.loads(recording_text)


def export_page(text: str) -> str:
    return export_snapshot(make_snapshot(text), "html").decode()


def test_same_files_give_the_same_bytes(tmp_path):
    for name in ("a.stl", "b.stl"):
        (tmp_path / name).write_bytes(write_stl_binary())
    text = robot_of(
        link_element("a", mesh_visual(tmp_path / "a.stl", "")) + link_element("b", mesh_visual(tmp_path / "b.stl", ""))
    )
    first = export_page(text)
    os.utime(tmp_path / "a.stl", (1_000_000, 1_000_000))
    assert export_page(text) == first
    assert str(tmp_path) not in first


def test_html_contains_all_server_messages():
    logged = read_recording(export_page(GRIPPER))
    types = [message["type"] for message in logged["messages"]]
    for message_type in ("hello", "tree", "robot_scene", "view_classes", "view_state", "joints", "joint_positions"):
        assert message_type in types
    assert types[-1] == "frame_table"
    controls = next(message for message in logged["messages"] if message["type"] == "joints")["controls"]
    assert [(control["name"], control["mimic"]) for control in controls] == [
        ("turn", None),
        ("open", None),
        ("open_too", "open"),
    ]
    positions = next(message for message in logged["messages"] if message["type"] == "joint_positions")["positions"]
    assert positions == pytest.approx({"turn": 0.0, "open": 0.25, "open_too": -0.45}, abs=1e-6)
    assert next(message for message in logged["messages"] if message["type"] == "view_state")["whole_robot"] is True
    assert logged["awaits_size"] is True
    assert logged["spacing"] == pytest.approx(1.0, abs=0.1)  # from the arm to a finger


def test_content_security_policy_allows_only_own_script():
    text = export_page(GRIPPER)
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', text)
    script = text.rpartition("<script>")[2].partition("</script>")[0]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    assert "http" not in policy
    assert text.count("</script>") == 2
    assert not re.search(r'(?:src|href)="', text)


def test_compressed_export_script_is_supported(tmp_path):
    script = tmp_path / "page" / "export" / "export.js"
    script.with_name("export.js.gz").write_bytes(gzip.compress(b'console.log("packed")'))
    script.unlink()
    assert '<script>console.log("packed")</script>' in export_page(GRIPPER)


def test_robot_names_are_escaped():
    name = "</script><script>alert(1)</script>"
    text = export_page(f'<robot name="{name.replace("<", "&lt;")}"><link name="&lt;!--"/></robot>')
    assert "<script>alert" not in text
    scene = next(message for message in read_recording(text)["messages"] if message["type"] == "robot_scene")
    assert (scene["name"], scene["links"][0]["name"]) == (name, "<!--")


def test_meshes_and_referenced_files_are_embedded(tmp_path):
    (tmp_path / "a.dae").write_bytes(write_dae())
    (tmp_path / "b.obj").write_bytes(write_obj("b.mtl", "paint"))
    (tmp_path / "b.mtl").write_text("newmtl paint\nKd 1 0 0\nmap_Kd -s 1 1 wood.png\n")
    (tmp_path / "wood.png").write_bytes(make_png(1, 2, 3))
    (tmp_path / "c.glb").write_bytes(write_glb())
    (tmp_path / "d.stl").write_bytes(write_stl_binary())
    (tmp_path / "secret.png").write_bytes(make_png(9, 9, 9))
    names = ("a.dae", "b.obj", "c.glb", "d.stl")
    logged = read_recording(
        export_page(robot_of("".join(link_element(name[0], mesh_visual(tmp_path / name, "")) for name in names)))
    )
    files = {path.rpartition("/")[2]: base64.b64decode(data) for path, data in logged["files"].items()}
    assert set(files) == {*names, "b.mtl", "wood.png"}
    assert files["d.stl"] == write_stl_binary()


def test_meshes_cannot_embed_files_from_other_folders(tmp_path):
    (tmp_path / "secret.png").write_bytes(make_png(9, 9, 9))
    folder = tmp_path / "meshes"
    folder.mkdir()
    (folder / "b.obj").write_bytes(write_obj("b.mtl", "paint"))
    (folder / "b.mtl").write_text("newmtl paint\nmap_Kd ../secret.png\nmap_Ks /etc/passwd\n")
    (folder / "link.mtl").symlink_to(tmp_path / "secret.png")
    logged = read_recording(export_page(robot_of(link_element("b", mesh_visual(folder / "b.obj", "")))))
    assert {path.rpartition("/")[2] for path in logged["files"]} == {"b.obj", "b.mtl"}


def test_html_contains_no_local_paths(tmp_path):
    (tmp_path / "d.stl").write_bytes(write_stl_binary())
    text = export_page(robot_of(link_element("d", mesh_visual(tmp_path / "d.stl", ""))))
    assert str(tmp_path) not in text
    # The secret in the URLs of the program's files is not exported either.
    assert re.search(r"/mesh/[^/~]+/d\.stl", text)
    assert not re.search(r"~[0-9a-f]{32}", text)
    assert '"place":{' not in text


@pytest.mark.parametrize(
    ("name", "has_known_suffix"), [("a.html", True), ("b.GLB", True), ("c.gltf", False), ("html", False)]
)
def test_export_format_is_recognized_by_suffix(name, has_known_suffix):
    assert (find_format(name) is not None) is has_known_suffix


async def test_html_contains_markers():
    """Markers and similar displays have their current state."""
    config = RvizConfig.for_model("base")
    config.insert(config.make_display("rviz_default_plugins/Marker", "Marker"))
    async with open_world(config) as world:
        world.describe(ARM)
        world.move_arm()
        marker = get_message("visualization_msgs/msg/Marker")()
        marker.header.frame_id, marker.type, marker.scale.x, marker.color.a = "base", 1, 1.0, 1.0
        topic = world.display("Marker").properties.text("Topic")
        world.graph.create_node("marks").create_publisher(type(marker), topic, 10).publish(marker)
        await world.settle()
        world.viewer.manager.fit_to_robot(2.0, 0.0)
        snapshot = take_configuration_snapshot(world.viewer, world.viewer.manager)
    logged = read_recording(export_snapshot(snapshot, "html").decode())
    assert logged["awaits_size"] is False  # a page has already measured the robot
    assert logged["spacing"] is None
    frames = [base64.b64decode(frame) for frame in logged["frames"]]
    assert any(b"markers_changed" in frame for frame in frames)
