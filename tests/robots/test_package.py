"""The files of the package: manifest, setup.py, launch files and RViz configuration."""

from __future__ import annotations

import ast
import warnings
from typing import Any

import pytest
import yaml
from catkin_pkg.package import Package, parse_package

from tests.places import PACKAGE, PUBLISHED
from tests.robots.test_models import TUTORIAL

LAUNCH_FILES = {
    "display.launch.py": {"gui": "false", "model": "mbot_base.urdf", "rvizconfig": "urdf.rviz"},
    "display_xacro.launch.py": {"gui": "true", "model": "mbot_base.xacro", "rvizconfig": "urdf.rviz"},
}


@pytest.fixture(scope="module")
def manifest() -> Package:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # catkin_pkg's own deprecations
        return parse_package(str(PACKAGE))


@pytest.fixture(scope="module")
def rviz() -> dict[str, Any]:
    return yaml.safe_load((PACKAGE / "rviz" / "urdf.rviz").read_text(encoding="utf-8"))


def test_manifest_is_valid(manifest: Package) -> None:
    advice: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        manifest.validate(warnings=advice)
    assert advice == []
    assert manifest.name == PACKAGE.name
    assert manifest.package_format == 3
    assert manifest.get_build_type() == "ament_python"


def test_manifest_declares_launch_file_dependencies(manifest: Package) -> None:
    declared = {dependency.name for dependency in manifest.exec_depends}
    for name in LAUNCH_FILES:
        tree = ast.parse((PACKAGE / "launch" / name).read_text(encoding="utf-8"))
        imported = {
            node.module.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module
        }
        assert imported | set(_find_node_words(tree, "package")) <= declared


def test_setup_py_matches_manifest(manifest: Package) -> None:
    tree = ast.parse((PACKAGE / "setup.py").read_text(encoding="utf-8"))
    (call,) = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and _called_name(node) == "setup"]
    values = {word.arg: word.value for word in call.keywords}
    assert ast.literal_eval(values["version"]) == manifest.version
    assert [ast.literal_eval(values["license"])] == list(manifest.licenses)
    assert ast.literal_eval(values["maintainer"]) == manifest.maintainers[0].name
    assert ast.literal_eval(values["maintainer_email"]) == manifest.maintainers[0].email


@pytest.mark.parametrize("name", LAUNCH_FILES)
def test_launch_files_declare_expected_arguments(name: str) -> None:
    tree = ast.parse((PACKAGE / "launch" / name).read_text(encoding="utf-8"))
    declared = [
        node for node in ast.walk(tree) if isinstance(node, ast.Call) and _called_name(node) == "DeclareLaunchArgument"
    ]
    defaults = {}
    for call in declared:
        values = {word.arg: word.value for word in call.keywords}
        # The last string constant of the default: the value, or the file name at the end of a path.
        strings = [node.value for node in ast.walk(values["default_value"]) if isinstance(node, ast.Constant)]
        defaults[ast.literal_eval(call.args[0])] = next(text for text in strings if text not in ("urdf", "rviz"))
        if ast.literal_eval(call.args[0]) == "gui":
            assert ast.literal_eval(values["choices"]) == ["true", "false"]
    assert defaults == LAUNCH_FILES[name]


@pytest.mark.parametrize("name", LAUNCH_FILES)
def test_launch_files_start_expected_nodes(name: str) -> None:
    tree = ast.parse((PACKAGE / "launch" / name).read_text(encoding="utf-8"))
    started = {"joint_state_publisher", "joint_state_publisher_gui", "robot_state_publisher", "rviz2"}
    assert set(_find_node_words(tree, "executable")) == started


def test_rviz_configuration_has_expected_displays(rviz: dict[str, Any]) -> None:
    manager = rviz["Visualization Manager"]
    displays = {display["Name"]: display for display in manager["Displays"]}
    assert list(displays) == ["Grid", "RobotModel", "TF"]
    assert all(display["Enabled"] and display["Value"] for display in displays.values())
    assert displays["RobotModel"]["Alpha"] == 0.8
    assert displays["RobotModel"]["Description Topic"]["Value"] == "/robot_description"
    view = manager["Views"]["Current"]
    assert (view["Distance"], view["Pitch"], view["Yaw"]) == (1.7, 0.33, 5.5)
    assert manager["Global Options"]["Fixed Frame"] == "base_link"


def test_rviz_configuration_contains_tutorial_values(rviz: dict[str, Any]) -> None:
    _assert_within(TUTORIAL["rviz"], rviz, "")


@pytest.mark.skipif(not PUBLISHED.is_dir(), reason="the published files of the tutorial are missing")
def test_tutorial_values_match_published_file() -> None:
    assert yaml.safe_load((PUBLISHED / "rviz" / "urdf.rviz").read_text(encoding="utf-8")) == TUTORIAL["rviz"]


def _assert_within(part: Any, other_items: Any, place: str) -> None:
    if isinstance(part, dict):
        for key, value in part.items():
            assert key in other_items, f"{place}/{key}"
            _assert_within(value, other_items[key], f"{place}/{key}")
    elif isinstance(part, list):
        for item in part:
            candidates = [other for other in other_items if other.get("Class") == item.get("Class")]
            assert candidates, f"{place}/{item.get('Class')}"
            _assert_within(item, candidates[0], f"{place}/{item.get('Class')}")
    else:
        assert other_items == part, place


def _called_name(call: ast.Call) -> str:
    return call.func.id if isinstance(call.func, ast.Name) else ""


def _find_node_words(tree: ast.AST, word: str) -> list[str]:
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and _called_name(node) == "Node"]
    return [ast.literal_eval(keyword.value) for call in calls for keyword in call.keywords if keyword.arg == word]
