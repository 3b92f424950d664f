"""The substitution that evaluates a Python expression."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import LinkwrightError, foreign, phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    AnyTexts,
    DeclaredSubstitution,
    Texts,
)
from linkwright.launch.model.substitution import (
    TextSubstitution,
    describe,
    perform_substitutions,
)


class PythonExpression(DeclaredSubstitution, tag="eval"):
    """A substitution that evaluates to the value of a Python expression, as text.

    Args:
        expression: the Python expression, as text or substitutions.
        python_modules: the names of the modules that the expression may use; by default ``math``. The members of
            ``math`` can also be used without the module name.
    """

    expression: Texts = Texts()
    python_modules: AnyTexts = AnyTexts(default=("math",))

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
        """Return the class and keyword arguments for an expression and, optionally, modules.

        The names of the modules are separated by commas.

        Raises:
            TypeError: the number of arguments is wrong.
        """
        if len(data) not in (1, 2):
            raise TypeError("eval substitution expects 1 or 2 arguments")
        kwargs: dict[str, Any] = {"expression": data[0]}
        if len(data) == 2:
            if not all(isinstance(substitution, TextSubstitution) for substitution in data[1]):
                raise TypeError("the modules of an eval substitution must be plain text")
            names = "".join(part.text for part in data[1]).split(",")
            kwargs["python_modules"] = [TextSubstitution(text=name.strip()) for name in names if name.strip()]
        return cls, kwargs

    def describe(self) -> str:
        """Return a text with the expression and the modules."""
        modules = ", ".join(module.describe() for module in self.python_modules)
        return f"PythonExpr({describe(self.expression)}, [{modules}])"

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the expression, and return its value as text.

        The expression runs unrestricted, like the launch file that contains it.

        Raises:
            Exception: LAUNCH126, an error that the expression raises, with the class of Python's exception.
        """
        expression = perform_substitutions(context, self.expression)
        namespace: dict[str, Any] = {}
        try:
            for module in self.python_modules:
                name = perform_substitutions(context, [module])
                namespace[name] = importlib.import_module(name)
            if "math" in namespace:
                members = vars(namespace["math"]).items()
                namespace.update({name: value for name, value in members if not name.startswith("_")})
            return str(eval(expression, {}, namespace))  # noqa: S307 - launch files are programs by design
        except LinkwrightError:
            raise
        except Exception as error:
            message = phrase(
                "Python expression '{expression}' cannot be evaluated ({kind}: {reason})",
                expression=expression,
                kind=type(error).__name__,
                reason=foreign(error),
            )
            hint = None
            if isinstance(error, NameError):
                hint = phrase(
                    "put quotes around the parts that are strings: [\"'\", LaunchConfiguration('x'), \"' == 'y'\"]"
                )
            raise error_at(self.source_location, "LAUNCH126", message, hint, ros_error=error) from error
