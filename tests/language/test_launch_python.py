"""Python launch files.

The tests cover completion, hover and definition in strings, without running the file.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.launch_arguments import arguments_in
from linkwright.language.python_text import PythonText
from tests.language.formats import Place, make_packages

HEAD = "share = get_package_share_directory('lamp_bringup')\n"
INCLUDE = """IncludeLaunchDescription(
    PythonLaunchDescriptionSource(os.path.join(share, 'launch', 'parts.launch.py')),
    launch_arguments={}
)"""


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    return lambda text: Place(folder / "launch" / "lamp.launch.py", HEAD + text)


def test_packages_and_executables_are_completed(position_at):
    assert position_at("Node(package='|')").labels()[:2] == ["lamp_bringup", "lamp_nodes"]
    assert position_at('FindPackageShare("lamp_n|').labels() == ["lamp_nodes"]
    assert position_at("Node(package='lamp_nodes', executable='|').").labels() == ["blink"]
    assert position_at("Node(\n  executable='b|',\n  package='lamp_nodes',\n)").labels() == ["blink"]
    assert position_at("name = 'lamp_nodes'\nNode(package=name, executable='|'").labels() == ["blink"]
    assert position_at("ComposableNode(package='lamp_bringup', plugin='|')").labels() == ["lamp_bringup::Fader"]
    assert position_at("Node(package='lamp_nodes', executable='bl|ink')").targets() == ["blink.py:main"]
    assert "Nodes of a lamp." in position_at("Node(package='lamp_no|des')").hover()


@pytest.mark.parametrize(
    "written",
    [
        "os.path.join(share, 'config', '|')",
        "os.path.join(share, 'config/|')",
        "share + '/config/|'",
        "Path(share) / 'config' / '|'",
        "PathJoinSubstitution([FindPackageShare('lamp_bringup'), 'config', '|'])",
        "[FindPackageShare('lamp_bringup'), '/config/|']",
        "'package://lamp_bringup/config/|'",
        "os.path.join(os.path.dirname(__file__), '..', 'config', '|')",
        "folder = os.path.join(share, 'config')\nopen(os.path.join(folder, '|'))",
    ],
)
def test_joined_path_is_completed_with_existing_files(position_at, written):
    assert position_at(written).labels() == ["lamp.yaml"]


def test_path_has_definition_hover_and_link(position_at):
    place = position_at("os.path.join(share, 'config', 'lamp|.yaml')")
    assert place.targets() == ["lamp.yaml:"]
    assert "config/lamp.yaml" in place.hover()
    assert place.links() == ["lamp.yaml"]
    assert position_at("os.path.join(share, 'config', 'la|mps.yaml')").hover().endswith("lamps.yaml` does not exist")


def test_launch_configurations_are_completed_from_declared_arguments(position_at):
    declared = "DeclareLaunchArgument('gui', default_value='true', description='Show ' 'it')\n"
    assert position_at(f"{declared}LaunchConfiguration('|").labels() == ["gui"]
    place = position_at(f"{declared}LaunchConfiguration('g|ui')")
    assert place.hover() == "**gui** = `true`, lamp.launch.py\n\nShow it"
    assert place.targets() == ["lamp.launch.py:gui"]


@pytest.mark.parametrize("pairs", ["{'|'}.items()", "{'x': '1', '|': '2'}.items()", "[('|', 'red')]", "[('x', y), ('|"])
def test_arguments_of_included_file_are_completed(position_at, pairs):
    assert position_at(INCLUDE.format(pairs)).labels() == ["color", "x", "y"]


def test_values_of_included_argument_are_its_choices(position_at):
    assert position_at(INCLUDE.format("{'color': '|'}.items()")).labels() == ["red", "blue"]
    assert position_at(INCLUDE.format("[('color', '|')]")).labels() == ["red", "blue"]
    assert position_at(INCLUDE.format("{'col|or': 'red'}.items()")).targets() == ["parts.launch.py:color"]


def test_next_statement_ends_unclosed_brackets():
    python = PythonText("a = join(x, 'b'\ndef f():\n    c = LaunchConfiguration('d')\n")
    (call,) = python.calls_of("LaunchConfiguration")
    assert call.parent is not None
    assert call.parent.group is python.root


def test_arguments_declared_in_loop_are_found():
    text = (
        "KNOWN = {'a': ('1', 'first'), 'b': ('2', 'second')}\n"
        "[DeclareLaunchArgument(n, default_value=d, description=t) for n, (d, t) in KNOWN.items()]\n"
        "for axis in ['x', 'y']:\n    add(DeclareLaunchArgument(axis, default_value='0'))\n"
    )
    defaults_and_descriptions = {
        argument.name: (argument.default, argument.description) for argument in arguments_in(text, Path("a.py"))
    }
    assert defaults_and_descriptions == {"a": ("1", "first"), "b": ("2", "second"), "x": ("0", ""), "y": ("0", "")}


def test_symbols_are_arguments_nodes_and_includes(position_at):
    place = position_at(f"|DeclareLaunchArgument('gui')\nNode(package='p', executable='e')\n{INCLUDE.format('[]')}")
    names = [symbol.name for symbol in place.format.symbols(place.document)]
    assert names == ["arg gui", "Node e", "include parts.launch.py"]


def test_boolean_spelling_follows_file(position_at):
    assert position_at("DeclareLaunchArgument('use_x', default_value='|')").labels()[:2] == ["true", "false"]
    text = "DeclareLaunchArgument('a', default_value='True')\nDeclareLaunchArgument('use_x', default_value='|')"
    assert position_at(text).labels()[:2] == ["True", "False"]


def test_configurations_used_in_file_are_offered_after_declared_ones(position_at):
    text = "DeclareLaunchArgument('a')\nb = LaunchConfiguration('outer')\nc = LaunchConfiguration('|')"
    assert position_at(text).labels() == ["a", "outer"]


def test_missing_dependency_is_offered_as_package(position_at):
    manifest = position_at("|").document.file.parents[1] / "package.xml"
    manifest.write_text(manifest.read_text().replace("</package>", "<exec_depend>far_away</exec_depend></package>"))
    assert "far_away" in position_at("Node(package='|')").labels()[:3]


def test_hover_explains_launch_classes_and_arguments(position_at):
    assert position_at("No|de(package='a')").hover().startswith("**Node**: An action that starts a node.")
    assert (
        position_at("Node(pack|age='a')").hover()
        == "`package`: the name of the package of the executable; None for a program."
    )
    assert "package" in position_at("Node(|").labels()[0]
    assert position_at("Node(package='a', exec|").labels()[0] == "executable="
    assert position_at("Node(package='a', parameters=[{|").labels() == []
    assert position_at("DeclareLaunchArgument('a', |)").labels()[:2] == ["default_value=", "description="]
    assert position_at("f(|)").labels() == []


def test_configuration_in_path_uses_its_default(position_at):
    declared = "DeclareLaunchArgument('package', default_value='lamp_bringup')\np = LaunchConfiguration('package')\n"
    assert position_at(f"{declared}PathJoinSubstitution([FindPackageShare(p), 'config', '|'])").labels() == [
        "lamp.yaml"
    ]


def test_hover_of_value_shows_its_argument(position_at):
    assert "Its color" in position_at(INCLUDE.format("{'color': 're|d'}.items()")).hover()
    assert (
        position_at("Node(name='ab|c')").hover()
        == "`name`: the name of the node; None for the name that the program sets."
    )
    assert position_at("Node(package='nowh|ere')").hover() == "package 'nowhere' not found"


def test_default_in_variable_is_resolved():
    text = "x = LaunchConfiguration('a', default='false')\ny = 'b.yaml'\n"
    text += "DeclareLaunchArgument('a', default_value=x)\nDeclareLaunchArgument('b', default_value=y)\n"
    assert [argument.default for argument in arguments_in(text, Path("a.py"))] == ["false", "b.yaml"]


def test_remapping_completion_offers_topics_of_the_node(position_at):
    node = 'Node(package="robot_state_publisher", executable="robot_state_publisher", remappings=[{}])'
    assert position_at(node.format('("jo|", "a")')).labels() == ["joint_states"]
    assert position_at(node.format('("/tf", "tf"), ("/tf|", "a")')).labels() == ["/tf_static"]
    assert position_at(node.format('("/tf", "|")')).labels() == ["tf"]
    assert "tf2_msgs/msg/TFMessage" in position_at(node.format('("/t|f", "tf")')).hover()
    users = node.format("").replace("[]", "remappings")
    assert position_at(f'remappings = [("jo|", "a")]\n{users}').labels() == ["joint_states"]


def test_node_parameters_are_completed_and_explained(position_at):
    node = 'Node(package="nav2_amcl", executable="amcl", parameters=[config, {{{}}}])'
    assert position_at(node.format('"max_p|": 1')).labels() == ["max_particles"]
    assert "max_particles" not in position_at(node.format('"max_particles": 1, "max_p|"')).labels()
    assert "2000" in position_at(node.format('"max_par|ticles": 1')).hover()
