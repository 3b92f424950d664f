"""Findings about valid worlds."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from linkwright.lint.engine import examine
from linkwright.packages import PackageFinder

WORLDS = Path(__file__).parents[3] / "shared" / "worlds"
MANIFEST = WORLDS / "manifest.json"
VALID_INERTIAL = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"


@pytest.fixture
def check_models(tmp_path, monkeypatch):
    """Return the code, line, location and message of the findings about models in a world."""
    monkeypatch.setenv("HOME", str(tmp_path))

    def check(inside):
        path = tmp_path / "w.world"
        path.write_text(f'<sdf version="1.9"><world name="w">\n{inside}\n</world></sdf>')
        findings = examine(path).diagnostics
        return [(finding.code, finding.span.line, str(finding.message)) for finding in findings]

    return check


def link_text(inertial, content=""):
    return f'<model name="m">{content}<link name="l">{inertial}</link></model>'


def inertia_text(ixx, iyy, izz, products=""):
    return f"<inertial><inertia><ixx>{ixx}</ixx><iyy>{iyy}</iyy><izz>{izz}</izz>{products}</inertia></inertial>"


@pytest.mark.parametrize(
    ("inertial", "code", "message"),
    [
        ("<inertial><mass>0</mass></inertial>", "LW302", "the mass of link 'l' is zero"),
        ("<inertial><mass>-2</mass></inertial>", "LW303", "the mass of link 'l' is negative: -2 kg"),
        (inertia_text(1, 0, 1), "LW311", "'iyy' of link 'l' is zero"),
        (inertia_text(1, 1, 1, "<ixy>0.8</ixy>"), "LW312", "'ixy' of link 'l' is larger than its moments allow: 0.8"),
        (inertia_text(1, 1, 3), "LW314", "'izz' of link 'l' is larger than the other two moments together"),
        (inertia_text(1, "nan", 1), "SDF122", "the mass or inertia of link 'l' is not a finite number"),
    ],
)
def test_impossible_inertials_are_reported_unless_static(check_models, inertial, code, message):
    assert check_models(link_text(inertial)) == [(code, 2, message)]
    assert check_models(link_text(inertial, "<static>true</static>")) == []


def test_automatic_inertial_is_not_checked(check_models):
    assert check_models(link_text('<inertial auto="true"><mass>0</mass></inertial>')) == []


def test_models_in_static_models_are_not_checked(check_models):
    inner = link_text("<inertial><mass>-2</mass></inertial>")
    assert check_models(f'<model name="o"><static>1</static>{inner}</model>') == []
    assert len(check_models(f'<model name="o"><link name="a"/>{inner}</model>')) == 1


@pytest.mark.parametrize(
    "shape",
    [
        "<box><size>1 0 1</size></box>",
        "<sphere><radius>-1</radius></sphere>",
        "<cylinder><radius>1</radius><length>0</length></cylinder>",
        "<ellipsoid><radii>1 1 0</radii></ellipsoid>",
    ],
)
def test_nonpositive_shape_sizes_are_reported(check_models, shape):
    collision = f'<collision name="c"><geometry>{shape}</geometry></collision>'
    assert check_models(link_text(VALID_INERTIAL + collision)) == [
        ("SDF122", 2, "collision 'c' has a size that is not positive")
    ]


def test_zero_axis_and_zero_step_are_reported(check_models):
    joint = '<joint name="j" type="revolute"><parent>l</parent><child>k</child><axis><xyz>0 0 0</xyz></axis></joint>'
    model = f'<model name="m"><link name="l"/><link name="k"/>{joint}</model>'
    assert check_models(model) == [("SDF122", 2, "the axis of joint 'j' has no direction")]
    fixed = [joint.replace('"j"', f'"{name}"').replace("revolute", "fixed") for name in ("f", "g", "h")]
    model = f'<model name="m"><link name="l"/><link name="k"/>{joint}{"".join(fixed)}</model>'
    assert check_models(model) == [
        ("SDF122", 2, "the axis of joint 'j' has no direction"),
        ("SDF122", 2, "the axis of joint 'f' has no direction (and 2 more)"),
    ]
    step = '<physics type="ode"><max_step_size>0</max_step_size></physics>'
    assert check_models(step + link_text(VALID_INERTIAL)) == [("SDF122", 2, "the time step is not positive: 0 s")]


def test_shapes_without_size_are_one_finding_per_model(check_models):
    box = '<{0} name="{1}"><geometry>\n<box><size>0 1 2</size></box></geometry></{0}>'
    walls = "".join(box.format(kind, f"{kind}{number}") for number in range(2) for kind in ("visual", "collision"))
    assert check_models(link_text(VALID_INERTIAL + walls)) == [
        ("SDF122", 3, "visual 'visual0' has a size that is not positive (and 3 more)")
    ]


def test_missing_mesh_is_reported_once(check_models, tmp_path):
    visual = '<visual name="v{}"><geometry><mesh>\n<uri>meshes/a.stl</uri></mesh></geometry></visual>'
    model = link_text(VALID_INERTIAL + visual.format(1) + visual.format(2))
    findings = check_models(model)
    assert [finding[:2] for finding in findings] == [("SDF162", 3)]
    assert findings[0][2].startswith("'meshes/a.stl' of visual 'v1' is left out: ")
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes/a.stl").touch()
    assert check_models(model) == []


def test_missing_models_and_meshes_are_one_finding_each(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    includes = "".join(f"<include>\n<uri>model://tree_{number}</uri></include>" for number in range(12))
    mesh = '<visual name="v{0}"><geometry><mesh>\n<uri>meshes/{0}.stl</uri></mesh></geometry></visual>'
    path = tmp_path / "w.world"
    link = link_text(VALID_INERTIAL + mesh.format(1) + mesh.format(2))
    path.write_text(f'<sdf version="1.9"><world name="w">{includes}{link}</world></sdf>')
    models, meshes = examine(path).diagnostics
    assert (models.code, meshes.code) == ("SDF160", "SDF162")
    assert str(models.message) == (
        "'model://tree_0' is left out: there is no model 'tree_0' on the search path (and 11 more)"
    )
    assert [note.span.line for note in models.notes[:-1]] == list(range(3, 13))
    assert str(models.notes[-1].message) == "and 1 more"
    assert str(meshes.message).endswith("(and 1 more)")
    assert [str(note.message).partition(" of ")[0] for note in meshes.notes] == ["'meshes/2.stl'"]


def test_world_findings_follow_settings(tmp_path):
    (tmp_path / "linkwright.toml").write_text('ignore = ["mass-negative", "SDF122"]\n')
    path = tmp_path / "w.world"
    model = link_text(
        "<inertial><mass>-2</mass></inertial>"
        '<visual name="v"><geometry><sphere><radius>0</radius></sphere></geometry></visual>'
    )
    path.write_text(f'<sdf version="1.9"><world name="w">{model}</world></sdf>')
    assert examine(path).diagnostics == ()


def _read_items():
    if not MANIFEST.is_file():
        return []
    items = json.loads(MANIFEST.read_text(encoding="utf-8"))["items"]
    return [pytest.param(item, id=item["name"]) for item in items if item["entry"].endswith((".world", ".sdf"))]


@pytest.mark.parametrize("item", _read_items())
def test_real_worlds_have_no_lint_findings(item, monkeypatch):
    path = WORLDS / item["entry"]
    folders = dict.fromkeys(str(WORLDS / path) for path in item.get("model_paths", ()))
    monkeypatch.setenv("GAZEBO_MODEL_PATH", os.pathsep.join(folders))
    monkeypatch.setenv("HOME", "/nowhere")
    findings = examine(path, packages=PackageFinder(start=path.parent, environment={})).diagnostics
    assert [finding for finding in findings if finding.code.startswith("LW") or finding.code == "SDF122"] == []
