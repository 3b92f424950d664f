"""The element ``<material>``: colours, textures and shaders.

Source of the elements and defaults: the SDFormat specification 1.12, ``material.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import COLOR, NUMBER, TEXT, TRUTH, Color, object_rule, value, values, without_unreadable


@dataclass(frozen=True, slots=True)
class MaterialScript:
    """A material that a script defines, such as ``Gazebo/Grey``, and the URIs of scripts and their folders."""

    uris: tuple[str, ...] = ()
    name: str = ""


@dataclass(frozen=True, slots=True)
class Workflow:
    """The images and factors of a physically based material; images that are not used are empty.

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
    """A physically based material, described for one or two workflows; the renderer chooses between them."""

    metal: Workflow | None = None
    specular: Workflow | None = None


@dataclass(frozen=True, slots=True)
class Shader:
    """The shader of a material in Gazebo classic: ``vertex``, ``pixel`` or a type with a normal map."""

    type: str = "pixel"
    normal_map: str = ""


@dataclass(frozen=True, slots=True)
class Material:
    """The material of a visual; missing colours and images are None.

    Attributes:
        ambient: the colour under ambient light.
        diffuse: the colour under direct light.
        specular: the colour of highlights.
        emissive: the colour of emitted light.
        shininess: the specular exponent; higher values make highlights narrower.
        lighting: whether lights affect the material.
        double_sided: whether the surface is also visible from inside.
        render_order: the drawing order of overlapping surfaces; the highest is drawn on top.
        script: a material from a script, which overrides the colours in Gazebo classic.
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
    _image_rule("albedo_map", "the image of the colour"),
    _image_rule("normal_map", "the image of the normals"),
    _image_rule("emissive_map", "the image of the emitted colour"),
    _image_rule("ambient_occlusion_map", "the image of the ambient occlusion"),
    _image_rule("environment_map", "the image of its reflections"),
    _image_rule("light_map", "the image of the light on it"),
)

MATERIAL = object_rule(
    Material,
    "material",
    "how it looks",
    value("ambient", COLOR, "the colour in the shade"),
    value("diffuse", COLOR, "the colour in the light"),
    value("specular", COLOR, "the colour of highlights"),
    value("emissive", COLOR, "the emitted colour"),
    value("shininess", NUMBER, "the sharpness of highlights", default="0"),
    value("lighting", TRUTH, "whether lights change it", default="true"),
    value("double_sided", TRUTH, "whether its inside is also visible", default="false"),
    value("render_order", NUMBER, "the order in which coinciding surfaces are drawn", default="0"),
    object_rule(
        without_unreadable(MaterialScript),
        "script",
        "a material of Gazebo classic by its name",
        values("uri", TEXT, "a folder or file of material scripts, or one of its textures"),
        value("name", TEXT, "the name of the material, such as Gazebo/Grey", default=""),
    ),
    ElementRule(
        "shader",
        "how it is shaded in Gazebo classic",
        (AttributeRule("type", TEXT, "vertex, pixel or a map of normals", default="pixel"),),
        (value("normal_map", TEXT, "the image of the normals", default=""),),
        make=Shader,
        keeps=True,
    ),
    object_rule(
        Pbr,
        "pbr",
        "a physically based surface",
        object_rule(
            Workflow,
            "metal",
            "a surface by roughness and metalness",
            *_COMMON_IMAGE_RULES,
            _image_rule("roughness_map", "the image of the roughness"),
            _image_rule("metalness_map", "the image of the metalness"),
            value("roughness", NUMBER, "from 0, a mirror, to 1, dull", default="0.5"),
            value("metalness", NUMBER, "from 0, none, to 1, metal", default="0.5"),
        ),
        object_rule(
            Workflow,
            "specular",
            "a surface by shine and glossiness",
            *_COMMON_IMAGE_RULES,
            _image_rule("specular_map", "the image of the specular colour"),
            _image_rule("glossiness_map", "the image of the glossiness"),
            value("glossiness", NUMBER, "from 0, dull, to 1, a mirror", default="0"),
        ),
    ),
)
