"""The element ``<gazebo>`` in a URDF, which only simulators read.

Most of its content is SDF for the link, joint or model to which it refers. Some of its tags are older than SDF and
represent SDF elements (``mu1``, ``turnGravityOff``). Both are combined into one SDF element, which the SDF tables read,
so that errors are reported at their positions in the URDF.

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

_Words = Mapping[str, tuple[str, ...]]
"""A word of ``<gazebo>``: the SDF elements that it represents."""

_MODEL_WORDS: _Words = {"static": ("static",)}
_LINK_WORDS: _Words = {
    "turnGravityOff": ("gravity",),
    "selfCollide": ("self_collide",),
    "dampingFactor": ("velocity_decay/linear", "velocity_decay/angular"),
}
_COLLISION_WORDS: _Words = {
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
_VISUAL_WORDS: _Words = {"material": ("material/script/name",)}
_JOINT_WORDS: _Words = {
    "springReference": ("axis/dynamics/spring_reference",),
    "springStiffness": ("axis/dynamics/spring_stiffness",),
    "provideFeedback": ("physics/provide_feedback",),
}
_KEPT_FIXED = "preserveFixedJoint"
_MADE_REVOLUTE = "disableFixedJointLumping"
_OTHER_WORDS = frozenset(
    {
        _KEPT_FIXED,
        _MADE_REVOLUTE,
        *("canonicalBody", "cfmDamping", "fudgeFactor", "implicitSpringDamper", "stopCfm", "stopErp"),
    }
)
"""Words of ``<gazebo>`` without a place in SDF, or in the part of SDF that is read."""
_WORDS = frozenset({*_MODEL_WORDS, *_LINK_WORDS, *_COLLISION_WORDS, *_VISUAL_WORDS, *_JOINT_WORDS, *_OTHER_WORDS})
_SHAPES = frozenset({"collision", "visual"})
_NEGATED = frozenset({"turnGravityOff"})
_TRUE, _FALSE = frozenset({"true", "yes", "1"}), frozenset({"false", "no", "0"})
_MATERIALS = "file://media/materials/scripts/gazebo.material"
"""The scripts of Gazebo's own materials."""


@dataclass(frozen=True, slots=True)
class LinkExtension:
    """The settings of a link in ``<gazebo>``.

    Attributes:
        link: an SDF link with sensors, lights and whether gravity acts; its shapes, mass and pose do not apply.
        visual: settings for each visual of the link, except geometry and pose.
        collision: settings for each collision of the link, except geometry and pose.
    """

    link: Link
    visual: Visual
    collision: Collision


class Extensions:
    """The ``<gazebo>`` elements of a robot, by their ``reference``.

    Args:
        robot: the robot.
        report: receives the errors in these elements.
    """

    def __init__(self, robot: Robot, report: SdfReport) -> None:
        self._report = report
        self._by_name: dict[str, list[Element]] = defaultdict(list)
        for element in robot.extensions:
            if element.tag == "gazebo" and not is_too_deep(element, report):
                self._by_name[element.attributes.get("reference", "")].append(element)

    def model(self, robot: Robot) -> Model:
        """Return an SDF model with the settings of the whole robot.

        These are plugins, and links and joints that URDF cannot express.
        """
        whole = _like(robot.element, "model", robot.name)
        for gazebo in self._by_name.get("", ()):
            whole.children += _sdf_children(gazebo)
            self._add_words(whole, gazebo, _MODEL_WORDS, MODEL)
        model: Model = read_element(whole, MODEL, self._report)
        return model

    def link(self, link: urdf.Link) -> LinkExtension:
        """Return the settings of a link, its visuals and its collisions."""
        whole = _like(link.element, "link", link.name)
        visual, collision = _like(link.element, "visual", link.name), _like(link.element, "collision", link.name)
        for gazebo in self._by_name.get(link.name, ()):
            whole.children += _sdf_children(gazebo)
            for shape, words, rule in ((visual, _VISUAL_WORDS, VISUAL), (collision, _COLLISION_WORDS, COLLISION)):
                for element in gazebo.elements(shape.tag):
                    _merge(shape, element)
                self._add_words(shape, gazebo, words, rule)
            self._add_words(whole, gazebo, _LINK_WORDS, LINK)
        return LinkExtension(
            read_element(whole, LINK, self._report),
            read_element(visual, VISUAL, self._report),
            read_element(collision, COLLISION, self._report),
        )

    def joint(self, joint: urdf.Joint, robot: Robot) -> Joint:
        """Return an SDF joint with the settings of a joint: sensors, a spring, and force feedback."""
        whole = _like(joint.element, "joint", joint.name)
        whole.attributes["type"] = "fixed"
        _put(whole, "parent", joint.parent, whole)
        _put(whole, "child", joint.child, whole)
        for gazebo in self._by_name.get(joint.name, ()):
            if joint.name not in robot.links:
                whole.children += map(_copied, _sdf_children(gazebo))
            self._add_words(whole, gazebo, _JOINT_WORDS, JOINT)
        found: Joint = read_element(whole, JOINT, self._report)
        return found

    def stays_fixed(self, joint: urdf.Joint) -> bool:
        """Return whether the links of a fixed joint are not merged (``preserveFixedJoint``)."""
        return self._is_true(joint, _KEPT_FIXED)

    def becomes_revolute(self, joint: urdf.Joint) -> bool:
        """Return whether a fixed joint becomes a revolute joint that cannot move.

        This is requested by ``disableFixedJointLumping``.
        """
        return self._is_true(joint, _MADE_REVOLUTE) and not self.stays_fixed(joint)

    def _is_true(self, joint: urdf.Joint, word: str) -> bool:
        elements = (element for gazebo in self._by_name.get(joint.name, ()) for element in gazebo.elements(word))
        return any(_tag_value(element).casefold() in _TRUE for element in elements)

    def _add_words(self, whole: Element, gazebo: Element, words: _Words, rule: ElementRule) -> None:
        """Add the SDF elements for the old tags in `gazebo` to an element.

        If a tag occurs several times, its last value applies.
        """
        for word in gazebo.elements():
            for path in words.get(word.tag, ()):
                place, text = _rule_at(rule, path), _tag_value(word)
                assert place.text is not None
                if place.text.type is TRUTH:
                    text = _truth(word.tag, text)
                try:
                    place.text.type.read(text)
                except ValueError:
                    self._report.malformed(_with_text(word, text), replace(place, tag=word.tag), place.text, whole)
                    continue
                _put(whole, path, text, word)
                if word.tag == "material":
                    _put(whole, "material/script/uri", _MATERIALS, word)


def _like(element: Element | None, tag: str, name: str) -> Element:
    """Return a new SDF element with the source position of a URDF element."""
    if element is None:
        return Element(tag, {"name": name})
    return Element(tag, {"name": name}, element.source, element.offset, element.origin)


def _sdf_children(gazebo: Element) -> Iterator[Element]:
    """Yield the child elements that are already SDF."""
    return (element for element in gazebo.elements() if element.tag not in _WORDS and element.tag not in _SHAPES)


def _merge(shape: Element, given: Element) -> None:
    """Add settings to those for all shapes of a link; a later surface or material replaces earlier ones."""
    for element in given.elements():
        if element.tag in ("surface", "material"):
            shape.children = [other for other in shape.elements() if other.tag != element.tag]
        shape.children.append(_copied(element))


def _copied(element: Element) -> Element:
    copy = Element(element.tag, dict(element.attributes), element.source, element.offset, element.origin)
    copy.children = [_copied(child) if isinstance(child, Element) else child for child in element.children]
    return copy


def _put(whole: Element, path: str, text: str, place: Element) -> None:
    """Set the text of a descendant at a path of tags, creating missing elements.

    New elements have the source position of `place`.
    """
    for tag in path.split("/"):
        inner = whole.first(tag)
        if inner is None:
            inner = Element(tag, None, place.source, place.offset, place.origin)
            whole.children.append(inner)
        whole = inner
    whole.children[:] = [Text(text)]


def _with_text(word: Element, text: str) -> Element:
    element = Element(word.tag, None, word.source, word.offset, word.origin)
    element.children.append(Text(text))
    return element


def _tag_value(word: Element) -> str:
    """Return the value of an old tag, from its attribute ``value`` or its text."""
    return word.attributes.get("value", word.text()).strip()


def _truth(word: str, text: str) -> str:
    """Return the value of an old boolean tag as ``true`` or ``false``, as the SDF element requires.

    Any other text becomes ``false``.
    """
    folded = text.casefold()
    if word in _NEGATED:
        return "true" if folded in _FALSE else "false"
    return "true" if folded in _TRUE else "false"


def _rule_at(rule: ElementRule, path: str) -> ElementRule:
    for tag in path.split("/"):
        rule = rule.child_rules[tag]
    return rule
