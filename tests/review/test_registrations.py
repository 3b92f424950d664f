"""The lines of a review about classes and nodes that sources register for programs which load them by name."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
GAZEBO = """#include "spring.hh"
void Spring::Configure(const Entity & entity) { x = 1; }
GZ_ADD_PLUGIN(Spring, gz::sim::System, Spring::ISystemConfigure)
GZ_ADD_PLUGIN_ALIAS(Spring, "arm::Spring", "Spring2")
"""
CLASSIC = '#include "spring.hh"\nvoid Foo::Load() { x = 1; }\nGZ_REGISTER_MODEL_PLUGIN(Foo)\n'
PLUGIN = '#include "foo.hpp"\nint Foo::run() { return 1; }\nPLUGINLIB_EXPORT_CLASS(arm::Foo, base::System)\n'
TREE = """#include "foo.hpp"
int Foo::run() { return 1; }
BT_REGISTER_NODES(factory)
{
  factory.registerNodeType<arm::Foo>("Foo", 1);
  factory.registerSimpleCondition("IsNear", std::bind(isNear));
  BT::NodeBuilder builder = [](const std::string & name, const BT::NodeConfig & config) { return make(name); };
  factory.registerBuilder<arm::Bar>("Bar", builder);
}
CreateRosNodePlugin(arm::Baz, "Baz");
"""
WORLD = """<sdf version="1.9"><world name="w">
  <!-- <plugin name="Spring2" filename="spring"/> -->
  <plugin filename="spring" name="arm::Spring"/>
</world></sdf>
"""
DESCRIPTION = (
    '<library path="foo">\n  <class name="arm/Foo" type="arm::Foo" base_class_type="base::System"/>\n</library>\n'
)
TREE_FILE = """<root BTCPP_format="4"><BehaviorTree ID="Main">
  <Sequence><Foo goal="1"/>
    <Condition ID="IsNear"/></Sequence>
</BehaviorTree></root>
"""


@pytest.fixture
def review_source(repository, compare):
    """Review another text of a source beside other files, and return the sentences and the breaking ones."""

    def run(old, new, files=()):
        repository.commit({**MANIFEST, **dict(files), "arm/src/source.cpp": old})
        repository.write({"arm/src/source.cpp": new})
        result = compare(repository)
        return [sentence for subject in result.subjects for sentence in sentences(subject)], breaking(result)

    return run


def test_renamed_plugin_of_gazebo_is_breaking_with_the_world_that_loads_it(review_source):
    lines, broken = review_source(GAZEBO, GAZEBO.replace('"arm::Spring"', '"arm::Coil"'), {"arm/w.sdf": WORLD})
    assert (
        lines
        == broken
        == [
            "plugin of Gazebo 'arm::Spring' renamed to 'arm::Coil'",
            "names 'arm::Spring', which no source registers any more",
        ]
    )


def test_removed_plugin_of_gazebo_is_breaking(review_source):
    _, broken = review_source(GAZEBO, GAZEBO.partition("GZ_")[0])
    assert broken == ["plugins of Gazebo removed: 'arm::Spring', 'Spring2'"]


def test_class_of_gazebo_may_have_another_name_behind_its_alias(review_source):
    _, broken = review_source(GAZEBO, GAZEBO.replace("(Spring,", "(Coil,").replace("Spring::", "Coil::", 1))
    assert not broken


@pytest.mark.parametrize(
    ("new", "broken"),
    [
        (CLASSIC.replace("GZ_REGISTER_MODEL_PLUGIN(Foo)\n", ""), ["plugins of Gazebo Classic removed: 'Foo'"]),
        (CLASSIC.replace("Foo", "Motor"), []),  # worlds name the library
    ],
)
def test_plugin_of_gazebo_classic_is_its_library(review_source, new, broken):
    assert review_source(CLASSIC, new)[1] == broken


@pytest.mark.parametrize("macro", ["PLUGINLIB_EXPORT_CLASS", "CLASS_LOADER_REGISTER_CLASS"])
@pytest.mark.parametrize("new", [PLUGIN.partition("PLUGINLIB")[0], PLUGIN.replace("arm::Foo", "arm::Bar")])
def test_class_that_a_plugin_description_declares_must_be_exported(review_source, macro, new):
    old, new = (text.replace("PLUGINLIB_EXPORT_CLASS", macro) for text in (PLUGIN, new))
    _, broken = review_source(old, new, {"arm/plugins.xml": DESCRIPTION})
    assert broken == ["names 'arm::Foo', which no source registers any more"]


@pytest.mark.parametrize(
    "new",
    [
        "namespace arm {\n" + PLUGIN.replace("arm::Foo", "Foo") + "}\n",
        PLUGIN.replace("PLUGINLIB_EXPORT_CLASS(arm::Foo, base::System)", "REGISTER_OWN_WAY(Foo)"),
    ],
)
def test_class_that_is_registered_otherwise_is_not_lost(review_source, new):
    assert not review_source(PLUGIN, new, {"arm/plugins.xml": DESCRIPTION})[1]


def test_removed_nodes_of_behavior_trees_are_breaking_with_the_trees_that_use_them(review_source):
    new = TREE.replace('"Foo"', '"Grasp"').replace('"IsNear"', '"IsFar"').replace('"Baz"', '"Turn"')
    _, broken = review_source(TREE, new.replace('"Bar"', '"Wait"'), {"arm/trees/main.xml": TREE_FILE})
    assert len([line for line in broken if "of behavior trees" in line]) >= 1
    assert [line for line in broken if line.startswith("names")] == [
        "names 'Foo', which no source registers any more",
        "names 'IsNear', which no source registers any more",
    ]


def test_unchanged_registrations_are_no_change(review_source):
    lines, _ = review_source(TREE, TREE.replace("return 1;", "return f(1);"), {"arm/trees/main.xml": TREE_FILE})
    assert lines == ["in 'Foo::run()': `return 1` -> `return f(1)`"]


@pytest.mark.parametrize(
    ("lost", "expected"),
    [("nav_core", ["class for pluginlib 'arm::Planner': base classes mbf::Planner, nav_core::Planner -> mbf::Planner"]),
     ("", [])],
)  # fmt: skip
def test_a_class_that_is_no_longer_exported_for_a_base_class_is_breaking(repository, compare, lost, expected):
    export = "PLUGINLIB_EXPORT_CLASS(arm::Planner, {}::Planner)\n"
    text = export.format("nav_core") + export.format("mbf")
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/a.cpp": text})
    repository.write({"arm/a.cpp": text.replace(export.format(lost), "") + "// planner\n"})
    assert breaking(compare(repository)) == expected


@pytest.mark.parametrize(("left", "is_lost"), [("", True), ("EXPORT_BOTH(Foo, Planner)\n", False)])
def test_a_description_that_declares_a_lost_base_class_is_named(review_source, left, is_lost):
    export = "PLUGINLIB_EXPORT_CLASS(arm::Foo, mbf::Planner)\n"
    description = DESCRIPTION.replace("base::System", "mbf::Planner")
    _, broken = review_source(PLUGIN + export, PLUGIN + left, {"arm/foo.xml": description})
    line = "declares 'arm::Foo' for 'mbf::Planner', for which no source exports it any more"
    assert (line in broken) is is_lost


PORTS = """#include "hover.hpp"
class Hover : public BT::StatefulActionNode {
 public:
  static BT::PortsList providedPorts() {
    return providedBasicPorts({
      BT::InputPort<double>("minimum_distance", 0.0, "Distance"),
      BT::OutputPort<std::vector<int>>("error"), BT::InputPort("goal")});
  }
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("minimum_distance", "minimum_radius",
         "port of behavior trees 'minimum_distance' renamed to 'minimum_radius'"),
        (', BT::InputPort("goal")', "", "ports of behavior trees removed: 'goal'"),
        ('("goal")', '("goal"), BT::InputPort("path")', None),
        ('"Distance"', '"Least distance"', None),
    ],
)  # fmt: skip
def test_ports_of_nodes_of_behavior_trees_are_names(review_source, old, new, expected):
    assert old in PORTS
    _, broken = review_source(PORTS, PORTS.replace(old, new))
    assert broken == ([expected] if expected else [])
