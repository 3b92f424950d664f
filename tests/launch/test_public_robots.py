"""Undocumented constructs in the launch files of public robots.

The documentation of launch and launch_ros does not mention them.
"""

from __future__ import annotations

import importlib
import os
import shutil
import sys
import warnings
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

from linkwright.diagnostics import LinkwrightError, package_hint
from linkwright.launch.arguments import format_arguments
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.packages import PackageFinder, use_finder
from linkwright.shell.programs import PROGRAMS, append_programs_to_path, set_ros_variables

MANIFEST = "<package format='3'><name>{}</name><version>1.0.0</version></package>"
HEAD = """\
import os
import launch
import launch_ros
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import *
"""


@pytest.fixture
def write_bot_file(write: Any) -> Any:
    """Write a launch file of package ``bot``."""
    write("src/bot/package.xml", MANIFEST.format("bot"))

    def write_launch_file(text: str, name: str = "a.launch.py", head: str = HEAD) -> Path:
        body = dedent(text)
        return write(f"src/bot/launch/{name}", head + body if name.endswith(".py") else body)

    return write_launch_file


@pytest.fixture
def launch_messages(launch: Any, tmp_path: Path) -> Any:
    """Return the messages of the LogInfo actions in a launch file."""

    async def run(path: Path, **configurations: str) -> list[str]:
        finder = PackageFinder(start=tmp_path, environment={})
        with use_finder(finder):
            result = await launch(load_launch_file(path), finder=finder, **configurations)
        assert result.succeeded, result.err
        return result.messages

    return run


@pytest.fixture(autouse=True)
def _isolated_modules() -> Any:
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in ("bot", "bot_tools", "bot_parts", "shared_parts"):
            del sys.modules[name]
    importlib.invalidate_caches()


class TestWorkspaceModules:
    USES = """
    from {module} import greet
    def generate_launch_description():
        return LaunchDescription([LogInfo(msg=greet(LaunchConfiguration('who')))])
    """
    GREET = "def greet(who):\n    return ['hello ', who]\n"

    async def test_module_of_source_package_is_imported(
        self, write: Any, write_bot_file: Any, launch_messages: Any
    ) -> None:
        write("src/bot_tools/package.xml", MANIFEST.format("bot_tools"))
        write("src/bot_tools/setup.py", "")
        write("src/bot_tools/bot_tools/__init__.py", "")
        write("src/bot_tools/bot_tools/words.py", self.GREET)
        assert await launch_messages(write_bot_file(self.USES.format(module="bot_tools.words")), who="you") == [
            "hello you"
        ]

    async def test_module_of_own_package_without_init_is_imported(
        self, write: Any, write_bot_file: Any, launch_messages: Any
    ) -> None:
        write("src/bot/bot/words.py", self.GREET)
        assert await launch_messages(write_bot_file(self.USES.format(module="bot.words")), who="me") == ["hello me"]

    async def test_module_named_unlike_its_package_is_imported(
        self, write: Any, write_bot_file: Any, launch_messages: Any
    ) -> None:
        write("src/bot_tools/package.xml", MANIFEST.format("bot_tools"))
        write("src/bot_tools/CMakeLists.txt", "ament_python_install_package(bot_parts)")
        write("src/bot_tools/bot_parts/__init__.py", self.GREET)
        assert await launch_messages(write_bot_file(self.USES.format(module="bot_parts")), who="all") == ["hello all"]

    @pytest.mark.parametrize("folder", ["lib/python3.10/site-packages", "local/lib/python3.10/dist-packages"])
    async def test_module_of_unsourced_install_folder_is_imported(
        self, write: Any, write_bot_file: Any, launch_messages: Any, folder: str
    ) -> None:
        write("install/.colcon_install_layout", "isolated")
        write("install/bot_tools/share/bot_tools/package.xml", MANIFEST.format("bot_tools"))
        write(f"install/bot_tools/{folder}/bot_tools/__init__.py", self.GREET)
        assert await launch_messages(write_bot_file(self.USES.format(module="bot_tools")), who="it") == ["hello it"]

    def test_workspace_modules_are_hidden_from_libraries(self, write: Any, write_bot_file: Any, tmp_path: Path) -> None:
        write("src/bot_tools/package.xml", MANIFEST.format("bot_tools"))
        write("src/bot_tools/bot_tools/__init__.py", self.GREET)
        with use_finder(PackageFinder(start=tmp_path, environment={})), pytest.raises(ModuleNotFoundError):
            exec(compile("import bot_tools", os.__file__, "exec"), {})

    def test_missing_module_has_hint_about_provider(self, write_bot_file: Any) -> None:
        for module, hint in (
            ("webots_ros2_driver.webots_launcher", "it is part of webots_ros2"),
            ("serial.nothing", package_hint("pyserial")),
            ("my_arm_bringup", "put the ROS package 'my_arm_bringup' into the workspace's src folder"),
            ("nobody_has_this", "install the Python package that provides 'nobody_has_this'"),
        ):
            path = write_bot_file(f"import {module}\ndef generate_launch_description(): pass")
            with pytest.raises(LinkwrightError) as caught:
                load_launch_file(path)
            (diagnostic,) = caught.value.diagnostics
            assert diagnostic.message.endswith(f"No module named '{module.partition('.')[0]}'")
            assert hint in (diagnostic.hint or "")


class TestSubmoduleImports:
    async def test_submodules_are_available_after_importing_launch(
        self, write_bot_file: Any, launch_messages: Any
    ) -> None:
        text = """
        def said(context):
            words = launch.utilities.normalize_to_list_of_substitutions(['a', LaunchConfiguration('x')])
            assert launch_ros.utilities.normalize_parameters([{'a': 1}])
            assert launch.some_substitutions_type.SomeSubstitutionsType
            assert launch_ros.actions.node.Node is Node
            return [LogInfo(msg=launch.utilities.perform_substitutions(context, words))]
        def generate_launch_description():
            return LaunchDescription([OpaqueFunction(function=said)])
        """
        assert await launch_messages(write_bot_file(text), x="b") == ["ab"]

    def test_names_imported_by_ros_modules_are_available(self) -> None:
        from launch.actions import ExecuteProcess
        from launch.launch_introspector import ExecuteProcess as Introspected
        from launch_ros.actions.node import SomeSubstitutionsType

        from launch import SomeSubstitutionsType as Listed

        assert Introspected is ExecuteProcess
        assert SomeSubstitutionsType is Listed

    def test_name_from_wrong_module_is_an_import_error(self) -> None:
        with pytest.raises(ImportError, match="cannot import name 'LaunchConfiguration'"):
            exec("from launch.actions import LaunchConfiguration", {})
        with pytest.raises(ImportError, match="cannot import name 'Nothing'"):
            exec("from launch.actions.execute_process import Nothing", {})

    def test_logging_handlers_are_available(self, tmp_path: Path) -> None:
        import logging

        import launch.logging

        path = tmp_path / "x.log"
        handler = launch.logging.handlers.RotatingFileHandler(path, maxBytes=1024, backupCount=3)
        handler.setFormatterFor(logging.getLogger("k1"), logging.Formatter("<%(message)s>"))
        handler.handle(logging.LogRecord("k1", logging.INFO, "", 1, "said", (), None))
        handler.close()
        assert path.read_text() == "<said>\n"
        with pytest.raises(AttributeError):
            launch.logging.handlers.Nothing  # noqa: B018

    async def test_condition_predicate_can_be_evaluated_by_user_class(
        self, write_bot_file: Any, launch_messages: Any
    ) -> None:
        text = """
        from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
        class Text(launch.Substitution):
            def __init__(self, yes, no, condition):
                self.words = yes if condition else no
            def perform(self, context):
                return self.words
        def said(context):
            x = LaunchConfiguration('x')
            holds = [IfCondition(x)._predicate_func(context), UnlessCondition(x)._predicate_func(context),
                     LaunchConfigurationEquals('x', 'true')._predicate_func(context)]
            return [DeclareLaunchArgument('y', default_value=Text('yes', 'no', holds[0])), LogInfo(msg=str(holds)),
                    LogInfo(msg=LaunchConfiguration('y'))]
        def generate_launch_description():
            return LaunchDescription([OpaqueFunction(function=said)])
        """
        assert await launch_messages(write_bot_file(text), x="true") == ["[True, False, True]", "yes"]

    async def test_group_action_can_replace_its_actions_at_runtime(
        self, write_bot_file: Any, launch_messages: Any
    ) -> None:
        text = """
        class Chosen(launch.actions.GroupAction):
            def __init__(self, name, **kwargs):
                self.__name = name
                declared = DeclareLaunchArgument(self.name, default_value='one')
                super().__init__(actions=[declared], scoped=False, **kwargs)
            @property
            def name(self):
                return self.__name
            def execute(self, context):
                words = context.launch_configurations.get(self.name, 'none')
                self._GroupAction__actions = [LogInfo(msg=['chosen ', words])]
                return super().execute(context)
        def generate_launch_description():
            return LaunchDescription([Chosen('q')])
        """
        path = write_bot_file(text)
        assert "'q'" in format_arguments(load_launch_file(path))
        assert await launch_messages(path, q="two") == ["chosen two"]

    async def test_description_can_grow_while_visited(self, write_bot_file: Any, launch_messages: Any) -> None:
        text = """
        def grow(context, description):
            description.add_action(LogInfo(msg=['grown by ', LaunchConfiguration('x')]))
        def generate_launch_description():
            description = LaunchDescription([DeclareLaunchArgument('x', default_value='one')])
            description.add_action(OpaqueFunction(function=grow, args=[description]))
            return description
        """
        assert await launch_messages(write_bot_file(text)) == ["grown by one"]

    async def test_module_beside_launch_file_is_imported(
        self, write: Any, write_bot_file: Any, launch_messages: Any
    ) -> None:
        write("src/bot/launch/shared_parts.py", "PARAMETERS = [{'name': 'a', 'default': '1'}]\n")
        text = """
        import pathlib, sys
        sys.path.append(str(pathlib.Path(__file__).parent.absolute()))
        import shared_parts
        def generate_launch_description():
            declared = [DeclareLaunchArgument(each['name'], default_value=each['default'])
                        for each in shared_parts.PARAMETERS]
            return LaunchDescription(declared + [LogInfo(msg=LaunchConfiguration('a'))])
        """
        saved = list(sys.path)
        try:
            assert await launch_messages(write_bot_file(text)) == ["1"]
        finally:
            sys.path[:] = saved


class TestNamesUpToFoxy:
    def test_node_prefixed_arguments_are_accepted_as_deprecated(self) -> None:
        from launch.utilities import perform_substitutions
        from launch_ros.actions import ComposableNodeContainer, LifecycleNode, Node
        from launch_ros.descriptions import ComposableNode

        from launch import LaunchContext

        with warnings.catch_warnings(record=True) as logged:
            warnings.simplefilter("always")
            node = Node(package="p", node_executable="talker", node_name="n", node_namespace="ns")
            LifecycleNode(package="p", node_executable="e", node_name="n", namespace="")
            part = ComposableNode(package="p", node_plugin="p::Part", node_name="part")
            ComposableNodeContainer(
                package="p", node_executable="e", node_name="c", node_namespace="", composable_node_descriptions=[part]
            )
        assert node.node_executable == "talker"
        assert perform_substitutions(LaunchContext(), part.node_plugin) == "p::Part"
        texts = [str(warning.message) for warning in logged]
        assert texts[0] == "'node_executable' of Node is deprecated: use 'executable'"
        assert "'node_plugin' of ComposableNode is deprecated: use 'plugin'" in texts
        assert len(texts) == 10
        assert {warning.filename for warning in logged} == {__file__}

    def test_old_and_new_argument_together_are_rejected(self) -> None:
        from launch_ros.actions import Node

        with pytest.raises(TypeError, match="received 'node_name' and 'name'"):
            Node(package="p", executable="e", name="a", node_name="b")


class TestMarkup:
    async def test_quoted_parameter_value_is_parsed(self, write_bot_file: Any, launch: Any) -> None:
        text = """
        launch:
        - set_parameter: {name: use_sim_time, value: "true"}
        - set_parameter: {name: rate, value: 2.5}
        """
        result = await launch(load_launch_file(write_bot_file(text, "a.launch.yaml")))
        assert result.session.context.launch_configurations["global_params"] == [("use_sim_time", True), ("rate", 2.5)]

    async def test_launch_version_attribute_is_accepted(self, write_bot_file: Any, launch_messages: Any) -> None:
        text = '<launch version="0.1.1"><log_info message="$(var x)"/></launch>'
        assert await launch_messages(write_bot_file(text, "a.launch.xml"), x="fine") == ["fine"]

    async def test_included_file_sets_launch_configurations(
        self, write: Any, write_bot_file: Any, launch_messages: Any
    ) -> None:
        write("src/bot/config/default_preset.yaml", "launch:\n- arg: {name: mode, default: mpc}\n")
        text = """
        <launch>
          <arg name="preset" default="default"/>
          <let name="folder" value="$(find-pkg-share $(var package))/config"/>
          <include file="$(var folder)/$(var preset)_preset.yaml"/>
          <let name="speed" value="slow"/>
          <let name="speed" value="fast" if="$(equals $(var mode) mpc)"/>
          <log_info message="$(var mode) is $(var speed) $(env NOBODY_SETS_THIS never)"/>
        </launch>
        """
        assert await launch_messages(write_bot_file(text, "a.launch.xml"), package="bot") == ["mpc is fast never"]


class TestResources:
    def test_ament_index_resources_are_found(self, write: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        import ament_index_python as ament

        write("src/bot/package.xml", MANIFEST.format("bot"))
        write("real/share/ament_index/resource_index/rviz__plugins/panel", "<library/>")
        monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "real"))
        with use_finder(PackageFinder(start=tmp_path)):
            assert ament.has_resource("packages", "bot") == str(tmp_path / "src" / "bot")
            assert ament.has_resource("packages", "nothing") is False
            assert ament.get_resource("rviz__plugins", "panel") == ("<library/>", str(tmp_path / "real"))
            assert ament.get_resources("rviz__plugins") == {"panel": str(tmp_path / "real")}
            assert "bot" in ament.get_resources("packages")
            assert ament.get_resource_types() == {"packages", "rviz__plugins"}
            assert str(tmp_path / "real") in ament.get_search_paths()
            with pytest.raises(LookupError, match="'none' of type 'rviz__plugins'"):
                ament.get_resource("rviz__plugins", "none")
            with pytest.raises(ament.InvalidResourceTypeNameError):
                ament.get_resources("a/b")
            with pytest.raises(ament.InvalidResourceNameError):
                ament.has_resource("packages", "")


class TestPrograms:
    async def test_ros2_and_related_programs_are_on_path(self, write_bot_file: Any, launch: Any) -> None:
        text = """
        def generate_launch_description():
            return LaunchDescription([
                ExecuteProcess(cmd=['ros2', 'pkg', 'prefix', 'bot'], output='screen'),
                LogInfo(msg=FindExecutable(name='ros2'))])
        """
        environment = dict(os.environ)
        append_programs_to_path(environment)
        append_programs_to_path(environment)
        folder = Path(environment["PATH"].split(os.pathsep)[-1])
        assert environment["PATH"].split(os.pathsep).count(str(folder)) == 1
        assert all(shutil.which(name, path=str(folder)) for name in PROGRAMS)
        os.environ["PATH"] = environment["PATH"]
        path = write_bot_file(text)
        os.environ["LINKWRIGHT_START"] = str(path.parent)
        result = await launch(load_launch_file(path))
        assert result.succeeded, result.err
        assert result.messages[0].endswith("/ros2")

    def test_ros_variables_are_set_except_those_that_are_set_already(self) -> None:
        unsourced, chosen = {"A": "b"}, {"ROS_DISTRO": "jazzy", "LD_LIBRARY_PATH": "/opt/ros/jazzy/lib"}
        set_ros_variables(unsourced)
        set_ros_variables(chosen)
        of_ros = {"ROS_DISTRO": "humble", "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}
        assert unsourced == {
            "A": "b",
            **of_ros,
            ASSUMED_DISTRIBUTION_VARIABLE: "1",
            "GZ_SIM_RESOURCE_PATH": "",
            "LD_LIBRARY_PATH": "",
        }
        assert chosen == {
            **of_ros,
            "ROS_DISTRO": "jazzy",
            "LD_LIBRARY_PATH": "/opt/ros/jazzy/lib",
            "GZ_SIM_RESOURCE_PATH": "",
        }
        models = {"GZ_SIM_RESOURCE_PATH": "/models"}
        set_ros_variables(models)
        assert models["GZ_SIM_RESOURCE_PATH"] == "/models"

    def test_unwritable_cache_folder_adds_no_programs(self, tmp_path: Path) -> None:
        blocked = tmp_path / "file"
        blocked.write_text("")
        os.environ["XDG_CACHE_HOME"] = str(blocked)
        environment = {"PATH": "/bin"}
        append_programs_to_path(environment)
        assert environment == {"PATH": "/bin"}


def test_rewritten_yaml_keeps_group_with_parameter_name(write: Any) -> None:
    import yaml
    from nav2_common.launch import RewrittenYaml

    from launch import LaunchContext

    path = write("p.yaml", "map:\n  ros__parameters: {map: 1, other: 2}\n")
    rewritten = RewrittenYaml(source_file=str(path), param_rewrites={"map": "7"}, convert_types=True)
    content = yaml.safe_load(Path(rewritten.perform(LaunchContext())).read_text())
    assert content == {"map": {"ros__parameters": {"map": 7, "other": 2}}}


def test_rewritten_yaml_accepts_empty_text_as_rewrites(write: Any) -> None:
    from nav2_common.launch import RewrittenYaml

    from launch import LaunchContext

    path = write("p.yaml", "map:\n  ros__parameters: {other: 2}\n")
    rewritten = RewrittenYaml(source_file=str(path), root_key="", param_rewrites="", convert_types=True)
    assert "other: 2" in Path(rewritten.perform(LaunchContext())).read_text()


def test_launch_utils_create_controller_spawners() -> None:
    from controller_manager import launch_utils
    from launch.utilities import perform_substitutions

    from launch import LaunchContext

    context = LaunchContext()
    description = launch_utils.generate_load_controller_launch_description("arm", "a/Arm", "/p.yaml", ["--inactive"])
    *declared, spawner = description.entities
    for argument in declared:
        argument.execute(context)
    words = [perform_substitutions(context, word) for word in spawner.cmd[1:]]
    manager = ["--controller-manager", "controller_manager"]
    typed = ["arm", "--controller-type", "a/Arm"]
    assert words[:9] == [*typed, *manager, "--param-file", "/p.yaml", "", "--inactive"]
    description = launch_utils.generate_load_controller_launch_description("arm", controller_params_file="/p.yaml")
    words = [perform_substitutions(context, word) for word in description.entities[-1].cmd[1:]]
    assert words[:5] == ["arm", *manager, "--param-file", "/p.yaml"]
    listed = launch_utils.generate_controllers_spawner_launch_description_from_dict({"a": ["x", "y"], "b": None})
    words = [perform_substitutions(context, word) for word in listed.entities[-1].cmd[1:]]
    assert words[:8] == ["a", "b", *manager, "--param-file", "x", "--param-file", "y"]
    with pytest.raises(ValueError, match="Invalid controller_info_dict"):
        launch_utils.generate_controllers_spawner_launch_description_from_dict(["a"])
    with pytest.raises(ValueError, match="Invalid controller_params_file"):
        launch_utils.generate_controllers_spawner_launch_description_from_dict({"a": 5})


class TestLaunchVerbApi:
    def test_launch_file_paths_of_package_are_found(self, write: Any, write_bot_file: Any, tmp_path: Path) -> None:
        from ros2launch.api import MultipleLaunchFilesError, get_launch_file_paths, get_share_file_path_from_package

        path = write_bot_file("def generate_launch_description():\n    return LaunchDescription()")
        with use_finder(PackageFinder(start=tmp_path, environment={})):
            assert get_share_file_path_from_package(package_name="bot", file_name="a.launch.py") == str(path)
            with pytest.raises(FileNotFoundError, match=r"'b\.launch\.py' was not found"):
                get_share_file_path_from_package(package_name="bot", file_name="b.launch.py")
            write("src/bot/other/a.launch.py", "")
            with pytest.raises(MultipleLaunchFilesError, match="more than once") as caught:
                get_share_file_path_from_package(package_name="bot", file_name="a.launch.py")
        assert len(caught.value.paths) == 2
        assert sorted(get_launch_file_paths(path=str(tmp_path / "src"))) == sorted(caught.value.paths)

    def test_launch_arguments_are_parsed(self) -> None:
        from ros2launch.api.api import parse_launch_arguments

        assert parse_launch_arguments(["a:=1", "b:=x:=y", "a:=2"]) == [("a", "2"), ("b", "x:=y")]
        with pytest.raises(RuntimeError, match="malformed launch argument 'a='"):
            parse_launch_arguments(["a="])

    def test_arguments_and_launch_file_are_printed(
        self, write_bot_file: Any, capsys: pytest.CaptureFixture[str]
    ) -> None:
        from ros2launch import api

        path = str(write_bot_file("<launch><arg name='x' default='1'/></launch>", "a.launch.xml"))
        api.print_arguments_of_launch_file(launch_file_path=path)
        api.print_a_launch_file(launch_file_path=path)
        printed = capsys.readouterr().out
        assert "(default: '1')" in printed
        assert "DeclareLaunchArgument('x'" in printed

    def test_launch_a_launch_file_runs_it(self, write_bot_file: Any, capfd: pytest.CaptureFixture[str]) -> None:
        from ros2launch.api import launch_a_launch_file

        path = str(
            write_bot_file("<launch><arg name='x'/><log_info message='x is $(var x)'/></launch>", "a.launch.xml")
        )
        assert launch_a_launch_file(launch_file_path=path, launch_file_arguments=["x:=5"]) == 0
        assert "x is 5" in capfd.readouterr().err
