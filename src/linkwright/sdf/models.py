"""The elements ``<model>``, ``<frame>`` and ``<include>``.

Source of the elements and defaults: the SDFormat specification 1.12, ``model.sdf``, ``frame.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.joints import JOINT, Joint
from linkwright.sdf.links import LINK, Link
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import TEXT, TRUTH, VECTOR3, name_of, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame of a model or world.

    Attributes:
        attached_to: the link, joint, frame or model with which the frame moves; empty for the model or world that
            contains the frame.
        pose: the pose of the frame, relative to `attached_to` unless it names another frame.
    """

    name: str
    attached_to: str = ""
    pose: RawPose = AT_ORIGIN
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Include:
    """An included model, light or actor, with the changes that the include makes.

    Attributes:
        uri: the address of the model: ``model://NAME``, a path or a URL.
        name: the name to use; empty for the name in the file.
        pose: the pose to use; None for the pose in the file.
        static: whether the model never moves; None for the setting of the file.
        placement_frame: the frame of the model that is placed at `pose`; empty for the model's own frame.
        merge: whether the parts of the model become parts of the enclosing model (SDF 1.9).
        plugins: plugins in addition to those in the file.
    """

    uri: str
    name: str = ""
    pose: RawPose | None = None
    static: bool | None = None
    placement_frame: str = ""
    merge: bool = False
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Model:
    """A model of links, joints and nested models.

    Attributes:
        pose: the pose of the model, relative to the enclosing model or world unless it names another frame.
        static: whether the model never moves.
        self_collide: whether the links of the model collide with each other.
        allow_auto_disable: whether the engine may put the model to sleep when it does not move.
        enable_wind: whether wind acts on the links.
        canonical_link: the link to which the model's frame is attached; empty for the first link.
        placement_frame: the frame of the model that is placed at `pose`; empty for the model's own frame.
        scale: the scale along x, y and z in worlds that Gazebo classic saved; few readers support it.
        models: the nested models.
        includes: the includes that are not yet, or cannot be, replaced by nested models.
    """

    name: str
    pose: RawPose = AT_ORIGIN
    static: bool = False
    self_collide: bool = False
    allow_auto_disable: bool = True
    enable_wind: bool = False
    canonical_link: str = ""
    placement_frame: str = ""
    scale: Vector3 = (1.0, 1.0, 1.0)
    links: tuple[Link, ...] = ()
    joints: tuple[Joint, ...] = ()
    frames: tuple[Frame, ...] = ()
    models: tuple[Model, ...] = ()
    includes: tuple[Include, ...] = ()
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


FRAME = ElementRule(
    "frame",
    "a frame with a name",
    (
        name_of(),
        AttributeRule("attached_to", TEXT, "the link, joint, frame or model with which the frame moves", default=""),
    ),
    (POSE,),
    is_repeated=True,
    make=Frame,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="frames",
)

INCLUDE = ElementRule(
    "include",
    "a model from another file",
    (AttributeRule("merge", TRUTH, "whether its parts become parts of the enclosing model", default="false"),),
    (
        value("uri", TEXT, "the address of the model: model://NAME, a path or a URL", default="", required=True),
        value("name", TEXT, "the name of the included model", default=""),
        replace(POSE, default=None),
        value("static", TRUTH, "whether the model never moves"),
        value("placement_frame", TEXT, "the frame of the model that is placed at the pose", default=""),
        PLUGIN,
    ),
    is_repeated=True,
    make=Include,
    keeps_element=True,
    passes_element=True,
    field="includes",
)

MODEL = ElementRule(
    "model",
    "a model of links, joints and nested models",
    (
        name_of(),
        AttributeRule("canonical_link", TEXT, "the link to which the model's frame is attached", default=""),
        AttributeRule("placement_frame", TEXT, "the frame of the model that is placed at its pose", default=""),
    ),
    (
        POSE,
        value("static", TRUTH, "whether the model never moves", default="false"),
        value("self_collide", TRUTH, "whether the links collide with each other", default="false"),
        value("allow_auto_disable", TRUTH, "whether the model may sleep when it does not move", default="true"),
        value("enable_wind", TRUTH, "whether wind acts on the links", default="false"),
        value("scale", VECTOR3, "the scale in worlds that Gazebo classic saved", default="1 1 1"),
        LINK,
        JOINT,
        FRAME,
        INCLUDE,
        PLUGIN,
    ),
    is_repeated=True,
    make=Model,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    is_recursive=True,
    field="models",
)
