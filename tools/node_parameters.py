"""Write the table of parameters of nodes and plugins, for the language server and reviews.

Most nodes declare their parameters in code. Each node is therefore started in a graph without a network, with each type
of plugins that it loads, and its declarations are recorded, with the descriptions of the tables that it reads.

Usage: python tools/node_parameters.py [--check]
"""

from __future__ import annotations

import asyncio
import json
import math
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from importlib import import_module
from io import StringIO
from itertools import product
from pathlib import Path
from typing import Any
from unittest import mock

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph
from linkwright.graph.parameters.node_parameters import NodeParameters
from linkwright.graph.parameters.parameter import ParameterRules, ParameterType
from linkwright.graph.parameters.store import ParameterStore
from linkwright.navigation.nodes import behavior_server, collision_zones, costmap_layers, followers, planner_server
from linkwright.nodes import parameter_tables
from linkwright.nodes.options import EXECUTABLES, NodeOptions

ROOT = Path(__file__).resolve().parent.parent
TEXTS_FILE = ROOT / "tools" / "node_parameters.toml"
TABLE_FILE = ROOT / "src" / "linkwright" / "nodes" / "node_parameters.json"

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

_FOLLOWERS = (followers.DWB, followers.MPPI, followers.PURE_PURSUIT, followers.ROTATION_SHIM)
_RECORD = re.compile(r"\{\s+([^{}]*?)\s+\}")
"""A JSON object that contains no other object; each parameter is on one line."""
_SENSOR = re.compile(r"^(odom|imu|pose|twist)\d")
_PLUGIN, _ITEM, _PART = "THE_PLUGIN", "THE_ITEM", "THE_PART"
_ROBOT = '<robot name="r"><link name="base_link"/></robot>'
_EXCLUDED_EXECUTABLES = ("cam2image", "teleop_twist_keyboard", "rmw_zenohd", "_node.py", "static_transform_publisher")
_EXCLUDED_PACKAGES = ("gazebo_ros", "ros_gz_", "ros_ign_", "audio_", "demo_nodes", "tf2_tools", "my_robot_voice")
_REQUIRED_ARGUMENTS: Mapping[str, list[str]] = {
    "cartographer_node": ["-configuration_directory", str(ROOT / "tools"), "-configuration_basename", "all_topics.lua"],
}
"""Arguments without which nodes do not start."""
_COMMON_PARAMETERS = ("use_sim_time", "qos_overrides", "start_type_description_service", "strict_callback_groups")
_REQUIRED_PARAMETERS: Mapping[str, dict[str, Any]] = {
    "ekf_node": {f"{name}{number}": "a" for name in ("odom", "imu", "pose", "twist") for number in range(2)},
    "ukf_node": {f"{name}{number}": "a" for name in ("odom", "imu", "pose", "twist") for number in range(2)},
    "lifecycle_manager": {"node_names": ["a"]},
    "robot_state_publisher": {"robot_description": _ROBOT},
    "delay": {"input_topic": "a"},
    "demux": {"output_topics": ["a"], "input_topic": "b"},
    "drop": {"input_topic": "a"},
    "mux": {"input_topics": ["a"]},
    "relay": {"input_topic": "a"},
    "throttle": {"input_topic": "a", "throttle_type": "messages"},
    "aggregator_node": {
        **{
            f"{_ITEM}.{name}": value
            for name, value in (
                ("type", "GenericAnalyzer"),
                ("path", "a"),
                ("timeout", 5.0),
                ("num_items", -1),
                ("discard_stale", False),
            )
        },
        **{
            f"{_ITEM}.{name}": ["a"]
            for name in (
                "contains",
                "startswith",
                "name",
                "expected",
                "regex",
                "find_and_remove_prefix",
                "remove_prefix",
            )
        },
    },
    "twist_mux": {
        f"{group}.{_ITEM}.{name}": value
        for group in ("topics", "locks")
        for name, value in (("topic", "a"), ("timeout", 0.5), ("priority", 1))
    },
}
"""The parameters without which a node does not start, by executable."""


def _iterate_zone_parameters() -> Iterator[dict[str, Any]]:
    """Yield the parameters of a collision monitor with one zone or sensor, for each type."""
    points = "[[0.1, 0.1], [0.1, -0.1], [-0.1, 0.0]]"
    for kind, action in product(collision_zones._ZONE_TYPES, collision_zones._ACTIONS):
        zone = {"type": kind, "action_type": action, "points": points, "radius": 0.1, "visualize": True}
        zone |= {"velocity_polygons": [_PART]} if kind == "velocity_polygon" else {}
        zone |= {f"{_PART}.points": points}
        yield {"polygons": [_ITEM], **{f"{_ITEM}.{name}": value for name, value in zone.items()}}
    for kind in ("scan", "pointcloud", "range"):
        yield {"observation_sources": [_ITEM], f"{_ITEM}.type": kind}


_VARIANTS: Mapping[str, list[dict[str, Any]]] = {"collision_monitor": [*_iterate_zone_parameters()]}
"""Several sets of parameters with which a node is started, by executable."""


def _list_layer_types() -> list[str]:
    names = ("StaticLayer", "ObstacleLayer", "VoxelLayer", "InflationLayer", "DenoiseLayer", "RangeSensorLayer")
    return [*dict.fromkeys((*costmap_layers.DEFAULT_LAYERS.values(), *(f"nav2_costmap_2d::{name}" for name in names)))]


def _iterate_plugins() -> Iterator[tuple[str, str, str, str]]:
    """Yield the executable, the node, the parameter that lists plugins, and each plugin's type."""
    for kind in _FOLLOWERS:
        yield "controller_server", "controller_server", "controller_plugins", kind
    for kind in ("SimpleGoalChecker", "StoppedGoalChecker"):
        yield "controller_server", "controller_server", "goal_checker_plugins", f"nav2_controller/{kind}"
    for kind in ("SimpleProgressChecker", "PoseProgressChecker"):
        yield "controller_server", "controller_server", "progress_checker_plugins", f"nav2_controller/{kind}"
    for kind in (planner_server._NAVFN, *planner_server._REPLACED_TYPES):  # the tables of the node
        yield "planner_server", "planner_server", "planner_plugins", kind
    for server in (behavior_server.BehaviorServer, behavior_server.RecoveriesServer):
        for kind in server.NODE.plugin_types():
            yield server.DEFAULT_NAME, server.DEFAULT_NAME, f"{server.NODE.KIND}_plugins", kind
    yield "smoother_server", "smoother_server", "smoother_plugins", "nav2_smoother/SimpleSmoother"
    yield (
        "waypoint_follower",
        "waypoint_follower",
        "waypoint_task_executor_plugin",
        "nav2_waypoint_follower/WaitAtWaypoint",
    )
    for kind in _list_layer_types():
        yield "controller_server", "local_costmap", "plugins", kind
    for kind in ("KeepoutFilter", "SpeedFilter"):
        yield "controller_server", "local_costmap", "filters", f"nav2_costmap_2d::{kind}"


Declarations = dict[str, dict[str, dict[str, Any]]]
"""The parameters by node name."""


@contextmanager
def _record_declarations(declarations: Declarations, given: Mapping[str, Any]) -> Iterator[None]:
    """Record the parameters that nodes declare; given values are not recorded as defaults."""
    start, declare, read = NodeParameters.__init__, ParameterStore.declare, parameter_tables._Reader.read
    owners: dict[int, str] = {}
    declared: list[tuple[ParameterStore, str, Any, Any]] = []
    tables: dict[tuple[str, str], parameter_tables.TableEntry] = {}

    def starting(node: Any, store: ParameterStore) -> None:
        owners[id(store)] = node.get_name()
        start(node, store)

    def declaring(store: ParameterStore, name: str, default: Any, descriptor: Any, **options: Any) -> Any:
        declared.append((store, name, default, descriptor))
        return declare(store, name, default, descriptor, **options)

    def reading(reader: Any, table: Any, prefix: str = "", defaults: Any = None) -> Any:
        for entry in parameter_tables.list_entries(table, prefix):
            tables.setdefault((reader._node.get_name(), entry.name), entry)
        return read(reader, table, prefix, defaults)

    with (
        mock.patch.object(NodeParameters, "__init__", starting),
        mock.patch.object(ParameterStore, "declare", declaring),
        mock.patch.object(parameter_tables._Reader, "read", reading),
    ):
        yield
    for store, name, default, descriptor in declared:
        owner = owners[id(store)]
        if not name.startswith(_COMMON_PARAMETERS):
            record = _make_record(default, descriptor, tables.get((owner, name)))
            if record.get("default") == _ITEM or (name in given and record.get("default") == given[name]):
                del record["default"]
            listing = [key for key, value in given.items() if value == [_ITEM]]
            known = declarations.setdefault(owner, {}).setdefault(name, record)
            if name.startswith(f"{_ITEM}.") and listing:
                known["keys"] = sorted({*known.get("keys", ()), *listing})
    # parameters of one distribution, which are not declared in the other one
    for (owner, name), entry in tables.items():
        if "*" not in name:
            declarations.setdefault(owner, {}).setdefault(name, _make_record(entry.default, None, entry))


def _make_record(default: Any, descriptor: Any, entry: parameter_tables.TableEntry | None) -> dict[str, Any]:
    """Return the type, default and description of a parameter, without unknown entries."""
    kind = default if isinstance(default, ParameterType) else ParameterType.from_parameter_value(_format_list(default))
    if kind is ParameterType.NOT_SET and descriptor is not None and descriptor.type:
        kind = ParameterType(descriptor.type)
    if entry is not None:
        kind = entry.kind
    if default == []:
        kind = ParameterType.STRING_ARRAY  # the type of an empty list is unknown
    record: dict[str, Any] = {"type": kind.name.lower().replace("not_set", "")}
    if default is not None and not isinstance(default, ParameterType):
        record["default"] = _to_json_value(default)
    description = getattr(descriptor, "description", "") or (entry.description if entry else "")
    record |= {"description": description} if description else {}
    record |= {"choices": list(entry.choices)} if entry and entry.choices else {}
    return record


def _format_list(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _to_json_value(value: Any) -> Any:
    """Return a value for JSON; infinity and NaN, which JSON lacks, become texts as in YAML."""
    if isinstance(value, (list, tuple)):
        return [_to_json_value(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return f"{'-' if value < 0 else ''}.{'nan' if math.isnan(value) else 'inf'}"
    return value


def _start_node(executable: tuple[str, str], parameters: Mapping[str, Any], others: ParameterRules) -> None:
    """Start a node, configure it, and close it, ignoring errors after the declarations."""
    options = NodeOptions(
        parameters=dict(parameters),
        parameters_of_others=others,
        arguments=_REQUIRED_ARGUMENTS.get(executable[1], []),
        output=lambda _: None,
    )
    running = None
    with suppress(LinkwrightError, OSError):
        running = EXECUTABLES[executable](Graph(), options)
        if hasattr(running.node, "trigger_configure"):
            running.node.trigger_configure()
    with suppress(Exception):
        if running is not None:
            running.close()


def _record_nodes() -> Declarations:
    declarations: Declarations = {}
    for package, executable in EXECUTABLES:
        if not executable.endswith(_EXCLUDED_EXECUTABLES) and not package.startswith(_EXCLUDED_PACKAGES):
            for parameters in _VARIANTS.get(executable) or [_REQUIRED_PARAMETERS.get(executable, {})]:
                with _record_declarations(declarations, parameters):
                    _start_node((package, executable), parameters, ParameterRules())
    return {node: _remove_plugin_parameters(declarations[node]) for node in sorted(declarations) if declarations[node]}


def _remove_plugin_parameters(parameters: Mapping[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return the parameters of a node without those of default plugins.

    A file may replace default plugins.
    """
    plugins = tuple(name.removesuffix("plugin") for name in parameters if name.endswith(".plugin"))
    return {
        name: record for name, record in parameters.items() if not name.startswith(plugins) or name.endswith(".plugin")
    }


def _iterate_plugin_tables() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the type of each plugin, the nodes and parameters that list it, and its parameters."""
    for executable, node, list_parameter, kind in _iterate_plugins():
        names: Any = _PLUGIN if list_parameter.endswith("_plugin") else [_PLUGIN]
        parameter_values = {list_parameter: names, f"{_PLUGIN}.plugin": kind}
        rules = ParameterRules()
        if node != executable:
            required = "filter_info_topic" if list_parameter == "filters" else "observation_sources"
            parameter_values[f"{_PLUGIN}.{required}"] = _ITEM
            for name, value in parameter_values.items():
                rules.set(f"/{node}/{node}", name, value)
        package = next(package for package, name in EXECUTABLES if name == executable)
        declarations: Declarations = {}
        with _record_declarations(declarations, parameter_values):
            _start_node((package, executable), {} if node != executable else parameter_values, rules)
        node_parameters = declarations[node]
        names_of_plugin = [name for name in node_parameters if name.startswith(f"{_PLUGIN}.")]
        parameters = {
            name.removeprefix(f"{_PLUGIN}.").replace(_ITEM, "*"): node_parameters[name] for name in names_of_plugin
        }
        parameters.pop("plugin", None)
        for name, record in parameters.items():
            record |= {"keys": ["observation_sources"]} if "*" in name else {}
        yield kind, {"node": node, "listed": list_parameter, "parameters": parameters}


def _add_descriptions(owner: str, parameters: dict[str, dict[str, Any]], texts: Mapping[str, Any]) -> None:
    """Add the descriptions in the file to parameters without one.

    Parameters that are only in the file are added, too.
    """
    groups = {
        "COSTMAP": owner.endswith("_costmap"),
        "ROBOT_LOCALIZATION": owner.endswith(("kf_filter_node",)),
        "LAYER": owner.startswith("nav2_costmap_2d"),
        "FOLLOWER": owner.replace("::", "/") in _FOLLOWERS,
    }
    package, _, name = owner.partition("/")
    tables = [texts.get(owner, {}), texts.get(package, {}).get(name, {})]
    written = [*tables, *([texts["FOLLOWER"]] if owner == followers.MPPI else [])]
    tables += [texts[group] for group, applies in groups.items() if applies]
    for table in written:
        parameters |= {name: entry for name, entry in table.items() if isinstance(entry, dict) and "type" in entry}
    for parameter, record in parameters.items():
        key = (
            _SENSOR.sub("SENSOR", parameter)
            if groups["ROBOT_LOCALIZATION"]
            else parameter.replace(_ITEM, "*").replace(_PART, "*")
        )
        key = "plugin" if key.endswith(".plugin") else key
        text = next((table[key] for table in [*tables, texts["any"]] if isinstance(table.get(key), str)), "")
        if text and "description" not in record:
            record["description"] = text
        choices = next((table[key] for table in tables if isinstance(table.get(key), dict)), {})
        record |= choices if "type" not in choices else {}


async def _format_table() -> str:
    texts = tomllib.loads(TEXTS_FILE.read_text(encoding="utf-8"))
    nodes = _record_nodes()
    nodes.setdefault("controller_manager", {})
    plugins = dict(_iterate_plugin_tables())
    for owner, parameters in nodes.items():
        _add_descriptions(owner, parameters, texts)
    for owner, plugin in plugins.items():
        plugin["purpose"] = texts["PLUGINS"][owner]
        _add_descriptions(owner, plugin["parameters"], texts)
    content = {"nodes": nodes, "plugins": plugins}
    text = json.dumps(content, indent=1, ensure_ascii=False).replace(_ITEM, "*").replace(_PART, "*")
    return _RECORD.sub(lambda match: "{" + " ".join(match[1].split()) + "}", text) + "\n"


def main(words: list[str]) -> int:
    """Write the table, or check it, and return the exit status."""
    with redirect_stderr(StringIO()), redirect_stdout(StringIO()):  # the logs of the nodes
        text = asyncio.run(_format_table())
    if words == ["--check"]:
        if TABLE_FILE.read_text(encoding="utf-8") == text:
            return 0
        print(f"{TABLE_FILE.relative_to(ROOT)} is stale: run `python tools/node_parameters.py`", file=sys.stderr)
        return 1
    TABLE_FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
