"""``linkwright xacro --args`` and `linkwright.xacro.arguments_of`."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import arguments_of


def listed(path, arguments=None, **options):
    return {argument.name: argument for argument in arguments_of(path, arguments, **options)}


def test_declared_arguments_are_listed(write):
    path = write(
        "a.xacro", '<xacro:arg name="x" default="1"/>\n<xacro:arg name="y" default="$(arg x)0"/><l n="$(arg y)"/>'
    )
    found = arguments_of(path)
    assert [argument.name for argument in found] == ["x", "y"]
    x, y = found
    assert (x.default, x.value, x.required, x.used, x.is_given) == ("1", "1", False, True, False)
    assert (y.default, y.value) == ("$(arg x)0", "10")
    assert (y.span.file, y.span.line, y.span.column) == ("a.xacro", 3, 18)


def test_given_argument_overrides_default(write):
    path = write("a.xacro", '<xacro:arg name="x" default="1"/><l n="$(arg x)"/>')
    x = listed(path, {"x": "5"})["x"]
    assert (x.default, x.value, x.required, x.is_given) == ("1", "5", False, True)


def test_arguments_of_nested_includes_are_listed(write):
    write("sub/b.xacro", '<xacro:arg name="b" default="1"/><xacro:include filename="../c.xacro"/>')
    write("c.xacro", '<xacro:arg name="c" default="1"/>')
    path = write("a.xacro", '<xacro:include filename="sub/b.xacro"/><xacro:arg name="a" default=""/>')
    found = listed(path)
    assert list(found) == ["b", "c", "a"]
    assert str(found["c"].span) == "sub/../c.xacro:2:18"
    assert not found["c"].used


def test_argument_used_in_root_before_declaration_is_required(write):
    path = write(
        "a.xacro",
        '<robot name="$(arg name)" xmlns:xacro="x">\n<xacro:arg name="name" default="ur"/>\n'
        '<xacro:arg name="o" default="1"/><l n="$(arg o)"/></robot>',
    )
    name, other = arguments_of(path)
    assert (name.name, name.default, name.required, name.value) == ("name", "ur", True, None)
    assert str(name.span) == "a.xacro:2:18"
    assert (other.name, other.required) == ("o", False)
    assert not listed(path, {"name": "x"})["name"].required


def test_undeclared_argument_is_required(write):
    path = write("a.xacro", '<l n="$(arg a)"/><l n="${xacro.arg(\'b\')}"/><t>$(arg a) $(arg c)</t>')
    found = listed(path)
    assert list(found) == ["a", "b", "c"]
    assert all(argument.required and argument.default is None for argument in found.values())
    assert str(found["a"].span) == "a.xacro:2:7"
    assert str(found["b"].span) == "a.xacro:2:26"
    assert str(found["c"].span) == "a.xacro:2:56"
    assert not any(argument.required for argument in arguments_of(path, {"a": "1", "b": "1", "c": "1"}))


def test_arguments_in_unused_branches_and_macros_are_listed(write):
    path = write(
        "a.xacro",
        '<xacro:arg name="arm" default="false"/>'
        '<xacro:if value="$(arg arm)"><xacro:arg name="side" default="left"/></xacro:if>'
        '<xacro:macro name="m"><xacro:arg name="in_macro" default="1"/><l n="$(arg nowhere)"/></xacro:macro>',
    )
    found = listed(path)
    assert list(found) == ["arm", "side", "in_macro"], (
        "an argument used only in a macro that is never called is not required"
    )
    assert "nowhere" in listed(path, {"nowhere": "1"})


def test_argument_value_selects_included_file(write):
    write("one.xacro", '<xacro:arg name="of_one" default=""/>')
    write("two.xacro", '<xacro:arg name="of_two" default=""/>')
    path = write("a.xacro", '<xacro:arg name="kind" default="one"/><xacro:include filename="$(arg kind).xacro"/>')
    assert list(listed(path)) == ["kind", "of_one"]
    assert list(listed(path, {"kind": "two"})) == ["kind", "of_two"]


def test_file_that_cannot_be_expanded_lists_known_arguments(write):
    write("c.xacro", '<xacro:arg name="c" default="2"/>')
    path = write(
        "a.xacro",
        """<xacro:include filename="$(arg which).xacro"/>
        <xacro:property name="y" value="${xacro.load_yaml('none.yaml')}"/><l v="${y.a}"/>
        <xacro:include filename="c.xacro"/><xacro:include filename="${y.b}"/><l n="$(arg late)"/>
        <xacro:arg name="a" default="1"/>""",
    )
    found = listed(path)
    assert list(found) == ["a", "c", "which", "late"]
    assert found["which"].required
    assert found["late"].required
    assert found["c"].default == "2"


def test_malformed_and_missing_files_are_rejected(write):
    path = write("a.xacro", "<robot><l></robot>")
    with pytest.raises(LinkwrightError):
        arguments_of(path)
    with pytest.raises(LinkwrightError):
        arguments_of("none.xacro")


def test_packages_and_text_can_be_passed(write, tmp_path):
    write("share/b.xacro", '<xacro:arg name="b" default="1"/>')
    text = '<r xmlns:xacro="x"><xacro:include filename="$(find p)/b.xacro"/></r>'
    assert list(listed("new.xacro", text=text, packages={"p": str(tmp_path / "share")})) == ["b"]


LIST = """\
name    required   a.xacro:2:18  used before its default "ur" is declared
size    "1"        b.xacro:2:18  given "3"
double  "$(arg size)0"  b.xacro:3:18  which is "30"
idle    ""         b.xacro:4:18  not used
need    required   a.xacro:4:9  not declared
"""


@pytest.fixture
def robot(write):
    write(
        "b.xacro",
        '<xacro:arg name="size" default="1"/>\n<xacro:arg name="double" default="$(arg size)0"/>\n'
        '<xacro:arg name="idle" default=""/><l n="$(arg double)"/>',
    )
    return write(
        "a.xacro",
        '<robot name="$(arg name)" xmlns:xacro="x">\n<xacro:arg name="name" default="ur"/>\n'
        '<xacro:include filename="b.xacro"/>\n<l n="x_$(arg need)"/></robot>',
    )


def test_args_option_prints_list(robot, run):
    result = run("--args", str(robot), "size:=3", "siz:=4")
    assert result.status == 0
    assert [line.split() for line in result.out.splitlines()] == [line.split() for line in LIST.splitlines()]
    assert result.err == (
        "warning[XAC215]: the argument 'siz' is given, but 'a.xacro' does not use it\n   = hint: did you mean 'size'?\n"
    )
    assert run("--args", str(robot), "size:=3", "siz:=4", "-q").err == ""


def test_args_option_prints_json(robot, run):
    result = run("--args", str(robot), "--format", "json")
    first, *_, last = json.loads(result.out)["arguments"]
    assert first == {
        "name": "name",
        "default": "ur",
        "value": None,
        "required": True,
        "used": True,
        "given": False,
        "file": "a.xacro",
        "line": 2,
        "column": 18,
    }
    assert (last["name"], last["default"], last["required"]) == ("need", None, True)


def test_incomplete_list_is_reported_with_warning(write, run):
    write("a.xacro", '<xacro:include filename="$(arg which).xacro"/>')
    result = run("--args", "a.xacro")
    assert result.status == 0
    assert result.out.startswith("which  required")
    assert result.err.startswith(
        "warning[XAC803]: the list of arguments may be incomplete because the file cannot be expanded with the "
        "arguments given"
    )
    assert "hint: pass which:=..." in result.err


def test_hint_names_argument_that_leads_to_missing_file(write, run):
    write(
        "a.xacro",
        '<xacro:arg name="kind" default="k5"/><xacro:arg name="other" default="o"/>'
        '<xacro:arg name="path" default="$(arg kind)/part.xacro"/><xacro:include filename="$(arg path)"/>'
        '<link name="$(arg name)"/><xacro:arg name="name" default="r"/>',
    )
    assert run("--args", "a.xacro").err.endswith("hint: pass kind:=...\n")


def test_list_is_written_to_output_file(write, run):
    write("a.xacro", "<l/>")
    assert run("--args", "a.xacro").out == "the file has no arguments\n"
    assert run("--args", "a.xacro", "-o", "list.txt").out == ""
