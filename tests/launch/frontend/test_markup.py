"""XML and YAML launch files: the resulting actions, and the messages about errors."""

from __future__ import annotations

import io
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from launch.invalid_launch_file_error import InvalidLaunchFileError
from launch.utilities import perform_substitutions
from launch_xml import Entity as XmlEntity

from launch import Action, LaunchContext, LaunchDescription, actions
from launch.frontend import Entity, Parser, expose_action
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.frontend.launch_file import load_launch_file


def parse(text: str) -> LaunchDescription:
    root, parser = Parser.load(io.StringIO(dedent(text)))
    return parser.parse_description(root)


XML = """
    <launch>
      <arg name="model" default="a$(env NOPE '')" description="the model"><choice value="a"/><choice value="b"/></arg>
      <let name="x" value="$(var model)1"/>
      <group scoped="false" unless="$(var skip)"><set_env name="A" value="1"/><unset_env name="B"/></group>
      <reset><keep name="x" value="$(var x)"/></reset>
      <executable cmd="ls -l '$(var x) y'z" cwd="/" name="my_ls" shell="true" output="log" respawn="true"
          respawn_delay="1.5" respawn_max_retries="2" sigkill_timeout="4.0" emulate_tty="1" launch-prefix="nice"
          on_exit="shutdown"><env name="var" value="1"/></executable>
      <timer period="1.5" cancel_on_shutdown="false"><log level="warning" message="m"/></timer>
      <include file="$(dirname)/other.launch.py"><arg name="a" value="b"/></include>
      <append_env name="P" value="q" prepend="true" separator="|"/>
      <for len="2" name="i"><log_info message="$(index i)"/></for>
      <shutdown reason="enough"/>
    </launch>
"""
YAML = """
    launch:
    - arg:
        name: model
        default: a$(env NOPE '')
        description: the model
        choice: [{value: a}, {value: b}]
    - let: {name: x, value: $(var model)1}
    - group:
        scoped: false
        unless: $(var skip)
        children:
        - set_env: {name: A, value: '1'}
        - unset_env: {name: B}
    - reset:
        keep: [{name: x, value: $(var x)}]
    - executable:
        cmd: ls -l '$(var x) y'z
        cwd: /
        name: my_ls
        shell: true
        output: log
        respawn: true
        respawn_delay: 1.5
        respawn_max_retries: 2
        sigkill_timeout: 4.0
        emulate_tty: true
        launch-prefix: nice
        on_exit: shutdown
        env: [{name: var, value: '1'}]
    - timer:
        period: 1.5
        cancel_on_shutdown: false
        children:
        - log: {level: warning, message: m}
    - include:
        file: $(dirname)/other.launch.py
        arg: [{name: a, value: b}]
    - append_env: {name: P, value: q, prepend: true, separator: '|'}
    - for:
        len: '2'
        name: i
        children:
        - log_info: {message: $(index i)}
    - shutdown: {reason: enough}
"""


@pytest.mark.parametrize("text", [XML, YAML], ids=["xml", "yaml"])
def test_xml_and_yaml_files_create_same_actions(text: str) -> None:
    entities = parse(text).entities
    context = LaunchContext()
    argument, let, group, reset, executable, timer, include, append, loop, shutdown = entities
    assert argument.name == "model"
    assert argument.choices == ["a", "b"]
    assert argument.description == "the model Valid choices are: ['a', 'b']".replace("model V", "model. V")
    argument.visit(context)
    let.visit(context)
    assert context.launch_configurations["x"] == "a1"
    context.launch_configurations["skip"] = "true"
    assert group.visit(context) is None
    context.launch_configurations["skip"] = "0"
    assert [type(action).__name__ for action in group.visit(context)] == [
        "SetEnvironmentVariable",
        "UnsetEnvironmentVariable",
    ]
    reset.visit(context)
    assert context.launch_configurations == {"x": "a1"}
    assert [perform_substitutions(context, word) for word in executable.cmd] == ["ls", "-l", "a1 yz"]
    assert executable.shell is True
    assert executable.emulate_tty is True
    assert executable.sigkill_timeout[0].perform(context) == "4.0"
    assert [perform_substitutions(context, part) for part in executable.additional_env[0]] == ["var", "1"]
    assert isinstance(executable.get_sub_entities()[0], actions.Shutdown)
    assert timer.period == 1.5
    assert perform_substitutions(context, timer.actions[0].level) == "warning"
    assert [perform_substitutions(context, part) for part in include.launch_arguments[0]] == ["a", "b"]
    assert append.prepend is True
    assert perform_substitutions(context, loop.length) == "2"
    assert shutdown.event.reason


def test_newer_yaml_shorthand_is_accepted() -> None:
    description = parse(
        """
        launch:
        - arg: {name: kind, default: b, choices: [a, b]}
        - let: {name: number, value: 3.5}
        - let: {name: truth, value: yes}
        - group: {if: false, children: [let: {name: never, value: x}]}
        - include: other.launch.py
        """
    )
    argument, number, truth, group, include = description.entities
    context = LaunchContext()
    assert argument.choices == ["a", "b"]
    assert [perform_substitutions(context, action.value) for action in (number, truth)] == ["3.5", "true"]
    assert group.visit(context) is None
    assert "other.launch.py" in include.launch_description_source.location


def test_custom_tag_reads_typed_attributes() -> None:
    attributes: dict[str, Any] = {}

    @expose_action("spin_around")
    class SpinAround(Action):
        @classmethod
        def parse(cls, entity: Entity, parser: Parser) -> Any:
            _, kwargs = super().parse(entity, parser)
            attributes["times"] = entity.get_attr("times", data_type=int, can_be_str=False)
            attributes["list"] = entity.get_attr("speeds", data_type=list[float], optional=True)
            attributes["axis"] = [axis.get_attr("name") for axis in entity.get_attr("axis", data_type=list[Entity])]
            return cls, kwargs

    inside = '<axis name="x"/><axis name="y"/>'
    parse(f'<launch><spin_around times="3" speeds="1.0;2.5" speeds-sep=";">{inside}</spin_around></launch>')
    assert attributes == {"times": 3, "list": [1.0, 2.5], "axis": ["x", "y"]}
    with pytest.raises(TypeError, match="times"):
        parse('<launch><spin_around times="$(var a)"><axis name="x"/></spin_around></launch>')


def test_duplicate_tag_name_is_rejected() -> None:
    def reads(entity: Entity, parser: Parser) -> Any:
        raise AssertionError

    with pytest.raises(RuntimeError, match=r"Two action parsing methods exposed with the same name: \[let\]"):
        expose_action("let")(reads)
    with pytest.raises(RuntimeError, match="is not a callable or a class containing a parse method"):
        expose_action("five")(5)


def test_xml_entity_accepts_elementtree_element() -> None:
    from xml.etree import ElementTree as ET

    tag = XmlEntity(ET.fromstring('<root><tag attr="1, 2, 3" attr-sep=", "/></root>')).children[0]
    assert tag.get_attr("attr", data_type=list[int]) == [1, 2, 3]
    assert tag.get_attr("nope", optional=True) is None


CASES = [
    (
        '<launch>\n <argg name="x"/></launch>',
        "LAUNCH115",
        (2, 2),
        "no action has the tag 'argg'",
        "did you mean 'arg'?",
    ),
    ('<launch><arg nam="x"/></launch>', "LAUNCH117", (1, 9), "'arg' needs an attribute 'name'", "instead of 'nam'"),
    ('<launch><arg name="x" defalt="2"/></launch>', "LAUNCH116", (1, 23), "no attribute 'defalt'", "mean 'default'?"),
    ('<launch><let name="a" value="b$(vr x)"/></launch>', "LAUNCH119", (1, 31), "substitution 'vr'", "mean 'var'?"),
    ('<launch><group scoped="maybe"/></launch>', "LAUNCH118", (1, 24), "'maybe', which is not a boolean", None),
    ('<launch><executable cmd="ls"><what/></executable></launch>', "LAUNCH116", (1, 30), "no element 'what'", None),
    ('<launch><log level="lod" message="a"/></launch>', "LAUNCH150", (1, 21), "no log level 'lod'", None),
    ("<lunch/>", "LAUNCH109", (1, 1), "must be 'launch', not 'lunch'", None),
    ('<launch>\n<arg name="x">\n</launch>', "XML", (3, 1), "", None),
    ("launch:\n- arg: {nam: x}\n", "LAUNCH117", (2, 3), "'arg' needs an attribute 'name'", "instead of 'nam'"),
    ("launch:\n- arg: {name: x, defalt: y}\n", "LAUNCH116", (2, 18), "'arg' has no key 'defalt'", "'default'?"),
    ("launch:\n- arg:\n    name: x\n   default: 3\n", "LAUNCH108", (4, 4), "is not valid YAML", None),
    (
        "launch:\n- let: {name: a, value: []}\n",
        "LAUNCH118",
        (2, 18),
        "'value' of 'let' is [], which is not a string",
        None,
    ),
    ("launch:\n- arg: {name: a, choices: [b, 3]}\n", "LAUNCH118", (2, 3), "'choices' of 'arg' must be a list", None),
    ("launch:\n- let: {name: a, value: '$(vr x)'}\n", "LAUNCH119", (2, 26), "substitution 'vr'", "mean 'var'?"),
    ("launch:\n- arg: {name: a}\n  let: {name: b}\n", "LAUNCH118", (2, 3), "a mapping with one key", None),
    ("launch:\n- arg: 3\n", "LAUNCH118", (2, 3), "'arg' must be a mapping of attributes", None),
    ("launch: 3\n", "LAUNCH118", (1, 1), "must be a mapping of attributes", None),
    ("a: 1\nb: 2\n", "LAUNCH109", (1, 1), "single key 'launch'", None),
]


@pytest.mark.parametrize(("text", "code", "place", "message", "hint"), CASES, ids=[case[0][:40] for case in CASES])
def test_errors_have_location_and_hint(
    text: str, code: str, place: tuple[int, int], message: str, hint: str | None
) -> None:
    with pytest.raises(LinkwrightError) as raised:
        parse(text)
    diagnostic = raised.value.diagnostics[0]
    assert diagnostic.code.startswith(code)
    assert diagnostic.span is not None
    assert (diagnostic.span.line, diagnostic.span.column) == place
    assert message in diagnostic.message
    if hint:
        assert hint in (diagnostic.hint or "")


def test_independent_errors_are_reported_together() -> None:
    with pytest.raises(LinkwrightError) as raised:
        parse('<launch><argg name="x"/><let nam="a"/></launch>')
    assert [diagnostic.code for diagnostic in raised.value.diagnostics] == ["LAUNCH115", "LAUNCH117"]


def test_markup_errors_have_documented_exception_types() -> None:
    for text, kind, words in (
        ("<launch><argg/></launch>", RuntimeError, "Unrecognized entity of the type: argg"),
        ('<launch><arg nam="x"/></launch>', AttributeError, "Attribute 'name' of type"),
        ('<launch><arg name="x" wat="2"/></launch>', ValueError, "'wat'"),
        ("<lunch/>", RuntimeError, "Expected 'launch' as root tag"),
        ("<launch><arg></launch>", InvalidLaunchFileError, "syntax error"),
    ):
        with pytest.raises(kind, match=words):
            parse(text)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.launch.xml", "<launch/>"),
        ("a.xml", "<launch/>"),
        ("a.launch", "<launch/>"),
        ("a.launch.yaml", "launch: []"),
        ("a_launch.yml", "launch: []"),
        ("a.launch.py", "from launch import LaunchDescription as L\ndef generate_launch_description(): return L()"),
        ("a", "<launch/>"),
        ("b", "from launch import LaunchDescription as L\ndef generate_launch_description(): return L()"),
    ],
)
def test_file_type_is_detected_by_name_or_content(write: Any, name: str, text: str) -> None:
    assert load_launch_file(write(name, text)).entities == []


def test_file_of_unknown_type_is_rejected(write: Any) -> None:
    with pytest.raises(InvalidLaunchFileError) as raised:
        load_launch_file(write("notes", "what is this"))
    assert raised.value.diagnostics[0].code == "LAUNCH107"  # type: ignore[attr-defined]


def test_missing_file_raises_file_not_found(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load_launch_file(tmp_path / "no.launch.xml")


def test_warning_names_file_and_line(tmp_path: Path) -> None:
    file = tmp_path / "old.launch.xml"
    file.write_text('<launch>\n  <log message="m"/>\n</launch>\n')
    root, parser = Parser.load(str(file))
    with pytest.warns(UserWarning, match="The action log now expects a log level") as warned:
        parser.parse_description(root)
    assert (warned[0].filename, warned[0].lineno) == (str(file), 2)
