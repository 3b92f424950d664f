"""Read the ``<gazebo>`` elements of a URDF, which are for simulators.

Most of their content is SDF for the link, joint or model that the attribute ``reference`` names. Some tags, such as
``mu1`` and ``turnGravityOff``, are older than SDF and represent SDF elements. Both are combined into one SDF element
that keeps the positions in the URDF, so that the SDF reader reports errors there.

Source: libsdformat's parser of URDF. That parser finds the shapes of a link by names derived from the link, and
therefore skips shapes with other names; here the settings apply to all shapes of the link.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from linkwright.schema import ElementRule
from linkwright.sdf.joints import JOINT, Joint
from linkwright.sdf.links import COLLISION, LINK, VISUAL, Collision, Link, Visual
from linkwright.sdf.models import MODEL, Model
from linkwright.sdf.reader import is_too_deep, read_element
from linkwright.sdf.report import SdfReport
from linkwright.sdf.values import TRUTH
from linkwright.urdf import Robot
from linkwright.urdf import model as urdf
from linkwright.xmltree import Element, Text

_PathsByTag = Mapping[str, tuple[str, ...]]
"""A mapping from an old tag in ``<gazebo>`` to the paths of the SDF elements that it represents."""

_MODEL_TAGS: _PathsByTag = {"static": ("static",)}
_LINK_TAGS: _PathsByTag = {
    "turnGravityOff": ("gravity",),
    "selfCollide": ("self_collide",),
    "dampingFactor": ("velocity_decay/linear", "velocity_decay/angular"),
}
_COLLISION_TAGS: _PathsByTag = {
    "mu1": ("surface/friction/ode/mu",),
    "mu2": ("surface/friction/ode/mu2",),
    "fdir1": ("surface/friction/ode/fdir1",),
    "kp": ("surface/contact/ode/kp",),
    "kd": ("surface/contact/ode/kd",),
    "maxVel": ("surface/contact/ode/max_vel",),
    "minDepth": ("surface/contact/ode/min_depth",),
    "laserRetro": ("laser_retro",),
    "maxContacts": ("max_contacts",),
}
_VISUAL_TAGS: _PathsByTag = {"material": ("material/script/name",)}
_JOINT_TAGS: _PathsByTag = {
    "springReference": ("axis/dynamics/spring_reference",),
    "springStiffness": ("axis/dynamics/spring_stiffness",),
    "provideFeedback": ("physics/provide_feedback",),
}
_KEEP_FIXED_TAG = "preserveFixedJoint"
_MAKE_REVOLUTE_TAG = "disableFixedJointLumping"
_OTHER_TAGS = frozenset(
    {
        _KEEP_FIXED_TAG,
        _MAKE_REVOLUTE_TAG,
        *("canonicalBody", "cfmDamping", "fudgeFactor", "implicitSpringDamper", "stopCfm", "stopErp"),
    }
)
"""Old tags in ``<gazebo>`` without an equivalent in SDF, or in the part of SDF that Linkwright reads."""
_OLD_TAGS = frozenset({*_MODEL_TAGS, *_LINK_TAGS, *_COLLISION_TAGS, *_VISUAL_TAGS, *_JOINT_TAGS, *_OTHER_TAGS})
_SHAPE_TAGS = frozenset({"collision", "visual"})
_NEGATED_TAGS = frozenset({"turnGravityOff"})
_TRUE_VALUES, _FALSE_VALUES = frozenset({"true", "yes", "1"}), frozenset({"false", "no", "0"})
_MATERIALS_URI = "file://media/materials/scripts/gazebo.material"
"""The address of the script that defines Gazebo's built-in materials."""


@dataclass(frozen=True, slots=True)
class LinkExtension:
    """The settings of a link in ``<gazebo>``.

    Attributes:
        link: an SDF link with the sensors, lights and gravity setting; its shapes, mass and pose do not apply.
        visual: settings for each visual of the link, except geometry and pose.
        collision: settings for each collision of the link, except geometry and pose.
    """

    link: Link
    visual: Visual
    collision: Collision


class Extensions:
    """The ``<gazebo>`` elements of a robot, grouped by the name in ``reference``.

    Args:
        robot: the robot with the ``<gazebo>`` elements.
        report: receives the errors in these elements.
    """

    def __init__(self, robot: Robot, report: SdfReport) -> None:
        self._report = report
        self._by_name: dict[str, list[Element]] = defaultdict(list)
        for element in robot.extensions:
            if element.tag == "gazebo" and not is_too_deep(element, report):
                self._by_name[element.attributes.get("reference", "")].append(element)

    def model(self, robot: Robot) -> Model:
        """Return an SDF model from the ``<gazebo>`` elements that apply to the whole robot.

        The model contains plugins, and links and joints that URDF cannot express.
        """
        model_element = _make_element_at(robot.element, "model", robot.name)
        for gazebo in self._by_name.get("", ()):
            model_element.children += _iterate_sdf_children(gazebo)
            self._add_old_tags(model_element, gazebo, _MODEL_TAGS, MODEL)
        model: Model = read_element(model_element, MODEL, self._report)
        return model

    def link(self, link: urdf.Link) -> LinkExtension:
        """Return the settings of a link, its visuals and its collisions."""
        link_element = _make_element_at(link.element, "link", link.name)
        visual, collision = (
            _make_element_at(link.element, "visual", link.name),
            _make_element_at(link.element, "collision", link.name),
        )
        for gazebo in self._by_name.get(link.name, ()):
            link_element.children += _iterate_sdf_children(gazebo)
            for shape, paths_by_tag, rule in ((visual, _VISUAL_TAGS, VISUAL), (collision, _COLLISION_TAGS, COLLISION)):
                for element in gazebo.elements(shape.tag):
                    _merge_shape_settings(shape, element)
                self._add_old_tags(shape, gazebo, paths_by_tag, rule)
            self._add_old_tags(link_element, gazebo, _LINK_TAGS, LINK)
        return LinkExtension(
            read_element(link_element, LINK, self._report),
            read_element(visual, VISUAL, self._report),
            read_element(collision, COLLISION, self._report),
        )

    def joint(self, joint: urdf.Joint, robot: Robot) -> Joint:
        """Return an SDF joint with the sensors, spring and force feedback of a joint."""
        joint_element = _make_element_at(joint.element, "joint", joint.name)
        joint_element.attributes["type"] = "fixed"
        _set_text(joint_element, "parent", joint.parent, joint_element)
        _set_text(joint_element, "child", joint.child, joint_element)
        for gazebo in self._by_name.get(joint.name, ()):
            if joint.name not in robot.links:
                joint_element.children += map(_copy_element, _iterate_sdf_children(gazebo))
            self._add_old_tags(joint_element, gazebo, _JOINT_TAGS, JOINT)
        sdf_joint: Joint = read_element(joint_element, JOINT, self._report)
        return sdf_joint

    def stays_fixed(self, joint: urdf.Joint) -> bool:
        """Return whether ``preserveFixedJoint`` prevents merging the links of a fixed joint."""
        return self._is_true(joint, _KEEP_FIXED_TAG)

    def becomes_revolute(self, joint: urdf.Joint) -> bool:
        """Return whether ``disableFixedJointLumping`` turns a fixed joint into a revolute joint.

        The revolute joint cannot move.

        ``preserveFixedJoint`` takes precedence.
        """
        return self._is_true(joint, _MAKE_REVOLUTE_TAG) and not self.stays_fixed(joint)

    def _is_true(self, joint: urdf.Joint, tag: str) -> bool:
        elements = (element for gazebo in self._by_name.get(joint.name, ()) for element in gazebo.elements(tag))
        return any(_read_tag_value(element).casefold() in _TRUE_VALUES for element in elements)

    def _add_old_tags(self, sdf_element: Element, gazebo: Element, words: _PathsByTag, rule: ElementRule) -> None:
        """Add the SDF elements for the old tags in `gazebo` to an element.

        If a tag occurs several times, its last value applies.
        """
        for old_element in gazebo.elements():
            for path in words.get(old_element.tag, ()):
                value_rule, text = _find_rule(rule, path), _read_tag_value(old_element)
                assert value_rule.text is not None
                if value_rule.text.type is TRUTH:
                    text = _convert_boolean(old_element.tag, text)
                try:
                    value_rule.text.type.read(text)
                except ValueError:
                    self._report.malformed(
                        _copy_with_text(old_element, text),
                        replace(value_rule, tag=old_element.tag),
                        value_rule.text,
                        sdf_element,
                    )
                    continue
                _set_text(sdf_element, path, text, old_element)
                if old_element.tag == "material":
                    _set_text(sdf_element, "material/script/uri", _MATERIALS_URI, old_element)


def _make_element_at(element: Element | None, tag: str, name: str) -> Element:
    """Return a new SDF element with the source position of a URDF element."""
    if element is None:
        return Element(tag, {"name": name})
    return Element(tag, {"name": name}, element.source, element.offset, element.origin)


def _iterate_sdf_children(gazebo: Element) -> Iterator[Element]:
    """Yield the SDF child elements of ``<gazebo>``, without old tags, visuals and collisions."""
    return (element for element in gazebo.elements() if element.tag not in _OLD_TAGS and element.tag not in _SHAPE_TAGS)


def _merge_shape_settings(shape: Element, settings: Element) -> None:
    """Add settings to the element for all shapes of a link.

    A surface or material replaces an earlier one.
    """
    for element in settings.elements():
        if element.tag in ("surface", "material"):
            shape.children = [child for child in shape.elements() if child.tag != element.tag]
        shape.children.append(_copy_element(element))


def _copy_element(element: Element) -> Element:
    copy = Element(element.tag, dict(element.attributes), element.source, element.offset, element.origin)
    copy.children = [_copy_element(child) if isinstance(child, Element) else child for child in element.children]
    return copy


def _set_text(ancestor: Element, path: str, text: str, source_element: Element) -> None:
    """Set the text of the descendant at a path of tags, and create missing elements.

    New elements have the source position of `source_element`.
    """
    for tag in path.split("/"):
        child = ancestor.first(tag)
        if child is None:
            child = Element(tag, None, source_element.source, source_element.offset, source_element.origin)
            ancestor.children.append(child)
        ancestor = child
    ancestor.children[:] = [Text(text)]


def _copy_with_text(old_element: Element, text: str) -> Element:
    element = Element(old_element.tag, None, old_element.source, old_element.offset, old_element.origin)
    element.children.append(Text(text))
    return element


def _read_tag_value(old_element: Element) -> str:
    """Return the value of an old tag, from its attribute ``value`` or its text."""
    return old_element.attributes.get("value", old_element.text()).strip()


def _convert_boolean(tag: str, text: str) -> str:
    """Return the value of an old boolean tag as ``true`` or ``false``, as in SDF.

    Any other text becomes ``false``.
    """
    folded_text = text.casefold()
    if tag in _NEGATED_TAGS:
        return "true" if folded_text in _FALSE_VALUES else "false"
    return "true" if folded_text in _TRUE_VALUES else "false"


def _find_rule(rule: ElementRule, path: str) -> ElementRule:
    for tag in path.split("/"):
        rule = rule.child_rules[tag]
    return rule
