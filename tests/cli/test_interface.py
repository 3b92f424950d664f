"""``linkwright interface``: types of Linkwright and of the workspace, without a build."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.cli.interface import find_nested_type, format_definition

DEFINITIONS = {
    "p/msg/Short": "# A short type\n# A constant\nbool BOOL_CONST=true # one\n\nbool value\nbool[<=3] values # two\n",
    "p/msg/Nested": '# Nested\nShort short # inside\nstring text "a # b"\n# End\n',
    "p/srv/Ask": "Nested[] n\n---\nstd_msgs/Header header\nHeader other\n",
    "std_msgs/msg/Header": "# stamp\nstring frame_id\n",
}


def interface_lines(name: str, **options: bool) -> list[str]:
    return list(format_definition(name, DEFINITIONS.__getitem__, **options))


def test_nested_definitions_are_indented_without_comments():
    assert interface_lines("p/msg/Nested") == [
        "# Nested",
        "Short short # inside",
        "\tbool BOOL_CONST=true",
        "\tbool value",
        "\tbool[<=3] values",
        'string text "a # b"',
        "# End",
    ]


def test_nested_comments_are_shown_with_option():
    assert interface_lines("p/msg/Nested", nested_comments=True) == [
        "# Nested",
        "Short short # inside",
        "\t# A short type",
        "\t# A constant",
        "\tbool BOOL_CONST=true # one",
        "",
        "\tbool value",
        "\tbool[<=3] values # two",
        'string text "a # b"',
        "# End",
    ]


def test_comments_can_be_omitted():
    assert interface_lines("p/msg/Nested", comments=False) == [
        "Short short",
        "\tbool BOOL_CONST=true",
        "\tbool value",
        "\tbool[<=3] values",
        'string text "a # b"',
    ]


def test_service_definition_expands_arrays_and_headers():
    assert interface_lines("p/srv/Ask", comments=False) == [
        "Nested[] n",
        "\tShort short",
        "\t\tbool BOOL_CONST=true",
        "\t\tbool value",
        "\t\tbool[<=3] values",
        '\tstring text "a # b"',
        "---",
        "std_msgs/Header header",
        "\tstring frame_id",
        "Header other",
        "\tstring frame_id",
    ]


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("uint8 x", None),
        ("string<=5[<=2] x", None),
        ("uint8 CONSTANT=3", None),
        ("---", None),
        ("# Short x", None),
        ("geometry_msgs/Point[4] corners", "geometry_msgs/msg/Point"),
        ("geometry_msgs/msg/Point p", "geometry_msgs/msg/Point"),
    ],
)
def test_nested_type_is_found_in_definition_line(line, found):
    assert find_nested_type(line, "p") == found


def run_command(capsys, *words: str, status: int = 0) -> tuple[str, str]:
    assert main(["interface", *words]) == status
    captured = capsys.readouterr()
    return captured.out, captured.err


def test_show_prints_definition(capsys):
    assert run_command(capsys, "show", "geometry_msgs/msg/Twist", "--no-comments")[0].splitlines() == [
        "Vector3 linear",
        "\tfloat64 x",
        "\tfloat64 y",
        "\tfloat64 z",
        "Vector3 angular",
        "\tfloat64 x",
        "\tfloat64 y",
        "\tfloat64 z",
    ]


def test_show_reads_type_from_standard_input(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("std_msgs/msg/String\n"))
    assert run_command(capsys, "show", "-")[0] == "# A text.\nstring data\n"


def test_show_of_unknown_type_suggests_nearest(capsys):
    assert "did you mean" in run_command(capsys, "show", "std_msgs/msg/Strin", status=1)[1]


def test_list_prints_interfaces_by_kind(capsys):
    out, _ = run_command(capsys, "list")
    text = out.splitlines()
    assert text[0] == "Messages:"
    assert "    sensor_msgs/msg/JointState" in text
    assert "    std_srvs/srv/SetBool" in text[text.index("Services:") :]
    assert "    example_interfaces/action/Fibonacci" in text[text.index("Actions:") :]


def test_list_prints_only_actions(capsys):
    out, _ = run_command(capsys, "list", "-a")
    assert out.startswith("Actions:\n")
    assert "Messages:" not in out


def test_package_lists_types(capsys):
    out, _ = run_command(capsys, "package", "std_srvs")
    assert out.splitlines() == ["std_srvs/srv/Empty", "std_srvs/srv/SetBool", "std_srvs/srv/Trigger"]
    assert run_command(capsys, "package", "std_srvs", "-m")[0] == ""


def test_unknown_package_suggests_nearest(capsys):
    _, err = run_command(capsys, "package", "std_srv", status=1)
    assert "Unknown package 'std_srv'" in err
    assert "did you mean 'std_srvs'" in err


def test_packages_lists_packages_with_interfaces(capsys):
    packages = run_command(capsys, "packages")[0].splitlines()
    assert {"std_msgs", "std_srvs", "action_msgs"} <= set(packages)
    assert packages == sorted(packages)
    assert "std_msgs" not in run_command(capsys, "packages", "-s")[0].splitlines()


def test_proto_prints_prototype(capsys):
    assert run_command(capsys, "proto", "std_msgs/msg/String")[0] == "\"data: ''\n\"\n"
    assert run_command(capsys, "proto", "--no-quotes", "std_srvs/srv/SetBool")[0] == "data: false\n\n"


def test_types_of_workspace_package_are_found(capsys, tmp_path: Path, monkeypatch):
    package = tmp_path / "src" / "my_interfaces"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(
        '<package format="3"><name>my_interfaces</name><version>0.0.0</version><description>d</description>'
        '<maintainer email="a@example.org">a</maintainer><license>MIT</license></package>',
        encoding="utf-8",
    )
    (package / "msg" / "Wheel.msg").write_text("# A wheel\nfloat64 speed  # rad/s\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert run_command(capsys, "show", "my_interfaces/msg/Wheel")[0] == "# A wheel\nfloat64 speed  # rad/s\n"
    assert run_command(capsys, "package", "my_interfaces")[0] == "my_interfaces/msg/Wheel\n"
