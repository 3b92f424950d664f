"""The element ``<material>``: colors, textures and shaders.

Source of the elements and defaults: the SDFormat specification 1.12, ``material.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import COLOR, NUMBER, TEXT, TRUTH, Color, object_rule, value, values, without_unreadable


@dataclass(frozen=True, slots=True)
class MaterialScript:
    """A material that a script defines, such as ``Gazebo/Grey``.

    `uris` are the addresses of scripts and their folders.
    """

    uris: tuple[str, ...] = ()
    name: str = ""


@dataclass(frozen=True, slots=True)
class Workflow:
    """The images and factors of a physically based material.

    Images that are not used are empty.

    Attributes:
        roughness: the roughness, from 0 for a mirror to 1 for a dull surface.
        metalness: the metalness, from 0 to 1; not used in the specular workflow.
        glossiness: the glossiness, from 0 for a dull surface to 1 for a mirror; only used in the specular workflow.
    """

    albedo_map: str = ""
    normal_map: str = ""
    roughness_map: str = ""
    metalness_map: str = ""
    emissive_map: str = ""
    ambient_occlusion_map: str = ""
    environment_map: str = ""
    light_map: str = ""
    specular_map: str = ""
    glossiness_map: str = ""
    roughness: float = 0.5
    metalness: float = 0.5
    glossiness: float = 0.0


@dataclass(frozen=True, slots=True)
class Pbr:
    """A physically based material, described for one or two workflows.

    The renderer chooses between them.
    """

    metal: Workflow | None = None
    specular: Workflow | None = None


@dataclass(frozen=True, slots=True)
class Shader:
    """The shader of a material in Gazebo classic.

    Its type is ``vertex``, ``pixel`` or a type with a normal map.
    """

    type: str = "pixel"
    normal_map: str = ""


@dataclass(frozen=True, slots=True)
class Material:
    """The material of a visual.

    Missing colors and images are None.

    Attributes:
        ambient: the color under ambient light.
        diffuse: the color under direct light.
        specular: the color of highlights.
        emissive: the color of emitted light.
        shininess: the specular exponent; higher values make highlights narrower.
        lighting: whether lights affect the material.
        double_sided: whether the surface is also visible from inside.
        render_order: the drawing order of overlapping surfaces; the highest is drawn on top.
        script: a material from a script, which overrides the colors in Gazebo classic.
        pbr: a physically based material, which overrides everything else in gz-sim.
    """

    ambient: Color | None = None
    diffuse: Color | None = None
    specular: Color | None = None
    emissive: Color | None = None
    shininess: float = 0.0
    lighting: bool = True
    double_sided: bool = False
    render_order: float = 0.0
    script: MaterialScript | None = None
    shader: Shader | None = None
    pbr: Pbr | None = None


def _image_rule(tag: str, meaning: str) -> ElementRule:
    return value(tag, TEXT, meaning, default="")


_COMMON_IMAGE_RULES = (
    _image_rule("albedo_map", "the albedo map"),
    _image_rule("normal_map", "the normal map"),
    _image_rule("emissive_map", "the emissive map"),
    _image_rule("ambient_occlusion_map", "the ambient occlusion map"),
    _image_rule("environment_map", "the environment map"),
    _image_rule("light_map", "the light map"),
)

MATERIAL = object_rule(
    Material,
    "material",
    "the material of a visual",
    value("ambient", COLOR, "the color under ambient light"),
    value("diffuse", COLOR, "the color under direct light"),
    value("specular", COLOR, "the color of highlights"),
    value("emissive", COLOR, "the emitted color"),
    value("shininess", NUMBER, "the specular exponent", default="0"),
    value("lighting", TRUTH, "whether lights affect the material", default="true"),
    value("double_sided", TRUTH, "whether the surface is also visible from inside", default="false"),
    value("render_order", NUMBER, "the drawing order of overlapping surfaces", default="0"),
    object_rule(
        without_unreadable(MaterialScript),
        "script",
        "a material that a script of Gazebo classic defines",
        values("uri", TEXT, "the address of a material script, or of a folder of scripts or textures"),
        value("name", TEXT, "the name of the material, such as Gazebo/Grey", default=""),
    ),
    ElementRule(
        "shader",
        "the shader in Gazebo classic",
        (AttributeRule("type", TEXT, "the type: vertex, pixel or a type with a normal map", default="pixel"),),
        (value("normal_map", TEXT, "the normal map", default=""),),
        make=Shader,
        keeps_element=True,
    ),
    object_rule(
        Pbr,
        "pbr",
        "a physically based material",
        object_rule(
            Workflow,
            "metal",
            "a material with roughness and metalness",
            *_COMMON_IMAGE_RULES,
            _image_rule("roughness_map", "the roughness map"),
            _image_rule("metalness_map", "the metalness map"),
            value("roughness", NUMBER, "the roughness, from 0 for a mirror to 1 for dull", default="0.5"),
            value("metalness", NUMBER, "the metalness, from 0 to 1", default="0.5"),
        ),
        object_rule(
            Workflow,
            "specular",
            "a material with specular color and glossiness",
            *_COMMON_IMAGE_RULES,
            _image_rule("specular_map", "the specular map"),
            _image_rule("glossiness_map", "the glossiness map"),
            value("glossiness", NUMBER, "the glossiness, from 0 for dull to 1 for a mirror", default="0"),
        ),
    ),
)
