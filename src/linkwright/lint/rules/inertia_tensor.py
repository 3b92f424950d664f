"""Rules about inertia tensors alone: whether a tensor is possible for any body."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, phrase
from linkwright.lint.finding import Finding
from linkwright.lint.rule import Rule
from linkwright.lint.rules.inertia import find_child_or_inertial
from linkwright.lint.subject import Subject
from linkwright.lint.tensors import DIAGONAL_NAMES, Flaw, read_tensor
from linkwright.urdf import Inertial, Link


class _FlawRule(Rule):
    """The base class of rules about one kind of flaw of inertia tensors."""

    kind = ""

    def links_with_flaw(self, subject: Subject) -> Iterator[tuple[Link, Inertial, Flaw]]:
        """Yield the links whose inertia tensor has this kind of flaw as its first flaw."""
        return (tensor_flaw for tensor_flaw in subject.tensor_flaws if tensor_flaw[2].kind == self.kind)


class _TensorRule(_FlawRule, ABC):
    """The base class of rules that report each flaw of one kind."""

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial, flaw in self.links_with_flaw(subject):
            yield self.finding(link.name, inertial, flaw)

    @abstractmethod
    def finding(self, name: str, inertial: Inertial, flaw: Flaw) -> Finding:
        """Return the finding on a flaw of this kind in the tensor of a link, in a robot or a world."""


class ZeroInertia(_FlawRule):
    """A mass with an inertia tensor of zero.

    ## Why

    Such a body does not resist rotation: a torque accelerates it without bound, and simulators refuse it. A point mass
    that is fixed to a body with an inertia is fine, and is not reported.

    ## Example

    ```xml
    <mass value="1.2"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>
    ```

    ## Use instead

    Write the tensor of the shape. `linkwright inertia FILE` computes it.
    """

    code = "LW310"
    name = "inertia-zero"
    kind = "zero"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, inertial, _ in self.links_with_flaw(subject):
            from linkwright.geometry.validity import is_positive_definite

            body = subject.bodies.of(link.name)
            if inertial.mass <= 0 or body is None:
                continue
            if is_positive_definite(subject.extents.mass_properties(body).inertia):
                continue
            yield self.report(
                phrase("link '{name}' has a mass of {mass:g} kg and no inertia", name=link.name, mass=inertial.mass),
                find_child_or_inertial(inertial, "inertia"),
                hint=phrase("run `linkwright inertia` to compute it from the link's shapes")
                if link.visuals or link.collisions
                else phrase(
                    "give it the inertia of a small solid with this mass, because the link has no shape to "
                    "compute it from"
                ),
            )


class NonPositiveMoment(_TensorRule):
    """A moment of inertia on the diagonal that is zero or negative.

    ## Why

    A moment is the sum of masses times squared distances, which is positive for every body that has an extent. Solvers
    divide by the moment and fail.

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
    holds_for_parts = True
    kind = "diagonal"

    def finding(self, name: str, inertial: Inertial, flaw: Flaw) -> Finding:
        problem = phrase("zero") if flaw.amount == 0 else phrase("negative: {amount:g}", amount=flaw.amount)
        return self.report(
            phrase("'{attribute}' of link '{name}' is {problem}", attribute=flaw.attribute, name=name, problem=problem),
            find_child_or_inertial(inertial, "inertia"),
            flaw.attribute,
            hint=phrase("run `linkwright inertia` to compute ixx, iyy and izz, which must be positive, in kg m2"),
        )


class ExcessiveProduct(_TensorRule):
    """A product of inertia that is larger than the moments allow.

    ## Why

    |ixy| can exceed neither half of izz nor the square root of ixx times iyy. The same holds for the other products. A
    larger product is a mistake, such as a moment in place of a product, or a component in other units.

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
    holds_for_parts = True
    kind = "product"

    def finding(self, name: str, inertial: Inertial, flaw: Flaw) -> Finding:
        assert flaw.attribute is not None
        value = getattr(inertial, flaw.attribute)
        return self.report(
            phrase(
                "'{attribute}' of link '{name}' is larger than its moments allow: {value:g}",
                attribute=flaw.attribute,
                name=name,
                value=value,
            ),
            find_child_or_inertial(inertial, "inertia"),
            flaw.attribute,
            notes=[Note(phrase("with these moments, its magnitude can be at most {amount:.3g}", amount=flaw.amount))],
            hint=phrase("check the order ixx ixy ixz iyy iyz izz, and that all are in kg m2"),
        )


class IndefiniteInertia(_TensorRule):
    """An inertia tensor that has a negative principal moment.

    ## Why

    The moment about some axis is negative, which is impossible. Gazebo and Drake refuse such a tensor, and other
    simulators fail at the first contact. Usually, the products have a wrong sign, or refer to a different point than
    the moments. If the smallest moment of a thin body is negative only because of rounding in the file, the tensor is
    not reported.

    ## Example

    ```xml
    <inertia ixx="1" ixy="-0.45" ixz="-0.2" iyy="0.5" iyz="-0.45" izz="1"/>
    ```

    ## Use instead

    Write the tensor about the center of mass, with all components from one source. `linkwright inertia FILE` computes
    such a tensor.
    """

    code = "LW313"
    name = "inertia-not-positive-definite"
    holds_for_parts = True
    kind = "indefinite"

    def finding(self, name: str, inertial: Inertial, flaw: Flaw) -> Finding:
        return self.report(
            phrase("the inertia tensor of link '{name}' is not positive definite", name=name),
            find_child_or_inertial(inertial, "inertia"),
            notes=[_make_principal_moments_note(inertial)],
            hint=phrase("check the signs of the products, and that all components are about the center of mass"),
        )


class TriangleInequality(_TensorRule):
    """An inertia tensor whose largest principal moment exceeds the sum of the other two.

    ## Why

    No distribution of mass has such moments: ixx + iyy - izz is twice the integral of z squared. Gazebo refuses the
    link. The usual causes are made-up numbers and overly coarse rounding.

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
    holds_for_parts = True
    kind = "triangle"

    def finding(self, name: str, inertial: Inertial, flaw: Flaw) -> Finding:
        is_diagonal = not (inertial.ixy or inertial.ixz or inertial.iyz)
        first, second = (item for item in DIAGONAL_NAMES if item != flaw.attribute)
        message = phrase("one moment of inertia of link '{name}' is larger than the other two together", name=name)
        notes = [_make_principal_moments_note(inertial)]
        if is_diagonal:
            moment_sum = getattr(inertial, first) + getattr(inertial, second)
            message = phrase(
                "'{attribute}' of link '{name}' is larger than the other two moments together",
                attribute=flaw.attribute,
                name=name,
            )
            notes = [Note(phrase("{first} + {second} = {small:g}", first=first, second=second, small=moment_sum))]
        return self.report(
            message,
            find_child_or_inertial(inertial, "inertia"),
            flaw.attribute if is_diagonal else None,
            notes=notes,
            hint=phrase(
                "run `linkwright inertia` to compute the moments of the link's shapes, because these "
                "are not physically possible"
            ),
        )


def _make_principal_moments_note(inertial: Inertial) -> Note:
    from linkwright.geometry.validity import largest_entry, relative_moments

    matrix = read_tensor(inertial)
    largest = largest_entry(matrix)
    moments = " ".join(f"{moment * largest:.4g}" for moment in relative_moments(matrix))
    return Note(phrase("its principal moments are {moments}", moments=moments))
