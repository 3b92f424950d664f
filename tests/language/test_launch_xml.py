"""Launch files in XML: completion, hover and definition."""

from __future__ import annotations

from pathlib import Path

import pytest

import linkwright.launch.model.actions.testing  # noqa: F401 - its tag exists once it has been imported
from linkwright.language.launch_schema import LAUNCH
from linkwright.launch.frontend.extensions import ACTION_GROUP, load
from linkwright.launch.frontend.xml import Entity, Parser
from linkwright.launch.model.markup.expose import action_parse_methods
from linkwright.schema import ElementRule
from linkwright.xmltree import parse
from tests.language.formats import Place, make_packages


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    return lambda text: Place(folder / "launch" / "lamp.launch.xml", f"<launch>{text}</launch>")


def test_table_contains_all_action_tags():
    assert list(load(ACTION_GROUP))
    assert "ready_to_test" in action_parse_methods
    assert {*action_parse_methods} - {"push-ros-namespace"} <= {*LAUNCH.child_rules}


VALUES = {"true or false": "true", "number": "1.0", "integer": "1", "level of a log": "info"}


def element_text(rule: ElementRule) -> str:
    """Return an element with the attributes that it needs."""
    required_attributes = [attribute for attribute in rule.attributes if attribute.required]
    attributes = "".join(
        f' {attribute.name}="{VALUES.get(attribute.type.name, "a")}"' for attribute in required_attributes
    )
    return f"<{rule.tag}{attributes}/>"


@pytest.mark.parametrize("tag", sorted(LAUNCH.child_rules))
def test_table_contains_attributes_read_by_actions(tag, monkeypatch):
    requested: set[str] = set()
    read = Entity.get_attr

    def recording(entity: Entity, name: str, **options):
        if entity.parent is None:
            requested.add(name)
        return read(entity, name, **options)

    monkeypatch.setattr(Entity, "get_attr", recording)
    assert list(load(ACTION_GROUP))
    rule = LAUNCH.child_rules[tag]
    children = "".join(map(element_text, rule.children)) if tag in ("load_composable_node", "rep_env") else ""
    text = element_text(rule).replace("/>", f">{children}</{tag}>")
    Parser().parse_action(Entity(parse(text, "a.launch.xml").root))
    of_python_or_yaml = {"choices", "level"} if tag in ("arg", "bool_arg") or tag.startswith("log_") else set()
    assert requested <= {*rule.attribute_rules, *rule.child_rules, "choice"} | of_python_or_yaml
    assert {*rule.attribute_rules} <= requested


def test_elements_and_attributes_are_completed(position_at):
    assert position_at("<no|").labels() == ["node", "node_container"]
    assert position_at("<group><timer period='1'><inc|").labels() == ["include"]
    assert position_at("<node |/>").labels()[:2] == ["pkg", "exec"]
    assert "xacro:if" not in position_at("<|").labels()
    assert position_at("<node pkg='a' exec='b'><re|").labels() == ["remap"]


def test_own_package_and_dependencies_come_first(position_at):
    assert position_at('<node pkg="|"/>').labels()[:2] == ["lamp_bringup", "lamp_nodes"]
    assert position_at('<let name="a" value="$(find-pkg-share lamp_n|"/>').labels() == ["lamp_nodes"]


def test_executables_of_package_are_completed(position_at):
    assert position_at('<node pkg="lamp_nodes" exec="|"/>').labels() == ["blink"]
    assert position_at('<node exec="g|" pkg="lamp_bringup"/>').labels() == ["glow"]
    assert position_at('<node pkg="lamp_nodes" exec="bl|ink"/>').targets() == ["blink.py:main"]
    assert position_at('<node pkg="lamp_bringup" exec="gl|ow"/>').targets() == ["CMakeLists.txt:glow"]
    assert position_at('<composable_node pkg="lamp_bringup" plugin="|"/>').labels() == ["lamp_bringup::Fader"]


def test_variables_are_completed_from_arguments(position_at):
    declared = '<arg name="gui" default="true" description="Show it"/><let name="b" value="2"/>'
    assert position_at(f'{declared}<log message="$(var |"/>').labels() == ["gui", "b"]
    assert position_at(f'{declared}<node if="|"/>').labels()[0] == "$(var gui)"
    place = position_at(f'{declared}<log message="$(var g|ui)"/>')
    assert place.hover() == "**gui** = `true`, lamp.launch.xml\n\nShow it"
    assert place.targets() == ["lamp.launch.xml:gui"]


@pytest.mark.parametrize(
    ("file", "names"),
    [("parts.launch.xml", ["rate", "mode"]), ("parts.launch.py", ["color", "x", "y"])],
)
def test_arguments_of_included_file_are_completed(position_at, file, names):
    include = f'<include file="$(find-pkg-share lamp_bringup)/launch/{file}"><arg '
    assert position_at(f'{include} name="|"/></include>').labels() == names
    assert position_at(f'{include} name="{names[0]}"/><arg name="|"/></include>').labels() == names[1:]
    place = position_at(f'{include} name="{names[0][:2]}|{names[0][2:]}"/></include>')
    assert place.targets() == [f"{file}:{names[0]}"]


def test_values_of_included_argument_are_its_choices(position_at):
    include = '<include file="$(dirname)/parts.launch.xml"><arg name="mode" value="|"/></include>'
    assert position_at(include).labels()[:2] == ["slow", "fast"]
    assert position_at(f'<arg name="mode"/>{include}').labels()[0] == "$(var mode)"


def test_paths_are_completed_with_existing_files(position_at):
    assert position_at('<include file="$(find-pkg-share lamp_bringup)/|"/>').labels()[:2] == ["config", "launch"]
    assert position_at('<param from="$(find-pkg-share lamp_bringup)/config/l|"/>').labels() == ["lamp.yaml"]
    assert position_at('<include file="|"/>').labels()[0] == "$(find-pkg-share "
    chained = '<arg name="p" default="$(find-pkg-share lamp_bringup)/config"/><param from="$(var p)/la|mp.yaml"/>'
    assert position_at(chained).labels() == ["lamp.yaml"]
    assert position_at(chained).targets() == ["lamp.yaml:"]
    assert position_at(chained).links() == ["lamp.yaml"]


def test_hover_explains_substitutions(position_at):
    assert position_at('<let name="a" value="$(|"/>').labels()[:2] == ["var", "find-pkg-share"]
    assert "share folder" in position_at('<let name="a" value="$(find-p|kg-share lamp_nodes)"/>').hover()
    assert "Nodes of a lamp." in position_at('<let name="a" value="$(find-pkg-share lamp_n|odes)"/>').hover()


def test_symbols_are_named_elements(position_at):
    (launch,) = position_at('|<arg name="a"/><group><node pkg="p" exec="e"/></group>').format.symbols(
        position_at('|<arg name="a"/><group><node pkg="p" exec="e"/></group>').document
    )
    assert [child.name for child in launch.children] == ["arg a", "group"]
    assert [child.name for child in launch.children[1].children] == ["node e"]


def test_remapping_completion_offers_topics_of_the_node(position_at):
    node = '<node pkg="robot_state_publisher" exec="robot_state_publisher"><remap {}/></node>'
    assert position_at(node.format('from="jo|"')).labels() == ["joint_states"]
    assert position_at(node.format('from="/jo|"')).labels() == ["/joint_states"]
    assert (
        position_at(node.format('from="/jo|int_states" to="a"'))
        .hover()
        .startswith("**joint_states** `sensor_msgs/msg/Joint")
    )
    assert position_at(node.format('from="/tf" to="|"')).labels() == ["tf"]
    node_with_remappings = node.format('from="joint_states" to="a"/><remap from="jo|"')
    assert position_at(node_with_remappings).labels() == []


def test_hover_of_executable_shows_topics(position_at):
    hover = position_at('<node pkg="teleop_twist_keyboard" exec="teleop_twist_key|board"/>').hover()
    assert "**cmd_vel** `geometry_msgs/msg/Twist`, publisher" in hover


def test_remapping_completion_reads_sources_of_own_node(position_at):
    node = '<node pkg="lamp_nodes" exec="blink"><remap from="{}"/></node>'
    place = position_at(node.format("|"))
    source = place.document.file.parents[2] / "lamp_nodes/lamp_nodes/blink.py"
    source.write_text(
        'def main():\n    node.create_publisher(Bool, "glow", 1)\n    ActionServer(self, Blink, "~/run", x)\n'
    )
    place.document.workspace.index.refresh()
    assert place.labels() == ["glow", "~/run"]
    document = position_at(node.format("gl|ow"))
    document.document.workspace.index.refresh()
    assert "publisher, blink.py" in document.hover()
    assert document.targets() == ["blink.py:glow"]


def test_parameters_are_completed_by_executable(position_at):
    assert position_at(
        '<node pkg="controller_manager" exec="ros2_control_node"><param name="upd|"/></node>'
    ).labels() == ["update_rate"]


def test_xacro_command_is_completed_with_paths_and_arguments(position_at):
    place = position_at('<let name="a" value="$(command \'xacro $(find-pkg-share lamp_nodes)/urdf/|"/>')
    urdf = place.document.file.parents[2] / "lamp_nodes/urdf/lamp.urdf.xacro"
    urdf.parent.mkdir()
    urdf.write_text('<robot><xacro:arg name="side" default="left"/><xacro:arg name="use_sim" default=""/></robot>')
    assert place.labels() == ["lamp.urdf.xacro"]
    command = "$(command 'xacro $(find-pkg-share lamp_nodes)/urdf/lamp.urdf.xacro use_sim:=1 |"
    assert position_at(f'<let name="a" value="{command}"/>').labels() == ["side:="]
