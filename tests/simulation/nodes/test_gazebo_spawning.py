"""spawn_entity.py and create, with a simulator that only records requests."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Any

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_service
from linkwright.nodes import NodeOptions
from linkwright.simulation.nodes.create import Create
from linkwright.simulation.nodes.entities import DeleteEntity, Remove, SetEntityPose
from linkwright.simulation.nodes.spawn_entity import SpawnEntity, parse_arguments
from tests.nodes.harness import NodeHarness

ROBOT = "<robot name='r'><link name='base'/></robot>"


class Simulator:
    """Services of a simulator that record the requests.

    Attributes:
        spawned: the requests for entities.
        created: the requests for entities to the service of gz.
        deleted: the names of the entities to delete.
        new_states: the requested states.
        names: the models of the world.
        calls: other services that were called.
    """

    def __init__(self, harness: NodeHarness, namespace: str = "") -> None:
        self.spawned: list[Any] = []
        self.created: list[Any] = []
        self.deleted: list[str] = []
        self.new_states: list[Any] = []
        self.names = ["ground"]
        self.calls: list[str] = []
        self.refuses = False
        node = harness.graph.create_node("gazebo", namespace=namespace or "/")
        node.create_service(get_service("gazebo_msgs/srv/SpawnEntity"), "spawn_entity", self._spawn)
        node.create_service(get_service("gazebo_msgs/srv/DeleteEntity"), "delete_entity", self._delete)
        node.create_service(get_service("gazebo_msgs/srv/SetEntityState"), "set_entity_state", self._set_state)
        node.create_service(get_service("gazebo_msgs/srv/GetModelList"), "get_model_list", self._list)
        node.create_service(get_service("std_srvs/srv/Empty"), "unpause_physics", self._unpause)
        node.create_service(get_service("ros_gz_interfaces/srv/SpawnEntity"), "/world/test/create", self._create)

    def _spawn(self, request: Any, response: Any) -> Any:
        self.spawned.append(request)
        response.success = not self.refuses
        response.status_message = "Entity already exists" if self.refuses else f"spawned {request.name}"
        return response

    def _create(self, request: Any, response: Any) -> Any:
        self.created.append(request.entity_factory)
        response.success = not self.refuses
        return response

    def _delete(self, request: Any, response: Any) -> Any:
        self.deleted.append(request.name)
        response.success = request.name in self.names
        return response

    def _set_state(self, request: Any, response: Any) -> Any:
        self.new_states.append(request.state)
        response.success = request.state.name in self.names
        return response

    def _list(self, _: Any, response: Any) -> Any:
        response.model_names = self.names
        return response

    def _unpause(self, _: Any, response: Any) -> Any:
        self.calls.append("unpause")
        return response


def start_spawn_entity(harness: NodeHarness, *arguments: str, **options: Any) -> SpawnEntity:
    return SpawnEntity(harness.graph, NodeOptions(arguments=list(arguments), **options))


def start_create(harness: NodeHarness, *arguments: str, **parameters: Any) -> Create:
    return Create(harness.graph, NodeOptions(arguments=list(arguments), parameters=parameters))


async def test_published_description_is_spawned_at_pose(harness, logged):
    simulator = Simulator(harness)
    pose_arguments = ("-x", "1.5", "-y", "-2", "-z", "0.1", "-Y", str(math.pi / 2))
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot", *pose_arguments)
    await harness.graph.settle()
    assert simulator.spawned == []
    await harness.describe(ROBOT)
    (request,) = simulator.spawned
    assert (request.name, request.xml, request.reference_frame) == ("mbot", ROBOT, "")
    pose = request.initial_pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (1.5, -2.0, 0.1)
    assert (pose.orientation.z, pose.orientation.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    assert node.finished.result() == 0
    assert logged("INFO")[-1] == "Spawn status: spawned mbot"


async def test_latched_description_is_spawned(harness):
    simulator = Simulator(harness)
    await harness.describe(ROBOT)
    node = start_create(harness, "-name", "mbot", "-topic", "robot_description", "-z=0.5")
    await harness.graph.settle()
    assert (simulator.created[0].name, simulator.created[0].pose.position.z) == ("mbot", 0.5)
    assert node.finished.result() == 0


async def test_create_waits_for_world(harness, logged):
    node = start_create(harness, "-name", "mbot", "-string", ROBOT)
    await harness.clock.advance(20.0)
    assert not node.finished.done()
    assert logged("INFO")[-1] == "Waiting for a world"
    simulator = Simulator(harness)
    await harness.clock.advance(0.2)
    await harness.graph.settle()
    assert [factory.name for factory in simulator.created] == ["mbot"]
    assert node.finished.result() == 0


async def test_rejected_create_exits_with_status_1(harness, logged):
    simulator = Simulator(harness)
    simulator.refuses = True
    node = start_create(harness, "-name", "mbot", "-string", ROBOT)
    await harness.graph.settle()
    assert node.finished.result() == 1
    assert len(logged("ERROR")) == 1


async def test_only_first_description_is_spawned(harness):
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot")
    await harness.graph.settle()
    await harness.describe(ROBOT.replace("base", "other"))
    simulator = Simulator(harness)
    await harness.graph.settle()
    assert [request.xml for request in simulator.spawned] == [ROBOT]
    assert node.finished.result() == 0


async def test_spawn_entity_waits_for_service_until_timeout(harness, logged):
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot", "-timeout", "7")
    await harness.clock.advance(6.9)
    assert not node.finished.done()
    assert logged("INFO")[-1] == "Waiting for service /spawn_entity, timeout = 7"
    await harness.clock.advance(0.2)
    assert node.finished.result() == 1
    assert logged("ERROR") == ["Service /spawn_entity unavailable. Was the simulation started?"]


async def test_rejected_spawn_exits_with_status_1(harness, logged):
    simulator = Simulator(harness)
    simulator.refuses = True
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot")
    await harness.graph.settle()
    assert node.finished.result() == 1
    assert logged("ERROR") == ["Spawning 'mbot' failed: Entity already exists"]


async def test_robot_and_gazebo_namespaces_are_applied(harness):
    simulator = Simulator(harness, "/sim")
    await harness.describe(ROBOT)
    arguments = ("-topic", "/robot_description", "-entity", "a", "-gazebo_namespace", "/sim")
    start_spawn_entity(harness, *arguments, namespace="/one")
    start_spawn_entity(harness, *arguments, "-robot_namespace", "two")
    await harness.graph.settle()
    assert [request.robot_namespace for request in simulator.spawned] == ["/one", "two"]


async def test_entities_are_spawned_from_file_database_and_stdin(
    harness, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    simulator = Simulator(harness)
    model = tmp_path / "models" / "box"
    model.mkdir(parents=True)
    (model / "model.sdf").write_text("<sdf version='1.6'><model name='box'/></sdf>", encoding="utf-8")
    (tmp_path / "robot.urdf").write_text(ROBOT.replace("base", "package://p/m.dae"), encoding="utf-8")
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path / "models"))
    monkeypatch.setattr("sys.stdin", io.StringIO(ROBOT))
    start_spawn_entity(harness, "-file", str(tmp_path / "robot.urdf"), "-entity", "a", "-package_to_model")
    start_spawn_entity(harness, "-database", "box", "-entity", "b")
    start_spawn_entity(harness, "-stdin", "-entity", "c")
    start_create(harness, "-file", "model://box", "-name", "d")
    start_create(harness, "--string", ROBOT, "--name=e")
    start_create(harness, "-param", "text", "-name", "f", text=ROBOT)
    await harness.graph.settle()
    box = (model / "model.sdf").read_text(encoding="utf-8")
    sent = {request.name: request.xml for request in simulator.spawned}
    sent |= {factory.name: factory.sdf for factory in simulator.created}
    assert sent == {
        "a": ROBOT.replace("base", "model://p/m.dae"),
        "b": box,
        "c": ROBOT,
        "d": box,
        "e": ROBOT,
        "f": ROBOT,
    }


async def test_unpause_option_unpauses_physics(harness):
    simulator = Simulator(harness)
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot", "-unpause")
    await harness.graph.settle()
    assert simulator.calls == ["unpause"]
    assert node.finished.result() == 0


async def test_wait_option_waits_for_other_entity(harness):
    simulator = Simulator(harness)
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot", "-wait", "table")
    await harness.clock.advance(2.0)
    assert simulator.spawned == []
    simulator.names.append("table")
    await harness.clock.advance(1.0)
    assert len(simulator.spawned) == 1
    assert node.finished.result() == 0


async def test_bound_entity_is_deleted_with_node(harness):
    simulator = Simulator(harness)
    await harness.describe(ROBOT)
    node = start_spawn_entity(harness, "-topic", "robot_description", "-entity", "mbot", "-b")
    await harness.graph.settle()
    assert not node.finished.done()
    node.close()
    await harness.graph.settle()
    assert simulator.deleted == ["mbot"]


async def test_create_passes_allow_renaming(harness):
    simulator = Simulator(harness)
    start_create(harness, "-string", ROBOT, "-name", "a", "-allow_renaming", "true")
    start_create(harness, "-string", ROBOT, "-name", "b", "-allow_renaming", "false")
    start_create(harness, "-allow_renaming", "-string", ROBOT, "-name", "c")
    await harness.graph.settle()
    assert {factory.name: factory.allow_renaming for factory in simulator.created} == {"a": True, "b": False, "c": True}


async def test_create_accepts_parameters_and_ignores_unknown_options(harness):
    simulator = Simulator(harness)
    start_create(harness, "-wonder", "1", name="mbot", string=ROBOT, x=1.0, Y=0.0)
    await harness.graph.settle()
    assert (simulator.created[0].name, simulator.created[0].pose.position.x) == ("mbot", 1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-topic", "t"], "the following arguments are required: -entity"),
        (["-entity", "a"], "one of the arguments -file -topic -database -stdin is required"),
        (["-entity", "a", "-topic", "t", "-file", "f"], "not allowed with argument"),
        (["-entity", "a", "-topic", "t", "-x", "far"], "invalid float value: 'far'"),
        (["-entity", "a", "-topic", "t", "-wonder"], "unrecognized arguments: -wonder"),
    ],
)
def test_invalid_spawn_arguments_are_rejected(arguments, message):
    with pytest.raises(LinkwrightError) as error:
        parse_arguments(arguments)
    (finding,) = error.value.diagnostics
    assert finding.code == "NODE810"
    assert message in str(finding.message)


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["-name", "a"], "NODE812"),
        (["-string", ROBOT, "-name", "a", "-x", "far"], "NODE812"),
        (["-file", "/nowhere/a.sdf", "-name", "a"], "NODE811"),
        (["-file", "model://nothing", "-name", "a"], "NODE811"),
    ],
)
async def test_create_reports_errors(harness, arguments, code):
    with pytest.raises(LinkwrightError) as error:
        start_create(harness, *arguments)
    assert error.value.diagnostics[0].code == code


@pytest.mark.parametrize(("name", "status"), [("ground", 0), ("nothing", 1)])
async def test_remove_and_delete_entity_delete_model_and_exit(harness, name, status):
    simulator = Simulator(harness)
    remove = Remove(harness.graph, NodeOptions(parameters={"entity_name": name, "world": "any"}))
    delete = DeleteEntity(harness.graph, NodeOptions(arguments=["--name", name]))
    await harness.graph.settle()
    assert (remove.finished.result(), delete.finished.result()) == (status, status)
    assert simulator.deleted == [name, name]


async def test_set_entity_pose_moves_model_and_exits(harness):
    simulator = Simulator(harness)
    arguments = ["--name", "ground", "--pos", "-1", "2", "3", "--euler", "0", "0", str(math.pi)]
    turned = SetEntityPose(harness.graph, NodeOptions(arguments=arguments))
    set_pose = SetEntityPose(
        harness.graph, NodeOptions(arguments=["--name", "link", "--type", "2", "--quat", "1", "0", "0", "0"])
    )
    await harness.graph.settle()
    assert (turned.finished.result(), set_pose.finished.result()) == (0, 1)
    first, second = simulator.new_states
    position = first.pose.position
    assert (position.x, position.y, position.z) == (-1.0, 2.0, 3.0)
    assert first.pose.orientation.z == pytest.approx(1.0)
    assert (second.name, second.pose.orientation.x, second.pose.orientation.w) == ("link", 1.0, 0.0)


@pytest.mark.parametrize(
    ("node", "arguments"),
    [
        (Remove, []),
        (DeleteEntity, ["--id", "3"]),
        (SetEntityPose, ["--name", "a", "--pos", "1"]),
        (SetEntityPose, ["--name", "a", "--type", "5"]),
    ],
)
async def test_missing_or_invalid_arguments_are_reported(harness, node, arguments):
    with pytest.raises(LinkwrightError) as error:
        node(harness.graph, NodeOptions(arguments=arguments))
    assert error.value.diagnostics[0].code == "NODE812"
