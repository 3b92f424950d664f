"""Rules about inertia tensors by themselves: whether a body can have them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Note
from linkwright.lint.rule import Option, Rule
from linkwright.lint.rules.inertia import links_with_inertial, part
from linkwright.lint.subject import Subject
from linkwright.urdf import Inertial, Link

if TYPE_CHECKING:
    from linkwright.inertia.properties import Array

_DIAGONAL = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")


@dataclass(frozen=True, slots=True)
class Flaw:
    """The first thing that is wrong with a link's tensor; by it each tensor is reported by one rule only.

    Attributes:
        kind: ``zero``, ``diagonal``, ``product``, ``indefinite`` or ``triangle``.
        attribute: the attribute it shows in, or None when it is in all of them.
        amount: a number that belongs to it: the largest product allowed, the part by which the inequality is broken.
    """

    kind: str
    attribute: str | None = None
    amount: float = 0.0


def tensor(inertial: Inertial) -> Array:
    """The tensor in kg m2 as it is written, in the inertial frame; shape (3, 3)."""
    import numpy as np

    i = inertial
    return np.array(((i.ixx, i.ixy, i.ixz), (i.ixy, i.iyy, i.iyz), (i.ixz, i.iyz, i.izz)))


def flaw_of(inertial: Inertial) -> Flaw | None:
    """The first thing that is wrong with a tensor, or None."""
    from linkwright.inertia import validity

    moments = [getattr(inertial, name) for name in _DIAGONAL]
    products = [getattr(inertial, name) for name in _PRODUCTS]
    if not any(moments) and not any(products):
        return Flaw("zero")
    for name, moment in zip(_DIAGONAL, moments, strict=True):
        if moment <= 0:
            return Flaw("diagonal", name, moment)
    matrix = tensor(inertial)
    if any(products):
        for name, limit in validity.excessive_products(matrix):
            return Flaw("product", name, limit)
        if not validity.is_positive_definite(matrix):
            return Flaw("indefinite")
    excess = validity.triangle_excess(matrix)
    if excess > validity.TOLERANCE:
        return Flaw("triangle", _DIAGONAL[moments.index(max(moments))], excess)
    return None


class _TensorRule(Rule):
    """A rule about one kind of flaw."""

    kind = ""

    def flawed(self, subject: Subject) -> Iterator[tuple[Link, Inertial, Flaw]]:
        """The links whose tensor has the flaw first of all."""
        for link, inertial in links_with_inertial(subject):
            flaw = flaw_of(inertial)
            if flaw is not None and flaw.kind == self.kind:
                yield link, inertial, flaw


class ZeroInertia(_TensorRule):
    """A mass with an inertia tensor of zero.

    ## Why

    Nothing resists turning such a body: a torque accelerates it without bound, and simulators refuse it. A point mass
    that is fixed to a body with an inertia is fine, and is not reported.

    ## Example

    ```xml
    <mass value="1.2"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>
    ```

    ## Use instead

    The tensor of the shape; `linkwright inertia FILE` computes it.
    """

    code = "LW310"
    name = "inertia-zero"
    kind = "zero"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        from linkwright.inertia.validity import is_positive_definite

        for link, inertial, _ in self.flawed(subject):
            body = subject.bodies.of(link.name)
            if inertial.mass <= 0 or body is None:
                continue
            if is_positive_definite(subject.bodies.mass_properties(body).inertia):
                continue
            yield self.report(
                f"link '{link.name}' has a mass of {inertial.mass:g} kg and no inertia",
                part(inertial, "inertia"),
                hint="`linkwright inertia` computes it from the link's shapes",
            )


class NonPositiveMoment(_TensorRule):
    """A moment of inertia on the diagonal that is zero or negative.

    ## Why

    A moment sums masses times squared distances. It is positive for everything that has an extent, and a solver that
    divides by it fails.

    ## Example

    ```xml
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="-0.01" iyz="0" izz="0.01"/>
    ```

    ## Use instead

    ```xml
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    ```
    """

    code = "LW311"
    name = "inertia-not-positive"
    kind = "diagonal"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link, inertial, flaw in self.flawed(subject):
            what = "zero" if flaw.amount == 0 else f"negative: {flaw.amount:g}"
            yield self.report(
                f"'{flaw.attribute}' of link '{link.name}' is {what}",
                part(inertial, "inertia"),
                flaw.attribute,
                hint="ixx, iyy and izz are positive, in kg m2; `linkwright inertia` computes them",
            )


class ExcessiveProduct(_TensorRule):
    """A product of inertia that is larger than the moments allow.

    ## Why

    |ixy| can be no more than half of izz, nor than the root of ixx times iyy; and so on around. A larger one is a slip:
    a moment written in the place of a product, or one component in other units.

    ## Example

    ```xml
    <inertia ixx="0.01" ixy="0.02" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    ```

    ## Use instead

    ```xml
    <inertia ixx="0.01" ixy="0.002" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    ```
    """

    code = "LW312"
    name = "inertia-product-too-large"
    kind = "product"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link, inertial, flaw in self.flawed(subject):
            assert flaw.attribute is not None
            value = getattr(inertial, flaw.attribute)
            yield self.report(
                f"'{flaw.attribute}' of link '{link.name}' is larger than its moments allow: {value:g}",
                part(inertial, "inertia"),
                flaw.attribute,
                notes=[Note(f"with these moments it is at most {flaw.amount:.3g} either way")],
                hint="check the order ixx ixy ixz iyy iyz izz, and that all are in kg m2",
            )


class IndefiniteInertia(_TensorRule):
    """An inertia tensor that is not positive definite.

    ## Why

    About some axis the moment is zero or negative, which no body has. Gazebo and Drake refuse it, others go wrong at
    the first contact. Mostly the products have a wrong sign, or were taken about another point than the moments.

    ## Example

    ```xml
    <inertia ixx="1" ixy="-0.45" ixz="-0.2" iyy="0.5" iyz="-0.45" izz="1"/>
    ```

    ## Use instead

    The tensor about the centre of mass, all components from one source; `linkwright inertia FILE` computes one.
    """

    code = "LW313"
    name = "inertia-not-positive-definite"
    kind = "indefinite"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link, inertial, _ in self.flawed(subject):
            yield self.report(
                f"the inertia tensor of link '{link.name}' is not positive definite",
                part(inertial, "inertia"),
                notes=[_principal_moments(inertial)],
                hint="check the signs of the products, and that all components are about the centre of mass",
            )


class TriangleInequality(_TensorRule):
    """An inertia tensor whose largest principal moment is more than the other two together.

    ## Why

    No distribution of mass has such moments: ixx + iyy - izz is twice the integral of z squared. Gazebo refuses the
    link. The usual causes are made-up numbers and a rounding too coarse.

    ## Example

    ```xml
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.01"/>
    ```

    ## Use instead

    ```xml
    <inertia ixx="0.005" ixy="0" ixz="0" iyy="0.005" iyz="0" izz="0.01"/>
    ```
    """

    code = "LW314"
    name = "inertia-triangle-inequality"
    kind = "triangle"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link, inertial, flaw in self.flawed(subject):
            diagonal = not (inertial.ixy or inertial.ixz or inertial.iyz)
            first, second = (name for name in _DIAGONAL if name != flaw.attribute)
            message = f"one moment of inertia of link '{link.name}' is larger than the other two together"
            notes = [_principal_moments(inertial)]
            if diagonal:
                small = getattr(inertial, first) + getattr(inertial, second)
                message = f"'{flaw.attribute}' of link '{link.name}' is larger than the other two moments together"
                notes = [Note(f"{first} + {second} = {small:g}")]
            yield self.report(
                message,
                part(inertial, "inertia"),
                flaw.attribute if diagonal else None,
                notes=notes,
                hint="no body has these moments; `linkwright inertia` computes those of the link's shapes",
            )


class PlaceholderInertia(Rule):
    """One and the same inertia copied to links of different shapes.

    ## Why

    A tensor of ones on everything is a placeholder from a tutorial. For a link of a few hundred grams it is thousands
    of times too large, and the robot moves as if in honey. What depends on size and mass cannot be the same for all.
    The rule speaks where at least half of the links share such a tensor.

    ## Example

    ```xml
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    ```

    on the body, each wheel and the caster alike.

    ## Use instead

    A tensor for each link; `linkwright inertia FILE` computes them all.
    """

    code = "LW315"
    name = "inertia-placeholder"
    options = (Option("links", 3, "how many links must share a tensor to be reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        least = subject.option(self, "links", int)
        groups: dict[tuple[float, ...], list[tuple[Link, Inertial]]] = {}
        count = 0
        for link, inertial in links_with_inertial(subject):
            values = tuple(getattr(inertial, name) for name in (*_DIAGONAL, *_PRODUCTS))
            if any(values):
                count += 1
                groups.setdefault(values, []).append((link, inertial))
        for values, sharing in groups.items():
            shapes = {_shapes(link) for link, _ in sharing} - {()}
            if len(sharing) < least or len(shapes) < least or 2 * len(sharing) < count:
                continue
            if not values[0] == values[1] == values[2]:
                continue
            link, inertial = sharing[0]
            others = ", ".join(f"'{other.name}'" for other, _ in sharing[1:5])
            more = "" if len(sharing) <= 5 else ", ..."
            yield self.report(
                f"link '{link.name}' has the same inertia as {len(sharing) - 1} links of other shapes",
                part(inertial, "inertia"),
                notes=[Note(f"the others are {others}{more}")],
                hint="`linkwright inertia` computes one for each from its shapes",
            )


class TurnedSphere(Rule):
    """A rotation in the `<origin>` of an inertia that is the same about every axis.

    ## Why

    The rotation of `<inertial>` turns the tensor only, not the shapes, and a tensor with three equal moments and no
    products looks the same from everywhere. The rotation was probably meant for something else.

    ## Example

    ```xml
    <origin xyz="0 0 0.1" rpy="1.5708 0 0"/>
    <mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    ```

    ## Use instead

    ```xml
    <origin xyz="0 0 0.1"/>
    ```
    """

    code = "LW316"
    name = "inertia-turned-in-vain"
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link, inertial in links_with_inertial(subject):
            alike = inertial.ixx == inertial.iyy == inertial.izz
            products = inertial.ixy or inertial.ixz or inertial.iyz
            if alike and not products and any(inertial.origin.rpy) and inertial.ixx:
                yield self.report(
                    f"the rotation of <inertial> of link '{link.name}' changes nothing: its inertia is alike about "
                    "every axis",
                    part(inertial, "origin"),
                    "rpy",
                    hint="leave 'rpy' out, or give the moments of the shape",
                )


class TinyInertia(Rule):
    """A moving body with a moment of inertia that solvers cannot work with.

    ## Why

    Integrators with steps of a millisecond become unstable where a joint turns something of almost no inertia.

    ## Example

    ```xml
    <inertia ixx="1e-12" ixy="0" ixz="0" iyy="1e-12" iyz="0" izz="1e-12"/>
    ```

    ## Use instead

    At least 1e-8 kg m2 or so, which is a steel ball of 8 mm; and armature or damping at the joint.
    """

    code = "LW317"
    name = "inertia-tiny"
    default = False
    options = (Option("smallest", 1e-9, "smallest principal moment of a moving body, in kg m2"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        smallest = subject.option(self, "smallest", float)
        for body in subject.bodies.all:
            holders = [link for link in subject.bodies.members(body) if link.inertial is not None]
            if body.joint is None or not holders:
                continue
            moment = float(subject.bodies.mass_properties(body).principal().moments[0])
            if 0 < moment < smallest and holders[0].inertial is not None:
                yield self.report(
                    f"the smallest moment of inertia of moving link '{body.links[0]}' is {moment:.2g} kg m2",
                    part(holders[0].inertial, "inertia"),
                    hint="simulate with more, or give the joint damping",
                )


def _principal_moments(inertial: Inertial) -> Note:
    import numpy as np

    moments = " ".join(f"{moment:.4g}" for moment in np.linalg.eigvalsh(tensor(inertial)))
    return Note(f"its principal moments are {moments}")


def _shapes(link: Link) -> tuple[object, ...]:
    """What a link looks like, to tell different links from copies."""
    return tuple(shape.geometry for shape in (link.collisions or link.visuals))
