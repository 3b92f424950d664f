"""Write the report of a review as text, Markdown, HTML, or data for programs."""

from linkwright.review.reports.data import as_data, as_diagnostics
from linkwright.review.reports.html import as_html
from linkwright.review.reports.markdown import as_markdown
from linkwright.review.reports.text import as_text

__all__ = ["as_data", "as_diagnostics", "as_html", "as_markdown", "as_text"]
