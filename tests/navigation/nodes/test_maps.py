"""map_server, map_saver_cli and map_saver_server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.graph import LATCHED_QOS, Graph, JumpClock, LogLevel, LogRecord
from linkwright.messages import Time, get_message, get_service
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import occupancy_message
from linkwright.navigation.maps.map_files import MapSaveSettings, load_map, save_map
from linkwright.navigation.nodes.map_saver import MapSaver, MapSaverServer
from linkwright.navigation.nodes.map_server import MapServer
from linkwright.nodes import NodeOptions
from tests.waiting import eventually

_GRID = get_message("nav_msgs/msg/OccupancyGrid")
_CELLS = np.array([[0, 100, -1], [0, 0, 100]], np.int8)


def _write_map_files(folder: Path, name: str = "house", cells: np.ndarray[Any, Any] = _CELLS) -> str:
    grid = Grid(cells=cells, resolution=0.05, x=-1.0)
    return str(save_map(grid, MapSaveSettings(name=str(folder / name), free_thresh=0.196))[1])


async def _call_service(graph: Graph, kind: str, service: str, **fields: object) -> Any:
    node = graph.create_node("asks")
    service_type = get_service(kind)
    future = node.create_client(service_type, service).call_async(service_type.Request(**fields))
    await eventually(future.done)
    node.destroy_node()
    return future.result()


def _logged_errors(log: list[LogRecord]) -> list[str]:
    return [record.text for record in log if record.level >= LogLevel.ERROR]


async def test_active_map_server_latches_map(graph: Graph, tmp_path: Path) -> None:
    server = MapServer(
        graph, NodeOptions(parameters={"yaml_filename": _write_map_files(tmp_path), "frame_id": "world"})
    )
    node: Any = server.node
    node.trigger_configure()
    inactive_answer = await _call_service(graph, "nav_msgs/srv/GetMap", "/map_server/map")
    assert inactive_answer.map.info.width == 0
    node.trigger_activate()
    maps: list[Any] = []
    graph.create_node("test_node").create_subscription(_GRID, "/map", maps.append, LATCHED_QOS)
    await graph.settle()
    assert list(maps[0].data) == _CELLS.ravel().tolist()
    assert (maps[0].header.frame_id, maps[0].info.origin.position.x) == ("world", -1.0)
    active_answer = await _call_service(graph, "nav_msgs/srv/GetMap", "/map_server/map")
    assert list(active_answer.map.data) == _CELLS.ravel().tolist()
    server.close()


async def test_load_map_service_replaces_map(graph: Graph, log: list[LogRecord], tmp_path: Path) -> None:
    parameters = {"yaml_filename": _write_map_files(tmp_path), "topic_name": "floor", "autostart_node": True}
    server = MapServer(graph, NodeOptions(parameters=parameters))
    maps: list[Any] = []
    graph.create_node("test_node").create_subscription(_GRID, "/floor", maps.append, LATCHED_QOS)
    other_file = _write_map_files(tmp_path, "other", _CELLS.T)

    async def load(url: str) -> Any:
        return await _call_service(graph, "nav2_msgs/srv/LoadMap", "/map_server/load_map", map_url=url)

    response = await load(other_file)
    assert (response.result, response.map.info.width) == (0, 2)
    assert [grid.info.width for grid in maps] == [3, 2]
    invalid_file = tmp_path / "broken.yaml"
    invalid_file.write_text("image: other.pgm\n")
    (tmp_path / "other.pgm").write_bytes(b"P5 1")
    assert [(await load(url)).result for url in ("", str(invalid_file), other_file)] == [1, 3, 2]
    assert [text.split("]")[0] for text in _logged_errors(log)] == ["error[NAV201", "error[NAV202", "error[NAV203"]
    assert f"{invalid_file}:1:1" in _logged_errors(log)[1]
    assert len(maps) == 2
    server.close()


async def test_map_server_starts_without_file_but_not_with_missing_file(graph: Graph, log: list[LogRecord]) -> None:
    server = MapServer(graph, NodeOptions(parameters={"autostart_node": True}))
    node: Any = server.node
    assert node.is_active
    server.close()
    server = MapServer(graph, NodeOptions(parameters={"autostart_node": True, "yaml_filename": "/no/house.yaml"}))
    node = server.node
    assert node.lifecycle_state.label == "unconfigured"
    assert "map file '/no/house.yaml' does not exist" in _logged_errors(log)[0]
    server.close()


def _publish_map(graph: Graph, topic: str = "/map") -> None:
    node = graph.create_node("mapper")
    node.create_publisher(_GRID, topic, LATCHED_QOS).publish(
        occupancy_message(Grid(cells=_CELLS, resolution=0.05), "map", Time())
    )


async def _save_map(graph: Graph, *words: str) -> int:
    saver = MapSaver(graph, NodeOptions(arguments=list(words)))
    await graph.settle()
    status = await saver.finished
    saver.close()
    return status


async def test_map_saver_saves_map_of_topic(graph: Graph, log: list[LogRecord], tmp_path: Path) -> None:
    _publish_map(graph, "/floor")
    words = ("-t", "floor", "-f", str(tmp_path / "a"), "--occ", "0.65", "--free", "0.196", "--mode", "trinary")
    assert await _save_map(graph, *words, "--ros-args", "-p", "save_map_timeout:=5.0") == 0
    assert load_map(tmp_path / "a.yaml").cells.tolist() == _CELLS.tolist()
    assert [record.text for record in log if record.level is LogLevel.INFO][-1] == "Map saved successfully"


async def test_map_saver_fails_after_timeout_without_map(
    graph: Graph, clock: JumpClock, log: list[LogRecord], tmp_path: Path
) -> None:
    saver = MapSaver(graph, NodeOptions(arguments=["-f", str(tmp_path / "a")]))
    await clock.advance(1.9)
    assert not saver.finished.done()
    await clock.advance(0.2)
    assert await saver.finished == 1
    assert "no map arrived within 2 s; no node publishes on '/map'" in _logged_errors(log)[0]
    saver.close()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--what"], "Wrong argument: --what"),
        (["-f"], "Wrong argument: -f should be followed by a value."),
        (["--occ", "much"], "Wrong argument: --occ should be followed by a number, not 'much'"),
    ],
)
async def test_map_saver_rejects_unknown_arguments(
    graph: Graph, log: list[LogRecord], words: list[str], text: str
) -> None:
    assert await _save_map(graph, *words) == 255
    assert _logged_errors(log) == [text]


async def test_map_saver_help_is_printed(graph: Graph) -> None:
    lines: list[str] = []
    saver = MapSaver(graph, NodeOptions(arguments=["--help"], output=lines.append))
    assert await saver.finished == 0
    assert "--mode trinary(default)/scale/raw" in lines[0]
    saver.close()


async def test_map_saver_fails_if_file_is_not_writable(graph: Graph, log: list[LogRecord], tmp_path: Path) -> None:
    _publish_map(graph)
    assert await _save_map(graph, "-f", str(tmp_path / "no" / "a")) == 1
    assert _logged_errors(log)[0].startswith("Failed to save the map: error[NAV206]")


async def test_save_map_service_saves_map(graph: Graph, tmp_path: Path) -> None:
    _publish_map(graph)
    server = MapSaverServer(graph, NodeOptions(parameters={"autostart_node": True}))
    response = await _call_service(
        graph,
        "nav2_msgs/srv/SaveMap",
        "/map_saver/save_map",
        map_topic="map",
        map_url=str(tmp_path / "a"),
        image_format="png",
        map_mode="trinary",
        free_thresh=float(np.float32(0.196)),
    )
    assert response.result
    assert "free_thresh: 0.196" in (tmp_path / "a.yaml").read_text()
    assert load_map(tmp_path / "a.yaml").cells.tolist() == _CELLS.tolist()
    server.close()
