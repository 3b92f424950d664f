"""Completion in descriptions: expanded names, values by type, plugins and their parameters."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from linkwright.diagnostics.translation import localized
from linkwright.language.expression_completion import FUNCTIONS, XACRO_FUNCTIONS
from linkwright.language.extension_schema import DESCRIPTION
from linkwright.language.format import Document, NotYetKnownError
from linkwright.language.includes import real_path
from linkwright.language.simulator_plugins import simulator_plugins
from linkwright.language.workspace import Workspace
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.lint.extension_names import CHILD_TAGS
from linkwright.loading.extensions import extensions
from linkwright.simulation.plugins.registry import PLUGIN_GROUP
from linkwright.xacro.expressions.builtin_names import global_names
from linkwright.xacro.session import Inputs

MANIFEST = "<package format='3'><name>{name}</name><version>0.1.0</version><description>d</description></package>"
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="radius" value="0.1"/>
  <xacro:property name="sizes_file" value="$(find arm)/config/sizes.yaml"/>
  <xacro:property name="sizes" value="${xacro.load_yaml(sizes_file)}"/>
  <xacro:macro name="wheel" params="side width:=0.02 *place **more">
    <xacro:property name="inner" value="${radius / 2}"/>
    <link name="${side}_wheel"/>
    <joint name="${side}_wheel_joint" type="continuous">
      <xacro:insert_block name="place"/>
      <parent link="base"/>
      <child link="${side}_wheel"/>
    </joint>
    <!-- in macro -->
  </xacro:macro>
  <link name="base"/>
  <xacro:wheel side="left"><origin/><a/></xacro:wheel>
  <!-- here -->
</robot>
"""
CMAKE = "pluginlib_export_plugin_description_file(hardware_interface plugins/arm.xml)\n"
PLUGINS_XML = """<library path="arm"><class name="arm/Motors" type="arm::Motors"
 base_class_type="hardware_interface::SystemInterface"><description> The motors. </description></class></library>
"""
SOURCE = 'auto port = info_.hardware_parameters["serial_port"]; if (info_.hardware_parameters.count("baud")) {}\n'


@pytest.fixture
def package(tmp_path: Path) -> Path:
    files = {
        "package.xml": MANIFEST.format(name="arm"),
        "CMakeLists.txt": CMAKE,
        "plugins/arm.xml": PLUGINS_XML,
        "src/motors.cpp": SOURCE,
        "config/sizes.yaml": "base:\n  mass: 2.5\n  mesh: base.stl\nwheel: {radius: 0.1}\n",
        "urdf/arm.urdf.xacro": ROBOT,
        "meshes/base.stl": "",
        "meshes/about.txt": "",
    }
    for name, text in files.items():
        path = tmp_path / "arm" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return real_path(tmp_path / "arm")


@pytest.fixture
def complete_labels(package: Path):
    """Return the labels that match the typed text after a replacement.

    The bar marks the cursor.
    """

    def labels(old: str, new: str, name: str = "urdf/arm.urdf.xacro", text: str = ROBOT) -> list[str]:
        text = text.replace(old, new, 1) if old else text
        offset = text.index("|")
        text, file = text.replace("|", "", 1), package / name
        workspace = Workspace([package])
        workspace.index.refresh()
        texts = {file: text}
        completions = complete(Document(workspace, texts, file, text), offset, workspace.names(file, texts))
        assert len({item.label for item in completions}) == len(completions)
        return [item.label for item in completions if item.label.startswith(text[item.start : offset])]

    return labels


def test_completion_offers_expanded_link_and_joint_names(complete_labels):
    assert complete_labels("<!-- here -->", '<joint name="a" type="fixed"><parent link="|"/></joint>') == [
        "base",
        "left_wheel",
    ]
    assert complete_labels("<!-- here -->", '<gazebo reference="left|"/>') == ["left_wheel", "left_wheel_joint"]
    motors = '<ros2_control name="a" type="system"><joint name="|"/></ros2_control>'
    assert complete_labels("<!-- here -->", motors) == ["left_wheel_joint"]


def test_completion_uses_saved_file_if_text_cannot_be_expanded(complete_labels):
    assert "left_wheel" in complete_labels("<!-- here -->", '<joint name="a" type="fixed"><child link="|')


def test_completion_in_macro_offers_unexpanded_names(complete_labels):
    joint = '<joint name="a" type="fixed"><parent link="|"/></joint>'
    assert complete_labels("<!-- in macro -->", joint)[0] == "${side}_wheel"


def test_expression_completion_offers_parameters_then_properties(complete_labels):
    place = '<origin xyz="${|}"/>'
    assert complete_labels("<!-- in macro -->", place)[:4] == ["side", "width", "inner", "radius"]
    outside = complete_labels("<!-- here -->", place)
    assert "inner" not in outside
    assert "side" not in outside
    assert outside[0] == "radius"


def test_expression_completion_offers_xacro_functions(complete_labels):
    assert complete_labels("<!-- here -->", '<origin xyz="${xacro.lo|}"/>') == ["xacro.load_yaml"]
    names = global_names(Inputs("a.xacro", {}).create_session())
    assert {*FUNCTIONS} <= {*names}
    assert {name.removeprefix("xacro.") for name in XACRO_FUNCTIONS} == {*names["xacro"].values}


def test_expression_completion_offers_yaml_keys(complete_labels):
    assert complete_labels("<!-- here -->", "<origin xyz=\"${sizes['|']}\"/>") == ["base", "wheel"]
    assert complete_labels("<!-- here -->", "<origin xyz=\"${sizes['base']['m|']}\"/>") == ["mass", "mesh"]
    assert complete_labels("<!-- here -->", '<origin xyz="${sizes.base.|}"/>') == ["mass", "mesh"]


def test_insert_block_completion_offers_block_parameters(complete_labels):
    assert complete_labels('<xacro:insert_block name="place"/>', '<xacro:insert_block name="|"/>') == ["place", "more"]


def test_required_macro_parameters_come_first(complete_labels):
    assert complete_labels('<xacro:wheel side="left">', "<xacro:wheel |>") == ["side", "width"]


def test_single_occurrence_elements_are_offered_once(complete_labels):
    joint = '<joint name="a" type="fixed"><parent link="base"/><|</joint>'
    assert complete_labels("<!-- here -->", joint)[0] == "child"
    assert "parent" not in complete_labels("<!-- here -->", joint)


def test_required_attributes_come_first(complete_labels):
    place = '<joint name="a" type="revolute"><limit |/></joint>'
    assert complete_labels("<!-- here -->", place)[:2] == ["effort", "velocity"]


def test_mesh_files_come_first(complete_labels):
    place = '<link name="b"><visual><geometry><mesh filename="package://arm/meshes/|"/>'
    assert complete_labels("<!-- here -->", place) == ["base.stl", "about.txt"]


def test_hardware_completion_offers_workspace_plugins_and_parameters(complete_labels):
    place = '<ros2_control name="a" type="system"><hardware><plugin>{}</plugin>{}</hardware></ros2_control>'
    assert complete_labels("<!-- here -->", place.format("|", ""))[:2] == [
        "arm/Motors",
        "mock_components/GenericSystem",
    ]
    assert complete_labels("<!-- here -->", place.format("arm/Motors", '<param name="|">1</param>')) == [
        "serial_port",
        "baud",
    ]
    mock = place.format("mock_components/GenericSystem", '<param name="calc|">true</param>')
    assert complete_labels("<!-- here -->", mock) == ["calculate_dynamics"]


def test_existing_joint_interfaces_are_not_offered(complete_labels):
    place = (
        '<ros2_control name="a" type="|"><joint name="b"><state_interface name="position"/>'
        '<state_interface name=""/></joint></ros2_control>'
    )
    assert complete_labels("<!-- here -->", place) == ["system", "actuator", "sensor"]
    place = place.replace("|", "").replace('name=""', 'name="|"')
    assert complete_labels("<!-- here -->", place)[:2] == ["velocity", "effort"]


def test_simulator_plugin_parameters_are_completed(complete_labels):
    place = "<gazebo><plugin filename='libgazebo_ros_diff_drive.so' name='drive'>{}</plugin></gazebo>"
    assert complete_labels("<!-- here -->", place.format("<wheel_|")) == ["wheel_separation", "wheel_diameter"]
    assert complete_labels("<!-- here -->", place.format("<left_joint>|</left_joint>")) == ["left_wheel_joint"]
    assert complete_labels("<!-- here -->", place.format("<publish_odom>|</publish_odom>")) == ["true", "false"]


def test_gz_plugin_library_and_class_are_completed(complete_labels):
    world = '<sdf version="1.9"><world name="w"><plugin {}></plugin></world></sdf>'

    def in_world(attributes: str) -> list[str]:
        return complete_labels("", "", "worlds/a.sdf", world.format(attributes))

    assert in_world('filename="gz-sim-diff|"') == ["gz-sim-diff-drive-system"]
    assert in_world('filename="gz-sim-imu-system" name="|"')[0] == "gz::sim::systems::Imu"
    assert in_world('name="gz::sim::systems::Imu" filename="|"')[0] == "gz-sim-imu-system"
    assert in_world('filename="ignition-gazebo-im|"') == ["ignition-gazebo-imu-system"]


def test_world_sensor_types_and_choices_are_completed(complete_labels):
    world = '<sdf version="1.9"><world name="w"><model name="m"><link name="l">{}</link></model></world></sdf>'
    assert complete_labels("", "", "a.sdf", world.format('<sensor name="s" type="gpu_l|">')) == ["gpu_lidar"]
    assert "directional" in complete_labels("", "", "a.sdf", world.format('<light name="s" type="|">'))


@pytest.fixture
def hover_text(package: Path):
    """Return the hover after a replacement; the bar marks the position of the mouse."""

    def hover(old: str, new: str, name: str = "urdf/arm.urdf.xacro", text: str = ROBOT) -> str:
        text = text.replace(old, new, 1) if old else text
        offset = text.index("|")
        text, file = text.replace("|", "", 1), package / name
        workspace = Workspace([package])
        workspace.index.refresh()
        explanation = explain_at(
            Document(workspace, {file: text}, file, text), offset, workspace.names(file, {file: text})
        )
        return "" if explanation is None else localized(explanation.text)

    return hover


def test_hover_explains_simulator_plugin_and_parameters(hover_text):
    place = "<gazebo><plugin filename='libgazebo_ros_diff_drive.so' name='drive'>{}</plugin></gazebo>"
    assert "drives a robot" in hover_text("<!-- here -->", place.format("").replace("_drive.so", "_dr|ive.so"))
    assert "number in m" in hover_text("<!-- here -->", place.format("<wheel_sep|aration>0.3</wheel_separation>"))
    assert "number in m" in hover_text("<!-- here -->", place.format("<wheel_separation>0.|3</wheel_separation>"))


def test_hover_explains_hardware_and_parameters(hover_text):
    place = '<ros2_control name="a" type="system"><hardware><plugin>{}</plugin>{}</hardware></ros2_control>'
    motors = hover_text("<!-- here -->", place.format("arm/Mo|tors", ""))
    assert "The motors." in motors
    assert "`serial_port`" in motors
    assert "motors.cpp" in hover_text("<!-- here -->", place.format("arm/Motors", '<param name="ba|ud">1</param>'))
    assert "rad/s" in hover_text(
        "<!-- here -->", '<ros2_control><joint name="j"><command_interface name="velo|city"/></joint></ros2_control>'
    )


def test_hover_explains_macro_parameters_and_functions(hover_text):
    assert "**side** (required)" in hover_text('<xacro:wheel side="left">', '<xacro:wheel si|de="left">')
    assert "= `0.02`" in hover_text('<xacro:wheel side="left">', '<xacro:wheel side="left" wid|th="1">')
    assert "**parameter side**" in hover_text('name="${side}_wheel"', 'name="${si|de}_wheel"')
    assert "square root" in hover_text("${radius / 2}", "${sq|rt(radius)}")


def test_hover_explains_element_in_macro_call(hover_text):
    assert "rad" in hover_text("<origin/><a/>", '<origin rp|y="0 0 0"/><a/>')


def test_hover_shows_angle_in_degrees(hover_text):
    joint = '<joint name="j" type="{}"><limit lower="{}"/><origin rpy="0 {} 1.5708"/></joint>'
    assert "-1.5708 rad = -90°" in hover_text("<!-- here -->", joint.format("revolute", "-1.57|08", "0"))
    assert "°" not in hover_text("<!-- here -->", joint.format("prismatic", "-1.57|08", "0"))
    assert "0 -0.7854 1.5708 rad = 0° -45° 90°" in hover_text("<!-- here -->", joint.format("fixed", "0", "-0.78|54"))
    assert "°" not in hover_text("<!-- here -->", joint.format("fixed", "0", "${p|i}"))


def test_completion_tables_cover_rules():
    for path, tags in CHILD_TAGS.items():
        rule = DESCRIPTION
        for tag in path.split("/"):
            rule = rule.child_rules.get(tag) or rule
        if path.startswith("ros2_control") and rule.tag == path.rpartition("/")[2]:
            assert {*rule.child_rules} <= {*tags}
    assert {*extensions(PLUGIN_GROUP)} <= {*simulator_plugins()}
    assert all(
        child.text is not None or child.children
        for plugin in simulator_plugins().values()
        for child in plugin.rule.children
    )


def test_completion_does_not_wait_for_expansion(package: Path):
    file = package / "urdf/arm.urdf.xacro"
    text = ROBOT.replace("<!-- here -->", '<gazebo reference="left_wheel"/>')
    offset = text.index("left_wheel") + 2
    workspace = Workspace([package])
    workspace.index.refresh()
    document = Document(workspace, {file: text}, file, text, waits=False)
    with pytest.raises(NotYetKnownError):
        complete(document, offset)
    waiting = [item.label for item in complete(replace(document, waits=True), offset)]
    assert waiting == [item.label for item in complete(document, offset)]
    assert not document.refreshes
    changed = text.replace('side="left"', 'side="right"')
    document = Document(workspace, {file: changed}, file, changed, waits=False)
    assert waiting == [item.label for item in complete(document, offset)]
    for refresh in document.refreshes:
        refresh()
    assert "right_wheel" in [item.label for item in complete(document, offset)]
