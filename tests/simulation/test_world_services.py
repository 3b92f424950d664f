"""The services of gz below /world/NAME."""

from __future__ import annotations

import re

import pytest

from linkwright.graph import LogLevel
from linkwright.messages import get_message
from linkwright.simulation.description_files import read_model_file
from linkwright.simulation.gz_services import CREATE
from linkwright.simulation.nodes.gz_requests import create_request
from tests.simulation.test_server import URDF, simulator
from tests.simulation.worlds import box, finder

PACKAGE = "ros_gz_interfaces"


def make(type_name: str, /, **fields):
    """Return a message of ros_gz_interfaces."""
    return get_message(f"{PACKAGE}/msg/{type_name}")(**fields)


def pose_at(x: float, z: float):
    """Return a pose message without a rotation."""
    pose = get_message("geometry_msgs/msg/Pose")()
    pose.position.x, pose.position.z = x, z
    return pose


def models(session):
    """Return the models of the world."""
    return session.simulator.server.simulation.scene.models


def errors(session) -> list[str]:
    """Return the errors in the log."""
    return [record.text for record in session.log if record.level is LogLevel.ERROR]


async def create(session, **fields) -> bool:
    factory = make("EntityFactory", **fields)
    response = await session.call(f"{PACKAGE}/srv/SpawnEntity", "/world/test/create", entity_factory=factory)
    return response.success


async def control(session, **fields) -> bool:
    request = make("WorldControl", **fields)
    response = await session.call(f"{PACKAGE}/srv/ControlWorld", "/world/test/control", world_control=request)
    return response.success


SDF = (
    '<sdf version="1.7"><model name="ball"><pose>0 0 7 0 0 0</pose><link name="link"><collision name="c"><geometry>'
    "<sphere><radius>0.1</radius></sphere></geometry></collision></link></model></sdf>"
)


async def test_models_are_created_and_removed(tmp_path):
    path = tmp_path / "crate.urdf"
    path.write_text(URDF, encoding="utf-8")
    async with simulator(tmp_path) as session:
        assert await create(session, name="one", sdf_filename=str(path), pose=pose_at(2.0, 3.0))
        assert session.simulator.server.simulation.model_pose("one")[:3] == pytest.approx((2.0, 0.0, 3.0))
        assert not await create(session, name="one", sdf=URDF)
        assert await create(session, name="one", sdf=URDF, allow_renaming=True, pose=pose_at(5.0, 3.0))
        assert "one_0" in models(session)
        entity = make("Entity", name="one")
        response = await session.call(f"{PACKAGE}/srv/DeleteEntity", "/world/test/remove", entity=entity)
        assert response.success
        assert "one" not in models(session)
        assert errors(session) == ["/world/test/create: a model 'one' already exists"]


async def test_pose_of_request_replaces_pose_of_model(tmp_path):
    async with simulator(tmp_path) as session:
        assert await create(session, sdf=SDF, pose=pose_at(2.0, 3.0))
        assert session.simulator.server.simulation.model_pose("ball")[:3] == pytest.approx((2.0, 0.0, 3.0))
        assert await create(session, name="second", sdf=SDF, pose=pose_at(0.0, 0.0))
        on_ground = (0.0, 0.0, 0.1)  # raised by the radius
        assert session.simulator.server.simulation.model_pose("second")[:3] == pytest.approx(on_ground)


async def test_included_model_is_created(tmp_path):
    path = tmp_path / "ball.sdf"
    path.write_text(SDF, encoding="utf-8")
    include = (
        '<sdf version="1.9"><include><uri>{uri}</uri><name>toy</name><pose>1 0 2 0 0 0</pose>'
        "<static>true</static></include></sdf>"
    )
    async with simulator(tmp_path) as session:
        assert await create(session, name="one", sdf=include.format(uri=path.as_uri()), pose=pose_at(2.0, 3.0))
        assert session.simulator.server.simulation.model_pose("one")[:3] == pytest.approx((2.0, 0.0, 3.0))
        request = create_request(CREATE, f'sdf: "{include.format(uri=path.as_uri())}"'.replace('="1.9"', "='1.9'"))
        await session.call(CREATE.ros_type, "/world/test/create", entity_factory=request.entity_factory)
        assert session.simulator.server.simulation.model_pose("toy")[:3] == pytest.approx((1.0, 0.0, 2.0))
        assert models(session)["toy"].model.static
        assert not await create(session, name="two", sdf=include.format(uri="model://missing_ball"))
        assert len(errors(session)) == 1
        assert "'model://missing_ball' is left out" in errors(session)[0]


async def test_request_of_gz_without_pose_keeps_pose_of_model(tmp_path):
    description = SDF.replace('"', "'")
    async with simulator(tmp_path) as session:
        request = create_request(CREATE, f'sdf: "{description}"')
        await session.call(CREATE.ros_type, "/world/test/create", entity_factory=request.entity_factory)
        assert session.simulator.server.simulation.model_pose("ball")[:3] == pytest.approx((0.0, 0.0, 7.0))
        request = create_request(CREATE, f'name: "second" sdf: "{description}" pose: {{position: {{x: 2 z: 3}}}}')
        await session.call(CREATE.ros_type, "/world/test/create", entity_factory=request.entity_factory)
        assert session.simulator.server.simulation.model_pose("second")[:3] == pytest.approx((2.0, 0.0, 3.0))


def test_relative_paths_in_file_are_relative_to_it(tmp_path):
    folder = tmp_path / "models & more" / "wheel"
    (folder / "meshes").mkdir(parents=True)
    mesh = folder / "meshes" / "wheel.stl"
    mesh.write_text("solid a\nendsolid a\n", encoding="utf-8")
    (folder / "model.sdf").write_text(
        '<sdf version="1.7"><model name="wheel"><link name="link"><visual name="v"><geometry><mesh><uri>\n'
        "meshes/wheel.stl </uri></mesh></geometry></visual><visual name='w'><geometry><mesh><uri>meshes/other.stl</uri>"
        "</mesh></geometry></visual></link></model></sdf>",
        encoding="utf-8",
    )
    text = read_model_file(str(folder / "model.sdf"), finder())
    assert [element.strip() for element in re.findall("<uri>([^<]*)</uri>", text)] == [
        str(mesh).replace("&", "&amp;"),
        "meshes/other.stl",
    ]


async def test_model_is_moved(tmp_path):
    async with simulator(tmp_path, box("crate", "0 0 5 0 0 0")) as session:
        service = (f"{PACKAGE}/srv/SetEntityPose", "/world/test/set_pose")
        entity = make("Entity", name="crate")
        assert (await session.call(*service, entity=entity, pose=pose_at(1.0, 4.0))).success
        assert session.simulator.server.simulation.model_pose("crate")[:3] == pytest.approx((1.0, 0.0, 4.0))
        assert not (await session.call(*service, entity=make("Entity", name="crata"), pose=pose_at(1.0, 4.0))).success
        assert not (await session.call(*service, entity=make("Entity", id=3), pose=pose_at(1.0, 4.0))).success
        assert errors(session) == [
            "/world/test/set_pose: there is no model or link 'crata' (did you mean 'crate'?)",
            "/world/test/set_pose: the request does not name a model (set its 'name'; models have no numeric IDs)",
        ]


async def test_paused_simulation_makes_steps_and_is_reset(tmp_path):
    async with simulator(tmp_path) as session:
        simulation = session.simulator.server.simulation
        assert await control(session, pause=True, multi_step=5)
        assert simulation.time == 5 * simulation.step
        assert await control(session, pause=True, step=True)
        assert simulation.time == 6 * simulation.step
        assert await control(session, pause=True, reset=make("WorldReset", all=True))
        assert simulation.time == 0
        assert await control(session)
        assert not session.simulator.runner.is_paused
        assert await control(session, pause=True)
        assert session.simulator.runner.is_paused
        assert not await control(session, pause=True, seed=3)
        assert errors(session) == ["/world/test/control: 'seed' is not supported"]


async def test_services_follow_name_of_loaded_world(tmp_path):
    async with simulator(tmp_path) as session:
        other = tmp_path / "other.world"
        other.write_text('<sdf version="1.7"><world name="my-world"/></sdf>', encoding="utf-8")
        resource = get_message("simulation_interfaces/msg/Resource")(uri=str(other))
        response = await session.call("simulation_interfaces/srv/LoadWorld", "/load_world", world_resource=resource)
        assert response.result.result == 1
        names = {name for name, _ in session.node.get_service_names_and_types()}
        assert "/world/my_world/control" in names
        assert not {name for name in names if name.startswith("/world/test/")}
