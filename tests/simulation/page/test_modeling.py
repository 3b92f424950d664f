"""Editing of a world in the page.

Messages of pages change the world's file and the simulation.
"""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.rviz.config.locations import recovery_folder
from tests.sdf.editing.texts import BOX_MODEL, PLAIN_WORLD
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

STRING = get_message("std_msgs/msg/String")
SERVICES = {
    "/pause_physics": "std_srvs/srv/Empty",
    "/unpause_physics": "std_srvs/srv/Empty",
    "/reset_simulation": "std_srvs/srv/Empty",
    "/load_world": "simulation_interfaces/srv/LoadWorld",
}
POSE = [1, 2, 3, 0, 0, 0.5]


class FakeSimulator:
    """The services of a simulator for an edited world; it records the requests."""

    def __init__(self, world, path: Path | None, *, loads: bool) -> None:
        self.node = world.graph.create_node("gazebo")
        if path is not None:
            self.node.declare_parameter("world", str(path))
        latched = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.description = self.node.create_publisher(STRING, "/world_description", latched)
        self.description.publish(STRING(data=PLAIN_WORLD))
        self.requests: list[tuple[str, object]] = []
        self.refusal = ""
        for name, service_type in SERVICES.items():
            if loads or name != "/load_world":
                self.node.create_service(
                    get_service(service_type),
                    name,
                    lambda request, response, name=name: self._record(name, request, response),
                )

    def _record(self, name, request, response):
        self.requests.append((name, request))
        if name == "/load_world":
            response.result.error_message = self.refusal
        return response

    async def last_loaded(self, count: int = 1):
        """Wait until the world was loaded some times, and return the last resource."""
        await eventually(lambda: self.count("/load_world") >= count)
        return self.requests[-1][1].world_resource

    def count(self, name: str) -> int:
        return [service for service, _ in self.requests].count(name)


@asynccontextmanager
async def modeling_session(path: Path | None = None, *, loads: bool = True):
    """Run a simulation of the world in a file, with a page that edits it."""
    async with open_world() as world:
        simulation = FakeSimulator(world, path, loads=loads)
        async with open_page(world.viewer) as client:
            await client.until("modeling_state", available=True)
            await client.send("set_modeling", active=True)
            client.state = await client.until("modeling_state", active=True)
            yield simulation, client, world


def write_world(tmp_path: Path, text: str = PLAIN_WORLD) -> Path:
    path = tmp_path / "my.world"
    path.write_bytes(text.encode())
    return path


def make_change(name: str, **fields) -> dict:
    return dict.fromkeys(("pose", "size", "new_name", "static", "color")) | {"name": name} | fields


async def test_modeling_is_unavailable_without_simulation():
    async with open_world() as world, open_page(world.viewer) as client:
        state = (await client.opened())["modeling_state"]
        assert (state["available"], state["active"], state["entities"]) == (False, False, [])
        await client.send("set_modeling", active=True)
        assert "there is no world to edit" in (await client.until("simulation_notice"))["text"]


async def test_modeling_pauses_and_resets_simulation(tmp_path):
    path = write_world(tmp_path)
    async with modeling_session(path) as (simulation, client, _):
        assert [name for name, _ in simulation.requests] == ["/pause_physics", "/reset_simulation"]
        assert client.state["file"] == str(path)
        assert not client.state["unsaved"]
        assert [(entity["name"], entity["kind"]) for entity in client.state["entities"]] == [
            ("ground_plane", "model"),
            ("box", "model"),
            ("lamp", "light"),
        ]
        ground, box, lamp = client.state["entities"]
        assert (ground["address"], ground["static"], ground["shape"]) == ("model://ground_plane", True, None)
        assert (box["shape"], box["size"], box["color"]) == ("box", [0.5, 0.5, 0.5], [0.9, 0.4, 0.1, 1])
        assert (box["pose"], box["parts"], lamp["color"]) == ([2, 0, 0.25, 0, 0, 0], [], [1, 1, 1, 1])
        await client.send("set_modeling", active=False)
        await client.until("modeling_state", active=False)
        assert simulation.requests[-1][0] == "/unpause_physics"


async def test_changes_are_loaded_undone_and_saved(tmp_path):
    path = write_world(tmp_path)
    path.chmod(0o640)
    async with modeling_session(path) as (simulation, client, _):
        await client.send("change_entities", changes=[make_change("box", pose=[3, 0, 0.25, 0, 0, 0])])
        state = await client.until("modeling_state", unsaved=True)
        assert (state["can_undo"], state["can_redo"]) == (True, False)
        resource = await simulation.last_loaded()
        assert (resource.uri, resource.resource_string) == (str(path), PLAIN_WORLD.replace(">2 0 0.250", ">3 0 0.250"))
        assert path.read_text() == PLAIN_WORLD
        await client.send("undo_world")
        assert (await client.until("modeling_state", can_redo=True))["unsaved"] is False
        assert (await simulation.last_loaded(2)).resource_string == PLAIN_WORLD
        await client.send("redo_world")
        await client.until("modeling_state", can_redo=False, unsaved=True)
        await client.send("save_world", path=None)
        await client.until("modeling_state", unsaved=False, can_undo=True)
        assert path.read_text() == PLAIN_WORLD.replace(">2 0 0.250", ">3 0 0.250")
        assert path.stat().st_mode & 0o777 == 0o640


async def test_modeling_messages_edit_entities(tmp_path):
    async with modeling_session(write_world(tmp_path)) as (_, client, _):

        async def names(service_type: str, **fields) -> list[str]:
            await client.send(service_type, **fields)
            return [entity["name"] for entity in (await client.until("modeling_state"))["entities"]]

        for shape in ("box", "cylinder", "sphere", "wall", "ramp"):
            assert shape in (await names("add_entity", shape=shape, address="", pose=POSE, size=[]))[-1]
        for light in ("point_light", "directional_light", "spot_light"):
            await names("add_entity", shape=light, address="", pose=POSE, size=[])
        entity_names = await names("add_entity", shape="model", address="model://sun", pose=POSE, size=[])
        assert entity_names == [
            *("ground_plane", "box", "lamp", "box_2", "cylinder", "sphere", "wall", "ramp"),
            *("point_light", "directional_light", "spot_light", "sun"),
        ]
        assert (await names("copy_entities", names=["wall"], offset=[0, 1, 0]))[7] == "wall_2"
        assert "pile" in await names("group_entities", names=["box", "box_2"], name="pile")
        assert "box_2" not in await names("delete_entities", names=["sun", "lamp"])
        assert "box_2" in await names("ungroup_entity", name="pile")
        changes = [
            make_change("wall", size=[1, 2, 3], color=[0, 0, 1, 1]),
            make_change("ramp", new_name="slope", static=False),
        ]
        await client.send("change_entities", changes=changes)
        entities = {entity["name"]: entity for entity in (await client.until("modeling_state"))["entities"]}
        assert (entities["wall"]["size"], entities["wall"]["color"]) == ([1, 2, 3], [0, 0, 1, 1])
        assert (entities["slope"]["shape"], entities["slope"]["static"]) == ("ramp", False)
        await client.send("request_models")
        model_choices = (await client.until("model_choices"))["models"]
        assert {"name": "sun", "address": "model://sun"} in model_choices


async def test_new_entity_gets_unused_name(tmp_path):
    async with modeling_session(write_world(tmp_path, PLAIN_WORLD.replace(BOX_MODEL, ""))) as (_, client, _):
        assert [entity["name"] for entity in client.state["entities"]] == ["ground_plane", "lamp"]
        await client.send("add_entity", shape="box", address="", pose=POSE, size=[])
        assert (await client.until("modeling_state", unsaved=True))["entities"][-1]["name"] == "box_2"


async def test_pages_share_edited_world(tmp_path):
    async with modeling_session(write_world(tmp_path)) as (_, client, world), open_page(world.viewer) as other:
        assert (await other.opened())["modeling_state"]["active"] is True
        await client.send("delete_entities", names=["box"])
        assert len((await other.until("modeling_state", unsaved=True))["entities"]) == 2
        await other.send("undo_world")
        assert len((await client.until("modeling_state", can_redo=True))["entities"]) == 3


async def test_failed_edit_is_reported_to_page(tmp_path):
    async with modeling_session(write_world(tmp_path)) as (simulation, client, _):
        await client.send("delete_entities", names=["nobody"])
        assert (await client.until("simulation_notice"))[
            "text"
        ] == "there is no model or light 'nobody' in the world's file"
        simulation.refusal = "too many links"
        await client.send("delete_entities", names=["box"])
        assert (await client.until("simulation_notice"))["text"] == "too many links"
        await client.send("save_world", path="notes.txt")
        assert "it must end in .world or .sdf" in (await client.until("simulation_notice"))["text"]


async def test_missing_load_world_service_is_reported(tmp_path):
    async with modeling_session(write_world(tmp_path), loads=False) as (_, client, _):
        await client.send("delete_entities", names=["box"])
        assert (await client.until("simulation_notice"))["text"] == "there is no service '/load_world'"


async def test_world_without_file_is_saved_to_new_file(tmp_path):
    async with modeling_session() as (simulation, client, _):
        assert client.state["file"] is None
        await client.send("delete_entities", names=["box"])
        assert (await simulation.last_loaded()).resource_string == PLAIN_WORLD.replace(BOX_MODEL, "")
        await client.send("save_world", path=None)
        assert "no file yet" in (await client.until("simulation_notice"))["text"]
        path = tmp_path / "new.world"
        await client.send("save_world", path=str(path))
        assert (await client.until("modeling_state", file=str(path)))["unsaved"] is False
        assert path.read_text() == PLAIN_WORLD.replace(BOX_MODEL, "")


@pytest.mark.parametrize("text", [None, PLAIN_WORLD.replace('name="w"', 'name="other"'), "<sdf"])
async def test_missing_or_different_world_file_is_ignored(tmp_path, text):
    path = tmp_path / "none.world" if text is None else write_world(tmp_path, text)
    async with modeling_session(path) as (_, client, _):
        assert client.state["file"] is None
        assert len(client.state["entities"]) == 3


async def test_externally_changed_file_is_reloaded_or_not_overwritten(tmp_path):
    path = write_world(tmp_path)
    async with modeling_session(path) as (_, client, _):
        path.write_text(PLAIN_WORLD.replace("'box'", "'crate'"))
        await client.send("delete_entities", names=["crate"])
        assert len((await client.until("modeling_state"))["entities"]) == 2
        path.write_text(PLAIN_WORLD)
        await client.send("save_world", path=None)
        assert "was changed by another program" in (await client.until("simulation_notice"))["text"]
        assert path.read_text() == PLAIN_WORLD
        await client.send("save_world", path="other.world")
        assert (await client.until("modeling_state"))["file"] == str(tmp_path / "other.world")


async def test_unsaved_changes_are_kept_at_exit(tmp_path):
    path = write_world(tmp_path)
    async with modeling_session(path) as (_, client, world):
        assert world.viewer.keep_unsaved() == []
        await client.send("delete_entities", names=["box"])
        await client.until("modeling_state", unsaved=True)
        (notice,) = world.viewer.keep_unsaved()
    assert (notice.code, path.read_text()) == ("RVIZ301", PLAIN_WORLD)
    files = list(recovery_folder().glob("my-*.world"))
    assert [file.read_text() for file in files if str(file) in notice.message] == [PLAIN_WORLD.replace(BOX_MODEL, "")]
