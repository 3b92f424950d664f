"""Materials from scripts of Gazebo and of models."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from linkwright.descriptions import examine_world
from linkwright.sdf.scripts import gazebo_look, read_script
from tests.sdf.worlds import examined, write

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


def material_of(folder, inside):
    """The material of a visual in a world in a folder."""
    found = examined(folder, VISUAL.format(f"<material>{inside}</material>"))
    assert found.diagnostics == ()
    return found.sdf.worlds[0].models[0].links[0].visuals[0].material


def script(name, *uris):
    return f"<script>{''.join(f'<uri>{each}</uri>' for each in uris)}<name>{name}</name></script>"


def test_gazebos_own_materials_have_their_colors(tmp_path):
    material = material_of(tmp_path, script("Gazebo/Grey", "file://media/materials/scripts/gazebo.material"))
    assert (material.ambient, material.diffuse) == ((0.3, 0.3, 0.3, 1), (0.7, 0.7, 0.7, 1))
    assert material.script.name == "Gazebo/Grey"
    glow = gazebo_look("Gazebo/BlueGlow")
    assert glow is not None
    assert glow.emissive == (0, 0, 1, 1)


def test_colors_of_the_file_come_before_those_of_the_script(tmp_path):
    material = material_of(tmp_path, script("Gazebo/Grey") + "<ambient>1 0 0 1</ambient>")
    assert (material.ambient, material.diffuse) == ((1, 0, 0, 1), (0.7, 0.7, 0.7, 1))


def test_a_name_that_nobody_has_leaves_a_material_as_it_is(tmp_path):
    material = material_of(tmp_path, script("Gazebo/NoSuch") + "<diffuse>1 0 0 1</diffuse>")
    assert (material.ambient, material.diffuse) == (None, (1, 0, 0, 1))
    assert gazebo_look("Grey") is None


def test_a_script_of_a_model_has_colors_and_an_image(tmp_path):
    write(tmp_path, {"box/materials/scripts/box.material": SCRIPT, "box/materials/textures/box.png": ""})
    uris = "file://box/materials/scripts", "file://box/materials/textures"
    material = material_of(tmp_path, script("Box/Child", *uris))
    assert (material.ambient, material.diffuse) == ((0.1, 0.2, 0.3, 1), (0.4, 0.5, 0.6, 0.7))
    assert (material.specular, material.emissive) == ((1, 1, 1, 1), (1, 0, 0, 1))
    assert material.pbr.metal.albedo_map == "file://box/materials/textures/box.png"
    alone = material_of(tmp_path, script("Box/Base", "file://box/materials/scripts/box.material"))
    assert alone.pbr.metal.albedo_map == (tmp_path / "box/materials/textures/box.png").as_uri()


def test_what_a_script_says_is_read_as_far_as_it_goes():
    found = read_script(SCRIPT)
    assert list(found) == ["Box/Base", "Box/Child", "Box/Wrong"]
    assert found["Box/Wrong"].diffuse is None
    assert read_script("material A") == {"A": found["Box/Wrong"]}


@given(
    st.lists(st.sampled_from(["material", "A", ":", "{", "}", "\n", "diffuse", "1", "x", "texture", "//", '"', " "]))
)
def test_any_script_is_read(words):
    read_script(" ".join(words))


def test_an_image_that_is_not_there_and_a_folder_that_is_no_script(tmp_path):
    write(tmp_path, {"box/box.material": SCRIPT, "box/a.material/x": ""})
    material = material_of(tmp_path, script("Box/Base", "box"))
    assert material.pbr is None
    assert material.diffuse == (0.4, 0.5, 0.6, 0.7)


def test_models_in_models_have_the_colors_too(tmp_path):
    inner = VISUAL.format(f"<material>{script('Gazebo/Red')}</material>")
    (tmp_path / "m.sdf").write_text(f'<sdf version="1.9"><model name="o">{inner}</model></sdf>')
    found = examine_world(tmp_path / "m.sdf", environment={"HOME": "/nowhere"})
    assert found.sdf is not None
    material = found.sdf.models[0].models[0].links[0].visuals[0].material
    assert material is not None
    assert material.diffuse == (1, 0, 0, 1)
