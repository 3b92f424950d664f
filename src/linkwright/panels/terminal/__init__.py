"""The terminals in the page."""
