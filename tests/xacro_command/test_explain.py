"""``linkwright xacro --explain``, `linkwright.xacro.explain` and `Expansion.provenance`."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import expand, explain


@pytest.fixture
def robot(write):
    write(
        "wheel.xacro",
        """<xacro:property name="width" value="0.02"/>
<xacro:macro name="wheel" params="side y tint:=grey *place">
  <link name="${side}_wheel">
    <cylinder radius="${radius}" length="${width}" fixed="1"/><material name="${tint}"/>
    <note>the ${side} one</note>
  </link>
  <joint name="${side}_joint">
    <xacro:insert_block name="place"/><parent link="$(arg prefix)base"/>
    <xacro:if value="1"><xacro:attribute name="extra" value="${y}"/></xacro:if>
  </joint>
</xacro:macro>""",
    )
    return write(
        "a.xacro",
        """<xacro:arg name="prefix" default="my_"/>
<xacro:property name="radius" value="0.05"/>
<xacro:property name="diameter" value="${2*radius}"/>
<xacro:include filename="wheel.xacro"/>
<xacro:wheel side="left" y="${diameter}"><origin xyz="0 ${diameter} 0"/></xacro:wheel>""",
    )


def explain_one(path, name, *explain_options, **options):
    (found,) = explain(path, name, *explain_options, **options)
    return found


def facts(value):
    return value.name, value.kind, value.value, str(value.span) if value.span else None, value.written


def attributes(found):
    return {f"{part.element.tag}.{attribute.name}": attribute for part in found.walk() for attribute in part.attributes}


def test_explain_shows_location_and_macro_calls(robot):
    found = explain_one(robot, "left_wheel")
    assert str(found.span) == "wheel.xacro:4:3"
    (call,) = found.calls
    assert (call.macro, str(call.span)) == ("wheel", "a.xacro:6:1")
    assert [facts(value) for value in call.parameters] == [
        ("side", "parameter", "'left'", "a.xacro:6:20", "left"),
        ("y", "parameter", "0.1", "a.xacro:6:29", "${diameter}"),
        ("tint", "parameter", "'grey'", "wheel.xacro:3:48", "grey"),
    ]


def test_explain_shows_attributes_and_values(robot):
    found = attributes(explain_one(robot, "left_wheel"))
    name = found["link.name"]
    assert (name.value, name.written, str(name.span)) == ("left_wheel", "${side}_wheel", "wheel.xacro:4:15")
    assert [facts(value) for value in found["cylinder.radius"].values] == [
        ("radius", "property", "0.05", "a.xacro:3:38", "0.05")
    ]
    fixed = found["cylinder.fixed"]
    assert (fixed.value, fixed.written, str(fixed.span), fixed.values) == ("1", "1", "wheel.xacro:5:59", ())


def test_explain_shows_text_content(robot):
    *_, note = explain_one(robot, "left_wheel").children
    (text,) = note.texts
    assert (text.value, text.written, str(text.span)) == ("the left one", "the ${side} one", "wheel.xacro:6:11")
    assert [value.name for value in text.values] == ["side"]


def test_block_keeps_location_and_values_of_caller(robot):
    origin, parent = explain_one(robot, "left_joint").children
    assert str(origin.span) == "a.xacro:6:42"
    assert [facts(value) for value in origin.attributes[0].values] == [
        ("diameter", "property", "0.1", "a.xacro:4:40", "${2*radius}")
    ]
    (value,) = parent.attributes[0].values
    assert facts(value) == ("$(arg prefix)", "argument", "'my_'", "a.xacro:2:35", "my_")


def test_given_argument_has_no_location(robot):
    parent = explain_one(robot, "left_joint", {"prefix": "his_"}).children[1]
    (value,) = parent.attributes[0].values
    assert facts(value) == ("$(arg prefix)", "argument", "'his_'", None, None)


def test_attribute_set_by_xacro_attribute_tag_is_traced(robot):
    extra = attributes(explain_one(robot, "left_joint"))["joint.extra"]
    assert (extra.value, extra.written, str(extra.span)) == ("0.1", "${y}", "wheel.xacro:10:62")
    assert [value.name for value in extra.values] == ["y"]


def test_provenance_of_expanded_element_matches_explain(robot):
    expansion = expand(robot)
    link = next(expansion.document.root.elements("link"))
    found, explanation = expansion.provenance(link), explain_one(robot, "left_wheel")
    assert (found.span, found.calls, found.attributes) == (explanation.span, explanation.calls, explanation.attributes)
    cylinder = next(link.elements("cylinder"))
    assert expansion.provenance(cylinder).calls == expansion.provenance(link).calls


def test_provenance_rejects_changed_file(robot):
    expansion = expand(robot)
    link = next(expansion.document.root.elements("link"))
    robot.write_text(robot.read_text().replace('side="left"', 'side="right"'))
    with pytest.raises(LinkwrightError, match="does not match the expansion of"):
        expansion.provenance(link)


def test_nested_calls_and_includes_are_traced(write):
    write("c.xacro", '<link name="deep_${x}"/>')
    write("b.xacro", '<xacro:macro name="in" params="x"><xacro:include filename="c.xacro"/></xacro:macro>')
    path = write(
        "a.xacro",
        """<xacro:include filename="b.xacro" ns="B"/>
<xacro:macro name="out" params="y:=^|1"><xacro:call macro="B.in" x="${y+1}"/></xacro:macro>
<xacro:out/>""",
    )
    found = explain_one(path, "deep_2")
    assert [(call.macro, str(call.span)) for call in found.calls] == [
        (None, "b.xacro:2:35"),
        ("in", "a.xacro:3:41"),
        ("out", "a.xacro:4:1"),
    ]
    assert [facts(value) for value in found.calls[1].parameters] == [("x", "parameter", "2", "a.xacro:3:69", "${y+1}")]
    assert [facts(value) for value in found.calls[2].parameters] == [("y", "parameter", "1", "a.xacro:3:38", "1")]


def test_property_values_are_those_at_evaluation(write):
    path = write(
        "a.xacro",
        """<xacro:property name="n" value="1"/><link name="l1" v="${n}"/>
<xacro:property name="n" value="2"/><link name="l2" v="${n}"/>
<xacro:property name="n" remove="true"/><xacro:property name="n" default="3"/><link name="l3" v="${n}"/>""",
    )
    for name, value, place in (("l1", "1", "a.xacro:2:33"), ("l2", "2", "a.xacro:3:33"), ("l3", "3", "a.xacro:4:75")):
        (found,) = attributes(explain_one(path, name))["link.v"].values
        assert (found.value, str(found.span)) == (value, place)


def test_keys_and_namespaces_are_traced_and_functions_are_not(write, tmp_path):
    (tmp_path / "v.yaml").write_text("arm: {length: [1, 2]}\n")
    write("b.xacro", '<xacro:property name="p" value="7"/>')
    path = write(
        "a.xacro",
        """<xacro:include filename="b.xacro" ns="N"/>
<xacro:property name="cfg" value="${xacro.load_yaml('v.yaml')}"/>
<link name="l" a="${cfg.arm['length'][0]*N.p}" b="${sin(pi)}" c="${[i*N.p for i in cfg.arm.length]}"
 d="${'x'.join(['a']).upper()}"/>""",
    )
    found = attributes(explain_one(path, "l"))
    assert [(value.name, value.value) for value in found["link.a"].values] == [
        ("cfg.arm['length'][0]", "1"),
        ("N.p", "7"),
    ]
    assert str(found["link.a"].values[1].span) == "b.xacro:2:33"
    assert found["link.b"].values == ()
    assert [value.name for value in found["link.c"].values] == ["N.p", "cfg.arm.length"]
    assert found["link.d"].values == ()


def test_packages_and_environment_variables_are_traced(write, tmp_path, monkeypatch):
    monkeypatch.setenv("LENGTH", "3")
    path = write("a.xacro", '<link name="l" a="$(find p)/x" b="$(env LENGTH)" c="$(optenv NONE 4)"/>')
    found = attributes(explain_one(path, "l", packages={"p": "/share/p"}))
    assert facts(found["link.a"].values[0]) == ("$(find p)", "package", "'/share/p'", None, None)
    assert facts(found["link.b"].values[0]) == ("$(env LENGTH)", "variable", "'3'", None, None)
    assert facts(found["link.c"].values[0])[2] == "'4'"


def test_properties_set_in_outer_scopes_are_traced(write):
    path = write(
        "a.xacro",
        """<xacro:macro name="m"><xacro:property name="g" value="1" scope="global"/>
<xacro:property name="p" value="${g+1}" scope="parent"/></xacro:macro>
<xacro:m/><link name="l" g="${g}" p="${p}"/>""",
    )
    found = attributes(explain_one(path, "l"))
    assert str(found["link.g"].values[0].span) == "a.xacro:2:55"
    assert facts(found["link.p"].values[0]) == ("p", "property", "2", "a.xacro:3:33", "${g+1}")


def test_elements_with_evaluated_tag_are_traced(write):
    path = write("a.xacro", '<xacro:property name="t" value="link"/><xacro:element xacro:name="${t}" name="l${1+1}"/>')
    found = explain_one(path, "l2")
    assert found.element.tag == "link"
    assert found.attributes[0].written == "l${1+1}"


def test_nested_elements_are_found_by_name(write):
    path = write("a.xacro", '<gazebo><plugin name="p"/><plugin name="p"/></gazebo>')
    assert [found.element.tag for found in explain(path, "p")] == ["plugin", "plugin"]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("left_whel", "did you mean 'left_wheel'?"),
        ("zz", "there are 2 links and joints, such as left_wheel, left_joint"),
    ],
)
def test_unknown_name_has_suggestion(robot, run, name, hint):
    result = run("--explain", name, str(robot))
    assert result.status == 1
    assert result.err == (
        f"error[XAC801]: the expansion of 'a.xacro' has no link or joint named '{name}'\n   = hint: {hint}\n"
    )


def test_expansion_error_is_reported(write, run):
    write("a.xacro", '<link name="${no}"/>')
    result = run("--explain", "l", "a.xacro")
    assert result.status == 1
    assert "XAC201" in result.err


STORY = """\
<joint extra="0.1" name="left_joint">
  <origin xyz="0 0.1 0"/>
  <parent link="my_base"/>
</joint>

written at wheel.xacro:8:3
  in macro 'wheel' called at a.xacro:6:1
      side = 'left'  (parameter a.xacro:6:20)
      y    = 0.1     (parameter a.xacro:6:29 "${diameter}")
      tint = 'grey'  (parameter wheel.xacro:3:48)

<joint> at wheel.xacro:8:3
  name="left_joint" from "${side}_joint"
    side = 'left'  (parameter a.xacro:6:20)
  extra="0.1" set by <xacro:attribute> at wheel.xacro:10:62 from "${y}"
    y = 0.1  (parameter a.xacro:6:29 "${diameter}")
<origin> at a.xacro:6:42
  xyz="0 0.1 0" from "0 ${diameter} 0"
    diameter = 0.1  (property a.xacro:4:40 "${2*radius}")
<parent> at wheel.xacro:9:39
  link="my_base" from "$(arg prefix)base"
    $(arg prefix) = 'my_'  (argument a.xacro:2:35)
"""


def test_explain_option_prints_text(robot, run):
    result = run("--explain", "left_joint", str(robot))
    assert (result.status, result.err) == (0, "")
    assert result.out == STORY


def test_explain_option_prints_json(robot, run):
    result = run("--explain", "left_wheel", str(robot), "--format", "json")
    (element,) = json.loads(result.out)["elements"]
    assert (element["tag"], element["file"], element["line"], element["column"]) == ("link", "wheel.xacro", 4, 3)
    assert element["calls"][0]["macro"] == "wheel"
    assert element["calls"][0]["parameters"][1]["written"] == "${diameter}"
    assert element["children"][2]["texts"][0]["value"] == "the left one"
    assert element["attributes"][0]["values"][0]["name"] == "side"


def test_unsaved_text_can_be_explained(write):
    text = '<robot xmlns:xacro="x"><xacro:property name="p" value="1"/><link name="l" a="${p}">t${p}</link></robot>'
    found = explain_one("new.xacro", "l", text=text)
    assert (found.texts[0].written, found.texts[0].value) == ("t${p}", "t1")
    assert found.attributes[1].values[0].value == "1"
    expansion = expand("new.xacro", text=text)
    assert expansion.provenance(expansion.document.root).children[0].texts == found.texts
