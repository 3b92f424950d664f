"""``linkwright spawn``, with a simulator that records the requests."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from linkwright.cli import calls, main
from linkwright.graph import Graph
from linkwright.messages import get_service

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


@pytest.fixture
def spawn_requests(add_to_graph) -> list[Any]:
    """Return the requests for entities; a used name is refused."""
    requests: list[Any] = []

    def spawn(request: Any, response: Any) -> Any:
        response.success = request.name not in [request.name for request in requests]
        response.status_message = f"spawned {request.name}" if response.success else "it is there"
        requests.append(request)
        return response

    def simulator(graph: Graph) -> None:
        graph.create_node("gazebo").create_service(get_service("gazebo_msgs/srv/SpawnEntity"), "/spawn_entity", spawn)

    add_to_graph(simulator)
    return requests


def robot(folder: Path) -> str:
    path = folder / "robot.urdf"
    path.write_text(ROBOT)
    return str(path)


def test_spawn_places_robot_at_pose_and_namespace(spawn_requests, tmp_path, capsys):
    place = ("-x", "1.5", "-y", "-2", "-z", "0.1", "-Y", str(math.pi / 2))
    assert main(["spawn", robot(tmp_path), "-name", "second", *place, "--namespace", "two"]) == 0
    assert capsys.readouterr().out == "spawned second\n"
    (request,) = spawn_requests
    assert (request.name, request.robot_namespace) == ("second", "two")
    assert '<link name="base"' in request.xml
    pose = request.initial_pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (1.5, -2.0, 0.1)
    assert pose.orientation.z == pytest.approx(math.sqrt(0.5))


def test_default_name_is_taken_from_file(spawn_requests, tmp_path):
    (tmp_path / "box.sdf").write_text('<sdf version="1.7"><model name="box"><link name="a"/></model></sdf>')
    assert main(["spawn", robot(tmp_path)]) == 0
    assert main(["spawn", str(tmp_path / "box.sdf")]) == 0
    assert [request.name for request in spawn_requests] == ["r", "box"]
    assert spawn_requests[1].xml.count("<model") == 1


def test_simulation_rejection_is_one_error(spawn_requests, tmp_path, capsys):
    assert main(["spawn", robot(tmp_path)]) == 0
    assert main(["spawn", robot(tmp_path)]) == 1
    output = capsys.readouterr().err
    assert output.count("error[CLI333]") == 1
    assert "rejects 'r': it is there" in output


def test_missing_simulation_is_reported_with_hint(add_to_graph, tmp_path, capsys, monkeypatch):
    add_to_graph(lambda graph: None)
    monkeypatch.setattr(calls, "SERVICE_TIMEOUT_S", 0.0)
    assert main(["spawn", robot(tmp_path)]) == 1
    output = capsys.readouterr().err
    assert output.count("error[") == 1
    assert "linkwright sim empty" in output


def test_malformed_model_is_one_error(spawn_requests, tmp_path, capsys):
    (tmp_path / "robot.urdf").write_text("<robot")
    assert main(["spawn", str(tmp_path / "robot.urdf")]) == 1
    assert capsys.readouterr().err.count("error[") == 1
    assert spawn_requests == []


def test_model_uris_are_resolved_beside_model(spawn_requests, tmp_path, monkeypatch, capsys):
    for folder in ("models/robot", "models/common", "far/away"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "models/common/part.stl").write_bytes(b"solid")
    (tmp_path / "models/common/model.config").write_text("<model><sdf>model.sdf</sdf></model>")
    shape = "<visual name='{0}'><geometry><mesh><uri>{1}</uri></mesh></geometry></visual>"
    shapes = shape.format("a", "model://common/part.stl") + shape.format("b", "model://none/part.stl")
    text = f"<sdf version='1.7'><model name='r'><link name='l'>{shapes}<color/></link></model></sdf>"
    (tmp_path / "models/robot/model.sdf").write_text(text)
    monkeypatch.chdir(tmp_path / "far/away")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert main(["spawn", str(tmp_path / "models/robot/model.sdf")]) == 0
    (request,) = spawn_requests
    assert (tmp_path / "models/common/part.stl").as_uri() in request.xml
    assert "model://none/part.stl" in request.xml
    assert "<color> in <link> is not read" in capsys.readouterr().err
