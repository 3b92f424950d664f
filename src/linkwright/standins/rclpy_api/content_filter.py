"""What a subscription wants to have filtered (rclpy ``subscription_content_filter_options``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class ContentFilterOptions(NamedTuple):
    """Which messages of a topic are wanted.

    No middleware has to filter by content, and CycloneDDS does not: who asks for it has to check messages anyhow.

    Attributes:
        filter_expression: a condition in the manner of SQL, such as ``data > %0``.
        expression_parameters: what stands for ``%0``, ``%1``, ... in it.
    """

    filter_expression: str
    expression_parameters: Sequence[str] = ()
