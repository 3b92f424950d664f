"""Material scripts of Gazebo and of models."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from linkwright.descriptions import examine_world
from linkwright.sdf.scripts import find_gazebo_look, read_script
from tests.sdf.worlds import examine_world_in, write_files

SCRIPT = """\
import * from "grid.material"
fragment_program P glsl { source p.frag }
material Box/Base   // the first
{
  technique { pass main {
      ambient 0.1 0.2 0.3
      diffuse 0.4 0.5 0.6 0.7
      specular 1 1 1 128
      texture_unit { texture "box.png" }
  } }
  /* diffuse 0 0 0 1 */
}
material "Box/Child" : Box/Base { technique { pass { emissive 1 0 0 } } }
material Box/Wrong { technique { pass { diffuse red green blue
} } }
"""
VISUAL = '<model name="m"><link name="l"><visual name="v">{}</visual></link></model>'


def read_material(folder, elements):
    """Return the material of a visual in a world in a folder."""
    reading = examine_world_in(folder, VISUAL.format(f"<material>{elements}</material>"))
    assert reading.diagnostics == ()
    return reading.sdf.worlds[0].models[0].links[0].visuals[0].material


def script_text(name, *uris):
    return f"<script>{''.join(f'<uri>{uri}</uri>' for uri in uris)}<name>{name}</name></script>"


def test_gazebo_materials_have_their_colors(tmp_path):
    material = read_material(tmp_path, script_text("Gazebo/Grey", "file://media/materials/scripts/gazebo.material"))
    assert (material.ambient, material.diffuse) == ((0.3, 0.3, 0.3, 1), (0.7, 0.7, 0.7, 1))
    assert material.script.name == "Gazebo/Grey"
    glow = find_gazebo_look("Gazebo/BlueGlow")
    assert glow is not None
    assert glow.emissive == (0, 0, 1, 1)


def test_material_colors_override_script(tmp_path):
    material = read_material(tmp_path, script_text("Gazebo/Grey") + "<ambient>1 0 0 1</ambient>")
    assert (material.ambient, material.diffuse) == ((1, 0, 0, 1), (0.7, 0.7, 0.7, 1))


def test_unknown_script_leaves_material_unchanged(tmp_path):
    material = read_material(tmp_path, script_text("Gazebo/NoSuch") + "<diffuse>1 0 0 1</diffuse>")
    assert (material.ambient, material.diffuse) == (None, (1, 0, 0, 1))
    assert find_gazebo_look("Grey") is None


def test_model_script_has_colors_and_texture(tmp_path):
    write_files(tmp_path, {"box/materials/scripts/box.material": SCRIPT, "box/materials/textures/box.png": ""})
    uris = "file://box/materials/scripts", "file://box/materials/textures"
    material = read_material(tmp_path, script_text("Box/Child", *uris))
    assert (material.ambient, material.diffuse) == ((0.1, 0.2, 0.3, 1), (0.4, 0.5, 0.6, 0.7))
    assert (material.specular, material.emissive) == ((1, 1, 1, 1), (1, 0, 0, 1))
    assert material.pbr.metal.albedo_map == "file://box/materials/textures/box.png"
    single_material = read_material(tmp_path, script_text("Box/Base", "file://box/materials/scripts/box.material"))
    assert single_material.pbr.metal.albedo_map == (tmp_path / "box/materials/textures/box.png").as_uri()


def test_script_is_read_up_to_errors():
    script = read_script(SCRIPT)
    assert list(script) == ["Box/Base", "Box/Child", "Box/Wrong"]
    assert script["Box/Wrong"].diffuse is None
    assert read_script("material A") == {"A": script["Box/Wrong"]}


@given(
    st.lists(st.sampled_from(["material", "A", ":", "{", "}", "\n", "diffuse", "1", "x", "texture", "//", '"', " "]))
)
def test_random_scripts_are_read_without_exception(tokens):
    read_script(" ".join(tokens))


def test_missing_texture_and_folder_as_script_are_ignored(tmp_path):
    write_files(tmp_path, {"box/box.material": SCRIPT, "box/a.material/x": ""})
    material = read_material(tmp_path, script_text("Box/Base", "box"))
    assert material.pbr is None
    assert material.diffuse == (0.4, 0.5, 0.6, 0.7)


def test_nested_models_get_script_colors(tmp_path):
    visual_text = VISUAL.format(f"<material>{script_text('Gazebo/Red')}</material>")
    (tmp_path / "m.sdf").write_text(f'<sdf version="1.9"><model name="o">{visual_text}</model></sdf>')
    reading = examine_world(tmp_path / "m.sdf", environment={"HOME": "/nowhere"})
    assert reading.sdf is not None
    material = reading.sdf.models[0].models[0].links[0].visuals[0].material
    assert material is not None
    assert material.diffuse == (1, 0, 0, 1)
