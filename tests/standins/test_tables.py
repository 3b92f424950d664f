"""The modules that tables of names describe.

They have exactly those names, and behave like Python's own modules.
"""

from __future__ import annotations

import importlib
import importlib.resources
import inspect
import pickle
import pkgutil
from unittest import mock

import pytest

from linkwright.standins import modules, table

MODULES = {name: module for package in table.list_packages() for name, module in table.read(package).items()}
NAMES = {package: {name for module in table.read(package).values() for name in module.names}
         for package in table.list_packages()}  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
def test_table_names_can_be_imported(name):
    module = importlib.import_module(name)
    for attribute in [*MODULES[name].names, *MODULES[name].submodules]:
        assert hasattr(module, attribute), f"from {name} import {attribute}"


@pytest.mark.parametrize("name", [name for name, module in MODULES.items() if not module.others])
def test_names_missing_from_table_are_not_exported(name):
    module = importlib.import_module(name)
    described = MODULES[name]
    missing_names = NAMES[name.partition(".")[0]] - described.names.keys() - set(described.submodules)
    for attribute in {*missing_names, *described.absent, "NoSuchName"}:
        assert not hasattr(module, attribute), f"from {name} import {attribute}"


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("rclpy.qos", "Node"),
        ("rclpy", "Node"),
        ("rclpy.time", "QoSProfile"),
        ("launch", "ForLoop"),
        ("launch.launch_introspector", "Node"),
        ("launch_ros.actions", "LaunchConfiguration"),
        ("tf2_ros", "PoseArray"),
    ],
)
def test_names_that_ros_does_not_export_cannot_be_imported(module, name):
    with pytest.raises(ImportError, match=f"cannot import name '{name}' from '{module}'"):
        exec(f"from {module} import {name}", {})


def test_origins_are_names_of_other_tables():
    """Otherwise an import in another table's module could hide a mistake in a table."""
    for name, module in MODULES.items():
        for attribute, origin in module.names.items():
            other = MODULES.get(origin.origin)
            if other is not None and origin.origin != name:
                assert origin.name in other.names or origin.name in other.submodules, f"{name}: {attribute}"


class TestModules:
    def test_pkgutil_lists_submodules(self):
        import launch.events

        import launch

        submodules = {iter_module.name: iter_module.ispkg for iter_module in pkgutil.iter_modules(launch.__path__)}
        assert submodules["actions"] is True
        assert submodules["launch_service"] is False
        walked = [walk_package.name for walk_package in pkgutil.walk_packages(launch.__path__, "launch.")]
        assert {"launch.actions.timer_action", "launch.events.process.process_exited"} <= set(walked)
        assert {"launch", "rclpy"} <= {iter_module.name for iter_module in pkgutil.iter_modules([modules.FOLDER])}

    def test_names_are_cached_and_can_be_patched(self):
        import rclpy.qos

        with mock.patch("rclpy.qos.QoSProfile") as replaced:
            assert rclpy.qos.QoSProfile is replaced
        from linkwright.graph.qos.profile import QoSProfile

        assert rclpy.qos.QoSProfile is QoSProfile

    def test_dir_and_star_import_list_names(self):
        import launch.conditions

        assert {"IfCondition", "if_condition", "__path__"} <= set(dir(launch.conditions))
        exported = {}
        exec("from launch.conditions import *", exported)
        assert "IfCondition" in exported
        assert "if_condition" not in exported

    def test_classes_can_be_pickled_and_inspected(self):
        from rclpy.time import Time
        from tf2_ros import Buffer

        assert pickle.loads(pickle.dumps(Time(nanoseconds=5))) == Time(nanoseconds=5)
        assert "class Buffer" in inspect.getsource(Buffer)

    def test_package_has_file_and_resources(self):
        import launch

        assert launch.__file__.endswith("launch.txt")
        assert launch.__spec__.submodule_search_locations
        assert importlib.resources.files("launch") is not None

    def test_modules_can_be_reloaded(self):
        import launch.conditions

        assert importlib.reload(launch.conditions) is launch.conditions
        assert launch.conditions.IfCondition


class TestReading:
    def test_table_is_parsed(self):
        read = table.parse(
            "# Words.\n"
            "[one]\n"
            "here: A B=C\n"
            "    D\n"
            "here since iron: E\n"
            "import: os\n"
            "value F: ('x', 1)\n"
            "absent G: why | 为什么\n"
            "differs A: how | 如何\n"
            "setup: here.begin\n"
            "[one.two] since jazzy\n"
        )
        module = read["one"]
        assert module.names == {
            "A": table.Name("here", "A"),
            "B": table.Name("here", "C"),
            "D": table.Name("here", "D"),
            "E": table.Name("here", "E", "iron"),
            "os": table.Name("import", "os"),
            "F": table.Name("value", "('x', 1)"),
        }
        assert module.absent == {"G": table.Remark("why", "为什么")}
        assert module.differs == {"A": table.Remark("how", "如何")}
        assert (module.setup, module.submodules, read["one.two"].since) == ("here.begin", ["two"], "jazzy")
        assert modules.resolve_name(module, "F") == ("x", 1)

    @pytest.mark.parametrize("text", ["[one]\nno line\n", "here: A\n"])
    def test_malformed_line_is_rejected(self, text):
        with pytest.raises(ValueError, match="not a line of a table"):
            table.parse(text)
