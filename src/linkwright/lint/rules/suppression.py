"""Rules about suppression comments.

The engine reports the findings of these rules.
"""

from __future__ import annotations

from linkwright.lint.rule import Rule, Scope


class UnusedSuppression(Rule):
    """A suppression comment that suppresses nothing.

    ## Why

    The finding for which the comment was written no longer exists, or never did. If the comment stays in the file, it
    may hide a new finding of this code by accident.

    ## Example

    ```xml
    <!-- linkwright: ignore LW203 -->
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    ```

    ## Use instead

    Remove the comment, or let `linkwright check --select LW001 --fix FILE` remove it.
    """

    code = "LW001"
    name = "unused-suppression"
    needs_all_sets = True
    default = False
    scope = Scope.COMMENTS


class UnknownSuppression(Rule):
    """A suppression comment with an unknown rule.

    ## Why

    Such a comment suppresses nothing, so the finding for which it was written is still reported.

    ## Example

    ```xml
    <!-- linkwright: ignore limit-invertd -->
    ```

    ## Use instead

    ```xml
    <!-- linkwright: ignore limit-inverted -->
    ```

    A code (`LW201`), the beginning of a code (`LW2`) and the name of a rule are valid.
    """

    code = "LW002"
    name = "unknown-suppression"
    scope = Scope.COMMENTS
