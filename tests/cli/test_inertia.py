"""`linkwright inertia`: the blocks, the comparison, writing, and errors."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.descriptions import load

MODEL = """\
<robot name="r">
  <link name="base_footprint"/>
  <joint name="base_joint" type="fixed"><parent link="base_footprint"/><child link="base_link"/></joint>
  <link name="base_link">
    <inertial>
      <origin xyz="0.01 0 0"/>
      <mass value="2"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>
    </inertial>
    <visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual>
  </link>
  <joint name="wheel_joint" type="continuous"><parent link="base_link"/><child link="wheel"/></joint>
  <link name="wheel">
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
</robot>
"""


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(MODEL)
    return path


def test_table_lists_links_by_severity(model, capsys):
    assert main(["inertia", str(model)]) == 0
    captured = capsys.readouterr()
    assert captured.out.splitlines() == [
        "link            mass (kg)           density (kg/m3)  principal moments (kg m2)  verdict",
        "wheel           - (4.189 computed)  -                -                          missing: it has no <inertial>",
        "base_link       2                   250              0.02 0.02 0.02             it matches its shapes",
        f"base_footprint  -{'-':>20}{'-':>17}{'':26}it is fixed to 'base_link', which has a mass",
    ]
    assert "--link NAME" in captured.err


def test_table_is_translated_to_chinese(model, capsys):
    assert main(["--lang", "zh", "inertia", str(model)]) == 0
    head, wheel, *_ = capsys.readouterr().out.splitlines()
    assert head == "连杆            质量 (kg)        密度 (kg/m3)  主惯量 (kg m2)  评判"
    assert wheel == "wheel           -（算出 4.189）  -             -               缺少：没有 <inertial>"


def test_link_option_prints_inertial_block_after_table(model, capsys):
    words = ["inertia", str(model), "--density", "100", "--mass", "wheel=0.5", "--link", "wheel", "--link", "base_link"]
    assert main(words) == 0
    table, *details = capsys.readouterr().out.split("\n\n")
    assert "base_link  2 (0.8 computed)" in table
    assert "\n\n".join(details) == (
        "base_link: 1 visual shape, mass from density: 0.8 kg at 100 kg/m3\n"
        "  <inertial>\n"
        '    <origin xyz="0 0 0" rpy="0 0 0"/>\n'
        '    <mass value="0.8"/>\n'
        '    <inertia ixx="0.00533333" ixy="0" ixz="0" iyy="0.00533333" iyz="0" izz="0.00533333"/>\n'
        "  </inertial>\n"
        "\n"
        "wheel: 1 collision shape, requested mass: 0.5 kg at 119.4 kg/m3\n"
        "  <inertial>\n"
        '    <origin xyz="0 0 0" rpy="0 0 0"/>\n'
        '    <mass value="0.5"/>\n'
        '    <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.002"/>\n'
        "  </inertial>\n"
    )


def test_json_output_contains_inertials_of_links(model, capsys):
    assert main(["inertia", str(model), "--format", "json"]) == 0
    data = json.loads(capsys.readouterr().out)
    empty, base, wheel = data["links"]
    assert empty["inertial"] is None
    assert base["inertial"]["mass"] == 2.0
    assert base["inertial"]["inertia"]["ixx"] == pytest.approx(2 * 0.08 / 12)
    assert base["present"]["center_distance"] == pytest.approx(0.01)
    assert base["present"]["moment_ratios"] == pytest.approx([1.5] * 3)
    assert base["equivalent_box"] == pytest.approx([0.2] * 3, rel=1e-4)
    assert [link["verdict"] for link in data["links"]] == ["unjudged", "fits", "missing"]
    assert base["present_density"] == pytest.approx(250.0)
    assert wheel["present"] is None
    assert wheel["why"] == "it has no <inertial>"
    assert wheel["from"] == "collision"
    assert wheel["xml"].startswith("<inertial>\n  <origin")


def test_write_updates_file(model, capsys):
    assert main(["inertia", str(model), "--write"]) == 0
    out = capsys.readouterr().out
    assert out.endswith(f"wrote 2 <inertial> to '{model}'\n")
    assert "<mass" not in out
    robot = load(model)
    assert robot.links["base_link"].inertial.ixx == 0.0133333
    assert robot.links["wheel"].inertial.mass == 4.18879
    assert main(["inertia", str(model)]) == 0
    assert capsys.readouterr().out.count("it matches its shapes") == 2


def test_inertial_from_macro_is_printed_but_not_written(tmp_path, capsys):
    path = tmp_path / "r.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:macro name="ball" params="name r">\n'
        '    <link name="${name}"><visual><geometry><sphere radius="${r}"/></geometry></visual></link>\n'
        "  </xacro:macro>\n"
        '  <xacro:arg name="r" default="1"/>\n'
        '  <xacro:ball name="b" r="$(arg r)"/>\n'
        "</robot>\n"
    )
    before = path.read_text()
    assert main(["inertia", str(path), "r:=0.1", "--write"]) == 1
    captured = capsys.readouterr()
    assert '<mass value="4.18879"/>' in captured.out
    assert "wrote 0 <inertial> to no file" in captured.out
    assert "INR211" in captured.err
    assert "the macro 'ball' generates it" in captured.err
    assert f"{path}:3:5" in captured.err
    assert path.read_text() == before


def test_unknown_link_names_and_invalid_masses_are_rejected(model, capsys):
    assert main(["inertia", str(model), "--link", "weel"]) == 1
    err = capsys.readouterr().err
    assert "CLI311" in err
    assert "did you mean 'wheel'?" in err
    assert main(["inertia", str(model), "--mass", "weel=1", "--mass", "wheel", "--mass", "wheel=-1"]) == 1
    err = capsys.readouterr().err
    assert err.count("CLI312") == 2
    assert "CLI311" in err


def test_density_must_be_positive(model, capsys):
    assert main(["inertia", str(model), "--density", "-3"]) == 2
    assert "'-3' is not a positive number" in capsys.readouterr().err


def test_description_without_robot_is_an_error(tmp_path, capsys):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"/>')
    assert main(["inertia", str(path)]) == 1
    assert "URDF106" in capsys.readouterr().err


def test_description_errors_are_reported_and_rest_is_computed(tmp_path, capsys):
    path = tmp_path / "r.urdf"
    path.write_text(MODEL.replace('<mass value="2"/>', '<mass value="2 kg"/>'))
    assert main(["inertia", str(path)]) == 1
    captured = capsys.readouterr()
    assert "2 kg" in captured.err
    assert "wheel" in captured.out
